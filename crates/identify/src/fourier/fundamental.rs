//! Fundamental w of the series: by local search, by the lowest RSS of all or by a rule.
//!
//! A rule is preferable: RSS is nearly equal in several minima while derivatives and conditioning differ, so the lowest
//! RSS is a poor criterion for w.

use estimation::statistics::median;
use serde::{Deserialize, Serialize};
use ship::ShortNumber;
use std::f64::consts::{PI, TAU};

use super::profile::Profile;
use crate::error::IdentifyError;
use crate::estimate::StopReason;
use crate::settings::{SettingsError, require};

/// Rule for the choice of the fundamental.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Fundamental {
    /// Local searches, downhill in RSS(w), from the highest peak of the discrete Fourier transform of the heading, from
    /// one period per record and from half a period; the lowest end point is used.
    Starts,
    /// Local search from the peak alone.
    FftPeak,
    /// Lowest RSS over all w from 0.35 periods per record (or 1.25/N of the peak of the transform, if that is more) to
    /// 1.5 times the peak.
    Global,
    /// One period of the series is the median period between zero crossings of the heading about its mean.
    ZeroCrossings,
    /// One period of the series is the record plus this many zig-zag periods (periods by `zero-crossings`): the added
    /// time connects the end of the record to its beginning, so that the record need not be periodic.
    RecordAndPeriods(f64),
}

/// Fundamental, and the reason why the search stopped.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ChosenFundamental {
    /// Fundamental w, rad/s.
    pub fundamental: f64,
    /// Reason why the search stopped.
    pub stop: StopReason,
    /// Number of fundamentals tried.
    pub evaluations: usize,
}

/// Minimum fundamental of a search, in periods per record: below it the 17 columns of eight harmonics span, to
/// rounding, the polynomials of degree 16.
const MIN_PERIODS: f64 = 0.35;

/// Maximum fundamental of a scan, relative to the peak of the transform.
const MAX_OVER_PEAK: f64 = 1.5;

/// Minimum ratio of the highest harmonic to the peak of the transform; below it the series cannot follow the record.
const MIN_REACH: f64 = 1.25;

/// Step of a scan as a share of π/(N T_rec), the change of w that moves the highest harmonic by half a period over the
/// record.
const SCAN_STEP: f64 = 0.3;

/// Step of a descent from a start, as a share of π/(N T_rec).
const DESCENT_STEP: f64 = 0.15;

impl Fundamental {
    /// Checks the settings; fails for a number of periods outside 0 to 2.
    pub fn check(&self) -> Result<(), SettingsError> {
        let Self::RecordAndPeriods(periods) = self else { return Ok(()) };
        let holds = (0.0..=2.0).contains(periods);
        require(holds, "fundamental.record-and-periods", ShortNumber(*periods), "0 to 2 periods")
    }

    /// Chooses w for `heading` (rad) at `time` (s, increasing), to be used with `harmonics` harmonics.
    ///
    /// Fails with [`IdentifyError::TooFewPoints`] if a rule that needs the zig-zag period finds fewer than two
    /// crossings.
    pub fn choose(&self, time: &[f64], heading: &[f64], harmonics: usize) -> Result<ChosenFundamental, IdentifyError> {
        let duration = time[time.len() - 1] - time[0];
        let direct = |fundamental| ChosenFundamental { fundamental, stop: StopReason::Direct, evaluations: 0 };
        let peak = || spectral_peak(time, heading);
        Ok(match self {
            Self::RecordAndPeriods(periods) => {
                direct(TAU / (duration + periods * zero_crossing_period(time, heading)?))
            }
            Self::ZeroCrossings => direct(TAU / zero_crossing_period(time, heading)?),
            Self::Starts => search_from(&[peak(), TAU / duration, PI / duration], time, heading, harmonics),
            Self::FftPeak => search_from(&[peak()], time, heading, harmonics),
            Self::Global => lowest(time, heading, harmonics),
        })
    }
}

/// Fundamental of lowest RSS among the local minima downhill from every start, rad/s.
fn search_from(starts: &[f64], time: &[f64], heading: &[f64], harmonics: usize) -> ChosenFundamental {
    let duration = time[time.len() - 1] - time[0];
    let mut profile = Profile::new(time, heading, harmonics);
    let ends: Vec<(f64, ChosenFundamental)> =
        starts.iter().map(|&start| descend(&mut profile, start, duration, harmonics)).collect();
    let (_, choice) = ends.into_iter().min_by(|a, b| a.0.total_cmp(&b.0)).expect("there is a start");
    ChosenFundamental { evaluations: profile.evaluations, ..choice }
}

/// RSS and fundamental of the local minimum downhill from `from` (rad/s), in steps too small to leave a basin, then
/// refined.
fn descend(profile: &mut Profile, from: f64, duration: f64, harmonics: usize) -> (f64, ChosenFundamental) {
    let step = DESCENT_STEP * PI / (harmonics as f64 * duration);
    let (floor, ceiling) = (MIN_PERIODS * TAU / duration, from.max(TAU / duration) * 2.0);
    let start = from.max(floor);
    let value = profile.rss(start);
    let direction = if profile.rss(start + step) < value { step } else { -step };
    let mut walk = profile.sweep(start, direction);
    let mut value = walk.next_rss();
    let mut steps = 0;
    let at = |steps: i32| start + f64::from(steps) * direction;
    loop {
        let next = at(steps + 1);
        if next < floor || next > ceiling {
            return (value, ChosenFundamental { fundamental: at(steps), stop: StopReason::RangeLimit, evaluations: 0 });
        }
        let ahead = walk.next_rss();
        if ahead >= value || ahead.is_nan() {
            break;
        }
        (steps, value) = (steps + 1, ahead);
    }
    let (behind, ahead) = (at(steps - 1), at(steps + 1));
    let (fundamental, rss) = close_in(profile, behind.min(ahead), at(steps), behind.max(ahead), value);
    (rss, ChosenFundamental { fundamental, stop: StopReason::Converged, evaluations: 0 })
}

/// Fundamental (rad/s) and value of the minimum of RSS between `lo` and `hi`, from an inner point `middle` with RSS
/// `value`: Brent (1973), parabolas, with golden sections if they fail. Converges at a relative step of 1e-8, below
/// which RSS is flat to rounding.
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

/// Fundamental of lowest RSS on a grid, refined between its neighbours; stopped by the range at an end of the grid.
fn lowest(time: &[f64], heading: &[f64], harmonics: usize) -> ChosenFundamental {
    let duration = time[time.len() - 1] - time[0];
    let peak = spectral_peak(time, heading);
    let lowest = (MIN_PERIODS * TAU / duration).max(MIN_REACH * peak / harmonics as f64);
    let step = SCAN_STEP * PI / (harmonics as f64 * duration);
    let last = ((MAX_OVER_PEAK * peak - lowest) / step).max(2.0).ceil() as usize;
    let mut profile = Profile::new(time, heading, harmonics);
    let rss = profile.scan(lowest, step, last + 1);
    let best = (0..=last).min_by(|&p, &q| rss[p].total_cmp(&rss[q])).expect("a scan is not empty");
    let stop = if best == 0 || best == last { StopReason::RangeLimit } else { StopReason::Converged };
    let at = |k: usize| lowest + k as f64 * step;
    let (lo, hi) = (at(best.saturating_sub(1)), at((best + 1).min(last)));
    let (fundamental, _) = close_in(&mut profile, lo, at(best), hi, rss[best]);
    ChosenFundamental { fundamental, stop, evaluations: profile.evaluations }
}

/// Angular frequency, rad/s, of the highest peak of the transform of the heading about its mean, from one period per
/// record upwards. Headings are first interpolated to even steps, so that gaps are admissible.
pub fn spectral_peak(time: &[f64], heading: &[f64]) -> f64 {
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
    let power = estimation::transform::power_spectrum(&mut even);
    let bin = (1..power.len()).max_by(|&p, &q| power[p].total_cmp(&power[q])).expect("a record has many rows");
    TAU * bin as f64 / (rows as f64 * step)
}

/// Median time between every other crossing of the heading through its mean, s; twice the time between the crossings if
/// there are only two.
///
/// A crossing counts if the heading departs from its mean by a quarter of its amplitude on the side before and on the
/// side after, so that noise near the mean makes no crossing; its time is the middle between the first and the last
/// change of sign.
///
/// Fails with [`IdentifyError::TooFewPoints`] if there are fewer than two crossings.
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
        let kind = "zero crossings of the heading";
        return Err(IdentifyError::TooFewPoints { kind, needed: 2, count: crossings.len() });
    }
    let mut periods: Vec<f64> = if crossings.len() == 2 {
        vec![2.0 * (crossings[1] - crossings[0])]
    } else {
        crossings.windows(3).map(|three| three[2] - three[0]).collect()
    };
    Ok(median(&mut periods).expect("there are two crossings"))
}

#[cfg(test)]
mod tests;
