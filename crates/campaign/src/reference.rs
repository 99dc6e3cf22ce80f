//! Reference of a trial: true responses, Cramér–Rao bound, and a validation manoeuvre outside all fits.

use identify::replay::replay;
use identify::{Identifier, output_error};
use ship::FirstOrder;
use simulate::recording::RudderSource;
use simulate::{Disturbances, Recording, Sensors, SimulatedTrial, Simulation, StreamKey};
use trial::Trial;

use crate::bound::{CramerRaoBound, cramer_rao_bound};
use crate::scenario::{SampledSpecification, Specification};

/// Reference for the estimates of a trial: true responses, Cramér–Rao bound and validation manoeuvre.
#[derive(Default)]
pub struct TrialReference {
    /// First-order response nearest to the ship, or the ship itself if it is first order; `None` if the fit fails.
    pub nearest: Option<FirstOrder>,
    /// First-order base of a response ship with effects; `None` for a first-order ship or a hull.
    pub base: Option<FirstOrder>,
    /// Cramér–Rao bound of this trial; `None` as in [`cramer_rao_bound`], and without a nearest response.
    pub cramer_rao_bound: Option<CramerRaoBound>,
    /// Second manoeuvre outside the fit: simulated without disturbance and measurement noise, or a measured record
    /// without heading spikes; `None` without validation.
    pub validation: Option<Trial>,
    /// Expected 2 ln Λ, with the likelihood ratio Λ of the truth to the nearest first-order response; `None` without a
    /// trace, and unless the heading noise is white.
    pub expected_2_ln_lambda: Option<f64>,
}

impl TrialReference {
    /// Reference of a simulated trial; `traces` states whether a trace is among the methods.
    pub fn from_simulated(
        trial_spec: &SampledSpecification,
        simulated: &[SimulatedTrial],
        key: &StreamKey,
        traces: bool,
    ) -> Self {
        let Specification { simulation, validation, true_response: truth, base_response: base, .. } =
            &*trial_spec.specification;
        let near = if truth.is_none() || traces { nearest_first_order(&trial_spec.specification, key) } else { None };
        let nearest = truth.or_else(|| near.as_ref().map(|near| near.response));
        let base = base.filter(|_| truth.is_none());
        let sd = simulation.sensors.declared_noise().heading_sd;
        let simulations = || trial_spec.specification.records(key).map(|(simulation, _)| simulation);
        let cramer_rao_bound = nearest.and_then(|nearest| cramer_rao_bound(simulations(), simulated, &nearest));
        let validation = validation.as_ref().and_then(|simulation| simulation.run(key).ok());
        // The expected 2 ln Λ is computed for white heading noise only.
        let Sensors { heading_wander, heading_every_rows, .. } = simulation.sensors;
        let white = sd.filter(|_| heading_wander.is_none());
        let ratio = |(near, sd): (NearestResponse, f64)| {
            near.mean_square / (sd * sd) * near.rows.div_ceil(heading_every_rows.unwrap_or(1)) as f64
        };
        let expected_2_ln_lambda = near.filter(|_| traces).zip(white).map(ratio);
        let validation = validation.map(|simulated| simulated.trial);
        Self { nearest, base, cramer_rao_bound, validation, expected_2_ln_lambda }
    }
}

/// Output-error fit of a first-order response to undisturbed, noise-free records of a trial.
pub struct NearestResponse {
    /// Response.
    pub response: FirstOrder,
    /// Mean square heading error, rad².
    mean_square: f64,
    /// Number of rows of all records.
    rows: usize,
}

/// First-order response nearest to a ship in the manoeuvres of a trial, by output error (Ljung 1999); `None` if a
/// simulation or the fit fails.
pub fn nearest_first_order(specification: &Specification, key: &StreamKey) -> Option<NearestResponse> {
    let calm = |(simulation, key): (&Simulation, StreamKey)| {
        let calm = Simulation {
            disturbances: Disturbances::default(),
            sensors: Sensors::default(),
            recording: Recording { rudder: RudderSource::Feedback, assumed_rudder_rate: None, ..simulation.recording },
            ..simulation.clone()
        };
        Some(calm.run(&key).ok()?.trial)
    };
    let trials: Vec<Trial> = specification.records(key).map(calm).collect::<Option<_>>()?;
    let method = output_error::Settings::default().build().ok()?;
    let response = method.identify(&trials).ok()?.response;
    let residuals: Vec<Vec<f64>> =
        trials.iter().map(|trial| Some(replay(trial, &response)?.residual)).collect::<Option<_>>()?;
    let rows = residuals.iter().map(Vec::len).sum();
    let square: f64 = residuals.iter().flatten().map(|e| e * e).sum();
    Some(NearestResponse { response, mean_square: square / rows as f64, rows })
}
