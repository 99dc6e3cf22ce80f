//! Fits that were asked for before: a search comes back to the same models, and a report to those of the search.

use std::collections::HashMap;
use std::sync::{Arc, Mutex};

use super::outcome::Fit;
use crate::noise::{Colour, GUSTS, Wander};
use crate::structure::{Structure, TermName};

/// What decides a fit: names of the terms and which of their parameters are held, and every number that goes into it,
/// by its bits.
type Question = (Vec<(TermName, &'static [usize])>, Vec<u64>);

/// Answers by their questions.
#[derive(Debug, Clone, Default)]
pub(super) struct Memory(Arc<Mutex<HashMap<Question, Fit>>>);

impl Memory {
    /// The answer to a question, looked up where it was asked before.
    pub fn once(&self, question: Question, fit: impl FnOnce() -> Fit) -> Fit {
        let finished = || self.0.lock().expect("no fit panics while it holds the lock");
        if let Some(known) = finished().get(&question) {
            return known.clone();
        }
        let fit = fit();
        finished().insert(question, fit.clone());
        fit
    }
}

/// What decides a fit; `start` are the parameters of a last term whose fit begins with known sensitivities.
pub(super) fn question(
    structure: &Structure,
    theta: &[f64],
    initial: &[[f64; 2]],
    colour: &Colour,
    start: Option<&[f64]>,
) -> Question {
    let names = structure.terms.iter().map(|term| (term.name(), term.held)).collect();
    let constants: Vec<f64> = structure.terms.iter().flat_map(|term| term.effect.constants()).collect();
    let bounds = structure.terms.iter().flat_map(|term| [&term.lowest, &term.highest, &term.scale]).flatten();
    let moment = colour.wander.map_or([0.0; 2], |(kind, level)| {
        let number = match kind {
            Wander::White => 1,
            Wander::Walk => 2,
            Wander::OrnsteinUhlenbeck(number) => 3 + number,
            Wander::Compass(number) => 3 + GUSTS.len() + number,
        };
        [number as f64, level]
    });
    let waves = colour.waves.map_or([0.0; 3], |waves| [waves.sd, waves.frequency, waves.damping]);
    let shape = [structure.own_bias, structure.ship_known, start.is_some()].map(f64::from);
    let scaling = structure.scaled().map_or(0.0, |scaling| scaling.approach_speed);
    let own = start.unwrap_or_default();
    let numbers = shape
        .iter()
        .chain([&scaling])
        .chain(&moment)
        .chain(&waves)
        .chain(&constants)
        .chain(bounds)
        .chain(initial.as_flattened())
        .chain(theta)
        .chain(own);
    (names, numbers.map(|x| x.to_bits()).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_question_is_worked_out_once() {
        let memory = Memory::default();
        let structure = Structure::base(1, false);
        let mut worked_out = 0;
        for gain in [0.1, 0.1, 0.2, 0.1] {
            let key = question(&structure, &[0.06, gain, 0.0], &[[0.0; 2]], &Colour::WHITE, None);
            let fit = memory.once(key, || {
                worked_out += 1;
                Fit {
                    theta: vec![gain],
                    initial: Vec::new(),
                    colour: Colour::WHITE,
                    residual: Vec::new(),
                    rss: 0.0,
                    deviance: 0.0,
                    freedom: 0,
                    lost: 0.0,
                    bic: 0.0,
                }
            });
            assert_eq!(fit.theta, [gain]);
        }
        assert_eq!(worked_out, 2);
    }
}
