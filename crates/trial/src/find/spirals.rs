//! Spirals after Dieudonné in a log: the rudder goes from side to side in steps and rests at each until the ship turns
//! steadily. Reverse spirals, where the rate is ordered and the rudder looked for, are not recognised.

use super::pattern::{Pattern, Prepared};
use super::rest::{Hold, usual};
use crate::manoeuvre::Manoeuvre;

/// Fewest holds of a way from side to side, and of a part of a way that leads up to it or goes on.
const FEWEST: usize = 5;
const FEWEST_OF_PART: usize = 3;

/// Smallest step of the rudder, rad.
const SMALLEST_STEP: f64 = 0.75_f64.to_radians();

/// Rudder angle that a way reaches to both sides, rad.
const BOTH_SIDES: f64 = 2.0_f64.to_radians();

/// Longest movement from hold to hold as a share of the shorter one.
const QUICK: f64 = 0.5;

/// A rest shorter than this share of both neighbours is a pause of a movement.
const PAUSE: f64 = 0.2;

/// Shortest hold as a share of the usual one.
const SHORTEST: f64 = 0.4;

/// Largest ratio of the rudder angles to both sides.
const SIDES: f64 = 2.0;

/// How much the rate of a turn changes in its last thirds, and how much it may change against the rudder from one to
/// the next, as shares of the range of rates.
const STEADY: f64 = 0.04;
const AGAINST: f64 = 0.15;

/// The spirals of a log.
pub(crate) fn spirals(record: &Prepared) -> Vec<Pattern> {
    let all = &record.rest.holds;
    let is_pause = |index: usize| {
        let shorter = |other: Option<&Hold>| other.is_some_and(|x| all[index].duration() < PAUSE * x.duration());
        index > 0 && shorter(all.get(index - 1)) && shorter(all.get(index + 1))
    };
    let holds: Vec<Hold> = (0..all.len()).filter(|&index| !is_pause(index)).map(|index| all[index]).collect();
    let ways: Vec<&[Hold]> = ways(&holds).into_iter().filter(|way| is_answered(record, way)).collect();
    let mut found: Vec<Pattern> = Vec::new();
    // Ways share the hold at which the rudder turns back.
    for group in ways.chunk_by(|a, b| a[a.len() - 1].first == b[0].first) {
        if !group.iter().any(|way| is_from_side_to_side(way)) {
            continue;
        }
        let mut holds = group[0].to_vec();
        group[1..].iter().for_each(|way| holds.extend(&way[1..]));
        let rudder = holds.iter().map(|hold| hold.level.abs()).fold(0.0, f64::max);
        let scale = usual(holds.iter().map(Hold::duration));
        let turns = holds.iter().filter_map(|hold| record.course.change(hold.from, hold.until));
        let swing = turns.map(f64::abs).fold(0.0, f64::max);
        found.push(Pattern { manoeuvre: Manoeuvre::Spiral { rudder }, holds, scale, swing });
    }
    found
}

/// Runs of holds, each further to the same side than the one before.
fn ways(holds: &[Hold]) -> Vec<&[Hold]> {
    let step = |index: usize| {
        let (a, b) = (&holds[index], &holds[index + 1]);
        let step = b.level - a.level;
        let quick = b.from - a.until <= QUICK * a.duration().min(b.duration());
        if quick && step.abs() >= SMALLEST_STEP { step.signum() } else { 0.0 }
    };
    let mut ways = Vec::new();
    let mut first = 0;
    while first + 1 < holds.len() {
        let way = step(first);
        let mut last = first + 1;
        while way != 0.0 && last + 1 < holds.len() && step(last) == way {
            last += 1;
        }
        if way != 0.0 && last + 1 - first >= FEWEST_OF_PART {
            ways.push(&holds[first..=last]);
        }
        first = last;
    }
    ways
}

fn is_from_side_to_side(way: &[Hold]) -> bool {
    let (first, last) = (way[0].level, way[way.len() - 1].level);
    let (port, starboard) = (-first.min(last), first.max(last));
    way.len() >= FEWEST && port.min(starboard) >= BOTH_SIDES && port.max(starboard) <= SIDES * port.min(starboard)
}

/// Whether the ship turns steadily in every hold, the more to the side the rudder went to.
fn is_answered(record: &Prepared, way: &[Hold]) -> bool {
    let usual = usual(way.iter().map(Hold::duration));
    if way.iter().any(|hold| hold.duration() < SHORTEST * usual) {
        return false;
    }
    let thirds = |hold: &Hold| {
        let third = hold.duration() / 3.0;
        let late = hold.until - third;
        record.course.rate(late - third, late).zip(record.course.rate(late, hold.until))
    };
    let Some(rates) = way.iter().map(thirds).collect::<Option<Vec<(f64, f64)>>>() else { return false };
    let (first, last) = (rates[0].1, rates[rates.len() - 1].1);
    let range = (last - first) * (way[way.len() - 1].level - way[0].level).signum();
    let sense = (last - first).signum();
    range > 0.0
        && rates.iter().all(|(earlier, later)| (later - earlier).abs() <= STEADY * range)
        && rates.windows(2).all(|pair| sense * (pair[1].1 - pair[0].1) >= -AGAINST * range)
}
