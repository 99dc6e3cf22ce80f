//! Coverage of the intervals of predictions, by characteristic of the manoeuvre.

use predict::imo::limit_of;
use serde::{Deserialize, Serialize};

use crate::rows::{PredictedCharacteristic, StudyRow};
use crate::statistics::{Statistic, wilson_share};

/// Predictions of one characteristic of a manoeuvre by one method in one cell.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct PredictionSummary {
    /// Index of the cell.
    pub cell: usize,
    /// Index of the method.
    pub method: usize,
    /// Manoeuvre and characteristic, with the unit.
    pub name: Box<str>,
    /// Number of trials with the characteristic.
    pub trials: u64,
    /// Number of trials whose 90 % interval contains the true value.
    pub inside: u64,
    /// IMO criterion of the characteristic, with the decisions on it.
    pub criterion: Option<ImoDecisionTally>,
    /// Sums over trials: error of the median, its square, width of the interval, true value.
    sums: [f64; 4],
}

/// Decisions on an IMO criterion: a 90 % interval on one side of the limit is a decision with a probability of at least
/// 95 %.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct ImoDecisionTally {
    /// Name of the criterion.
    pub name: Box<str>,
    /// Maximum allowed value.
    pub limit: f64,
    /// Number of trials whose ship meets it.
    pub kept: u64,
    /// Number of trials with a correct decision.
    pub right: u64,
    /// Number of trials with a wrong decision.
    pub wrong: u64,
}

impl ImoDecisionTally {
    fn add(&mut self, figure: &PredictedCharacteristic) {
        let is_kept = figure.truth <= self.limit;
        let [low, high] = figure.ci90;
        self.kept += u64::from(is_kept);
        self.right += u64::from(if is_kept { high <= self.limit } else { low > self.limit });
        self.wrong += u64::from(if is_kept { low > self.limit } else { high <= self.limit });
    }
}

impl PredictionSummary {
    /// Coverage of the 90 % intervals.
    pub fn coverage(&self) -> Option<Statistic> {
        wilson_share(self.inside, self.trials)
    }

    fn mean(&self, place: usize) -> f64 {
        self.sums[place] / self.trials as f64
    }

    /// Mean error of the median.
    pub fn bias(&self) -> f64 {
        self.mean(0)
    }

    /// Root mean square error of the median.
    pub fn rms(&self) -> f64 {
        self.mean(1).sqrt()
    }

    /// Mean width of the 90 % interval.
    pub fn width(&self) -> f64 {
        self.mean(2)
    }

    /// Mean true value.
    pub fn truth(&self) -> f64 {
        self.mean(3)
    }
}

/// Adds the predictions of a row; `length_over_speed` is L/V of the ship, s.
pub(super) fn add_predictions(lines: &mut Vec<PredictionSummary>, row: &StudyRow, length_over_speed: Option<f64>) {
    for figure in row.predicted.iter().flatten() {
        let at = lines.iter().position(|line| line.name == figure.name).unwrap_or_else(|| {
            let (cell, method, name) = (row.cell as usize, row.method, figure.name.clone());
            let limited = length_over_speed.and_then(|scale| limit_of(&name, scale));
            let criterion = limited.map(|(name, limit)| ImoDecisionTally {
                name: name.into(),
                limit,
                ..ImoDecisionTally::default()
            });
            lines.push(PredictionSummary { cell, method, name, criterion, ..PredictionSummary::default() });
            lines.len() - 1
        });
        let line = &mut lines[at];
        line.trials += 1;
        line.inside += u64::from(figure.covers_truth());
        line.criterion.iter_mut().for_each(|tally| tally.add(figure));
        let error = figure.median - figure.truth;
        let added = [error, error * error, figure.ci90[1] - figure.ci90[0], figure.truth];
        line.sums.iter_mut().zip(added).for_each(|(sum, value)| *sum += value);
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
            StudyRow { predicted: Some([figure].into()), ..StudyRow::default() }
        };
        let mut lines = Vec::new();
        [99.0, 103.0, 97.0, 101.0].into_iter().for_each(|truth| add_predictions(&mut lines, &row(truth), None));
        add_predictions(&mut lines, &StudyRow::default(), None);
        let [first] = lines.try_into().expect("one figure");
        assert_eq!((first.trials, first.inside), (4, 3));
        assert_eq!((first.bias(), first.width(), first.truth()), (0.0, 5.0, 100.0));
        assert!((first.rms() - 5f64.sqrt()).abs() < 1e-12);
        assert_eq!(first.coverage().expect("trials").value, 0.75);
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
                &StudyRow { predicted: Some([figure].into()), ..StudyRow::default() },
                Some(20.0),
            );
        }
        let tally = lines[0].criterion.as_ref().expect("it is limited");
        assert_eq!((tally.limit, tally.kept, tally.right, tally.wrong), (15.0, 2, 2, 1));
    }
}
