//! Yaw response with speed and drift: a ship that can be simulated and has a track.

use ship::{Dynamics, MeasuredChannels, Motion, Replayable, Response, ShipInput};

use super::planar::PlanarModel;

/// Yaw response completed by surge and sway.
///
/// The states are the states of the response, then surge u and sway v (m/s). Effects of the response that use measured
/// speed or sway receive √(u² + v²) and v of this ship. The planar equations use the rudder after the dead time; other
/// effects on the rudder (lag, saturation) belong to the yaw response alone.
#[derive(Debug, Clone)]
pub struct PlanarShip {
    /// Yaw response.
    pub response: Response,
    /// Equations of surge and sway.
    pub planar: PlanarModel,
}

impl PlanarShip {
    /// Number of states of the yaw response, and its input.
    fn yaw_input(&self, state: &[f64], input: &ShipInput) -> (usize, ShipInput) {
        let yaw_states = self.response.dimension();
        let [u, v] = [state[yaw_states], state[yaw_states + 1]];
        let measured = MeasuredChannels { speed: Some(u.hypot(v)), sway: Some(v), ..input.measured };
        (yaw_states, ShipInput { measured, ..*input })
    }
}

impl Dynamics for PlanarShip {
    fn dimension(&self) -> usize {
        self.response.dimension() + 2
    }

    /// Straight ahead at approach speed, without drift.
    fn approach(&self, heading: f64, yaw_rate: f64, state: &mut [f64]) {
        let yaw_states = self.response.dimension();
        let (yaw, planar) = state.split_at_mut(yaw_states);
        planar.copy_from_slice(&[self.planar.approach_speed, 0.0]);
        let measured = MeasuredChannels { speed: Some(planar[0]), sway: Some(0.0), ..MeasuredChannels::default() };
        self.response.initialise(heading, yaw_rate, &ShipInput { measured, ..ShipInput::default() }, yaw);
    }

    fn rates(&self, t: f64, state: &[f64], input: &ShipInput, rate: &mut [f64]) {
        let (yaw_states, seen) = self.yaw_input(state, input);
        self.response.rates(t, &state[..yaw_states], &seen, &mut rate[..yaw_states]);
        let [u, v] = [state[yaw_states], state[yaw_states + 1]];
        rate[yaw_states..].copy_from_slice(&self.planar.rates(u, v, state[1], input.rudder));
    }

    fn update_memory(&self, t: f64, state: &mut [f64], input: &ShipInput) {
        let (yaw_states, seen) = self.yaw_input(state, input);
        self.response.update_memory(t, &mut state[..yaw_states], &seen);
    }

    fn motion(&self, t: f64, state: &[f64], input: &ShipInput) -> Motion {
        let (yaw_states, seen) = self.yaw_input(state, input);
        let motion = self.response.motion(t, &state[..yaw_states], &seen);
        Motion { speed: seen.measured.speed, sway: seen.measured.sway, ..motion }
    }

    fn dead_time(&self) -> f64 {
        self.response.dead_time()
    }

    /// Minimum of the maximum step of the response and a hundredth of the ship-length time L/U.
    fn largest_step(&self) -> f64 {
        self.response.largest_step().min(self.planar.length / self.planar.approach_speed / 100.0)
    }
}
