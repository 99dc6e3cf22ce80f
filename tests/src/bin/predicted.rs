//! Predicts measured trials from other trials of the same ship and writes page, table and figures. The records are not
//! part of the project; the page goes into `results/published/predicted`.
//!
//! Run with the folder of the results as only argument; the records are looked for as [`kempf_tests::measured`] says.

use std::path::Path;
use std::process::ExitCode;

use kempf_tests::measured::into_results;
use kempf_tests::measured::sets::Outcome;
use kempf_tests::predicted::forecast::Forecasts;
use kempf_tests::predicted::page;

fn main() -> ExitCode {
    into_results("results/published/predicted", run)
}

fn run(results: &Path) -> Outcome<()> {
    let scratch = tempfile::tempdir()?;
    page::write(&Forecasts::make(scratch.path())?, results)
}
