//! Traces what a first-order model lacks of a record, and prints its error before and after:
//! `cargo run -p kempf --example trace_record -- RECORD.csv`.

use std::error::Error;
use std::path::PathBuf;

use kempf::prelude::*;
use kempf::trace::{Settings, trace};

fn main() -> Result<(), Box<dyn Error>> {
    let path = std::env::args_os().nth(1).unwrap_or_else(|| "scenarios/records/undeclared-damping.csv".into());
    let record = read(&PathBuf::from(path))?.trial;
    let analysis = trace(std::slice::from_ref(&record), &[], &Settings::default())?;
    println!("{}: {}", record.name(), analysis.verdict.as_str());
    for effect in &analysis.effects {
        println!("  {} ({}): {}", effect.id, effect.form, effect.sentence);
    }
    let judged = &analysis.identification[0];
    let (before, after) = (to_deg(judged.before.errors.heading), to_deg(judged.after.errors.heading));
    println!("heading error {before:.3} deg before, {after:.3} deg after");
    Ok(())
}
