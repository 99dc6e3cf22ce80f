//! Straight pieces between the manoeuvres of a log: the heading stays near a course and the rudder near amidships, by
//! hand, by autopilot or without steering. A ship at rest also keeps her heading; such rows are excluded if speed or
//! propeller was recorded.

use std::ops::Range;

use super::detection::{DetectedManoeuvre, RecordingQuality};
use super::pattern::{Pattern, PreparedLog};
use super::rudder::finite_median;

/// Maximum range of headings on a course, rad: an autopilot keeps ±1°, in waves ±2°.
const MAX_HEADING_RANGE: f64 = 5.0_f64.to_radians();

/// Maximum deviation of the rudder from its neutral angle, rad.
const MAX_RUDDER: f64 = 7.0_f64.to_radians();

/// Minimum duration of a piece, time scales of the manoeuvres of the log.
const MIN_SCALES: f64 = 2.0;

/// Minimum duration of a piece of a log without manoeuvres, as a share of the log.
const MIN_DURATION_SHARE: f64 = 0.02;

/// Minimum number of rows of a piece.
const MIN_ROWS: usize = 20;

/// Maximum speed and revolutions of a ship at rest, as shares of the usual values.
const AT_REST_SHARE: f64 = 0.2;

/// Adds the straight pieces to the manoeuvres of a log, in order of time.
pub(crate) fn add_straight_runs(record: &PreparedLog, patterns: &[Pattern], list: &mut Vec<DetectedManoeuvre>) {
    let time = record.log.time;
    let Some((&begin, &end)) = time.first().zip(time.last()) else { return };
    let scale = finite_median(patterns.iter().map(|pattern| pattern.scale));
    let shortest = if scale > 0.0 { MIN_SCALES * scale } else { MIN_DURATION_SHARE * (end - begin) };
    // Recorded speed and revolutions, each with its minimum for a ship under way.
    let channels = [record.log.speed, record.log.propeller_rate].into_iter().flatten();
    let under_way: Vec<(&[f64], f64)> = channels
        .filter(|values| values.len() == time.len())
        .map(|values| (values, AT_REST_SHARE * finite_median(values.iter().map(|x| x.abs()))))
        .collect();
    let is_straight = |row: usize| {
        let moves = |(values, least): &(&[f64], f64)| values[row].is_nan() || values[row].abs() >= *least;
        under_way.iter().all(moves) && (record.rudder.angle[row] - record.rudder.neutral).abs() <= MAX_RUDDER
    };
    let pieces_in = |first, end| pieces_in(record, is_straight, first..end, shortest);
    let mut pieces = Vec::new();
    let mut first = 0;
    for manoeuvre in list.iter() {
        pieces.extend(pieces_in(first, time.partition_point(|&t| t < manoeuvre.start_time)));
        first = time.partition_point(|&t| t <= manoeuvre.end_time);
    }
    pieces.extend(pieces_in(first, time.len()));
    list.extend(pieces);
    list.sort_by(|a, b| a.start_time.total_cmp(&b.start_time));
}

/// Straight pieces in a range of rows; `is_straight` tests speed, propeller and rudder of a row, not its heading.
fn pieces_in(
    record: &PreparedLog,
    is_straight: impl Fn(usize) -> bool,
    rows: Range<usize>,
    shortest: f64,
) -> Vec<DetectedManoeuvre> {
    let log = record.log;
    let mut pieces = Vec::new();
    let mut piece: Option<Piece> = None;
    for row in rows {
        let psi = log.heading[row];
        let straight = is_straight(row);
        if let Some(open) = piece.as_mut()
            && straight
            && log.time[row] - open.read <= 0.25 * shortest
            && (psi.is_nan() || open.takes(row, psi, log.time[row]))
        {
            continue;
        }
        pieces.extend(piece.take().and_then(|piece| piece.manoeuvre(record, shortest)));
        piece = (straight && psi.is_finite()).then(|| Piece::new(row, psi, log.time[row]));
    }
    pieces.extend(piece.and_then(|piece| piece.manoeuvre(record, shortest)));
    pieces
}

/// Rows on one course.
struct Piece {
    first: usize,
    last: usize,
    lowest: f64,
    highest: f64,
    /// Time of the last heading, s.
    read: f64,
}

impl Piece {
    fn new(row: usize, psi: f64, time: f64) -> Self {
        Self { first: row, last: row, lowest: psi, highest: psi, read: time }
    }

    /// Includes a row unless its heading is off the course; `true` if included.
    fn takes(&mut self, row: usize, psi: f64, time: f64) -> bool {
        let (lowest, highest) = (self.lowest.min(psi), self.highest.max(psi));
        // NaN and infinite headings fail the comparison.
        let near = highest - lowest <= MAX_HEADING_RANGE && psi.is_finite();
        if near {
            *self = Self { first: self.first, last: row, lowest, highest, read: time };
        }
        near
    }

    fn manoeuvre(&self, record: &PreparedLog, shortest: f64) -> Option<DetectedManoeuvre> {
        let [from, until] = [self.first, self.last].map(|row| record.log.time[row]);
        (until - from >= shortest && self.last + 1 - self.first >= MIN_ROWS).then(|| DetectedManoeuvre {
            manoeuvre: None,
            start_time: from,
            end_time: until,
            first_execute_time: from,
            execute_count: 0,
            quality: RecordingQuality::from_rows(record, self.first, self.last),
        })
    }
}
