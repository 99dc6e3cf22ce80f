//! Tables of what criterion has measured: the time of every work, its ratio to what stands beside it, the limit, and
//! whether that is met.

use std::fs;
use std::path::Path;

use report::number::{self, MISSING, significant};
use report::{Table, TableColumn};
use serde::Deserialize;

use crate::work::{Cores, Group, Reach, Row, Work};

/// A quantity with a 95 % interval.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Measured {
    /// Its value.
    pub value: f64,
    /// 95 % interval of it.
    pub interval: [f64; 2],
}

impl Measured {
    fn half_width(&self) -> f64 {
        0.5 * (self.interval[1] - self.interval[0])
    }

    fn times(self, factor: f64) -> Self {
        Self { value: self.value * factor, interval: self.interval.map(|end| end * factor) }
    }

    /// This over another quantity that was measured apart from it; the interval is that of the worst case.
    fn over(self, other: &Self) -> Self {
        let interval = [self.interval[0] / other.interval[1], self.interval[1] / other.interval[0]];
        Self { value: self.value / other.value, interval }
    }

    /// Whether it is at most a limit, in words; the interval may leave that open.
    fn at_most(&self, limit: f64) -> &'static str {
        let is_open = self.interval[0] <= limit && limit <= self.interval[1];
        match (self.value <= limit, is_open) {
            (true, false) => "met",
            (true, true) => "met, within noise",
            (false, true) => "missed, within noise",
            (false, false) => "missed",
        }
    }
}

/// A row that was measured.
#[derive(Debug, Clone)]
pub struct Line {
    row: Row,
    /// Its time, s per unit.
    time: Measured,
    /// Time of what stands beside it, s per unit.
    beside: Option<Measured>,
    /// What is held against a ratio to be reached: time over time beside, or the share of all cores that is used.
    ratio: Option<Measured>,
}

impl Line {
    fn of(row: &Row, time: Measured, beside: Option<Measured>) -> Self {
        let ratio = beside.map(|beside| match row.reach {
            Some(Reach::Scaling(_)) => beside.over(&time).times(1.0 / cores()),
            _ => time.over(&beside),
        });
        Self { row: row.clone(), time, beside, ratio }
    }

    /// Whether the limit is met; `None` where there is none, or where what stands beside was not measured.
    fn verdict(&self) -> Option<&'static str> {
        match self.row.reach? {
            Reach::Ratio(limit) => Some(self.ratio?.at_most(limit)),
            Reach::Time(limit) => Some(self.time.at_most(limit)),
            Reach::Scaling(limit) => {
                let Measured { value, interval: [low, high] } = self.ratio?;
                Some(Measured { value: -value, interval: [-high, -low] }.at_most(-limit))
            }
        }
    }

    /// The limit in words.
    fn limit(&self) -> String {
        match self.row.reach {
            None => MISSING.to_owned(),
            Some(Reach::Ratio(limit)) => format!("≤ {}", significant(limit, 2)),
            Some(Reach::Time(limit)) => format!("< {}", in_unit(limit, |size| significant(limit / size, 3))),
            Some(Reach::Scaling(limit)) => format!("≥ {} of the cores", significant(limit, 2)),
        }
    }

    /// The same for machines: SI, seven digits, empty where there is no number.
    pub fn record(&self, group: &str) -> [String; 14] {
        let exact = |value: f64| format!("{value:.6e}");
        let work = &self.row.work;
        let ratio = |value: fn(&Measured) -> f64| self.ratio.as_ref().map_or_else(String::new, |r| exact(value(r)));
        [
            group.to_owned(),
            work.name.clone(),
            if work.cores == Cores::All { cores() } else { 1.0 }.to_string(),
            work.units.to_string(),
            exact(self.time.value),
            exact(self.time.interval[0]),
            exact(self.time.interval[1]),
            self.row.beside.as_ref().map_or_else(String::new, |beside| beside.name.clone()),
            self.beside.map_or_else(String::new, |beside| exact(beside.value)),
            ratio(|ratio| ratio.value),
            ratio(|ratio| ratio.interval[0]),
            ratio(|ratio| ratio.interval[1]),
            self.row.reach.map_or_else(String::new, |_| self.limit()),
            self.verdict().unwrap_or_default().to_owned(),
        ]
    }
}

/// Threads that work on all cores takes.
fn cores() -> f64 {
    rayon::current_num_threads() as f64
}

/// The rows of a group that criterion has measured into a folder.
pub fn lines(group: &Group, criterion: &Path) -> Vec<Line> {
    let time = |work: &Work| {
        let found = estimate(&criterion.join(group.name).join(&work.name).join("new/estimates.json"))?;
        Some(found.times(1.0 / work.units))
    };
    let line = |row: &Row| Some(Line::of(row, time(&row.work)?, row.beside.as_ref().and_then(|beside| time(beside))));
    group.rows.iter().filter_map(line).collect()
}

#[derive(Deserialize)]
struct Estimates {
    mean: Estimate,
    slope: Option<Estimate>,
}

#[derive(Deserialize)]
struct Estimate {
    confidence_interval: Interval,
    point_estimate: f64,
}

#[derive(Deserialize)]
struct Interval {
    lower_bound: f64,
    upper_bound: f64,
}

/// What criterion found, s per go: the slope of time over goes, or the mean where all samples have as many goes. `None`
/// where nothing was measured.
fn estimate(path: &Path) -> Option<Measured> {
    let Estimates { mean, slope } = serde_json::from_str(&fs::read_to_string(path).ok()?).ok()?;
    let typical = slope.unwrap_or(mean);
    let Interval { lower_bound, upper_bound } = typical.confidence_interval;
    let nanoseconds = Measured { value: typical.point_estimate, interval: [lower_bound, upper_bound] };
    Some(nanoseconds.times(1e-9))
}

/// The table of a group.
pub fn table(lines: &[Line]) -> Table {
    let mut table = Table::new([
        TableColumn::left("work"),
        TableColumn::left("time"),
        TableColumn::left("beside it"),
        TableColumn::left("its time"),
        TableColumn::decimal("ratio"),
        TableColumn::left("reach"),
        TableColumn::left("verdict"),
    ]);
    for line in lines {
        let work = &line.row.work;
        let unit = if work.units > 1.0 { " per unit" } else { "" };
        let threads = if work.cores == Cores::All { format!(" ({} threads)", cores()) } else { String::new() };
        table.push([
            format!("{}{threads}", work.name),
            measured_time(&line.time) + unit,
            line.row.beside.as_ref().map_or(MISSING, |beside| &beside.name).to_owned(),
            line.beside.as_ref().map_or(MISSING.to_owned(), measured_time),
            line.ratio.as_ref().map_or(MISSING.to_owned(), plus_minus),
            line.limit(),
            line.verdict().unwrap_or_default().to_owned(),
        ]);
    }
    table
}

/// A value and half of its interval; alone where there is no interval.
fn plus_minus(value: &Measured) -> String {
    match value.half_width() {
        half if half > 0.0 => number::with_uncertainty(value.value, Some(half)),
        _ => significant(value.value, 3),
    }
}

const UNITS: [(f64, &str); 4] = [(1e-9, "ns"), (1e-6, "µs"), (1e-3, "ms"), (1.0, "s")];

/// A time (s) in the unit that suits it, whose size in s is given to `show`.
fn in_unit(seconds: f64, show: impl Fn(f64) -> String) -> String {
    let (size, name) = UNITS.into_iter().rev().find(|(size, _)| seconds >= *size).unwrap_or(UNITS[0]);
    format!("{} {name}", show(size))
}

fn measured_time(value: &Measured) -> String {
    in_unit(value.value, |size| plus_minus(&value.times(1.0 / size)))
}

#[cfg(test)]
mod tests {
    use super::*;

    const FOUND: &str = r#"{
        "mean": {"confidence_interval": {"confidence_level": 0.95, "lower_bound": 190.0, "upper_bound": 210.0},
                 "point_estimate": 200.0, "standard_error": 5.0},
        "median": {}, "median_abs_dev": {}, "slope": null, "std_dev": {} }"#;

    fn group() -> Group {
        let mut group = Group::new("group", "Group", "");
        let rival = group.alone(Work::new("rival", || ()), None);
        group.beside(Work::new("own", || ()), &rival, Some(Reach::Ratio(2.0)));
        group
    }

    fn measured(value: f64, half: f64) -> Measured {
        Measured { value, interval: [value - half, value + half] }
    }

    #[test]
    fn what_criterion_stored_is_read() {
        let folder = tempfile::tempdir().expect("a folder");
        let store = |work: &str, text: &str| {
            let new = folder.path().join("group").join(work).join("new");
            fs::create_dir_all(&new).expect("a folder");
            fs::write(new.join("estimates.json"), text).expect("a file");
        };
        store("own", FOUND);
        // Where the rival was not measured there is no ratio.
        let [line] = lines(&group(), folder.path()).try_into().expect("one line");
        assert_eq!(line.record("group")[4..8], ["2.000000e-7", "1.900000e-7", "2.100000e-7", "rival"]);
        assert!(line.ratio.is_none() && line.verdict().is_none());
        store("rival", &FOUND.replace("00.0", "50.0"));
        let [_, line] = lines(&group(), folder.path()).try_into().expect("two lines");
        assert!((line.ratio.expect("a rival").value - 0.8).abs() < 1e-12);
        assert_eq!(line.verdict(), Some("met"));
        assert!(table(&[line]).to_markdown().contains("200 ± 10 ns"));
    }

    #[test]
    fn verdicts_say_when_the_noise_decides() {
        assert_eq!(measured(1.0, 0.1).at_most(1.5), "met");
        assert_eq!(measured(1.45, 0.1).at_most(1.5), "met, within noise");
        assert_eq!(measured(1.55, 0.1).at_most(1.5), "missed, within noise");
        assert_eq!(measured(2.0, 0.1).at_most(1.5), "missed");
        // One core is as fast as `share` of all of them makes it.
        let scaling = |share: f64| {
            let row = Row { reach: Some(Reach::Scaling(0.92)), ..group().rows[1].clone() };
            Line::of(&row, measured(1.0, 0.001), Some(measured(share * cores(), 0.001))).verdict()
        };
        assert_eq!((scaling(0.95), scaling(0.5)), (Some("met"), Some("missed")));
    }

    #[test]
    fn times_have_the_unit_that_suits_them() {
        assert_eq!(measured_time(&measured(2.134e-4, 0.4e-5)), "213 ± 4 µs");
        assert_eq!(measured_time(&measured(0.05, 0.0)), "50.0 ms");
    }
}
