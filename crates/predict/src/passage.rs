//! One drawn ship through one manoeuvre.

use simulate::helm::Execute;
use simulate::vessel::Solver;
use simulate::{Manoeuvre, SimulateError, Simulation, SteeringGear, Vessel};

use crate::mixture::Drawn;

/// Rows per time of the ship.
const ROWS: f64 = 20.0;

/// Steps of the solver per shortest time constant: the classical Runge–Kutta step is then exact to 10⁻⁵ of the response.
const STEPS: f64 = 6.0;

/// Shortest step, s.
const SHORTEST_STEP: f64 = 1e-3;

/// Longest wait for a heading, in times of the ship: a circle of 540° with very little rudder.
const LONGEST_WAIT: f64 = 500.0;

/// What a ship did; time in s from the first execute, angles in rad.
#[derive(Debug, Clone, PartialEq)]
pub struct Passage {
    /// Time between rows, s.
    pub period: f64,
    /// Heading, 0 at the first execute.
    pub heading: Vec<f64>,
    /// Yaw rate, rad/s.
    pub yaw_rate: Vec<f64>,
    /// Rudder.
    pub rudder: Vec<f64>,
    /// Orders of the helm.
    pub executes: Vec<Execute>,
}

impl Passage {
    /// Steers a ship through a manoeuvre; `timescale` is a time of the ship, s.
    ///
    /// Fails where the ship does not reach a heading that the helm waits for, or turns for ever.
    pub fn sail(ship: &Drawn, manoeuvre: &Manoeuvre, timescale: f64) -> Result<Self, SimulateError> {
        let mut simulation = Simulation::new(Vessel::response(ship.response.clone()), manoeuvre.clone());
        simulation.gear = match manoeuvre {
            Manoeuvre::Replay(_) => SteeringGear::default(),
            _ => ship.gear,
        };
        simulation.approach.yaw_rate = ship.yaw_rate;
        simulation.disturbances = ship.disturbances;
        simulation.recording.period = (timescale / ROWS).clamp(2e-3, 900.0);
        simulation.longest_wait = LONGEST_WAIT * timescale;
        if !ship.response.model().effects().is_empty() {
            let step = (ship.response.shortest_time() / STEPS).min(simulation.recording.period);
            simulation.solver = Solver::RungeKutta(step.max(SHORTEST_STEP));
        }
        let truth = simulation.run(&ship.key)?.truth;
        let truth = std::sync::Arc::unwrap_or_clone(truth);
        Ok(Self {
            period: simulation.recording.period,
            heading: truth.heading,
            yaw_rate: truth.yaw_rate,
            rudder: truth.rudder,
            executes: truth.executes,
        })
    }

    /// Time of a row, s.
    pub fn time(&self, row: usize) -> f64 {
        row as f64 * self.period
    }

    /// First time, s, at which the heading has changed by `angle` (rad) to the side `side` (±1); straight between rows.
    pub fn reached(&self, angle: f64, side: f64) -> Option<f64> {
        let row = self.heading.iter().position(|heading| side * heading >= angle)?;
        let Some(before) = row.checked_sub(1) else { return Some(0.0) };
        let [low, high] = [before, row].map(|row| side * self.heading[row]);
        Some(self.time(before) + self.period * (angle - low) / (high - low))
    }

    /// Largest heading to the side `side` (±1), rad, between two times, s: where the yaw rate changes its sign between
    /// rows the peak of the parabola.
    pub fn peak(&self, side: f64, from: f64, until: f64) -> Option<f64> {
        let first = (from / self.period).floor() as usize;
        let last = ((until / self.period).ceil() as usize).min(self.heading.len().checked_sub(1)?);
        (first..last).find_map(|row| {
            let [now, next] = [row, row + 1].map(|row| side * self.yaw_rate[row]);
            let rising = now > 0.0 && next <= 0.0;
            rising.then(|| {
                let share = now / (now - next);
                side * self.heading[row] + 0.5 * now * share * self.period
            })
        })
    }
}
