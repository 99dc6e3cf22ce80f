//! A moment that grows with the distance from the track on which a record begins: a bank, or shallow water to one side.
//! It has no name among the effects, since its constant belongs to a place and not to a ship.

use ship::EffectReal;
use ship::effects::{Acts, Effect, Manoeuvres, Now, Parameter, Places, Proposal};

use crate::candidates::{Candidate, Sizes};
use crate::monomial::COEFFICIENT;
use crate::record::Record;

/// c y with y' = sin(ψ − ψ₀), as an equivalent rudder angle; y in units of the length of the record. The first heading
/// is too noisy a reading of the course ψ₀: a tenth of a degree is a trend.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Offset {
    /// Heading at the beginning, rad.
    course: f64,
    /// Length of the record, s.
    duration: f64,
}

const PARAMETERS: [Parameter; 2] = [
    COEFFICIENT,
    Parameter {
        key: "psi_0",
        symbol: "ψ₀",
        unit: "rad",
        neutral: 0.0,
        typical: 0.01,
        lowest: -1e3,
        highest: 1e3,
        odd: false,
    },
];

impl Effect for Offset {
    fn id(&self) -> &'static str {
        "empirical"
    }

    fn form(&self) -> &'static str {
        "∫ sin(ψ − ψ₀) dt"
    }

    fn equation(&self) -> &'static str {
        "T r' + r = K (δ + δ_r + c ∫ sin(ψ − ψ₀) dt)"
    }

    fn parameters(&self) -> &'static [Parameter] {
        &PARAMETERS
    }

    fn constants(&self) -> Vec<f64> {
        vec![self.duration]
    }

    fn states(&self) -> usize {
        1
    }

    fn sees_heading(&self) -> bool {
        true
    }

    fn proposal(&self, _about: &Manoeuvres) -> Option<Proposal> {
        let start = vec![0.0, self.course];
        Some(Proposal::new(*self, vec![0.02, 0.02], vec![start], vec![1.0, self.course]))
    }

    fn places(&self) -> Places {
        Places::MOMENT
    }
}

impl<R: EffectReal> Acts<R> for Offset {
    fn rates(&self, p: &[R], _z: &[R], now: &Now<R>, _before: R, rate: &mut [R]) {
        rate[0] = (now.heading - p[1]).sin_cos().0 / self.duration;
    }

    fn yaw_acceleration(&self, p: &[R], z: &[R], now: &Now<R>) -> R {
        now.gain * p[0] * z[0]
    }
}

/// The candidate on a record; `None` for several, which have a track each.
pub fn candidate(records: &[Record], sizes: &Sizes) -> Option<Candidate> {
    let [record] = records else { return None };
    let offset = Offset { course: record.heading[*record.observed.first()?], duration: record.duration() };
    Some(Candidate::new(offset.proposal(&sizes.manoeuvres(records, record))?, None))
}
