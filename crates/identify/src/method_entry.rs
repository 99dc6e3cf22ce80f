//! Document entries for the estimates of methods, as in `fit.json`.

use document::method::{IndexEstimates, MethodEntry, MethodStatus};
use ship::angle::to_deg;
use trial::Trial;

use crate::error::IdentifyError;
use crate::estimate::Estimate;
use crate::replay::pooled_response_rms;

/// Entry of a successful fit.
///
/// `heading_rmse_deg` is the rms heading error of the replay, deg, `None` without a finite replay. Diagnostics that are
/// not finite are left out.
pub fn success_entry(method: &str, estimate: &Estimate, heading_rmse_deg: Option<f64>) -> MethodEntry {
    let diagnostics = estimate.diagnostics.iter().filter(|(_, value)| value.is_finite());
    MethodEntry {
        method: method.to_owned(),
        status: MethodStatus::Ok,
        parameters: Some(IndexEstimates {
            k_per_s: estimate.K(),
            t_s: estimate.T(),
            delta_r_deg: estimate.rudder_bias().scaled(to_deg(1.0)),
        }),
        course_unstable: estimate.response.is_course_unstable(),
        heading_rmse_deg,
        noise: estimate.noise,
        diagnostics: diagnostics.map(|&(name, value)| (name.to_owned(), value)).collect(),
        stop: Some(estimate.stop.as_str().to_owned()),
        ..MethodEntry::default()
    }
}

/// Entry of a failed fit: the reason as a sentence and as a kind.
pub fn failure_entry(method: &str, error: &IdentifyError) -> MethodEntry {
    let (reason, failure) = (Some(error.to_string()), Some(error.kind().to_owned()));
    MethodEntry { method: method.to_owned(), reason, failure, ..MethodEntry::default() }
}

/// Document entry of one method, `label`, and its estimate; `None` for a failed fit.
pub fn method_entry(
    label: &str,
    answer: Result<Estimate, IdentifyError>,
    trials: &[Trial],
) -> (MethodEntry, Option<Estimate>) {
    match answer {
        Ok(estimate) => (
            success_entry(label, &estimate, pooled_response_rms(trials, &estimate.response).map(to_deg)),
            Some(estimate),
        ),
        Err(error) => (failure_entry(label, &error), None),
    }
}
