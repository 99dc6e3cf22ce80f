//! Models against records: errors of the recorded rudder replayed, before and after, on the records that were fitted
//! and on others. Nothing is fitted here but initial states, and moments of the record beside the plain errors.

use document::trace::{ErrorsEntry, HorizonEntry};
use estimation::statistics::wilson;
use identify::replay::{Replay, replay};
use rayon::prelude::*;
use ship::angle::to_deg;
use ship::{FirstOrder, Response};
use trial::Trial;

use crate::average::{Average, AverageReplay, AveragedModel};
use crate::band;
use crate::record::PreparedRecord;
use crate::record_moment::RecordMoment;
use crate::replay_errors::{
    HORIZONS, ReplayDepth, ReplayErrors, WindowError, duration, is_shorter, overshoot_error, root_mean_square,
};
use crate::settings::TraceError;

/// A model on one record.
#[derive(Debug, Clone, PartialEq)]
pub struct ReplayResult {
    /// Replay.
    pub replay: Replay,
    /// Errors.
    pub errors: ReplayErrors,
    /// Half the width of the 95 % band of a reading at every row of the replay, rad; `None` where it was not asked for
    /// and where the records do not tell the parameters apart.
    pub band: Option<Vec<f64>>,
}

/// The headings of a record and the 95 % band of its replay.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BandCoverage {
    /// Measured headings inside the band.
    pub inside: usize,
    /// Measured headings.
    pub of: usize,
    /// Interval of the share inside, 99 % (Wilson 1927), for as many headings as tell something of their own:
    /// neighbours are in or out together, and n of them count as n (1 − ρ)/(1 + ρ) with their autocorrelation ρ at
    /// lag 1.
    pub interval: [f64; 2],
}

/// Share of the headings that a band is made for.
const HELD: f64 = 0.95;

/// Standard deviations on either side of 99 % of a normal error.
const QUANTILE_99: f64 = 2.575_829_303_548_901;

impl BandCoverage {
    /// Of headings in order of time, which are inside; `None` without any.
    pub fn of(inside: &[bool]) -> Option<Self> {
        let (count, of) = (inside.iter().filter(|&&inside| inside).count(), inside.len());
        let share = (of > 0).then(|| count as f64 / of as f64)?;
        let off: Vec<f64> = inside.iter().map(|&inside| f64::from(u8::from(inside)) - share).collect();
        let cross: f64 = off.windows(2).map(|pair| pair[0] * pair[1]).sum();
        let square: f64 = off.iter().map(|off| off * off).sum();
        let correlation = if square > 0.0 { (cross / square).max(0.0) } else { 0.0 };
        let independent = of as f64 * (1.0 - correlation) / (1.0 + correlation);
        Some(Self { inside: count, of, interval: wilson(share, independent, QUANTILE_99) })
    }

    /// Share of the headings inside.
    pub fn share(&self) -> f64 {
        self.inside as f64 / self.of as f64
    }

    /// Whether the band may hold as much as it is made for.
    pub fn is_held(&self) -> bool {
        self.interval[1] >= HELD
    }
}

impl ReplayResult {
    /// The measured headings against the band; `None` where there is none.
    pub fn coverage(&self) -> Option<BandCoverage> {
        let pairs = self.replay.residual.iter().zip(self.band.as_ref()?).filter(|(residual, _)| residual.is_finite());
        BandCoverage::of(&pairs.map(|(residual, half)| residual.abs() <= *half).collect::<Vec<bool>>())
    }

    /// Mean width of the band, rad.
    pub fn width(&self) -> Option<f64> {
        let band = self.band.as_ref().filter(|band| !band.is_empty())?;
        Some(2.0 * band.iter().sum::<f64>() / band.len() as f64)
    }
}

impl From<&ReplayResult> for ErrorsEntry {
    fn from(on: &ReplayResult) -> Self {
        let errors = &on.errors;
        let horizon = HORIZONS.map(|length| (format!("{length:.0}"), errors.within(length).map(to_deg)));
        Self {
            heading_rmse_deg: to_deg(errors.heading),
            yaw_rate_rmse_deg_s: errors.yaw_rate.map(to_deg),
            overshoot_error_deg: errors.overshoot.map(to_deg),
            horizon_rmse_deg: horizon.into(),
            band_coverage_95: on.coverage().map(|own| own.share()),
            band_width_95_deg: on.width().map(to_deg),
            with_own_bias_deg: errors.with_moment.map(|with| to_deg(with.bias)),
            with_own_moment_deg: errors.with_moment.map(|with| to_deg(with.slow)),
        }
    }
}

/// One record with the models before and after.
#[derive(Debug, Clone, PartialEq)]
pub struct RecordComparison {
    /// Base.
    pub before: ReplayResult,
    /// Average of the structures.
    pub after: ReplayResult,
}

impl RecordComparison {
    /// Heading errors against how far ahead the replays go: of the windows of which the record holds more than one,
    /// then of the whole record.
    pub fn horizons(&self) -> Vec<HorizonEntry> {
        let [before, after] = [&self.before.errors, &self.after.errors];
        let time = &self.before.replay.time;
        let shorter = before.windows.iter().filter(|window| is_shorter(window.length, time));
        let windows = shorter.filter_map(|window| Some((window.length, window.heading?, after.within(window.length)?)));
        let all = windows.chain([(duration(time), before.heading, after.heading)]);
        let entry = |(horizon_s, before, after)| HorizonEntry {
            horizon_s,
            before_deg: to_deg(before),
            after_deg: to_deg(after),
        };
        all.map(entry).collect()
    }
}

/// Heading (rad) and yaw rate (rad/s) with which a record may begin: as the base has it, without yaw rate, as measured.
pub fn starts(trial: &Trial, base: &FirstOrder) -> Vec<[f64; 2]> {
    let Some(first) = trial.observed_rows().next() else { return Vec::new() };
    let heading = trial.heading()[first];
    let mut starts = vec![[heading, 0.0]];
    starts.extend(replay(trial, base).map(|replay| replay.initial()));
    starts.extend(trial.yaw_rate().map(|rate| rate[first]).filter(|rate| rate.is_finite()).map(|rate| [heading, rate]));
    starts
}

/// The base on a record: in closed form, which neither sign of T disturbs.
pub fn before(
    trial: &Trial,
    record: &PreparedRecord,
    base: &FirstOrder,
    depth: ReplayDepth,
) -> Result<ReplayResult, TraceError> {
    let refuse = || TraceError::Replay { trial: trial.name().to_owned() };
    let replay = replay(trial, base).ok_or_else(refuse)?;
    let average = Average { members: vec![(1.0, Box::new(Response::first_order_ship(*base)))] };
    let windows = match depth {
        ReplayDepth::Heading => None,
        _ => average.replay(record, &[replay.initial()], depth).map(|replayed| replayed.windows),
    };
    Ok(result(trial, replay, windows.unwrap_or_default(), depth))
}

impl AveragedModel<'_> {
    /// Base and average on a record that neither was fitted to; where it is `thorough`, with moments of the record and
    /// with the growth of the error as well.
    pub fn compared(&self, trial: &Trial, base: &FirstOrder, thorough: bool) -> Result<RecordComparison, TraceError> {
        let record = PreparedRecord::whole(trial);
        let depth = if thorough { ReplayDepth::Growth } else { ReplayDepth::Windows };
        let mut before = before(trial, &record, base, depth)?;
        let mut starts = starts(trial, base);
        starts.push(before.replay.initial());
        let mut after = self.on(trial, &record, &starts, depth)?;
        if let Some(moment) = thorough.then(|| RecordMoment::new(&record, base)).flatten() {
            before.errors.with_moment = Some(moment.of_base(&before.replay));
            after.errors.with_moment = Some(moment.of_average(&self.average(), &after.replay));
        }
        Ok(RecordComparison { before, after })
    }

    /// The same on several.
    pub fn all_compared(
        &self,
        trials: &[Trial],
        base: &FirstOrder,
        thorough: bool,
    ) -> Result<Vec<RecordComparison>, TraceError> {
        trials.par_iter().map(|trial| self.compared(trial, base, thorough)).collect()
    }

    /// Replays the average on a record from initial states near the `starts`.
    pub fn on(
        &self,
        trial: &Trial,
        record: &PreparedRecord,
        starts: &[[f64; 2]],
        depth: ReplayDepth,
    ) -> Result<ReplayResult, TraceError> {
        let refuse = || TraceError::Replay { trial: trial.name().to_owned() };
        let mut all = starts.to_vec();
        if let Some(number) = self.known {
            all.extend(self.members.iter().map(|(_, fit)| fit.initial[number]));
        }
        let AverageReplay { replay, windows, members } =
            self.average().replay(record, &all, depth).ok_or_else(refuse)?;
        let band = band::of(self, trial, &replay, &members);
        Ok(ReplayResult { band, ..result(trial, replay, windows, depth) })
    }
}

/// Errors of a replay.
fn result(trial: &Trial, replay: Replay, windows: Vec<WindowError>, depth: ReplayDepth) -> ReplayResult {
    let thorough = depth != ReplayDepth::Heading;
    let first = trial.observed_rows().next().unwrap_or(0);
    let rows = replay.observed().count();
    let finite = |values: &[f64]| -> Vec<f64> { values.iter().copied().filter(|x| x.is_finite()).collect() };
    let yaw_rate = trial.yaw_rate().filter(|_| thorough).and_then(|measured| {
        let differences: Vec<f64> =
            measured[first..].iter().zip(&replay.yaw_rate).map(|(one, own)| one - own).collect();
        root_mean_square(&finite(&differences))
    });
    let errors = ReplayErrors {
        heading: replay.rms(),
        rows,
        yaw_rate,
        overshoot: if thorough { overshoot_error(trial, &replay) } else { None },
        windows,
        with_moment: None,
    };
    ReplayResult { replay, errors, band: None }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// As many headings outside say much where they stand alone and little where they are one swing.
    #[test]
    fn neighbours_outside_a_band_count_little() {
        let outside = |is_out: fn(usize) -> bool| {
            let inside: Vec<bool> = (0..200).map(|row| !is_out(row)).collect();
            BandCoverage::of(&inside).expect("headings")
        };
        let (apart, swing) = (outside(|row| row % 10 == 0), outside(|row| row >= 180));
        assert_eq!((apart.inside, swing.inside), (180, 180));
        assert!(!apart.is_held() && swing.is_held(), "{apart:?} {swing:?}");
        assert!(outside(|_| false).is_held() && !outside(|_| true).is_held());
        assert_eq!(BandCoverage::of(&[]), None);
    }
}
