//! `performance [--quick] DIR` measures what simulation, identification, tracing and studies cost on this machine,
//! beside rivals and beside what is to be reached, and how it grows with samples and trials; it writes a report, tables
//! and figures into DIR. On a machine that does nothing else it takes some ten minutes; `--quick` does the same with
//! small sizes in seconds, to see that it works.

mod child;
mod figures;
mod growth;
mod machine;
mod page;
mod trials;

use std::path::PathBuf;
use std::process::ExitCode;

use kempf_benches::measure::{Effort, in_turn};
use kempf_benches::process::{self, Outcome};
use kempf_benches::verdict::Line;
use kempf_benches::work::{Group, Work};
use kempf_benches::works;

/// A group and its measured rows.
pub struct Measurements {
    /// The group.
    pub group: Group,
    /// Its rows.
    pub lines: Vec<Line>,
}

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let done = match arguments.iter().map(String::as_str).collect::<Vec<_>>()[..] {
        [child::CHILD, ref rest @ ..] => child::answer(rest),
        ["--quick", folder] | [folder, "--quick"] => run(&PathBuf::from(folder), true),
        [folder] if !folder.starts_with('-') => run(&PathBuf::from(folder), false),
        _ => {
            eprintln!("usage: performance [--quick] DIR, for instance results/performance");
            return ExitCode::from(2);
        }
    };
    process::end(done)
}

fn run(folder: &std::path::Path, quick: bool) -> Outcome<()> {
    std::fs::create_dir_all(folder)
        .map_err(|error| format!("failed to make the folder {}: {error}", folder.display()))?;
    let effort = if quick { Effort::QUICK } else { Effort::FULL };
    let mut measured = Vec::new();
    for group in works::all() {
        say(&format!("{}: {} pieces of work", group.name, group.works().len()));
        measured.push(measure(group, &effort));
    }
    say("time over samples");
    let samples = growth::with_samples(quick);
    let trials = trials::measure(quick)?;
    let machine = machine::Machine::new(quick);
    figures::write(folder, &measured, &samples, &trials)?;
    page::write(folder, &machine, &measured, &samples, &trials)
}

/// Progress, on standard error.
pub fn say(what: &str) {
    eprintln!("{what} …");
}

fn measure(group: Group, effort: &Effort) -> Measurements {
    let works: Vec<&Work> = group.works().into_iter().map(AsRef::as_ref).collect();
    let samples = in_turn(&works, effort);
    let of = |name: &str| works.iter().position(|work| work.name == name).map(|index| samples[index].as_slice());
    let line = |row: &kempf_benches::work::Row| {
        let beside = row.beside.as_ref().and_then(|beside| of(&beside.name));
        Line::paired(row, of(&row.work.name)?, beside)
    };
    let lines = group.rows.iter().filter_map(line).collect();
    Measurements { lines, group }
}
