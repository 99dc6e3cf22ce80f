//! Tables of results for the screen, `report.md` and other programs.

use campaign::stored_figures::ReferenceIndices;
use report::number::{self, MISSING};
use report::{Table, TableHead};

use campaign::design::{CellFacts, Design};
use campaign::scenario::{MethodName, TRACE_ID};
use campaign::showcase::Showcase;
use campaign::statistics::Statistic;
use campaign::store::StoredStudy;
use campaign::summary::{IndexErrors, MethodPerformance, MethodSummary, ReferenceComparison, Summary};
use document::method::MethodEntry;

/// Table of the first trial of a cell (a showcase): estimates of the methods, and below them the true and the published
/// values.
pub fn showcase_table(showcase: &Showcase) -> Table {
    let entries: Vec<MethodEntry> = showcase.methods.iter().map(|shown| shown.entry.clone()).collect();
    let mut table = super::method_table::table(&entries, &[]);
    let references = [("truth", showcase.intervals.truth), ("published", showcase.intervals.published)];
    for (name, reference) in references {
        if let Some(ReferenceIndices { k_per_s, t_s }) = reference {
            let (k, t) = (number::significant(k_per_s, 4), number::significant(t_s, 4));
            table.push([name, &k, MISSING, &t]);
        }
    }
    table
}

/// Every statistic of methods in cells, for other programs: `summary.csv`. An interval is two columns.
pub fn method_summary_table(lines: &[MethodSummary], design: &Design) -> Table {
    let mut head = cell_and_method_head(design).counts(["trials", "failed"]);
    for index in ["K", "T", "K/T"] {
        head = ERRORS.iter().fold(head, |head, (name, unit, _)| with_ends(head, &format!("{index} {name}"), unit));
    }
    head = with_ends(head, "failure rate", "%");
    for name in ["heading error", "validation error", "validation error 90 %"] {
        head = with_ends(head, name, "deg");
    }
    let mut table = Table::new(head.numbers(["evaluations"]));
    for line in lines {
        let performance = &line.performance;
        let mut cells = row_labels(design, line.cell, line.method);
        cells.extend([performance.trials.to_string(), performance.failed().to_string()]);
        for errors in [&performance.k, &performance.t, &performance.k_over_t] {
            cells.extend(ERRORS.iter().flat_map(|(.., get)| all_digits(get(errors))));
        }
        let percent = performance.failure_rate.map(|rate| rate.times(100.0));
        for figure in [
            percent,
            performance.heading_rmse_deg,
            performance.validation_rmse_deg,
            performance.validation_rmse_p90_deg,
        ] {
            cells.extend(all_digits(figure));
        }
        cells.push(number::optional(performance.mean_evaluations, 1));
        table.push(cells);
    }
    table
}

/// Statistic of [`IndexErrors`]: its name, its unit, and its accessor.
type ErrorFigure = (&'static str, &'static str, fn(&IndexErrors) -> Option<Statistic>);

/// Statistics of K, T and K/T in `summary.csv`, in the order of its columns.
const ERRORS: [ErrorFigure; 15] = [
    ("mean error", "%", |errors| errors.mean),
    ("median error", "%", |errors| errors.median),
    ("sd", "%", |errors| errors.sd),
    ("rms error", "%", |errors| errors.rms),
    ("MAD", "%", |errors| errors.mad),
    ("2.5 % quantile", "%", |errors| errors.quantiles[0]),
    ("25 % quantile", "%", |errors| errors.quantiles[1]),
    ("75 % quantile", "%", |errors| errors.quantiles[2]),
    ("97.5 % quantile", "%", |errors| errors.quantiles[3]),
    ("median of sizes", "%", |errors| errors.median_absolute_error),
    ("90 % of sizes", "%", |errors| errors.absolute_error_p90),
    ("coverage", "%", |errors| errors.coverage.map(|share| share.times(100.0))),
    ("width of intervals", "%", |errors| errors.median_interval_width),
    ("quoting intervals", "%", |errors| errors.share_with_interval.map(|share| share.times(100.0))),
    ("sd/bound", "", |errors| errors.sd_over_bound),
];

/// Columns of the axes, one each, and of the method.
pub fn cell_and_method_head(design: &Design) -> TableHead {
    cell_head(design).texts(["method"])
}

/// Columns of the axes, one each.
pub fn cell_head(design: &Design) -> TableHead {
    TableHead::default().texts(&design.axes)
}

/// Labels of a cell and a method, in the columns of [`cell_and_method_head`].
pub fn row_labels(design: &Design, cell: usize, method: usize) -> Vec<String> {
    let labels = design.cells[cell].labels.iter().cloned();
    labels.chain([design.methods[method].label.clone()]).collect()
}

/// Columns of a statistic and the ends of its interval, after those of `head`.
fn with_ends(head: TableHead, name: &str, unit: &str) -> TableHead {
    let head = head.numbers(["", " lower 95", " upper 95"].map(|end| format!("{name}{end}")));
    if unit.is_empty() { head } else { head.unit(unit) }
}

/// Statistic and the ends of its interval with six significant digits.
fn all_digits(figure: Option<Statistic>) -> [String; 3] {
    Statistic::value_and_ends(figure).map(|value| number::significant(value.unwrap_or(f64::NAN), 6))
}

/// Statistics of methods in the width of a screen or a page: failures, median and rms errors with interval, coverage,
/// spread over the bound, and the validation error if there is one.
pub fn brief_summary_table(summary: &Summary, design: &Design) -> Table {
    let performances = || summary.methods.iter().map(|line| &line.performance);
    let validated = performances().any(|performance| performance.validation_rmse_deg.is_some());
    let mut head = cell_and_method_head(design).counts(["failed"]);
    for index in ["K", "T"] {
        head = head.numbers(["median", "rms"].map(|figure| format!("{index} {figure}"))).unit("%").interval95();
        head = head.counts(["coverage"]).unit("%").numbers(["sd/bound"]);
    }
    let mut table = Table::new(head.numbers(validated.then_some("validation")).unit("deg"));
    for line in &summary.methods {
        let mut cells = row_labels(design, line.cell, line.method);
        cells.extend(brief(&line.performance));
        cells.extend(validated.then(|| supported(line.performance.validation_rmse_deg)));
        table.push(cells);
    }
    with_reference(table, design)
}

fn brief(performance: &MethodPerformance) -> Vec<String> {
    let mut cells = vec![format!("{}/{}", performance.failed(), performance.trials)];
    for errors in [&performance.k, &performance.t] {
        cells.push(supported(errors.median));
        cells.push(supported(errors.rms));
        cells.push(interval(errors.rms));
        cells.push(fixed(errors.coverage.map(|share| share.times(100.0)), 1));
        cells.push(fixed(errors.sd_over_bound, 2));
    }
    cells
}

/// Reference of the errors of K and T as text. A trace is compared with the ship's own K and T.
pub fn error_reference(design: &Design) -> &'static str {
    let is_nearest = |cell: &CellFacts| cell.is_compared_with_nearest;
    match () {
        () if design.methods.iter().all(|method| method.id == TRACE_ID) => TRUTH,
        () if design.cells.iter().all(is_nearest) => "the nearest first-order response",
        () if design.cells.iter().any(is_nearest) => {
            "the truth, and of ships that are not first order to the nearest first-order response"
        }
        () => TRUTH,
    }
}

/// Reference of the errors of K and T of first-order ships.
const TRUTH: &str = "the truth";

/// Table of errors, titled with their reference unless that is the truth alone.
fn with_reference(table: Table, design: &Design) -> Table {
    match error_reference(design) {
        TRUTH => table,
        reference => table.titled(format!("Errors of K and T relative to {reference}")),
    }
}

/// Statistics over all cells, one row per method.
pub fn overall_table(summary: &Summary, design: &Design) -> Table {
    let mut head = TableHead::default().texts(["method"]).counts(["failed"]);
    for index in ["K", "T"] {
        head = head.numbers([format!("{index} median size")]).unit("%").interval95();
        head = head.numbers(["90 %"]).unit("%").counts(["coverage"]).unit("%");
    }
    let mut table = Table::new(head.numbers(["validation"]).unit("deg"));
    for (method, performance) in design.methods.iter().zip(&summary.overall) {
        let mut cells = vec![method.label.clone(), format!("{}/{}", performance.failed(), performance.trials)];
        for errors in [&performance.k, &performance.t] {
            cells.push(supported(errors.median_absolute_error));
            cells.push(interval(errors.median_absolute_error));
            cells.push(supported(errors.absolute_error_p90));
            cells.push(fixed(errors.coverage.map(|share| share.times(100.0)), 1));
        }
        cells.push(supported(performance.validation_rmse_deg));
        table.push(cells);
    }
    with_reference(table, design)
}

/// Table of [`overall_table`] with caption and label for a paper: `summary.tex`.
pub fn overall_paper_table(summary: &Summary, stored: &StoredStudy) -> Table {
    let (name, cells) = (&stored.manifest.name, stored.design.cells.len());
    let scope = if cells == 1 { name.clone() } else { format!("{name}, all {cells} cells together") };
    let caption = format!(
        "Errors of K and T in {scope}, relative to {}: trials that failed, median of the size of the error with its 95 % \
         bootstrap interval, 90 % quantile of this size, share of the 95 % intervals that contain the truth, and median \
         heading error on an unseen manoeuvre.",
        error_reference(&stored.design)
    );
    overall_table(summary, &stored.design).titled(caption).labelled(name.as_str())
}

/// Every method against the reference on the same trials, with caption and label: the second table of `summary.tex`.
pub fn comparison_paper_table(summary: &Summary, stored: &StoredStudy) -> Table {
    let (design, name) = (&stored.design, &stored.manifest.name);
    let mut head = cell_and_method_head(design).counts(["trials"]);
    for index in ["K", "T"] {
        head = head.numbers([format!("{index} rms ratio")]).interval95();
        head = head.numbers([format!("{index} closer")]).unit("%").interval95();
    }
    let mut table = Table::new(head);
    for line in &summary.comparisons {
        let mut cells = row_labels(design, line.cell, line.method);
        cells.push(line.trials.to_string());
        for comparison in [&line.k, &line.t] {
            for figure in [comparison.rms_ratio, comparison.smaller_error_share.map(|share| share.times(100.0))] {
                cells.extend([supported(figure), interval(figure)]);
            }
        }
        table.push(cells);
    }
    let caption = format!(
        "Each method of {name} against {} on the same trials, those in which both gave an answer: ratio of the rms errors, \
         and share of the trials in which the method is closer to the truth, with 95 % intervals.",
        design.methods[summary.reference].label
    );
    table.titled(caption).labelled(format!("{name}-pairs"))
}

/// Every method against the reference on the same trials: `pairs.csv`.
pub fn comparison_table(lines: &[ReferenceComparison], reference: &MethodName, design: &Design) -> Table {
    let mut head = cell_and_method_head(design).texts(["reference"]).counts(["trials"]);
    for index in ["K", "T"] {
        for (figure, unit) in [("rms difference", "%"), ("rms ratio", ""), ("closer", "%")] {
            head = with_ends(head, &format!("{index} {figure}"), unit);
        }
    }
    let mut table = Table::new(head);
    for line in lines {
        let mut cells = row_labels(design, line.cell, line.method);
        cells.extend([reference.label.clone(), line.trials.to_string()]);
        for comparison in [&line.k, &line.t] {
            cells.extend(all_digits(comparison.rms_difference));
            cells.extend(all_digits(comparison.rms_ratio));
            cells.extend(all_digits(comparison.smaller_error_share.map(|share| share.times(100.0))));
        }
        table.push(cells);
    }
    table
}

fn fixed(figure: Option<Statistic>, decimals: usize) -> String {
    number::optional(figure.map(|figure| figure.value), decimals)
}

fn supported(figure: Option<Statistic>) -> String {
    figure.map_or_else(|| MISSING.to_owned(), |figure| number::with_supported_digits(figure.value, figure.ci95))
}

fn interval(figure: Option<Statistic>) -> String {
    number::interval(figure.and_then(|figure| figure.ci95))
}

/// Reasons of failed trials with their counts, one line per cell and method.
pub fn failure_lines(summary: &Summary, design: &Design) -> Vec<String> {
    let line = |cell: usize, method: usize, performance: &MethodPerformance| {
        let reasons: Vec<String> =
            performance.failure_counts.iter().map(|(reason, count)| format!("{count} × {reason}")).collect();
        let place = design.cells[cell].labels.join(", ");
        let place = if place.is_empty() { String::new() } else { format!("{place}: ") };
        let method = &design.methods[method].label;
        format!("{place}{method}: {} of {} failed ({})", performance.failed(), performance.trials, reasons.join(", "))
    };
    let failing = summary.methods.iter().filter(|line| !line.performance.failure_counts.is_empty());
    failing.map(|summary| line(summary.cell, summary.method, &summary.performance)).collect()
}
