//! Simulated zig-zag records of a first-order ship, and changes to a record: exchange of sides, shift of clock or
//! compass, loss of rows. The records are inputs of methods; this module does not identify.

use ship::FirstOrder;
use ship::angle::from_deg;
use simulate::{Manoeuvre, Side, SimulatedShip, SimulatedTrial, Simulation, SteeringGear, StreamKey};
use trial::{Channel, Columns, Trial};

/// Beginning of a record.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Begin {
    /// At the first execute, on a straight course.
    Rest,
    /// 1.2 s after the second execute, in the middle of the trial.
    Mid,
}

/// Zig-zag of a first-order ship and its record.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Case {
    /// First-order ship.
    pub ship: FirstOrder,
    /// Rudder angle, deg.
    pub rudder_deg: f64,
    /// Heading at which the rudder is reversed, deg.
    pub heading_deg: f64,
    /// Rudder rate, deg/s; infinite for an instantaneous rudder.
    pub rate_deg_s: f64,
    /// Side of the first execute.
    pub first: Side,
    /// Beginning of the record.
    pub begin: Begin,
    /// Duration of the record, s.
    pub duration_s: f64,
    /// Time between rows, s.
    pub period_s: f64,
    /// Standard deviation of white heading noise, deg.
    pub noise_deg: f64,
}

impl Default for Case {
    /// 10/10 zig-zag of K = 0.1 1/s, T = 16.3 s at 2.5 deg/s, 271 rows at 1 s from rest, no noise.
    fn default() -> Self {
        Self {
            ship: FirstOrder::from_indices(0.1, 16.3, 0.0),
            rudder_deg: 10.0,
            heading_deg: 10.0,
            rate_deg_s: 2.5,
            first: Side::Starboard,
            begin: Begin::Rest,
            duration_s: 270.0,
            period_s: 1.0,
            noise_deg: 0.0,
        }
    }
}

impl Case {
    /// Specification of the trial.
    pub fn simulation(&self) -> Simulation {
        let mut simulation = zig_zag(
            SimulatedShip::from_first_order(self.ship),
            self.rudder_deg,
            self.heading_deg,
            from_deg(self.rate_deg_s),
            self.duration_s,
        );
        simulation.manoeuvre = simulation.manoeuvre.with_first_side(self.first);
        if self.begin == Begin::Mid {
            (simulation.recording.after_execute, simulation.recording.first_row_offset) = (Some(2), Some(1.2));
        }
        simulation.recording.sampling_period = self.period_s;
        simulation.sensors.heading_noise = from_deg(self.noise_deg);
        simulation
    }

    /// Record and truth of a replicate.
    ///
    /// # Panics
    /// If the ship never reaches its executes: a programming error of the test.
    pub fn run(&self, replicate: u64) -> SimulatedTrial {
        let key = StreamKey { seed: 1957, cell: 0, replicate };
        self.simulation().run(&key).expect("the ship of a case reaches its executes")
    }

    /// Record of a replicate.
    pub fn trial(&self, replicate: u64) -> Trial {
        self.run(replicate).trial
    }
}

/// Simulation of a zig-zag (angles in deg, `rate` in rad/s), starboard first, recorded once a second for `duration` s.
pub fn zig_zag(vessel: SimulatedShip, rudder_deg: f64, heading_deg: f64, rate: f64, duration: f64) -> Simulation {
    let (rudder, heading) = (from_deg(rudder_deg), from_deg(heading_deg));
    let manoeuvre = Manoeuvre::zig_zag(rudder, heading);
    let mut simulation = Simulation::new(vessel, manoeuvre);
    simulation.gear = SteeringGear::with_rate(rate);
    simulation.recording.duration = Some(duration);
    simulation
}

/// Record with altered columns; the map contains heading and rudder under their channels.
fn altered(trial: &Trial, alter: impl FnOnce(&mut Columns)) -> Trial {
    let mut channels: std::collections::BTreeMap<Channel, Vec<f64>> =
        trial.channels().map(|(channel, values)| (channel, values.to_vec())).collect();
    channels.insert(Channel::Rudder, trial.rudder().to_vec());
    let mut columns = Columns { time: trial.time().to_vec(), channels, unknown_columns: Vec::new() };
    alter(&mut columns);
    let made = Trial::new(trial.name(), trial.origin().clone(), columns).expect("the altered record is a record");
    let made = made.with_noise(trial.noise());
    match trial.particulars() {
        Some(particulars) => made.with_particulars(particulars),
        None => made,
    }
}

/// Record with port and starboard exchanged.
pub fn mirrored(trial: &Trial) -> Trial {
    altered(trial, |columns| {
        for channel in [Channel::Heading, Channel::Rudder, Channel::YawRate, Channel::Sway] {
            columns.channels.get_mut(&channel).into_iter().flatten().for_each(|value| *value = -*value);
        }
    })
}

/// Record with the clock set forward by `by` s.
pub fn delayed(trial: &Trial, by: f64) -> Trial {
    altered(trial, |columns| columns.time.iter_mut().for_each(|t| *t += by))
}

/// Record with the compass turned by `by` rad.
pub fn turned(trial: &Trial, by: f64) -> Trial {
    altered(trial, |columns| {
        columns.channels.get_mut(&Channel::Heading).into_iter().flatten().for_each(|psi| *psi += by);
    })
}

/// Record without the headings of rows for which `lost` is true: they are NaN.
pub fn without_headings(trial: &Trial, lost: impl Fn(usize) -> bool) -> Trial {
    altered(trial, |columns| {
        let heading = columns.channels.get_mut(&Channel::Heading).into_iter().flatten().enumerate();
        heading.filter(|(row, _)| lost(*row)).for_each(|(_, psi)| *psi = f64::NAN);
    })
}

/// Record without the rows for which `lost` is true.
pub fn without_rows(trial: &Trial, lost: impl Fn(usize) -> bool) -> Trial {
    altered(trial, |columns| {
        for column in std::iter::once(&mut columns.time).chain(columns.channels.values_mut()) {
            let mut row = 0;
            column.retain(|_| {
                row += 1;
                !lost(row - 1)
            });
        }
    })
}

/// Record of `rows` rows at 1 s with the rudder amidships and a heading that varies by less than 0.1 deg.
pub fn straight_run(rows: usize) -> Trial {
    let time: Vec<f64> = (0..rows).map(|row| row as f64).collect();
    let heading = time.iter().map(|t| 0.3 + from_deg(0.05) * (0.7 * t).sin()).collect();
    let channels = [(Channel::Heading, heading), (Channel::Rudder, vec![0.0; rows])].into();
    let origin = trial::RecordOrigin::Simulated { scenario: "straight run".into(), cell: 0, replicate: 0 };
    Trial::new("straight run", origin, Columns { time, channels, unknown_columns: Vec::new() })
        .expect("a straight run is a record")
}
