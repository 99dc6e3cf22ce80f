//! Durations of simulation and identification: the only result that depends on the machine, stored separately from the
//! rows.

use std::collections::BTreeMap;
use std::time::Duration;

use serde::{Deserialize, Serialize};

use crate::design::Design;
use crate::failure::Failure;
use crate::statistics::Moments;

/// Name of the simulation among the methods.
const SIMULATION: &str = "(simulation)";

/// Wall times of the simulation and the methods of one trial.
pub struct TrialTiming {
    /// Index of the cell.
    pub cell: u64,
    /// Duration of the simulation.
    pub simulation: Duration,
    /// Duration of every method, in the order of the scenario; empty if the simulation failed.
    pub methods: Vec<Duration>,
}

/// Line of `timings.csv`: durations of one method in one cell.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TimingLine {
    cell: u64,
    method: String,
    trials: u64,
    mean_us: f64,
    sd_us: f64,
    shortest_us: f64,
}

/// Durations of simulation and methods in a study or a part of it.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Timings {
    /// Moments, µs, by cell and index: 0 is the simulation, followed by the methods.
    times: BTreeMap<(u64, usize), Moments>,
}

impl Timings {
    /// Adds a trial.
    pub fn add(&mut self, timing: &TrialTiming) {
        for (place, time) in [&timing.simulation].into_iter().chain(&timing.methods).enumerate() {
            self.times.entry((timing.cell, place)).or_default().add(time.as_secs_f64() * 1e6);
        }
    }

    /// Adds the durations of another part.
    pub fn merge(&mut self, other: &Self) {
        other.times.iter().for_each(|(place, times)| self.times.entry(*place).or_default().merge(times));
    }

    /// Mean duration of a method over all trials and its standard error, µs; `None` without trials.
    pub fn mean_us(&self, method: usize) -> Option<(f64, f64)> {
        let mut all = Moments::default();
        self.times.iter().filter(|((_, place), _)| *place == 1 + method).for_each(|(_, times)| all.merge(times));
        (all.count > 0.0).then(|| (all.mean, all.sd() / all.count.sqrt()))
    }

    /// Lines of all timed cells and methods.
    pub fn timing_lines<'a>(&'a self, design: &'a Design) -> impl Iterator<Item = TimingLine> + 'a {
        let names: Vec<&str> = names(design).collect();
        self.times.iter().map(move |(&(cell, place), times)| TimingLine {
            cell,
            method: names[place].to_owned(),
            trials: times.count as u64,
            mean_us: to_the_nanosecond(times.mean),
            sd_us: to_the_nanosecond(times.sd()),
            shortest_us: to_the_nanosecond(times.min_value),
        })
    }

    /// Durations from lines; methods outside the design are omitted.
    pub fn from_timing_lines(lines: impl IntoIterator<Item = TimingLine>, design: &Design) -> Self {
        let times = lines.into_iter().filter_map(|line| {
            let place = names(design).position(|name| name == line.method)?;
            let count = line.trials as f64;
            let second = line.sd_us.powi(2) * (line.trials.saturating_sub(1)) as f64;
            let (mean, smallest) = (line.mean_us, line.shortest_us);
            Some((
                (line.cell, place),
                Moments { count, mean, squared_deviation_sum: second, min_value: smallest, ..Moments::default() },
            ))
        });
        Self { times: times.collect() }
    }

    /// Text of `timings.csv`.
    pub fn to_csv(&self, design: &Design) -> Result<Vec<u8>, Failure> {
        let refuse = |error: &dyn std::fmt::Display| Failure::execution(format!("failed to write timings: {error}"));
        let mut file = csv::Writer::from_writer(Vec::new());
        self.timing_lines(design).try_for_each(|line| file.serialize(line)).map_err(|error| refuse(&error))?;
        file.into_inner().map_err(|error| refuse(&error))
    }

    /// Durations from the text of `timings.csv`; methods outside the design are omitted. Fails for an invalid text.
    pub fn from_csv(text: &[u8], design: &Design) -> Result<Self, String> {
        let lines = csv::Reader::from_reader(text).into_deserialize().collect::<Result<Vec<TimingLine>, _>>();
        Ok(Self::from_timing_lines(lines.map_err(|error| error.to_string())?, design))
    }
}

/// Names of what is timed: the simulation, then every method.
fn names(design: &Design) -> impl Iterator<Item = &str> {
    std::iter::once(SIMULATION).chain(design.methods.iter().map(|method| method.label.as_str()))
}

/// Duration in µs, rounded to the nanosecond.
fn to_the_nanosecond(time: f64) -> f64 {
    (time * 1e3).round() / 1e3
}
