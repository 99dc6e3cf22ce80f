//! Specification of a simulated trial, and its result: the record of the instruments, and the truth, which must not
//! enter an identification.

use std::sync::Arc;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use ship::FirstOrder;
use ship::first_order::YawState;
use trial::degrees::Degrees;
use trial::manoeuvre::Manoeuvre;
use trial::{DeclaredConditions, RecordOrigin, Trial};

use crate::display::HeadingDisplay;
use crate::disturbance::Disturbances;
use crate::error::{self, Check, Requirement, SimulateError, SpecificationError};
use crate::gear::{RudderPath, SteeringGear};
use crate::helm::{Helm, HelmOrder, Helmsman};
use crate::limits::MAX_ROWS;
use crate::manoeuvre::{check_manoeuvre, scenario_keys};
use crate::measure::{self, PerfectReadings, TrueRunView};
use crate::propagate::{ClosedForm, Integrated, Propagator, ShipInWeather};
use crate::recording::{Recording, RudderSource, Sampler};
use crate::run::{Run, RunEvent, RunResult};
use crate::sample::Sample;
use crate::sensor::Sensors;
use crate::simulated_ship::{SimulatedShip, Solver};
use crate::stream::StreamKey;
use crate::wave_path::SeaWaves;
use crate::weather::{DEFAULT_CELL_S, Weather};

/// Approach of the ship to the first execute.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
#[schemars(rename = "BeforeExecute")]
pub struct Approach {
    /// Heading at the beginning of the run: the base course.
    #[serde(rename = "heading-deg", with = "Degrees::<f64>")]
    pub heading: f64,
    /// Yaw rate at the beginning of the run.
    #[serde(rename = "yaw-rate-deg-s", with = "Degrees::<f64>")]
    pub yaw_rate: f64,
    // The neutral rudder angle, if the ship requires one for a straight course.
    /// Rudder angle until the first execute.
    #[serde(rename = "rudder-deg", with = "Degrees::<f64>")]
    pub rudder: f64,
    /// Straight run before the first execute.
    #[serde(rename = "lead-in-s")]
    pub lead_in_time: f64,
}

impl Approach {
    /// Check of every value; fails with the first invalid value.
    pub fn check(&self) -> Check {
        error::check_finite("approach.heading-deg", self.heading)?;
        error::check_finite("approach.yaw-rate-deg-s", self.yaw_rate)?;
        error::check_finite("approach.rudder-deg", self.rudder)?;
        error::check_time("approach.lead-in-s", self.lead_in_time)
    }
}

/// Specification of a simulated trial.
///
/// ```
/// use kempf_simulate::{Manoeuvre, SimulatedShip, Simulation, StreamKey};
/// use ship::{FirstOrder, angle::from_deg};
///
/// let ship = SimulatedShip::from_first_order(FirstOrder::from_indices(0.1, 16.3, 0.0));
/// let zig_zag = Manoeuvre::zig_zag(from_deg(20.0), from_deg(20.0));
/// let mut simulation = Simulation::new(ship, zig_zag);
/// simulation.recording.duration = Some(200.0);
/// simulation.sensors.heading_noise = from_deg(0.2);
/// // Equal keys give equal trials; another replicate gives another trial.
/// let run = |replicate| simulation.run(&StreamKey { seed: 7, cell: 0, replicate });
/// assert_eq!(run(0)?.trial.heading(), run(0)?.trial.heading());
/// assert_ne!(run(0)?.trial.heading(), run(1)?.trial.heading());
/// # Ok::<(), kempf_simulate::SimulateError>(())
/// ```
#[derive(Debug, Clone)]
pub struct Simulation {
    /// Name of the scenario, included in the origin of the record.
    pub scenario_name: String,
    /// Ship.
    pub ship: SimulatedShip,
    /// Approach to the first execute.
    pub approach: Approach,
    /// Manoeuvre.
    pub manoeuvre: Manoeuvre,
    /// Helmsman.
    pub helmsman: Helmsman,
    /// Steering gear.
    pub gear: SteeringGear,
    /// Wind and sea.
    pub disturbances: Disturbances,
    /// Instruments.
    pub sensors: Sensors,
    /// Recorded part.
    pub recording: Recording,
    /// Method of integration.
    pub solver: Solver,
    /// Cell width of the weather, s; the weather is linear within a cell. It must be short against every correlation
    /// time of the weather and every time constant of the ship.
    pub weather_cell_width: f64,
    /// Maximum wait for a heading after an execute, s; a run that exceeds it fails.
    pub longest_wait: f64,
}

/// True motion at the stamps of the rows of the record. Waves are not part of it, because they belong to the observed
/// heading and not to the response.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Truth {
    /// Time, s.
    pub time: Vec<f64>,
    /// Heading, rad.
    pub heading: Vec<f64>,
    /// Yaw rate, rad/s.
    pub yaw_rate: Vec<f64>,
    /// Yaw acceleration, rad/s².
    pub yaw_acceleration: Vec<f64>,
    /// Rudder angle, rad, before any dead time of the ship.
    pub rudder: Vec<f64>,
    /// Total disturbance as equivalent rudder angle, rad.
    pub disturbance_rudder: Vec<f64>,
    /// Speed through the water, m/s; `None` if the equations of the ship have no speed.
    pub speed: Option<Vec<f64>>,
    /// Orders from the beginning of the run to the end of the record, including orders before the first row.
    pub execute_orders: Vec<HelmOrder>,
}

/// Simulated trial: record and truth.
#[derive(Debug, Clone)]
pub struct SimulatedTrial {
    /// Record of the instruments.
    pub trial: Trial,
    /// True motion; shared between records that differ only in instrument errors.
    pub truth: Arc<Truth>,
}

/// True run without the random errors of the record.
#[derive(Debug, Clone)]
pub(crate) struct TrueRun {
    pub perfect_readings: PerfectReadings,
    pub truth: Arc<Truth>,
}

/// Default of [`Simulation::longest_wait`], s; no ship of the registry takes ten minutes for one leg of a zig-zag.
const MAX_WAIT_S: f64 = 3600.0;

/// Minimum step of the solver, s.
const MIN_STEP_S: f64 = 1e-5;

/// Maximum step of the solver, s.
const MAX_STEP_S: f64 = 60.0;

impl Simulation {
    /// Trial in a calm, with perfect helmsman, gear and instruments, recorded completely at one row a second.
    pub fn new(ship: SimulatedShip, manoeuvre: Manoeuvre) -> Self {
        Self {
            scenario_name: String::from("simulation"),
            ship,
            approach: Approach::default(),
            manoeuvre,
            helmsman: Helmsman::default(),
            gear: SteeringGear::default(),
            disturbances: Disturbances::default(),
            sensors: Sensors::default(),
            recording: Recording::default(),
            solver: Solver::default(),
            weather_cell_width: DEFAULT_CELL_S,
            longest_wait: MAX_WAIT_S,
        }
    }

    /// Check of the complete specification; fails with the first value that is invalid or does not fit the manoeuvre.
    pub fn check(&self) -> Check {
        check_manoeuvre(&self.manoeuvre)?;
        self.helmsman.check()?;
        self.gear.check()?;
        self.disturbances.check()?;
        self.sensors.check()?;
        self.recording.check()?;
        self.approach.check()?;
        error::check_positive_time("longest_wait", self.longest_wait)?;
        error::check_between("weather_cell_width", self.weather_cell_width, MIN_STEP_S, MAX_STEP_S)?;
        if let Solver::RungeKutta(step) = self.solver {
            error::check_between("solver.step", step, MIN_STEP_S, MAX_STEP_S)?;
        }
        error::check_at_most("approach.rudder-deg", self.approach.rudder.abs(), self.gear.largest_rudder())?;
        let is_replay = matches!(self.manoeuvre, Manoeuvre::Replay { .. });
        if !is_replay {
            error::check_at_most(
                scenario_keys(&self.manoeuvre)[0],
                self.manoeuvre.max_rudder(),
                self.gear.largest_rudder(),
            )?;
        }
        // A negative dead time belongs to a record with a late clock, not to a ship.
        error::check_time("vessel.dead_time", self.ship.dynamics().dead_time())?;
        let end = self.approach.lead_in_time + self.manoeuvre.duration();
        match (&self.manoeuvre, self.recording.duration) {
            (_, None) if end.is_finite() => {
                error::check_at_most(scenario_keys(&self.manoeuvre)[1], end, self.recording.max_duration())?;
            }
            (_, Some(duration)) => {
                error::check_at_most("recording.duration-s", duration, self.recording.max_duration())?
            }
            (Manoeuvre::ZigZag { executes: None, .. }, None) => {
                error::refuse("recording.duration-s", Requirement::Duration)?;
            }
            _ => {}
        }
        self.check_cost()?;
        let most = self.manoeuvre.max_executes();
        if let Some(number) = self.recording.after_execute.filter(|number| *number > most) {
            let value = number as f64;
            return Err(SpecificationError {
                key: "recording.after-execute",
                value,
                expected: Requirement::Execute(most),
            });
        }
        if is_replay && self.recording.rudder == RudderSource::Orders {
            return error::refuse(
                "recording.rudder",
                Requirement::OtherValue([
                    "`recording.rudder` is \"orders\", but a replayed rudder has no orders",
                    "expected \"feedback\"",
                    "leave the key out",
                ]),
            );
        }
        Ok(())
    }

    /// Simulated trial of `key`: record and truth.
    ///
    /// Fails if the specification is invalid or too costly, the motion diverges, a heading is never reached, the record
    /// starts at an execute that is never made, the run does not end, or its rows are too few for a [`Trial`].
    pub fn run(&self, key: &StreamKey) -> Result<SimulatedTrial, SimulateError> {
        self.check()?;
        self.record(&self.true_run(key)?, key)
    }

    /// `true` if no random input acts on ship, helmsman or the instants of the rows.
    pub(crate) fn is_repeatable(&self) -> bool {
        let Disturbances { wind, gusts, moment_random_walk: random_walk, waves, .. } = &self.disturbances;
        let weather = gusts.is_some() || *random_walk > 0.0 || wind.is_some_and(|wind| wind.gusting.is_some());
        let seas = waves.is_some() || !self.ship.random_headings().is_empty();
        let compass = self.sensors.heading_noise > 0.0 || self.sensors.heading_wander.is_some();
        let display = self.helmsman.reads_display_every.is_some() && (compass || seas);
        !weather && !display && self.sensors.sampling_jitter == 0.0
    }

    /// True run from the beginning to the end of the record. Fails for the reasons of [`run`](Self::run), except an
    /// invalid specification.
    pub(crate) fn true_run(&self, key: &StreamKey) -> Result<TrueRun, SimulateError> {
        let approach = YawState { heading: self.approach.heading, yaw_rate: self.approach.yaw_rate };
        let weather = || Weather::new(&self.disturbances, self.weather_cell_width, key);
        match self.closed_form() {
            Some(ship) => {
                self.drive(key, || ClosedForm::new(ship, weather(), approach, self.recording.sampling_period))
            }
            None => {
                let step = match self.solver {
                    Solver::Automatic => None,
                    Solver::RungeKutta(step) => Some(step),
                };
                let (ship, wind, lag) = (self.ship.dynamics(), self.disturbances.wind, self.sensors.heading_lag);
                let speed = self.ship.particulars().map(|particulars| particulars.speed);
                let ship_in_weather = || ShipInWeather::new(ship, wind, speed, lag, weather());
                self.drive(key, || Integrated::new(ship_in_weather(), approach, step))
            }
        }
    }

    /// First-order ship whose whole run has a closed form; `None` if the run must be integrated.
    pub(crate) fn closed_form(&self) -> Option<FirstOrder> {
        let rudder_is_linear = self.gear.lag == 0.0 || matches!(self.manoeuvre, Manoeuvre::Replay { .. });
        let moment_is_linear = self.disturbances.wind.is_none_or(|wind| wind.moment == 0.0);
        let exact = rudder_is_linear && moment_is_linear && self.sensors.heading_lag == 0.0;
        self.ship.closed_form().filter(|_| exact && self.solver == Solver::Automatic)
    }

    fn begin<P: Propagator>(&self, key: &StreamKey, propagator: P) -> Run<'_, P> {
        let Approach { heading, rudder, lead_in_time: lead_in, .. } = self.approach;
        let path = match &self.manoeuvre {
            Manoeuvre::Replay { rudder: Some(signal), .. } => RudderPath::from_signal(rudder, lead_in, signal),
            _ => RudderPath::constant(rudder),
        };
        let helm = Helm::new(&self.manoeuvre, &self.helmsman, lead_in);
        let display = self.helmsman.reads_display_every.map(|period| {
            let waves = SeaWaves::new(&self.disturbances, &self.ship, key);
            HeadingDisplay::new(period, self.sensors, waves, key, heading)
        });
        Run::new(propagator, path, &self.gear, helm, display, self.longest_wait)
    }

    fn drive<P: Propagator>(&self, key: &StreamKey, propagator: impl Fn() -> P) -> Result<TrueRun, SimulateError> {
        let mut run = self.begin(key, propagator());
        let start = match self.recording.after_execute {
            None => 0.0,
            Some(number) => run.reach_execute(number)? + self.recording.first_row_offset.unwrap_or(0.0),
        };
        let mut rows = Sampler::at_row_times(start, &self.recording);
        let mut instruments = Sampler::at_instrument_times(start, &self.recording, &self.sensors, key);
        if instruments.as_ref().is_some_and(|sampler| sampler.next_time() < run.time()) {
            // The first row has a heading from before its execute, whose time is now known: the run is repeated.
            run = self.begin(key, propagator());
        }
        loop {
            if instruments.is_none() {
                run.record_rows(&mut rows);
            }
            let next = instruments.iter().map(Sampler::next_time).fold(rows.next_time(), f64::min);
            if next == f64::INFINITY {
                break;
            }
            match run.advance(next)? {
                RunEvent::Executed => {}
                RunEvent::Over => break,
                RunEvent::Reached => {
                    let sample = run.sample();
                    rows.take(&sample);
                    if let Some(sampler) = &mut instruments {
                        sampler.take(&sample);
                    }
                }
            }
        }
        if rows.samples.len() > MAX_ROWS {
            return Err(SimulateError::TooLong { time: run.time(), quantity: "rows", limit: MAX_ROWS });
        }
        Ok(self.look_back(rows, instruments, &run.finish()))
    }

    /// Rudder path reconstructed from the orders; `None` if the rudder feedback is recorded.
    fn assumed_path(&self, executes: &[HelmOrder]) -> Option<RudderPath> {
        let rate = self.recording.assumed_rudder_rate.filter(|_| self.recording.rudder == RudderSource::Orders)?;
        let gear = SteeringGear::with_rate(rate);
        let mut path = RudderPath::constant(self.approach.rudder);
        executes.iter().for_each(|execute| path.order(execute.time, execute.ordered_rudder, &gear));
        Some(path)
    }

    /// True run with its samples, after the end of the run.
    fn look_back(&self, mut rows: Sampler, mut instruments: Option<Sampler>, run: &RunResult) -> TrueRun {
        if let Some(sampler) = &mut instruments {
            // Truncated to the shorter: with a delay, the two end at different rows.
            let count = rows.samples.len().min(sampler.samples.len());
            rows.samples.truncate(count);
            sampler.samples.truncate(count);
        }
        let truth = truth(&rows.samples, run);
        let assumed = self.assumed_path(&run.executes);
        let view = TrueRunView {
            samples: instruments.as_ref().map_or(&rows.samples, |sampler| &sampler.samples),
            jitter: instruments.as_ref().map_or(&[], |sampler| &sampler.jitter),
            run,
            assumed: assumed.as_ref(),
            approach_order: (!matches!(self.manoeuvre, Manoeuvre::Replay { .. })).then_some(self.approach.rudder),
            wind: self.disturbances.wind,
            particulars: self.ship.particulars(),
        };
        TrueRun { perfect_readings: PerfectReadings::new(truth.time.clone(), &view), truth: Arc::new(truth) }
    }

    /// Record of a run with the random errors of `key`.
    pub(crate) fn record(&self, true_run: &TrueRun, key: &StreamKey) -> Result<SimulatedTrial, SimulateError> {
        let waves = SeaWaves::new(&self.disturbances, &self.ship, key);
        let written = measure::with_sensor_errors(&self.sensors, &true_run.perfect_readings, waves, key);
        let truth = match &written.kept {
            None => Arc::clone(&true_run.truth),
            Some(kept) => Arc::new(true_run.truth.keep(kept)),
        };
        let (name, origin) = self.name_and_origin(key);
        Ok(SimulatedTrial { trial: self.with_declarations(Trial::new(name, origin, written.columns)?), truth })
    }

    /// Name and origin of the record of `key`.
    pub(crate) fn name_and_origin(&self, StreamKey { cell, replicate, .. }: &StreamKey) -> (String, RecordOrigin) {
        let (cell, replicate) = (*cell, *replicate);
        let origin = RecordOrigin::Simulated { scenario: self.scenario_name.clone(), cell, replicate };
        (format!("{}-{cell}-{replicate}", self.scenario_name), origin)
    }

    /// Record with the declared noise, weather and particulars.
    pub(crate) fn with_declarations(&self, trial: Trial) -> Trial {
        let conditions = DeclaredConditions { weather: self.recording.weather, ..DeclaredConditions::default() };
        let trial = trial.with_noise(self.sensors.declared_noise()).with_conditions(conditions);
        match self.ship.particulars() {
            Some(particulars) => trial.with_particulars(particulars),
            None => trial,
        }
    }
}

impl Truth {
    /// Truth of the kept rows.
    fn keep(&self, kept: &[bool]) -> Self {
        let mut kept_rows = self.clone();
        let Self {
            time,
            heading,
            yaw_rate,
            yaw_acceleration,
            rudder,
            disturbance_rudder: disturbance,
            speed,
            execute_orders: _,
        } = &mut kept_rows;
        let columns = [time, heading, yaw_rate, yaw_acceleration, rudder, disturbance];
        columns.into_iter().chain(speed).for_each(|column| measure::retain_flagged(column, kept));
        kept_rows
    }
}

fn truth(samples: &[Sample], run: &RunResult) -> Truth {
    let column = |value: fn(&Sample) -> f64| samples.iter().map(value).collect();
    Truth {
        time: column(|sample| sample.time),
        heading: column(|sample| sample.motion.heading),
        yaw_rate: column(|sample| sample.motion.yaw_rate),
        yaw_acceleration: column(|sample| sample.motion.yaw_acceleration),
        rudder: run.path.angles_at(samples.iter().map(|sample| sample.time)),
        disturbance_rudder: column(|sample| sample.disturbance_rudder),
        speed: samples.iter().map(|sample| sample.motion.speed).collect(),
        execute_orders: run.executes.clone(),
    }
}
