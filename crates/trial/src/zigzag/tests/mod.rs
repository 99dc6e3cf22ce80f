//! Tests of the characteristics as a whole: against an independent simulation, under mirroring, offsets and noise, on
//! measured trials, and on records that are no zig-zag.

mod anchors;

use approx::assert_relative_eq;
use ship::angle::{from_deg, to_deg};

use super::*;
use crate::SensorNoise;
use crate::testing::{Gaussian, Plant, trial};
use document::Quantity;

fn of_plant(plant: Plant, duration: f64, step: f64) -> ZigZag {
    let (time, heading, rudder) = plant.record(duration, step);
    ZigZag::from_trial(&trial(time, heading, rudder)).expect("a zig-zag")
}

/// Reach and complete cycle are the base-course crossings of the closed-form response, found here on a 1 ms grid.
#[test]
fn reach_and_complete_cycle() {
    let (time, heading, _) = Plant::default().record(200.0, 0.001);
    let crossings: Vec<f64> = (1..time.len())
        .filter(|&row| heading[row - 1] * heading[row] < 0.0)
        .map(|row| time[row])
        .filter(|&t| t > 1.0)
        .collect();
    let zigzag = of_plant(Plant::default(), 400.0, 1.0);
    assert_relative_eq!(zigzag.reach.expect("returns").value, crossings[0], epsilon = 0.02);
    assert_relative_eq!(zigzag.complete_cycle_time.expect("returns twice").value, crossings[1], epsilon = 0.02);
}

#[test]
fn an_approach_gives_the_base_course_and_shifts_only_the_clock() {
    let plain = of_plant(Plant::default(), 300.0, 1.0);
    let zigzag = of_plant(Plant { approach: 60.0, ..Plant::default() }, 360.0, 1.0);
    assert_eq!(zigzag.base_course.source, BaseCourseSource::Approach);
    assert_relative_eq!(zigzag.base_course.heading.value, 0.0, epsilon = 1e-6);
    assert_relative_eq!(zigzag.executes[0].time.value, 60.0, epsilon = 1e-6);
    let t_a = |zigzag: &ZigZag| zigzag.initial_turning_time.expect("has a first execute").value;
    assert_relative_eq!(t_a(&zigzag), t_a(&plain), epsilon = 1e-3);
    assert_eq!(zigzag.overshoots.len(), plain.overshoots.len());
    for (a, b) in zigzag.overshoots.iter().zip(&plain.overshoots) {
        assert_relative_eq!(a.angle.value, b.angle.value, epsilon = 1e-4);
    }
}

/// The rows of a noisy, uneven record with a hole, for the invariances.
fn rough_record() -> (Vec<f64>, Vec<f64>, Vec<f64>) {
    let mut gaussian = Gaussian::new(11);
    let mut time = vec![0.0];
    while time[time.len() - 1] < 400.0 {
        time.push(time[time.len() - 1] + 0.6 + 0.8 * (gaussian.draw() * 0.2).abs().min(1.0));
    }
    let (mut heading, rudder) = Plant { approach: 40.0, ..Plant::new(20.0, 20.0, 2.5) }.sampled(&time);
    heading.iter_mut().for_each(|psi| *psi += from_deg(0.2 * gaussian.draw()));
    heading[30] = f64::NAN;
    heading[100..104].fill(f64::NAN);
    (time, heading, rudder)
}

fn mirrored(quantity: Quantity) -> Quantity {
    quantity.scaled(-1.0)
}

#[test]
fn a_mirrored_record_has_exactly_the_mirrored_characteristics() {
    let (time, heading, rudder) = rough_record();
    let negative = |values: &[f64]| values.iter().map(|value| -value).collect::<Vec<f64>>();
    let port_first =
        ZigZag::from_trial(&trial(time.clone(), negative(&heading), negative(&rudder))).expect("a zig-zag");
    let starboard_first = ZigZag::from_trial(&trial(time, heading, rudder)).expect("a zig-zag");
    assert_eq!(starboard_first.first_side, Some(Side::Starboard));
    let mut mirror = starboard_first;
    mirror.first_side = Some(Side::Port);
    mirror.base_course.heading = mirrored(mirror.base_course.heading);
    for execute in &mut mirror.executes {
        execute.heading = mirrored(execute.heading);
        execute.yaw_rate = execute.yaw_rate.map(mirrored);
        execute.rudder_before = -execute.rudder_before;
        execute.rudder_after = -execute.rudder_after;
    }
    for overshoot in &mut mirror.overshoots {
        overshoot.peak_heading = mirrored(overshoot.peak_heading);
    }
    assert_eq!(port_first, mirror);
}

#[test]
fn the_base_course_does_not_matter() {
    let (time, heading, rudder) = rough_record();
    let offset = from_deg(213.0) + 2.0 * std::f64::consts::TAU;
    let turned: Vec<f64> = heading.iter().map(|psi| psi + offset).collect();
    let north = ZigZag::from_trial(&trial(time.clone(), heading, rudder.clone())).expect("a zig-zag");
    let other = ZigZag::from_trial(&trial(time, turned, rudder)).expect("a zig-zag");
    assert_eq!(north.nominal_angles, other.nominal_angles);
    assert_relative_eq!(other.base_course.heading.value, north.base_course.heading.value + offset, epsilon = 1e-10);
    assert_eq!(north.overshoots.len(), other.overshoots.len());
    for (a, b) in north.overshoots.iter().zip(&other.overshoots) {
        assert_relative_eq!(a.angle.value, b.angle.value, epsilon = 1e-10);
        assert_relative_eq!(a.peak_time.value, b.peak_time.value, epsilon = 1e-7);
    }
    let t_a = |zigzag: &ZigZag| zigzag.initial_turning_time.expect("has a first execute").value;
    assert_relative_eq!(t_a(&north), t_a(&other), epsilon = 1e-7);
}

/// A 10/20 trial cut 1.2 s and 5.5 s after its first reversal began, and in the middle of a hold: no first execute.
#[test]
fn a_record_that_begins_within_the_trial() {
    let (time, heading, rudder) = Plant::new(10.0, 20.0, 2.5).record(500.0, 0.1);
    for start in [37.5, 40.3, 41.8, 49.0, 60.0] {
        let from = (start / 0.1_f64).round() as usize;
        let every_second = |values: &[f64]| values[from..].iter().step_by(10).copied().collect::<Vec<f64>>();
        let turned: Vec<f64> = heading.iter().map(|psi| psi + 2.0).collect();
        let record = trial(every_second(&time), every_second(&turned), every_second(&rudder));
        let zigzag = ZigZag::from_trial(&record).expect("a zig-zag");
        assert!(zigzag.lacks_first_execute(), "cut at {start} s");
        assert_eq!(zigzag.base_course.source, BaseCourseSource::Executes);
        assert_relative_eq!(to_deg(zigzag.base_course.heading.value - 2.0), 0.0, epsilon = 0.02);
        assert!(zigzag.nominal_angles.expect("headings agree").is_deg(10.0, 20.0));
        assert_eq!((zigzag.initial_turning_time, zigzag.reach, zigzag.complete_cycle_time), (None, None, None));
        assert_eq!(zigzag.nth_overshoot(1), None);
        assert_relative_eq!(zigzag.executes[0].time.value, 114.60, epsilon = 0.02);
        assert_relative_eq!(to_deg(zigzag.overshoots[0].angle.value), 8.65, epsilon = 0.02);
    }
}

/// Cut 1 s before to 1 s after the reversal at 38.30 s: a one-sided fit would give an error of the first overshoot of
/// up to a degree.
#[test]
fn a_record_that_begins_at_a_reversal_does_not_tell_its_overshoot() {
    let plant = Plant::new(20.0, 20.0, 2.5);
    let (time, heading, rudder) = plant.record(400.0, 0.1);
    let reversal = plant.execute_times(400.0)[1];
    let [_, second, ..] = of_plant(plant, 400.0, 0.1).overshoots[..] else { panic!("four peaks") };
    for start in [-1.0, 0.0, 1.0] {
        let mut gaussian = Gaussian::new(3);
        let from = ((reversal + start) * 10.0).round() as usize;
        let every_second = |values: &[f64]| values[from..].iter().step_by(10).copied().collect::<Vec<f64>>();
        let noisy = every_second(&heading).into_iter().map(|psi| psi + from_deg(0.1 * gaussian.draw())).collect();
        let zigzag = ZigZag::from_trial(&trial(every_second(&time), noisy, every_second(&rudder))).expect("a zig-zag");
        assert!(zigzag.begins_at_reversal && zigzag.lacks_first_execute(), "{start} s");
        assert_eq!(zigzag.overshoots_by_execute().next(), Some(None), "{start} s");
        let next = zigzag.overshoots[0].angle;
        assert!((next.value - second.angle.value).abs() < 4.0 * next.sd.expect("noise"), "{start} s: {next:?}");
    }
}

/// The rudder is at 2.5 to 7.5 of 10 degrees in the first row: the start of the movement is unknown.
#[test]
fn a_record_that_begins_within_the_first_movement_has_no_times_from_it() {
    let whole = of_plant(Plant::default(), 300.0, 1.0);
    for late in [1, 2, 3] {
        let (time, heading, rudder) = Plant::default().record(300.0, 1.0);
        let cut = |values: Vec<f64>| values[late..].to_vec();
        let zigzag = ZigZag::from_trial(&trial(cut(time), cut(heading), cut(rudder))).expect("a zig-zag");
        assert_eq!((zigzag.initial_turning_time, zigzag.reach, zigzag.complete_cycle_time), (None, None, None));
        assert_eq!(zigzag.first_side, Some(Side::Starboard));
        let [cut, uncut] = [&zigzag, &whole].map(|zigzag| zigzag.nth_overshoot(1).expect("seen").angle.value);
        assert_relative_eq!(cut, uncut, epsilon = 1e-3);
    }
}

/// Whole-degree rudder and tenth-degree heading, as printed on a bridge.
#[test]
fn a_record_read_off_indicators() {
    let (time, heading, rudder) = Plant { approach: 30.0, ..Plant::default() }.record(400.0, 1.0);
    let rounded = |values: Vec<f64>, step_deg: f64| {
        values.into_iter().map(|angle| from_deg(step_deg * (to_deg(angle) / step_deg).round())).collect::<Vec<f64>>()
    };
    let zigzag = ZigZag::from_trial(&trial(time, rounded(heading, 0.1), rounded(rudder, 1.0))).expect("a zig-zag");
    assert!(zigzag.nominal_angles.expect("headings agree").is_deg(10.0, 10.0));
    for (execute, expected) in zigzag.executes.iter().zip([30.0, 54.09, 109.20, 167.37, 225.68]) {
        assert!((execute.time.value - expected).abs() < 0.35, "{} for {expected}", execute.time.value);
    }
    for (n, expected) in (1..).zip([6.35, 8.07, 8.14]) {
        assert_relative_eq!(to_deg(zigzag.nth_overshoot(n).expect("seen").angle.value), expected, epsilon = 0.35);
    }
}

#[test]
fn a_peak_after_the_end_is_not_an_overshoot() {
    // The second reversal is at 79.2 s, its peak at 94.2 s.
    let zigzag = of_plant(Plant::default(), 92.0, 1.0);
    assert_eq!((zigzag.executes.len(), zigzag.overshoots.len()), (3, 1));
    assert_eq!(zigzag.period, None);
    assert_eq!(zigzag.complete_cycle_time, None);
    assert!(zigzag.reach.is_some());
}

/// Mean and standard deviation of a characteristic (`pick`) over 200 noisy copies, with the mean of the reported
/// deviations.
fn scatter(noise_deg: f64, pick: impl Fn(&ZigZag) -> Quantity) -> (f64, f64, f64) {
    let plant = Plant { approach: 60.0, ..Plant::default() };
    let (time, heading, rudder) = plant.record(360.0, 1.0);
    let (mut sum, mut squares, mut reported) = (0.0, 0.0, 0.0);
    const SEEDS: u64 = 200;
    for seed in 0..SEEDS {
        let mut gaussian = Gaussian::new(1000 + seed);
        let noisy = heading.iter().map(|psi| psi + from_deg(noise_deg * gaussian.draw())).collect();
        let zigzag = ZigZag::from_trial(&trial(time.clone(), noisy, rudder.clone())).expect("a zig-zag");
        let quantity = pick(&zigzag);
        sum += quantity.value;
        squares += quantity.value * quantity.value;
        reported += quantity.sd.expect("noise can be estimated");
    }
    let n = SEEDS as f64;
    let mean = sum / n;
    (mean, ((squares - n * mean * mean) / (n - 1.0)).sqrt(), reported / n)
}

/// Reported standard deviation within 30 % of the scatter, bias below 0.4 of it, at 0.1 and 0.5 deg of heading noise.
#[test]
fn reported_uncertainty_is_the_scatter_over_seeds() {
    type Pick = fn(&ZigZag) -> Quantity;
    let picks: [(&str, f64, Pick); 7] = [
        ("first overshoot", from_deg(6.35), |zigzag| zigzag.nth_overshoot(1).expect("seen").angle),
        ("second overshoot", from_deg(8.07), |zigzag| zigzag.nth_overshoot(2).expect("seen").angle),
        ("time to check yaw", 14.95, |zigzag| zigzag.nth_overshoot(2).expect("seen").time_to_check_yaw),
        ("execute heading", from_deg(10.0), |zigzag| zigzag.executes[1].heading),
        ("rate at execute", from_deg(0.741), |zigzag| zigzag.executes[1].yaw_rate.expect("has headings")),
        ("t_a", 24.09, |zigzag| zigzag.initial_turning_time.expect("has a first execute")),
        ("heading noise", 0.0, |zigzag| Quantity::new(zigzag.heading_noise_sd.expect("estimated"), Some(0.0))),
    ];
    for noise_deg in [0.1, 0.5] {
        for (name, truth, pick) in picks {
            let (mean, sd, reported) = scatter(noise_deg, pick);
            if name == "heading noise" {
                assert_relative_eq!(to_deg(mean), noise_deg, max_relative = 0.1);
                continue;
            }
            assert!(
                (0.7..1.3).contains(&(reported / sd)),
                "{noise_deg} deg: {name}: scatter {sd}, reported {reported}"
            );
            assert!((mean - truth).abs() < 0.4 * sd, "{noise_deg} deg: {name}: {mean} for {truth}, scatter {sd}");
        }
    }
}

#[test]
fn declared_noise_wins_over_the_estimate() {
    let (time, heading, rudder) = Plant::default().record(300.0, 1.0);
    let noise = SensorNoise { heading_sd: Some(from_deg(0.3)), ..SensorNoise::default() };
    let zigzag = ZigZag::from_trial(&trial(time, heading, rudder).with_noise(noise)).expect("a zig-zag");
    assert_eq!(zigzag.heading_noise_sd, noise.heading_sd);
    let sd = to_deg(zigzag.overshoots[0].angle.sd.expect("declared"));
    assert!((0.1..0.3).contains(&sd), "{sd}");
}

#[test]
fn other_records_are_refused() {
    let time: Vec<f64> = (0..300).map(f64::from).collect();
    let zero = vec![0.0; 300];
    let of = |heading: Vec<f64>, rudder: Vec<f64>| {
        ZigZag::from_trial(&trial(time.clone(), heading, rudder)).expect_err("refused")
    };
    assert!(matches!(of(zero.clone(), zero.clone()), ZigZagError::NoRudder { .. }));

    let mut gaussian = Gaussian::new(5);
    let jitter: Vec<f64> = (0..300).map(|_| from_deg(0.1 * gaussian.draw())).collect();
    assert!(matches!(of(zero.clone(), jitter), ZigZagError::NoRudder { .. }));
    let autopilot: Vec<f64> = (0..300).map(|_| from_deg(2.0 * gaussian.draw())).collect();
    assert!(matches!(of(zero.clone(), autopilot), ZigZagError::NotHeld { .. }));

    let circle: Vec<f64> = time.iter().map(|t| if *t < 20.0 { 0.02 } else { -0.6 }).collect();
    assert_eq!(of(zero.clone(), circle), ZigZagError::TooFewReversals { reversals: 0, needed: 2 });

    let (_, heading, rudder) = Plant::default().record(299.0, 1.0);
    let flipped: Vec<f64> = rudder.iter().map(|delta| -delta).collect();
    assert!(matches!(of(heading.clone(), flipped), ZigZagError::HeadingAgainstRudder { .. }));

    let mut holed = heading;
    holed[60..100].fill(f64::NAN);
    assert!(matches!(of(holed, rudder), ZigZagError::NoHeading { .. }));
}

/// Rudder noise of 0.3 deg: errors of the executes match their standard deviations (rms of error/sd within 0.6 and 1.6,
/// an approximation because the rows of a ramp are chosen by their noisy angle).
#[test]
fn executes_of_a_noisy_rudder() {
    for step in [0.1, 1.0] {
        for approach in [0.0, 60.0] {
            let plant = Plant { approach, ..Plant::default() };
            let (time, heading, rudder) = plant.record(420.0, step);
            let expected = plant.execute_times(420.0);
            let (mut squares, mut n) = (0.0, 0.0);
            for seed in 0..20 {
                let mut gaussian = Gaussian::new(seed);
                let noisy = rudder.iter().map(|delta| delta + from_deg(0.3 * gaussian.draw())).collect();
                let zigzag = ZigZag::from_trial(&trial(time.clone(), heading.clone(), noisy)).expect("a zig-zag");
                for (execute, expected) in zigzag.executes.iter().zip(&expected) {
                    let error = execute.time.value - expected;
                    assert!(error.abs() < 0.5, "every {step} s: {} for {expected}", execute.time.value);
                    squares += (error / execute.time.sd.expect("always known")).powi(2);
                    n += 1.0;
                }
            }
            let ratio: f64 = (squares / n).sqrt();
            assert!((0.6..1.6).contains(&ratio), "every {step} s, approach {approach} s: {ratio}");
        }
    }
}

/// Every 5 s the ramps of 8 s (reversals) and 4 s (first execute) contain two rows, one or none: errors of the executes
/// are less than the half-width of the interval that contains them, √3 of its standard deviation, or by half a second.
#[test]
fn sparse_sampling() {
    for (delta_deg, psi_deg) in [(10.0, 10.0), (10.0, 20.0), (20.0, 20.0)] {
        let plant = Plant { approach: 60.0, ..Plant::new(delta_deg, psi_deg, 2.5) };
        let zigzag = of_plant(plant, 500.0, 5.0);
        assert!(zigzag.nominal_angles.expect("headings agree").is_deg(delta_deg, psi_deg));
        for (execute, expected) in zigzag.executes.iter().zip(plant.execute_times(500.0)) {
            let sd = execute.time.sd.expect("always known");
            let error = (execute.time.value - expected).abs();
            assert!(error <= 0.5 + 3.0_f64.sqrt() * sd && error <= 2.5, "{:?} for {expected}", execute.time);
        }
    }
}
