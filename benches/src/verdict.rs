//! Rows with their times: ratio to what stands beside, limit, and whether it is met.

use report::number::{self, MISSING, significant};
use report::{Column, Table};

use crate::measure::Measured;
use crate::work::{Cores, Reach, Row};

/// A row that was measured.
#[derive(Debug, Clone)]
pub struct Line {
    /// What was measured.
    pub row: Row,
    /// Its time, s per unit.
    pub time: Measured,
    /// Time of what stands beside it, s per unit.
    pub beside: Option<Measured>,
    /// What is held against a ratio to be reached: time over time beside, or the share of all cores that is used.
    pub ratio: Option<Measured>,
}

/// Whether a limit is met.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Verdict {
    /// It is.
    Met,
    /// It is, but the limit lies within the interval.
    JustMet,
    /// It is not, but the limit lies within the interval.
    JustMissed,
    /// It is not.
    Missed,
}

impl Verdict {
    /// In words.
    pub fn as_str(self) -> &'static str {
        match self {
            Self::Met => "met",
            Self::JustMet => "met, within noise",
            Self::JustMissed => "missed, within noise",
            Self::Missed => "missed",
        }
    }

    /// Whether the value itself meets the limit.
    pub fn is_met(self) -> bool {
        matches!(self, Self::Met | Self::JustMet)
    }

    /// Of a value that should be at most `limit`.
    pub fn at_most(value: &Measured, limit: f64) -> Self {
        match (value.value <= limit, value.interval[0] <= limit && limit <= value.interval[1]) {
            (true, false) => Self::Met,
            (true, true) => Self::JustMet,
            (false, true) => Self::JustMissed,
            (false, false) => Self::Missed,
        }
    }

    /// Of a value that should be at least `limit`.
    pub fn at_least(value: &Measured, limit: f64) -> Self {
        Self::at_most(&value.times(-1.0).swapped(), -limit)
    }
}

impl Measured {
    fn swapped(self) -> Self {
        Self { interval: [self.interval[1], self.interval[0]], ..self }
    }
}

impl Line {
    /// From samples of work and rival that were taken in turn: the ratio is the median of those of every round.
    pub fn paired(row: &Row, own: &[f64], beside: Option<&[f64]>) -> Option<Self> {
        let ratio = |beside: &[f64]| {
            let pairs = own.iter().zip(beside);
            Measured::median(pairs.map(|(own, beside)| ratio(row, *own, *beside)))
        };
        Some(Self {
            row: row.clone(),
            time: Measured::median(own.iter().copied())?,
            beside: beside.and_then(|beside| Measured::median(beside.iter().copied())),
            ratio: beside.and_then(ratio),
        })
    }

    /// From estimates of work and rival that were made apart.
    pub fn apart(row: &Row, time: Measured, beside: Option<Measured>) -> Self {
        let ratio = beside.map(|beside| match row.reach {
            Some(Reach::Scaling(_)) => beside.over(&time).times(1.0 / cores()),
            _ => time.over(&beside),
        });
        Self { row: row.clone(), time, beside, ratio }
    }

    /// Whether the limit is met; `None` where there is none, or where what stands beside was not measured.
    pub fn verdict(&self) -> Option<Verdict> {
        match self.row.reach? {
            Reach::Ratio(limit) => self.ratio.map(|ratio| Verdict::at_most(&ratio, limit)),
            Reach::Time(limit) => Some(Verdict::at_most(&self.time, limit)),
            Reach::Scaling(limit) => self.ratio.map(|ratio| Verdict::at_least(&ratio, limit)),
        }
    }

    /// The limit in words.
    pub fn limit(&self) -> String {
        match self.row.reach {
            None => MISSING.to_owned(),
            Some(Reach::Ratio(limit)) => format!("≤ {}", significant(limit, 2)),
            Some(Reach::Time(limit)) => format!("< {}", time(limit)),
            Some(Reach::Scaling(limit)) => format!("≥ {} of the cores", significant(limit, 2)),
        }
    }
}

fn ratio(row: &Row, own: f64, beside: f64) -> f64 {
    match row.reach {
        Some(Reach::Scaling(_)) => beside / (own * cores()),
        _ => own / beside,
    }
}

/// Threads that work on all cores takes.
pub fn cores() -> f64 {
    rayon::current_num_threads() as f64
}

/// The table of a group.
pub fn table(lines: &[Line]) -> Table {
    let mut table = Table::new([
        Column::left("work"),
        Column::left("time"),
        Column::left("beside it"),
        Column::left("its time"),
        Column::decimal("ratio"),
        Column::left("reach"),
        Column::left("verdict"),
    ]);
    for line in lines {
        let unit = if line.row.work.units > 1.0 { " per unit" } else { "" };
        let threads = if line.row.work.cores == Cores::All { format!(" ({} threads)", cores()) } else { String::new() };
        let beside = line.row.beside.as_ref().map_or(MISSING, |beside| beside.name.as_str());
        table.push([
            format!("{}{threads}", line.row.work.name),
            measured_time(&line.time) + unit,
            beside.to_owned(),
            line.beside.as_ref().map_or(MISSING.to_owned(), measured_time),
            line.ratio.as_ref().map_or(MISSING.to_owned(), plus_minus),
            line.limit(),
            line.verdict().map_or("", Verdict::as_str).to_owned(),
        ]);
    }
    table
}

/// A value and half of its interval; alone where there is no interval.
pub fn plus_minus(value: &Measured) -> String {
    match value.half_width() {
        half if half > 0.0 => number::with_uncertainty(value.value, Some(half)),
        _ => significant(value.value, 3),
    }
}

const UNITS: [(f64, &str); 4] = [(1e-9, "ns"), (1e-6, "µs"), (1e-3, "ms"), (1.0, "s")];

fn unit(seconds: f64) -> (f64, &'static str) {
    UNITS.into_iter().rev().find(|(size, _)| seconds >= *size).unwrap_or(UNITS[0])
}

/// A time in the unit that suits it.
pub fn time(seconds: f64) -> String {
    let (size, name) = unit(seconds);
    format!("{} {name}", significant(seconds / size, 3))
}

/// A time with half of its interval, in the unit that suits it.
pub fn measured_time(value: &Measured) -> String {
    let (size, name) = unit(value.value);
    format!("{} {name}", plus_minus(&value.times(1.0 / size)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::work::{Group, Work};

    fn measured(value: f64, half: f64) -> Measured {
        Measured { value, interval: [value - half, value + half], least: None, samples: 0 }
    }

    #[test]
    fn verdicts_say_when_the_noise_decides() {
        assert_eq!(Verdict::at_most(&measured(1.0, 0.1), 1.5), Verdict::Met);
        assert_eq!(Verdict::at_most(&measured(1.45, 0.1), 1.5), Verdict::JustMet);
        assert_eq!(Verdict::at_most(&measured(1.55, 0.1), 1.5), Verdict::JustMissed);
        assert_eq!(Verdict::at_most(&measured(2.0, 0.1), 1.5), Verdict::Missed);
        assert_eq!(Verdict::at_least(&measured(0.95, 0.01), 0.92), Verdict::Met);
        assert_eq!(Verdict::at_least(&measured(0.93, 0.02), 0.92), Verdict::JustMet);
        assert_eq!(Verdict::at_least(&measured(0.5, 0.02), 0.92), Verdict::Missed);
    }

    #[test]
    fn ratios_are_those_of_every_round() {
        let mut group = Group::new("group", "");
        let rival = group.alone(Work::new("rival", || ()), None);
        group.beside(Work::new("own", || ()), &rival, Some(Reach::Ratio(0.5)));
        // The machine was twice as slow in the second round; the ratio does not see it.
        let line = Line::paired(&group.rows[1], &[1.0, 2.0, 1.0], Some(&[4.0, 8.0, 4.0])).expect("samples");
        assert_eq!(line.ratio.map(|ratio| (ratio.value, ratio.interval)), Some((0.25, [0.25, 0.25])));
        assert_eq!(line.verdict(), Some(Verdict::Met));
        let alone = Line::paired(&group.rows[1], &[1.0], None).expect("samples");
        assert_eq!(alone.verdict(), None);
    }

    #[test]
    fn times_have_the_unit_that_suits_them() {
        assert_eq!(time(2.1e-4), "210 µs");
        assert_eq!(time(0.05), "50.0 ms");
        assert_eq!(measured_time(&measured(2.134e-4, 0.4e-5)), "213 ± 4 µs");
    }
}
