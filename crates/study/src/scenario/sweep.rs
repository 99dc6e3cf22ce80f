//! The design of a study: axes over any keys of the scenario, and their product as cells.
//!
//! A point of an axis sets one key or several; the changed document is resolved like any scenario, so a swept value is
//! checked as strictly as one that is written down.

use serde::Deserialize;
use toml::{Table, Value};

/// Largest number of cells; more is a mistake in a range.
const MOST_CELLS: usize = 100_000;

/// An axis as it is written: `[[sweep]]`.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct AxisWire {
    /// Name on plots and in tables; the key when it is left out.
    name: Option<String>,
    /// Dotted key that is swept, with `values`, `linear` or `log`.
    key: Option<String>,
    /// The values one by one.
    values: Option<Vec<Value>>,
    /// Evenly spaced values.
    linear: Option<RangeWire>,
    /// Evenly spaced values of the logarithm.
    log: Option<RangeWire>,
    /// Points that set several keys at once.
    points: Option<Vec<PointWire>>,
}

/// A range of numbers, both ends included.
#[derive(Debug, Clone, Copy, Deserialize)]
#[serde(deny_unknown_fields)]
struct RangeWire {
    from: f64,
    to: f64,
    points: usize,
}

/// A point that sets several keys.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
struct PointWire {
    label: String,
    set: Table,
}

/// One axis of the design.
#[derive(Debug, Clone, PartialEq)]
pub struct Axis {
    /// Name on plots and in tables.
    pub name: String,
    /// The points in order.
    pub points: Vec<Point>,
}

/// One point of an axis.
#[derive(Debug, Clone, PartialEq)]
pub struct Point {
    /// What it is called.
    pub label: String,
    /// Its value, where the axis is a number.
    pub value: Option<f64>,
    /// Dotted keys and the values they get.
    pub set: Vec<(String, Value)>,
}

/// Why an axis makes no sense; `key` is relative to the `sweep` array.
#[derive(Debug, Clone, PartialEq)]
pub struct SweepError {
    /// Dotted path from the root of the document.
    pub key: String,
    /// What was found and what was expected.
    pub problem: String,
}

impl AxisWire {
    /// Checks an axis; `index` is its place in the `sweep` array.
    pub fn resolve(&self, index: usize) -> Result<Axis, SweepError> {
        let error = |key: &str, problem: String| SweepError { key: format!("sweep.{index}{key}"), problem };
        let points = match (&self.key, &self.values, &self.linear, &self.log, &self.points) {
            (Some(key), Some(values), None, None, None) => values.iter().map(|value| Point::of(key, value.clone())).collect(),
            (Some(key), None, Some(range), None, None) => {
                let values = range.values().map_err(|problem| error(".linear", problem))?;
                values.map(|value| Point::of(key, Value::Float(value))).collect()
            }
            (Some(key), None, None, Some(range), None) => {
                if range.from <= 0.0 || range.to <= 0.0 {
                    return Err(error(".log", format!("a logarithmic range from {} to {}: both ends have to be positive", range.from, range.to)));
                }
                let logs = RangeWire { from: range.from.ln(), to: range.to.ln(), points: range.points };
                let values = logs.values().map_err(|problem| error(".log", problem))?;
                values.map(|value| Point::of(key, Value::Float(value.exp()))).collect()
            }
            (None, None, None, None, Some(points)) => points
                .iter()
                .map(|point| Point {
                    label: point.label.clone(),
                    value: None,
                    set: point.set.iter().map(|(key, value)| (key.clone(), value.clone())).collect(),
                })
                .collect::<Vec<_>>(),
            _ => {
                return Err(error(
                    "",
                    "expected `key` with one of `values`, `linear`, `log`, or `points` alone".into(),
                ));
            }
        };
        if points.is_empty() {
            return Err(error("", "an axis without points: give at least one value".into()));
        }
        let name = self.name.clone().or_else(|| self.key.clone()).unwrap_or_else(|| format!("axis {}", index + 1));
        Ok(Axis { name, points })
    }
}

impl RangeWire {
    fn values(self) -> Result<impl Iterator<Item = f64>, String> {
        if self.points < 2 || !self.from.is_finite() || !self.to.is_finite() {
            return Err(format!("{} points from {} to {}: expected two points or more between finite ends", self.points, self.from, self.to));
        }
        let step = (self.to - self.from) / (self.points - 1) as f64;
        Ok((0..self.points).map(move |k| if k + 1 == self.points { self.to } else { self.from + k as f64 * step }))
    }
}

impl Point {
    fn of(key: &str, value: Value) -> Self {
        let number = value.as_float().or_else(|| value.as_integer().map(|integer| integer as f64));
        let label = match (&value, number) {
            (_, Some(number)) => trim(number),
            (Value::String(text), None) => text.clone(),
            (other, None) => other.to_string(),
        };
        Self { label, value: number, set: vec![(key.to_owned(), value)] }
    }
}

/// A number with at most four significant digits and no trailing zeros.
fn trim(number: f64) -> String {
    let digits = if number == 0.0 { 0 } else { (3 - number.abs().log10().floor() as i32).clamp(0, 12) as usize };
    let text = format!("{number:.digits$}");
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_owned() } else { text }
}

/// Every combination of points, the first axis slowest; one empty combination when there is no axis.
pub fn product(axes: &[Axis]) -> Result<Vec<Vec<&Point>>, SweepError> {
    let count = axes.iter().try_fold(1usize, |count, axis| count.checked_mul(axis.points.len())).unwrap_or(usize::MAX);
    if count > MOST_CELLS {
        return Err(SweepError { key: "sweep".into(), problem: format!("{count} cells: at most {MOST_CELLS} are accepted") });
    }
    let mut cells: Vec<Vec<&Point>> = vec![Vec::new()];
    for axis in axes {
        cells = cells
            .into_iter()
            .flat_map(|cell| axis.points.iter().map(move |point| cell.iter().copied().chain([point]).collect()))
            .collect();
    }
    Ok(cells)
}

/// Sets a dotted key in a document, making tables on the way; numbers in the path index arrays.
///
/// Fails with a sentence when the path leads through something that is neither table nor array.
pub fn set(document: &mut Table, key: &str, value: Value) -> Result<(), String> {
    let mut place = document;
    let mut parts = key.split('.').peekable();
    while let Some(part) = parts.next() {
        if parts.peek().is_none() {
            place.insert(part.to_owned(), value);
            return Ok(());
        }
        let mut next = place.entry(part.to_owned()).or_insert_with(|| Value::Table(Table::new()));
        while let Value::Array(items) = next {
            let index = parts.next().unwrap_or_default();
            let length = items.len();
            next = index
                .parse()
                .ok()
                .and_then(|index: usize| items.get_mut(index))
                .ok_or_else(|| format!("`{part}` is an array of {length}: expected an index below that, found `{index}`"))?;
        }
        place = next.as_table_mut().ok_or_else(|| format!("`{part}` is a value, not a table: nothing can be set below it"))?;
    }
    Err("an empty key".into())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn axis(text: &str) -> Result<Axis, SweepError> {
        toml::from_str::<AxisWire>(text).expect("well formed").resolve(0)
    }

    #[test]
    fn ranges_hit_both_ends() {
        let log = axis("key = \"a.b\"\nlog = { from = 0.01, to = 1.0, points = 3 }").expect("valid");
        let values: Vec<f64> = log.points.iter().filter_map(|point| point.value).collect();
        assert!((values[1] - 0.1).abs() < 1e-12 && (values[2] - 1.0).abs() < 1e-12, "{values:?}");
        assert_eq!(log.points[1].label, "0.1");
        assert!(axis("key = \"a\"\nlog = { from = 0.0, to = 1.0, points = 3 }").is_err());
        assert!(axis("key = \"a\"").is_err());
    }

    #[test]
    fn cells_are_the_product_in_order() {
        let two = axis("key = \"x\"\nvalues = [1, 2]").expect("valid");
        let named = axis("name = \"trial\"\npoints = [{ label = \"p\", set = { \"m.r\" = 10, \"m.h\" = 20 } }, { label = \"q\", set = {} }]")
            .expect("valid");
        let axes = [two, named];
        let cells = product(&axes).expect("few");
        let labels: Vec<Vec<&str>> = cells.iter().map(|cell| cell.iter().map(|point| point.label.as_str()).collect()).collect();
        assert_eq!(labels, [["1", "p"], ["1", "q"], ["2", "p"], ["2", "q"]]);
    }

    #[test]
    fn sets_keys_in_tables_and_arrays() {
        let mut document: Table = "x = 1\n[[identifier]]\nsrivc = {}".parse().expect("well formed");
        set(&mut document, "sensor.noise", Value::Float(0.5)).expect("makes the table");
        set(&mut document, "identifier.0.srivc.n", Value::Integer(3)).expect("indexes the array");
        assert_eq!(document["sensor"]["noise"].as_float(), Some(0.5));
        assert_eq!(document["identifier"][0]["srivc"]["n"].as_integer(), Some(3));
        assert!(set(&mut document, "x.y", Value::Integer(1)).is_err());
        assert!(set(&mut document, "identifier.4.x", Value::Integer(1)).is_err());
    }
}
