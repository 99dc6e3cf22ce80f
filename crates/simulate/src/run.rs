//! One run: the loop of helm, steering gear and ship. It advances from event to event (an execute, a row, a display
//! reading), and events are never rounded to a step. Recording is controlled by the caller, so a run can advance to an
//! execute and be recorded from that execute on.

use crate::display::{DisplayReading, HeadingDisplay};
use crate::error::SimulateError;
use crate::gear::{RudderPath, SteeringGear};
use crate::helm::{Helm, HelmOrder};
use trial::manoeuvre::Trigger;

use crate::limits::{MAX_EXECUTES, MAX_STEPS};
use crate::propagate::{AwaitedHeading, Propagator, RowLimits, has_diverged};
use crate::recording::Sampler;
use crate::sample::Sample;

/// Tolerance, s, at the end of a manoeuvre, so that a row at k·period is not lost to rounding.
const END_TOLERANCE: f64 = 1e-9;

/// Event at which a run stopped.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum RunEvent {
    /// Requested time.
    Reached,
    /// Execute, which is the last in the list of executes.
    Executed,
    /// End of the manoeuvre.
    Over,
}

/// State of one run.
#[derive(Debug)]
pub(crate) struct Run<'a, P> {
    propagator: P,
    path: RudderPath,
    gear: &'a SteeringGear,
    helm: Helm<'a>,
    display: Option<HeadingDisplay>,
    base: f64,
    executes: Vec<HelmOrder>,
    longest_wait: f64,
    /// Number of steps taken.
    steps: usize,
}

/// Result of a run: rudder path, executes, and readings of the helmsman.
#[derive(Debug)]
pub(crate) struct RunResult {
    pub path: RudderPath,
    pub executes: Vec<HelmOrder>,
    pub readings: Vec<DisplayReading>,
}

impl<'a, P: Propagator> Run<'a, P> {
    /// Run at its beginning; the base course is the heading of the propagator.
    pub fn new(
        propagator: P,
        path: RudderPath,
        gear: &'a SteeringGear,
        helm: Helm<'a>,
        display: Option<HeadingDisplay>,
        longest_wait: f64,
    ) -> Self {
        let base = propagator.state().heading;
        let executes = Vec::with_capacity(16);
        Self { propagator, path, gear, helm, display, base, executes, longest_wait, steps: 0 }
    }

    /// Current time of the run, s.
    pub fn time(&self) -> f64 {
        self.propagator.time()
    }

    /// Time, s, of execute `number` (from 1), to which the run advances.
    ///
    /// Fails if the run ends before this execute.
    pub fn reach_execute(&mut self, number: usize) -> Result<f64, SimulateError> {
        while self.executes.len() < number {
            if self.advance(f64::INFINITY)? == RunEvent::Over {
                return Err(SimulateError::NoSuchExecute { execute: number, made: self.executes.len() });
            }
        }
        Ok(self.executes[number - 1].time)
    }

    /// Advances to `until` (s), to the next execute or to the end of the manoeuvre, whichever comes first.
    ///
    /// At an execute the order has been given. Fails if the motion diverges, a heading is never reached, or a limit of
    /// the run is exceeded.
    pub fn advance(&mut self, until: f64) -> Result<RunEvent, SimulateError> {
        loop {
            let end = self.helm.end() + END_TOLERANCE;
            let deadline = self.deadline();
            let trigger = self.helm.trigger();
            let mut to = until.min(end);
            let mut watch = None;
            match trigger {
                Trigger::Time(time) => to = to.min(time),
                Trigger::Deviation { side, angle } => {
                    to = to.min(deadline);
                    match &mut self.display {
                        Some(display) => {
                            display.skip_to(self.propagator.time());
                            to = to.min(display.next_time());
                        }
                        None => watch = Some(AwaitedHeading { base: self.base, side, angle }),
                    }
                }
                Trigger::Never => {}
            }
            if to == f64::INFINITY {
                return Ok(RunEvent::Over);
            }
            let crossed = self.travel(to, watch)?;
            let t = self.propagator.time();
            let noticed = match trigger {
                Trigger::Time(time) => t >= time,
                Trigger::Deviation { side, angle } => match &mut self.display {
                    Some(display) if t >= display.next_time() => {
                        display.read(self.propagator.sample(&self.path).gyro, side, angle)
                    }
                    Some(_) => false,
                    None => crossed,
                },
                Trigger::Never => false,
            };
            if noticed {
                if let Some(order) = self.helm.act(t) {
                    self.execute(t, order);
                    if self.executes.len() > MAX_EXECUTES {
                        return Err(SimulateError::TooLong { time: t, quantity: "executes", limit: MAX_EXECUTES });
                    }
                    return Ok(RunEvent::Executed);
                }
            } else if t >= until {
                return Ok(RunEvent::Reached);
            } else if t >= end {
                return Ok(RunEvent::Over);
            } else if let Trigger::Deviation { angle, .. } = trigger
                && t >= deadline
            {
                let execute = self.executes.len();
                return Err(SimulateError::NeverReached { execute, angle, waited: self.longest_wait });
            }
        }
    }

    /// Records the rows before the next possible event.
    pub fn record_rows(&mut self, rows: &mut Sampler) {
        // A display has instants of reading between rows.
        if self.display.is_some() {
            return;
        }
        let (time, watch) = match self.helm.trigger() {
            Trigger::Time(time) => (time, None),
            Trigger::Deviation { side, angle } => {
                (self.deadline(), Some(AwaitedHeading { base: self.base, side, angle }))
            }
            Trigger::Never => (f64::INFINITY, None),
        };
        let limits = RowLimits { before: time.min(self.helm.end()), watch, base: self.base };
        self.propagator.record_rows(&self.path, &limits, rows);
    }

    /// Latest time, s, at which the heading of the next execute must be reached.
    fn deadline(&self) -> f64 {
        self.executes.last().map_or(0.0, |execute| execute.time) + self.longest_wait
    }

    /// Sample at the current time.
    pub fn sample(&mut self) -> Sample {
        self.propagator.sample(&self.path)
    }

    /// Ends the run and returns its result.
    pub fn finish(self) -> RunResult {
        let readings = self.display.map(HeadingDisplay::into_log).unwrap_or_default();
        RunResult { path: self.path, executes: self.executes, readings }
    }

    fn execute(&mut self, time: f64, order: f64) {
        let state = self.propagator.state();
        self.path.order(time, order, self.gear);
        self.executes.push(HelmOrder { time, heading: state.heading, yaw_rate: state.yaw_rate, ordered_rudder: order });
    }

    /// Moves the ship to `to` (s), or to the crossing of the heading `watch` if that is earlier; `true` if the crossing
    /// is earlier.
    fn travel(&mut self, to: f64, watch: Option<AwaitedHeading>) -> Result<bool, SimulateError> {
        let (ship, path) = (&mut self.propagator, &self.path);
        loop {
            // A travel of zero length counts, too, so that the loop always ends.
            self.steps += 1;
            if self.steps > MAX_STEPS {
                return Err(SimulateError::TooLong { time: ship.time(), quantity: "steps", limit: MAX_STEPS });
            }
            if ship.time() >= to {
                return Ok(false);
            }
            let from = ship.state();
            if watch.is_some_and(|watch| watch.excess(from.heading) >= 0.0) {
                return Ok(true);
            }
            let (t, target) = (ship.time(), ship.stride(path, to));
            let h = target - t;
            let end = ship.probe(path, h);
            if has_diverged(end, self.base) {
                return Err(SimulateError::Diverged { time: target, heading: end.heading, yaw_rate: end.yaw_rate });
            }
            let Some(watch) = watch else {
                ship.commit(path, target);
                continue;
            };
            let mut probed = h;
            let event = watch.first_crossing(from, end, h, |h| {
                probed = h;
                ship.probe(path, h)
            });
            // A commit advances to the last probe.
            let stop = event.unwrap_or(h);
            if probed != stop {
                ship.probe(path, stop);
            }
            if event.is_some() {
                ship.commit(path, if stop < h { t + stop } else { target });
                return Ok(true);
            }
            ship.commit(path, target);
        }
    }
}
