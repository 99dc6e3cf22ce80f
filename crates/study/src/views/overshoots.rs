//! Overshoots of the zig-zags of a trace, compared with those of replays of their rudder.

use ::trace::replay_errors::replayed_zigzag;
use document::names;
use document::trace::{RecordEntry, TraceDocument};
use estimation::statistics::median;
use report::figures::{AxisSpec, NamedRows, RowItem, RowKind, RowPlace, RowsColumn};
use report::number::{MISSING, counted};
use report::palette::{CurveStyle, Marker};
use report::{CurveOrigin, PageFigure};
use ship::angle::to_deg;
use trial::{ZigZag, imo};

use super::record_study::degrees_text;
use crate::documents::curves::{TraceCurves, TracedRecord};

/// First or second overshoot of a record, measured and replayed, degrees; only these two have an IMO limit.
pub struct ReplayedOvershoot<'a> {
    record: &'a RecordEntry,
    word: &'static str,
    measured: f64,
    /// Overshoots in the replays by the base and by the traced model; `None` if a replay has none.
    replayed: [Option<f64>; 2],
    /// IMO limit; `None` if no criterion applies to the record.
    limit: Option<f64>,
    /// Maximum rudder of the record, rad.
    rudder_rad: f64,
}

/// Overshoots of all records, in ascending order of the rudder.
pub fn replayed_overshoots<'a>(document: &'a TraceDocument, curves: &TraceCurves) -> Vec<ReplayedOvershoot<'a>> {
    let mut all = Vec::new();
    for (record, TracedRecord { trial, replays, .. }) in document.records.iter().zip(&curves.records) {
        let Ok(zigzag) = ZigZag::from_trial(trial) else { continue };
        let replays = replays.each_ref().map(|replay| replayed_zigzag(trial, replay));
        // The limits are for ships; for a model, the record does not state the length of the full-size ship.
        let ship = record.particulars().filter(|ship| ship.length >= imo::MIN_LENGTH_M);
        let criteria: Vec<_> = ship.map(|ship| imo::imo_criteria(&zigzag, ship)).unwrap_or_default();
        for (number, word) in [(0, "first"), (1, "second")] {
            let angle = |zigzag: &ZigZag| Some(to_deg(zigzag.overshoots_by_execute().nth(number)??.angle.value));
            let Some(measured) = angle(&zigzag) else { continue };
            let limit = criteria.iter().find(|limit| {
                limit.unit == imo::CriterionUnit::Degrees && limit.measured.is_some() && limit.name.contains(word)
            });
            let replayed = replays.each_ref().map(|replay| replay.as_ref().and_then(angle));
            let limit = limit.map(|limit| limit.limit);
            all.push(ReplayedOvershoot { record, word, measured, replayed, limit, rudder_rad: trial.largest_rudder() });
        }
    }
    all.sort_by(|a, b| a.rudder_rad.total_cmp(&b.rudder_rad));
    all
}

/// Error of the overshoots of a replay.
pub struct OvershootError {
    /// Median absolute error, degrees; `None` if the replay has no overshoot.
    pub median_deg: Option<f64>,
    /// Number of measured overshoots.
    pub measured_count: usize,
    /// Number of measured overshoots without a replayed one.
    pub unreplayed_count: usize,
}

/// Errors of the overshoots of both replays, of held-out or of fitted records.
pub fn overshoot_errors_before_after(all: &[ReplayedOvershoot], held_out: bool) -> [OvershootError; 2] {
    let judged = || all.iter().filter(|overshoot| overshoot.record.held_out == held_out);
    [0, 1].map(|model| {
        let distance = |overshoot: &ReplayedOvershoot| Some((overshoot.replayed[model]? - overshoot.measured).abs());
        let mut distances: Vec<f64> = judged().filter_map(distance).collect();
        let (measured, replayed) = (judged().count(), distances.len());
        OvershootError {
            median_deg: median(&mut distances),
            measured_count: measured,
            unreplayed_count: measured - replayed,
        }
    })
}

/// Items of the row of an overshoot: measured bar, limit and both replays, each with its error as a number.
fn row_items(overshoot: &ReplayedOvershoot) -> Vec<RowItem> {
    // One mark above the other, so that both are visible.
    let mark = |name: &str, origin: CurveOrigin, shift: f64, value: Option<f64>| {
        let number = Some(degrees_text((value? - overshoot.measured).abs()));
        let item = RowItem::new(name, RowKind::Mark(origin.style(), value?, None)).clipped_if_far();
        Some(RowItem { place: RowPlace::Shifted(shift), number, ..item })
    };
    let measured = CurveStyle { marker: Marker::Square, ..CurveOrigin::Record.style() };
    let items = [
        Some(RowItem::new("measured", RowKind::Bar(measured, overshoot.measured))),
        overshoot.limit.map(|limit| RowItem::new("IMO limit", RowKind::Limit(limit))),
        mark("K and T alone", CurveOrigin::Before, -0.16, overshoot.replayed[0]),
        mark("traced", CurveOrigin::After, 0.16, overshoot.replayed[1]),
    ];
    items.into_iter().flatten().collect()
}

/// Note on the numbers, and on overshoots without a mark.
fn note(all: &[ReplayedOvershoot]) -> String {
    let is_partial = all.iter().any(|overshoot| overshoot.replayed.contains(&None));
    let missing = if is_partial { " No mark: the replay has no such overshoot; it counts as missing." } else { "" };
    format!("Numbers: errors.{missing}")
}

/// Figure of the first two overshoots of every zig-zag and of both replays; if some records have more rudder than the
/// fitted records, the rows of all others are shaded; `None` if no record is a zig-zag.
pub fn overshoot_figure(document: &TraceDocument, all: &[ReplayedOvershoot]) -> Option<PageFigure> {
    let held_out = document.records.iter().filter(|record| record.held_out).count();
    let errors = overshoot_errors_before_after(all, held_out > 0);
    let medians = errors.iter().map(|error| RowItem {
        number: Some(error.median_deg.map_or_else(|| MISSING.to_owned(), degrees_text)),
        ..RowItem::new("", RowKind::Heading)
    });
    let rows = all.iter().map(row_items).chain([medians.collect()]).collect();
    let column =
        RowsColumn { x: AxisSpec::decimal("overshoot [°]"), rows, has_zero_line: true, ..RowsColumn::default() };
    let name = |overshoot: &ReplayedOvershoot| {
        let used = if overshoot.record.held_out { "" } else { " (fitted)" };
        let place = if overshoot.word == "first" { "1st" } else { "2nd" };
        format!("{}: {place}{used}", names::record_name(&overshoot.record.name))
    };
    let seen = document.ship.validity_range.rudder_rad;
    let (within, beyond): (Vec<usize>, Vec<usize>) = (0..all.len()).partition(|&place| all[place].rudder_rad <= seen);
    let shaded = (!beyond.is_empty()).then(|| (String::from("rudder within that of the fit"), within));
    let data = NamedRows {
        names: all
            .iter()
            .map(name)
            .chain([String::from(if held_out > 0 { "median, not fitted" } else { "median" })])
            .collect(),
        columns: vec![column],
        shaded_rows: shaded,
        note: Some(note(all)),
        ..NamedRows::default()
    };
    let error_words = |error: OvershootError| {
        let off = error.median_deg.map_or_else(|| MISSING.to_owned(), degrees_text);
        let missing =
            if error.unreplayed_count > 0 { format!(" ({} missing)", error.unreplayed_count) } else { String::new() };
        (off, missing, error.measured_count)
    };
    let [(before, no_before, count), (after, no_after, _)] = errors.map(error_words);
    let of_records = match held_out {
        0 => String::new(),
        records => format!(" of {} that were not fitted", counted(records as u64, "record")),
    };
    let finding = format!(
        "Median error of {count} overshoots{of_records}: {before} with K and T alone{no_before}, {after} traced{no_after}"
    );
    let limits = match all.iter().any(|overshoot| overshoot.limit.is_some()) {
        true => ", with the limits of IMO MSC.137(76)",
        false => "",
    };
    let caption = format!(
        "Overshoots of the records and of the replays of their rudder by K and T alone and by the traced \
         model{limits}. No mark: the replay has no such overshoot; it counts as missing and not in the median."
    );
    (!all.is_empty()).then(|| PageFigure::new("overshoots", finding, caption, data))
}
