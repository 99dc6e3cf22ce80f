//! A moment that grows with the distance from the track on which a record begins: a bank, or shallow water to one side.
//! It has no name among the effects, since its constant belongs to a place and not to a ship.

use ship::EffectReal;
use ship::effects::{Acts, Effect, Manoeuvres, Now, Parameter, Places, Proposal};

use crate::candidates::{Candidate, Sizes};
use crate::monomial::PARAMETERS;
use crate::record::Record;

/// c y with y' = sin(ψ − ψ₀), as an equivalent rudder angle; y in units of the length of the record.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Offset {
    /// Course of the track ψ₀, rad.
    course: f64,
    /// Length of the record, s.
    duration: f64,
}

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
        vec![self.course, self.duration]
    }

    fn states(&self) -> usize {
        1
    }

    fn sees_heading(&self) -> bool {
        true
    }

    fn proposal(&self, _about: &Manoeuvres) -> Option<Proposal> {
        Some(Proposal::of_one(*self, 0.02, 0.0, 1.0))
    }

    fn places(&self) -> Places {
        Places::MOMENT
    }
}

impl<R: EffectReal> Acts<R> for Offset {
    fn rates(&self, _p: &[R], _z: &[R], now: &Now<R>, _before: R, rate: &mut [R]) {
        rate[0] = (now.heading - R::from(self.course)).sin_cos().0 / self.duration;
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
