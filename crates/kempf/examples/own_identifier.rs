//! A user's identification method in a study, next to those of the project and without changes to the workspace.

use std::error::Error;
use std::path::PathBuf;
use std::sync::Arc;

use kempf::prelude::*;

/// Least squares of ψ̈ = (K/T) δ − (1/T) ψ̇ on central differences of the heading, without rudder bias.
struct Differences;

impl Identifier for Differences {
    fn id(&self) -> &'static str {
        "differences"
    }

    fn summary(&self) -> &'static str {
        "regression on differences of the heading"
    }

    fn identify(&self, trials: &[Trial]) -> Result<Estimate, IdentifyError> {
        let mut sums = [0.0; 5];
        for trial in trials {
            let (time, heading, rudder) = (trial.time(), trial.heading(), trial.rudder());
            // A step of 5 s or more keeps the change of heading above its noise.
            let step = (5.0 / trial.sampling_period()).ceil() as usize;
            for row in step..trial.len().saturating_sub(step) {
                let (before, after) = (row - step, row + step);
                let half = 0.5 * (time[after] - time[before]);
                let rate = (heading[after] - heading[before]) / (2.0 * half);
                let acceleration = (heading[after] - 2.0 * heading[row] + heading[before]) / (half * half);
                if acceleration.is_finite() {
                    let x = [rudder[row], -rate];
                    let terms = [x[0] * x[0], x[0] * x[1], x[1] * x[1], x[0] * acceleration, x[1] * acceleration];
                    sums.iter_mut().zip(terms).for_each(|(sum, term)| *sum += term);
                }
            }
        }
        let [aa, ab, bb, ay, by] = sums;
        let determinant = aa * bb - ab * ab;
        if determinant <= 0.0 {
            return Err(IdentifyError::NoTrial);
        }
        let slope = (ay * bb - by * ab) / determinant;
        let inverse_time = (by * aa - ay * ab) / determinant;
        Ok(Estimate {
            response: FirstOrder::from_indices(slope / inverse_time, 1.0 / inverse_time, 0.0),
            uncertainty: Uncertainty::None { reason: "differences have correlated errors" },
            robust_covariance: None,
            stop: StopReason::Direct,
            evaluations: 1,
            noise: None,
            diagnostics: Vec::new(),
            warnings: Vec::new(),
        })
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    let path = std::env::args_os().nth(1).unwrap_or_else(|| "scenarios/yukun.toml".into());
    let study = Scenario::read(&PathBuf::from(path), None)?.with_identifier("differences", Arc::new(Differences))?;
    let (design, rows) = collect_in_memory(&study);
    let summary = summarise(&rows, &design);
    println!("{:28} median size of the error of T [%]", "method");
    for (method, performance) in design.methods.iter().zip(&summary.overall) {
        let size =
            performance.t.median_absolute_error.map_or("no answer".to_owned(), |size| format!("{:.3}", size.value));
        println!("{:28} {size}", method.label);
    }
    Ok(())
}
