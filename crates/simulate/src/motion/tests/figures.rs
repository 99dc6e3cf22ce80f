//! Track and characteristics of a turning circle against closed forms.

use std::f64::consts::PI;

use approx::assert_relative_eq;

use crate::motion::{TurningCircleCharacteristics, dead_reckoning, turning_circle};

const SURGE: f64 = 5.0;
const SWAY: f64 = -1.2;
const RATE: f64 = 0.02;

/// Characteristics of a ship that turns with constant velocities from the first row on, to starboard or port, on any
/// course.
fn circle(side: f64, course: f64, turned: f64) -> TurningCircleCharacteristics {
    let rows = 4000;
    let time: Vec<f64> = (0..=rows).map(|row| f64::from(row) * turned / RATE / f64::from(rows)).collect();
    let heading: Vec<f64> = time.iter().map(|t| course + side * RATE * t).collect();
    let velocity = vec![[SURGE, side * SWAY]; time.len()];
    let path = dead_reckoning(&time, &heading, &velocity);
    turning_circle([&time, &heading, &vec![side * RATE; time.len()]], [&path, &velocity], 0.0)
}

#[test]
fn a_steady_circle_has_its_closed_figures_to_both_sides() {
    for (side, course) in [(1.0, 0.0), (-1.0, 0.0), (1.0, 2.5), (-1.0, -4.0)] {
        let figures = circle(side, course, 4.0 * PI);
        let is = |figure: Option<f64>, expected: f64| {
            assert_relative_eq!(figure.expect("reached"), expected, max_relative = 1e-5);
        };
        is(figures.advance, (SURGE - SWAY) / RATE);
        is(figures.transfer, (SURGE + SWAY) / RATE);
        is(figures.tactical_diameter, 2.0 * SURGE / RATE);
        is(figures.speed_ratio, 1.0);
        // Positive drift to starboard: the bow points into the turn.
        is(figures.drift_angle, side * (-SWAY).atan2(SURGE));
        is(figures.pivot_ahead, -SWAY / RATE);
    }
}

#[test]
fn what_is_not_reached_is_none() {
    let quarter = circle(1.0, 0.0, 2.0);
    assert!(quarter.advance.is_some() && quarter.transfer.is_some());
    assert_eq!((quarter.tactical_diameter, quarter.drift_angle), (None, None));
    let begun = circle(-1.0, 0.0, 1.0);
    assert_eq!(begun, TurningCircleCharacteristics::default());
}

#[test]
fn a_series_that_is_no_turn_has_no_figures() {
    let (time, two) = ([0.0, 1.0, 2.0], [0.0, 2.0]);
    let path = [[0.0; 2]; 3];
    let of = |heading: &[f64], execute: f64| turning_circle([&time, heading, &time], [&path, &path], execute);
    let none = TurningCircleCharacteristics::default();
    assert_eq!(of(&two, 0.0), none);
    assert_eq!(of(&[0.0, f64::NAN, 3.0], 0.0), none);
    assert_eq!(of(&time, 9.0), none);
    assert_eq!(of(&[0.0; 3], 0.0), none);
    assert_eq!(of(&time, f64::NAN), none);
    assert!(dead_reckoning(&[], &[], &[]).is_empty());
}
