//! Fits a record: `cargo run -p kempf --example fit_csv -- RECORD.csv`.

use std::error::Error;
use std::path::PathBuf;

use kempf::prelude::*;

fn main() -> Result<(), Box<dyn Error>> {
    let path = std::env::args_os().nth(1).unwrap_or_else(|| "scenarios/records/first-order.csv".into());
    let record = read(&PathBuf::from(path))?.trial;
    for settings in registry::defaults() {
        let method = settings.build()?;
        match method.identify(std::slice::from_ref(&record)) {
            Ok(estimate) => {
                println!("{:24} K = {:.4} 1/s, T = {:.2} s", method.id(), estimate.K().value, estimate.T().value)
            }
            Err(error) => println!("{:24} {error}", method.id()),
        }
    }
    Ok(())
}
