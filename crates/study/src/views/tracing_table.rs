//! Tables of what traces said.

use std::collections::BTreeSet;

use report::number::{self, MISSING};
use report::{Column, Table};

use super::tables::head_of_cells;
use super::trace_charts::promised;
use campaign::design::Design;
use campaign::statistics::{Statistic, share};
use campaign::summary::{CALIBRATION, CLEAR, Summary, TraceSummary};
use scenario::TRACE;

/// Every cell with its shares, for people and, with all digits, for `tracing.csv`.
///
/// Heading errors are medians over the trials, of the base (the reference method) and of the traced model, on the trial
/// itself and on the validation manoeuvre. What the bands cover are means over the trials: of the headings of the
/// trial, and of those of the validation manoeuvre, whose band is that of the parameters alone since it has no noise.
pub fn table(lines: &[TraceSummary], summary: &Summary, design: &Design, all_digits: bool) -> Table {
    let several = has_several(design);
    let mut columns = head_of_cells(design);
    if several {
        columns.push(Column::left("method"));
    }
    columns.push(Column::left("missing"));
    columns.push(Column::right("trials"));
    let shares = ["all named", "exact", "false names", "named where clear"];
    for name in shares {
        columns.push(Column::decimal(name).unit("%"));
        if all_digits {
            columns.extend(["low", "high"].map(|end| Column::decimal(format!("{name} {end}")).unit("%")));
        }
    }
    columns.push(Column::right(format!("clear (margin above {CLEAR:.0})")));
    columns.extend(["clean", "traced", "unexplained"].map(Column::right));
    for what in ["heading", "validation"] {
        columns.extend(["before", "after"].map(|when| Column::decimal(format!("{what} {when}")).unit("deg")));
    }
    columns.push(Column::decimal("expected likelihood ratio"));
    columns.extend(["band covers", "band covers validation"].map(|name| Column::decimal(name).unit("%")));
    columns.push(Column::left("named"));
    let mut table = Table::new(columns);
    for line in lines {
        let mut cells: Vec<String> = design.cells[line.cell].labels.clone();
        if several {
            cells.push(design.methods[line.method].label.clone());
        }
        cells.push(if line.missing.is_empty() { MISSING.into() } else { line.missing.join(" + ") });
        cells.push(line.trials.to_string());
        for figure in [line.complete_share(), line.exact_share(), line.wrong_share(), line.clear_share()] {
            cells.extend(percent(figure, all_digits));
        }
        cells.push(line.clear[0].to_string());
        cells.extend(line.verdicts.map(|count| count.to_string()));
        let records = [summary.reference, line.method].map(|method| summary.record(line.cell, method));
        let median =
            |figure: Option<Statistic>| figure.map_or_else(|| MISSING.into(), |f| number::significant(f.value, 3));
        cells.extend(records.map(|record| median(record.and_then(|record| record.heading_rmse_deg))));
        cells.extend(records.map(|record| median(record.and_then(|record| record.validation_rmse_deg))));
        cells.push(line.expected.map_or_else(|| MISSING.into(), |expected| number::significant(expected, 3)));
        let digits = if all_digits { 3 } else { 1 };
        cells.extend(line.band.map(|share| number::optional(share.map(|share| 100.0 * share), digits)));
        let mut named: Vec<(&String, &u64)> = line.named.iter().collect();
        named.sort_by(|one, other| other.1.cmp(one.1).then(one.0.cmp(other.0)));
        let most = if all_digits { usize::MAX } else { 4 };
        cells.push(named.iter().take(most).map(|(id, count)| format!("{id} {count}")).collect::<Vec<_>>().join(", "));
        table.push(cells);
    }
    table
}

/// Effects by the probability that was given to them, over all cells.
pub fn reliability(lines: &[TraceSummary]) -> Table {
    let mut table = Table::new(vec![
        Column::right("probability from").unit("%"),
        Column::right("to").unit("%"),
        Column::right("effects"),
        Column::decimal("mean probability").unit("%"),
        Column::decimal("present").unit("%"),
        Column::decimal("low").unit("%"),
        Column::decimal("high").unit("%"),
    ]);
    for (range, ends) in promised(lines).iter().zip(CALIBRATION.windows(2)) {
        let mean = (range.effects > 0).then(|| 100.0 * range.sum / range.effects as f64);
        let present = share(range.present, range.effects);
        let ends_of = present.and_then(|share| share.ci95);
        let three = [present.map(|share| share.value), ends_of.map(|ends| ends[0]), ends_of.map(|ends| ends[1])];
        let mut cells: Vec<String> = ends.iter().map(|end| number::fixed(100.0 * end, 0)).collect();
        cells.extend([range.effects.to_string(), number::optional(mean, 2)]);
        cells.extend(three.map(|share| number::optional(share.map(|share| 100.0 * share), 2)));
        table.push(cells);
    }
    table
}

fn percent(figure: Option<Statistic>, all_digits: bool) -> Vec<String> {
    let value = |x: f64| number::fixed(100.0 * x, if all_digits { 3 } else { 1 });
    let mut cells = vec![figure.map_or_else(|| MISSING.into(), |figure| value(figure.value))];
    if all_digits {
        let ends = figure.and_then(|figure| figure.ci95);
        cells.extend([0, 1].map(|k| ends.map_or_else(|| MISSING.into(), |ends| value(ends[k]))));
    }
    cells
}

/// Whether more than one method of a study is a trace.
pub fn has_several(design: &Design) -> bool {
    design.methods.iter().filter(|method| method.id == TRACE).count() > 1
}

/// All cells of one kind together, a line each of every trace: nothing missing, one effect, several, a hull.
pub fn kinds(lines: &[TraceSummary], design: &Design) -> Table {
    let several = has_several(design);
    let method = several.then(|| Column::left("method"));
    let mut table = Table::new(Vec::from_iter(method.into_iter().chain([
        Column::left("cells"),
        Column::right("number"),
        Column::right("trials"),
        Column::left("all named [%]"),
        Column::left("exact [%]"),
        Column::left("false names [%]"),
        Column::left("named where clear [%]"),
    ])));
    let kind = |line: &TraceSummary| match line.missing.len() {
        0 => "nothing missing",
        _ if line.wrong_share().is_none() => "a hull",
        1 => "one effect missing",
        _ => "several effects missing",
    };
    let methods: BTreeSet<usize> = lines.iter().map(|line| line.method).collect();
    let kinds = ["nothing missing", "one effect missing", "several effects missing", "a hull"];
    for (name, number) in kinds.into_iter().flat_map(|name| methods.iter().map(move |&number| (name, number))) {
        let own: Vec<&TraceSummary> = lines.iter().filter(|line| kind(line) == name && line.method == number).collect();
        if own.is_empty() {
            continue;
        }
        let mut sum = TraceSummary { missing: own[0].missing.clone(), ..TraceSummary::default() };
        for line in &own {
            sum.trials += line.trials;
            sum.complete += line.complete;
            sum.wrong += line.wrong;
            sum.exact += line.exact;
            sum.clear = [sum.clear[0] + line.clear[0], sum.clear[1] + line.clear[1]];
        }
        let cell = |figure: Option<Statistic>| match figure {
            Some(figure) => {
                let ends = figure.ci95.map(|ends| ends.map(|end| 100.0 * end));
                format!("{} {}", number::fixed(100.0 * figure.value, 2), number::interval(ends))
            }
            None => MISSING.into(),
        };
        let label = several.then(|| design.methods[number].label.clone());
        table.push(label.into_iter().chain([
            name.to_owned(),
            own.len().to_string(),
            sum.trials.to_string(),
            cell(sum.complete_share()),
            cell(sum.exact_share()),
            cell(sum.wrong_share()),
            cell(sum.clear_share()),
        ]));
    }
    table
}
