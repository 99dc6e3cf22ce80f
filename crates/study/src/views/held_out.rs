//! Held-out records: residuals and errors of the best first-order response (before) and of the traced model (after).

use ::trace::replay_errors::HORIZONS_S;
use campaign::curves::angle_curve_deg;
use document::names;
use document::trace::{ModelReplayErrors, RecordEntry, RecordReplayErrors, TraceDocument};
use predict::prediction::RANGE_FACTOR;
use report::figures::{
    AxisSpec, Layer, LayeredPanel, NamedRows, PanelGroup, PanelRow, Panels, Pen, RowItem, RowsColumn, TickRule,
};
use report::markdown::escaped_text;
use report::number::{counted, fixed, significant};
use report::{CurveOrigin, PageFigure};

use super::trace_figures::{heading_error_ratio, replays_by_origin};
use super::trace_tables::restarted_heading_error;
use crate::documents::curves::{TraceCurves, TracedRecord};

/// Number of panels side by side.
const ACROSS: usize = 3;

/// Figure of the residuals of both models on every held-out record, the worst first; `None` without held-out records.
pub fn residual_figure(document: &TraceDocument, curves: &TraceCurves) -> Option<PageFigure> {
    let all = document.records.iter().zip(&curves.records).filter(|(entry, _)| entry.held_out);
    let mut all: Vec<(&RecordEntry, &TracedRecord, &RecordReplayErrors)> =
        all.zip(&document.trace.error.validation).map(|((entry, record), errors)| (entry, record, errors)).collect();
    let size = |(_, _, errors): &(&RecordEntry, &TracedRecord, &RecordReplayErrors)| errors.after.heading_rmse_deg;
    all.sort_by(|a, b| size(b).total_cmp(&size(a)));
    let [worst, best] = [all.first()?, all.last()?];
    let error_words = |entry: &(&RecordEntry, _, _), degrees| {
        format!("{} {}°", names::record_name(&entry.0.name), significant(degrees, 2))
    };
    let [worst, best] = [worst, best].map(|entry| error_words(entry, size(entry)));
    let finding = match all.len() {
        1 => format!("Heading error: {worst}"),
        count => format!("Heading error on {}: from {best} to {worst}", counted(count as u64, "held-out record")),
    };
    let panel = |(entry, record, errors): &(&RecordEntry, &TracedRecord, &RecordReplayErrors)| {
        let line = |(origin, replay): (CurveOrigin, &identify::replay::Replay)| {
            let pen = Pen::new(origin.style().colour).width(0.9);
            Layer::line(origin.label(), angle_curve_deg(&replay.time, &replay.residual), pen)
        };
        let [before, after] = [&errors.before, &errors.after].map(|error| significant(error.heading_rmse_deg, 2));
        let head = format!("{}: {before}° → {after}°", names::record_name(&entry.name));
        LayeredPanel { head: Some(head), layers: replays_by_origin(record).map(line).into(), ..LayeredPanel::default() }
    };
    let row = PanelRow::zeroed(AxisSpec::new("residual [°]", TickRule::Angle), 0.13);
    let plot = Panels::new(PanelGroup::multiples(
        ACROSS.min(all.len()),
        AxisSpec::time(),
        row,
        all.iter().map(panel).collect(),
    ));
    let caption = "Heading errors of the best first-order response (before) and of the model with the effects (after) on records that were \
                   not fitted; degrees are root mean squares. The worst predicted record comes first.";
    Some(PageFigure::new("held-out-residuals", finding, caption, plot))
}

/// Sentence on the band of held-out records with more rudder than the fitted ones, the least covered first; `None`
/// without such a record.
pub fn beyond_fitted_rudder(document: &TraceDocument, curves: &TraceCurves) -> Option<String> {
    let fitted = document.ship.validity_range.rudder_rad;
    let all = document.records.iter().zip(&curves.records).filter(|(entry, _)| entry.held_out);
    let beyond = all.zip(&document.trace.error.validation).filter_map(|((entry, record), errors)| {
        let is_beyond = record.trial.largest_rudder() > RANGE_FACTOR * fitted;
        Some((&entry.name, errors.after.band_coverage_95.filter(|_| is_beyond)?, errors.after.heading_rmse_deg))
    });
    let mut beyond: Vec<(&String, f64, f64)> = beyond.collect();
    beyond.sort_by(|a, b| a.1.total_cmp(&b.1));
    let phrase = |(name, covered, degrees): &(&String, f64, f64)| {
        let [share, off] = [fixed(100.0 * covered, 0), significant(*degrees, 2)];
        format!("{share} % of the headings of {} (heading error {off}° rms)", escaped_text(&names::record_name(name)))
    };
    let all: Vec<String> = beyond.iter().map(phrase).collect();
    (!all.is_empty()).then(|| format!(" There the 95 % band holds {}.", all.join(" and ")))
}

/// Figure of the heading errors on held-out records before and after. Its axes begin at zero, so that ratios are
/// visible. `None` without held-out records.
pub fn error_figure(document: &TraceDocument) -> Option<PageFigure> {
    let (_, judged) = document.errors();
    let column = |title: String, pick: &dyn Fn(&ModelReplayErrors) -> Option<f64>| {
        let row = |errors: &RecordReplayErrors| -> Vec<RowItem> {
            let pairs = [(CurveOrigin::Before, &errors.before), (CurveOrigin::After, &errors.after)];
            let mark =
                |(of, all): (CurveOrigin, _)| Some(RowItem::mark_below(of.label(), of.style(), pick(all)?, None));
            pairs.into_iter().filter_map(mark).collect()
        };
        let rows = judged.iter().map(|record| row(record.errors)).collect();
        RowsColumn { x: AxisSpec::decimal(title), rows, has_zero_line: true, ..RowsColumn::default() }
    };
    let mut columns = vec![column(String::from("whole replay [°]"), &|error| Some(error.heading_rmse_deg))];
    columns.extend(HORIZONS_S.map(|window_s| {
        column(format!("every {window_s:.0} s [°]"), &move |all| restarted_heading_error(all, window_s))
    }));
    let count = judged.len();
    let records = if count == 1 { "record that was" } else { "records that were" };
    let title = format!(
        "Heading error × {:.2} on {count} {records} not fitted",
        heading_error_ratio(judged.iter().map(|line| line.errors))
    );
    let data = NamedRows {
        names: judged.iter().map(|record| format!("{}, {}", names::record_name(record.name), record.used)).collect(),
        columns,
        ..NamedRows::default()
    };
    let caption = "Error of the heading on records that were not fitted, before and after: of the whole replay, and of \
                   replays restarted every 20 and 60 s.";
    (!judged.is_empty()).then(|| PageFigure::new("held-out", title, caption, data))
}
