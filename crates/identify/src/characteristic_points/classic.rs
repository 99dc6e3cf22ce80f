//! Traditional solution: K and δ_r between instants with r = 0, then T from such an instant to a passage of the base
//! course. Source: Nomoto (1960), see the parent module.

use nalgebra::{DMatrix, DVector, Matrix2, Matrix3, Vector2};

use super::points::{CharacteristicPoint, TrialPoints};
use super::points_fit::{AnalysedTrial, PointsFit};
use crate::error::IdentifyError;
use estimation::column::extremes;
use estimation::least_squares::LeastSquares;

/// Characteristic points of one trial that enter the solution.
struct SelectedPoints<'a> {
    /// Instants with r = 0.
    still: &'a [CharacteristicPoint],
    /// Passages of the base course.
    crossings: Vec<CharacteristicPoint>,
}

/// Differences between two points: ψ(t) − ψ(s) + T [r(t) − r(s)] = K (rudder + δ_r duration).
#[derive(Debug, Clone, Copy)]
struct Interval {
    /// Duration t − s, s.
    duration: f64,
    /// Rudder integral ∫δ, rad s.
    rudder: f64,
    /// Change of heading, rad.
    heading: f64,
    /// Yaw rate r at the end, rad/s.
    rate: f64,
}

impl Interval {
    fn between(from: &CharacteristicPoint, to: &CharacteristicPoint) -> Self {
        Self {
            duration: to.time - from.time,
            rudder: to.rudder_integral - from.rudder_integral,
            heading: to.heading - from.heading,
            rate: to.yaw_rate,
        }
    }

    /// K (∫δ + δ_r Δt) − Δψ, rad: T r for an interval that begins with r = 0.
    fn rate_moment(&self, gain: &GainFit) -> f64 {
        gain.gain * self.rudder + gain.gain_bias * self.duration - self.heading
    }
}

/// K (1/s), K δ_r (rad/s) and their covariance; the covariance is `None` without degrees of freedom.
#[derive(Debug)]
struct GainFit {
    gain: f64,
    gain_bias: f64,
    /// Covariance of (K, K δ_r) and its degrees of freedom.
    covariance: Option<(Matrix2<f64>, f64)>,
    condition: f64,
}

/// K, K δ_r and T by the traditional method, from all points or from the first three peaks of every trial. `bias` is a
/// given δ_r, rad; `None` identifies it.
pub(super) fn identify(
    trials: &[AnalysedTrial],
    bias: Option<f64>,
    condition_limit: f64,
    three_peaks: bool,
) -> Result<PointsFit, IdentifyError> {
    let used = trials
        .iter()
        .map(|trial| if three_peaks { first_three_peaks(&trial.points) } else { Ok(all(&trial.points)) })
        .collect::<Result<Vec<_>, _>>()?;
    let swings: Vec<Vec<Interval>> = used
        .iter()
        .map(|trial| trial.still.windows(2).map(|pair| Interval::between(&pair[0], &pair[1])).collect())
        .collect();
    let rises: Vec<Interval> = used
        .iter()
        .flat_map(|trial| trial.crossings.iter().filter_map(|crossing| to_crossing(trial.still, crossing)))
        .collect();
    let gain = GainFit::from_swings(&swings, bias, condition_limit)?;
    let flat: Vec<Interval> = swings.into_iter().flatten().collect();
    let squares: f64 = rises.iter().map(|rise| rise.rate * rise.rate).sum();
    if rises.is_empty() {
        return Err(IdentifyError::TooFewPoints { kind: "passages of the base course", needed: 1, count: 0 });
    }
    // The ratio of sums has less variance than the mean of ratios, because it weights them by r².
    let time = rises.iter().map(|rise| rise.rate_moment(&gain) * rise.rate).sum::<f64>() / squares;
    Ok(PointsFit {
        parameters: [gain.gain, gain.gain_bias, time],
        covariance: covariance(&gain, &rises, time, squares),
        diagnostics: diagnostics(&flat, &rises, &gain),
    })
}

fn all(points: &TrialPoints) -> SelectedPoints<'_> {
    SelectedPoints { still: &points.zero_rate_points, crossings: points.crossings.clone() }
}

fn first_three_peaks(points: &TrialPoints) -> Result<SelectedPoints<'_>, IdentifyError> {
    let extrema = points.extrema();
    let still = extrema.get(..3).ok_or(IdentifyError::TooFewPoints {
        kind: "heading extrema",
        needed: 3,
        count: extrema.len(),
    })?;
    let inside = |crossing: &&CharacteristicPoint| crossing.time > still[0].time && crossing.time < still[2].time;
    Ok(SelectedPoints { still, crossings: points.crossings.iter().filter(inside).copied().collect() })
}

/// Interval from the last instant with r = 0 before a passage, or from the first instant after it if none is before.
fn to_crossing(still: &[CharacteristicPoint], crossing: &CharacteristicPoint) -> Option<Interval> {
    let after = still.partition_point(|point| point.time < crossing.time);
    let from = still.get(after.saturating_sub(1))?;
    Some(Interval::between(from, crossing))
}

impl GainFit {
    fn from_swings(swings: &[Vec<Interval>], bias: Option<f64>, condition_limit: f64) -> Result<Self, IdentifyError> {
        let flat = || swings.iter().flatten();
        let count = flat().count();
        let needed = if bias.is_some() { 1 } else { 2 };
        if count < needed {
            return Err(IdentifyError::TooFewPoints {
                kind: "swings between instants without yaw rate",
                needed,
                count,
            });
        }
        let rudder: Vec<f64> = flat().map(|swing| swing.rudder + bias.unwrap_or(0.0) * swing.duration).collect();
        let duration: Vec<f64> = flat().map(|swing| swing.duration).collect();
        let heading: Vec<f64> = flat().map(|swing| swing.heading).collect();
        let columns: &[&[f64]] = if bias.is_some() { &[&rudder] } else { &[&rudder, &duration] };
        let solution = LeastSquares::solve(columns, &heading, condition_limit)?;
        let gain = solution.parameters[0];
        let gain_bias = bias.map_or_else(|| solution.parameters[1], |bias| bias * gain);
        let design = DMatrix::from_fn(count, columns.len(), |row, column| columns[column][row]);
        let covariance = difference_covariance(&design, &solution, swings).map(|matrix| {
            let full = match bias {
                // K δ_r follows K.
                Some(bias) => {
                    let along = Vector2::new(1.0, bias);
                    along * along.transpose() * matrix[(0, 0)]
                }
                None => Matrix2::from_fn(|i, j| matrix[(i, j)]),
            };
            (full, solution.degrees_of_freedom)
        });
        Ok(Self { gain, gain_bias, covariance, condition: solution.condition_number })
    }
}

/// Covariance of the solution for independent errors of the points, which correlate successive differences: G Xᵀ Ω X G
/// s² with G = (XᵀX)⁻¹, Ω = tridiag(−1, 2, −1) in every trial and s² = rss / tr(M Ω), M the residual maker. `None`
/// without degrees of freedom.
fn difference_covariance(
    design: &DMatrix<f64>,
    solution: &LeastSquares,
    swings: &[Vec<Interval>],
) -> Option<DMatrix<f64>> {
    if solution.degrees_of_freedom < 1.0 {
        return None;
    }
    let count = design.nrows();
    let mut omega = DMatrix::from_diagonal(&DVector::from_element(count, 2.0));
    let mut row = 0;
    for trial in swings {
        for k in row + 1..row + trial.len() {
            (omega[(k, k - 1)], omega[(k - 1, k)]) = (-1.0, -1.0);
        }
        row += trial.len();
    }
    let inverse = &solution.unscaled_covariance;
    let spread = design.transpose() * &omega * design;
    let expected = omega.trace() - (inverse * &spread).trace();
    (expected > 0.0).then(|| inverse * spread * inverse * (solution.residual_sum_of_squares / expected))
}

fn covariance(
    gain: &GainFit,
    rises: &[Interval],
    time: f64,
    squares: f64,
) -> Result<(Matrix3<f64>, f64), &'static str> {
    let (gain_covariance, gain_freedom) = gain.covariance.ok_or("no more swings than unknowns")?;
    let time_freedom = rises.len() as f64 - 1.0;
    if time_freedom < 1.0 {
        return Err("a single passage of the base course");
    }
    let scatter: f64 = rises.iter().map(|rise| (rise.rate_moment(gain) - time * rise.rate).powi(2)).sum();
    // Derivative of T with respect to (K, K δ_r), through the right-hand side.
    let sensitivity = Vector2::new(
        rises.iter().map(|rise| rise.rate * rise.rudder).sum::<f64>() / squares,
        rises.iter().map(|rise| rise.rate * rise.duration).sum::<f64>() / squares,
    );
    let cross = gain_covariance * sensitivity;
    let scatter_variance = scatter / time_freedom / squares;
    let mut matrix = Matrix3::zeros();
    matrix.fixed_view_mut::<2, 2>(0, 0).copy_from(&gain_covariance);
    matrix.fixed_view_mut::<2, 1>(0, 2).copy_from(&cross);
    matrix.fixed_view_mut::<1, 2>(2, 0).copy_from(&cross.transpose());
    matrix[(2, 2)] = sensitivity.dot(&cross) + scatter_variance;
    Ok((matrix, gain_freedom.min(time_freedom)))
}

/// Diagnostics: K and T by side, K without the first swing and the range of T; undefined values are omitted.
fn diagnostics(swings: &[Interval], rises: &[Interval], gain: &GainFit) -> Vec<(&'static str, f64)> {
    let gain_of = |swings: &[Interval], chosen: &dyn Fn(&Interval) -> bool| {
        let chosen: Vec<&Interval> = swings.iter().filter(|swing| chosen(swing)).collect();
        let squares: f64 = chosen.iter().map(|swing| swing.rudder * swing.rudder).sum();
        let product = |swing: &&Interval| (swing.heading - gain.gain_bias * swing.duration) * swing.rudder;
        (squares > 0.0).then(|| chosen.iter().map(product).sum::<f64>() / squares)
    };
    let time_of = |side: f64| {
        let chosen = || rises.iter().filter(|rise| rise.rate * side > 0.0);
        let squares: f64 = chosen().map(|rise| rise.rate * rise.rate).sum();
        (squares > 0.0).then(|| chosen().map(|rise| rise.rate_moment(gain) * rise.rate).sum::<f64>() / squares)
    };
    let each: Vec<f64> = rises.iter().map(|rise| rise.rate_moment(gain) / rise.rate).collect();
    let (shortest, longest) = extremes(&each);
    let later = swings.get(1..).unwrap_or_default();
    [
        ("condition", Some(gain.condition)),
        ("K_to_starboard_per_s", gain_of(swings, &|swing| swing.heading > 0.0)),
        ("K_to_port_per_s", gain_of(swings, &|swing| swing.heading < 0.0)),
        ("K_without_first_swing_per_s", gain_of(later, &|_| true)),
        ("T_to_starboard_s", time_of(1.0)),
        ("T_to_port_s", time_of(-1.0)),
        ("T_range_s", Some(longest - shortest)),
    ]
    .into_iter()
    .filter_map(|(name, value)| Some((name, value?)))
    .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// After the first swing the rudder is amidships: K of the later swings is undefined.
    #[test]
    fn swings_without_a_rudder_have_no_gain_of_their_own() {
        let swing = |rudder, heading| Interval { duration: 20.0, rudder, heading, rate: 0.0 };
        let swings = [swing(3.0, 0.3), swing(0.0, -0.1), swing(0.0, 0.05)];
        let rises = [Interval { rate: 0.01, ..swing(1.0, 0.1) }];
        let gain = GainFit { gain: 0.1, gain_bias: 0.0, covariance: None, condition: 1.0 };
        let figures = diagnostics(&swings, &rises, &gain);
        assert!(figures.iter().all(|(_, value)| value.is_finite()), "{figures:?}");
        assert!(!figures.iter().any(|(name, _)| *name == "K_without_first_swing_per_s"), "{figures:?}");
    }
}
