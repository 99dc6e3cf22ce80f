//! What is taken for granted in a trial where settings are left out.

use trial::Manoeuvre;

use crate::simulation::Simulation;

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

    /// Whether a simulation makes it. A rate that is given as infinite is meant.
    pub fn holds(self, simulation: &Simulation) -> bool {
        let Simulation { manoeuvre, helmsman, gear, sensors, .. } = simulation;
        match self {
            Self::InstantRudder => {
                gear.rate.is_none() && gear.lag == 0.0 && !matches!(manoeuvre, Manoeuvre::Replay { .. })
            }
            Self::PerfectHelmsman => {
                let perfect = helmsman.reads_display_every.is_none() && helmsman.reaction_time == 0.0;
                perfect && matches!(manoeuvre, Manoeuvre::ZigZag { .. })
            }
            Self::PerfectCompass => {
                let never_off = sensors.heading_wander.is_none_or(|wander| wander.sd == 0.0)
                    && sensors.heading_spikes.is_none_or(|spikes| spikes.probability == 0.0);
                sensors.heading_noise == 0.0 && sensors.heading_quantum == 0.0 && never_off
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
