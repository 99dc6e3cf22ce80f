//! Coverage of the intervals of predictions, by characteristic of the manoeuvre.

use std::array;
use std::sync::LazyLock;

use estimation::statistics::median;
use predict::imo::imo_limit;

use crate::rows::{PredictedCharacteristic, StudyRow};
use crate::statistics::{Statistic, wilson_share};

/// Predictions of one characteristic of a manoeuvre by one method in one cell.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct PredictionSummary {
    /// Index of the cell.
    pub cell: usize,
    /// Index of the method.
    pub method: usize,
    /// Manoeuvre and characteristic, with the unit.
    pub characteristic: Box<str>,
    /// Number of trials with the characteristic.
    pub trials: u64,
    /// IMO criterion of the characteristic, with the decisions on it; `None` for a characteristic without a limit.
    pub criterion: Option<ImoDecisionTally>,
    /// For the 90 % intervals scaled about the median by each of [`INTERVAL_SCALES`]: number of trials whose interval
    /// contains the true value, and sum of the interval scores of all trials.
    scaled: Vec<(u64, f64)>,
    /// Sums over trials: error of the median, its square, width of the interval, true value.
    sums: [f64; 4],
}

/// Nominal coverage of the intervals.
const NOMINAL: f64 = 0.9;

/// Factors of intervals about the median, among which the factor of nominal coverage is sought: 1/8 to 32, 9 % apart.
static INTERVAL_SCALES: LazyLock<[f64; 65]> =
    LazyLock::new(|| array::from_fn(|place| ((place as f64 - UNSCALED as f64) / 8.0).exp2()));

/// Place of the factor 1 in [`INTERVAL_SCALES`].
const UNSCALED: usize = 24;

/// Interval score of a 90 % interval: its width, and 20 times the distance of the true value from it; small is good.
///
/// Source: T. Gneiting and A. E. Raftery (2007), Strictly proper scoring rules, prediction, and estimation, eq. (43).
fn interval_score([low, high]: [f64; 2], truth: f64) -> f64 {
    high - low + 2.0 / (1.0 - NOMINAL) * ((low - truth).max(0.0) + (truth - high).max(0.0))
}

/// Scaling of the intervals of one ship by the smallest factor that covers 90 % of the characteristics of other ships.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ConformalScaling {
    /// Factor on both parts of an interval, below and above its median.
    pub factor: f64,
    /// Mean coverage over the characteristics, unscaled and scaled.
    pub coverage: [f64; 2],
    /// Median over the characteristics of the interval score, relative to the true value, unscaled and scaled.
    pub score: [f64; 2],
}

impl ConformalScaling {
    /// Scaling of `predictions` by the factor of the `calibration` predictions, with equal weights of all
    /// characteristics.
    ///
    /// `None` if either is empty, or if no factor covers enough. The ships are taken as exchangeable, not the trials,
    /// which differ only in noise.
    ///
    /// Source: V. Vovk, A. Gammerman and G. Shafer (2005), Algorithmic Learning in a Random World.
    pub fn from_calibration(predictions: &[&PredictionSummary], calibration: &[&PredictionSummary]) -> Option<Self> {
        let coverage = |lines: &[&PredictionSummary], place: usize| {
            lines.iter().map(|line| line.share_inside(place)).sum::<f64>() / lines.len() as f64
        };
        let place = (0..INTERVAL_SCALES.len()).find(|place| coverage(calibration, *place) >= NOMINAL)?;
        let relative = |line: &&PredictionSummary, place: usize| line.relative_to_truth(line.mean_score(place));
        let score = |place| median(&mut predictions.iter().map(|line| relative(line, place)).collect::<Vec<_>>());
        Some(Self {
            factor: INTERVAL_SCALES[place],
            coverage: [UNSCALED, place].map(|place| coverage(predictions, place)),
            score: [score(UNSCALED)?, score(place)?],
        })
    }
}

/// Decisions on an IMO criterion: a 90 % interval on one side of the limit is a decision with a probability of at least
/// 95 %.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct ImoDecisionTally {
    /// Name of the criterion.
    pub name: Box<str>,
    /// Maximum allowed value, in the unit of the characteristic.
    pub limit: f64,
    /// Number of trials whose ship meets the criterion.
    pub meeting_trials: u64,
    /// Number of trials with a correct decision.
    pub right: u64,
    /// Number of trials with a wrong decision.
    pub wrong: u64,
}

impl ImoDecisionTally {
    fn add(&mut self, figure: &PredictedCharacteristic) {
        let is_met = figure.truth <= self.limit;
        let [low, high] = figure.ci90;
        self.meeting_trials += u64::from(is_met);
        self.right += u64::from(if is_met { high <= self.limit } else { low > self.limit });
        self.wrong += u64::from(if is_met { low > self.limit } else { high <= self.limit });
    }
}

impl PredictionSummary {
    /// Share of the trials whose 90 % interval contains the true value, with its 95 % interval.
    pub fn coverage(&self) -> Option<Statistic> {
        wilson_share(self.scaled[UNSCALED].0, self.trials)
    }

    /// Share of the trials whose 90 % interval contains the true value.
    pub fn inside_share(&self) -> f64 {
        self.share_inside(UNSCALED)
    }

    fn mean(&self, place: usize) -> f64 {
        self.sums[place] / self.trials as f64
    }

    /// Mean error of the median, in the unit of the characteristic.
    pub fn median_bias(&self) -> f64 {
        self.mean(0)
    }

    /// Root mean square error of the median, in the unit of the characteristic.
    pub fn rms_error(&self) -> f64 {
        self.mean(1).sqrt()
    }

    /// Mean width of the 90 % interval, in the unit of the characteristic.
    pub fn mean_interval_width(&self) -> f64 {
        self.mean(2)
    }

    /// Mean true value, in the unit of the characteristic.
    pub fn mean_truth(&self) -> f64 {
        self.mean(3)
    }

    /// Mean interval score, in the unit of the characteristic.
    pub fn mean_interval_score(&self) -> f64 {
        self.mean_score(UNSCALED)
    }

    /// `value`, in the unit of the characteristic, over the absolute mean true value.
    pub fn relative_to_truth(&self, value: f64) -> f64 {
        value / self.mean_truth().abs()
    }

    fn share_inside(&self, place: usize) -> f64 {
        self.scaled[place].0 as f64 / self.trials as f64
    }

    fn mean_score(&self, place: usize) -> f64 {
        self.scaled[place].1 / self.trials as f64
    }
}

/// Adds the predictions of a row; `length_over_speed` is L/V of the ship, s, on which IMO limits depend.
pub(super) fn add_predictions(lines: &mut Vec<PredictionSummary>, row: &StudyRow, length_over_speed: Option<f64>) {
    for figure in row.predictions.iter().flatten() {
        let at = lines.iter().position(|line| line.characteristic == figure.name).unwrap_or_else(|| {
            let (cell, method, name) = (row.cell as usize, row.method, figure.name.clone());
            let limited = length_over_speed.and_then(|scale| imo_limit(&name, scale));
            let criterion = limited.map(|(name, limit)| ImoDecisionTally {
                name: name.into(),
                limit,
                ..ImoDecisionTally::default()
            });
            let scaled = vec![(0, 0.0); INTERVAL_SCALES.len()];
            lines.push(PredictionSummary {
                cell,
                method,
                characteristic: name,
                criterion,
                scaled,
                ..PredictionSummary::default()
            });
            lines.len() - 1
        });
        let line = &mut lines[at];
        line.trials += 1;
        line.criterion.iter_mut().for_each(|tally| tally.add(figure));
        let error = figure.median - figure.truth;
        let added = [error, error * error, figure.ci90[1] - figure.ci90[0], figure.truth];
        line.sums.iter_mut().zip(added).for_each(|(sum, value)| *sum += value);
        for (scale, (inside, score)) in INTERVAL_SCALES.iter().zip(&mut line.scaled) {
            // The unscaled interval keeps its ends to the last digit.
            let [low, high] = figure.ci90.map(|end| end + (scale - 1.0) * (end - figure.median));
            *inside += u64::from((low..=high).contains(&figure.truth));
            *score += interval_score([low, high], figure.truth);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn intervals_are_counted_where_they_hold() {
        let row = |truth: f64| {
            let figure = PredictedCharacteristic {
                name: "zig-zag 10/10 period_s".into(),
                truth,
                median: 100.0,
                ci90: [98.0, 103.0],
            };
            StudyRow { predictions: Some([figure].into()), ..StudyRow::default() }
        };
        let mut lines = Vec::new();
        [99.0, 103.0, 97.0, 101.0].into_iter().for_each(|truth| add_predictions(&mut lines, &row(truth), None));
        add_predictions(&mut lines, &StudyRow::default(), None);
        let [first] = lines.try_into().expect("one figure");
        assert_eq!((first.trials, first.scaled[UNSCALED].0), (4, 3));
        assert_eq!((first.median_bias(), first.mean_interval_width(), first.mean_truth()), (0.0, 5.0, 100.0));
        assert!((first.rms_error() - 5f64.sqrt()).abs() < 1e-12);
        assert_eq!(first.coverage().expect("trials").value, 0.75);
        // Width 5 in every trial, and 20 times the 1 that the third lies below its interval.
        assert!((first.mean_interval_score() - (5.0 + 20.0 / 4.0)).abs() < 1e-9);
    }

    /// Intervals of ±1 whose true values lie 2 off need twice the width; the ship with errors of 1 does not.
    #[test]
    fn the_factor_of_other_ships_is_applied() {
        let ship = |error: f64| {
            let figure = |error: f64| PredictedCharacteristic {
                name: "zig-zag 10/10 period_s".into(),
                truth: 100.0 + error,
                median: 100.0,
                ci90: [99.0, 101.0],
            };
            let mut lines = Vec::new();
            for sign in [-1.0, 1.0] {
                let predicted = Some([figure(sign * error)].into());
                add_predictions(&mut lines, &StudyRow { predictions: predicted, ..StudyRow::default() }, None);
            }
            lines.remove(0)
        };
        let (near, far) = (ship(1.0), ship(2.0));
        let scaling = ConformalScaling::from_calibration(&[&near], &[&far]).expect("both are there");
        assert_eq!((scaling.factor, scaling.coverage), (2.0, [1.0, 1.0]));
        assert!((scaling.score[0] - 0.02).abs() < 1e-12 && (scaling.score[1] - 0.04).abs() < 1e-12);
        let scaling = ConformalScaling::from_calibration(&[&far], &[&near]).expect("both are there");
        assert_eq!((scaling.factor, scaling.coverage), (1.0, [0.0, 0.0]));
        // Width 2 and 20 times 1, of 100.
        assert!((scaling.score[1] - 0.22).abs() < 1e-9);
        assert_eq!(ConformalScaling::from_calibration(&[&near], &[]), None);
        assert_eq!(ConformalScaling::from_calibration(&[&near], &[&ship(50.0)]), None);
    }

    /// The limit is 5 + L/(2V) = 15°.
    #[test]
    fn decisions_on_a_criterion_are_counted() {
        let mut lines = Vec::new();
        for (truth, low, high) in [(12.0, 10.0, 14.0), (12.0, 10.0, 16.0), (18.0, 10.0, 14.0), (18.0, 16.0, 20.0)] {
            let (name, ci90) = ("zig-zag 10/10 first_overshoot_deg".into(), [low, high]);
            let figure = PredictedCharacteristic { name, truth, median: 13.0, ci90 };
            add_predictions(
                &mut lines,
                &StudyRow { predictions: Some([figure].into()), ..StudyRow::default() },
                Some(20.0),
            );
        }
        let tally = lines[0].criterion.as_ref().expect("it is limited");
        assert_eq!((tally.limit, tally.meeting_trials, tally.right, tally.wrong), (15.0, 2, 2, 1));
    }
}
