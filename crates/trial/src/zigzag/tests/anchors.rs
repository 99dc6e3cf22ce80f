//! The ship (K, T) = (0.1 1/s, 16.3 s) in nine zig-zags, against an independent integration and the closed form.

use approx::assert_relative_eq;
use ship::angle::to_deg;

use super::of_plant;
use crate::testing::Plant;
use crate::zigzag::{BaseCourseSource, Side};

const INF: f64 = f64::INFINITY;
const NAN: f64 = f64::NAN;

/// A row of the table of anchors: pair and rudder rate; first crossing and three later executes; three overshoots; the
/// period where the source has its limit (elsewhere it has the median of few cycles, the transient one among them);
/// rates at the first reversals; largest rate. Seconds and degrees.
type Anchor = ([f64; 3], [f64; 4], [f64; 3], f64, [f64; 3], f64);

/// The ship (K, T) = (0.1 1/s, 16.3 s) by an independent Runge-Kutta integration at 0.01 s, ramp rudder, from rest.
const ANCHORS: [Anchor; 9] = [
    ([10.0, 10.0, 2.32], [24.24, 79.98, 138.81, 197.79], [6.59, 8.35, 8.43], 117.97, [0.741, 0.922, 0.931], 0.932),
    ([10.0, 10.0, 2.5], [24.09, 79.20, 137.37, 195.68], [6.35, 8.07, 8.14], 116.63, [0.741, 0.921, 0.929], 0.930),
    ([10.0, 10.0, 3.0], [23.76, 77.49, 134.23, 191.11], [5.81, 7.44, 7.52], 113.78, [0.742, 0.918, 0.926], 0.927),
    ([10.0, 10.0, INF], [22.11, 68.92, 118.44, 168.09], [3.06, 4.23, 4.28], NAN, [0.742, 0.901, 0.909], 0.909),
    ([20.0, 20.0, 2.32], [26.35, 90.91, 158.85, 226.94], [19.71, 24.28, 24.48], NAN, [1.477, 1.875, 1.892], 1.894),
    ([20.0, 20.0, 2.5], [26.05, 89.35, 155.99, 222.78], [18.81, 23.23, 23.43], NAN, [1.478, 1.871, 1.888], 1.890),
    ([20.0, 20.0, 3.0], [25.40, 85.98, 149.82, 213.81], [16.83, 20.93, 21.13], NAN, [1.480, 1.862, 1.879], 1.882),
    ([10.0, 20.0, 2.5], [36.31, 114.60, 194.58, 274.58], [7.64, 8.65, 8.66], NAN, [0.878, 0.980, 0.981], 0.981),
    ([5.0, 5.0, 2.5], [23.10, 74.07, 127.94, 181.95], [2.36, 3.09, 3.12], 108.04, [0.371, 0.456, 0.460], 0.460),
];

/// Tolerance 0.02 of everything (s, deg, deg/s), and what the reference adds: it reverses the rudder at the first of
/// its 0.01 s steps after the heading condition. So an interval between executes may be a step long, a cycle two, and
/// an overshoot (from the nominal heading there) contains the yaw of a step.
fn check_anchor(anchor: &Anchor, step: f64) {
    let ([delta_deg, psi_deg, rate_deg_s], reference, overshoots_deg, period, rates_deg_s, largest_deg_s) = *anchor;
    let plant = Plant::new(delta_deg, psi_deg, rate_deg_s);
    let zigzag = of_plant(plant, 900.0, step);
    let label = format!("{delta_deg}/{psi_deg} at {rate_deg_s} deg/s every {step} s");
    let within = |tolerance: f64, name: &str, found: f64, expected: f64| {
        assert!((found - expected).abs() < tolerance, "{label}: {name} is {found:.4}, expected {expected:.4}");
    };
    let close = |name: &str, found: f64, expected: f64| within(0.02, name, found, expected);
    assert!(zigzag.pair.expect("has a pair").is_deg(delta_deg, psi_deg), "{label}");
    assert_eq!(zigzag.side, Some(Side::Starboard));
    assert_eq!(zigzag.base_course.source, BaseCourseSource::FirstHeading);
    let executes: Vec<f64> = zigzag.executes.iter().map(|execute| execute.time.value).collect();
    close("first execute", executes[0], 0.0);
    close("t_a", zigzag.initial_turning_time.expect("has a first execute").value, reference[0]);
    close("second execute", executes[1], reference[0]);
    const LATE: f64 = 0.01;
    for (found, expected) in executes[1..].windows(2).zip(reference.windows(2)) {
        within(0.02 + LATE, "interval between executes", found[1] - found[0], expected[1] - expected[0]);
    }
    for (n, expected) in (1..).zip(overshoots_deg) {
        let found = to_deg(zigzag.nth_overshoot(n).expect("seen").angle.value);
        within(0.02 + LATE * largest_deg_s, "overshoot", found, expected);
    }
    for (execute, expected) in zigzag.executes[1..].iter().zip(rates_deg_s) {
        close("rate", to_deg(execute.yaw_rate.expect("has headings").value.abs()), expected);
    }
    let last = executes.len() - 1;
    if period.is_finite() {
        within(0.02 + 2.0 * LATE, "last cycle", executes[last] - executes[last - 2], period);
    }
    let cycles: Vec<f64> = (2..=last - 2).map(|index| executes[index + 2] - executes[index]).collect();
    let mean = cycles.iter().sum::<f64>() / cycles.len() as f64;
    within(1e-9, "period", zigzag.period.expect("several cycles").value, mean);
    close("largest rate", to_deg(zigzag.largest_yaw_rate.expect("has headings").value), largest_deg_s);
    let Some(rate) = zigzag.rudder_rate else {
        assert!(rate_deg_s.is_infinite(), "{label}");
        return;
    };
    within(1e-6, "rudder rate", to_deg(rate), rate_deg_s);
    // Against the closed-form response itself, which has no step.
    for (&found, expected) in executes.iter().zip(plant.execute_times(900.0)) {
        within(1e-6, "execute", found, expected);
    }
    for overshoot in &zigzag.overshoots {
        let near: Vec<f64> = (-3000..=3000).map(|k| overshoot.peak_time.value + 1e-3 * f64::from(k)).collect();
        let peak = plant.sampled(&near).0.iter().fold(0.0_f64, |most, psi| most.max(psi.abs()));
        within(2e-3, "overshoot, closed form,", to_deg(overshoot.angle.value), to_deg(peak) - psi_deg);
    }
}

#[test]
fn anchors_sampled_every_second() {
    ANCHORS.iter().filter(|anchor| anchor.0[2].is_finite()).for_each(|anchor| check_anchor(anchor, 1.0));
}

#[test]
fn anchors_sampled_finely() {
    ANCHORS.iter().for_each(|anchor| check_anchor(anchor, if anchor.0[2].is_finite() { 0.2 } else { 0.01 }));
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
