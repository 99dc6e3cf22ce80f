//! Base: the first-order response with the least heading error, and its replays.

use identify::replay::{Replay, replay};
use identify::{Estimate, Identifier, output_error};
use trial::Trial;

use crate::settings::TraceError;

/// First-order response fitted jointly to one or several records, with its replays.
#[derive(Debug, Clone)]
pub struct FittedBase {
    /// Estimate of K, T and δ_r by `output-error`, which searches both signs of 1/T.
    pub estimate: Estimate,
    /// Replay of every record.
    pub replays: Vec<Replay>,
}

impl FittedBase {
    /// Fits the first-order base; fails if `output-error` gives no estimate or a replay diverges.
    pub fn fit(trials: &[Trial]) -> Result<Self, TraceError> {
        let method = output_error::Settings::default().build().expect("default settings are valid");
        let estimate = method.identify(trials)?;
        let replayed = |trial: &Trial| {
            replay(trial, &estimate.response).ok_or_else(|| TraceError::Replay { trial: trial.name().to_owned() })
        };
        let replays = trials.iter().map(replayed).collect::<Result<_, _>>()?;
        Ok(Self { estimate, replays })
    }

    /// Initial heading (rad) and yaw rate (rad/s) of every replay.
    pub fn initial(&self) -> Vec<[f64; 2]> {
        self.replays.iter().map(Replay::initial_state).collect()
    }

    /// Mean square of the heading residual over all records, rad².
    pub fn mean_square(&self) -> f64 {
        let (sum, rows) = self.replays.iter().fold((0.0, 0.0), |(sum, rows), replay| {
            let count = replay.observed_residuals().count() as f64;
            (sum + replay.rms().powi(2) * count, rows + count)
        });
        sum / rows
    }
}
