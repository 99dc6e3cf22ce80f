//! `study check`: resolve scenario files, run nothing.

use std::path::PathBuf;

use crate::screen;
use scenario::Scenario;
use scenario::failure::{Blame, Failure};

/// Resolves every file and prints one line for each that is right; all that are wrong are in the message.
pub fn run(scenarios: &[PathBuf]) -> Result<(), Failure> {
    let mut wrong = Vec::new();
    for path in scenarios {
        match Scenario::read(path, None) {
            Ok(scenario) => screen::say(&format!(
                "{}: {}, {}, {} each",
                path.display(),
                counted(scenario.cells.len() as u64, "cell"),
                counted(scenario.labels().count() as u64, "method"),
                counted(scenario.replicates, "trial"),
            ))?,
            Err(failure) => wrong.push(failure),
        }
    }
    let Some(first) = wrong.first() else { return Ok(()) };
    let others: String = wrong[1..].iter().map(|failure| format!("\n\n{failure}")).collect();
    Err(Failure { blame: Blame::Input, message: first.message.clone() + &others })
}

fn counted(count: u64, word: &str) -> String {
    if count == 1 { format!("1 {word}") } else { format!("{count} {word}s") }
}
