//! Estimates of an outside estimator for the trials of a scenario, as a further method.

use std::collections::HashMap;

use identify::{Estimate, IdentifyError, OutsideFit};

/// Cell and replicate of a trial.
pub type CellAndReplicate = (u64, u64);

/// Id of a method whose estimates are read from a table.
pub const METHOD_ID: &str = "external";

/// Outside estimates by trial. A trial without an estimate counts as failed.
#[derive(Debug, Clone, PartialEq)]
pub struct OutsideEstimates {
    answers: HashMap<CellAndReplicate, Result<OutsideFit, String>>,
    source_sha256: String,
}

impl OutsideEstimates {
    /// Outside estimates, or reasons for missing estimates, with the SHA-256 of their source, which identifies them.
    pub fn new(answers: HashMap<CellAndReplicate, Result<OutsideFit, String>>, source_sha256: String) -> Self {
        Self { answers, source_sha256 }
    }

    /// SHA-256 of the source of the estimates, hexadecimal.
    pub fn source_sha256(&self) -> &str {
        &self.source_sha256
    }

    /// Estimate for a trial. Fails with the reason of a missing estimate.
    pub fn estimate(&self, place: CellAndReplicate) -> Result<Estimate, IdentifyError> {
        match self.answers.get(&place) {
            Some(Ok(answer)) => answer.estimate(),
            Some(Err(reason)) => Err(IdentifyError::from_outside_message(reason)),
            None => Err(IdentifyError::from_outside_message("no answer")),
        }
    }
}
