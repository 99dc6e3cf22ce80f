//! The design of a study: axes over any keys of the scenario, and their product as cells.
//!
//! A point of an axis sets one key or several; the changed document is resolved like any scenario, so a swept value is
//! checked as strictly as one that is written down.

use std::collections::HashSet;

use serde::{Deserialize, Serialize};
use ship::ShortNumber;
use toml::{Table, Value};

use crate::scenario::key_words::in_words;
use crate::scenario::limits;
use crate::scenario::name;
use crate::scenario::part::ScenarioPart;
use crate::scenario::problem::{AtFault, KeyFault, KeyPath, of_text};

/// Largest number of cells; more is a mistake in a range.
const MOST_CELLS: usize = 100_000;

/// An axis as it is written: `[[sweep]]`.
#[derive(Debug, Clone, Deserialize, Serialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct AxisWire {
    /// Name on plots and in tables; the key when it is left out.
    name: Option<String>,
    /// Dotted key that is swept, with `values`, `linear` or `log`.
    key: Option<String>,
    /// The values one by one.
    #[schemars(with = "Option<Vec<serde_json::Value>>")]
    values: Option<Vec<Value>>,
    /// Evenly spaced values.
    linear: Option<RangeWire>,
    /// Evenly spaced values of the logarithm.
    log: Option<RangeWire>,
    /// Points that set several keys at once.
    points: Option<Vec<PointWire>>,
}

/// A range of numbers, both ends included.
#[derive(Debug, Clone, Copy, Deserialize, Serialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
struct RangeWire {
    /// First value.
    from: f64,
    /// Last value.
    to: f64,
    /// How many values.
    points: usize,
}

/// A point that sets several keys.
#[derive(Debug, Clone, Deserialize, Serialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
struct PointWire {
    /// What it is called.
    label: String,
    /// Where it lies on an axis of numbers; of an effect its size, which the label has, too (wind 0.7°).
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
    /// The points in order.
    pub points: Vec<SweepPoint>,
}

/// One point of an axis.
#[derive(Debug, Clone, PartialEq)]
pub struct SweepPoint {
    /// What it is called.
    pub label: String,
    /// Its value, where the axis is a number.
    pub value: Option<f64>,
    /// The keys it sets.
    pub set: Vec<SweepSetting>,
}

/// A key that a point sets.
#[derive(Debug, Clone, PartialEq)]
pub struct SweepSetting {
    /// The key that is changed.
    pub key: KeyPath,
    /// The value it gets.
    pub value: Value,
    /// Where the file names the key.
    pub key_place: KeyPath,
    /// Where the file says the value.
    pub value_place: KeyPath,
}

impl SweepSetting {
    /// Whether its key is one that a sweep may change.
    fn check(&self) -> Result<(), KeyFault> {
        limits::depth(&self.key, &self.key_place)?;
        let first = self.key.parts().first().map_or("", String::as_str);
        if first.is_empty() || matches!(ScenarioPart::of(first), ScenarioPart::Prose | ScenarioPart::Study) {
            let found = match first {
                "" => "the sweep names no key".to_owned(),
                _ => format!("the sweep changes `{}`, which is the same for the whole study", self.key),
            };
            return Err(KeyFault {
                mark: if self.key_place == self.value_place { AtFault::Name } else { AtFault::Value },
                ..KeyFault::value(
                    self.key_place.clone(),
                    found,
                    "expected a key of the trial or of a method",
                    "for instance `sensor.heading-noise-deg`, `ship.first-order.T-s`, `identifier.0.method.srivc.max-iterations`",
                )
            });
        }
        Ok(())
    }

    /// The problem of a changed scenario, moved to the sweep that caused it; `cell` names the cell where it helps.
    pub fn attributed(&self, problem: KeyFault, cell: Option<&str>) -> KeyFault {
        let (place, mark) = match problem.mark {
            // Where the point itself names the key, its name is underlined and not its value.
            AtFault::Name if self.key_place == self.value_place => (self.key_place.clone(), AtFault::Name),
            AtFault::Name => (self.key_place.clone(), AtFault::Value),
            AtFault::Value => (self.value_place.clone(), AtFault::Value),
            AtFault::Within(_) => {
                let below = problem.key.parts().strip_prefix(self.key.parts()).unwrap_or_default();
                (below.iter().fold(self.value_place.clone(), |key, part| key.child(part)), problem.mark)
            }
        };
        let cell = cell.map_or_else(String::new, |cell| format!(" (cell {cell})"));
        let mut found = format!("the sweep sets `{}` to {}{cell}", self.key, written(&self.value));
        // "to −1: `key` is −1" would say it twice.
        if !problem.found.starts_with(&format!("`{}` is", self.key)) {
            found = format!("{found}: {}", problem.found);
        }
        KeyFault { key: place, mark, found, ..problem }
    }
}

impl AxisWire {
    /// Checks an axis; `index` is its place in the `sweep` array.
    pub fn resolve(&self, index: usize) -> Result<SweepAxis, KeyFault> {
        let place = KeyPath::dotted("sweep").child(index);
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
            return Err(KeyFault::of(
                key,
                value,
                "expected a finite number",
                "give the place of the point on its axis",
            ));
        }
        distinguish(&mut points);
        let name =
            self.name.clone().or_else(|| self.key.as_deref().map(in_words)).unwrap_or_else(|| "point".to_owned());
        self.check_names(&place, &name, &points)?;
        Ok(SweepAxis { name, points })
    }

    /// The points, as they are written or spread over a range.
    fn points(&self, place: &KeyPath) -> Result<Vec<SweepPoint>, KeyFault> {
        let single =
            |key: &str, value: Value, value_place: KeyPath| SweepPoint::of(key, value, place.child("key"), value_place);
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
                    "this sweep does not say what it changes and how",
                    "expected `key` with one of `values`, `linear` and `log`, or `points` alone",
                    "for instance `key = \"sensor.heading-noise-deg\"` and `values = [0.01, 0.1, 1.0]`",
                ));
            }
        })
    }

    /// Whether the axis and its points have names that can be printed, each point one of its own.
    fn check_names(&self, place: &KeyPath, name: &str, points: &[SweepPoint]) -> Result<(), KeyFault> {
        for (i, point) in points.iter().enumerate() {
            name::label(&point.label).map_err(|unfit| {
                let (key, advice) = match &self.points {
                    Some(_) => (place.child("points").child(i).child("label"), "change the label"),
                    None => (place.child("values").child(i), "give the value a shorter name: a `label` under `points`"),
                };
                KeyFault { advice: advice.to_owned(), ..of_text(key, &point.label, unfit) }
            })?;
        }
        name::label(name).map_err(|unfit| {
            let key = if self.name.is_some() { "name" } else { "key" };
            KeyFault { advice: "give the sweep a short `name`".to_owned(), ..of_text(place.child(key), name, unfit) }
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
                key: KeyPath::dotted(key),
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
            return Err(self.problem(place, "expected finite ends"));
        }
        let step = (self.to - self.from) / (self.points.max(2) - 1) as f64;
        self.spread(place, |k| self.from + k as f64 * step)
    }

    fn log(&self, place: &KeyPath) -> Result<Vec<f64>, KeyFault> {
        if !(self.from > 0.0 && self.to > 0.0) {
            return Err(self.problem(place, "expected both ends of a logarithmic range to be above 0"));
        }
        if !(self.from.is_finite() && self.to.is_finite()) {
            return Err(self.problem(place, "expected finite ends"));
        }
        // Evenly spaced shares of the range of the logarithm.
        let ratio = (self.to / self.from).ln();
        self.spread(place, |k| self.from * (ratio * k as f64 / (self.points - 1) as f64).exp())
    }

    /// The values: between the ends, which are exact, those at a place.
    fn spread(&self, place: &KeyPath, between: impl Fn(usize) -> f64) -> Result<Vec<f64>, KeyFault> {
        let Self { from, to, points } = *self;
        if !(2..=MOST_CELLS).contains(&points) {
            return Err(self.problem(place, &format!("expected 2 to {MOST_CELLS} points")));
        }
        Ok(std::iter::once(from).chain((1..points - 1).map(between)).chain([to]).collect())
    }

    fn problem(&self, place: &KeyPath, expected: &str) -> KeyFault {
        let found =
            format!("a range of {} points from {} to {}", self.points, ShortNumber(self.from), ShortNumber(self.to));
        KeyFault::name(place.clone(), found, expected, "change the range, or write the `values` one by one")
    }
}

impl SweepPoint {
    fn of(key: &str, value: Value, key_place: KeyPath, value_place: KeyPath) -> Self {
        let number = value.as_float().or_else(|| value.as_integer().map(|integer| integer as f64));
        let label = match (&value, number) {
            (_, Some(number)) => trim(number),
            (Value::String(text), None) => text.clone(),
            (other, None) => other.to_string(),
        };
        let set = vec![SweepSetting { key: KeyPath::dotted(key), value, key_place, value_place }];
        Self { label, value: number, set }
    }
}

/// Gives numbers all their digits where four are too few to tell points apart.
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

/// A value as a person would write it.
pub fn written(value: &Value) -> String {
    match value {
        Value::Float(number) if !ShortNumber(*number).is_plain() => ShortNumber(*number).to_string(),
        other => other.to_string(),
    }
}

/// A number with four significant digits, more where they stand before the point, and no trailing zeros.
fn trim(number: f64) -> String {
    let rounded = ShortNumber::rounded(number, 4);
    if !rounded.is_plain() {
        return rounded.to_string();
    }
    let digits = if number == 0.0 { 0 } else { (3 - number.abs().log10().floor() as i32).clamp(0, 12) as usize };
    let text = format!("{number:.digits$}");
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_owned() } else { text }
}

/// The axes of a design.
pub fn axes(wires: &[AxisWire]) -> Result<Vec<SweepAxis>, KeyFault> {
    wires.iter().enumerate().map(|(index, axis)| axis.resolve(index)).collect()
}

/// Every combination of points, the first axis slowest; one empty combination when there is no axis.
///
/// Fails when there are too many, and when two axes change the same key.
pub fn product(axes: &[SweepAxis]) -> Result<Vec<Vec<&SweepPoint>>, KeyFault> {
    limits::entries("sweep", axes.len(), limits::MOST_SWEEPS)?;
    let count = axes.iter().try_fold(1usize, |count, axis| count.checked_mul(axis.points.len())).unwrap_or(usize::MAX);
    if count > MOST_CELLS {
        let sizes: Vec<String> = axes.iter().map(|axis| axis.points.len().to_string()).collect();
        return Err(KeyFault::name(
            KeyPath::dotted("sweep"),
            format!("the sweeps make {} = {count} cells", sizes.join(" × ")),
            format!("expected at most {MOST_CELLS} cells"),
            "use fewer points, or fewer sweeps",
        ));
    }
    let mut before: HashSet<&KeyPath> = HashSet::new();
    for (index, axis) in axes.iter().enumerate() {
        let keys = || axis.points.iter().flat_map(|point| &point.set).map(|setting| &setting.key);
        if let Some(again) = keys().find(|key| before.contains(key)) {
            return Err(KeyFault::name(
                KeyPath::dotted("sweep").child(index),
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

/// Sets a key in a document, making tables on the way; numbers in the path count the entries of lists from 0.
///
/// Fails when the path leads through something that is neither table nor list, or beyond the end of a list.
pub fn set(document: &mut Table, key: &KeyPath, value: Value) -> Result<(), KeyFault> {
    let fault = |problem: String, expected: String| KeyFault::name(key.clone(), problem, expected, "change the key");
    let mut place = document;
    let mut parts = key.parts().iter().peekable();
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
