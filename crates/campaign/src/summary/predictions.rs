//! Whether the intervals of predictions hold, figure by figure.

use serde::{Deserialize, Serialize};

use crate::rows::StudyRow;
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
    /// Sums of the median less what the ship does, of its square, of the width of the interval, and of what the
    /// ship does.
    sums: [f64; 4],
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

/// Takes note of a row of one method in one cell.
pub(super) fn add_predictions(lines: &mut Vec<PredictionSummary>, row: &StudyRow) {
    for figure in row.predicted.iter().flatten() {
        let at = lines.iter().position(|line| line.name == figure.name).unwrap_or_else(|| {
            let (cell, method, name) = (row.cell as usize, row.method, figure.name.clone());
            lines.push(PredictionSummary { cell, method, name, ..PredictionSummary::default() });
            lines.len() - 1
        });
        let line = &mut lines[at];
        line.trials += 1;
        line.inside += u64::from(figure.holds());
        let error = figure.median - figure.truth;
        let added = [error, error * error, figure.ci90[1] - figure.ci90[0], figure.truth];
        line.sums.iter_mut().zip(added).for_each(|(sum, value)| *sum += value);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rows::PredictedFigure;

    #[test]
    fn intervals_are_counted_where_they_hold() {
        let row = |truth: f64| {
            let figure =
                PredictedFigure { name: "zig-zag 10/10 period_s".into(), truth, median: 100.0, ci90: [98.0, 103.0] };
            StudyRow { predicted: Some([figure].into()), ..StudyRow::default() }
        };
        let mut lines = Vec::new();
        [99.0, 103.0, 97.0, 101.0].into_iter().for_each(|truth| add_predictions(&mut lines, &row(truth)));
        add_predictions(&mut lines, &StudyRow::default());
        let [first] = lines.try_into().expect("one figure");
        assert_eq!((first.trials, first.inside), (4, 3));
        assert_eq!((first.bias(), first.width(), first.truth()), (0.0, 5.0, 100.0));
        assert!((first.rms() - 5f64.sqrt()).abs() < 1e-12);
        assert_eq!(first.coverage().expect("trials").value, 0.75);
    }
}
