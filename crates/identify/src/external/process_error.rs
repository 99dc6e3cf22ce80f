//! What can go wrong between this program and another one.

use std::process::ExitStatus;
use std::time::Duration;

use thiserror::Error;

use crate::error::IdentifyError;

/// Why there is no answer; the process is of no more use.
#[derive(Debug, Error)]
pub enum ProcessError {
    /// The program cannot be started.
    #[error("not started: {0}")]
    NotStarted(std::io::Error),
    /// Nothing came in time.
    #[error("no answer within {} s; after 3 such silences in succession it is asked no more", .0.as_secs_f64())]
    Silent(Duration),
    /// The process is gone, or has closed its output.
    #[error("the process ended without an answer{}", .0.map_or_else(String::new, |status| format!(" ({status})")))]
    Ended(Option<ExitStatus>),
    /// A line without an end.
    #[error("an answer of more than {0} bytes")]
    TooLong(usize),
    /// A line that is no answer to the question.
    #[error("{0}")]
    Nonsense(String),
}

impl From<ProcessError> for IdentifyError {
    fn from(error: ProcessError) -> Self {
        match error {
            ProcessError::NotStarted(error) => Self::NotStarted(error.to_string()),
            other => Self::outside(&other.to_string()),
        }
    }
}
