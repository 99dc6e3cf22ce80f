//! Evaluation of the stopping rule: the standard error of a statistic in the current cell, from running sums
//! (sequential estimation, Chow and Robbins 1965).

use crate::rows::StudyRow;
use crate::scenario::{NomotoIndex, StopFigure, StopRule};
use crate::statistics::Moments;

/// State of a stopping rule in the current cell.
#[derive(Clone)]
pub struct StopCheck {
    rule: StopRule,
    /// Index of the method of the rule; `None` if all methods must meet it.
    method: Option<usize>,
    cell: u64,
    methods: Vec<FigureSums>,
}

impl StopCheck {
    /// State before any row; `labels` are those of all methods, in the order of the scenario.
    pub fn new<'a>(rule: &StopRule, labels: impl Iterator<Item = &'a str>) -> Self {
        let labels: Vec<&str> = labels.collect();
        let method = rule.method.as_deref().and_then(|method| labels.iter().position(|label| *label == method));
        Self { rule: rule.clone(), method, cell: 0, methods: vec![FigureSums::default(); labels.len()] }
    }

    /// Adds a row; a row of another cell resets the state.
    pub fn add(&mut self, row: &StudyRow) {
        if row.cell != self.cell {
            self.cell = row.cell;
            self.methods.fill(FigureSums::default());
        }
        let sums = &mut self.methods[row.method];
        let (place, ends) = match self.rule.figure.index() {
            NomotoIndex::K => (0, row.k_ci95_per_s),
            NomotoIndex::T => (1, row.t_ci95_s),
        };
        if let Some(error) = row.errors()[place] {
            sums.errors.add(100.0 * error);
        }
        if let Some((truth, [low, high])) = row.true_indices()[place].zip(ends) {
            sums.quoted += 1.0;
            sums.held += f64::from(u8::from(low <= truth && truth <= high));
        }
    }

    /// `true` if the standard error is at most the limit of the rule, for its method or for all methods.
    pub fn is_met(&self) -> bool {
        let met = |sums: &FigureSums| {
            sums.standard_error(self.rule.figure).is_some_and(|error| error <= self.rule.standard_error)
        };
        match self.method {
            Some(method) => met(&self.methods[method]),
            None => self.methods.iter().all(met),
        }
    }
}

/// Moments of relative errors, %, and numbers of quoted intervals and of those that contain the truth (`held`).
#[derive(Debug, Clone, Copy, Default)]
struct FigureSums {
    errors: Moments,
    quoted: f64,
    held: f64,
}

impl FigureSums {
    /// Standard error of a statistic, %, or percentage points for a coverage; `None` below 20 values.
    ///
    /// Source: delta method, Cramér (1946).
    fn standard_error(&self, figure: StopFigure) -> Option<f64> {
        let Moments {
            count: n,
            mean,
            squared_deviation_sum: second,
            cubed_deviation_sum: third,
            fourth_power_sum: fourth,
            ..
        } = self.errors;
        let enough = |count: f64| (count >= 20.0).then_some(count);
        let (m2, m3, m4) = (second / n, third / n, fourth / n);
        match figure {
            StopFigure::MeanK | StopFigure::MeanT => enough(n).map(|n| (m2 / (n - 1.0)).sqrt()),
            // Var(s) ≈ (m₄ − m₂²)/(4 n m₂).
            StopFigure::SdK | StopFigure::SdT if m2 == 0.0 => enough(n).map(|_| 0.0),
            StopFigure::SdK | StopFigure::SdT => enough(n).map(|n| ((m4 - m2 * m2).max(0.0) / (4.0 * n * m2)).sqrt()),
            StopFigure::RmsK | StopFigure::RmsT => {
                let square = m2 + mean * mean;
                // Variance of x² from the central moments of x.
                let spread = m4 + 4.0 * mean * m3 + 4.0 * mean * mean * m2 - m2 * m2;
                let error = if square == 0.0 { 0.0 } else { (spread.max(0.0) / (4.0 * n * square)).sqrt() };
                enough(n).map(|_| error)
            }
            StopFigure::CoverageK | StopFigure::CoverageT => enough(self.quoted).map(|n| {
                // Source: Agresti and Coull (1998); a share of 0 or 1 then has an error.
                let (n, held) = (n + 4.0, self.held + 2.0);
                let share = held / n;
                100.0 * (share * (1.0 - share) / n).sqrt()
            }),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn standard_errors_are_those_of_the_sample() {
        // Two-point sample ±1 about 3: m₂ = 1, m₃ = 0, m₄ = 1.
        let mut sums = FigureSums::default();
        (0..100).for_each(|k| sums.errors.add(if k % 2 == 0 { 2.0 } else { 4.0 }));
        let error = |figure| sums.standard_error(figure).expect("enough values");
        assert!((error(StopFigure::MeanK) - (1.0_f64 / 99.0).sqrt()).abs() < 1e-12);
        assert!(error(StopFigure::SdK) < 1e-7, "a two-point sample has a standard deviation without scatter");
        // Var(x²) = 4·9·1; error of √10 is √36/(2·√10·10).
        assert!((error(StopFigure::RmsK) - 6.0 / (20.0 * 10.0_f64.sqrt())).abs() < 1e-12);
        assert_eq!(sums.standard_error(StopFigure::CoverageK), None, "no interval was quoted");
    }

    #[test]
    fn the_error_of_a_standard_deviation_is_that_of_a_normal_sample() {
        // Quantiles of a normal distribution: se(s)/s = 1/√(2n).
        let mut sums = FigureSums::default();
        let n = 4000;
        let normal = |p: f64| {
            use statrs::distribution::{ContinuousCDF, Normal};
            Normal::standard().inverse_cdf(p)
        };
        (0..n).for_each(|k| sums.errors.add(2.0 * normal((k as f64 + 0.5) / n as f64)));
        let error = sums.standard_error(StopFigure::SdT).expect("enough values");
        assert!((error / (2.0 / (2.0 * n as f64).sqrt()) - 1.0).abs() < 0.02, "{error}");
    }
}
