//! Logs without manoeuvres, and invalid logs: no manoeuvre is detected, and there is no panic.

use ship::angle::{from_deg, to_deg};

use super::ship::SimulatedLog;
use crate::find::{LogSignals, detect_manoeuvres};
use crate::testing::Gaussian;

#[test]
fn an_autopilot_keeps_a_straight_piece() {
    let mut log = SimulatedLog::new(0.5);
    log.keep(3600.0);
    let spread = log.rudder.iter().map(|x| to_deg(x.abs())).fold(0.0, f64::max);
    assert!(spread > 1.0, "{spread}");
    assert_eq!(log.names(), ["straight"]);
    // Orders in steps of three degrees, as of an autopilot with a dead band.
    let mut log = SimulatedLog::new(0.5);
    let base = log.course;
    let mut order = from_deg(3.0);
    for _ in 0..7200 {
        if (log.course - base).abs() > from_deg(0.6) {
            order = from_deg(3.0) * (base - log.course).signum();
        }
        log.row(order);
    }
    assert_eq!(log.names(), ["straight"]);
}

#[test]
fn changes_of_course_are_nothing() {
    let mut log = SimulatedLog::new(0.5);
    let mut course = log.course;
    for change_deg in [20.0, -40.0, 60.0, -20.0, 30.0, -60.0, 60.0] {
        log.steer(course, 300.0);
        course += from_deg(change_deg);
        log.steer(course, 60.0);
    }
    log.steer(course, 300.0);
    assert_eq!(log.detected(), []);
}

/// Random orders for random times, any angle or multiples of five degrees, of about the durations in a zig-zag. In so
/// many orders a few look like a trial of three executes.
#[test]
fn harbour_manoeuvring_is_nothing() {
    let mut detected = Vec::new();
    for seed in 0..20 {
        for in_fives in [false, true] {
            let mut log = SimulatedLog::new(0.5);
            log.chance = Gaussian::new(seed);
            for _ in 0..400 {
                let (order, time) = (15.0 * log.chance.draw(), 15.0 + 10.0 * log.chance.draw().abs());
                let order = if in_fives { 5.0 * (order / 5.0).round() } else { order };
                log.hold(from_deg(order.clamp(-35.0, 35.0)), time);
            }
            detected.extend(log.detected().into_iter().map(|part| (seed, in_fives, part)));
        }
    }
    assert!(detected.len() <= 3, "{} in 16 000 orders: {detected:?}", detected.len());
}

#[test]
fn a_ship_that_does_not_answer_makes_no_zig_zag() {
    let mut log = SimulatedLog::new(0.5);
    log.keep(300.0);
    log.zig_zag(10.0, 10.0, 6);
    log.keep(300.0);
    let headings = std::mem::replace(&mut log.heading, vec![f64::NAN; log.time.len()]);
    assert_eq!(log.names(), [""; 0]);
    log.heading = headings.iter().map(|psi| -psi).collect();
    assert_eq!(log.detected(), []);
}

#[test]
fn a_gap_of_the_log_ends_a_zig_zag() {
    let mut log = SimulatedLog::new(0.5);
    log.keep(300.0);
    log.zig_zag(10.0, 10.0, 4);
    let rows = log.time.len();
    log.zig_zag(10.0, 10.0, 5);
    log.keep(300.0);
    log.time[rows - 5..].iter_mut().for_each(|t| *t += 7200.0);
    let detected = log.detected();
    assert!(detected.iter().all(|manoeuvre| manoeuvre.end_time - manoeuvre.start_time < 1000.0), "{detected:?}");
}

/// The rudder goes from a long circle directly to a short one, and only then amidships.
#[test]
fn between_two_turns_there_is_no_pull_out() {
    let (mut time, mut rudder, mut heading) = (Vec::new(), Vec::new(), Vec::new());
    let mut psi = 0.0;
    for (rows, rudder_deg, turn_deg) in [(40, 0.0, 0.0), (100, 10.0, 2.0), (10, -25.0, -30.0), (60, 0.0, 0.0)] {
        for _ in 0..rows {
            time.push(time.len() as f64);
            rudder.push(from_deg(rudder_deg));
            psi += from_deg(turn_deg);
            heading.push(psi);
        }
    }
    let log = LogSignals { time: &time, rudder: &rudder, heading: &heading, speed: None, propeller_rate: None };
    let list = detect_manoeuvres(&log);
    let names: Vec<String> = list.iter().map(|manoeuvre| manoeuvre.name()).collect();
    assert_eq!(names, ["turning circle 10 to starboard", "turning circle 25 to port", "pull-out", "straight"]);
    assert!(list.windows(2).all(|pair| pair[0].end_time < pair[1].start_time), "{list:?}");
}

/// Logs of constants, of few rows or with unsound channels contain no manoeuvre.
#[test]
fn logs_that_are_none() {
    for rows in 0..9 {
        let time: Vec<f64> = (0..rows).map(f64::from).collect();
        for rudder in [0.0, 0.2, f64::NAN] {
            for heading in [0.0, f64::NAN, f64::INFINITY] {
                let (rudder, heading) = (vec![rudder; time.len()], vec![heading; time.len()]);
                let channel = Some(&rudder[..]);
                let log = LogSignals {
                    time: &time,
                    rudder: &rudder,
                    heading: &heading,
                    speed: channel,
                    propeller_rate: channel,
                };
                assert_eq!(detect_manoeuvres(&log), []);
                let shorter = LogSignals { rudder: &rudder[..rudder.len() / 2], propeller_rate: Some(&[]), ..log };
                assert_eq!(detect_manoeuvres(&shorter), []);
            }
        }
    }
}
