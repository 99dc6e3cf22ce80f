//! What a run may cost, known before it is made, and the limits of it: so that no specification, drawn by chance or
//! slipped from a pen, computes for ever or takes all memory. The estimate is refused in [`Simulation::validate`]; what
//! it misses stops in the run itself, with [`SimulateError::TooLong`](crate::SimulateError::TooLong).

use ship::narrow_band::NarrowBand;

use crate::error::{Checked, Expected, SpecificationError};
use crate::helm::Watches;
use crate::limits::MOST_STEPS;
use crate::manoeuvre::{Manoeuvre, PullOut, TurnEnd, ZigZagEnd, length};
use crate::propagate::{ClosedForm, exposed};
use crate::recording::{Recording, Start};
use crate::simulation::Simulation;
use crate::vessel::Solver;
use crate::wave_path;

/// What a run may take at most.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Cost {
    /// Time from the beginning of the run to its end, s. Every heading that is awaited counts with the longest wait.
    pub duration: f64,
    /// Steps: of the solver, of the weather and the sea, to the rows and to the readings of the display.
    pub steps: f64,
    /// Key and value of what lasts longest.
    longest: (&'static str, f64),
}

/// A part of a run: its key, its value, and how long it lasts at most, s.
#[derive(Debug, Clone, Copy)]
struct Part {
    key: &'static str,
    value: f64,
    duration: f64,
}

impl Part {
    fn time(key: &'static str, duration: f64) -> Self {
        Self { key, value: duration, duration }
    }
}

impl Simulation {
    /// What a run may take at most, for a specification whose values make sense one by one.
    pub fn cost(&self) -> Cost {
        let (manoeuvre, record) = (self.until_end_of_manoeuvre(), self.until_end_of_record());
        let sum = |parts: &[Part]| parts.iter().map(|part| part.duration).sum::<f64>();
        let parts: &[Part] = if sum(&manoeuvre) < sum(&record) { &manoeuvre } else { &record };
        let longest =
            parts.iter().fold(parts[0], |longest, part| if part.duration > longest.duration { *part } else { longest });
        let duration = sum(parts);
        Cost { duration, steps: duration * self.steps_per_second(), longest: (longest.key, longest.value) }
    }

    /// Refuses a run that takes too many steps, with the value that makes it so.
    pub(crate) fn check_cost(&self) -> Checked {
        let Cost { steps, longest: (key, value), .. } = self.cost();
        let most = MOST_STEPS as f64;
        if steps <= most {
            return Ok(());
        }
        Err(SpecificationError { key, value, expected: Expected::Steps { estimate: steps, most } })
    }

    /// The wait for one heading of a zig-zag; `number` of them are awaited before the `number + 1`-th execute.
    fn waits(&self, key: &'static str, number: usize) -> Part {
        let duration = number.saturating_sub(1) as f64 * (self.longest_wait + self.helmsman.reaction_time);
        match self.helmsman.reaction_time > self.longest_wait {
            true => Part { key: "helmsman.reaction-time-s", value: self.helmsman.reaction_time, duration },
            false => Part { key, value: number as f64, duration },
        }
    }

    fn until_end_of_manoeuvre(&self) -> [Part; 3] {
        let nothing = Part::time("approach.lead-in-s", 0.0);
        let [first, second] = match &self.manoeuvre {
            Manoeuvre::ZigZag(zig_zag) => match zig_zag.end {
                ZigZagEnd::Executes(count) => [self.waits("manoeuvre.zig-zag.executes", count), nothing],
                ZigZagEnd::Duration(duration) => [Part::time("manoeuvre.zig-zag.duration-s", duration), nothing],
                ZigZagEnd::Record => [Part::time("recording.duration-s", f64::INFINITY), nothing],
            },
            Manoeuvre::TurningCircle(turn) => match turn.end {
                TurnEnd::Duration(duration) => [Part::time("manoeuvre.turning-circle.duration-s", duration), nothing],
                TurnEnd::HeadingChange(_) => [Part::time("longest_wait", self.longest_wait), nothing],
            },
            Manoeuvre::PullOut(PullOut { hold, duration, .. }) => {
                [Part::time("manoeuvre.pull-out.hold-s", *hold), Part::time("manoeuvre.pull-out.duration-s", *duration)]
            }
            Manoeuvre::Williamson(turn) => [
                Part::time("longest_wait", 2.0 * (self.longest_wait + self.helmsman.reaction_time)),
                Part::time("manoeuvre.williamson.duration-s", turn.duration),
            ],
            Manoeuvre::Replay(signal) => [Part::time("manoeuvre.replay.file", length(signal)), nothing],
        };
        [Part::time("approach.lead-in-s", self.approach.lead_in), first, second]
    }

    fn until_end_of_record(&self) -> [Part; 5] {
        let Recording { start, duration, .. } = self.recording;
        let lead_in = Part::time("approach.lead-in-s", self.approach.lead_in);
        let nothing = Part { duration: 0.0, ..lead_in };
        let [lead_in, reached, offset] = match start {
            Start::Run => [nothing; 3],
            Start::Execute { number, offset } => {
                let reached = match &self.manoeuvre {
                    Manoeuvre::ZigZag(_) => self.waits("recording.after-execute", number),
                    Manoeuvre::PullOut(pull_out) => Part::time("manoeuvre.pull-out.hold-s", pull_out.hold),
                    Manoeuvre::Williamson(_) => self.waits("recording.after-execute", number),
                    Manoeuvre::TurningCircle(_) | Manoeuvre::Replay(_) => nothing,
                };
                [lead_in, reached, Part::time("recording.offset-s", offset)]
            }
        };
        let delay = self.sensors.clock.heading_delay;
        // A heading that is younger than its row is read after the last row.
        let late = Part { key: "sensor.heading-delay-s", value: delay, duration: (-delay).max(0.0) };
        [lead_in, reached, offset, Part::time("recording.duration-s", duration.unwrap_or(f64::INFINITY)), late]
    }

    fn steps_per_second(&self) -> f64 {
        let step = match (self.closed_form(), self.solver) {
            (Some(ship), _) => ClosedForm::longest_step(&ship),
            (None, Solver::RungeKutta(step)) => step,
            (None, Solver::Automatic) => exposed::largest_step(self.vessel.largest_step(), self.sensors.heading.lag),
        };
        let display = match self.helmsman.watches {
            Watches::TrueHeading => 0.0,
            Watches::Display { period } => 1.0 / period,
        };
        let weather = if self.disturbances.change() { 1.0 / self.weather_grid } else { 0.0 };
        let sea = |waves: &NarrowBand| 1.0 / wave_path::cell_width(waves);
        let seas = self.disturbances.waves.iter().chain(self.vessel.random_headings()).map(sea).sum::<f64>();
        // The rows, and the instants at which instruments are read.
        1.0 / step + 2.0 / self.recording.period + display + weather + seas
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::limits::MOST_EXECUTES;
    use crate::tests::{KEY, zig_zag};
    use crate::{SimulateError, Vessel};
    use ship::FirstOrder;

    /// What the estimate is for: the culprit, by name.
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
            s.manoeuvre = Manoeuvre::zig_zag(0.1, 0.1, ZigZagEnd::Executes(count));
            s.recording.duration = None;
        };
        assert_eq!(refused(&|s| executes(s, 1_000_000_000)), "manoeuvre.zig-zag.executes");
        assert_eq!(
            refused(&|s| executes(s, MOST_EXECUTES)),
            "manoeuvre.zig-zag.executes",
            "a hundred days of zig-zags"
        );
        assert_eq!(
            refused(&|s| s.recording.start = Start::Execute { number: 90_000, offset: 0.0 }),
            "recording.after-execute"
        );
        assert_eq!(refused(&|s| s.recording.duration = Some(2e6)), "recording.duration-s");
        assert_eq!(refused(&|s| s.approach.lead_in = 1e300), "approach.lead-in-s");
        let fast = |s: &mut Simulation| {
            s.vessel = Vessel::first_order(FirstOrder { inverse_T: 1e12, K_over_T: 1.0, rudder_bias: 0.0 });
        };
        assert_eq!(refused(&fast), "recording.duration-s");
        let tired = |s: &mut Simulation| {
            executes(s, 9);
            s.helmsman.reaction_time = 9e6;
        };
        assert_eq!(refused(&tired), "helmsman.reaction-time-s");
    }

    #[test]
    fn the_estimate_is_not_below_the_run() {
        let mut simulation = zig_zag(10.0, 10.0, 2.5, 100.0);
        simulation.sensors.clock.heading_delay = -3.0;
        simulation.recording.start = Start::Execute { number: 2, offset: 1.0 };
        let Cost { duration, steps, .. } = simulation.cost();
        assert_eq!(duration, 3600.0 + 1.0 + 100.0 + 3.0);
        // The closed form strides over a minute; every row is read twice.
        assert!((steps - duration * (1.0 / 60.0 + 2.0)).abs() < 1e-6, "{steps}");
    }
}
