//! Sway coupling: the second time constant and the rudder zero that a first-order response lacks.

use super::effect::{Acts, Effect, Manoeuvres, Parameter, Places, Proposal, SwayCoupling};
use crate::number::Real;

/// T₁T₂ r'' + (T₁+T₂) r' + r = K (δ + δ_r) + K T₃ δ', with T₁ = 1/a of the base.
///
/// Absent when T₂ = T₃: zero and pole cancel. Source: Nomoto, Taguchi, Honda and Hirano (1957).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct SecondOrder;

const PARAMETERS: [Parameter; 2] = [
    Parameter {
        key: "T2",
        symbol: "T₂",
        unit: "s",
        neutral: 1.0,
        typical: 2.5,
        lowest: 0.02,
        highest: 600.0,
        odd: false,
    },
    Parameter {
        key: "T3",
        symbol: "T₃",
        unit: "s",
        neutral: 1.0,
        typical: 6.2,
        lowest: -600.0,
        highest: 2000.0,
        odd: false,
    },
];

/// Largest T₂ and T₃ that are looked for, in time constants of the base. Beyond, zero and pole are so slow that they
/// imitate a trend.
const SLOWEST_POLE: f64 = 1.0;
const SLOWEST_ZERO: f64 = 2.0;

impl Effect for SecondOrder {
    fn id(&self) -> &'static str {
        "second_order"
    }

    fn form(&self) -> &'static str {
        "sway coupling"
    }

    fn equation(&self) -> &'static str {
        "T₁T₂ r'' + (T₁+T₂) r' + r = K (δ + δ_r) + K T₃ δ'"
    }

    fn parameters(&self) -> &'static [Parameter] {
        &PARAMETERS
    }

    fn proposal(&self, about: &Manoeuvres) -> Option<Proposal> {
        let time = about.time;
        let starts = [[0.15, 0.4], [0.2, 0.02], [0.4, 1.2]].map(|[t2, t3]| vec![t2 * time, t3 * time]);
        let (scale, large) = (vec![0.2 * time, 0.5 * time], vec![0.15 * time, 0.5 * time]);
        let proposal = Proposal::new(*self, scale, starts.into(), large);
        let shortest = 0.02_f64.max(0.1 * about.spacing);
        Some(proposal.within(0, [shortest, SLOWEST_POLE * time]).within(1, [-0.5 * time, SLOWEST_ZERO * time]))
    }

    fn places(&self) -> Places {
        Places::NONE
    }

    /// One state, s of [`crate::response`]; the response itself steps it.
    fn states(&self) -> usize {
        1
    }

    fn shortest_time(&self, p: &[f64]) -> f64 {
        p[0]
    }
}

impl<R: Real> Acts<R> for SecondOrder {
    fn sway_coupling(&self, p: &[R]) -> Option<SwayCoupling<R>> {
        Some(SwayCoupling { second_time: p[0], rudder_time: p[1] })
    }
}
