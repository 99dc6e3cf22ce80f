//! Answers that somebody found elsewhere to the trials of a scenario, as one more method of it.

use std::collections::HashMap;

use identify::{Answer, Estimate, IdentifyError};

/// A trial: its cell, and its number there.
pub type TrialNumber = (u64, u64);

/// Id of a method whose answers come as a table.
pub const ID: &str = "external";

/// Answers by trial. A trial without one has failed.
#[derive(Debug, Clone, PartialEq)]
pub struct Answers {
    answers: HashMap<TrialNumber, Result<Answer, String>>,
    sha256: String,
}

impl Answers {
    /// Answers, or reasons why there is none, and the SHA-256 of what they were read from, which tells them from
    /// others.
    pub fn new(answers: HashMap<TrialNumber, Result<Answer, String>>, sha256: String) -> Self {
        Self { answers, sha256 }
    }

    /// What they were read from.
    pub fn sha256(&self) -> &str {
        &self.sha256
    }

    /// The answer to a trial.
    pub fn to(&self, place: TrialNumber) -> Result<Estimate, IdentifyError> {
        match self.answers.get(&place) {
            Some(Ok(answer)) => answer.estimate(),
            Some(Err(words)) => Err(IdentifyError::outside(words)),
            None => Err(IdentifyError::outside("no answer")),
        }
    }
}
