//! Replay errors of the base ("before") and of the structure average ("after"), on fitted and on held-out records.
//!
//! Only initial states are fitted here; on held-out records also a bias or a slow moment of the record, reported
//! separately.

use document::trace::{HorizonEntry, ModelReplayErrors};
use estimation::statistics::wilson_interval;
use identify::replay::{Replay, replay};
use rayon::prelude::*;
use ship::angle::to_deg;
use ship::{FirstOrder, Response};
use trial::Trial;

use crate::average::{AverageReplay, FittedAverage, ModelAverage};
use crate::band;
use crate::record::PreparedRecord;
use crate::record_moment::RecordMoment;
use crate::replay_errors::{
    HORIZONS_S, ReplayDepth, ReplayErrors, WindowError, duration, has_several_windows, overshoot_error,
    root_mean_square,
};
use crate::settings::TraceError;

/// Replay of a model on one record, with its errors.
#[derive(Debug, Clone, PartialEq)]
pub struct ReplayResult {
    /// Full replay.
    pub replay: Replay,
    /// Errors of the replay.
    pub errors: ReplayErrors,
    /// Half-width of the 95 % band of a reading at every row of the replay, rad; `None` for the base, if the
    /// covariance of a structure is singular, or if a hull has no variance on the record.
    pub band_half_width: Option<Vec<f64>>,
}

/// Coverage of the headings of a record by the 95 % band of its replay.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ConfidenceBandCoverage {
    /// Number of measured headings inside the band.
    pub headings_inside: usize,
    /// Number of measured headings.
    pub heading_count: usize,
    /// 99 % interval of the share inside (Wilson 1927), for the effective number of headings n (1 − ρ)/(1 + ρ) with the
    /// lag-1 autocorrelation ρ of the inside flags, because neighbouring headings are correlated.
    pub share_ci99: [f64; 2],
}

/// Nominal coverage of a band.
const NOMINAL_COVERAGE: f64 = 0.95;

/// 99.5 % quantile of the standard normal law.
const QUANTILE_99: f64 = 2.575_829_303_548_901;

impl ConfidenceBandCoverage {
    /// Coverage from flags in order of time, `true` for a heading inside; `None` without headings.
    pub fn from_flags(inside: &[bool]) -> Option<Self> {
        let (headings_inside, headings) = (inside.iter().filter(|&&inside| inside).count(), inside.len());
        let share = (headings > 0).then(|| headings_inside as f64 / headings as f64)?;
        let off: Vec<f64> = inside.iter().map(|&inside| f64::from(u8::from(inside)) - share).collect();
        let cross: f64 = off.windows(2).map(|pair| pair[0] * pair[1]).sum();
        let square: f64 = off.iter().map(|off| off * off).sum();
        let correlation = if square > 0.0 { (cross / square).max(0.0) } else { 0.0 };
        let independent = headings as f64 * (1.0 - correlation) / (1.0 + correlation);
        Some(Self {
            headings_inside,
            heading_count: headings,
            share_ci99: wilson_interval(share, independent, QUANTILE_99),
        })
    }

    /// Share of the headings inside the band.
    pub fn share(&self) -> f64 {
        self.headings_inside as f64 / self.heading_count as f64
    }

    /// `true` if the coverage is not significantly below the nominal 95 %.
    pub fn is_nominal(&self) -> bool {
        self.share_ci99[1] >= NOMINAL_COVERAGE
    }
}

impl ReplayResult {
    /// Coverage of the measured headings; `None` without a band.
    pub fn band_coverage(&self) -> Option<ConfidenceBandCoverage> {
        let pairs = self
            .replay
            .residual
            .iter()
            .zip(self.band_half_width.as_ref()?)
            .filter(|(residual, _)| residual.is_finite());
        ConfidenceBandCoverage::from_flags(
            &pairs.map(|(residual, half)| residual.abs() <= *half).collect::<Vec<bool>>(),
        )
    }

    /// Mean width of the band, rad; `None` without a band.
    pub fn band_width(&self) -> Option<f64> {
        let band = self.band_half_width.as_ref().filter(|band| !band.is_empty())?;
        Some(2.0 * band.iter().sum::<f64>() / band.len() as f64)
    }
}

impl From<&ReplayResult> for ModelReplayErrors {
    fn from(on: &ReplayResult) -> Self {
        let errors = &on.errors;
        let horizon =
            HORIZONS_S.map(|window| (format!("{window:.0}"), errors.restarted_heading_rmse(window).map(to_deg)));
        Self {
            heading_rmse_deg: to_deg(errors.heading_rmse),
            yaw_rate_rmse_deg_s: errors.yaw_rate_rmse.map(to_deg),
            overshoot_error_deg: errors.overshoot_error.map(to_deg),
            horizon_rmse_deg: horizon.into(),
            band_coverage_95: on.band_coverage().map(|coverage| coverage.share()),
            band_width_95_deg: on.band_width().map(to_deg),
            heading_rmse_own_bias_deg: errors.fitted_moment_errors.map(|with| to_deg(with.with_bias)),
            heading_rmse_own_moment_deg: errors.fitted_moment_errors.map(|with| to_deg(with.with_slow_moment)),
        }
    }
}

/// Comparison of base and structure average on one record.
#[derive(Debug, Clone, PartialEq)]
pub struct RecordComparison {
    /// Replay of the base.
    pub base_replay: ReplayResult,
    /// Replay of the structure average.
    pub average_replay: ReplayResult,
}

impl RecordComparison {
    /// Heading errors by prediction horizon: windows of at most two thirds of the record, then the whole record.
    pub fn horizons(&self) -> Vec<HorizonEntry> {
        let [before, after] = [&self.base_replay.errors, &self.average_replay.errors];
        let time = &self.base_replay.replay.time;
        let shorter = before.windows.iter().filter(|window| has_several_windows(window.duration, time));
        let windows = shorter.filter_map(|window| {
            Some((window.duration, window.heading_rmse?, after.restarted_heading_rmse(window.duration)?))
        });
        let all = windows.chain([(duration(time), before.heading_rmse, after.heading_rmse)]);
        let entry = |(horizon_s, before, after)| HorizonEntry {
            horizon_s,
            before_deg: to_deg(before),
            after_deg: to_deg(after),
        };
        all.map(entry).collect()
    }
}

/// Start values of the initial heading (rad) and yaw rate (rad/s): the first heading with zero yaw rate, the initial
/// state of the replay of the base if it is finite, and the first heading with the first yaw rate if it is measured.
/// Empty without headings.
pub fn initial_state_guesses(trial: &Trial, base: &FirstOrder) -> Vec<[f64; 2]> {
    let Some(first) = trial.observed_rows().next() else { return Vec::new() };
    let heading = trial.heading()[first];
    let mut starts = vec![[heading, 0.0]];
    starts.extend(replay(trial, base).map(|replay| replay.initial_state()));
    starts.extend(trial.yaw_rate().map(|rate| rate[first]).filter(|rate| rate.is_finite()).map(|rate| [heading, rate]));
    starts
}

/// Replay of the base on a record, in closed form, which holds for either sign of T; fails if it is not finite.
pub fn replay_base(
    trial: &Trial,
    record: &PreparedRecord,
    base: &FirstOrder,
    depth: ReplayDepth,
) -> Result<ReplayResult, TraceError> {
    let refuse = || TraceError::Replay { trial: trial.name().to_owned() };
    let replay = replay(trial, base).ok_or_else(refuse)?;
    let average = ModelAverage { members: vec![(1.0, Box::new(Response::first_order_ship(*base)))] };
    let windows = match depth {
        ReplayDepth::Heading => None,
        _ => average.replay(record, &[replay.initial_state()], depth).map(|replayed| replayed.windows),
    };
    Ok(result(trial, replay, windows.unwrap_or_default(), depth))
}

impl FittedAverage<'_> {
    /// Comparison on a held-out record; if `thorough`, also the errors with a fitted moment of the record and for all
    /// horizons ([`ReplayDepth::Growth`]). Fails if no replay is finite.
    pub fn compare(&self, trial: &Trial, base: &FirstOrder, thorough: bool) -> Result<RecordComparison, TraceError> {
        let record = PreparedRecord::unaveraged(trial);
        let depth = if thorough { ReplayDepth::Growth } else { ReplayDepth::Windows };
        let mut before = replay_base(trial, &record, base, depth)?;
        let mut starts = initial_state_guesses(trial, base);
        starts.push(before.replay.initial_state());
        let mut after = self.replay_on(trial, &record, &starts, depth)?;
        if let Some(moment) = thorough.then(|| RecordMoment::new(&record, base)).flatten() {
            before.errors.fitted_moment_errors = Some(moment.base_errors(&before.replay));
            after.errors.fitted_moment_errors = Some(moment.average_errors(&self.average(), &after.replay));
        }
        Ok(RecordComparison { base_replay: before, average_replay: after })
    }

    /// Comparisons on several held-out records.
    pub fn compare_all(
        &self,
        trials: &[Trial],
        base: &FirstOrder,
        thorough: bool,
    ) -> Result<Vec<RecordComparison>, TraceError> {
        trials.par_iter().map(|trial| self.compare(trial, base, thorough)).collect()
    }

    /// Replay of the average on a record from initial states near the `starts` (rad, rad/s), with its errors and band;
    /// fails if no replay is finite.
    pub fn replay_on(
        &self,
        trial: &Trial,
        record: &PreparedRecord,
        starts: &[[f64; 2]],
        depth: ReplayDepth,
    ) -> Result<ReplayResult, TraceError> {
        let refuse = || TraceError::Replay { trial: trial.name().to_owned() };
        let mut all = starts.to_vec();
        if let Some(number) = self.fitted_record {
            all.extend(self.members.iter().map(|(_, fit)| fit.initial[number]));
        }
        let AverageReplay { replay, windows, member_replays: members } =
            self.average().replay(record, &all, depth).ok_or_else(refuse)?;
        let band = band::band_half_width(self, trial, &replay, &members);
        Ok(ReplayResult { band_half_width: band, ..result(trial, replay, windows, depth) })
    }
}

/// Replay of a record with its errors to the extent of `depth`, without a band and without errors with a fitted moment.
fn result(trial: &Trial, replay: Replay, windows: Vec<WindowError>, depth: ReplayDepth) -> ReplayResult {
    let thorough = depth != ReplayDepth::Heading;
    let first = trial.observed_rows().next().unwrap_or(0);
    let rows = replay.observed_residuals().count();
    let finite = |values: &[f64]| -> Vec<f64> { values.iter().copied().filter(|x| x.is_finite()).collect() };
    let yaw_rate = trial.yaw_rate().filter(|_| thorough).and_then(|measured| {
        let differences: Vec<f64> =
            measured[first..].iter().zip(&replay.yaw_rate).map(|(rate, replayed)| rate - replayed).collect();
        root_mean_square(&finite(&differences))
    });
    let errors = ReplayErrors {
        heading_rmse: replay.rms(),
        heading_count: rows,
        yaw_rate_rmse: yaw_rate,
        overshoot_error: if thorough { overshoot_error(trial, &replay) } else { None },
        windows,
        fitted_moment_errors: None,
    };
    ReplayResult { replay, errors, band_half_width: None }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// An equal number of headings outside is significant if they are scattered, and not if they belong to one swing.
    #[test]
    fn neighbours_outside_a_band_count_little() {
        let outside = |is_out: fn(usize) -> bool| {
            let inside: Vec<bool> = (0..200).map(|row| !is_out(row)).collect();
            ConfidenceBandCoverage::from_flags(&inside).expect("headings")
        };
        let (scattered, swing) = (outside(|row| row % 10 == 0), outside(|row| row >= 180));
        assert_eq!((scattered.headings_inside, swing.headings_inside), (180, 180));
        assert!(!scattered.is_nominal() && swing.is_nominal(), "{scattered:?} {swing:?}");
        assert!(outside(|_| false).is_nominal() && !outside(|_| true).is_nominal());
        assert_eq!(ConfidenceBandCoverage::from_flags(&[]), None);
    }
}
