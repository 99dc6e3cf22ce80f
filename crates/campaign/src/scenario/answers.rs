//! Answers of an outside estimator to the trials of a scenario, as a further method.

use std::collections::HashMap;

use identify::{Estimate, IdentifyError, OutsideFit};

/// Cell and replicate of a trial.
pub type TrialNumber = (u64, u64);

/// Id of a method whose answers are read from a table.
pub const ID: &str = "external";

/// Answers by trial. A trial without an answer counts as failed.
#[derive(Debug, Clone, PartialEq)]
pub struct Answers {
    answers: HashMap<TrialNumber, Result<OutsideFit, String>>,
    sha256: String,
}

impl Answers {
    /// Answers, or reasons for missing ones, with the SHA-256 of their source, which identifies them.
    pub fn new(answers: HashMap<TrialNumber, Result<OutsideFit, String>>, sha256: String) -> Self {
        Self { answers, sha256 }
    }

    /// SHA-256 of their source.
    pub fn sha256(&self) -> &str {
        &self.sha256
    }

    /// Estimate for a trial; fails with the reason of a missing answer.
    pub fn to(&self, place: TrialNumber) -> Result<Estimate, IdentifyError> {
        match self.answers.get(&place) {
            Some(Ok(answer)) => answer.estimate(),
            Some(Err(reason)) => Err(IdentifyError::outside(reason)),
            None => Err(IdentifyError::outside("no answer")),
        }
    }
}
