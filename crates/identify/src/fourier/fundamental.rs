//! The fundamental w of the series: by local search from stated starts, by the lowest RSS of all, by a rule, or given.
//!
//! Reasons to prefer a rule: RSS is nearly the same in several minima while derivatives and conditioning are not, so
//! the lowest RSS says little about which w serves best.

use serde::{Deserialize, Serialize};
use ship::Shown;
use std::f64::consts::{PI, TAU};

use super::basis::Basis;
use super::profile::Profile;
use crate::error::IdentifyError;
use crate::estimate::StopReason;
use crate::settings::SettingsError;

/// Where a local search for w starts.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum StartPoint {
    /// Highest peak of the discrete Fourier transform of the heading about its mean.
    FftPeak,
    /// 2π/T_rec: one period a record.
    RecordLength,
    /// π/T_rec: half a period a record.
    TwiceRecordLength,
}

impl StartPoint {
    /// How many there are.
    const COUNT: usize = 3;
}

/// How the fundamental is chosen.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "kebab-case", rename_all_fields = "kebab-case", deny_unknown_fields)]
pub enum Fundamental {
    /// A local search from every start, downhill in RSS(w); the best end wins.
    Starts(Vec<StartPoint>),
    /// The lowest RSS over all w from 0.35 periods a record (or 1.25/N of the peak of the transform, if that is more)
    /// to 1.5 times the peak.
    Global,
    /// The best-conditioned local minimum of RSS whose R² lies within this much of the best.
    BestConditioned {
        /// Loss of R² that is accepted.
        r_squared_loss: f64,
    },
    /// One period of the series is the median period between zero crossings of the heading about its mean.
    ZeroCrossings,
    /// One period of the series is the record and this many zig-zag periods more (periods by [`Self::ZeroCrossings`]):
    /// room in which the series joins the end of the record to its beginning, so that it need not be periodic.
    RecordAndPeriods(f64),
    /// One period of the series is this many record lengths.
    RecordLengths(f64),
    /// Given, rad/s.
    FixedRadS(f64),
}

/// A fundamental and how it was found.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Choice {
    /// w, rad/s.
    pub fundamental: f64,
    /// Why the search stopped.
    pub stop: StopReason,
    /// Fundamentals tried.
    pub evaluations: usize,
}

/// Fundamentals that can be given, rad/s: one period in two months, and faster than any instrument reads.
const FREQUENCIES: std::ops::RangeInclusive<f64> = 1e-6..=1e3;

/// Lowest fundamental of a scan, periods a record: below it 17 columns are one polynomial to rounding.
const FEWEST_PERIODS: f64 = 0.35;

/// Highest fundamental of a scan over the peak of the transform.
const HIGHEST_OVER_PEAK: f64 = 1.5;

/// The highest harmonic must reach past the peak of the transform, else the series cannot follow the record.
const LEAST_REACH: f64 = 1.25;

/// Steps as a share of π/(N T_rec), the change of w that moves the highest harmonic by half a period over the record.
const SCAN_STEP: f64 = 0.3;
const DESCENT_STEP: f64 = 0.15;

impl Fundamental {
    /// Refuses settings that cannot mean anything.
    pub fn check(&self) -> Result<(), SettingsError> {
        let refuse = |key, found: f64, expected| Err(SettingsError::new(key, Shown(found), expected));
        match self {
            Self::Starts(starts) if !(1..=StartPoint::COUNT).contains(&starts.len()) => {
                let found = format!("a list of {} starts", starts.len());
                Err(SettingsError::new("fundamental.starts", found, "1 to 3 starts"))
            }
            Self::BestConditioned { r_squared_loss: loss } if !(*loss >= 0.0 && *loss < 1.0) => {
                refuse("fundamental.best-conditioned", *loss, "a loss of R² from 0 to below 1")
            }
            Self::RecordAndPeriods(x) if !(*x >= 0.0 && *x <= 2.0) => {
                refuse("fundamental.record-and-periods", *x, "0 to 2 periods")
            }
            Self::RecordLengths(x) if !(*x >= 0.01 && *x <= 1.0 / FEWEST_PERIODS) => {
                refuse("fundamental.record-lengths", *x, "a period of 0.01 to 2.86 record lengths")
            }
            Self::FixedRadS(w) if !FREQUENCIES.contains(w) => {
                refuse("fundamental.fixed-rad-s", *w, "a frequency of 1e-6 to 1000 rad/s")
            }
            _ => Ok(()),
        }
    }

    /// Chooses w for `heading` (rad) at `time` (s, increasing), to be used with `harmonics` harmonics.
    ///
    /// Fails with [`IdentifyError::TooFewPoints`] when a rule that needs the zig-zag period finds fewer than two
    /// crossings.
    pub fn choose(&self, time: &[f64], heading: &[f64], harmonics: usize) -> Result<Choice, IdentifyError> {
        let length = time[time.len() - 1] - time[0];
        let direct = |fundamental| Choice { fundamental, stop: StopReason::Direct, evaluations: 0 };
        match self {
            Self::FixedRadS(fundamental) => Ok(direct(*fundamental)),
            Self::RecordLengths(lengths) => Ok(direct(TAU / (lengths * length))),
            Self::RecordAndPeriods(periods) => {
                Ok(direct(TAU / (length + periods * zero_crossing_period(time, heading)?)))
            }
            Self::ZeroCrossings => Ok(direct(TAU / zero_crossing_period(time, heading)?)),
            Self::Starts(starts) => Ok(search_from(starts, time, heading, harmonics)),
            Self::Global => Ok(Scan::new(time, heading, harmonics).lowest()),
            Self::BestConditioned { r_squared_loss } => {
                Scan::new(time, heading, harmonics).best_conditioned(time, *r_squared_loss)
            }
        }
    }
}

/// Local searches from every start, the lowest RSS kept.
fn search_from(starts: &[StartPoint], time: &[f64], heading: &[f64], harmonics: usize) -> Choice {
    let length = time[time.len() - 1] - time[0];
    let mut profile = Profile::new(time, heading, harmonics);
    let mut best: Option<(f64, Choice)> = None;
    for start in starts {
        let from = match start {
            StartPoint::FftPeak => peak_of_transform(time, heading),
            StartPoint::RecordLength => TAU / length,
            StartPoint::TwiceRecordLength => PI / length,
        };
        let (rss, choice) = descend(&mut profile, from, length, harmonics);
        if best.is_none_or(|(lowest, _)| rss < lowest) {
            best = Some((rss, choice));
        }
    }
    let (_, choice) = best.expect("settings hold at least one start");
    Choice { evaluations: profile.evaluations(), ..choice }
}

/// Walks downhill from `from` in steps too small to leave a basin, then closes in on the minimum.
fn descend(profile: &mut Profile, from: f64, length: f64, harmonics: usize) -> (f64, Choice) {
    let step = DESCENT_STEP * PI / (harmonics as f64 * length);
    let (floor, ceiling) = (FEWEST_PERIODS * TAU / length, from.max(TAU / length) * 2.0);
    let start = from.max(floor);
    let value = profile.rss(start);
    let direction = if profile.rss(start + step) < value { step } else { -step };
    let mut walk = profile.walk(start, direction);
    let mut value = walk.next_rss();
    let mut steps = 0;
    let at = |steps: i32| start + f64::from(steps) * direction;
    loop {
        let next = at(steps + 1);
        if next < floor || next > ceiling {
            return (value, Choice { fundamental: at(steps), stop: StopReason::RangeLimit, evaluations: 0 });
        }
        let ahead = walk.next_rss();
        if ahead >= value || ahead.is_nan() {
            break;
        }
        (steps, value) = (steps + 1, ahead);
    }
    let (behind, ahead) = (at(steps - 1), at(steps + 1));
    let (fundamental, rss) = close_in(profile, behind.min(ahead), at(steps), behind.max(ahead), value);
    (rss, Choice { fundamental, stop: StopReason::Converged, evaluations: 0 })
}

/// Minimum of RSS between `lo` and `hi` from an inner point `middle` with RSS `value`: Brent (1973), parabolas with
/// golden sections where they fail. Settles at a relative step of 1e-8, below which RSS is flat to rounding.
fn close_in(profile: &mut Profile, lo: f64, middle: f64, hi: f64, value: f64) -> (f64, f64) {
    const GOLDEN: f64 = 0.381_966_011_250_105;
    let (mut lo, mut hi) = (lo, hi);
    let (mut x, mut w, mut v) = (middle, middle, middle);
    let (mut fx, mut fw, mut fv) = (value, value, value);
    let (mut step, mut before): (f64, f64) = (0.0, 0.0);
    for _ in 0..60 {
        let centre = 0.5 * (lo + hi);
        let tolerance = 1e-8 * x.abs();
        if (x - centre).abs() <= 2.0 * tolerance - 0.5 * (hi - lo) {
            break;
        }
        let (r, q) = ((x - w) * (fx - fv), (x - v) * (fx - fw));
        let (mut p, mut denominator) = ((x - v) * q - (x - w) * r, 2.0 * (q - r));
        if denominator > 0.0 {
            p = -p;
        }
        denominator = denominator.abs();
        let parabola =
            p.abs() < (0.5 * denominator * before).abs() && p > denominator * (lo - x) && p < denominator * (hi - x);
        (before, step) = if parabola {
            (step, p / denominator)
        } else {
            let long = if x < centre { hi - x } else { lo - x };
            (long, GOLDEN * long)
        };
        let u = x + if step.abs() >= tolerance { step } else { tolerance.copysign(step) };
        let fu = profile.rss(u);
        if fu <= fx {
            if u < x {
                hi = x
            } else {
                lo = x
            }
            (v, fv, w, fw, x, fx) = (w, fw, x, fx, u, fu);
        } else {
            if u < x {
                lo = u
            } else {
                hi = u
            }
            if fu <= fw || w == x {
                (v, fv, w, fw) = (w, fw, u, fu);
            } else if fu <= fv || v == x || v == w {
                (v, fv) = (u, fu);
            }
        }
    }
    (x, fx)
}

/// RSS on a grid of fundamentals.
struct Scan {
    profile: Profile,
    harmonics: usize,
    lowest: f64,
    step: f64,
    rss: Vec<f64>,
}

impl Scan {
    fn new(time: &[f64], heading: &[f64], harmonics: usize) -> Self {
        let length = time[time.len() - 1] - time[0];
        let peak = peak_of_transform(time, heading);
        let lowest = (FEWEST_PERIODS * TAU / length).max(LEAST_REACH * peak / harmonics as f64);
        let step = SCAN_STEP * PI / (harmonics as f64 * length);
        let count = ((HIGHEST_OVER_PEAK * peak - lowest) / step).max(2.0).ceil() as usize + 1;
        let mut profile = Profile::new(time, heading, harmonics);
        let rss = profile.scan(lowest, step, count);
        Self { profile, harmonics, lowest, step, rss }
    }

    fn at(&self, k: usize) -> f64 {
        self.lowest + k as f64 * self.step
    }

    /// Closes in on the minimum around grid point `k`, inside the grid.
    fn polish(&mut self, k: usize) -> (f64, f64) {
        let last = self.rss.len() - 1;
        let (lo, hi) = (self.at(k.saturating_sub(1)), self.at((k + 1).min(last)));
        let (middle, value) = (self.at(k), self.rss[k]);
        close_in(&mut self.profile, lo, middle, hi, value)
    }

    fn lowest(mut self) -> Choice {
        let last = self.rss.len() - 1;
        let best = (0..=last).min_by(|&p, &q| self.rss[p].total_cmp(&self.rss[q])).expect("a scan is not empty");
        let stop = if best == 0 || best == last { StopReason::RangeLimit } else { StopReason::Converged };
        let (fundamental, _) = self.polish(best);
        Choice { fundamental, stop, evaluations: self.profile.evaluations() }
    }

    fn best_conditioned(mut self, time: &[f64], loss: f64) -> Result<Choice, IdentifyError> {
        let last = self.rss.len() - 1;
        let is_minimum =
            |k: usize| (k == 0 || self.rss[k] <= self.rss[k - 1]) && (k == last || self.rss[k] < self.rss[k + 1]);
        let minima: Vec<usize> = (0..=last).filter(|&k| is_minimum(k)).collect();
        let mut ends = Vec::with_capacity(minima.len());
        for k in minima {
            let (w, rss) = self.polish(k);
            ends.push((k, w, rss));
        }
        let best = ends.iter().fold(f64::INFINITY, |best, end| best.min(end.2));
        let limit = best + loss * self.profile.total();
        let mut chosen: Option<(f64, Choice)> = None;
        for (k, fundamental, _) in ends.into_iter().filter(|end| end.2 <= limit) {
            let condition = Basis::new(time, fundamental, self.harmonics)?.condition();
            if chosen.is_none_or(|(least, _)| condition < least) {
                let stop = if k == 0 || k == last { StopReason::RangeLimit } else { StopReason::Converged };
                chosen = Some((condition, Choice { fundamental, stop, evaluations: self.profile.evaluations() }));
            }
        }
        Ok(chosen.expect("the lowest point of a scan is a minimum within any loss").1)
    }
}

/// Angular frequency, rad/s, of the highest peak of the transform of the heading about its mean, from one period a
/// record upwards. Headings are interpolated to even steps first, so that gaps do no harm.
pub fn peak_of_transform(time: &[f64], heading: &[f64]) -> f64 {
    let rows = time.len();
    let step = (time[rows - 1] - time[0]) / (rows - 1) as f64;
    let mut even = Vec::with_capacity(rows);
    let mut k = 0;
    for row in 0..rows {
        let t = time[0] + row as f64 * step;
        while k + 2 < rows && time[k + 1] < t {
            k += 1;
        }
        let share = (t - time[k]) / (time[k + 1] - time[k]);
        even.push(heading[k] + share * (heading[k + 1] - heading[k]));
    }
    let mean = even.iter().sum::<f64>() / rows as f64;
    even.iter_mut().for_each(|x| *x -= mean);
    let power = estimation::transform::power(&mut even);
    let bin = (1..power.len()).max_by(|&p, &q| power[p].total_cmp(&power[q])).expect("a record has many rows");
    TAU * bin as f64 / (rows as f64 * step)
}

/// Median time between every other crossing of the heading through its mean, s; twice the median time between crossings
/// when there are only two.
///
/// A crossing counts once the heading has gone a quarter of its amplitude to the other side, so that noise near zero
/// makes none of its own; its time is the middle between the first and the last change of sign on the way.
///
/// Fails with [`IdentifyError::TooFewPoints`] when there are fewer than two crossings.
pub fn zero_crossing_period(time: &[f64], heading: &[f64]) -> Result<f64, IdentifyError> {
    let mean = heading.iter().sum::<f64>() / heading.len() as f64;
    let amplitude = heading.iter().fold(0.0f64, |most, psi| most.max((psi - mean).abs()));
    let mut side = 0.0;
    let mut changes: Vec<f64> = Vec::new();
    let mut crossings: Vec<f64> = Vec::new();
    for row in 0..time.len() {
        let here = heading[row] - mean;
        if row > 0 {
            let before = heading[row - 1] - mean;
            if (before < 0.0) != (here < 0.0) {
                changes.push(time[row - 1] + (time[row] - time[row - 1]) * before / (before - here));
            }
        }
        if here.abs() >= 0.25 * amplitude {
            if side != 0.0 && here.signum() != side {
                let (first, last) = (changes.first(), changes.last());
                let (first, last) = first.zip(last).expect("sides differ, so the sign has changed");
                crossings.push(0.5 * (first + last));
            }
            side = here.signum();
            changes.clear();
        }
    }
    if crossings.len() < 2 {
        let what = "zero crossings of the heading";
        return Err(IdentifyError::TooFewPoints { what, needed: 2, found: crossings.len() });
    }
    let mut periods: Vec<f64> = if crossings.len() == 2 {
        vec![2.0 * (crossings[1] - crossings[0])]
    } else {
        crossings.windows(3).map(|three| three[2] - three[0]).collect()
    };
    periods.sort_by(f64::total_cmp);
    let middle = periods.len() / 2;
    Ok(if periods.len() % 2 == 1 { periods[middle] } else { 0.5 * (periods[middle - 1] + periods[middle]) })
}

#[cfg(test)]
mod tests;
