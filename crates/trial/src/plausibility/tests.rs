//! Every check on synthetic records: correct records pass, faulty ones give their message.

use std::collections::BTreeMap;

use ship::angle::from_deg;

use super::*;
use crate::channel::Channel;
use crate::record::{Columns, RecordOrigin};

/// Rudder and heading of a ship with K, T (s), 10 Hz, by small Euler steps; `steer` gives the rudder from time,
/// heading, rate.
fn sail(gain: f64, lag: f64, duration: f64, mut steer: impl FnMut(f64, f64, f64) -> (f64, f64)) -> Columns {
    let (mut psi, mut r) = (0.0, 0.0);
    let h = 0.01;
    let mut columns = Columns::default();
    let (mut rudder, mut heading, mut rate) = (Vec::new(), Vec::new(), Vec::new());
    for step in 0..(duration / h) as usize {
        let t = step as f64 * h;
        let (delta, disturbance) = steer(t, psi, r);
        if step.is_multiple_of(10) {
            columns.time.push(t);
            rudder.push(delta);
            heading.push(psi);
            rate.push(r);
        }
        r += h * (gain * delta + disturbance - r) / lag;
        psi += h * r;
    }
    columns.channels =
        BTreeMap::from([(Channel::Rudder, rudder), (Channel::Heading, heading), (Channel::YawRate, rate)]);
    columns
}

fn zig_zag(delta_deg: f64, psi_deg: f64, gain: f64, lag: f64) -> Columns {
    let mut delta = from_deg(delta_deg);
    let limit = from_deg(psi_deg);
    sail(gain, lag, 25.0 * lag, move |_, psi, _| {
        if psi * delta > 0.0 && psi.abs() > limit {
            delta = -delta;
        }
        (delta, 0.0)
    })
}

fn scaled(mut columns: Columns, channel: Channel, factor: f64) -> Columns {
    for value in columns.channels.get_mut(&channel).expect("made by sail") {
        *value *= factor;
    }
    columns
}

fn verdict(columns: Columns) -> Result<Vec<Warning>, Implausibility> {
    let origin = RecordOrigin::Simulated { scenario: "plausibility".to_owned(), cell: 0, replicate: 0 };
    let checked = check_plausibility(&Trial::new("record", origin, columns).expect("the columns make a record"));
    // The rudder of these records has no steering gear, and each gives a warning of that.
    checked
        .map(|warnings| warnings.into_iter().filter(|warning| !warning.text.contains("looks like the order")).collect())
}

const PER_DEGREE: f64 = std::f64::consts::PI / 180.0;

/// Fault of a channel, and parts of its message.
const WRONG: [(Channel, f64, &[&str]); 9] = [
    (Channel::Rudder, -1.0, &["RudderFlipped"]),
    (Channel::YawRate, -1.0, &["culprit: \"yaw-rate\""]),
    (Channel::Heading, -1.0, &["culprit: \"heading\""]),
    (Channel::YawRate, PER_DEGREE, &["YawRateUnit"]),
    (Channel::YawRate, 60.0, &["YawRateUnit"]),
    (Channel::Rudder, PER_DEGREE, &["RudderInRadians"]),
    (Channel::Rudder, 1.0 / PER_DEGREE, &["RudderInDegrees"]),
    (Channel::Heading, PER_DEGREE, &["HeadingInRadians", "YawRateUnit"]),
    (Channel::Heading, 1.0 / PER_DEGREE, &["HeadingInDegrees", "YawRateUnit"]),
];

/// No message advises a column name that the column already has.
#[test]
fn a_column_that_is_named_so_already_is_thought_of() {
    for (channel, factor) in [(Channel::Rudder, 20.0), (Channel::Rudder, 0.01), (Channel::Heading, 60.0)] {
        let message =
            verdict(scaled(zig_zag(10.0, 10.0, 0.1, 16.3), channel, factor)).expect_err("refused").to_string();
        assert!(message.contains("if it already has that name, its numbers have another scale"), "{message}");
    }
}

#[test]
fn zig_zags_of_ships_of_every_size_pass_and_every_wrong_unit_and_sign_is_named() {
    for (gain, lag) in [(0.1, 16.3), (0.357, 23.3), (0.05, 140.0), (0.5, 1.5)] {
        for (delta_deg, psi_deg) in [(10.0, 10.0), (20.0, 20.0), (10.0, 20.0), (5.0, 1.0), (35.0, 10.0)] {
            let made = || zig_zag(delta_deg, psi_deg, gain, lag);
            let context = format!("{delta_deg}/{psi_deg}, K {gain} T {lag}");
            assert_eq!(verdict(made()), Ok(vec![]), "{context}");
            for (channel, factor, names) in WRONG {
                let error = verdict(scaled(made(), channel, factor)).expect_err(&context);
                let error = format!("{error:?}");
                assert!(
                    names.iter().any(|name| error.contains(name)),
                    "{context}, {channel:?} times {factor}: {error}"
                );
            }
        }
    }
}

#[test]
fn a_record_without_movement_is_refused() {
    let still = sail(0.1, 16.0, 100.0, |_, _, _| (0.02, 0.0));
    let frozen = scaled(still, Channel::Heading, 0.0);
    assert!(matches!(verdict(frozen), Err(Implausibility::NothingMoves { .. })));
    let frozen = scaled(zig_zag(10.0, 10.0, 0.1, 16.0), Channel::Heading, 0.0);
    assert!(matches!(verdict(frozen), Err(Implausibility::HeadingConstant { .. })));
    let pull_out = sail(0.1, 16.0, 100.0, |t, _, _| (0.0, if t < 20.0 { 0.01 } else { 0.0 }));
    let warnings = verdict(pull_out).expect("a ship may turn without its rudder");
    assert!(warnings[0].text.contains("the rudder stays at"), "{warnings:?}");
}

#[test]
fn a_turning_circle_a_dither_and_course_keeping_in_wind_are_not_refused() {
    let circle = sail(0.1, 16.0, 900.0, |t, _, _| (if t < 30.0 { 0.0 } else { from_deg(-35.0) }, 0.0));
    assert_eq!(verdict(circle), Ok(vec![]));
    let dither = sail(0.1, 16.0, 300.0, |t, _, _| (from_deg(10.0) * (1.5 * t).sin(), 0.0));
    let warnings = verdict(dither).expect("a dither moves the heading little");
    assert!(warnings.iter().any(|warning| warning.text.contains("radians")), "{warnings:?}");
    // The rudder depends on the heading: gusts of many periods, a helmsman with counter-rudder.
    for gust in [0.5, 1.0, 2.0] {
        for (p, d) in [(1.0, 0.0), (1.0, 10.0), (3.0, 20.0), (0.5, 30.0)] {
            let keeping = sail(0.1, 16.0, 600.0, |t, psi, r| {
                let phases = [0.11, 0.23, 0.037, 0.061, 0.31, 0.017, 0.43];
                let wind: f64 = phases.iter().map(|w| (w * gust * t + 40.0 * w).sin()).sum();
                (-p * psi - d * r, 0.004 * wind)
            });
            assert!(verdict(keeping.clone()).is_ok(), "gust {gust} p {p} d {d}: {:?}", verdict(keeping));
        }
    }
}

#[test]
fn headings_that_wrap_at_two_pi_under_a_degree_name_are_named() {
    let mut columns = zig_zag(10.0, 10.0, 0.1, 16.0);
    columns.channels.remove(&Channel::YawRate);
    for psi in columns.channels.get_mut(&Channel::Heading).expect("made by sail") {
        *psi = psi.rem_euclid(std::f64::consts::TAU) * PER_DEGREE;
    }
    assert!(matches!(verdict(columns), Err(Implausibility::HeadingInRadians { .. })));
}

#[test]
fn gaps_are_remarked() {
    let mut columns = zig_zag(10.0, 10.0, 0.1, 16.0);
    for values in std::iter::once(&mut columns.time).chain(columns.channels.values_mut()) {
        values.drain(500..560);
    }
    let warnings = verdict(columns).expect("a gap is no fault");
    assert!(
        warnings[0].text.starts_with("1 gap ") && warnings[0].text.contains("6.1 s, begins at 49.9 s"),
        "{warnings:?}"
    );
}
