//! Straight pieces between the manoeuvres of a log: the heading stays near one course and the rudder near amidships, by
//! hand, by autopilot or without either. A ship at rest keeps her heading, too, and is left out where her speed or her
//! propeller tells.

use std::ops::Range;

use super::found::{FoundManoeuvre, Quality};
use super::pattern::{Pattern, Prepared};
use super::rest::usual;

/// Range of headings on one course, rad: an autopilot keeps ±1 degree, in waves ±2.
const COURSE: f64 = 5.0_f64.to_radians();

/// Rudder off its neutral angle, rad.
const RUDDER: f64 = 7.0_f64.to_radians();

/// Shortest piece in usual holds of the manoeuvres of the log.
const SHORTEST: f64 = 2.0;

/// Shortest piece of a log without manoeuvres, as a share of it.
const SHORTEST_SHARE: f64 = 0.02;

/// Fewest rows.
const FEWEST_ROWS: usize = 20;

/// Speed and revolutions of a ship at rest, as shares of the usual ones.
const AT_REST: f64 = 0.2;

/// Adds the straight pieces to the manoeuvres of a log, in order of time.
pub(crate) fn add(record: &Prepared, found: &[Pattern], list: &mut Vec<FoundManoeuvre>) {
    let time = record.log.time;
    let Some((&begin, &end)) = time.first().zip(time.last()) else { return };
    let scale = usual(found.iter().map(|pattern| pattern.scale));
    let shortest = if scale > 0.0 { SHORTEST * scale } else { SHORTEST_SHARE * (end - begin) };
    // Speed and revolutions where they are known, and the least of each for a ship under way.
    let channels = [record.log.speed, record.log.propeller].into_iter().flatten();
    let under_way: Vec<(&[f64], f64)> = channels
        .filter(|values| values.len() == time.len())
        .map(|values| (values, AT_REST * usual(values.iter().map(|x| x.abs()))))
        .collect();
    let is_straight = |row: usize| {
        let moves = |(values, least): &(&[f64], f64)| values[row].is_nan() || values[row].abs() >= *least;
        under_way.iter().all(moves) && (record.rest.angle[row] - record.rest.neutral).abs() <= RUDDER
    };
    let pieces_in = |first, end| pieces_in(record, is_straight, first..end, shortest);
    let mut pieces = Vec::new();
    let mut first = 0;
    for manoeuvre in list.iter() {
        pieces.extend(pieces_in(first, time.partition_point(|&t| t < manoeuvre.from)));
        first = time.partition_point(|&t| t <= manoeuvre.until);
    }
    pieces.extend(pieces_in(first, time.len()));
    list.extend(pieces);
    list.sort_by(|a, b| a.from.total_cmp(&b.from));
}

/// The straight pieces among some rows; `is_straight` says what of a row, but for its heading, tells that the ship goes
/// straight.
fn pieces_in(
    record: &Prepared,
    is_straight: impl Fn(usize) -> bool,
    rows: Range<usize>,
    shortest: f64,
) -> Vec<FoundManoeuvre> {
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

    /// Takes a row along unless its heading is off the course.
    fn takes(&mut self, row: usize, psi: f64, time: f64) -> bool {
        let (lowest, highest) = (self.lowest.min(psi), self.highest.max(psi));
        // NaN and infinite headings fail the comparison.
        let near = highest - lowest <= COURSE && psi.is_finite();
        if near {
            *self = Self { first: self.first, last: row, lowest, highest, read: time };
        }
        near
    }

    fn manoeuvre(&self, record: &Prepared, shortest: f64) -> Option<FoundManoeuvre> {
        let [from, until] = [self.first, self.last].map(|row| record.log.time[row]);
        (until - from >= shortest && self.last + 1 - self.first >= FEWEST_ROWS).then(|| FoundManoeuvre {
            manoeuvre: None,
            from,
            until,
            start: from,
            executes: 0,
            quality: Quality::of(record, self.first, self.last),
        })
    }
}
