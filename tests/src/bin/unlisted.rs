//! Traces records of ships that are on no list and writes what came out into `results/published/unlisted`.
//!
//! Run with the folder of the results as first argument; see [`kempf_tests::unlisted`].

use std::error::Error;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use kempf_tests::unlisted::{NOISES_DEG, REPLICATES, chart, page, run, truths};
use report::Theme;

fn main() -> ExitCode {
    let Some(results) = std::env::args_os().nth(1).map(PathBuf::from) else {
        eprintln!("give the folder of the results: {}", page::COMMAND);
        return ExitCode::from(2);
    };
    match write(&results) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("{}: {error}", results.display());
            ExitCode::FAILURE
        }
    }
}

fn write(results: &Path) -> Result<(), Box<dyn Error>> {
    fs::create_dir_all(results)?;
    let truths = truths::all();
    let outcomes = run(&truths, &NOISES_DEG, REPLICATES);
    let figure = chart::outcomes(&truths, &outcomes);
    fs::write(results.join(format!("{}.png", figure.stem)), figure.plot.draw(&Theme::screen()).png()?)?;
    fs::write(results.join("outcomes.csv"), page::csv(&truths, &outcomes))?;
    Ok(fs::write(results.join("README.md"), page::markdown(&truths, &outcomes))?)
}
