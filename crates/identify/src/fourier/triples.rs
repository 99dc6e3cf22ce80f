//! Solution for K, T and δ_r from triples of instants: T r'ᵢ + rᵢ = K (δᵢ + δ_r), i = 1, 2, 3, eq. (10) of Ge, Hu, Yin
//! and Sun.
//!
//! The determinant of the three equations is proportional to the area of the triangle that the instants make in the
//! plane of rudder and r': zero for three instants with one rudder angle, small for a thin triangle, and then the error
//! of r' dominates the estimate. This module samples triples and solves them; the method combines the estimates.

use nalgebra::Matrix3;
use rand::{RngExt, SeedableRng, rngs::ChaCha8Rng};
use serde::{Deserialize, Serialize};

use crate::error::IdentifyError;

/// Minimum area, relative to the product of standard deviations; below it three instants lie on one line to rounding.
const MIN_AREA: f64 = 1e-9;

/// Maximum number of draws per requested triple.
const DRAWS_PER_TRIPLE: usize = 1000;

/// Maximum number of triples: ten million draws if no triple is usable.
pub const MAX_TRIPLES: usize = 10_000;

/// Maximum condition number of the equations of a well-conditioned triple, columns divided by the standard deviations
/// of r' and δ.
const MAX_CONDITION: f64 = 10.0;

/// Selection of the triples.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Selection {
    /// Any three instants.
    Uniform,
    /// Instants from the central nine tenths of the record with the rudder at rest, and equations with a condition
    /// number below 10.
    #[default]
    WellConditioned,
}

/// Rudder, yaw rate and yaw acceleration at an instant: the signals of the equation of motion.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RegressionPoint {
    /// Rudder δ, rad.
    pub rudder: f64,
    /// Yaw rate r, rad/s.
    pub yaw_rate: f64,
    /// Yaw acceleration r', rad/s².
    pub yaw_acceleration: f64,
}

/// Estimate from one triple: the solution of its three equations.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TripleEstimate {
    /// K, 1/s.
    pub K: f64,
    /// T, s.
    pub T: f64,
    /// δ_r, rad.
    pub rudder_bias: f64,
}

/// Estimates of the kept triples, and counts of the other triples.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct SampledTriples {
    /// Estimate of every kept triple.
    pub estimates: Vec<TripleEstimate>,
    /// Number of sampled triples.
    pub sampled: usize,
    /// Number of triples left out because their points lie on a line, for example with three equal rudder angles.
    pub singular: usize,
    /// Number of triples left out with a condition number above the limit.
    pub ill_conditioned: usize,
    /// Number of kept triples with K or T below zero.
    pub negative: usize,
}

/// Samples `count` usable triples from `instants`, with a generator of this `seed`.
///
/// Fails with [`IdentifyError::TooFewPoints`] if there are fewer than three instants or if a thousand draws per triple
/// do not give `count` triples.
pub fn sample_triples(
    instants: &[RegressionPoint],
    selection: Selection,
    count: usize,
    seed: u64,
) -> Result<SampledTriples, IdentifyError> {
    if instants.len() < 3 {
        let kind = "instants with the rudder at rest";
        return Err(IdentifyError::TooFewPoints { kind, needed: 3, count: instants.len() });
    }
    let scale = [standard_deviation(instants, |i| i.yaw_acceleration), standard_deviation(instants, |i| i.rudder)];
    let mut generator = ChaCha8Rng::seed_from_u64(seed);
    let mut drawn = SampledTriples { estimates: Vec::with_capacity(count), ..SampledTriples::default() };
    while drawn.estimates.len() < count {
        if drawn.sampled == count * DRAWS_PER_TRIPLE {
            let (needed, count) = (count, drawn.estimates.len());
            return Err(IdentifyError::TooFewPoints { kind: "usable triples of instants", needed, count });
        }
        let chosen: [usize; 3] = std::array::from_fn(|_| generator.random_range(0..instants.len()));
        if chosen[0] == chosen[1] || chosen[1] == chosen[2] || chosen[0] == chosen[2] {
            continue;
        }
        drawn.sampled += 1;
        let triple = chosen.map(|index| instants[index]);
        let Some(answer) = solve_triple(&triple, scale) else {
            drawn.singular += 1;
            continue;
        };
        if selection == Selection::WellConditioned && condition(&triple, scale) >= MAX_CONDITION {
            drawn.ill_conditioned += 1;
            continue;
        }
        drawn.negative += usize::from(answer.K < 0.0 || answer.T < 0.0);
        drawn.estimates.push(answer);
    }
    Ok(drawn)
}

/// Parameters from three instants; `None` if they lie on a line in the plane of rudder and r' (to rounding), both
/// measured in `scale` (standard deviations of r' and δ), or if K is zero.
pub fn solve_triple(triple: &[RegressionPoint; 3], scale: [f64; 2]) -> Option<TripleEstimate> {
    let [first, second, third] = triple;
    // Differences against the third instant eliminate K δ_r.
    let difference = |i: &RegressionPoint| {
        (i.yaw_acceleration - third.yaw_acceleration, i.yaw_rate - third.yaw_rate, i.rudder - third.rudder)
    };
    let ((a1, r1, d1), (a2, r2, d2)) = (difference(first), difference(second));
    let area = d1 * a2 - a1 * d2;
    if area.abs() <= MIN_AREA * scale[0] * scale[1] || area.is_nan() {
        return None;
    }
    let (T, K) = ((r1 * d2 - r2 * d1) / area, (a2 * r1 - a1 * r2) / area);
    let rudder_bias = (T * third.yaw_acceleration + third.yaw_rate) / K - third.rudder;
    rudder_bias.is_finite().then_some(TripleEstimate { K, T, rudder_bias })
}

/// Condition number of the three equations with scaled columns.
fn condition(triple: &[RegressionPoint; 3], scale: [f64; 2]) -> f64 {
    let rows = Matrix3::from_fn(|row, column| match column {
        0 => triple[row].yaw_acceleration / scale[0],
        1 => triple[row].rudder / scale[1],
        _ => 1.0,
    });
    let values = rows.singular_values();
    // Singular triples are already excluded, so that the smallest value is not zero.
    values.max() / values.min()
}

fn standard_deviation(instants: &[RegressionPoint], quantity: impl Fn(&RegressionPoint) -> f64) -> f64 {
    let count = instants.len() as f64;
    let mean = instants.iter().map(&quantity).sum::<f64>() / count;
    (instants.iter().map(|i| (quantity(i) - mean).powi(2)).sum::<f64>() / count).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::Case;
    use approx::{assert_abs_diff_eq, assert_relative_eq};

    fn exact(case: &Case) -> Vec<RegressionPoint> {
        let truth = case.truth();
        (0..truth.time.len())
            .map(|row| RegressionPoint {
                rudder: truth.rudder[row],
                yaw_rate: truth.yaw_rate[row],
                yaw_acceleration: truth.yaw_acceleration[row],
            })
            .collect()
    }

    #[test]
    fn the_algebra_is_exact() {
        for heading_deg in [10.0, 20.0] {
            let case = Case { heading_deg, bias_deg: 0.7, ..Case::default() };
            let drawn = sample_triples(&exact(&case), Selection::Uniform, 4000, 1).expect("most triples are usable");
            assert!(drawn.singular > 0 && drawn.negative == 0);
            for answer in &drawn.estimates {
                assert_relative_eq!(answer.K, case.K, max_relative = 1e-6);
                assert_relative_eq!(answer.T, case.T, max_relative = 1e-6);
                assert_abs_diff_eq!(answer.rudder_bias, case.ship().rudder_bias, epsilon = 1e-6);
            }
        }
    }

    /// Three equal rudder angles: 14 to 20 % of random triples in 10/10 and 10/20 (independent computation; 0.162 and
    /// 0.190 by counting rows, and the sample has a standard deviation of 0.006).
    #[test]
    fn the_share_of_singular_triples_is_that_of_a_count() {
        for (heading_deg, counted) in [(10.0, 0.162), (20.0, 0.190)] {
            let instants = exact(&Case { heading_deg, ..Case::default() });
            let drawn = sample_triples(&instants, Selection::Uniform, 4000, 1).expect("most triples are usable");
            let share = drawn.singular as f64 / drawn.sampled as f64;
            assert!((share - counted).abs() < 0.02, "{share} singular in 10/{heading_deg}");
        }
    }

    #[test]
    fn the_condition_holds_for_what_is_kept() {
        let instants = exact(&Case::default());
        let drawn = sample_triples(&instants, Selection::default(), 200, 2).expect("enough good triples");
        assert!(drawn.ill_conditioned > 0);
        assert_eq!(drawn.sampled, 200 + drawn.ill_conditioned + drawn.singular);
    }

    #[test]
    fn one_rudder_angle_gives_no_triple() {
        let mut instants = exact(&Case::default());
        instants.retain(|i| (i.rudder - 10f64.to_radians()).abs() < 1e-12);
        let error = sample_triples(&instants, Selection::Uniform, 10, 1).expect_err("one rudder angle");
        assert_eq!(error, IdentifyError::TooFewPoints { kind: "usable triples of instants", needed: 10, count: 0 });
    }
}
