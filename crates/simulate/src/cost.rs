//! Upper estimate of the cost of a run, so that no random or mistyped specification runs without end or exhausts the
//! memory. [`Simulation::check`] rejects a run whose estimate is too large; a run that exceeds its estimate stops
//! with [`SimulateError::TooLong`](crate::SimulateError::TooLong).

use ship::narrow_band::NarrowBandProcess;
use trial::manoeuvre::{Manoeuvre, OrderStep, Trigger};

use crate::error::{Check, Requirement, SpecificationError};
use crate::limits::MAX_STEPS;
use crate::propagate::{ClosedForm, ship_in_weather};
use crate::simulated_ship::Solver;
use crate::simulation::Simulation;
use crate::wave_path;

/// Upper estimate of the cost of a run.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RunCost {
    /// Maximum duration of the run, s; every wait for a heading counts with the maximum wait.
    pub max_duration: f64,
    /// Maximum number of steps of solver, weather and sea, rows, and display readings.
    pub max_steps: f64,
    /// Key and value of the part with the longest duration.
    longest: (&'static str, f64),
}

/// Part of a run: key, value and maximum duration, s.
#[derive(Debug, Clone, Copy)]
struct RunPart {
    key: &'static str,
    value: f64,
    duration: f64,
}

impl RunPart {
    fn time(key: &'static str, duration: f64) -> Self {
        Self { key, value: duration, duration }
    }
}

impl Simulation {
    /// Upper estimate of the cost, for a specification whose single values are valid.
    pub fn cost(&self) -> RunCost {
        let (manoeuvre, record) = (self.until_end_of_manoeuvre(), self.until_end_of_record());
        let sum = |parts: &[RunPart]| parts.iter().map(|part| part.duration).sum::<f64>();
        let parts = if sum(&manoeuvre) < sum(&record) { &manoeuvre } else { &record };
        let longest =
            parts.iter().fold(parts[0], |longest, part| if part.duration > longest.duration { *part } else { longest });
        let duration = sum(parts);
        RunCost {
            max_duration: duration,
            max_steps: duration * self.steps_per_second(),
            longest: (longest.key, longest.value),
        }
    }

    /// Check of the number of steps; fails with the key and value of the part with the longest duration.
    pub(crate) fn check_cost(&self) -> Check {
        let RunCost { max_steps: steps, longest: (key, value), .. } = self.cost();
        let most = MAX_STEPS as f64;
        if steps <= most {
            return Ok(());
        }
        Err(SpecificationError { key, value, expected: Requirement::Steps { estimate: steps, most } })
    }

    /// Lead-in and at most `count` steps of the manoeuvre, as parts; `key_of_waits` replaces the keys of waits for a
    /// heading.
    fn steps(&self, count: usize, key_of_waits: Option<&'static str>) -> Vec<RunPart> {
        let mut parts = vec![RunPart::time("approach.lead-in-s", self.approach.lead_in_time)];
        let wait = self.longest_wait + self.helmsman.reaction_time;
        let is_slow = self.helmsman.reaction_time > self.longest_wait;
        for (orders, OrderStep { trigger, key, .. }) in self.manoeuvre.order_steps().take(count).enumerate() {
            let part = match trigger {
                Trigger::Time(time) => RunPart::time(key, time),
                Trigger::Never => RunPart::time(key, f64::INFINITY),
                Trigger::Deviation { .. } if is_slow => {
                    RunPart { key: "helmsman.reaction-time-s", value: self.helmsman.reaction_time, duration: wait }
                }
                // Number of the execute that ends the wait.
                Trigger::Deviation { .. } => {
                    RunPart { key: key_of_waits.unwrap_or(key), value: (orders + 1) as f64, duration: wait }
                }
            };
            match parts.last_mut().filter(|last| last.key == part.key) {
                Some(last) => (last.value, last.duration) = (part.value.max(last.value), last.duration + part.duration),
                None => parts.push(part),
            }
        }
        parts
    }

    fn until_end_of_manoeuvre(&self) -> Vec<RunPart> {
        match self.manoeuvre {
            Manoeuvre::ZigZag { duration: Some(duration), .. } => {
                let lead_in = RunPart::time("approach.lead-in-s", self.approach.lead_in_time);
                vec![lead_in, RunPart::time("manoeuvre.zig-zag.duration-s", duration)]
            }
            Manoeuvre::ZigZag { executes: None, .. } => vec![RunPart::time("recording.duration-s", f64::INFINITY)],
            _ => self.steps(usize::MAX, None),
        }
    }

    fn until_end_of_record(&self) -> Vec<RunPart> {
        let mut parts = match self.recording.after_execute {
            None => Vec::new(),
            Some(number) => self.steps(number, Some("recording.after-execute")),
        };
        let delay = self.sensors.heading_delay;
        parts.extend([
            RunPart::time("recording.offset-s", self.recording.first_row_offset.unwrap_or(0.0)),
            RunPart::time("recording.duration-s", self.recording.duration.unwrap_or(f64::INFINITY)),
            // A heading more recent than its row is read after the last row.
            RunPart { key: "sensor.heading-delay-s", value: delay, duration: (-delay).max(0.0) },
        ]);
        parts
    }

    fn steps_per_second(&self) -> f64 {
        let dynamics = self.ship.dynamics();
        let step = match (self.closed_form(), self.solver) {
            (Some(ship), _) => ClosedForm::longest_step(&ship),
            (None, Solver::RungeKutta(step)) => step,
            (None, Solver::Automatic) => {
                ship_in_weather::largest_step(dynamics.largest_step(), self.sensors.heading_lag)
            }
        };
        let display = self.helmsman.reads_display_every.map_or(0.0, |period| 1.0 / period);
        let weather = if self.disturbances.are_time_dependent() { 1.0 / self.weather_cell_width } else { 0.0 };
        let sea = |waves: &NarrowBandProcess| 1.0 / wave_path::cell_width(waves);
        let declared = self.disturbances.waves.map(|waves| waves.process());
        let seas = declared.iter().chain(self.ship.random_headings()).map(sea).sum::<f64>();
        // Rows, and readings of the instruments.
        1.0 / step + 2.0 / self.recording.sampling_period + display + weather + seas
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::limits::MAX_EXECUTES;
    use crate::tests::{KEY, zig_zag};
    use crate::{SimulateError, SimulatedShip};
    use ship::FirstOrder;

    /// Error of a run that cannot end: it names the key that causes the cost.
    #[test]
    fn a_run_that_cannot_end_is_refused_with_what_makes_it_so() {
        let refused = |change: &dyn Fn(&mut Simulation)| {
            let mut simulation = zig_zag(10.0, 10.0, 2.5, 100.0);
            change(&mut simulation);
            match simulation.run(&KEY) {
                Err(SimulateError::Specification(SpecificationError { key, .. })) => key,
                other => panic!("expected a refusal, found {other:?}"),
            }
        };
        let executes = |s: &mut Simulation, count| {
            s.manoeuvre = Manoeuvre::zig_zag(0.1, 0.1).until_execute(count);
            s.recording.duration = None;
        };
        assert_eq!(refused(&|s| executes(s, 1_000_000_000)), "manoeuvre.zig-zag.executes");
        assert_eq!(refused(&|s| executes(s, MAX_EXECUTES)), "manoeuvre.zig-zag.executes", "a hundred days of zig-zags");
        assert_eq!(refused(&|s| s.recording.after_execute = Some(90_000)), "recording.after-execute");
        assert_eq!(refused(&|s| s.recording.duration = Some(2e6)), "recording.duration-s");
        assert_eq!(refused(&|s| s.approach.lead_in_time = 1e300), "approach.lead-in-s");
        let fast = |s: &mut Simulation| {
            s.ship = SimulatedShip::from_first_order(FirstOrder { inverse_T: 1e12, K_over_T: 1.0, rudder_bias: 0.0 });
        };
        assert_eq!(refused(&fast), "recording.duration-s");
        let slow = |s: &mut Simulation| {
            executes(s, 9);
            s.helmsman.reaction_time = 9e6;
        };
        assert_eq!(refused(&slow), "helmsman.reaction-time-s");
    }

    #[test]
    fn the_estimate_is_not_below_the_run() {
        let mut simulation = zig_zag(10.0, 10.0, 2.5, 100.0);
        simulation.sensors.heading_delay = -3.0;
        (simulation.recording.after_execute, simulation.recording.first_row_offset) = (Some(2), Some(1.0));
        let RunCost { max_duration: duration, max_steps: steps, .. } = simulation.cost();
        assert_eq!(duration, 3600.0 + 1.0 + 100.0 + 3.0);
        // The closed form has steps of a minute; every row is read twice.
        assert!((steps - duration * (1.0 / 60.0 + 2.0)).abs() < 1e-6, "{steps}");
    }
}
