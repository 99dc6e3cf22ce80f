use approx::assert_relative_eq;
use nalgebra::{DMatrix, DVector};
use ship::angle::from_deg;
use ship::effects::listed_effect;
use ship::first_order::{FirstOrderTransition, YawState};

use super::*;
use crate::testing::{BASE, TrialPlan, of_columns, record, ship};

fn base() -> FirstOrder {
    FirstOrder { inverse_T: BASE[0], K_over_T: BASE[1], rudder_bias: BASE[2] }
}

/// Mean and variance given all rows agree with one large normal vector, for either sign of 1/T.
#[test]
fn the_smoother_is_the_conditional_mean() {
    for inverse in [0.06, 0.0, -0.03] {
        let ship = FirstOrder { inverse_T: inverse, K_over_T: 0.02, rudder_bias: 0.0 };
        let time = (0..14).map(|k| 1.3 * f64::from(k) + 0.4 * f64::from(k % 3) + if k > 8 { 7.0 } else { 0.0 });
        let time: Vec<f64> = time.collect();
        let n = time.len();
        let noise: Vec<f64> = (0..n).map(|k| if k % 4 == 0 { 2.0 } else { 1.0 }).collect();
        let (sd, intensity) = (0.05, 0.7);
        let rows = MomentRows::new(ship, time.clone(), noise.clone(), sd);
        let heading: Vec<f64> = time.iter().map(|t| (0.21 * t).sin() + 0.02 * t).collect();
        let column = HeadingRows { heading: heading.clone(), forced: vec![[0.0; 2]; n] };

        // Heading at a time after a unit state; integrated over the walk.
        let slope = |t: f64| FirstOrderTransition::new(inverse, t);
        let of = |t: f64| -> [f64; 3] { [1.0, slope(t).phi1, 0.02 * slope(t).phi2] };
        let prior = sd.powi(-2);
        let (mut seen, mut cross) = (DMatrix::<f64>::from_diagonal(&DVector::from_vec(noise)), DMatrix::zeros(n, n));
        let mut moments = DMatrix::<f64>::zeros(n, n);
        let since = |row: usize| time[row] - time[0];
        for i in 0..n {
            for j in 0..n {
                let (row, other) = (of(since(i)), of(since(j)));
                seen[(i, j)] += prior * (0..3).map(|k| row[k] * other[k]).sum::<f64>();
                cross[(i, j)] = prior * other[2];
                moments[(i, j)] = prior + intensity * since(i.min(j));
                let until = since(i.min(j));
                let both = |s: f64| of(since(i) - s)[2] * of(since(j) - s)[2];
                seen[(i, j)] += intensity * integral(until, both);
                // The moment of row i and the heading of row j.
                cross[(i, j)] += intensity * integral(until, |s| of(since(j) - s)[2]);
            }
        }
        let factor = seen.cholesky().expect("a covariance");
        let mean = &cross * factor.solve(&DVector::from_vec(heading));
        let left = &moments - &cross * factor.solve(&cross.transpose());
        let filter = rows.filter(intensity);
        let (states, variances) = (filter.smoothed(&column), filter.moment_variance());
        for row in 0..n {
            assert_relative_eq!(states[row][2], mean[row], epsilon = 1e-8, max_relative = 1e-8);
            assert_relative_eq!(variances[row], left[(row, row)], max_relative = 1e-8);
        }
    }
}

/// ∫₀ᵗ by the five-point Gauss–Legendre rule on forty pieces.
fn integral(until: f64, value: impl Fn(f64) -> f64) -> f64 {
    let nodes = [(0.0, 128.0 / 225.0), (1.0, 0.0), (-1.0, 0.0)];
    let root = |sign: f64| (5.0 + sign * 2.0 * (10.0_f64 / 7.0).sqrt()).sqrt() / 3.0;
    let weight = |sign: f64| (322.0 - sign * 13.0 * 70.0_f64.sqrt()) / 900.0;
    let inner =
        [(root(-1.0), weight(-1.0)), (-root(-1.0), weight(-1.0)), (root(1.0), weight(1.0)), (-root(1.0), weight(1.0))];
    let half = until / 80.0;
    let piece = |k: usize| {
        let middle = (2 * k + 1) as f64 * half;
        nodes.iter().chain(&inner).map(|(x, w)| w * half * value(middle + x * half)).sum::<f64>()
    };
    (0..40).map(piece).sum()
}

/// Steps forced by the rudder and by a moment agree with the exact response.
#[test]
fn a_known_input_acts_between_rows() {
    let truth = base();
    let record =
        PreparedRecord::unaveraged(&record(&ship(Vec::new()), TrialPlan { noise_deg: 0.0, ..TrialPlan::default() }));
    let time: Vec<f64> = record.observed_rows.iter().map(|&row| record.time[row]).collect();
    let rows = MomentRows::new(truth, time.clone(), vec![1.0; time.len()], 1e-3);
    let steered = rows.rudder_response(&record.rudder);
    let rudder: Vec<f64> = at_rows(&record.rudder, &time).iter().map(|delta| delta + BASE[2]).collect();
    for (steered, pushed) in steered.iter().zip(rows.moment_response(&rudder)) {
        assert_relative_eq!(steered[0], pushed[0], epsilon = 1e-14);
        assert_relative_eq!(steered[1], pushed[1], epsilon = 1e-14);
    }
}

/// For a ship equal to the base the interval contains zero in nine of ten rows, and hardly any curve excludes zero.
#[test]
fn no_moment_is_missing_from_the_true_base() {
    let (mut inside, mut all, mut shown) = (0, 0, 0);
    for seed in 1..=20 {
        let record = PreparedRecord::unaveraged(&record(&ship(Vec::new()), TrialPlan { seed, ..TrialPlan::default() }));
        let missing = MissingMoment::new(&record, &base(), from_deg(0.05), Vec::new()).expect("enough rows");
        let holds = |row: &usize| missing.interval(*row)[0] <= 0.0 && 0.0 <= missing.interval(*row)[1];
        inside += (0..missing.time.len()).filter(holds).count();
        all += missing.time.len();
        assert_eq!(missing.channel_moments.len(), 3);
        shown += missing.channel_moments.iter().filter(|moment| !moment.curve.contains_zero()).count();
    }
    assert!(10 * inside >= 9 * all && shown <= 2, "{inside} of {all} rows, {shown} of 60 curves");
}

/// A course-unstable base on a long record: the smoothed heading follows the record, and a step of the moment is found.
#[test]
fn an_unstable_base_is_smoothed_as_well() {
    let unstable = FirstOrder { inverse_T: -0.02, K_over_T: 0.01, rudder_bias: 0.0 };
    let count = 1500;
    let time: Vec<f64> = (0..count).map(f64::from).collect();
    // Steered to stay on course; the moment begins at half time.
    let moment = |t: f64| if t < 750.0 { 0.0 } else { from_deg(2.0) };
    let (mut heading, mut rudder, mut state) = (Vec::new(), Vec::new(), YawState::default());
    for &t in &time {
        let order = 0.2 * (0.05 * t).sin() - 2.0 * state.heading - 8.0 * state.yaw_rate;
        heading.push(state.heading + from_deg(0.02) * (1.7 * t * t).sin());
        rudder.push(order);
        let input = |delta: f64| 0.01 * (delta + moment(t));
        let ahead = FirstOrderTransition::new(-0.02, 1.0);
        // The next order is the fixed point of an iteration.
        let next = (0..200).fold(order, |next, _| {
            let to = ahead.advance(state, input(order), input(next) - input(order));
            0.5 * (next + 0.2 * (0.05 * (t + 1.0)).sin() - 2.0 * to.heading - 8.0 * to.yaw_rate)
        });
        state = ahead.advance(state, input(order), input(next) - input(order));
    }
    let record = PreparedRecord::unaveraged(&of_columns(time, heading, rudder));
    let missing = MissingMoment::new(&record, &unstable, from_deg(0.02), Vec::new()).expect("enough rows");
    for (row, expected) in [(300, 0.0), (600, 0.0), (900, from_deg(2.0)), (1300, from_deg(2.0))] {
        assert!((missing.moment[row] - expected).abs() < 4.0 * missing.moment_sd[row].min(from_deg(0.3)), "{row}");
    }
}

/// Cubic damping gives an odd curve, −n₃ r³/K against the yaw rate, in units of rudder.
#[test]
fn cubic_damping_has_its_shape() {
    const CUBE: f64 = 80.0;
    let damped = ship(vec![(listed_effect("nonlinear_damping", "r³"), vec![CUBE])]);
    let record = PreparedRecord::unaveraged(&record(&damped, TrialPlan::default()));
    let missing = MissingMoment::new(&record, &base(), from_deg(0.05), Vec::new()).expect("enough rows");
    let over_yaw_rate = &missing.channel_moments[0];
    assert_eq!(
        over_yaw_rate.channel,
        MomentChannel::YawRate,
        "{:?}",
        missing.channel_moments.iter().map(|p| (p.channel, p.explained_share)).collect::<Vec<_>>()
    );
    assert!(over_yaw_rate.explained_share.is_some_and(|share| share > 0.8), "{:?}", over_yaw_rate.explained_share);
    assert!(!over_yaw_rate.curve.contains_zero());
    // r' = … − c r³ equals the effect of a rudder angle of −c r³ T/K.
    let per = CUBE / BASE[1];
    let rates = &missing.channels[0].1;
    let mean = rates.iter().map(|r| -per * r.powi(3)).sum::<f64>() / rates.len() as f64;
    let truth: Vec<f64> = over_yaw_rate.curve.channel_values.iter().map(|r| -per * r.powi(3) - mean).collect();
    assert!(over_yaw_rate.curve.contains(&truth));
    let (x, moment) = (&over_yaw_rate.curve.channel_values, &over_yaw_rate.curve.moment);
    let at = |r: f64| {
        let place = (1..x.len()).find(|&k| x[k] >= r).unwrap_or(x.len() - 1);
        moment[place - 1] + (moment[place] - moment[place - 1]) * (r - x[place - 1]) / (x[place] - x[place - 1])
    };
    let reach = 0.9 * x[0].abs().min(x[x.len() - 1]);
    let size = moment.iter().fold(0.0_f64, |largest, m| largest.max(m.abs()));
    for share in [0.3, 0.6, 1.0] {
        let sum = at(share * reach) + at(-share * reach) - 2.0 * at(0.0);
        assert!(sum.abs() < 0.15 * size, "{sum} against {size}");
    }
    assert!(at(reach) < -0.2 * size && at(-reach) > 0.2 * size);
}

#[test]
fn few_rows_have_no_moment() {
    let record = PreparedRecord::unaveraged(&record(&ship(Vec::new()), TrialPlan { rows: 20, ..TrialPlan::default() }));
    assert_eq!(MissingMoment::new(&record, &base(), 1e-3, Vec::new()), None);
}
