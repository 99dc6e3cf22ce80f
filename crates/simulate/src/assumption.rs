//! Assumptions of a trial in which settings are left out.

use trial::Manoeuvre;

use crate::simulation::Simulation;

/// Assumption of a trial for a setting that was left out; it can decide the result of a study.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Assumption {
    /// Instantaneous rudder.
    InstantRudder,
    /// Orders given exactly at their heading.
    PerfectHelmsman,
    /// Recorded heading without errors.
    PerfectCompass,
}

impl Assumption {
    /// All assumptions, in order of decreasing effect on results.
    pub const ALL: [Self; 3] = [Self::InstantRudder, Self::PerfectHelmsman, Self::PerfectCompass];

    /// `true` if a simulation makes this assumption. A rate set to infinity is intentional and is no assumption.
    pub fn is_made_by(self, simulation: &Simulation) -> bool {
        let Simulation { manoeuvre, helmsman, gear, sensors, .. } = simulation;
        match self {
            Self::InstantRudder => {
                gear.rudder_rate.is_none() && gear.lag == 0.0 && !matches!(manoeuvre, Manoeuvre::Replay { .. })
            }
            Self::PerfectHelmsman => {
                let perfect = helmsman.reads_display_every.is_none() && helmsman.reaction_time == 0.0;
                perfect && matches!(manoeuvre, Manoeuvre::ZigZag { .. })
            }
            Self::PerfectCompass => {
                let without_faults = sensors.heading_wander.is_none_or(|wander| wander.sd == 0.0)
                    && sensors.heading_spikes.is_none_or(|spikes| spikes.probability == 0.0);
                sensors.heading_noise == 0.0 && sensors.heading_quantum == 0.0 && without_faults
            }
        }
    }

    /// Message: the assumption, its reason, and advice.
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
