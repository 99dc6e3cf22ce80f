//! A method that is another program: it is started once, asked trial by trial in one line of JSON each, and answers in
//! one line each. What stands in the lines is in [`protocol`], how a program is started, asked and ended in `process`
//! and `pool`.
//!
//! A program works on one trial at a time, so there are never more processes of a command than threads that ask. An
//! answer may depend on nothing but its question: then rows do not depend on the number of threads.
//!
//! A program that is silent three times in succession is given up. Questions after that fail at once, with the reason
//! of those that were waited for: the rows of a program that always hangs are the same however many threads asked it.

use std::path::Path;
use std::sync::Arc;
use std::time::Duration;

use serde::{Deserialize, Serialize};
use ship::ShortNumber;
use trial::{Origin, Trial};

use crate::error::IdentifyError;
use crate::estimate::Estimate;
use crate::identifier::{Identifier, Outside};
use crate::settings::{SettingsError, require};
use pool::ProcessPool;
use process_error::ProcessError;

mod answer;
mod place;
mod pool;
mod process;
mod process_error;
pub mod protocol;

pub use answer::{Answer, Errors};
pub use place::shown;
pub use process::end_all;

/// Id of a method that is another program.
pub const ID: &str = "external";

/// Most words of a command.
const MOST_WORDS: usize = 64;

/// Longest word of a command, bytes.
const LONGEST_WORD: usize = 4096;

/// Times that may be waited for an answer, s.
const TIMEOUTS_S: std::ops::RangeInclusive<f64> = 0.01..=86_400.0;

/// The command of an outside estimator, and how long its answer is waited for.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct Settings {
    /// The program and its arguments; no shell looks at them.
    pub command: Vec<String>,
    /// Longest time to an answer, s; that to the first one holds the start of the program.
    #[serde(default = "usual_timeout_s")]
    pub timeout_s: f64,
}

fn usual_timeout_s() -> f64 {
    60.0
}

impl Settings {
    /// A command with the usual time for an answer.
    pub fn new(command: impl IntoIterator<Item = impl Into<String>>) -> Self {
        Self { command: command.into_iter().map(Into::into).collect(), timeout_s: usual_timeout_s() }
    }

    /// Checks the settings and makes the method, whose program runs in `folder`. Nothing is started.
    pub fn build(self, folder: &Path) -> Result<External, SettingsError> {
        let Self { command, timeout_s } = self;
        if !(1..=MOST_WORDS).contains(&command.len()) {
            return Err(SettingsError::new("command", format!("a list of {}", command.len()), "1 to 64 words"));
        }
        let is_word = |word: &String| !word.trim().is_empty() && word.len() <= LONGEST_WORD && !word.contains('\0');
        if let Some(wrong) = command.iter().find(|word| !is_word(word)) {
            let found = format!("a list with {:?}", wrong.chars().take(20).collect::<String>());
            return Err(SettingsError::new("command", found, "words that are not blank, of at most 4096 bytes each"));
        }
        let holds = TIMEOUTS_S.contains(&timeout_s);
        require(holds, "timeout-s", ShortNumber(timeout_s), "a time from 0.01 to 86400 s")?;
        Ok(External { pool: ProcessPool::of(command, folder, Duration::from_secs_f64(timeout_s)) })
    }
}

/// An outside estimator with its settings.
pub struct External {
    pool: Arc<ProcessPool>,
}

impl Identifier for External {
    fn id(&self) -> &'static str {
        ID
    }

    fn summary(&self) -> &'static str {
        "another program, asked in a line of JSON for every trial"
    }

    fn identify(&self, trials: &[Trial]) -> Result<Estimate, IdentifyError> {
        let (first, others) = trials.split_first().ok_or(IdentifyError::NoTrial)?;
        let replicate = match first.origin() {
            Origin::Simulated { replicate, .. } => *replicate,
            Origin::Measured { .. } => 0,
        };
        let (number, question) = protocol::question(replicate, first, others);
        let mut process = self.pool.take()?;
        loop {
            let before = process.answered;
            let asked = process.ask(self.pool.timeout, question.clone());
            match asked {
                Err(ProcessError::Silent(_)) => self.pool.was_silent(),
                _ => self.pool.was_answered(),
            }
            match asked.and_then(|line| protocol::answer(&line, number)) {
                Ok(answer) => {
                    self.pool.give_back(process);
                    return answer.map_err(|words| IdentifyError::outside(&words))?.estimate();
                }
                // What a process did before must not show in a row: a new one is asked once more. Not after silence,
                // which would take the time twice.
                Err(ProcessError::Ended(_) | ProcessError::TooLong(_) | ProcessError::Nonsense(_)) if before > 0 => {
                    process.kill();
                    process = self.pool.start()?;
                }
                Err(error) => {
                    process.kill();
                    return Err(error.into());
                }
            }
        }
    }

    fn outside(&self) -> Option<&dyn Outside> {
        Some(&*self.pool)
    }
}
