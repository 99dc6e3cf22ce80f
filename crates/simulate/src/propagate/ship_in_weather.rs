//! Ship in the weather with a lagging gyrocompass: the terms that depend on heading are part of the right-hand side.

use ship::{Dynamics, MeasuredChannels, Motion, ShipInput};

use crate::disturbance::{Wind, gusting_speed};
use crate::weather::{Weather, WeatherCell};

/// Ship in the weather of one run, with the lag of its gyrocompass as the last state.
#[derive(Debug)]
pub(crate) struct ShipInWeather<'a, D: ?Sized> {
    ship: &'a D,
    wind: Option<Wind>,
    /// Approach speed of the ship, m/s, for equations without a speed; `None` if it is unknown.
    approach_speed: Option<f64>,
    /// Time constant of the gyrocompass, s; 0 without lag.
    gyro_lag: f64,
    /// Weather; its cell changes between steps only.
    pub weather: Weather,
}

impl<'a, D: Dynamics + ?Sized> ShipInWeather<'a, D> {
    /// Ship in the weather at the beginning of a run.
    pub fn new(ship: &'a D, wind: Option<Wind>, approach_speed: Option<f64>, gyro_lag: f64, weather: Weather) -> Self {
        Self { ship, wind, approach_speed, gyro_lag, weather }
    }

    /// Total disturbance as equivalent rudder angle, rad.
    pub fn disturbance_rudder(&self, t: f64, heading: f64) -> f64 {
        let cell: &WeatherCell = self.weather.cell();
        cell.moment(t) + self.wind.map_or(0.0, |wind| wind.yaw_moment(heading, cell.gust_factor(t)))
    }

    /// Heading of the gyrocompass, rad.
    pub fn gyro(&self, state: &[f64]) -> f64 {
        if self.gyro_lag > 0.0 { state[self.ship.dimension()] } else { state[0] }
    }

    fn acting(&self, t: f64, state: &[f64], input: &ShipInput) -> ShipInput {
        let input = ShipInput { disturbance_rudder: self.disturbance_rudder(t, state[0]), ..*input };
        match self.wind {
            Some(Wind { speed: Some(mean), .. }) => self.in_measured_wind(t, state, input, mean),
            _ => input,
        }
    }

    /// Input with the relative wind, for equations that use it.
    fn in_measured_wind(&self, t: f64, state: &[f64], input: ShipInput, mean: f64) -> ShipInput {
        let ship_speed = self.ship.motion(t, &state[..self.ship.dimension()], &input).speed;
        let (Some(wind), Some(ship_speed)) = (self.wind, ship_speed.or(self.approach_speed)) else { return input };
        let speed = gusting_speed(mean, self.weather.cell().gust_factor(t));
        let (speed, from) = wind.relative_wind(speed, ship_speed, state[0]);
        let measured = MeasuredChannels { wind_speed: Some(speed), wind_from: Some(from), ..input.measured };
        ShipInput { measured, ..input }
    }
}

impl<D: Dynamics + ?Sized> Dynamics for ShipInWeather<'_, D> {
    fn dimension(&self) -> usize {
        self.ship.dimension() + usize::from(self.gyro_lag > 0.0)
    }

    fn approach(&self, heading: f64, yaw_rate: f64, state: &mut [f64]) {
        let (ship, gyro) = state.split_at_mut(self.ship.dimension());
        self.ship.approach(heading, yaw_rate, ship);
        // In a steady turn a compass with lag τ is behind by τ r.
        gyro.fill(heading - self.gyro_lag * yaw_rate);
    }

    fn rates(&self, t: f64, state: &[f64], input: &ShipInput, rate: &mut [f64]) {
        let states = self.ship.dimension();
        self.ship.rates(t, &state[..states], &self.acting(t, state, input), &mut rate[..states]);
        if self.gyro_lag > 0.0 {
            rate[states] = (state[0] - state[states]) / self.gyro_lag;
        }
    }

    fn update_memory(&self, t: f64, state: &mut [f64], input: &ShipInput) {
        let acting = self.acting(t, state, input);
        self.ship.update_memory(t, &mut state[..self.ship.dimension()], &acting);
    }

    fn motion(&self, t: f64, state: &[f64], input: &ShipInput) -> Motion {
        self.ship.motion(t, &state[..self.ship.dimension()], &self.acting(t, state, input))
    }

    fn dead_time(&self) -> f64 {
        self.ship.dead_time()
    }

    fn largest_step(&self) -> f64 {
        largest_step(self.ship.largest_step(), self.gyro_lag)
    }
}

/// Maximum step, s, of a ship with maximum step `ship_step` s and a compass with time constant `gyro_lag` s.
pub(crate) fn largest_step(ship_step: f64, gyro_lag: f64) -> f64 {
    // A quarter of the time constant keeps the compass state stable and accurate.
    if gyro_lag > 0.0 { ship_step.min(0.25 * gyro_lag) } else { ship_step }
}
