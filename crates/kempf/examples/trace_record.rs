//! Traces the effects that a first-order model lacks on a record, and prints the heading error before and after:
//! `cargo run -p kempf --example trace_record -- RECORD.csv`.

use std::error::Error;
use std::path::PathBuf;

use kempf::prelude::*;
use kempf::trace::{Settings, trace};

fn main() -> Result<(), Box<dyn Error>> {
    let path = std::env::args_os().nth(1).unwrap_or_else(|| "scenarios/records/undeclared-damping.csv".into());
    let record = read(&PathBuf::from(path))?.trial;
    let analysis = trace(std::slice::from_ref(&record), &[], &Settings::default())?;
    println!("{}: {}", record.name(), analysis.document.headline);
    for effect in &analysis.document.effects {
        println!("  {} ({}): {}", effect.id, effect.form, effect.evidence);
    }
    let compared = &analysis.identification[0];
    let (before, after) =
        (to_deg(compared.base_replay.errors.heading_rmse), to_deg(compared.average_replay.errors.heading_rmse));
    println!("heading error {before:.3} deg before, {after:.3} deg after");
    Ok(())
}
