//! Figures of a benchmark: scores relative to those of the reference method.

use campaign::benchmark::board::{Leaderboard, LeaderboardRow};
use campaign::benchmark::{BenchDocument, BenchTask};
use campaign::scenario::name::slug;
use campaign::scenario::{STRAIGHT_ON_ID, TRACE_ID};
use campaign::statistics::{MIN_SUMMARISED_VALUES, distinct};
use report::figures::{AxisSpec, NamedRows, ReferenceBand95, RowItem, RowKind, RowsColumn, TickRule};
use report::number::counted;
use report::palette::CurveStyle;
use report::{CurveOrigin, PageFigure};

use super::key_rows::tint;
use super::remarks::TRACE_REMARK;

/// Maximum ratio of a score to that of the reference; a larger one is shown as an arrow.
const MAX_RATIO: f64 = 100.0;

/// First part of the names of the figures.
const RATIOS: &str = "ratios";

/// The sentence with a capital first letter.
pub fn capital(sentence: &str) -> String {
    let mut letters = sentence.chars();
    letters.next().map_or_else(String::new, |first| first.to_uppercase().chain(letters).collect())
}

/// Figures of a benchmark, one for every kind of record.
pub fn figures(results: &BenchDocument) -> Vec<PageFigure> {
    let figure = |study: &str| {
        let boards = results.boards.iter().filter(|board| board.study == study);
        let mut over = boards.flat_map(|board| &board.standings).filter_map(|standing| standing.ratio.as_ref());
        let arrow = match over.any(|ratio| ratio.value.is_none_or(|value| value > MAX_RATIO)) {
            true => format!(" An arrow: more than {MAX_RATIO} times, or no answer in half of the cases."),
            false => String::new(),
        };
        let caption = format!(
            "{}: median of the score over that of {} in the same case, with 95 % intervals where there are six independent \
             records or more.{arrow}",
            capital(study),
            results.reference
        );
        let boards: Vec<&Leaderboard> = results.boards.iter().filter(|board| board.study == study).collect();
        let finding = format!("{}: {}", capital(study), finding(&boards, &results.reference));
        Some(PageFigure::new(format!("{RATIOS}-{}", slug(study)), finding, caption, ratios(results, study)?))
    };
    results.study_names().into_iter().filter_map(figure).collect()
}

fn curve_origin(method: &str) -> CurveOrigin {
    match method {
        // The straight-on forecast is not a method: grey.
        STRAIGHT_ON_ID => CurveOrigin::Series { label: method.to_owned(), number: 2 },
        method if method != TRACE_ID && method.starts_with(TRACE_ID) => {
            CurveOrigin::Variant { label: method.to_owned(), method: TRACE_ID.to_owned(), number: 0 }
        }
        method => CurveOrigin::Method(method.to_owned()),
    }
}

/// Name of a task as the title of a narrow axis.
fn axis_title(task: BenchTask) -> &'static str {
    match task {
        BenchTask::Identify => "fitted record",
        BenchTask::Indices => "K and T",
        BenchTask::OtherSide => "other side",
        BenchTask::OtherAmplitude => "other amplitude",
        BenchTask::Circle => "turning circle",
        BenchTask::Name => "missing effect",
    }
}

/// Methods that are significantly better than the reference on a board.
fn winners(board: &Leaderboard) -> impl Iterator<Item = &str> {
    let is_better = |standing: &&LeaderboardRow| {
        let upper = standing.ratio.and_then(|ratio| ratio.ci95?[1]);
        upper.is_some_and(|upper| upper < 1.0)
    };
    board.standings.iter().filter(is_better).map(|standing| standing.method.as_str())
}

/// Number of boards on which a method is significantly better than the reference.
fn won_count(boards: &[&Leaderboard], method: &str) -> usize {
    boards.iter().filter(|board| winners(board).any(|winner| winner == method)).count()
}

/// Finding: the methods that are significantly better than the reference in most tasks.
fn finding(boards: &[&Leaderboard], reference: &str) -> String {
    let methods = distinct(boards.iter().flat_map(|board| winners(board)));
    let Some(most) = methods.iter().map(|method| won_count(boards, method)).max() else {
        return format!("no method clearly beats {reference}");
    };
    let (best, others): (Vec<&str>, Vec<&str>) =
        methods.into_iter().partition(|method| won_count(boards, method) == most);
    let verb = if best.len() > 1 { "beat" } else { "beats" };
    let others = match others.len() {
        0 => String::new(),
        count => format!(", {} in fewer", counted(count as u64, "other method")),
    };
    let tasks = counted(boards.len() as u64, "task");
    format!("{} clearly {verb} {reference} in {most} of {tasks}{others}", best.join(" and "))
}

/// Columns whose axes have the same range.
fn share_scale(mut columns: Vec<RowsColumn>) -> Vec<RowsColumn> {
    let marks = columns.iter().flat_map(|column| &column.rows).flatten();
    let values = marks.filter_map(|item| if let RowKind::Mark(_, value, _) = item.kind { Some(value) } else { None });
    let values: Vec<f64> = values.filter(|value| value.is_finite()).collect();
    columns.iter_mut().for_each(|column| column.included_values.clone_from(&values));
    columns
}

/// Remark under a figure of score ratios.
fn ratio_note(boards: &[&Leaderboard], BenchDocument { reference, methods, .. }: &BenchDocument) -> String {
    let score = match boards.iter().any(|board| board.task == BenchTask::Indices) {
        true => "rms heading error; for K and T the larger relative error",
        false => "rms heading error",
    };
    let mut note = format!(
        "Error ratio: error over that of {reference}, medians over n cases; left of the line a method is better than \
         {reference}. Error: {score}. Intervals need six independent records."
    );
    if methods.iter().any(|method| method.starts_with(TRACE_ID)) {
        note += &format!(" {TRACE_REMARK}");
    }
    if boards.iter().any(|board| board.cases < MIN_SUMMARISED_VALUES) {
        note += &format!(
            " Hollow: single cases if fewer than {MIN_SUMMARISED_VALUES}; near values are drawn above each other."
        );
    }
    note
}

fn ratios(results: &BenchDocument, study: &str) -> Option<NamedRows> {
    let boards: Vec<_> = results.boards.iter().filter(|board| board.study == study).collect();
    let mut rivals: Vec<&String> = results.methods.iter().filter(|method| **method != results.reference).collect();
    // The methods of the finding are on top, in full colour.
    let won = |method: &str| won_count(&boards, method);
    let most = rivals.iter().map(|method| won(method)).max().unwrap_or(0);
    rivals.sort_by_key(|method| most - won(method));
    let style = |method: &str| {
        let style = curve_origin(method).style();
        let colour = if won(method) == most { style.colour } else { tint(style.colour) };
        CurveStyle { colour, is_hollow: false, ..style }
    };
    let has_ratios = boards.iter().flat_map(|board| &board.standings).any(|standing| standing.ratio.is_some());
    if rivals.is_empty() || !has_ratios {
        return None;
    }
    let column = |board: &&Leaderboard| {
        let points = |method: &str| -> Vec<RowItem> {
            let cases = results.cases.iter().filter(|case| case.task == board.task && case.study == board.study);
            let ratios = cases.filter_map(|case| case.score_ratio(method, &results.reference));
            let style = CurveStyle { is_hollow: true, ..style(method) };
            ratios.map(|ratio| RowItem::new("", RowKind::Mark(style, ratio.max(f64::MIN_POSITIVE), None))).collect()
        };
        let row = |method: &&String| {
            if board.cases < MIN_SUMMARISED_VALUES {
                return points(method);
            }
            let standing = board.standings.iter().find(|standing| standing.method == **method);
            let Some(ratio) = standing.and_then(|standing| standing.ratio) else { return Vec::new() };
            let value = ratio.value.filter(|value| *value <= MAX_RATIO).unwrap_or(f64::INFINITY);
            let end = |end: Option<f64>| end.unwrap_or(f64::INFINITY).max(f64::MIN_POSITIVE);
            let interval = ratio.ci95.map(|ends| ends.map(end)).filter(|_| value.is_finite());
            vec![RowItem::new("", RowKind::Mark(style(method), value.max(f64::MIN_POSITIVE), interval))]
        };
        RowsColumn {
            x: AxisSpec::new(
                // Unbreakable, so that the number stays on one line.
                format!("error ratio, {} (n\u{a0}=\u{a0}{})", axis_title(board.task), board.cases),
                TickRule::Logarithmic,
            ),
            reference: Some(ReferenceBand95::line_at(1.0)),
            rows: rivals.iter().map(row).collect(),
            ..RowsColumn::default()
        }
    };
    Some(NamedRows {
        names: rivals.iter().map(|method| (*method).clone()).collect(),
        columns: share_scale(boards.iter().map(column).collect()),
        note: Some(ratio_note(&boards, results)),
        ..NamedRows::default()
    })
}
