//! Simulated records with known truth, for tests of this crate: an alternating rudder replayed through a response, plus
//! white heading noise.

use std::sync::Arc;

use rand::{SeedableRng, rngs::ChaCha8Rng};
use rand_distr::{Distribution, Normal, StandardNormal};
use ship::angle::from_deg;
use ship::dynamics::Dynamics;
use ship::effects::Effect;
use ship::replay::{RecordedSignals, replay};
use ship::{Polyline, Response, ResponseModel};
use trial::{Channel, Columns, RecordOrigin, Trial};

/// 1/T (1/s), K/T (1/s²) and δ_r (rad) of a ship with K = 0.1 1/s, T = 16.3 s and δ_r = 0.5 deg.
pub const BASE: [f64; 3] = [1.0 / 16.3, 0.1 / 16.3, 0.00873];

/// Base response with effects.
pub fn ship(effects: Vec<(Arc<dyn Effect>, Vec<f64>)>) -> Response {
    let parameters = BASE.iter().copied().chain(effects.iter().flat_map(|(_, values)| values.clone())).collect();
    ResponseModel::new(effects.into_iter().map(|(effect, _)| effect).collect()).with_parameters(parameters)
}

/// Plan of a simulated record.
#[derive(Debug, Clone, Copy)]
pub struct TrialPlan {
    /// Number of rows.
    pub rows: usize,
    /// Time between rows, s.
    pub period: f64,
    /// Rudder angle, deg.
    pub rudder_deg: f64,
    /// Standard deviation of the heading noise, deg.
    pub noise_deg: f64,
    /// Number of rows per heading.
    pub every: usize,
    /// Seed of the noise.
    pub seed: u64,
}

impl Default for TrialPlan {
    fn default() -> Self {
        Self { rows: 301, period: 1.0, rudder_deg: 10.0, noise_deg: 0.05, every: 1, seed: 1 }
    }
}

/// Times of the executes, s; uneven, for an aperiodic record.
const ORDERS: [f64; 9] = [4.0, 22.0, 60.0, 101.0, 139.0, 184.0, 220.0, 261.0, 300.0];

/// Period after which the executes repeat, s.
const LAP: f64 = 336.0;

/// Simulates a record of a ship.
pub fn record(ship: &Response, plan: TrialPlan) -> Trial {
    let time: Vec<f64> = (0..plan.rows).map(|row| row as f64 * plan.period).collect();
    let (mut corners, mut angles, mut angle) = (vec![-1.0], vec![0.0], 0.0);
    let travel = plan.rudder_deg / 2.5;
    for (number, order) in (0..).flat_map(|lap| ORDERS.map(|order| order + f64::from(lap) * LAP)).enumerate() {
        if order > time[plan.rows - 1] {
            break;
        }
        let next = if number % 2 == 0 { plan.rudder_deg } else { -plan.rudder_deg };
        let end = order + travel * (next - angle).abs() / plan.rudder_deg;
        corners.extend([order, end]);
        angles.extend([angle, next].map(from_deg));
        angle = next;
    }
    let signal = Polyline::new(corners, angles).expect("orders are further apart than the rudder travels");
    let mut state = vec![0.0; ship.dimension()];
    ship.approach(0.0, 0.0, &mut state);
    let noise = Normal::new(0.0, from_deg(plan.noise_deg)).expect("a standard deviation");
    let mut generator = ChaCha8Rng::seed_from_u64(plan.seed);
    let mut heading = vec![f64::NAN; plan.rows];
    replay(ship, &RecordedSignals::from_rudder(&signal), &time, 0.05, &mut state, |row, motion| {
        if row % plan.every == 0 {
            heading[row] = motion.heading + noise.sample(&mut generator);
        }
    });
    let rudder = time.iter().map(|&t| signal.value_at(t)).collect();
    of_columns(time, heading, rudder)
}

/// Record of these columns, s and rad.
pub fn of_columns(time: Vec<f64>, heading: Vec<f64>, rudder: Vec<f64>) -> Trial {
    let channels = [(Channel::Heading, heading), (Channel::Rudder, rudder)].into();
    let origin = RecordOrigin::Simulated { scenario: "made up".into(), cell: 0, replicate: 0 };
    Trial::new("made up", origin, Columns { time, channels, unknown_columns: Vec::new() }).expect("a valid record")
}

/// Record with rows one second apart, its heading plus the response of the base to a moment (rad of rudder) over time
/// (s).
pub fn moved(trial: &Trial, moment: impl Fn(f64) -> f64) -> Trial {
    let [mut heading, mut rate, h] = [0.0, 0.0, 0.02];
    let mut measured = trial.heading().to_vec();
    for (row, value) in measured.iter_mut().enumerate() {
        for step in 0..if row > 0 { 50 } else { 0 } {
            rate += h * (BASE[1] * moment(trial.time()[row - 1] + h * f64::from(step)) - BASE[0] * rate);
            heading += h * rate;
        }
        *value += heading;
    }
    of_columns(trial.time().to_vec(), measured, trial.rudder().to_vec())
}

/// Record of the base under a random-walk moment: `level` (deg) is the heading standard deviation of a ship without
/// damping after 300 s.
pub fn wandering(level: f64, seed: u64) -> Trial {
    let calm = record(&ship(Vec::new()), TrialPlan { seed, ..TrialPlan::default() });
    let mut generator = ChaCha8Rng::seed_from_u64(seed + 1_000_000);
    let mut draw = || -> f64 { StandardNormal.sample(&mut generator) };
    let h = 0.02;
    let step = level.to_radians() * (20.0 / 300f64.powi(5) * h).sqrt();
    let [mut heading, mut rate, mut moment] = [0.0; 3];
    let mut measured = calm.heading().to_vec();
    for (row, value) in measured.iter_mut().enumerate() {
        for _ in 0..if row > 0 { 50 } else { 0 } {
            moment += step * draw();
            rate += h * (moment - BASE[0] * rate);
            heading += h * rate;
        }
        *value += heading;
    }
    of_columns(calm.time().to_vec(), measured, calm.rudder().to_vec())
}

/// Rudder strokes of 2.5 deg/s between ±10 deg that begin between rows: times (s) and angles (rad).
pub fn strokes(rows: usize) -> (Vec<f64>, Vec<f64>) {
    let time: Vec<f64> = (0..rows).map(|row| row as f64).collect();
    let angle = |t: &f64| {
        let laps = (t + 3.37) / 43.7;
        let (lap, sign) = (43.7 * laps.fract(), if (laps as usize).is_multiple_of(2) { 1.0 } else { -1.0 });
        from_deg(sign * (2.5 * lap - 10.0).min(10.0))
    };
    (time.clone(), time.iter().map(angle).collect())
}

/// Angles (rad) plus white noise of a standard deviation in degrees.
pub fn noisy(angle: &[f64], sd_deg: f64) -> Vec<f64> {
    let mut generator = ChaCha8Rng::seed_from_u64(7);
    let noise = Normal::new(0.0, from_deg(sd_deg)).expect("a standard deviation");
    angle.iter().map(|angle| angle + noise.sample(&mut generator)).collect()
}
