//! Simulation of one manoeuvre of a drawn ship.

use std::sync::Arc;

use serde::{Deserialize, Serialize};
use ship::Particulars;
use ship::vessel::prime::MAX_PRIME_SPEED;
use simulate::motion;
use simulate::simulated_ship::Solver;
use simulate::simulation::{SimulatedTrial, Truth};
use simulate::{HelmOrder, Manoeuvre, Recording, SimulateError, SimulatedShip, Simulation, StreamKey};
use trial::{Channel, Trial};

use crate::mixture::DrawnShip;

/// Rows per timescale of the ship.
const ROWS_PER_TIMESCALE: f64 = 20.0;

/// Solver steps per minimum time constant: the classical Runge–Kutta step is then exact to 10⁻⁵ of the response.
const STEPS_PER_TIME_CONSTANT: f64 = 6.0;

/// Minimum step, s.
const MIN_STEP_S: f64 = 1e-3;

/// Maximum wait for a heading, in timescales of the ship: a circle of 540° with very little rudder.
const MAX_WAIT_TIMESCALES: f64 = 500.0;

/// Motion of a ship; time in s from the first execute, angles in rad.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct SimulatedManoeuvre {
    /// Time between rows, s.
    pub period: f64,
    /// Heading, 0 at the first execute.
    pub heading: Vec<f64>,
    /// Yaw rate, rad/s.
    pub yaw_rate: Vec<f64>,
    /// Rudder.
    pub rudder: Vec<f64>,
    /// Orders of the helm; not written to a file.
    #[serde(skip)]
    pub executes: Vec<HelmOrder>,
    /// Velocity and track; `None` for a model without speed and drift.
    #[serde(rename = "way")]
    pub planar_motion: Option<PlanarMotion>,
}

/// Speed, drift and track of a manoeuvre.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct PlanarMotion {
    /// Length of the ship, m.
    pub length: f64,
    /// Surge, and sway to starboard, m/s.
    pub velocity: Vec<[f64; 2]>,
    /// North and east, m, 0 at the first execute; north is the course of the approach. Empty for a model without drift.
    pub track: Vec<[f64; 2]>,
}

impl PlanarMotion {
    /// Velocity and track of a ship of this length, m; `None` if the record has no speed or sway.
    fn from_trial(length: f64, trial: &Trial, heading: &[f64]) -> Option<Self> {
        let (speed, sway) = (trial.channel(Channel::Speed)?, trial.channel(Channel::Sway)?);
        let surge = |(speed, sway): (&f64, &f64)| [(speed * speed - sway * sway).max(0.0).sqrt(), *sway];
        let velocity: Vec<[f64; 2]> = speed.iter().zip(sway).map(surge).collect();
        let track = motion::dead_reckoning(trial.time(), heading, &velocity);
        Some(Self { length, velocity, track })
    }
}

/// Time between rows, s, for a ship with this timescale, s.
pub(crate) fn row_interval(timescale: f64) -> f64 {
    (timescale / ROWS_PER_TIMESCALE).clamp(2e-3, 900.0)
}

/// Maximum time step of the weather, s.
const MAX_CELL_S: f64 = 60.0;

/// Maximum time step of the weather as a share of its correlation time: the moment is then within 2 % of the process.
const MAX_CORRELATION_SHARE: f64 = 0.5;

/// Ship of the simulation from a drawn ship.
fn simulated_ship(ship: &DrawnShip) -> SimulatedShip {
    match &ship.hull {
        Some(hull) => SimulatedShip::from_dynamics(Arc::new(hull.clone()))
            .with_particulars(Particulars { length: hull.length, speed: hull.speed }),
        None => SimulatedShip::from_response(ship.response.clone()),
    }
}

impl SimulatedManoeuvre {
    /// North and east, m; `None` for a model without drift.
    pub fn track(&self) -> Option<&[[f64; 2]]> {
        self.planar_motion.as_ref().map(|planar| planar.track.as_slice()).filter(|track| !track.is_empty())
    }

    /// Value of a series on the rows at a time, s, linear between rows.
    pub(crate) fn interpolated(&self, values: &[f64], time: f64) -> f64 {
        let place = (time / self.period).clamp(0.0, (values.len() - 1) as f64);
        let (low, share) = (place.floor() as usize, place.fract());
        let high = (low + 1).min(values.len() - 1);
        values[low] + share * (values[high] - values[low])
    }

    /// Distance through the water until `time` s, m; `None` for a model without speed.
    pub fn distance_sailed(&self, time: f64) -> Option<f64> {
        let velocity = &self.planar_motion.as_ref()?.velocity;
        let speed = |row: usize| velocity[row][0].hypot(velocity[row][1]);
        let rows = ((time / self.period) as usize).min(velocity.len().checked_sub(1)?);
        let whole: f64 = (0..rows).map(|row| 0.5 * self.period * (speed(row) + speed(row + 1))).sum();
        Some(whole + (time - self.time(rows)) * speed(rows))
    }

    /// Steers a ship through a manoeuvre; `timescale` is the timescale of the ship, s.
    ///
    /// Fails if the ship does not reach a heading that the helm waits for, turns without end, or exceeds the speeds for
    /// which the equations of a hull are valid.
    pub fn simulate(ship: &DrawnShip, manoeuvre: &Manoeuvre, timescale: f64) -> Result<Self, SimulateError> {
        let mut simulation = Simulation::new(simulated_ship(ship), manoeuvre.clone());
        if !matches!(manoeuvre, Manoeuvre::Replay { .. }) {
            simulation.gear = ship.gear;
        }
        simulation.approach.yaw_rate = ship.initial_yaw_rate;
        simulation.disturbances = ship.disturbances;
        // As fine as the rows, because a ship does not respond to faster changes.
        let correlation = ship.disturbances.gusts.map_or(f64::INFINITY, |gusts| gusts.correlation_time);
        simulation.weather_cell_width =
            row_interval(timescale).min(MAX_CORRELATION_SHARE * correlation).min(MAX_CELL_S);
        let shortest = match &ship.hull {
            Some(_) => Some(timescale),
            None => (!ship.response.model().effects().is_empty()).then(|| ship.response.min_time_constant()),
        };
        if let Some(shortest) = shortest {
            let step = (shortest / STEPS_PER_TIME_CONSTANT).min(row_interval(timescale));
            simulation.solver = Solver::RungeKutta(step.max(MIN_STEP_S));
        }
        let passage = Self::from_simulation(simulation, &ship.moment_key, timescale)?;
        match ship.hull.as_ref().and_then(|hull| passage.runs_away(MAX_PRIME_SPEED * hull.speed)) {
            Some(row) => Err(SimulateError::Diverged {
                time: passage.time(row),
                heading: passage.heading[row],
                yaw_rate: passage.yaw_rate[row],
            }),
            None => Ok(passage),
        }
    }

    /// First row in which the ship exceeds the speed `fastest`, m/s; `None` if it never does.
    fn runs_away(&self, fastest: f64) -> Option<usize> {
        self.planar_motion.as_ref()?.velocity.iter().position(|[surge, sway]| surge.hypot(*sway) > fastest)
    }

    /// Motion of any simulated ship; sampling period and maximum wait follow from `timescale`, the timescale of the
    /// ship, s.
    ///
    /// Fails as the simulation does.
    pub fn from_simulation(mut simulation: Simulation, key: &StreamKey, timescale: f64) -> Result<Self, SimulateError> {
        simulation.recording = Recording::every(row_interval(timescale));
        simulation.longest_wait = MAX_WAIT_TIMESCALES * timescale;
        let SimulatedTrial { trial, truth } = simulation.run(key)?;
        let Truth { heading, yaw_rate, rudder, execute_orders: executes, .. } = Arc::unwrap_or_clone(truth);
        let length = simulation.ship.particulars().map(|particulars| particulars.length);
        let planar_motion = length.and_then(|length| PlanarMotion::from_trial(length, &trial, &heading));
        Ok(Self { period: simulation.recording.sampling_period, heading, yaw_rate, rudder, executes, planar_motion })
    }

    /// Rotates the motion to another course: headings increase by `angle` (rad).
    pub fn rotate_course(&mut self, angle: f64) {
        self.heading.iter_mut().for_each(|heading| *heading += angle);
        let (sin, cos) = angle.sin_cos();
        for place in self.planar_motion.iter_mut().flat_map(|planar| &mut planar.track) {
            let [north, east] = *place;
            *place = [north * cos - east * sin, north * sin + east * cos];
        }
    }

    /// Motion up to `time` s.
    pub fn until(&self, time: f64) -> Self {
        let rows = (time / self.period).floor() as usize + 1;
        let mut cut = self.clone();
        [&mut cut.heading, &mut cut.yaw_rate, &mut cut.rudder].into_iter().for_each(|column| column.truncate(rows));
        if let Some(planar) = &mut cut.planar_motion {
            planar.velocity.truncate(rows);
            planar.track.truncate(rows);
        }
        cut
    }

    /// Maximum |yaw rate|, rad/s.
    pub fn max_yaw_rate(&self) -> f64 {
        self.yaw_rate.iter().fold(0.0, |largest, rate| largest.max(rate.abs()))
    }

    /// Time of a row, s.
    pub fn time(&self, row: usize) -> f64 {
        row as f64 * self.period
    }

    /// First time, s, at which the heading has changed by `angle` (rad) to the side `side` (±1), linear between rows;
    /// `None` if it never does.
    pub fn time_of_heading_change(&self, angle: f64, side: f64) -> Option<f64> {
        let row = self.heading.iter().position(|heading| side * heading >= angle)?;
        let Some(before) = row.checked_sub(1) else { return Some(0.0) };
        let [low, high] = [before, row].map(|row| side * self.heading[row]);
        Some(self.time(before) + self.period * (angle - low) / (high - low))
    }

    /// First maximum of the heading to the side `side` (±1), rad, between two times, s: the peak of a parabola between
    /// the rows at which the yaw rate changes sign. `None` if it does not change sign.
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
