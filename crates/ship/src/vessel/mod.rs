//! Hulls with three degrees of freedom (surge, sway, yaw), which serve as true ships that match no response model
//! exactly.
//!
//! A hull defines its accelerations ([`Hull`]); heading, position and the implementation of [`Dynamics`] are here.
//! [`mmg`] models hull, propeller and rudder separately, [`abkowitz`] uses one polynomial for the whole ship.
//! Parameter sets with their sources are in [`crate::ships`].
//!
//! Water is deep and at rest, propeller revolutions are constant, heel is absent. The equations are valid for a ship
//! that moves ahead; near standstill and astern they stay finite without physical meaning (see [`MIN_SPEED_SHARE`]).

pub mod abkowitz;
pub mod mmg;
pub mod prime;
pub mod prior;
pub mod scaled;

use crate::dynamics::{Dynamics, Motion, ShipInput};
use crate::particulars::Particulars;

/// Indices in the state vector of every hull.
pub mod state {
    /// Heading ψ, rad.
    pub const HEADING: usize = 0;
    /// Yaw rate r, rad/s.
    pub const YAW_RATE: usize = 1;
    /// Surge velocity u, m/s.
    pub const SURGE: usize = 2;
    /// Sway velocity v at midship, to starboard, m/s.
    pub const SWAY: usize = 3;
    /// Position of midship towards heading zero (advance of a trial begun at heading zero), m.
    pub const NORTH: usize = 4;
    /// Position of midship to starboard of heading zero (transfer), m.
    pub const EAST: usize = 5;
    /// Number of states.
    pub const DIMENSION: usize = 6;
}

/// Lower bound of the speed in prime quantities, as a share of the approach speed.
///
/// Prime velocities v/U and r L/U are undefined at U → 0, and their powers would overflow. Ships in zig-zag trials and
/// turning circles keep more than a quarter of their speed, so trials never reach this bound.
pub const MIN_SPEED_SHARE: f64 = 0.1;

/// Hull with three degrees of freedom at constant propeller revolutions.
///
/// A hull implements [`Dynamics`] with the states of [`state`]: ψ' = r, x' = u cos ψ − v sin ψ, y' = u sin ψ + v
/// cos ψ.
pub trait Hull: Send + Sync {
    /// Length, and speed of the steady straight approach.
    fn particulars(&self) -> Particulars;

    /// Accelerations (u', v', r'), m/s² and rad/s², in the rotating frame of the ship, at surge u, sway v to starboard
    /// (m/s) and yaw rate r (rad/s) at midship; finite for finite arguments.
    fn acceleration(&self, velocity: [f64; 3], input: &ShipInput) -> [f64; 3];
}

fn velocity(state: &[f64]) -> [f64; 3] {
    [state::SURGE, state::SWAY, state::YAW_RATE].map(|place| state[place])
}

impl<H: Hull> Dynamics for H {
    fn dimension(&self) -> usize {
        state::DIMENSION
    }

    /// Straight ahead at approach speed from the origin. An asymmetric hull does not stay in this state.
    fn approach(&self, heading: f64, yaw_rate: f64, state: &mut [f64]) {
        state.fill(0.0);
        state[state::HEADING] = heading;
        state[state::YAW_RATE] = yaw_rate;
        state[state::SURGE] = self.particulars().speed;
    }

    fn rates(&self, _t: f64, state: &[f64], input: &ShipInput, rate: &mut [f64]) {
        let velocity @ [surge, sway, yaw_rate] = velocity(state);
        let (sin, cos) = state[state::HEADING].sin_cos();
        rate[state::HEADING] = yaw_rate;
        [rate[state::SURGE], rate[state::SWAY], rate[state::YAW_RATE]] = self.acceleration(velocity, input);
        rate[state::NORTH] = surge * cos - sway * sin;
        rate[state::EAST] = surge * sin + sway * cos;
    }

    fn motion(&self, _t: f64, state: &[f64], input: &ShipInput) -> Motion {
        let velocity @ [surge, sway, yaw_rate] = velocity(state);
        let [.., yaw_acceleration] = self.acceleration(velocity, input);
        let heading = state[state::HEADING];
        Motion { heading, yaw_rate, yaw_acceleration, speed: Some(surge.hypot(sway)), sway: Some(sway) }
    }

    /// Hundredth of the ship-length time L/U, so that a model has as many steps as its full-scale ship.
    ///
    /// After five reversals of a 20° rudder the heading then differs by less than 0.0001° from the heading at a far
    /// smaller step; the error comes from the kinks of an MMG hull.
    fn largest_step(&self) -> f64 {
        self.particulars().ship_length_time() / 100.0
    }
}
