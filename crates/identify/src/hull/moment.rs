//! Error of the form of a hull, as a random yaw moment that reproduces the residual of the fit.

use estimation::number::Dual;
use rand::rngs::ChaCha8Rng;
use rand::{RngExt, SeedableRng};
use rand_distr::StandardNormal;
use ship::vessel::prime::PrimeHull;

use super::objective::{Misfit, window_mean_square};
use super::replayed::replay_rows;
use super::track::HullSignals;

/// Correlation time, in L/U₀: the error of a form changes with the manoeuvre and not with a gust.
const CORRELATION_TIME_LENGTHS: f64 = 2.0;

/// Standard deviation of the first simulated moments, as a rudder angle, rad.
const FIRST_DEVIATION_RAD: f64 = 5e-3;

/// Number of rescalings of the simulated moments: the departure of a hull is nearly linear in them.
const SCALINGS: usize = 2;

/// Number of moments simulated per record.
const DRAWS: u64 = 6;

/// Seed of the first draw.
const SEED: u64 = 2_210_105;

/// Random yaw moment that a hull form leaves unexplained: an Ornstein–Uhlenbeck process.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MisfitMoment {
    /// Standard deviation as the rudder angle of equal moment at approach speed, rad.
    pub sd_rudder: f64,
    /// Time in which its autocorrelation falls to 1/e, s.
    pub correlation_time: f64,
}

impl MisfitMoment {
    /// Random moment, in units of L and U₀, under which the hull departs from its undisturbed replay in windows of 3.5
    /// L/U₀ by the residuals of the records, `misfits`. The deviation is zero if a simulated departure is zero or not
    /// finite.
    pub(super) fn from_misfits(hull: &PrimeHull, hull_signals: &[HullSignals], misfits: &[Misfit]) -> Self {
        let hull = hull.to_real::<Dual<1>>();
        let mean = |squares: &mut dyn Iterator<Item = f64>| squares.sum::<f64>() / hull_signals.len() as f64;
        let target = mean(&mut misfits.iter().map(|misfit| misfit.window_heading));
        let mut deviation = FIRST_DEVIATION_RAD;
        for _ in 0..SCALINGS {
            let of_record =
                |signals| (0..DRAWS).map(|draw| departure(&hull, signals, deviation, SEED + draw)).sum::<f64>();
            let simulated = mean(&mut hull_signals.iter().map(of_record)) / DRAWS as f64;
            if !(simulated > 0.0 && simulated.is_finite()) {
                return Self { sd_rudder: 0.0, correlation_time: CORRELATION_TIME_LENGTHS };
            }
            deviation *= (target / simulated).sqrt();
        }
        Self { sd_rudder: deviation, correlation_time: CORRELATION_TIME_LENGTHS }
    }
}

/// Mean square heading error (rad²) in windows of a replay under a random moment, computed as for a record.
fn departure(hull: &PrimeHull<Dual<1>>, signals: &HullSignals, deviation: f64, seed: u64) -> f64 {
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    let mut disturbed = signals.clone();
    let mut moment = deviation * random.sample::<f64, _>(StandardNormal);
    for (row, value) in disturbed.moment.iter_mut().enumerate() {
        if row > 0 {
            let kept = (-(signals.time[row] - signals.time[row - 1]) / CORRELATION_TIME_LENGTHS).exp();
            moment = kept * moment + (1.0 - kept * kept).sqrt() * deviation * random.sample::<f64, _>(StandardNormal);
        }
        *value = moment;
    }
    let start = [signals.initial_velocity[0], signals.initial_velocity[1], 0.0].map(Dual::from);
    let rows = replay_rows(hull, &disturbed, signals.whole_record, start).rows;
    let heading = rows.iter().zip(&signals.heading);
    let heading = heading.map(|(row, read)| if read.is_finite() { row[0].value } else { f64::NAN }).collect();
    let mut rates = vec![0.0; signals.window_bounds.len() - 1];
    window_mean_square(hull, &HullSignals { heading, ..signals.clone() }, &mut rates, false)
}
