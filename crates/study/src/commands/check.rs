//! `study check`: resolve scenario files, run nothing.

use std::path::{Path, PathBuf};

use crate::options::Common;
use crate::screen;
use scenario::Scenario;
use scenario::failure::{Blame, Failure};
use simulate::settings::Assumption;

/// Resolves every file and prints one line for each that is right, with a note where its rudder moves instantly; with
/// `resolved` the whole scenario below it. All that are wrong are in the message.
pub fn run(scenarios: &[PathBuf], resolved: bool, common: &Common) -> Result<(), Failure> {
    let mut wrong = Vec::new();
    for path in scenarios {
        match Scenario::read(path, common.seed) {
            Ok(scenario) if resolved => {
                let summary: String = summary(path, &scenario).lines().map(|line| format!("# {line}\n")).collect();
                screen::say(&format!("{summary}\n{}", scenario.resolved()))?;
            }
            Ok(_) if common.quiet => {}
            Ok(scenario) => screen::say(&summary(path, &scenario))?,
            Err(failure) => wrong.push(failure),
        }
    }
    let Some(first) = wrong.first() else { return Ok(()) };
    let others: String = wrong[1..].iter().map(|failure| format!("\n\n{failure}")).collect();
    Err(Failure { blame: Blame::Input, message: first.message.clone() + &others })
}

/// The size of a scenario, and below it a note on a rudder that moves instantly, which few mean and no real ship has.
fn summary(path: &Path, scenario: &Scenario) -> String {
    let size = format!(
        "{}: {}, {}, {} each",
        path.display(),
        counted(scenario.cells.len() as u64, "cell"),
        counted(scenario.labels().count() as u64, "method"),
        counted(scenario.replicates, "trial"),
    );
    let mut defaults = scenario.defaults_that_matter().into_iter();
    match defaults.find(|(assumption, _)| *assumption == Assumption::InstantRudder) {
        Some((_, sentence)) => format!("{size}\n  note: {sentence}"),
        None => size,
    }
}

fn counted(count: u64, word: &str) -> String {
    if count == 1 { format!("1 {word}") } else { format!("{count} {word}s") }
}
