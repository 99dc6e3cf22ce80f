//! Outcomes of traces for ships whose scenario states the correct outcome.

use campaign::design::Design;
use campaign::scenario::MissingPhysics;
use campaign::statistics::{Statistic, grouped, wilson_share};
use campaign::summary::{Judgement, MAX_PERIOD_ERROR, MAX_TIME_ERROR_S, Summary, TraceSummary};
use report::Table;
use report::figures::{CellMap, MapCell, Outline, Shades};
use report::number;

use super::remarks::count_range;
use super::tables::cell_head;
use super::tracing_table::has_several_traces;

/// Kind of a ship by what its model lacks: a listed effect, an unlisted moment, or nothing; for figures and files.
fn kind(physics: &MissingPhysics) -> &'static str {
    match physics {
        MissingPhysics::Listed { .. } => "listed",
        MissingPhysics::Unlisted { .. } => "unlisted",
        MissingPhysics::Nothing { .. } => "nothing",
    }
}

/// Summary of the traces in a cell, and the missing physics of its ship.
type JudgedLine<'a> = (&'a TraceSummary, &'a MissingPhysics);

fn judged<'a>(design: &'a Design, lines: &'a [TraceSummary]) -> Vec<JudgedLine<'a>> {
    lines.iter().filter_map(|line| Some((line, design.cells[line.cell].physics.as_ref()?))).collect()
}

fn count(lines: &[JudgedLine], is_counted: impl Fn(Judgement, &MissingPhysics) -> bool) -> u64 {
    let of_line = |(line, physics): &JudgedLine| {
        line.judgements
            .iter()
            .filter(|(judgement, _)| is_counted(**judgement, physics))
            .map(|(_, count)| count)
            .sum::<u64>()
    };
    lines.iter().map(of_line).sum()
}

/// Finding, and map with a row for every ship and a column for every judgement; cells that differ in further axes are
/// one row. `None` for a study that states no outcome.
pub fn outcome_map(design: &Design, lines: &[TraceSummary]) -> Option<(String, CellMap)> {
    let judged = judged(design, lines);
    let ships = grouped(judged.iter().copied(), |(line, physics): &JudgedLine| {
        let label = design.cells[line.cell].labels.first().map_or("", String::as_str);
        format!("{}: {label}", kind(physics)).replace(" %", "\u{a0}%")
    });
    let trials = |lines: &[JudgedLine]| count(lines, |_, _| true);
    let cell = |lines: &[JudgedLine], judgement: Judgement| {
        let share =
            wilson_share(count(lines, |other, _| other == judgement), trials(lines)).map(|share| share.times(100.0));
        MapCell {
            value: share.map(|share| share.value),
            interval: share.and_then(|share| share.ci95),
            outline: judgement.is_right(lines[0].1).then_some(Outline::Correct),
            trial_count: trials(lines),
        }
    };
    let right = |name: &str| {
        let lines: Vec<JudgedLine> = judged.iter().copied().filter(|(_, physics)| kind(physics) == name).collect();
        format!("{} of {}", count(&lines, Judgement::is_right), trials(&lines))
    };
    let cells = ships.iter().map(|(_, lines)| Judgement::ALL.map(|judgement| cell(lines, judgement)).to_vec());
    let cells: Vec<Vec<MapCell>> = cells.collect();
    let finding = format!("Right: listed effects {}, unlisted effects {}", right("listed"), right("unlisted"));
    let counts: Vec<u64> = ships.iter().map(|(_, lines)| trials(lines)).collect();
    let map = CellMap {
        axis_titles: [String::from("answer of the trace"), String::from("what is missing")],
        columns: Judgement::ALL.map(|judgement| judgement.to_string()).to_vec(),
        rows: ships.into_iter().map(|(name, _)| name).collect(),
        shades: Shades::Shares,
        panels: vec![(None, cells)],
        note: Some(format!(
            "Shares in per cent; {} trials of each kind of ship. Listed effects have another formula than on the list. Located: its dependence and its times are found. Unexplained: the residual is more than \
             noise. Disturbed: a random moment. Clean: noise alone. Alias: an effect that acts alike. Empty: no trial.",
            count_range(&counts)
        )),
    };
    (!judged.is_empty()).then_some((finding, map))
}

/// Legend of the judgements.
pub fn outcome_legend() -> String {
    format!(
        "*named right*: an effect that the ship has or stands for, and no other; *located right*: a moment with the \
         dependence of the truth and, where this has times, within {MAX_TIME_ERROR_S:.0} s of a change (its beginning, end or \
         middle) or {:.0} % of a period, or effects of time named there; *alias*: an effect indistinguishable from \
         the truth; *located elsewhere*: with another dependence or time; *wrong*: any other name, or a located \
         moment for a ship that lacks nothing. For a moment on no list *unexplained* is \
         *right*, too; for a ship that random moments turn, *disturbed* is.",
        100.0 * MAX_PERIOD_ERROR
    )
}

/// Counts of every cell: `outcomes.csv`; `None` for a study that states no outcome.
pub fn outcome_table(design: &Design, summary: &Summary) -> Option<Table> {
    let several = has_several_traces(design);
    let head = cell_head(design).texts(several.then_some("method")).texts(["kind"]).counts(["trials", "failed"]);
    let head = head.numbers(["right", "right lower 95", "right upper 95"]).unit("%");
    let mut table = Table::new(head.counts(Judgement::ALL.map(|judgement| judgement.to_string())));
    let judged = judged(design, &summary.tracing);
    for (line, physics) in &judged {
        let line_alone = [(*line, *physics)];
        let failed = summary.performance(line.cell, line.method).map_or(0, |record| record.failed());
        let right = Statistic::value_and_ends(wilson_share(count(&line_alone, Judgement::is_right), line.trials));
        let mut cells: Vec<String> = design.cells[line.cell].labels.clone();
        cells.extend(several.then(|| design.methods[line.method].label.clone()));
        cells.extend([kind(physics).to_owned(), line.trials.to_string(), failed.to_string()]);
        cells.extend(right.map(|share| number::optional(share.map(|share| 100.0 * share), 1)));
        cells.extend(Judgement::ALL.map(|judgement| count(&line_alone, |other, _| other == judgement).to_string()));
        table.push(cells);
    }
    (!judged.is_empty()).then_some(table)
}
