//! Summary of a study of measured records: replay errors on fitted records and on validation records.
//!
//! Trials that share a fit or a validation record are not independent. Intervals of medians are percentile bootstraps
//! over fits (Efron 1979), or over validation records if there is only one fit.

use std::collections::BTreeMap;

use estimation::statistics::median;

use crate::design::Design;
use crate::rows::StudyRow;
use crate::statistics::{Statistic, percentile_interval, resample_clusters};

/// Replay errors of one method on the records of a cell.
#[derive(Debug, Clone, PartialEq)]
pub struct RecordSummary {
    /// Index of the cell.
    pub cell: usize,
    /// Index of the method.
    pub method: usize,
    /// Number of fits.
    pub fits: usize,
    /// Number of failed fits.
    pub failed: usize,
    /// Median over fits of the heading error on the fitted records, deg.
    pub fitted_deg: Option<Statistic>,
    /// Median over trials of the heading error on the validation record, deg.
    pub validation_deg: Option<Statistic>,
    /// Median over trials of the ratio of validation errors, this method over the first; `None` for the first
    /// method.
    pub ratio: Option<Statistic>,
    /// Median over trials of the ratio of the validation errors of replays restarted every 60 s; `None` for the first
    /// method.
    pub window_ratio: Option<Statistic>,
    /// Number of fits that named each effect.
    pub named: BTreeMap<String, usize>,
}

/// Summaries of a study of measured records, by cell and method.
pub fn record_summaries(rows: &[StudyRow], design: &Design) -> Vec<RecordSummary> {
    let cells = (0..design.cells.len()).flat_map(|cell| (0..design.methods.len()).map(move |method| (cell, method)));
    cells.map(|(cell, method)| summary(rows, design, cell, method)).collect()
}

fn summary(rows: &[StudyRow], design: &Design, cell: usize, method: usize) -> RecordSummary {
    let rows_of = |method: usize| {
        let is_own = move |row: &&StudyRow| row.cell == cell as u64 && row.method == method;
        rows.iter().filter(is_own).collect::<Vec<&StudyRow>>()
    };
    let (method_rows, first) = (rows_of(method), rows_of(0));
    let records = &design.cells[cell].records;
    let fit = |row: &StudyRow| records[row.replicate as usize].fitted.as_str();
    let mut fits: Vec<&StudyRow> = Vec::new();
    for row in &method_rows {
        if fits.last().is_none_or(|last| fit(last) != fit(row)) {
            fits.push(row);
        }
    }
    let group = |row: &StudyRow| match fits.len() {
        1 => row.replicate as usize,
        _ => fits.iter().position(|fitted| fit(fitted) == fit(row)).unwrap_or(0),
    };
    let grouped = |values: &mut dyn Iterator<Item = (usize, Option<f64>)>| {
        let mut groups: BTreeMap<usize, Vec<f64>> = BTreeMap::new();
        values.for_each(|(place, value)| groups.entry(place).or_default().extend(value));
        middle(&groups.into_values().collect::<Vec<_>>())
    };
    let ratio = |error: fn(&StudyRow) -> Option<f64>| {
        let over = |(row, other): (&&StudyRow, &&StudyRow)| Some(error(row)? / error(other)?);
        let mut pairs = method_rows.iter().zip(&first).map(|pair| (group(pair.0), over(pair)));
        (method > 0).then(|| grouped(&mut pairs)).flatten()
    };
    let mut named: BTreeMap<String, usize> = BTreeMap::new();
    for effect in fits.iter().filter_map(|row| row.traced.as_ref()).flat_map(|traced| &traced.named_effects) {
        *named.entry(effect.id.to_string()).or_default() += 1;
    }
    RecordSummary {
        cell,
        method,
        fits: fits.len(),
        failed: fits.iter().filter(|row| row.failure.is_some()).count(),
        fitted_deg: grouped(&mut fits.iter().map(|row| (group(row), row.heading_rmse_deg))),
        validation_deg: grouped(&mut method_rows.iter().map(|row| (group(row), row.validation_rmse_deg))),
        ratio: ratio(|row| row.validation_rmse_deg),
        window_ratio: ratio(|row| row.validation_60_s_rmse_deg),
        named,
    }
}

/// Median of all values, with an interval for six groups or more; `None` without values.
fn middle(groups: &[Vec<f64>]) -> Option<Statistic> {
    let values = groups.concat();
    let median_of = |places: &[usize]| median(&mut places.iter().map(|&place| values[place]).collect::<Vec<f64>>());
    let mut end = 0;
    let clusters: Vec<Vec<usize>> = groups
        .iter()
        .map(|group| {
            end += group.len();
            (end - group.len()..end).collect()
        })
        .collect();
    let value = median_of(&clusters.concat())?;
    let drawn = resample_clusters(&clusters, median_of).into_iter().flatten().collect();
    Some(Statistic { value, ci95: percentile_interval(groups.len(), drawn) })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::design::{CellFacts, TrialRecords};
    use crate::rows::{NamedEffect, TraceRow};
    use crate::scenario::MethodName;

    /// Seven records, each fitted alone and validated on the six others.
    fn design() -> Design {
        let name = |number: usize| format!("r{number}");
        let pairs = (0..7).flat_map(|fit| {
            (0..7).filter(move |validation| *validation != fit).map(move |validation| (fit, validation))
        });
        let records =
            pairs.map(|(fit, validation)| TrialRecords { fitted: name(fit), validation: Some(name(validation)) });
        let method = |label: &str| MethodName { label: label.into(), id: label.into() };
        Design {
            methods: vec![method("output-error"), method("trace")],
            cells: vec![CellFacts { records: records.collect(), stored_replicates: 0..42, ..CellFacts::default() }],
            ..Design::default()
        }
    }

    #[test]
    fn methods_are_compared_on_the_same_trial() {
        let named = NamedEffect { id: "speed_loss".into(), ..NamedEffect::default() };
        let rows = (0..42).flat_map(|replicate| {
            let fit = replicate / 6;
            let error = 1.0 + replicate as f64;
            let row = |method: usize, error: f64| StudyRow {
                replicate,
                method,
                heading_rmse_deg: Some(0.1 * (1.0 + fit as f64)),
                validation_rmse_deg: Some(error),
                ..StudyRow::default()
            };
            let traced = TraceRow { named_effects: vec![named.clone()], ..TraceRow::default() };
            [row(0, error), StudyRow { traced: Some(Box::new(traced)), ..row(1, 0.25 * error) }]
        });
        let rows: Vec<StudyRow> = rows.collect();
        let [first, trace] = &record_summaries(&rows, &design())[..] else { panic!("two methods") };
        assert_eq!((first.fits, first.failed, first.ratio), (7, 0, None));
        assert_eq!(first.validation_deg.map(|figure| figure.value), Some(21.5));
        assert!((first.fitted_deg.expect("fitted").value - 0.4).abs() < 1e-12);
        assert_eq!(trace.ratio, Some(Statistic { value: 0.25, ci95: Some([0.25, 0.25]) }));
        let [low, high] = first.validation_deg.and_then(|figure| figure.ci95).expect("seven fits");
        assert!(low < 15.0 && high > 28.0, "fits are drawn and not trials: {low} {high}");
        assert_eq!(trace.named, BTreeMap::from([("speed_loss".to_owned(), 7)]));
    }

    #[test]
    fn of_few_fits_there_is_no_interval() {
        assert_eq!(middle(&[vec![1.0, 2.0], vec![4.0]]), Some(Statistic { value: 2.0, ci95: None }));
        assert_eq!(middle(&[]), None);
    }
}
