//! Whether the intervals of predictions hold, figure by figure.

use predict::imo::limit_of;
use serde::{Deserialize, Serialize};

use crate::rows::{PredictedFigure, StudyRow};
use crate::statistics::{Statistic, share};

/// One figure of a manoeuvre in one cell, predicted from the answers of one method.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct PredictionSummary {
    /// Index of the cell.
    pub cell: usize,
    /// Index of the method.
    pub method: usize,
    /// Manoeuvre and figure, with the unit.
    pub name: Box<str>,
    /// Trials with the figure.
    pub trials: u64,
    /// Trials whose 90 % interval holds what the ship does.
    pub inside: u64,
    /// The criterion of IMO that limits the figure, and what was told of it.
    pub criterion: Option<CriterionTally>,
    /// Sums of the median less what the ship does, of its square, of the width of the interval, and of what the
    /// ship does.
    sums: [f64; 4],
}

/// What predictions tell of a limit: an interval of 90 % on one side of it gives a probability of 95 % or more.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct CriterionTally {
    /// What it is called.
    pub name: Box<str>,
    /// Largest value.
    pub limit: f64,
    /// Trials whose ship keeps within it.
    pub kept: u64,
    /// Trials of which it was told on which side the ship is, and that was so.
    pub right: u64,
    /// Trials of which the other side was told.
    pub wrong: u64,
}

impl CriterionTally {
    fn add(&mut self, figure: &PredictedFigure) {
        let is_kept = figure.truth <= self.limit;
        let [low, high] = figure.ci90;
        self.kept += u64::from(is_kept);
        self.right += u64::from(if is_kept { high <= self.limit } else { low > self.limit });
        self.wrong += u64::from(if is_kept { low > self.limit } else { high <= self.limit });
    }
}

impl PredictionSummary {
    /// Share of the trials whose interval holds what the ship does.
    pub fn coverage(&self) -> Option<Statistic> {
        share(self.inside, self.trials)
    }

    fn mean(&self, place: usize) -> f64 {
        self.sums[place] / self.trials as f64
    }

    /// Mean of the median less what the ship does.
    pub fn bias(&self) -> f64 {
        self.mean(0)
    }

    /// Root mean square of that.
    pub fn rms(&self) -> f64 {
        self.mean(1).sqrt()
    }

    /// Mean width of the 90 % interval.
    pub fn width(&self) -> f64 {
        self.mean(2)
    }

    /// Mean of what the ships do.
    pub fn truth(&self) -> f64 {
        self.mean(3)
    }
}

/// Takes note of a row of one method in one cell, whose ship has this L/V, s.
pub(super) fn add_predictions(lines: &mut Vec<PredictionSummary>, row: &StudyRow, length_over_speed: Option<f64>) {
    for figure in row.predicted.iter().flatten() {
        let at = lines.iter().position(|line| line.name == figure.name).unwrap_or_else(|| {
            let (cell, method, name) = (row.cell as usize, row.method, figure.name.clone());
            let limited = length_over_speed.and_then(|scale| limit_of(&name, scale));
            let criterion =
                limited.map(|(name, limit)| CriterionTally { name: name.into(), limit, ..CriterionTally::default() });
            lines.push(PredictionSummary { cell, method, name, criterion, ..PredictionSummary::default() });
            lines.len() - 1
        });
        let line = &mut lines[at];
        line.trials += 1;
        line.inside += u64::from(figure.holds());
        line.criterion.iter_mut().for_each(|own| own.add(figure));
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
            let figure =
                PredictedFigure { name: "zig-zag 10/10 period_s".into(), truth, median: 100.0, ci90: [98.0, 103.0] };
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
    fn what_is_told_of_a_criterion_is_counted() {
        let mut lines = Vec::new();
        for (truth, low, high) in [(12.0, 10.0, 14.0), (12.0, 10.0, 16.0), (18.0, 10.0, 14.0), (18.0, 16.0, 20.0)] {
            let (name, ci90) = ("zig-zag 10/10 first_overshoot_deg".into(), [low, high]);
            let figure = PredictedFigure { name, truth, median: 13.0, ci90 };
            add_predictions(
                &mut lines,
                &StudyRow { predicted: Some([figure].into()), ..StudyRow::default() },
                Some(20.0),
            );
        }
        let told = lines[0].criterion.as_ref().expect("it is limited");
        assert_eq!((told.limit, told.kept, told.right, told.wrong), (15.0, 2, 2, 1));
    }
}
