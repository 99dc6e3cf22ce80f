//! What the rows say: bias, spread, failures and coverage of every method in every cell, each with its own uncertainty.

use crate::engine::CellFacts;
use crate::rows::Row;
use crate::statistics::{self, Figure};

/// Errors of one index over the replicates of a cell, relative to the truth.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Errors {
    /// Median error, per cent.
    pub median_percent: Option<Figure>,
    /// Root mean square error, per cent.
    pub rms_percent: Option<Figure>,
    /// Standard deviation, per cent.
    pub sd_percent: Option<Figure>,
    /// Share of trials whose quoted 95 % interval holds the truth, of those that quote one.
    pub coverage: Option<Figure>,
    /// Standard deviation over the Cramér–Rao bound of the cell.
    pub sd_over_bound: Option<Figure>,
}

/// One method in one cell.
#[derive(Debug, Clone, PartialEq)]
pub struct MethodSummary {
    /// Index of the cell.
    pub cell: usize,
    /// Label of the method.
    pub method: String,
    /// Trials run.
    pub trials: usize,
    /// Trials without an estimate, and the reasons with their counts.
    pub failures: Vec<(String, usize)>,
    /// Errors of K.
    pub k: Errors,
    /// Errors of T.
    pub t: Errors,
    /// Median over trials of the heading error of the replay, deg.
    pub heading_rmse_deg: Option<Figure>,
}

impl MethodSummary {
    /// Number of failed trials.
    pub fn failed(&self) -> usize {
        self.failures.iter().map(|(_, count)| count).sum()
    }
}

/// Summarises rows, cell by cell, methods in the order in which they appear.
pub fn summarise(rows: &[Row], facts: &[CellFacts]) -> Vec<MethodSummary> {
    let mut summaries = Vec::new();
    for (cell, facts) in facts.iter().enumerate() {
        let of_cell: Vec<&Row> = rows.iter().filter(|row| row.cell == cell as u64).collect();
        let mut methods: Vec<&str> = Vec::new();
        for row in &of_cell {
            if !methods.contains(&row.method.as_str()) {
                methods.push(&row.method);
            }
        }
        for method in methods {
            let own: Vec<&Row> = of_cell.iter().copied().filter(|row| row.method == method).collect();
            summaries.push(one_method(cell, method, &own, facts));
        }
    }
    summaries
}

fn one_method(cell: usize, method: &str, rows: &[&Row], facts: &CellFacts) -> MethodSummary {
    let mut failures: Vec<(String, usize)> = Vec::new();
    for reason in rows.iter().filter_map(|row| row.reason.as_ref()) {
        match failures.iter_mut().find(|(known, _)| known == reason) {
            Some((_, count)) => *count += 1,
            None => failures.push((reason.clone(), 1)),
        }
    }
    let rmse: Vec<f64> = rows.iter().filter_map(|row| row.heading_rmse_deg).collect();
    MethodSummary {
        cell,
        method: method.to_owned(),
        trials: rows.len(),
        failures,
        k: errors(rows, facts.bound_k_percent, |row| (row.k_per_s, row.true_k_per_s, row.k_ci95_per_s)),
        t: errors(rows, facts.bound_t_percent, |row| (row.t_s, row.true_t_s, row.t_ci95_s)),
        heading_rmse_deg: statistics::median(&rmse),
    }
}

/// Value, truth and interval of one index in a row.
type Index = (Option<f64>, Option<f64>, Option<[f64; 2]>);

fn errors(rows: &[&Row], bound_percent: Option<f64>, index: impl Fn(&Row) -> Index) -> Errors {
    let percent: Vec<f64> = rows
        .iter()
        .filter_map(|row| {
            let (value, truth, _) = index(row);
            Some(100.0 * (value? / truth? - 1.0))
        })
        .collect();
    let held: Vec<bool> = rows
        .iter()
        .filter_map(|row| {
            let (_, truth, interval) = index(row);
            let ([low, high], truth) = (interval?, truth?);
            Some(low <= truth && truth <= high)
        })
        .collect();
    let sd_percent = statistics::standard_deviation(&percent);
    let over = |figure: Figure, bound: f64| Figure {
        value: figure.value / bound,
        ci95: figure.ci95.map(|ends| ends.map(|end| end / bound)),
    };
    Errors {
        median_percent: statistics::median(&percent),
        rms_percent: statistics::rms(&percent),
        sd_percent,
        coverage: statistics::share(held.iter().filter(|&&held| held).count(), held.len()),
        sd_over_bound: sd_percent.zip(bound_percent).map(|(sd, bound)| over(sd, bound)),
    }
}
