use super::*;
use crate::design::CellFacts;
use crate::design::Design;
use crate::rows::StudyRow;
use crate::scenario::{MethodName, Presentation, Prose};
use crate::statistics::Statistic;

fn design(methods: &[&str], cells: usize) -> Design {
    let cell = |index: usize| CellFacts { labels: vec![index.to_string()], values: vec![None], ..CellFacts::default() };
    Design {
        axes: vec!["case".into()],
        methods: methods.iter().map(|&label| MethodName { label: label.into(), id: label.into() }).collect(),
        cells: (0..cells).map(cell).collect(),
        prose: Prose {
            output: Presentation { detail: vec!["0".into()], ..Presentation::default() },
            ..Prose::default()
        },
        ..Design::default()
    }
}

/// Row with relative errors of K and T, %, and intervals of ± 2 %.
fn answer(cell: u64, replicate: u64, method: usize, k: f64, t: f64) -> StudyRow {
    let (true_k, true_t) = (0.1, 20.0);
    let about = |value: f64, truth: f64| [value - 0.02 * truth, value + 0.02 * truth];
    let (k, t) = (true_k * (1.0 + k / 100.0), true_t * (1.0 + t / 100.0));
    StudyRow {
        cell,
        replicate,
        method,
        true_k_per_s: Some(true_k),
        true_t_s: Some(true_t),
        cramer_rao_sd: Some([0.001, 0.2, 1e-4]),
        k_per_s: Some(k),
        k_ci95_per_s: Some(about(k, true_k)),
        t_s: Some(t),
        t_ci95_s: Some(about(t, true_t)),
        heading_rmse_deg: Some(0.5),
        evaluations: Some(7.0),
        ..StudyRow::default()
    }
}

fn near(figure: Option<Statistic>, value: f64) {
    let computed = figure.expect("defined").value;
    assert!((computed - value).abs() < 1e-9 * value.abs().max(1.0), "{computed}, {value} expected");
}

/// Errors of −3, −2, … 3 % of K, and of T a tenth of that.
fn ladder() -> Vec<StudyRow> {
    (0..7).map(|r| answer(0, r, 0, r as f64 - 3.0, 0.1 * (r as f64 - 3.0))).collect()
}

#[test]
fn figures_are_those_of_the_errors() {
    let summary = summarise(&ladder(), &design(&["output-error"], 1));
    let performance = summary.performance(0, 0).expect("one cell");
    let sd = (28.0_f64 / 6.0).sqrt();
    near(performance.k.mean, 0.0);
    near(performance.k.median, 0.0);
    near(performance.k.sd, sd);
    near(performance.k.rms, 2.0);
    near(performance.k.mad, 2.0);
    near(performance.k.quantiles[1], -1.5);
    near(performance.k.median_absolute_error, 2.0);
    // Five of seven intervals of ± 2 % contain the truth; two of these have an end at it, where rounding decides.
    let coverage = performance.k.coverage.expect("quoted").value * 7.0;
    assert!((3.0..=5.0).contains(&coverage.round()), "{coverage}");
    near(performance.t.coverage, 1.0);
    near(performance.k.sd_over_bound, sd);
    near(performance.t.sd_over_bound, 0.1 * sd);
    near(performance.k.share_with_interval, 1.0);
    near(performance.k.median_interval_width, 4.0);
    near(performance.heading_rmse_deg, 0.5);
    assert_eq!((performance.trials, performance.failed(), performance.mean_evaluations), (7, 0, Some(7.0)));
    assert_eq!(performance.validation_rmse_deg, None);
    assert_eq!(summary.overall[0], *performance, "one cell is all cells");
}

#[test]
fn failures_count_and_do_not_spoil() {
    let mut rows = ladder();
    rows.extend((7..10).map(|replicate| StudyRow {
        replicate,
        failure: Some("not-excited".into()),
        ..StudyRow::default()
    }));
    let summary = summarise(&rows, &design(&["output-error"], 1));
    let performance = summary.performance(0, 0).expect("one cell");
    assert_eq!(
        (performance.failed(), performance.failure_counts.as_slice()),
        (3, [("not-excited".to_owned(), 3)].as_slice())
    );
    near(performance.failure_rate, 0.3);
    near(performance.k.rms, 2.0);
}

#[test]
fn methods_are_compared_on_the_same_trials() {
    let mut rows = Vec::new();
    for r in 0..40u64 {
        let error = if r % 2 == 0 { 1.0 } else { -1.0 };
        // The second method fails in some trials; only trials with both estimates count.
        rows.push(match r % 4 {
            3 => StudyRow { replicate: r, method: 0, failure: Some("singular".into()), ..StudyRow::default() },
            _ => answer(0, r, 0, 3.0 * error, 0.5 * error),
        });
        rows.push(answer(0, r, 1, error, error));
    }
    let summary = summarise(&rows, &design(&["srivc", "output-error"], 1));
    assert_eq!(summary.reference, 1);
    let [pair] = summary.comparisons.as_slice() else { panic!("one method beside the reference") };
    assert_eq!((pair.method, pair.trials), (0, 30));
    near(pair.k.rms_difference, 2.0);
    near(pair.k.rms_ratio, 3.0);
    near(pair.k.smaller_error_share, 0.0);
    near(pair.t.rms_ratio, 0.5);
    near(pair.t.smaller_error_share, 1.0);
}

#[test]
fn cells_are_told_apart_and_pooled() {
    let mut rows = ladder();
    rows.extend(
        ladder()
            .into_iter()
            .map(|row| StudyRow { cell: 2, ..row })
            .map(|row| StudyRow { k_per_s: row.k_per_s.map(|k| k + 0.01), ..row }),
    );
    let summary = summarise(&rows, &design(&["output-error"], 3));
    near(summary.performance(0, 0).expect("rows").k.median, 0.0);
    near(summary.performance(2, 0).expect("rows").k.median, 10.0);
    assert!(summary.performance(1, 0).is_none(), "a cell without rows");
    near(summary.overall[0].k.mean, 5.0);
    assert_eq!(summary.details.len(), 1);
}

#[test]
fn one_trial_has_no_interval() {
    let summary = summarise(&ladder()[..1], &design(&["output-error"], 1));
    let performance = summary.performance(0, 0).expect("rows");
    assert_eq!((performance.k.sd, performance.k.rms.expect("one").ci95), (None, None));
    assert_eq!(summarise(&[], &design(&["output-error"], 1)).methods, []);
}
