//! Fits a log as `study fit` does: `cargo run -p kempf --example fit_csv -- RECORD.csv`.

use std::error::Error;
use std::path::PathBuf;
use std::process::ExitCode;

use kempf::prelude::*;

fn main() -> ExitCode {
    match fit() {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("{error}");
            ExitCode::FAILURE
        }
    }
}

fn fit() -> Result<(), Box<dyn Error>> {
    let path = std::env::args_os().nth(1).unwrap_or_else(|| "scenarios/records/first-order.csv".into());
    let path = PathBuf::from(path);
    let log = InstrumentLog::open(&path, Sidecar::existing_beside(&path).as_deref(), &[])?;
    let ReadRecord { trial, warnings } = log.into_zig_zag(None)?;
    let (records, mut all_warnings) = ([trial], Warnings::default());
    all_warnings.extend(warnings);
    let mut answers = Vec::new();
    for method in registry::default_methods() {
        let (entry, estimate) = method_entry(method.id(), method.identify(&records), &records);
        match &estimate {
            Some(estimate) => {
                println!("{:24} K = {:.4} 1/s, T = {:.2} s", method.id(), estimate.K().value, estimate.T().value);
                all_warnings.extend(WarningSource::Method(method.id().to_owned()).attach_to(estimate.warnings.clone()));
            }
            None => println!("{:24} {}", method.id(), entry.reason.as_deref().unwrap_or("no answer")),
        }
        answers.push((entry, estimate));
    }
    match verdict::from_estimates(&records, &answers) {
        None => println!("no method can identify this record"),
        Some(VerdictEntry { because: Some(because), .. }) => println!("no K and T can be taken, because {because}"),
        Some(verdict) => {
            let [k, t] =
                [verdict.k_per_s, verdict.t_s].map(|index| index.expect("an answer that is to be taken has both"));
            println!("take K = {:.4} 1/s, T = {:.2} s from {}", k.value, t.value, verdict.method);
        }
    }
    all_warnings.ranked().iter().for_each(|warning| println!("warning: {warning}"));
    Ok(())
}
