//! Identification of K, T and δ_r from one record, compared with another library.

use std::sync::Arc;

use identify::{IdentifierSettings, fourier_published, registry};
use trial::Trial;

use crate::records::{ROWS, first_order_zig_zag, record};
use crate::work::{Reach, Work, WorkGroup};

/// Reference of the comparison.
const RIVAL: &str = "dsmc SRIVC, heading";

/// Number of triples of the published method in its second variant, and the name of this variant.
const TRIPLES: usize = 200;
const MANY_TRIPLES: &str = "fourier-published, 200 triples";

/// Maximum accepted relative error of K and T. The published Fourier method gives T 14 to 20 % too low even without
/// noise.
fn tolerance(method: &str) -> f64 {
    match method {
        "fourier-published" => 0.6,
        "characteristic-points" | "least-squares" => 0.15,
        _ => 0.02,
    }
}

/// Maximum time, relative to the rival library; `None` for a method without a limit.
fn reach(method: &str) -> Option<Reach> {
    let share = match method {
        "output-error" => 0.5,
        "srivc" => 1.0,
        "integral-least-squares" => 0.1,
        "fourier-projected" => 4.0,
        "fourier-published" | MANY_TRIPLES => 8.0,
        // Four kinds of noise; the readings include the gyro.
        "maximum-likelihood" => 8.0,
        _ => return None,
    };
    Some(Reach::Ratio(share))
}

/// Work of a method on a record, with a name.
fn identifying(name: &str, settings: IdentifierSettings, trial: &Arc<Trial>) -> Work {
    let method = settings.build().expect("valid settings");
    let (id, trial) = (method.id(), Arc::clone(trial));
    Work::answering(name, tolerance(id), move || {
        let estimate = method.identify(std::slice::from_ref(&*trial)).ok()?;
        Some([estimate.response.K(), estimate.response.T()])
    })
}

/// Benchmarks of every method with default settings on one record, and of the published method with many triples.
pub fn identification() -> WorkGroup {
    let mut group = WorkGroup::new(
        "identify",
        "Identification",
        "One record of 1201 rows (10/10, 600 s at 0.5 s, K 0.08 1/s, T 25 s, heading noise 0.1 deg, gyro noise 0.02 deg/s), on \
         one core. Ours give K, T and the rudder bias with covariance, diagnostics and a typed reason where they fail. Beside \
         them stands SRIVC of dsmc 0.27 on the heading (one integrator, order one, first-order hold, \
         started at 0.1 rad/s; a good start is 1/T of the ship), which gives K and T alone.",
    );
    let trial = Arc::new(record(&first_order_zig_zag(ROWS)));
    #[cfg(feature = "rivals")]
    by_rivals(&mut group, &trial);
    for settings in registry::default_settings() {
        let id = settings.build().expect("default settings are valid").id();
        group.beside(identifying(id, settings, &trial), RIVAL, reach(id));
    }
    let many = fourier_published::Settings { triples: TRIPLES, ..fourier_published::Settings::default() };
    let many = identifying(MANY_TRIPLES, IdentifierSettings::FourierPublished(many), &trial);
    group.beside(many, RIVAL, reach(MANY_TRIPLES));
    group
}

/// Adds the benchmarks of another library on a record with a gyro.
#[cfg(feature = "rivals")]
fn by_rivals(group: &mut WorkGroup, trial: &Trial) {
    use crate::records::{PERIOD, T};

    let yaw_rate = trial.channel(trial::Channel::YawRate).expect("a record with a gyro").to_vec();
    let (rudder, heading) = (trial.rudder().to_vec(), trial.heading().to_vec());
    let within = 0.02;
    let srivc = |name: &str, bandwidth: f64| {
        let (u, y) = (rudder.clone(), heading.clone());
        Work::answering(name, within, move || rivals::srivc_heading(&u, &y, PERIOD, bandwidth))
    };
    group.alone(srivc(RIVAL, rivals::BANDWIDTH), None);
    group.beside(srivc("dsmc SRIVC, good start", 1.0 / T), RIVAL, None);
    let (u, y) = (rudder.clone(), yaw_rate.clone());
    let gyro = Work::answering("dsmc SRIVC, gyro", within, move || rivals::srivc_gyro(&u, &y, PERIOD));
    group.beside(gyro, RIVAL, None);
    let output_error = move || rivals::output_error_gyro(&rudder, &yaw_rate, PERIOD);
    group.beside(Work::answering("dsmc output error, gyro", within, output_error), RIVAL, None);
}
