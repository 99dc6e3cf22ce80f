//! The ship (K, T) = (0.1 1/s, 16.3 s) in nine zig-zags, against the closed form.

use approx::assert_relative_eq;
use ship::angle::to_deg;

use super::of_plant;
use crate::testing::Plant;
use crate::zigzag::{BaseCourseSource, Side};

const INF: f64 = f64::INFINITY;

/// Rudder and heading, deg, and rate of the rudder, deg/s.
const TRIALS: [[f64; 3]; 9] = [
    [10.0, 10.0, 2.32],
    [10.0, 10.0, 2.5],
    [10.0, 10.0, 3.0],
    [10.0, 10.0, INF],
    [20.0, 20.0, 2.32],
    [20.0, 20.0, 2.5],
    [20.0, 20.0, 3.0],
    [10.0, 20.0, 2.5],
    [5.0, 5.0, 2.5],
];

/// Characteristics of the samples compared with the response itself, whose executes and peaks are those of an
/// independent program (the validation of the workspace). A rudder that jumps is timed to the middle of its interval.
fn check([delta_deg, psi_deg, rate_deg_s]: [f64; 3], step: f64) {
    let plant = Plant::new(delta_deg, psi_deg, rate_deg_s);
    let zigzag = of_plant(plant, 900.0, step);
    let label = format!("{delta_deg}/{psi_deg} at {rate_deg_s} deg/s every {step} s");
    let within = |tolerance: f64, name: &str, measured: f64, expected: f64| {
        assert!((measured - expected).abs() < tolerance, "{label}: {name} is {measured:.6}, expected {expected:.6}");
    };
    assert!(zigzag.nominal_angles.expect("has a pair").is_deg(delta_deg, psi_deg), "{label}");
    assert_eq!(zigzag.first_side, Some(Side::Starboard));
    assert_eq!(zigzag.base_course.source, BaseCourseSource::FirstHeading);
    let executes: Vec<f64> = zigzag.executes.iter().map(|execute| execute.time.value).collect();
    let expected = plant.execute_times(900.0);
    assert!(executes.len() > 6 && executes.len() <= expected.len(), "{label}");
    let [execute_tolerance, overshoot_tolerance] = if rate_deg_s.is_finite() { [1e-6, 2e-3] } else { [0.02, 0.02] };
    executes
        .iter()
        .zip(expected)
        .for_each(|(&measured, expected)| within(execute_tolerance, "execute", measured, expected));
    within(0.02, "t_a", zigzag.initial_turning_time.expect("has a first execute").value, executes[1]);
    let cycles: Vec<f64> = executes[2..].windows(3).map(|three| three[2] - three[0]).collect();
    let mean = cycles.iter().sum::<f64>() / cycles.len() as f64;
    within(1e-9, "period", zigzag.period.expect("several cycles").value, mean);
    for overshoot in &zigzag.overshoots {
        let near: Vec<f64> = (-3000..=3000).map(|k| overshoot.peak_time.value + 1e-3 * f64::from(k)).collect();
        let peak = plant.sampled(&near).0.iter().fold(0.0_f64, |most, psi| most.max(psi.abs()));
        within(overshoot_tolerance, "overshoot", to_deg(overshoot.angle.value), to_deg(peak) - psi_deg);
    }
    let rate = |time: f64| {
        let heading = plant.sampled(&[time - 1e-4, time + 1e-4]).0;
        to_deg((heading[1] - heading[0]) / 2e-4).abs()
    };
    for execute in &zigzag.executes[1..] {
        let measured = to_deg(execute.yaw_rate.expect("has headings").value.abs());
        within(0.01, "yaw rate", measured, rate(execute.time.value));
    }
    match zigzag.rudder_rate {
        Some(rate) => within(1e-6, "rudder rate", to_deg(rate), rate_deg_s),
        None => assert!(rate_deg_s.is_infinite(), "{label}"),
    }
}

#[test]
fn anchors_sampled_every_second() {
    TRIALS.into_iter().filter(|trial| trial[2].is_finite()).for_each(|trial| check(trial, 1.0));
}

#[test]
fn anchors_sampled_finely() {
    TRIALS.into_iter().for_each(|trial| check(trial, if trial[2].is_finite() { 0.2 } else { 0.01 }));
}

/// 13.74, 14.95, 15.01 s (10/10) and 18.64, 19.63, 19.68 s (20/20) at 2.5 deg/s, same source; tolerance 0.05 s, because
/// the peak is flat: 0.05 s change the heading by 1e-4 deg.
#[test]
fn time_to_check_yaw() {
    for (angle_deg, expected) in [(10.0, [13.74, 14.95, 15.01]), (20.0, [18.64, 19.63, 19.68])] {
        for step in [0.2, 1.0] {
            let zigzag = of_plant(Plant::new(angle_deg, angle_deg, 2.5), 400.0, step);
            for (n, expected) in (1..).zip(expected) {
                let time = zigzag.nth_overshoot(n).expect("seen").time_to_check_yaw.value;
                assert_relative_eq!(time, expected, epsilon = 0.05);
            }
        }
    }
}
