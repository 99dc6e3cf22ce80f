//! An outside estimator for tests: least squares, and on request whatever an estimator should not do.
//!
//! `estimator MODE [REST]`: what MODE says is done at the trials whose number leaves this rest when it is divided by 7,
//! at all others the record is identified. `started FILE` adds a line to a file at the start.

use std::fs::OpenOptions;
use std::io::{self, BufRead, Write};
use std::time::Duration;

use kempf_tests::outside::least_squares;
use serde_json::{Value, json};

fn main() -> io::Result<()> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let mode = arguments.first().map_or("honest", String::as_str);
    let rest = arguments.get(1).and_then(|rest| rest.parse::<u64>().ok());
    if mode == "started" {
        let mut file = OpenOptions::new().append(true).create(true).open(&arguments[1])?;
        writeln!(file, "started")?;
    }
    if mode == "deaf" {
        std::thread::sleep(Duration::from_secs(3600));
    }
    for (answered, line) in io::stdin().lock().lines().enumerate() {
        let question: Value = serde_json::from_str(&line?)?;
        let trial = question["trial"].as_u64().expect("a question has a number");
        let answer = answer(&question);
        let mut output = io::stdout().lock();
        match mode {
            _ if rest.is_some_and(|own| own != trial % 7) => writeln!(output, "{answer}")?,
            "silent" => std::thread::sleep(Duration::from_secs(3600)),
            "dies" => std::process::exit(7),
            "nonsense" => writeln!(output, "Warning: \u{1b}[31m{trial}")?,
            "endless" => loop {
                output.write_all(&[b'x'; 1 << 16])?;
            },
            "cut" => {
                write!(output, "{{\"trial\": {trial}, \"K_per_s\"")?;
                output.flush()?;
                std::process::exit(0)
            }
            "wrong-number" => {
                writeln!(output, "{}", json!({ "trial": trial + 1, "K_per_s": 0.1, "T_s": 16.0 }))?;
            }
            "fails" => writeln!(output, "{}", json!({ "trial": trial, "failed": "no \u{7}excitation\n at all" }))?,
            "twice" => writeln!(output, "{answer}\n{answer}")?,
            "once" => {
                writeln!(output, "{answer}")?;
                return Ok(());
            }
            // Its third trial is too much for it.
            "tires" if answered == 2 => std::process::exit(7),
            "says" => {
                eprintln!("trial {trial} of {} rows", question["t_s"].as_array().map_or(0, Vec::len));
                writeln!(output, "{answer}")?;
            }
            "chatters" => {
                eprintln!("{}", "x".repeat(1 << 19));
                writeln!(output, "{answer}")?;
            }
            _ => writeln!(output, "{answer}")?,
        }
    }
    Ok(())
}

/// The answer to a question; K of further records is averaged with that of the first.
fn answer(question: &Value) -> Value {
    let also = question["also"].as_array().into_iter().flatten();
    let all: Option<Vec<[f64; 3]>> = std::iter::once(question).chain(also).map(identified).collect();
    match all {
        None => json!({ "trial": question["trial"], "failed": "the equations are singular" }),
        Some(found) => {
            let count = found.len() as f64;
            let mean = |part: usize| found.iter().map(|one| one[part]).sum::<f64>() / count;
            let sd = json!({ "K_per_s": 0.01, "T_s": 1.5, "delta_r_rad": null });
            json!({ "trial": question["trial"], "K_per_s": mean(0), "T_s": mean(1), "delta_r_rad": mean(2), "sd": sd })
        }
    }
}

fn identified(record: &Value) -> Option<[f64; 3]> {
    let column =
        |name: &str| -> Option<Vec<Option<f64>>> { Some(record[name].as_array()?.iter().map(Value::as_f64).collect()) };
    let whole = |name: &str| -> Option<Vec<f64>> { column(name)?.into_iter().collect() };
    least_squares(&whole("t_s")?, &column("heading_rad")?, &whole("rudder_rad")?)
}
