//! A helmsman and a first-order ship for the tests: T r' + r = K (δ − δ₀), stepped row by row. It shares no code with
//! the search.

use ship::angle::from_deg;

use crate::find::{DetectedManoeuvre, LogSignals, detect_manoeuvres};
use crate::testing::Gaussian;

/// Log of a simulated ship under way, and the motion at its end.
pub struct SimulatedLog {
    /// Time between rows, s.
    pub step: f64,
    /// Speed of the rudder, rad/s.
    pub gear: f64,
    /// K, 1/s.
    pub gain: f64,
    /// T, s.
    pub lag: f64,
    /// Rudder angle that keeps the ship straight, rad.
    pub neutral: f64,
    pub time: Vec<f64>,
    pub rudder: Vec<f64>,
    pub heading: Vec<f64>,
    pub speed: Vec<f64>,
    pub propeller: Vec<f64>,
    rate: f64,
    angle: f64,
    pub course: f64,
    pub chance: Gaussian,
}

impl SimulatedLog {
    pub fn new(step: f64) -> Self {
        Self {
            step,
            gear: from_deg(2.3),
            gain: 0.1,
            lag: 16.3,
            neutral: 0.0,
            time: Vec::new(),
            rudder: Vec::new(),
            heading: Vec::new(),
            speed: Vec::new(),
            propeller: Vec::new(),
            rate: 0.0,
            angle: 0.0,
            course: 0.3,
            chance: Gaussian::new(1),
        }
    }

    /// Log of a ship with `factor` times the usual time constant, and the same product KT.
    pub fn scaled(step: f64, factor: f64) -> Self {
        let log = Self::new(step);
        Self { lag: log.lag * factor, gain: log.gain / factor, ..log }
    }

    pub fn now(&self) -> f64 {
        self.time.len() as f64 * self.step
    }

    /// Adds one row with the rudder on its way to `order`.
    pub fn row(&mut self, order: f64) {
        self.time.push(self.now());
        self.angle += (order - self.angle).clamp(-self.gear * self.step, self.gear * self.step);
        self.rudder.push(self.angle);
        self.heading.push(self.course);
        self.speed.push(8.0);
        self.propeller.push(1.5);
        let target = self.gain * (self.angle - self.neutral);
        let decay = (-self.step / self.lag).exp();
        self.course += target * self.step + (self.rate - target) * self.lag * (1.0 - decay);
        self.rate = target + (self.rate - target) * decay;
    }

    /// Holds an order for a time, s.
    pub fn hold(&mut self, order: f64, duration: f64) {
        let until = self.now() + duration - 0.5 * self.step;
        while self.now() < until {
            self.row(order);
        }
    }

    /// Keeps the present course for a time with a wandering rudder of about three degrees.
    pub fn keep(&mut self, duration: f64) {
        self.steer(self.course, duration);
    }

    /// Steers a course for a time, s: an autopilot with little noise in its order.
    pub fn steer(&mut self, course: f64, duration: f64) {
        let until = self.now() + duration - 0.5 * self.step;
        let start = self.now();
        let period = 1.3 * self.lag;
        while self.now() < until {
            let phase = std::f64::consts::TAU * (self.now() - start) / period;
            let off = course - self.course;
            let order = self.neutral + off - 2.0 * self.lag * self.rate + from_deg(3.0) * phase.sin();
            self.row(order.clamp(-from_deg(15.0), from_deg(15.0)));
        }
    }

    /// A zig-zag about the present course, angles in degrees; `executes` executes, with the last hold until the heading
    /// is back on the base course. Returns the times of the first row with the rudder on its way and of the last row
    /// with it held.
    pub fn zig_zag(&mut self, delta_deg: f64, psi_deg: f64, executes: usize) -> (f64, f64) {
        let (delta, psi, base) = (from_deg(delta_deg), from_deg(psi_deg), self.course);
        let start = self.now();
        let mut side = 1.0;
        for execute in 0..executes {
            let goal = if execute + 1 == executes { 0.0 } else { psi };
            while side * (self.course - base) < goal || self.angle != self.neutral + side * delta {
                self.row(self.neutral + side * delta);
            }
            side = -side;
        }
        (start, self.now() - self.step)
    }

    pub fn signals(&self) -> LogSignals<'_> {
        LogSignals {
            time: &self.time,
            rudder: &self.rudder,
            heading: &self.heading,
            speed: Some(&self.speed),
            propeller_rate: Some(&self.propeller),
        }
    }

    /// The manoeuvres except the straight pieces.
    pub fn detected(&self) -> Vec<DetectedManoeuvre> {
        detect_manoeuvres(&self.signals()).into_iter().filter(|manoeuvre| manoeuvre.manoeuvre.is_some()).collect()
    }

    /// Names of all detected manoeuvres.
    pub fn names(&self) -> Vec<String> {
        detect_manoeuvres(&self.signals()).iter().map(|manoeuvre| manoeuvre.name()).collect()
    }
}
