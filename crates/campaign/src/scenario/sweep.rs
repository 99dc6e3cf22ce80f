//! Design of a study: axes over keys of the scenario, and their product as cells (full factorial design).
//!
//! A point of an axis sets one or several keys. The changed document is resolved as a scenario, so swept values are
//! checked as strictly as written values.

use std::collections::HashSet;

use serde::{Deserialize, Serialize};
use ship::ShortNumber;
use toml::{Table, Value};

use crate::scenario::key_units::axis_title;
use crate::scenario::limits;
use crate::scenario::name;
use crate::scenario::part::ScenarioPart;
use crate::scenario::problem::{FaultMark, KeyFault, KeyPath, text_fault};

/// Maximum number of cells; more indicate an error in a range.
const MAX_CELLS: usize = 100_000;

/// Axis as written: `[[sweep]]`.
#[derive(Debug, Clone, Deserialize, Serialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct AxisWire {
    /// Name on plots and in tables; the key if omitted.
    name: Option<String>,
    /// Dotted key that is swept, with `values`, `linear` or `log`.
    key: Option<String>,
    /// Values of the swept key; in place of `linear` or `log`.
    #[schemars(with = "Option<Vec<serde_json::Value>>")]
    values: Option<Vec<Value>>,
    /// Range of evenly spaced values.
    linear: Option<RangeWire>,
    /// Range of values with evenly spaced logarithms.
    log: Option<RangeWire>,
    /// Points that set several keys at once.
    points: Option<Vec<PointWire>>,
}

/// Range of numbers, both ends included.
#[derive(Debug, Clone, Copy, Deserialize, Serialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
struct RangeWire {
    /// First value.
    from: f64,
    /// Last value.
    to: f64,
    /// Number of values.
    points: usize,
}

/// Point that sets several keys.
#[derive(Debug, Clone, Deserialize, Serialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
struct PointWire {
    /// Label of the point.
    label: String,
    /// Value on a numeric axis; for an effect its size, which the label also contains (wind 0.7°).
    value: Option<f64>,
    /// Dotted keys and their values.
    #[schemars(with = "serde_json::Map<String, serde_json::Value>")]
    set: Table,
}

/// One axis of the design.
#[derive(Debug, Clone, PartialEq)]
pub struct SweepAxis {
    /// Name on plots and in tables.
    pub name: String,
    /// Points in order.
    pub points: Vec<SweepPoint>,
}

/// One point of an axis.
#[derive(Debug, Clone, PartialEq)]
pub struct SweepPoint {
    /// Label of the point.
    pub label: String,
    /// Value on a numeric axis; `None` for a point with a label alone.
    pub value: Option<f64>,
    /// Keys that the point sets, with their values.
    pub set: Vec<SweepSetting>,
}

/// Key that a point sets.
#[derive(Debug, Clone, PartialEq)]
pub struct SweepSetting {
    /// Key that is changed.
    pub key: KeyPath,
    /// Value that is set.
    pub value: Value,
    /// Path in the file that names the key.
    pub key_place: KeyPath,
    /// Path of the value in the scenario file.
    pub value_place: KeyPath,
}

impl SweepSetting {
    /// Checks that a sweep may change the key.
    fn check(&self) -> Result<(), KeyFault> {
        limits::check_depth(&self.key, &self.key_place)?;
        let first = self.key.names().first().map_or("", String::as_str);
        if first.is_empty() || matches!(ScenarioPart::from_key(first), ScenarioPart::Prose | ScenarioPart::Study) {
            let problem = match first {
                "" => "the sweep names no key".to_owned(),
                _ => format!("the sweep changes `{}`, which is the same for the whole study", self.key),
            };
            return Err(KeyFault {
                mark: if self.key_place == self.value_place { FaultMark::Name } else { FaultMark::Value },
                ..KeyFault::value(
                    self.key_place.clone(),
                    problem,
                    "expected a key of the trial or of a method",
                    "for instance `sensor.heading-noise-deg`, `ship.first-order.T-s`, `identifier.0.method.srivc.max-iterations`",
                )
            });
        }
        Ok(())
    }

    /// Fault of a changed scenario, attributed to the sweep; `cell` names the cell if there are several axes.
    pub fn attributed(&self, fault: KeyFault, cell: Option<&str>) -> KeyFault {
        let (place, mark) = match fault.mark {
            // If the point itself names the key, its name is underlined.
            FaultMark::Name if self.key_place == self.value_place => (self.key_place.clone(), FaultMark::Name),
            FaultMark::Name => (self.key_place.clone(), FaultMark::Value),
            FaultMark::Value => (self.value_place.clone(), FaultMark::Value),
            FaultMark::Within(_) => {
                let below = fault.key.names().strip_prefix(self.key.names()).unwrap_or_default();
                (below.iter().fold(self.value_place.clone(), |key, part| key.child(part)), fault.mark)
            }
        };
        let cell = cell.map_or_else(String::new, |cell| format!(" (cell {cell})"));
        let mut problem = format!("the sweep sets `{}` to {}{cell}", self.key, toml_text(&self.value));
        // Avoids "to −1: `key` is −1".
        if !fault.problem.starts_with(&format!("`{}` is", self.key)) {
            problem = format!("{problem}: {}", fault.problem);
        }
        KeyFault { key: place, mark, problem, ..fault }
    }
}

impl AxisWire {
    /// Axis of the sweep, checked; its index in `[[sweep]]` is only for error messages.
    pub fn resolve(&self, index_in_messages: usize) -> Result<SweepAxis, KeyFault> {
        let place = KeyPath::from_dotted("sweep").child(index_in_messages);
        let mut points = self.points(&place)?;
        if points.is_empty() {
            return Err(KeyFault::name(
                place,
                "this sweep has no points",
                "expected at least one",
                "add a value, or remove the sweep",
            ));
        }
        for setting in points.iter().flat_map(|point| &point.set) {
            setting.check()?;
        }
        let odd = points.iter().position(|point| point.value.is_some_and(|value| !value.is_finite()));
        if let (Some(index), true) = (odd, self.points.is_some()) {
            let key = place.child("points").child(index).child("value");
            let value = points[index].value.unwrap_or(f64::NAN);
            return Err(KeyFault::new(
                key,
                value,
                "expected a finite number",
                "give the place of the point on its axis",
            ));
        }
        distinguish(&mut points);
        let name =
            self.name.clone().or_else(|| self.key.as_deref().map(axis_title)).unwrap_or_else(|| "point".to_owned());
        self.check_names(&place, &name, &points)?;
        Ok(SweepAxis { name, points })
    }

    /// Points of the axis, as listed or spread over a range.
    fn points(&self, place: &KeyPath) -> Result<Vec<SweepPoint>, KeyFault> {
        let single = |key: &str, value: Value, value_place: KeyPath| {
            SweepPoint::from_value(key, value, place.child("key"), value_place)
        };
        let spread = |key: &str, values: Vec<f64>, how: &str| -> Vec<SweepPoint> {
            values.into_iter().map(|value| single(key, Value::Float(value), place.child(how))).collect()
        };
        Ok(match (&self.key, &self.values, &self.linear, &self.log, &self.points) {
            (Some(key), Some(values), None, None, None) => values
                .iter()
                .enumerate()
                .map(|(i, value)| single(key, value.clone(), place.child("values").child(i)))
                .collect(),
            (Some(key), None, Some(range), None, None) => spread(key, range.linear(&place.child("linear"))?, "linear"),
            (Some(key), None, None, Some(range), None) => spread(key, range.log(&place.child("log"))?, "log"),
            (None, None, None, None, Some(points)) => {
                points.iter().enumerate().map(|(i, point)| point.resolve(&place.child("points").child(i))).collect()
            }
            _ => {
                return Err(KeyFault::name(
                    place.clone(),
                    "this sweep needs a key with values, or points",
                    "expected `key` with one of `values`, `linear` and `log`, or `points` alone",
                    "for instance `key = \"sensor.heading-noise-deg\"` and `values = [0.01, 0.1, 1.0]`",
                ));
            }
        })
    }

    /// Checks that axis and points have printable labels, unique within the axis.
    fn check_names(&self, place: &KeyPath, name: &str, points: &[SweepPoint]) -> Result<(), KeyFault> {
        for (i, point) in points.iter().enumerate() {
            name::check_label(&point.label).map_err(|unfit| {
                let (key, advice) = match &self.points {
                    Some(_) => (place.child("points").child(i).child("label"), "change the label"),
                    None => (place.child("values").child(i), "give the value a shorter name: a `label` under `points`"),
                };
                KeyFault { advice: advice.to_owned(), ..text_fault(key, &point.label, unfit) }
            })?;
        }
        name::check_label(name).map_err(|unfit| {
            let key = if self.name.is_some() { "name" } else { "key" };
            KeyFault { advice: "give the sweep a short `name`".to_owned(), ..text_fault(place.child(key), name, unfit) }
        })?;
        let mut labels: Vec<&str> = points.iter().map(|point| point.label.as_str()).collect();
        labels.sort_unstable();
        if let Some(twice) = labels.windows(2).find(|pair| pair[0] == pair[1]) {
            return Err(KeyFault::name(
                place.clone(),
                format!("two points of this sweep are called `{}`", twice[0]),
                "expected points with names of their own",
                "remove one of them, or give it another label",
            ));
        }
        Ok(())
    }
}

impl PointWire {
    fn resolve(&self, place: &KeyPath) -> SweepPoint {
        let set = self.set.iter().map(|(key, value)| {
            let place = place.child("set").child(key);
            SweepSetting {
                key: KeyPath::from_dotted(key),
                value: value.clone(),
                key_place: place.clone(),
                value_place: place,
            }
        });
        SweepPoint { label: self.label.clone(), value: self.value, set: set.collect() }
    }
}

impl RangeWire {
    fn linear(&self, place: &KeyPath) -> Result<Vec<f64>, KeyFault> {
        if !(self.from.is_finite() && self.to.is_finite()) {
            return Err(self.range_fault(place, "expected finite ends"));
        }
        let step = (self.to - self.from) / (self.points.max(2) - 1) as f64;
        self.spread(place, |k| self.from + k as f64 * step)
    }

    fn log(&self, place: &KeyPath) -> Result<Vec<f64>, KeyFault> {
        if !(self.from > 0.0 && self.to > 0.0) {
            return Err(self.range_fault(place, "expected both ends of a logarithmic range to be above 0"));
        }
        if !(self.from.is_finite() && self.to.is_finite()) {
            return Err(self.range_fault(place, "expected finite ends"));
        }
        // Evenly spaced in the logarithm.
        let ratio = (self.to / self.from).ln();
        self.spread(place, |k| self.from * (ratio * k as f64 / (self.points - 1) as f64).exp())
    }

    /// Values of the range: exact ends, and `between` for the inner points.
    fn spread(&self, place: &KeyPath, between: impl Fn(usize) -> f64) -> Result<Vec<f64>, KeyFault> {
        let Self { from, to, points } = *self;
        if !(2..=MAX_CELLS).contains(&points) {
            return Err(self.range_fault(place, &format!("expected 2 to {MAX_CELLS} points")));
        }
        Ok(std::iter::once(from).chain((1..points - 1).map(between)).chain([to]).collect())
    }

    fn range_fault(&self, place: &KeyPath, expected: &str) -> KeyFault {
        let problem =
            format!("a range of {} points from {} to {}", self.points, ShortNumber(self.from), ShortNumber(self.to));
        KeyFault::name(place.clone(), problem, expected, "change the range, or write the `values` one by one")
    }
}

impl SweepPoint {
    fn from_value(key: &str, value: Value, key_place: KeyPath, value_place: KeyPath) -> Self {
        let number = value.as_float().or_else(|| value.as_integer().map(|integer| integer as f64));
        let label = match (&value, number) {
            (_, Some(number)) => trim(number),
            (Value::String(text), None) => text.clone(),
            (other, None) => other.to_string(),
        };
        let set = vec![SweepSetting { key: KeyPath::from_dotted(key), value, key_place, value_place }];
        Self { label, value: number, set }
    }
}

/// Writes labels with all digits if four significant digits are not unique.
fn distinguish(points: &mut [SweepPoint]) {
    let mut labels: Vec<String> = points.iter().map(|point| point.label.clone()).collect();
    labels.sort_unstable();
    let before = labels.len();
    labels.dedup();
    if labels.len() < before {
        for point in points {
            if let Some(value) = point.value {
                point.label = ShortNumber(value).to_string();
            }
        }
    }
}

/// Value in TOML notation, short for very large or small numbers.
pub fn toml_text(value: &Value) -> String {
    match value {
        Value::Float(number) if !ShortNumber(*number).is_plain() => ShortNumber(*number).to_string(),
        other => other.to_string(),
    }
}

/// Number with four significant digits, at least all digits before the point, without trailing zeros.
fn trim(number: f64) -> String {
    let rounded = ShortNumber::rounded(number, 4);
    if !rounded.is_plain() {
        return rounded.to_string();
    }
    let digits = if number == 0.0 { 0 } else { (3 - number.abs().log10().floor() as i32).clamp(0, 12) as usize };
    let text = format!("{number:.digits$}");
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_owned() } else { text }
}

/// Checked axes of a design. Fails for the first invalid axis.
pub fn resolve_axes(wires: &[AxisWire]) -> Result<Vec<SweepAxis>, KeyFault> {
    wires.iter().enumerate().map(|(index, axis)| axis.resolve(index)).collect()
}

/// All combinations of points, first axis slowest; without axes one empty combination.
///
/// Fails for too many combinations, and if two axes change the same key.
pub fn combine_points(axes: &[SweepAxis]) -> Result<Vec<Vec<&SweepPoint>>, KeyFault> {
    limits::check_count("sweep", axes.len(), limits::MAX_SWEEP_ENTRIES)?;
    let count = axes.iter().try_fold(1usize, |count, axis| count.checked_mul(axis.points.len())).unwrap_or(usize::MAX);
    if count > MAX_CELLS {
        let sizes: Vec<String> = axes.iter().map(|axis| axis.points.len().to_string()).collect();
        return Err(KeyFault::name(
            KeyPath::from_dotted("sweep"),
            format!("the sweeps make {} = {count} cells", sizes.join(" × ")),
            format!("expected at most {MAX_CELLS} cells"),
            "use fewer points, or fewer sweeps",
        ));
    }
    let mut before: HashSet<&KeyPath> = HashSet::new();
    for (index, axis) in axes.iter().enumerate() {
        let keys = || axis.points.iter().flat_map(|point| &point.set).map(|setting| &setting.key);
        if let Some(again) = keys().find(|key| before.contains(key)) {
            return Err(KeyFault::name(
                KeyPath::from_dotted("sweep").child(index),
                format!("two sweeps change `{again}`"),
                "expected every sweep to change keys of its own",
                "remove one of them, or join them into one sweep with `points`",
            ));
        }
        before.extend(keys());
    }
    let mut cells: Vec<Vec<&SweepPoint>> = vec![Vec::new()];
    for axis in axes {
        cells = cells
            .into_iter()
            .flat_map(|cell| axis.points.iter().map(move |point| cell.iter().copied().chain([point]).collect()))
            .collect();
    }
    Ok(cells)
}

/// Sets a key in a document and creates missing tables; numbers in the path are list indices from 0.
///
/// Fails if the path passes through a value, or beyond the end of a list.
pub fn set_key(document: &mut Table, key: &KeyPath, value: Value) -> Result<(), KeyFault> {
    let fault = |problem: String, expected: String| KeyFault::name(key.clone(), problem, expected, "change the key");
    let mut place = document;
    let mut parts = key.names().iter().peekable();
    while let Some(part) = parts.next() {
        if parts.peek().is_none() {
            place.insert(part.clone(), value);
            return Ok(());
        }
        let mut next = place.entry(part.clone()).or_insert_with(|| Value::Table(Table::new()));
        while let Value::Array(items) = next {
            let index = parts.next().map_or("", String::as_str);
            let length = items.len();
            next = index.parse().ok().and_then(|index: usize| items.get_mut(index)).ok_or_else(|| {
                fault(
                    format!("`{part}` has {length} entries, and `{index}` is none of them"),
                    format!("expected a number from 0 to {}", length.saturating_sub(1)),
                )
            })?;
            if parts.peek().is_none() {
                *next = value;
                return Ok(());
            }
        }
        place = next
            .as_table_mut()
            .ok_or_else(|| fault(format!("`{part}` is a value"), "nothing can be set below a value".to_owned()))?;
    }
    Ok(())
}

#[cfg(test)]
mod tests;
