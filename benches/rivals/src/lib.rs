//! K and T by methods of the crate `dsmc`, the only other Rust library known to us that identifies continuous-time
//! models from samples. Orders are fixed as a user who knows the ship would fix them; none of its methods gives a
//! rudder bias or an interval of K and T, which ours do in the time that is compared.

use dsmc::system_identification::arx::Arx;
use dsmc::system_identification::iv::srivc::{
    Initialization, InterSample, Prefilter, SrivcOptions, identify, identify_with_prefilter,
};
use dsmc::system_identification::oe;

/// Bandwidth that a search starts from when the ship is unknown, rad/s: between that of a tanker and that of a boat. It
/// takes three iterations from here and from most other starts, two from close to 1/T.
pub const BANDWIDTH: f64 = 0.1;

/// Cut-off of the prefilter, rad/s: a third of the frequency of the zig-zag, as the documentation of the crate advises.
const CUTOFF: f64 = 0.02;

/// SRIV iterations before output error; its documentation recommends to start so.
const SRIV_ITERATIONS: usize = 10;

fn options() -> SrivcOptions<f64> {
    SrivcOptions { input_intersample: InterSample::FirstOrderHold, ..SrivcOptions::default() }
}

/// K/T and 1/T to K and T.
fn indices(theta: &[f64]) -> [f64; 2] {
    [theta[1] / theta[0], 1.0 / theta[0]]
}

/// SRIVC of K/(s (1 + T s)) from heading and rudder, `period` s apart: order one and one integrator, rudder linear
/// between samples; the search starts from `bandwidth`, rad/s. `None` if it gives no answer.
pub fn srivc_heading(rudder: &[f64], heading: &[f64], period: f64, bandwidth: f64) -> Option<[f64; 2]> {
    let prefilter = Prefilter::new(1, CUTOFF).ok()?;
    let start = Initialization::StateVariableFilter(bandwidth);
    let fit = identify_with_prefilter(rudder, heading, period, 1, 0, &prefilter, &start, &options()).ok()?;
    Some(indices(fit.parameter.as_slice()))
}

/// SRIVC of K/(1 + T s) from yaw rate and rudder, as in [`srivc_heading`], from a start at [`BANDWIDTH`].
pub fn srivc_gyro(rudder: &[f64], yaw_rate: &[f64], period: f64) -> Option<[f64; 2]> {
    let start = Initialization::StateVariableFilter(BANDWIDTH);
    let fit = identify(rudder, yaw_rate, period, 1, 0, &start, &options()).ok()?;
    Some(indices(fit.parameter.as_slice()))
}

/// Output error of rₖ = f rₖ₋₁ + b₀ δₖ + b₁ δₖ₋₁ from yaw rate and rudder; T = −period/ln f, K = (b₀ + b₁)/(1 − f).
pub fn output_error_gyro(rudder: &[f64], yaw_rate: &[f64], period: f64) -> Option<[f64; 2]> {
    let start = oe::Initialization::Sriv(SRIV_ITERATIONS);
    let fit = oe::identify(rudder, yaw_rate, &Arx::new(1, 1), &start, &oe::OeOptions::default()).ok()?;
    let [f, b0, b1] = fit.model.parameter.as_slice() else { return None };
    Some([(b0 + b1) / (1.0 - f), -period / f.ln()])
}

#[cfg(test)]
mod tests {
    use rand::{SeedableRng, rngs::ChaCha12Rng};
    use rand_distr::{Distribution, Normal};

    use super::*;

    const K: f64 = 0.08;
    const T: f64 = 25.0;
    const PERIOD: f64 = 0.5;

    /// Rudder, heading and yaw rate of a 10/10 zig-zag of 600 s, steps of ten in a period, with the noise of sensors.
    fn zig_zag() -> [Vec<f64>; 3] {
        let (step, rate) = (0.1 * PERIOD, 2.5_f64.to_radians());
        let mut chance = ChaCha12Rng::seed_from_u64(1957);
        let mut noise = |sd: f64| Normal::new(0.0, sd).expect("a width").sample(&mut chance);
        let (mut delta, mut psi, mut r, mut order) = (0.0_f64, 0.0_f64, 0.0_f64, 10.0_f64.to_radians());
        let mut columns = [Vec::new(), Vec::new(), Vec::new()];
        for number in 0..12_010 {
            if number % 10 == 0 {
                let row = [delta, psi + noise(0.1_f64.to_radians()), r + noise(0.02_f64.to_radians())];
                columns.iter_mut().zip(row).for_each(|(column, value)| column.push(value));
            }
            if psi * order > 0.0 && psi.abs() > order.abs() {
                order = -order;
            }
            let before = delta;
            delta += (order - delta).clamp(-rate * step, rate * step);
            // Exact where the rudder stands at the middle of its step.
            let steady = K * 0.5 * (before + delta);
            let kept = (-step / T).exp();
            psi += steady * step + T * (r - steady) * (1.0 - kept);
            r = steady + (r - steady) * kept;
        }
        columns
    }

    /// A comparison of times is only fair between methods that answer the same question rightly.
    #[test]
    fn rivals_find_the_ship() {
        let [rudder, heading, yaw_rate] = zig_zag();
        for (name, fit, within) in [
            ("SRIVC, heading", srivc_heading(&rudder, &heading, PERIOD, BANDWIDTH), 0.01),
            ("SRIVC, gyro", srivc_gyro(&rudder, &yaw_rate, PERIOD), 0.01),
            ("output error, gyro", output_error_gyro(&rudder, &yaw_rate, PERIOD), 0.01),
        ] {
            let [k, t] = fit.expect(name);
            assert!((k / K - 1.0).abs() < within && (t / T - 1.0).abs() < within, "{name}: K {k} 1/s, T {t} s");
        }
    }
}
