//! All settings of a trial together: their keys, what they have to be, and what is taken for granted where they are
//! left out.

use crate::helm::Watches;
use crate::manoeuvre::{Manoeuvre, ZigZag, ZigZagEnd};
use crate::recording::{RudderColumn, Start};
use crate::sensor::HeadingSensor;
use crate::settings::refusal::SettingError;
use crate::settings::steering::GearSettings;
use crate::simulation::Simulation;

/// The simulation, if its settings go together.
///
/// Fails with the first value that makes no sense, or that does not go with the manoeuvre.
pub fn checked(simulation: Simulation) -> Result<Simulation, SettingError> {
    simulation.validate()?;
    start_is_reached(&simulation)?;
    match (&simulation.manoeuvre, simulation.recording.rudder) {
        (Manoeuvre::Replay(_), RudderColumn::Orders { .. }) => Err(SettingError::value(
            "recording.rudder",
            "`recording.rudder` is \"orders\", and a replayed rudder follows none",
            "expected \"feedback\"",
            "leave the key out",
        )),
        _ => Ok(simulation),
    }
}

/// Whether the execute after which the record starts can be made at all.
fn start_is_reached(simulation: &Simulation) -> Result<(), SettingError> {
    let Start::Execute { number, .. } = simulation.recording.start else { return Ok(()) };
    let made = match &simulation.manoeuvre {
        Manoeuvre::ZigZag(ZigZag { end: ZigZagEnd::Executes(executes), .. }) => *executes,
        Manoeuvre::ZigZag(_) => usize::MAX,
        Manoeuvre::PullOut(_) => 2,
        Manoeuvre::Williamson(_) => 3,
        Manoeuvre::TurningCircle(_) | Manoeuvre::Replay(_) => 1,
    };
    if number <= made {
        return Ok(());
    }
    Err(SettingError::value(
        "recording.after-execute",
        format!("`recording.after-execute` is {number}, and the manoeuvre ends after execute {made}"),
        format!("expected at most {made}"),
        "start the record earlier, or leave the key out to record from the start",
    ))
}

/// What is taken for granted in a trial because a setting was left out, and can decide what a study finds.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Assumption {
    /// The rudder is where it is ordered to be at once.
    InstantRudder,
    /// Every order is given exactly at the heading it waits for.
    PerfectHelmsman,
    /// The heading in the record is the true one.
    PerfectCompass,
}

impl Assumption {
    /// All of them, the one that does most harm first.
    pub const ALL: [Self; 3] = [Self::InstantRudder, Self::PerfectHelmsman, Self::PerfectCompass];

    /// Whether a simulation with the gear of these settings makes it. A rate that is given as infinite is meant.
    pub fn holds(self, gear: &GearSettings, simulation: &Simulation) -> bool {
        let Simulation { manoeuvre, helmsman, sensors, .. } = simulation;
        match self {
            Self::InstantRudder => {
                let instant = simulation.gear.rate.is_infinite() && simulation.gear.lag == 0.0;
                instant && gear.rate_deg_s.is_none() && !matches!(manoeuvre, Manoeuvre::Replay(_))
            }
            Self::PerfectHelmsman => {
                let perfect = helmsman.watches == Watches::TrueHeading && helmsman.reaction_time == 0.0;
                perfect && matches!(manoeuvre, Manoeuvre::ZigZag(_))
            }
            Self::PerfectCompass => {
                let HeadingSensor { noise, quantum, wander, spikes, .. } = sensors.heading;
                let never_off = wander.is_none_or(|wander| wander.sd == 0.0)
                    && spikes.is_none_or(|spikes| spikes.probability == 0.0);
                noise == 0.0 && quantum == 0.0 && never_off
            }
        }
    }

    /// What it is, why, and what to do.
    pub fn sentence(self) -> &'static str {
        match self {
            Self::InstantRudder => {
                "the rudder moves instantly, because `[steering-gear] rate-deg-s` is not given and the ship has none; \
                 give it, for instance 2.5"
            }
            Self::PerfectHelmsman => {
                "every order is given exactly at its heading, because `[helmsman]` has neither `reads-display-every-s` \
                 nor `reaction-time-s`"
            }
            Self::PerfectCompass => {
                "the recorded heading is the true one, because `[sensor]` has neither `heading-noise-deg` nor \
                 `heading-quantum-deg`"
            }
        }
    }
}
