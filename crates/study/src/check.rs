//! `study check`: resolve scenario files, run nothing.

use std::path::PathBuf;

use crate::failure::{Blame, Failure};
use crate::scenario::Scenario;

/// Resolves every file and prints one line for each that is right; all that are wrong are in the message.
pub fn run(scenarios: &[PathBuf]) -> Result<(), Failure> {
    let mut wrong = Vec::new();
    for path in scenarios {
        match Scenario::read(path, None) {
            Ok(scenario) => println!(
                "{}: {} {}, {} {}, {} {} each",
                path.display(),
                scenario.cells.len(),
                plural(scenario.cells.len() as u64, "cell"),
                scenario.labels().count(),
                plural(scenario.labels().count() as u64, "method"),
                scenario.replicates,
                plural(scenario.replicates, "trial"),
            ),
            Err(failure) => wrong.push(failure.message),
        }
    }
    if wrong.is_empty() { Ok(()) } else { Err(Failure { blame: Blame::Input, message: wrong.join("\n\n") }) }
}

fn plural(count: u64, word: &str) -> String {
    if count == 1 { word.to_owned() } else { format!("{word}s") }
}
