//! Tables of the effects named by traces.

use document::names;
use std::collections::BTreeSet;

use report::number::{self, MISSING};
use report::{Table, TableHead};

use super::power_charts::calibration_bins;
use super::tables::cell_head;
use campaign::design::Design;
use campaign::scenario::TRACE_ID;
use campaign::statistics::{Statistic, wilson_share};
use campaign::summary::{CALIBRATION_BIN_EDGES, MIN_CLEAR_MARGIN, MethodPerformance, Summary, TraceSummary};
use trace::TraceVerdict;

/// Table of every cell with its shares, for people and, with intervals and more digits, for `tracing.csv`.
///
/// Heading errors are medians over the trials, of the base (the reference method) and of the traced model, on the trial
/// itself and on the validation manoeuvre. Coverages of the bands are means over the trials: of the headings of the
/// trial, and of those of the validation manoeuvre, whose band is that of the parameters alone since it has no noise.
pub fn naming_table(lines: &[TraceSummary], summary: &Summary, design: &Design, all_digits: bool) -> Table {
    let several = has_several_traces(design);
    let name = |id: &String| if all_digits { id.clone() } else { names::effect_name(id) };
    let ends: &[&str] = if all_digits { &["", " low", " high"] } else { &[""] };
    let shares = ["all named", "exact", "false names", "named where clear"];
    let shares = shares.iter().flat_map(|name| ends.iter().map(move |end| format!("{name}{end}")));
    let head = cell_head(design).texts(several.then_some("method")).texts(["missing"]).counts(["trials"]);
    let head = head.numbers(shares).unit("%").counts([format!("clear (margin above {MIN_CLEAR_MARGIN:.0})")]);
    let head = head.counts(TraceVerdict::ALL.map(|verdict| verdict.to_string()));
    let head = head.numbers(["heading before", "heading after", "validation before", "validation after"]).unit("deg");
    let head = head.numbers(["expected likelihood ratio"]).numbers(["band covers", "band covers validation"]).unit("%");
    let mut table = Table::new(head.texts(["named"]));
    for line in lines {
        let mut cells: Vec<String> = design.cells[line.cell].labels.clone();
        cells.extend(several.then(|| design.methods[line.method].label.clone()));
        cells.push(if line.missing_effects.is_empty() {
            MISSING.into()
        } else {
            line.missing_effects.iter().map(name).collect::<Vec<_>>().join(" + ")
        });
        cells.push(line.trials.to_string());
        for figure in [
            line.all_named_trial_share(),
            line.exactly_named_trial_share(),
            line.falsely_named_trial_share(),
            line.clearly_separable_share(),
        ] {
            cells.extend(percent(figure, all_digits));
        }
        cells.push(line.clearly_separable[0].to_string());
        cells.extend(line.verdict_counts.map(|count| count.to_string()));
        let records = [summary.reference, line.method].map(|method| summary.performance(line.cell, method));
        let three = |value: Option<f64>| number::significant(value.unwrap_or(f64::NAN), 3);
        for error in [|row: &MethodPerformance| row.heading_rmse_deg, |row: &MethodPerformance| row.validation_rmse_deg]
        {
            cells.extend(records.map(|record| three(record.and_then(error).map(|figure| figure.value))));
        }
        cells.push(three(line.mean_expected_2_ln_lambda));
        let digits = if all_digits { 3 } else { 1 };
        cells.extend(line.band_coverage.map(|share| number::optional(share.map(|share| 100.0 * share), digits)));
        let mut named: Vec<(&String, &u64)> = line.named_effect_counts.iter().collect();
        named.sort_by(|a, b| b.1.cmp(a.1).then(a.0.cmp(b.0)));
        let most = if all_digits { usize::MAX } else { 4 };
        cells.push(
            named.iter().take(most).map(|(id, count)| format!("{} {count}", name(id))).collect::<Vec<_>>().join(", "),
        );
        table.push(cells);
    }
    table
}

/// Table of effects by their posterior probability, over all cells.
pub fn reliability_table(lines: &[TraceSummary]) -> Table {
    let head = TableHead::default().counts(["probability from", "to"]).unit("%").counts(["effects"]);
    let mut table = Table::new(head.numbers(["mean probability", "present", "low", "high"]).unit("%"));
    for (range, ends) in calibration_bins(lines).iter().zip(CALIBRATION_BIN_EDGES.windows(2)) {
        let mean = (range.effect_count > 0).then(|| 100.0 * range.probability_sum / range.effect_count as f64);
        let present = wilson_share(range.present_count, range.effect_count);
        let mut cells: Vec<String> = ends.iter().map(|end| number::fixed(100.0 * end, 0)).collect();
        cells.extend([range.effect_count.to_string(), number::optional(mean, 2)]);
        cells.extend(
            Statistic::value_and_ends(present).map(|share| number::optional(share.map(|share| 100.0 * share), 2)),
        );
        table.push(cells);
    }
    table
}

fn percent(figure: Option<Statistic>, all_digits: bool) -> Vec<String> {
    let (count, digits) = if all_digits { (3, 3) } else { (1, 1) };
    let value = |x: Option<f64>| number::optional(x.map(|x| 100.0 * x), digits);
    Statistic::value_and_ends(figure).into_iter().take(count).map(value).collect()
}

/// `true` if more than one method of a study is a trace.
pub fn has_several_traces(design: &Design) -> bool {
    design.methods.iter().filter(|method| method.id == TRACE_ID).count() > 1
}

/// Table of the cells pooled by kind of ship (no missing effect, one effect, several, a hull), one row for every kind
/// and trace.
pub fn ship_kind_table(lines: &[TraceSummary], design: &Design) -> Table {
    let several = has_several_traces(design);
    let head = TableHead::default().texts(several.then_some("method")).texts(["cells"]).counts(["number", "trials"]);
    let mut table = Table::new(head.texts(["all named", "exact", "false names", "named where clear"]).unit("%"));
    let kind = |line: &TraceSummary| match line.missing_effects.len() {
        0 => "nothing missing",
        _ if line.is_hull() => "a hull",
        1 => "one effect missing",
        _ => "several effects missing",
    };
    let methods: BTreeSet<usize> = lines.iter().map(|line| line.method).collect();
    let kinds = ["nothing missing", "one effect missing", "several effects missing", "a hull"];
    for (name, number) in kinds.into_iter().flat_map(|name| methods.iter().map(move |&number| (name, number))) {
        let part: Vec<&TraceSummary> =
            lines.iter().filter(|line| kind(line) == name && line.method == number).collect();
        if part.is_empty() {
            continue;
        }
        let mut sum = TraceSummary { missing_effects: part[0].missing_effects.clone(), ..TraceSummary::default() };
        for line in &part {
            sum.trials += line.trials;
            sum.all_named_count += line.all_named_count;
            sum.falsely_named_count += line.falsely_named_count;
            sum.exactly_named_count += line.exactly_named_count;
            sum.clearly_separable = [
                sum.clearly_separable[0] + line.clearly_separable[0],
                sum.clearly_separable[1] + line.clearly_separable[1],
            ];
        }
        let cell = |figure: Option<Statistic>| match figure.map(|figure| figure.times(100.0)) {
            Some(figure) => format!("{} {}", number::fixed(figure.value, 2), number::interval(figure.ci95)),
            None => MISSING.into(),
        };
        let label = several.then(|| design.methods[number].label.clone());
        table.push(label.into_iter().chain([
            name.to_owned(),
            part.len().to_string(),
            sum.trials.to_string(),
            cell(sum.all_named_trial_share()),
            cell(sum.exactly_named_trial_share()),
            cell(sum.falsely_named_trial_share()),
            cell(sum.clearly_separable_share()),
        ]));
    }
    table
}
