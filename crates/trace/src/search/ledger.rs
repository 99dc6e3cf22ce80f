//! What a search has tried, whatever came of it.

use std::collections::BTreeMap;
use std::sync::{Mutex, MutexGuard};

use ship::effects::{Effect, WaveYaw};

use crate::fit::Fit;
use crate::structure::{Structure, TermName};

/// Identifier, form and record of the terms of a structure, sorted; waves are a term here.
pub type Names = Vec<TermName>;

/// A structure with its fit of lowest BIC under any noise that was tried.
#[derive(Debug, Clone)]
pub struct Noted {
    /// The structure, its terms in the order of that fit.
    pub structure: Structure,
    /// The fit.
    pub fit: Fit,
    /// Whether the noise that suits the structure best was looked for.
    pub judged: bool,
}

/// Every structure that was tried, by the names of its terms.
#[derive(Debug, Default)]
pub struct Ledger(Mutex<BTreeMap<Names, Noted>>);

/// The names of a structure with its fit.
pub(super) fn names(structure: &Structure, fit: &Fit) -> Names {
    let mut names: Names = structure.terms.iter().map(|term| term.name()).collect();
    names.extend(fit.colour.waves.map(|_| (WaveYaw.id(), WaveYaw.form(), None)));
    names.sort_unstable();
    names
}

impl Ledger {
    /// Notes a fit of a structure; `judged` when the noise that suits it best was looked for.
    pub(super) fn note(&self, structure: &Structure, fit: &Fit, judged: bool) {
        if !fit.bic.is_finite() {
            return;
        }
        let mut known = self.known();
        let noted = |judged: bool| Noted { structure: structure.clone(), fit: fit.clone(), judged };
        match known.get_mut(&names(structure, fit)) {
            // Fits come in no order: of equal ones that with the smaller parameters stays.
            Some(old) if (fit.bic, &fit.theta) < (old.fit.bic, &old.fit.theta) => *old = noted(judged || old.judged),
            Some(old) => old.judged |= judged,
            None => {
                known.insert(names(structure, fit), noted(judged));
            }
        }
    }

    /// Everything that was noted.
    pub fn known(&self) -> MutexGuard<'_, BTreeMap<Names, Noted>> {
        self.0.lock().expect("no search panics while it holds the lock")
    }
}
