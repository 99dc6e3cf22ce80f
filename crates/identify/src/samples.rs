//! Samples of a record: the rows with a heading, and the rudder integrated exactly up to them.

use std::ops::RangeInclusive;

use crate::likelihood::TrialSignals;
use estimation::column::extremes;
use ship::angle::to_deg;
use trial::{RudderCorner, Trial};

use crate::error::IdentifyError;

/// Minimum range of rudder and heading, deg, that counts as steering.
const MIN_RANGE_DEG: f64 = 0.5;

/// Minimum and maximum duration of a record, s: a microsecond to thirty years, far beyond any trial. Methods use powers
/// of the time up to the eighth, and the ratio of the duration to the sampling interval, which must not overflow.
const DURATION_S: RangeInclusive<f64> = 1e-6..=1e9;

/// Maximum angle, rad: a heading that has turned 160 000 times.
const MAX_ANGLE_RAD: f64 = 1e6;

/// Observed rows of a trial. All columns have the same length; time starts at 0.
#[derive(Debug, Clone, Default)]
pub struct Samples {
    /// Time since the first observed row, s.
    pub time: Vec<f64>,
    /// Heading ψ, rad.
    pub heading: Vec<f64>,
    /// Rudder δ, rad.
    pub rudder: Vec<f64>,
    /// ∫δ from the first observed row, rad s, exact for a rudder that is linear between rows and corners.
    pub rudder_integral: Vec<f64>,
    /// ∫∫δ from the first observed row, rad s².
    pub rudder_double_integral: Vec<f64>,
}

impl Samples {
    /// Samples of the observed rows of a trial.
    ///
    /// Fails with [`IdentifyError::TooFewSamples`] if there are fewer than `needed_headings` finite headings, with
    /// [`IdentifyError::OutOfRange`] if the time from the first to the last of them is not within 1e-6 and 1e9 s or an
    /// angle exceeds 1e6 rad, and with [`IdentifyError::NotExcited`] if rudder or heading vary by less than half a
    /// degree.
    pub fn new(trial: &Trial, needed_headings: usize) -> Result<Self, IdentifyError> {
        check(trial, needed_headings)?;
        let (t, delta, psi) = (trial.time(), trial.rudder(), trial.heading());
        let first = trial.observed_rows().next().unwrap_or(0);
        let rows = trial.len() - first;
        let (mut once, mut twice) = (vec![0.0; rows], vec![0.0; rows]);
        let mut corners = trial.rudder_corners().iter().filter(|corner| corner.row_before >= first);
        let mut corner = corners.next();
        // Integration starts at the first observed row.
        let (mut integral, mut double) = (0.0, 0.0);
        let intervals = t[first..].windows(2).zip(delta[first..].windows(2));
        let integrals = once[1..].iter_mut().zip(&mut twice[1..]);
        for (row, ((ends, delta), (once, twice))) in (first..).zip(intervals.zip(integrals)) {
            let h = ends[1] - ends[0];
            if let Some(&RudderCorner { time, rate_before: before, rate_after: after, .. }) =
                corner.filter(|corner| corner.row_before == row)
            {
                let (start, u, change) = (delta[0], ends[1] - time, after - before);
                double += h * integral + h * h * (3.0 * start + h * before) / 6.0 + u.powi(3) * change / 6.0;
                integral += h * start + 0.5 * (h * h * before + u * u * change);
                corner = corners.next();
            } else {
                double += h * integral + h * h * (2.0 * delta[0] + delta[1]) / 6.0;
                integral += 0.5 * h * (delta[0] + delta[1]);
            }
            (*once, *twice) = (integral, double);
        }
        let time = t[first..].iter().map(|time| time - t[first]).collect();
        let mut columns = [time, psi[first..].to_vec(), delta[first..].to_vec(), once, twice];
        if psi[first..].iter().any(|psi| !psi.is_finite()) {
            for column in &mut columns {
                let mut headings = psi[first..].iter();
                column.retain(|_| headings.next().is_some_and(|psi| psi.is_finite()));
            }
        }
        let [time, heading, rudder, rudder_integral, rudder_double_integral] = columns;
        Ok(Self { time, heading, rudder, rudder_integral, rudder_double_integral })
    }

    /// Samples of every trial, or the first error.
    pub fn from_trials(trials: &[Trial], needed_headings: usize) -> Result<Vec<Self>, IdentifyError> {
        if trials.is_empty() {
            return Err(IdentifyError::NoTrial);
        }
        trials.iter().map(|trial| Self::new(trial, needed_headings)).collect()
    }

    /// Number of rows.
    pub fn len(&self) -> usize {
        self.time.len()
    }
}

/// Signals of a trial that is excited and has `needed_headings` headings; fails as [`Samples::new`] does.
pub(crate) fn checked_signals(trial: &Trial, needed_headings: usize) -> Result<TrialSignals, IdentifyError> {
    check(trial, needed_headings)?;
    Ok(TrialSignals::new(trial))
}

/// Checks the requirements of every method on a trial; fails as [`Samples::new`] does.
pub(crate) fn check(trial: &Trial, needed_headings: usize) -> Result<(), IdentifyError> {
    let (time, delta, psi) = (trial.time(), trial.rudder(), trial.heading());
    let count = psi.iter().filter(|psi| psi.is_finite()).count();
    let first = trial.observed_rows().next().unwrap_or(0);
    let last = psi.iter().rposition(|psi| psi.is_finite()).unwrap_or(0);
    if count < needed_headings {
        return Err(IdentifyError::TooFewSamples { trial: trial.name().into(), needed: needed_headings, count });
    }
    let largest = |(lo, hi): (f64, f64)| hi.max(-lo);
    let range_deg = |(lo, hi): (f64, f64)| to_deg(hi - lo);
    let heading = extremes(psi);
    // The rudder between observed rows is used as well.
    let (duration_s, angle_rad) = (time[last] - time[first], largest(heading).max(largest(extremes(delta))));
    if !DURATION_S.contains(&duration_s) || angle_rad > MAX_ANGLE_RAD {
        return Err(IdentifyError::OutOfRange { trial: trial.name().into(), duration_s, angle_rad });
    }
    let steered = if count == trial.len() {
        extremes(delta)
    } else {
        trial
            .observed_rows()
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(lo, hi), row| (lo.min(delta[row]), hi.max(delta[row])))
    };
    let (rudder_deg, heading_deg) = (range_deg(steered), range_deg(heading));
    if rudder_deg < MIN_RANGE_DEG || heading_deg < MIN_RANGE_DEG {
        return Err(IdentifyError::NotExcited { trial: trial.name().into(), rudder_deg, heading_deg });
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use crate::registry;
    use crate::testing::{Case, record};

    /// Any finite numbers make a valid trial; the squares may overflow, so that a search or an iteration may not end.
    #[test]
    fn what_overflows_is_refused_by_every_method() {
        let trial = Case::default().trial();
        let stretched = |by: f64| trial.time().iter().map(|t| t * by).collect::<Vec<f64>>();
        let grown = |column: &[f64], by: f64| column.iter().map(|x| x * by).collect::<Vec<f64>>();
        let (time, heading, rudder) = (trial.time().to_vec(), trial.heading().to_vec(), trial.rudder().to_vec());
        let absurd = [
            record("age of the universe", stretched(1e300), heading.clone(), rudder.clone()),
            record("instant", stretched(1e-300), heading.clone(), rudder.clone()),
            record("heading", time.clone(), grown(&heading, 1e200), rudder.clone()),
            record("rudder", time, heading, grown(&rudder, 1e150)),
        ];
        let methods =
            registry::default_settings().into_iter().map(|settings| settings.build().expect("valid defaults"));
        for method in methods {
            for trial in &absurd {
                let error = method.identify(std::slice::from_ref(trial)).expect_err("no manoeuvre");
                assert_eq!(error.kind(), "out-of-range", "{}: {error}", method.id());
            }
        }
    }
}
