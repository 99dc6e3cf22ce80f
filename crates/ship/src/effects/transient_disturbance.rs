//! A moment that is present for a part of the record only: a squall, a passing ship.

use super::effect::{Acts, Effect, Manoeuvres, Now, Parameter, Places, Proposal};
use crate::number::Real;

/// m over a span of time with smooth edges, as an equivalent rudder angle: m/2 [tanh((t − t_c + d/2)/w) − tanh((t − t_c
/// − d/2)/w)], w = d/10.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct TransientDisturbance;

const PARAMETERS: [Parameter; 3] = [
    Parameter {
        key: "m",
        symbol: "m",
        unit: "rad",
        neutral: 0.0,
        typical: 0.03,
        lowest: -0.6,
        highest: 0.6,
        odd: true,
    },
    Parameter {
        key: "t_c",
        symbol: "t_c",
        unit: "s",
        neutral: 100.0,
        typical: 100.0,
        lowest: -1e7,
        highest: 1e7,
        odd: false,
    },
    Parameter { key: "d", symbol: "d", unit: "s", neutral: 30.0, typical: 30.0, lowest: 0.5, highest: 1e5, odd: false },
];

/// Width of an edge as a share of the duration.
const EDGE: f64 = 0.1;

/// Longest squall that is looked for, as a share of its record.
const LONGEST: f64 = 0.2;

impl Effect for TransientDisturbance {
    fn id(&self) -> &'static str {
        "transient_disturbance"
    }

    fn form(&self) -> &'static str {
        "moment for a while"
    }

    fn equation(&self) -> &'static str {
        "T r' + r = K (δ + δ_r + m s(t; t_c, d))"
    }

    fn parameters(&self) -> &'static [Parameter] {
        &PARAMETERS
    }

    fn is_of_time(&self) -> bool {
        true
    }

    fn proposal(&self, about: &Manoeuvres) -> Option<Proposal> {
        let Manoeuvres { duration, spacing, span: [start, end], .. } = *about;
        let length = end - start;
        let scale = vec![0.02, 0.05 * duration, 0.05 * duration];
        let proposal = Proposal::new(*self, scale, Vec::new(), vec![0.05, 0.5 * (start + end), 0.1 * length]);
        // A squall comes and goes within the record; what lasts longer is a trend or a change of the ship.
        let margin = LONGEST * 0.25 * length;
        let proposal = proposal.within(1, [start + margin, end - margin]);
        Some(proposal.within(2, [(3.0 * spacing).max(0.5), LONGEST * length]))
    }

    fn places(&self) -> Places {
        Places::MOMENT
    }

    fn shortest_time(&self, p: &[f64]) -> f64 {
        EDGE * p[2]
    }

    /// Fifteen widths beyond the edges: tanh is there one to 10⁻¹³.
    fn fast_span(&self, p: &[f64]) -> [f64; 2] {
        let reach = (0.5 + 15.0 * EDGE) * p[2];
        [p[1] - reach, p[1] + reach]
    }
}

impl<R: Real> Acts<R> for TransientDisturbance {
    fn yaw_acceleration(&self, p: &[R], _z: &[R], now: &Now<R>) -> R {
        let (from_centre, half, width) = (R::from(now.t) - p[1], p[2] * 0.5, p[2] * EDGE);
        now.gain * 0.5 * p[0] * (((from_centre + half) / width).tanh() - ((from_centre - half) / width).tanh())
    }
}
