//! A ship that is another one from an instant on: a tow that is let go, another depth, another trim. It has no name
//! among the effects, since nothing in the motion itself says when it comes.

use ship::EffectReal;
use ship::effects::instant::{EDGE_ROWS, INSTANT, REACH};
use ship::effects::{Acts, Effect, Manoeuvres, Now, Parameter, Places, Proposal, Scale};

use crate::candidates::{Candidate, Sizes};
use crate::record::Record;

/// 1/T and K/T times 1 + a s(t; t₀) and 1 + b s(t; t₀), s = ½ [1 + tanh((t − t₀)/w)].
#[derive(Debug, Clone, Copy, PartialEq)]
struct Change {
    /// Width w of the edge, s.
    edge: f64,
}

/// A share by which an index changes.
const SHARE: Parameter =
    Parameter { key: "a", symbol: "a", unit: "1", neutral: 0.0, typical: 0.2, lowest: -0.9, highest: 10.0, odd: false };

const PARAMETERS: [Parameter; 3] = [SHARE, Parameter { key: "b", symbol: "b", ..SHARE }, INSTANT];

/// Instants from which a fit starts, as shares of the record; the outer ones bound it.
const INSTANTS: [f64; 9] = [0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9];

impl Effect for Change {
    fn id(&self) -> &'static str {
        "empirical"
    }

    fn form(&self) -> &'static str {
        "another 1/T and K/T from t₀ on"
    }

    fn equation(&self) -> &'static str {
        "r' = −(1 + a s(t; t₀)) r/T + (1 + b s(t; t₀)) (K/T) (δ + δ_r)"
    }

    fn parameters(&self) -> &'static [Parameter] {
        &PARAMETERS
    }

    fn constants(&self) -> Vec<f64> {
        vec![self.edge]
    }

    fn has_instant(&self) -> bool {
        true
    }

    fn proposal(&self, about: &Manoeuvres) -> Option<Proposal> {
        let [start, end] = about.span;
        let at = |share: f64| start + share * (end - start);
        let starts = INSTANTS[1..INSTANTS.len() - 1].iter().map(|&share| vec![0.0, 0.0, at(share)]).collect();
        let scale = vec![0.2, 0.2, 0.05 * about.duration];
        let proposal = Proposal::new(*self, scale, starts, vec![0.5, 0.5, at(0.5)]);
        Some(proposal.within(2, [at(INSTANTS[0]), at(INSTANTS[INSTANTS.len() - 1])]))
    }

    fn places(&self) -> Places {
        Places::SCALE
    }

    fn shortest_time(&self, _p: &[f64]) -> f64 {
        self.edge
    }

    fn fast_span(&self, p: &[f64]) -> [f64; 2] {
        [p[2] - REACH * self.edge, p[2] + REACH * self.edge]
    }
}

impl<R: EffectReal> Acts<R> for Change {
    fn scale(&self, p: &[R], _z: &[R], now: &Now<R>) -> Scale<R> {
        let since = (R::from(now.t) - p[2]) / R::from(self.edge);
        let there = (since.tanh() + R::from(1.0)) * 0.5;
        Scale { damping: p[0] * there + R::from(1.0), gain: p[1] * there + R::from(1.0) }
    }
}

/// The candidate on a record; `None` for several, which may be runs of different ships.
pub fn candidate(records: &[Record], sizes: &Sizes) -> Option<Candidate> {
    let [record] = records else { return None };
    let change = Change { edge: EDGE_ROWS * record.spacing };
    Some(Candidate::new(change.proposal(&sizes.manoeuvres(records, record))?, None))
}
