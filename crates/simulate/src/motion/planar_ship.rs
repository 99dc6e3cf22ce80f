//! A yaw response with speed and drift beside it: a ship that can be steered and leaves a track.

use ship::{Dynamics, Input, Measured, Motion, Replayable, Response};

use super::planar::Planar;

/// A yaw response completed by speed and drift.
///
/// Its states are those of the response, then surge u and sway v (m/s). Effects of the response that ask for measured
/// speed or sway get √(u² + v²) and v of this ship. The planar equations see the rudder after the dead time; what
/// effects make of it besides (lag, saturation) is part of the yaw response alone.
#[derive(Debug, Clone)]
pub struct PlanarShip {
    /// How the ship turns.
    pub response: Response,
    /// How it loses speed and drifts.
    pub planar: Planar,
}

impl PlanarShip {
    /// What the yaw response sees, and the number of its states.
    fn seen(&self, state: &[f64], input: &Input) -> (usize, Input) {
        let own = self.response.dimension();
        let [u, v] = [state[own], state[own + 1]];
        let measured = Measured { speed: Some(u.hypot(v)), sway: Some(v), ..input.measured };
        (own, Input { measured, ..*input })
    }
}

impl Dynamics for PlanarShip {
    fn dimension(&self) -> usize {
        self.response.dimension() + 2
    }

    /// Straight ahead at approach speed, without drift.
    fn approach(&self, heading: f64, yaw_rate: f64, state: &mut [f64]) {
        let own = self.response.dimension();
        let (yaw, planar) = state.split_at_mut(own);
        planar.copy_from_slice(&[self.planar.approach_speed, 0.0]);
        let measured = Measured { speed: Some(planar[0]), sway: Some(0.0), ..Measured::default() };
        self.response.enter(heading, yaw_rate, &Input { measured, ..Input::default() }, yaw);
    }

    fn rates(&self, t: f64, state: &[f64], input: &Input, rate: &mut [f64]) {
        let (own, seen) = self.seen(state, input);
        self.response.rates(t, &state[..own], &seen, &mut rate[..own]);
        let [u, v] = [state[own], state[own + 1]];
        rate[own..].copy_from_slice(&self.planar.rates(u, v, state[1], input.rudder));
    }

    fn settle(&self, t: f64, state: &mut [f64], input: &Input) {
        let (own, seen) = self.seen(state, input);
        self.response.settle(t, &mut state[..own], &seen);
    }

    fn motion(&self, t: f64, state: &[f64], input: &Input) -> Motion {
        let (own, seen) = self.seen(state, input);
        let motion = self.response.motion(t, &state[..own], &seen);
        Motion { speed: seen.measured.speed, sway: seen.measured.sway, ..motion }
    }

    fn dead_time(&self) -> f64 {
        self.response.dead_time()
    }

    /// The smaller of the step of the response and a hundredth of the time the ship needs for its own length.
    fn largest_step(&self) -> f64 {
        self.response.largest_step().min(self.planar.length / self.planar.approach_speed / 100.0)
    }
}
