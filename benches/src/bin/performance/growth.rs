//! How time grows with the samples of a record, and the exponent of any such growth.

use std::time::Duration;

use identify::registry;
use kempf_benches::measure::{Effort, Measured, in_turn};
use kempf_benches::process::Outcome;
use kempf_benches::records::{K, KEY, PERIOD, T, first_order_zig_zag};
use kempf_benches::work::Work;
use kempf_benches::{rivals, works};

use campaign::collect::in_memory;
use scenario::Scenario;
use ship::FirstOrder;

use crate::say;

/// A time beyond this, s, is not waited for.
const LIMIT: f64 = 60.0;

/// Sizes that take part in an exponent: the largest one and those down to a hundredth of it.
const DECADES: f64 = 2.0;

const EFFORT: Effort = Effort { rounds: 9, fewest: 1, sample: Duration::from_millis(5), limit: Duration::from_secs(5) };

/// Time over a size.
#[derive(Debug, Clone)]
pub struct Growth {
    /// Whose time.
    pub name: String,
    /// Size and time, s.
    pub points: Vec<(f64, Measured)>,
    /// Sizes at which there was no answer.
    pub refused: Vec<usize>,
    /// Sizes at which the answer was far from the ship: its time says little.
    pub wrong: Vec<usize>,
    /// First size that would have taken too long, and how long it would have taken, s.
    pub cut: Option<(usize, f64)>,
}

/// t = a n + b.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Line {
    /// a, s per sample.
    pub per_sample: f64,
    /// b, s.
    pub fixed: f64,
    /// Largest relative error at the sizes it is fitted to.
    pub worst: f64,
    /// Smallest and largest of these sizes.
    pub range: [f64; 2],
}

/// t ∝ n^p.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Exponent {
    /// p.
    pub value: f64,
    /// Its standard error.
    pub standard_error: f64,
    /// Smallest and largest size it is fitted to.
    pub range: [f64; 2],
}

impl Growth {
    /// The straight line of least relative error; `None` below two sizes.
    pub fn line(&self) -> Option<Line> {
        let sum = |value: &dyn Fn(f64, f64) -> f64| self.points.iter().map(|(n, t)| value(*n, t.value)).sum::<f64>();
        // Normal equations of Σ ((a n + b)/t − 1)².
        let (nn, n1) = (sum(&|n, t| (n / t).powi(2)), sum(&|n, t| n / (t * t)));
        let (one, nt, t1) = (sum(&|_, t| 1.0 / (t * t)), sum(&|n, t| n / t), sum(&|_, t| 1.0 / t));
        let determinant = nn * one - n1 * n1;
        let (per_sample, fixed) = ((nt * one - t1 * n1) / determinant, (nn * t1 - n1 * nt) / determinant);
        let off = |(n, t): &(f64, Measured)| ((per_sample * n + fixed) / t.value - 1.0).abs();
        let worst = self.points.iter().map(off).fold(0.0, f64::max);
        let range = [self.points.first()?.0, self.points.last()?.0];
        (self.points.len() > 1).then_some(Line { per_sample, fixed, worst, range })
    }

    /// Of these points, all of them measured.
    pub fn new(name: &str, points: Vec<(f64, Measured)>) -> Self {
        Self { name: name.to_owned(), points, refused: Vec::new(), wrong: Vec::new(), cut: None }
    }

    /// Least squares of ln t on ln n over the upper decades; `None` below three sizes.
    pub fn exponent(&self) -> Option<Exponent> {
        let largest = self.points.last()?.0;
        let smallest = largest / 10_f64.powf(DECADES) * (1.0 - 1e-9);
        let points: Vec<(f64, f64)> = self
            .points
            .iter()
            .filter(|(size, _)| *size >= smallest)
            .map(|(size, time)| (size.ln(), time.value.ln()))
            .collect();
        let count = points.len() as f64;
        let mean = |values: &dyn Fn(&(f64, f64)) -> f64| points.iter().map(values).sum::<f64>() / count;
        let (x, y) = (mean(&|point| point.0), mean(&|point| point.1));
        let spread: f64 = points.iter().map(|point| (point.0 - x).powi(2)).sum();
        let value = points.iter().map(|point| (point.0 - x) * (point.1 - y)).sum::<f64>() / spread;
        let left: f64 = points.iter().map(|point| (point.1 - y - value * (point.0 - x)).powi(2)).sum();
        let standard_error = (left / (count - 2.0) / spread).sqrt();
        let range = [points.first()?.0.exp(), largest];
        (points.len() > 2).then_some(Exponent { value, standard_error, range })
    }

    /// What the next size would take if it goes on as between the last two sizes, but at least in proportion, s.
    fn expected(&self, next: f64) -> f64 {
        match self.points[..] {
            [.., (n1, t1), (n2, t2)] => {
                let exponent = (t2.value / t1.value).ln() / (n2 / n1).ln();
                t2.value * (next / n2).powf(exponent.max(1.0))
            }
            _ => 0.0,
        }
    }
}

/// Lengths of the trials that the cost of a trial is measured on, s; a sample a second.
const LENGTHS: [u32; 4] = [150, 270, 540, 1080];

/// Trials of each length.
const TRIALS: u64 = 48;
const QUICK_TRIALS: u64 = 2;

/// Time of one trial of a study, with all its methods and what is computed beside them, over its samples: on one
/// thread, rows kept in memory.
pub fn of_trials(quick: bool) -> Outcome<Growth> {
    let effort = if quick { Effort { rounds: 1, ..EFFORT } } else { EFFORT };
    let trials = if quick { QUICK_TRIALS } else { TRIALS };
    let document: toml::Table = std::fs::read_to_string(works::throughput())?.parse()?;
    let work = |length: u32| -> Outcome<Work> {
        let mut document = document.clone();
        let recording = document.get_mut("recording").and_then(toml::Value::as_table_mut).ok_or("no recording")?;
        recording.insert("duration-s".to_owned(), f64::from(length).into());
        document.insert("replicates".to_owned(), (trials as i64).into());
        let scenario = Scenario::parse(&works::throughput(), "throughput", toml::to_string(&document)?, None)
            .map_err(|failure| failure.to_string())?;
        let work = Work::new(format!("{length} s"), move || in_memory(&scenario).1.len());
        Ok(work.of_units(trials as usize))
    };
    let works: Vec<Work> = LENGTHS.into_iter().map(work).collect::<Outcome<_>>()?;
    let samples = in_turn(&works.iter().collect::<Vec<_>>(), &effort);
    let points = LENGTHS.into_iter().zip(samples);
    let points = points.filter_map(|(length, times)| Some((f64::from(length) + 1.0, Measured::median(times)?)));
    Ok(Growth::new("one trial", points.collect()))
}

/// Sizes of records: half decades.
fn sizes(quick: bool) -> Vec<usize> {
    let last = if quick { 7 } else { 12 };
    (4..=last).map(|half| 10_f64.powf(0.5 * f64::from(half)).round() as usize).collect()
}

/// Simulation, every method and the rival, on records of a hundred rows to a million, half a second apart.
pub fn with_samples(quick: bool) -> Vec<Growth> {
    let effort = if quick { Effort { rounds: 1, ..EFFORT } } else { EFFORT };
    let methods =
        registry::defaults().into_iter().map(|settings| settings.build().expect("default settings are valid"));
    let methods: Vec<_> = methods.collect();
    let mut growths: Vec<Growth> = std::iter::once("simulation")
        .chain(methods.iter().map(|method| method.id()))
        .chain([works::RIVAL])
        .map(|name| Growth::new(name, Vec::new()))
        .collect();
    for size in sizes(quick) {
        if !quick {
            say(&format!("{size} samples"));
        }
        let simulation = first_order_zig_zag(size);
        let Ok(simulated) = simulation.run(&KEY) else { continue };
        let trial = simulated.trial;
        time(&mut growths[0], size, &effort, Work::new("simulation", move || simulation.run(&KEY)));
        let [u, y, _] = rivals::columns(&trial);
        let rival = move || rivals::srivc_heading(&u, &y, PERIOD, rivals::BANDWIDTH);
        let [own @ .., theirs] = &mut growths[1..] else { unreachable!("a simulation, methods and a rival") };
        time(theirs, size, &effort, Work::answering(works::RIVAL, 1.0, rival));
        for (growth, settings) in own.iter_mut().zip(registry::defaults()) {
            let (trial, method) = (trial.clone(), settings.build().expect("default settings are valid"));
            // A method that refuses a short record has no time.
            if growth.expected(size as f64) <= LIMIT {
                match method.identify(std::slice::from_ref(&trial)) {
                    Err(_) => {
                        growth.refused.push(size);
                        continue;
                    }
                    Ok(estimate) if is_far(&estimate.response) => growth.wrong.push(size),
                    Ok(_) => {}
                }
            }
            time(growth, size, &effort, Work::new(method.id(), move || method.identify(std::slice::from_ref(&trial))));
        }
    }
    growths
}

/// Whether K or T is off by more than half, which no method is on a record that suits it.
fn is_far(found: &FirstOrder) -> bool {
    let off = |found: f64, truth: f64| (found / truth - 1.0).abs() > 0.5;
    off(found.K(), K) || off(found.T(), T)
}

fn time(growth: &mut Growth, size: usize, effort: &Effort, work: Work) {
    let expected = growth.expected(size as f64);
    if expected > LIMIT {
        growth.cut = growth.cut.or(Some((size, expected)));
        return;
    }
    let samples = in_turn(&[&work], effort);
    if let Some(measured) = Measured::median(samples.into_iter().flatten()) {
        growth.points.push((size as f64, measured));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn power(exponent: f64) -> Growth {
        let time = |n: f64| Measured { value: n.powf(exponent), interval: [0.0, 1.0], least: None, samples: 1 };
        Growth::new("power", (2..=6).map(|decade| 10_f64.powi(decade)).map(|n| (n, time(n))).collect())
    }

    #[test]
    fn exponents_are_those_of_the_upper_decades() {
        let mut growth = power(1.5);
        // The small sizes do not count.
        growth.points[0].1.value = 1e9;
        let found = growth.exponent().expect("five sizes");
        assert!((found.value - 1.5).abs() < 1e-12 && found.standard_error < 1e-9);
        assert!((found.range[0] - 1e4).abs() < 1e-6);
        assert_eq!(Growth { points: growth.points[..2].to_vec(), ..growth }.exponent(), None);
    }

    #[test]
    fn a_line_is_found_again() {
        let time = |n: f64| Measured { value: 3.0 * n + 15.0, interval: [0.0, 1.0], least: None, samples: 1 };
        let growth = Growth::new("line", [100.0, 1000.0, 10_000.0].map(|n| (n, time(n))).to_vec());
        let found = growth.line().expect("three sizes");
        assert!((found.per_sample - 3.0).abs() < 1e-9 && (found.fixed - 15.0).abs() < 1e-6 && found.worst < 1e-9);
        assert_eq!(found.range, [100.0, 10_000.0]);
    }

    #[test]
    fn what_would_take_too_long_is_foreseen() {
        assert!((power(2.0).expected(1e7) - 1e14).abs() < 1e3);
        assert!((power(0.5).expected(1e7) - 1e4).abs() < 1e-3, "at least in proportion");
    }
}
