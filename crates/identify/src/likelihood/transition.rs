//! Exact transition and noise covariance of the state over a time step, by a power series. Source: Van Loan (1978),
//! Computing integrals involving the matrix exponential, IEEE Transactions on Automatic Control 23, 395–404.

use estimation::kalman::{LinearStep, congruence, identity, product, sum};
use ship::first_order::FirstOrderTransition;
use trial::noise_model::MomentKind;

use super::parameters::NoiseParameters;
use super::schedule::ReadingInterval;

/// Number of terms of the series of the matrix exponential over one scaled step.
const TERMS: usize = 16;

/// Maximum scaled step, in time constants: the series then ends below rounding. Longer steps are built by doubling.
const MAX_SCALED_STEP: f64 = 0.25;

/// Nodes and weights on (0, 1) of the Gauss–Legendre rule of eight points, exact up to degree 15.
const NODES: [(f64, f64); 8] = [
    (0.019_855_071_751_231_884, 0.050_614_268_145_188_13),
    (0.101_666_761_293_186_63, 0.111_190_517_226_687_24),
    (0.237_233_795_041_835_5, 0.156_853_322_938_943_64),
    (0.408_282_678_752_175_1, 0.181_341_891_689_181),
    (0.591_717_321_247_825, 0.181_341_891_689_181),
    (0.762_766_204_958_164_5, 0.156_853_322_938_943_64),
    (0.898_333_238_706_813_4, 0.111_190_517_226_687_24),
    (0.980_144_928_248_768_1, 0.050_614_268_145_188_13),
];

type Small = [[f64; 3]; 3];

/// Transition and process noise between two readings: the pieces of the rudder in order, and the decay of the compass
/// error over the whole time.
pub(crate) fn transition_step<const N: usize>(
    parameters: &NoiseParameters,
    interval: &ReadingInterval,
) -> LinearStep<N> {
    let mut whole = match parameters.rudder_error_sd {
        None => undisturbed(parameters, interval.duration()),
        Some(size) => {
            let piece = |&duration: &f64| with_rudder(undisturbed(parameters, duration), parameters, size, duration);
            let mut pieces = interval.pieces.iter().map(piece);
            let first = pieces.next().unwrap_or(LinearStep { transition: identity(), process_noise: [[0.0; N]; N] });
            pieces.fold(first, |before, piece| before.followed_by(&piece))
        }
    };
    if let (Some(place), Some(inverse_time)) = (parameters.compass_state(), parameters.compass_inverse_time) {
        let decay = (-inverse_time * interval.duration()).exp();
        whole.transition[place][place] = decay;
        whole.process_noise[place][place] = 1.0 - decay * decay;
    }
    whole
}

/// Step of ship and moment without rudder error: a short step F, Q, doubled by F F and Q + F Q Fᵀ up to `duration`, s.
fn undisturbed<const N: usize>(parameters: &NoiseParameters, duration: f64) -> LinearStep<N> {
    let inverse_times = parameters.inverse_T.abs() + parameters.moment_inverse_time;
    let doublings = (inverse_times * duration / MAX_SCALED_STEP).log2().ceil().max(0.0);
    let (mut f, mut q) = short(parameters, duration / doublings.exp2());
    for _ in 0..doublings as usize {
        q = sum(&q, &congruence(&f, &q));
        f = product(&f, &f);
    }
    let mut step = LinearStep { transition: identity(), process_noise: [[0.0; N]; N] };
    let states = if parameters.has_moment_state() { 3 } else { 2 };
    for i in 0..states {
        for j in 0..states {
            (step.transition[i][j], step.process_noise[i][j]) = (f[i][j], q[i][j]);
        }
    }
    step
}

/// Adds the error of the recorded rudder at both ends of a piece, between which it is linear.
fn with_rudder<const N: usize>(
    mut step: LinearStep<N>,
    parameters: &NoiseParameters,
    size: f64,
    duration: f64,
) -> LinearStep<N> {
    let Some(place) = parameters.rudder_state() else { return step };
    let FirstOrderTransition { phi1, phi2, phi3, .. } = FirstOrderTransition::new(parameters.inverse_T, duration);
    let after = [phi3 / duration, phi2 / duration];
    let before = [phi2 - after[0], phi1 - after[1]];
    let mut fresh = [0.0; N];
    for i in 0..2 {
        step.transition[i][place] = size * before[i];
        fresh[i] = size * after[i];
    }
    step.transition[place] = [0.0; N];
    fresh[place] = 1.0;
    for (row, left) in step.process_noise.iter_mut().zip(fresh) {
        for (value, right) in row.iter_mut().zip(fresh) {
            *value += left * right;
        }
    }
    step
}

/// Transition and covariance over a step that is short against T and τ. Time is counted in steps, so that the series
/// has no units: z = (ψ, r h, m h²).
fn short(parameters: &NoiseParameters, h: f64) -> (Small, Small) {
    let (x, y) = (parameters.inverse_T * h, parameters.moment_inverse_time * h);
    // Coefficients of the motion after an impulse on r, and on m: (ψ, r, m) as polynomials of time.
    let mut of_rate = [[0.0; TERMS]; 3];
    let mut of_moment = [[0.0; TERMS]; 3];
    of_rate[1][0] = 1.0;
    of_moment[2][0] = 1.0;
    for j in 1..TERMS {
        let per = 1.0 / j as f64;
        of_rate[0][j] = of_rate[1][j - 1] * per;
        of_rate[1][j] = -(x * of_rate[1][j - 1]) * per;
        of_moment[0][j] = of_moment[1][j - 1] * per;
        of_moment[1][j] = (of_moment[2][j - 1] - x * of_moment[1][j - 1]) * per;
        of_moment[2][j] = -(y * of_moment[2][j - 1]) * per;
    }
    let at = |polynomial: &[f64; TERMS], s: f64| polynomial.iter().rev().fold(0.0, |sum, &term| sum * s + term);
    let [r, m] = [&of_rate, &of_moment].map(|motion| motion.each_ref().map(|polynomial| at(polynomial, 1.0)));
    let transition = [[1.0, r[0] * h, m[0] * (h * h)], [0.0, r[1], m[1] * h], [0.0, 0.0, m[2]]];

    let (impulse, density) = match parameters.moment {
        MomentKind::None => return (transition, [[0.0; 3]; 3]),
        MomentKind::White => (&of_rate, parameters.moment_level * parameters.moment_level * h.powi(3)),
        MomentKind::Walk => (&of_moment, parameters.moment_level * parameters.moment_level * h.powi(5)),
        MomentKind::OrnsteinUhlenbeck => (
            &of_moment,
            parameters.moment_level * parameters.moment_level * parameters.moment_inverse_time * (2.0 * h.powi(5)),
        ),
    };
    let mut added = [[0.0; 3]; 3];
    for (s, weight) in NODES {
        let motion = impulse.each_ref().map(|polynomial| at(polynomial, s));
        for i in 0..3 {
            for j in 0..=i {
                added[i][j] += motion[i] * motion[j] * weight;
            }
        }
    }
    let units = [1.0, h, h * h];
    let entry = |i: usize, j: usize| added[i.max(j)][i.min(j)] * density / (units[i] * units[j]);
    (transition, std::array::from_fn(|i| std::array::from_fn(|j| entry(i, j))))
}
