//! Fixtures of tests: an exact first-order zig-zag (straight pieces of rudder, closed-form response, and executes at
//! the root of the heading condition, independent of the detection under test), noise, and measured records.

use rand::SeedableRng;
use rand::rngs::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};
use ship::FirstOrder;
use ship::angle::from_deg;
use ship::first_order::{FirstOrderTransition, YawState};

use crate::{Channel, Columns, RecordOrigin, Trial};

/// Ship and its zig-zag; angles in radians, starboard first.
#[derive(Clone, Copy)]
pub(crate) struct Plant {
    pub delta: f64,
    pub psi: f64,
    /// Rudder rate, rad/s; infinite for an instantaneous rudder.
    pub rate: f64,
    /// Straight run before the first execute, s.
    pub approach: f64,
}

impl Default for Plant {
    /// 10/10 at 2.5 deg/s without an approach.
    fn default() -> Self {
        Self::new(10.0, 10.0, 2.5)
    }
}

/// Piece from `time` on: the state then, and a rudder that is linear in time.
struct Piece {
    time: f64,
    state: YawState,
    rudder: f64,
    slope: f64,
}

impl Plant {
    pub fn new(delta_deg: f64, psi_deg: f64, rate_deg_s: f64) -> Self {
        Self { delta: from_deg(delta_deg), psi: from_deg(psi_deg), rate: from_deg(rate_deg_s), approach: 0.0 }
    }

    /// Time, heading and rudder of the ship (K, T) = (0.1 1/s, 16.3 s) every `step` seconds up to `duration`.
    pub fn record(&self, duration: f64, step: f64) -> (Vec<f64>, Vec<f64>, Vec<f64>) {
        let rows = (duration / step).round() as usize;
        let time: Vec<f64> = (0..=rows).map(|k| k as f64 * step).collect();
        let (heading, rudder) = self.sampled(&time);
        (time, heading, rudder)
    }

    /// Heading and rudder at given times.
    pub fn sampled(&self, time: &[f64]) -> (Vec<f64>, Vec<f64>) {
        let pieces = self.pieces(time[time.len() - 1]);
        time.iter()
            .map(|&t| {
                // The value from the left at a jump, so that the record starts with the rudder amidships.
                let piece = &pieces[pieces.partition_point(|piece| piece.time < t).saturating_sub(1)];
                let after = t - piece.time;
                (advance(piece.state, piece.rudder, piece.slope, after).heading, piece.rudder + piece.slope * after)
            })
            .unzip()
    }

    /// Times at which the rudder starts to move, the first execute included.
    pub fn execute_times(&self, duration: f64) -> Vec<f64> {
        let moves = |piece: &&Piece| piece.slope != 0.0 || self.rate.is_infinite();
        self.pieces(duration).iter().skip(1).filter(moves).map(|piece| piece.time).collect()
    }

    fn pieces(&self, duration: f64) -> Vec<Piece> {
        let mut pieces = vec![Piece { time: 0.0, state: YawState::default(), rudder: 0.0, slope: 0.0 }];
        let (mut time, mut state, mut rudder) = (self.approach, YawState::default(), 0.0);
        let mut side = 1.0;
        while time <= duration {
            let target = side * self.delta;
            if self.rate.is_finite() {
                let ramp = (target - rudder).abs() / self.rate;
                pieces.push(Piece { time, state, rudder, slope: side * self.rate });
                state = advance(state, rudder, side * self.rate, ramp);
                time += ramp;
            }
            rudder = target;
            pieces.push(Piece { time, state, rudder, slope: 0.0 });
            // Executes of these trials come after the ramp has ended and after the peak.
            let beyond = |after: f64| side * advance(state, rudder, 0.0, after).heading - self.psi;
            let mut upper = 0.0;
            while beyond(upper) < 0.0 {
                upper += 0.5;
            }
            let mut lower = upper - 0.5;
            for _ in 0..60 {
                let middle = 0.5 * (lower + upper);
                if beyond(middle) < 0.0 { lower = middle } else { upper = middle }
            }
            state = advance(state, rudder, 0.0, upper);
            time += upper;
            side = -side;
        }
        pieces
    }
}

fn advance(state: YawState, rudder: f64, slope: f64, time: f64) -> YawState {
    let ship = FirstOrder::from_indices(0.1, 16.3, 0.0);
    FirstOrderTransition::new(ship.inverse_T, time).advance(state, ship.K_over_T * rudder, ship.K_over_T * slope)
}

/// A record from its columns.
pub(crate) fn trial(time: Vec<f64>, heading: Vec<f64>, rudder: Vec<f64>) -> Trial {
    let origin = RecordOrigin::Simulated { scenario: "first order".into(), cell: 0, replicate: 0 };
    let channels = [(Channel::Heading, heading), (Channel::Rudder, rudder)].into_iter().collect();
    Trial::new("zig-zag", origin, Columns { time, channels, unknown_columns: Vec::new() })
        .expect("columns are consistent")
}

/// Generator of standard normal deviates.
pub(crate) struct Gaussian(ChaCha8Rng);

impl Gaussian {
    pub fn new(seed: u64) -> Self {
        Self(ChaCha8Rng::seed_from_u64(seed))
    }

    pub fn draw(&mut self) -> f64 {
        StandardNormal.sample(&mut self.0)
    }
}
