//! Characteristics of a manoeuvre; the unit is in the name. Source of the definitions: MSC.137(76) and MSC/Circ.1053
//! (2002).

use std::f64::consts::{FRAC_PI_2, PI};

use indexmap::IndexMap;
use ship::Particulars;
use ship::angle::to_deg;
use simulate::motion::turning_circle;
use simulate::{HelmOrder, Manoeuvre};
use trial::manoeuvre::INITIAL_TURNING_CHANGE_RAD;

use crate::interval::PredictionInterval;
use crate::simulated_manoeuvre::{PlanarMotion, SimulatedManoeuvre};
use crate::standard::ZIG_ZAG_EXECUTES;

/// Characteristics by name; `None` for a characteristic that the motion does not reach.
pub type Characteristics = IndexMap<&'static str, Option<f64>>;

pub(crate) const OVERSHOOT_NAMES: [&str; ZIG_ZAG_EXECUTES - 2] =
    ["first_overshoot_deg", "second_overshoot_deg", "third_overshoot_deg", "fourth_overshoot_deg"];

pub(crate) const EXECUTE_TIME_NAMES: [&str; ZIG_ZAG_EXECUTES - 1] =
    ["second_execute_s", "third_execute_s", "fourth_execute_s", "fifth_execute_s", "sixth_execute_s"];

/// Characteristics of a manoeuvre: overshoots, times, diameters; lengths in ship lengths if length and speed are known.
///
/// For a model without speed the distance of the initial turning is V times the time.
pub fn characteristics(
    kind: &Manoeuvre,
    passage: &SimulatedManoeuvre,
    particulars: Option<Particulars>,
) -> Characteristics {
    let side = kind.first_side().sign();
    let last = passage.heading.last().copied();
    match *kind {
        Manoeuvre::ZigZag { heading, .. } => {
            let mut figures = initial_turning(passage, passage.time_of_heading_change(heading, side), particulars);
            zig_zag(passage, &mut figures);
            figures
        }
        Manoeuvre::InitialTurning { .. } => {
            let end = passage.time(passage.heading.len().saturating_sub(1));
            initial_turning(
                passage,
                passage.time_of_heading_change(INITIAL_TURNING_CHANGE_RAD - 1e-9, side).or(Some(end)),
                particulars,
            )
        }
        Manoeuvre::TurningCircle { .. } => {
            let mut figures = turn_characteristics(passage, side);
            figures.extend(circle_characteristics(passage, 0.0));
            figures
        }
        Manoeuvre::PullOut { .. } => Characteristics::from([
            ("rate_before_deg_s", mean_rate(passage, passage.heading.len() / 2, side)),
            ("residual_rate_deg_s", mean_rate(passage, passage.heading.len(), side)),
        ]),
        // The ship returns from the other side: the opposite course is at −180°.
        Manoeuvre::Williamson { .. } => Characteristics::from([
            ("second_execute_s", passage.executes.get(1).map(|execute| execute.time)),
            ("third_execute_s", passage.executes.get(2).map(|execute| execute.time)),
            ("course_error_deg", last.map(|heading| to_deg(-side * heading - PI))),
        ]),
        Manoeuvre::Spiral { .. } | Manoeuvre::Replay { .. } => Characteristics::default(),
    }
}

/// Time of the initial turning (s), and its distance in ship lengths if length and speed are known.
pub(crate) fn initial_turning(
    passage: &SimulatedManoeuvre,
    turning: Option<f64>,
    particulars: Option<Particulars>,
) -> Characteristics {
    let lengths = particulars.map(|Particulars { length, speed }| {
        turning.map(|time| passage.distance_sailed(time).unwrap_or(speed * time) / length)
    });
    let lengths = lengths.map(|lengths| ("initial_turning_lengths", lengths));
    [("initial_turning_time_s", turning)].into_iter().chain(lengths).collect()
}

/// Characteristics of the track of a turn with the execute at `execute` s; empty for a model without speed and drift.
pub(crate) fn circle_characteristics(passage: &SimulatedManoeuvre, execute: f64) -> Characteristics {
    let Some(PlanarMotion { length, velocity, track }) = &passage.planar_motion else {
        return Characteristics::default();
    };
    let time: Vec<f64> = (0..passage.heading.len()).map(|row| passage.time(row)).collect();
    let measures = turning_circle([&time, &passage.heading, &passage.yaw_rate], [track, velocity], execute);
    let lengths = |metres: Option<f64>| metres.map(|metres| metres / length);
    let speed_loss = ("speed_loss_share", measures.speed_ratio.map(|ratio| 1.0 - ratio));
    Characteristics::from([
        ("advance_m", measures.advance),
        ("advance_lengths", lengths(measures.advance)),
        ("transfer_m", measures.transfer),
        ("tactical_diameter_m", measures.tactical_diameter),
        ("tactical_diameter_lengths", lengths(measures.tactical_diameter)),
        speed_loss,
        ("drift_angle_deg", measures.drift_angle.map(|angle| to_deg(angle.abs()))),
        ("pivot_ahead_lengths", lengths(measures.pivot_ahead)),
    ])
}

/// `true` if an interval is possible for a characteristic: the 5 % quantile of a size of a turning circle is positive.
pub(crate) fn is_possible(name: &str, interval: &PredictionInterval) -> bool {
    let is_size = ["advance", "transfer", "tactical_diameter"].iter().any(|size| name.starts_with(size));
    !is_size || interval.ci90[0] > 0.0
}

/// Overshoots, executes and period of a zig-zag.
///
/// An overshoot is counted from the heading at its execute.
fn zig_zag(passage: &SimulatedManoeuvre, figures: &mut Characteristics) {
    let executes = &passage.executes;
    for (number, name) in OVERSHOOT_NAMES.into_iter().enumerate() {
        let overshoot = || {
            let (before, now, next) = (executes.get(number)?, executes.get(number + 1)?, executes.get(number + 2)?);
            let side = before.ordered_rudder.signum();
            Some(to_deg(passage.peak(side, now.time, next.time)? - side * now.heading))
        };
        figures.insert(name, overshoot());
    }
    for (number, name) in EXECUTE_TIME_NAMES.into_iter().enumerate() {
        figures.insert(name, executes.get(number + 1).map(|execute| execute.time));
    }
    figures.insert("period_s", execute_period(executes));
}

/// Mean time between executes to the same side, s; `None` without a cycle. The cycle from the second execute on
/// includes the initial transient and counts only if there is no later cycle, as in a record
/// ([`trial::ZigZag::period`]).
pub(crate) fn execute_period(executes: &[HelmOrder]) -> Option<f64> {
    let first = if executes.len() > 4 { 2 } else { 1 };
    let ends = executes.iter().skip(first + 2);
    let cycles: Vec<f64> = executes.iter().skip(first).zip(ends).map(|(a, b)| b.time - a.time).collect();
    (!cycles.is_empty()).then(|| cycles.iter().sum::<f64>() / cycles.len() as f64)
}

/// Times and steady rate of a turn to one side (±1); the rate is the mean over the last half turn of a turn beyond
/// 270°.
pub(crate) fn turn_characteristics(passage: &SimulatedManoeuvre, side: f64) -> Characteristics {
    let last = passage.heading.last().map_or(0.0, |heading| side * heading);
    let steady = || {
        let from = passage.time_of_heading_change(last - PI, side).filter(|_| last > 1.5 * PI)?;
        Some(to_deg(PI / (passage.time_of_heading_change(last, side)? - from)))
    };
    Characteristics::from([
        ("time_to_90_s", passage.time_of_heading_change(FRAC_PI_2, side)),
        ("time_to_180_s", passage.time_of_heading_change(PI, side)),
        ("steady_rate_deg_s", steady()),
    ])
}

/// Mean yaw rate to a side (±1) over the last tenth of the rows before `until`, deg/s; `None` for fewer than ten rows.
fn mean_rate(passage: &SimulatedManoeuvre, until: usize, side: f64) -> Option<f64> {
    let rows = &passage.yaw_rate[until - until / 10..until];
    (!rows.is_empty()).then(|| to_deg(side * rows.iter().sum::<f64>() / rows.len() as f64))
}

#[cfg(test)]
mod tests {
    use super::*;
    use ship::FirstOrder;
    use ship::angle::from_deg;
    use simulate::{Disturbances, SteeringGear, StreamKey};

    use crate::mixture::DrawnShip;

    fn yukun(kind: &Manoeuvre) -> SimulatedManoeuvre {
        let ship = DrawnShip {
            response: ship::Response::first_order_ship(FirstOrder::from_indices(0.1, 16.3, 0.0)),
            hull: None,
            hull_coefficients: Vec::new(),
            gear: SteeringGear::with_rate(from_deg(2.5)),
            disturbances: Disturbances::default(),
            initial_yaw_rate: 0.0,
            moment_key: StreamKey::default(),
        };
        SimulatedManoeuvre::simulate(&ship, &crate::standard::with_predicted_end(kind, 12.8).expect("steered"), 12.8)
            .expect("a manoeuvre")
    }

    fn value(figures: &Characteristics, name: &str) -> f64 {
        figures.get(name).copied().flatten().unwrap_or(f64::NAN)
    }

    /// YUKUN with a rudder of 2.5 deg/s: overshoots of 6.35 and 8.07 deg (10/10), 18.8 deg (20/20), computed
    /// independently with a step of 0.01 s, by which executes may be late.
    #[test]
    fn overshoots_are_those_of_the_reference() {
        let kind: Manoeuvre = "zig-zag:10/10".parse().expect("known");
        let ten = characteristics(&kind, &yukun(&kind), None);
        assert!((value(&ten, "first_overshoot_deg") - 6.35).abs() < 0.025, "{ten:?}");
        assert!((value(&ten, "second_overshoot_deg") - 8.07).abs() < 0.025, "{ten:?}");
        let kind: Manoeuvre = "zig-zag:20/20".parse().expect("known");
        let twenty = characteristics(&kind, &yukun(&kind), None);
        assert!((value(&twenty, "first_overshoot_deg") - 18.8).abs() < 0.06, "{twenty:?}");
    }

    /// Steady turn of K δ, and decay of the rate.
    #[test]
    fn turns_settle_where_the_ship_does() {
        let kind: Manoeuvre = "turning-circle:-10".parse().expect("known");
        let turn = characteristics(&kind, &yukun(&kind), None);
        assert!((value(&turn, "steady_rate_deg_s") - 1.0).abs() < 1e-3, "{turn:?}");
        // r = K δ (1 − e^(−t/T)) from a ramp of four seconds: T + 2 s late.
        assert!((value(&turn, "time_to_180_s") - (180.0 + 16.3 + 2.0)).abs() < 0.1, "{turn:?}");
        let kind: Manoeuvre = "pull-out:10".parse().expect("known");
        let pull_out = characteristics(&kind, &yukun(&kind), None);
        assert!((value(&pull_out, "rate_before_deg_s") - 1.0).abs() < 1e-3, "{pull_out:?}");
        assert!(value(&pull_out, "residual_rate_deg_s").abs() < 1e-3, "{pull_out:?}");
    }

    /// A mirrored manoeuvre has the same characteristics.
    #[test]
    fn sides_are_mirrored() {
        for [original, mirrored] in [["zig-zag:10/10", "zig-zag:-10/10"], ["williamson:35", "williamson:-35"]] {
            let [original, mirrored]: [Manoeuvre; 2] = [original, mirrored].map(|text| text.parse().expect("known"));
            let (a, b) = (
                characteristics(&original, &yukun(&original), None),
                characteristics(&mirrored, &yukun(&mirrored), None),
            );
            for ((name, a), (_, b)) in a.iter().zip(&b) {
                let (a, b) = (a.expect(name), b.expect(name));
                assert!((a - b).abs() < 1e-9, "{name} {a} {b}");
            }
        }
        let kind: Manoeuvre = "initial-turning:10".parse().expect("known");
        let turning = characteristics(&kind, &yukun(&kind), Some(Particulars { length: 75.0, speed: 6.0 }));
        let time = value(&turning, "initial_turning_time_s");
        assert!(time > 20.0 && time < 30.0, "{time}");
        assert!((value(&turning, "initial_turning_lengths") - time * 6.0 / 75.0).abs() < 1e-9);
    }
}
