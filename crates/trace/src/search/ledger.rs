//! What a search has tried, whatever came of it.

use std::collections::BTreeMap;
use std::sync::{Mutex, MutexGuard};

use ship::effects::{Effect, WaveYaw};

use crate::fit::Fit;
use crate::structure::{Structure, TermName};

/// The lowest BIC of every structure that was tried, by the sorted names of its terms.
#[derive(Debug, Default)]
pub struct Ledger(Mutex<BTreeMap<Vec<TermName>, f64>>);

impl Ledger {
    /// Notes a fit of a structure; waves are a term here.
    pub(super) fn note(&self, structure: &Structure, fit: &Fit) {
        if !fit.bic.is_finite() {
            return;
        }
        let mut names: Vec<TermName> = structure.terms.iter().map(|term| term.name()).collect();
        names.extend(fit.colour.waves.map(|_| (WaveYaw.id(), WaveYaw.form(), None)));
        names.sort_unstable();
        let mut known = self.known();
        let lowest = known.entry(names).or_insert(f64::INFINITY);
        *lowest = lowest.min(fit.bic);
    }

    /// Everything that was noted.
    pub(super) fn known(&self) -> MutexGuard<'_, BTreeMap<Vec<TermName>, f64>> {
        self.0.lock().expect("no search panics while it holds the lock")
    }
}
