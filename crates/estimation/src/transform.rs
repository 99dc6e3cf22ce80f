//! Discrete Fourier transform of real numbers, compiled here once: the underlying library is generic, and every crate
//! that calls it directly would compile all algorithms again.

use realfft::RealFftPlanner;
pub use realfft::num_complex::Complex;

/// Squared magnitudes |X_k|² of the discrete Fourier transform of the N values `x`, k = 0 … N/2, not divided by N: N
/// times Ljung's periodogram. Overwrites `x`; empty for an empty `x`.
pub fn power_spectrum(x: &mut [f64]) -> Vec<f64> {
    fourier_transform(x).into_iter().map(|z| z.norm_sqr()).collect()
}

/// Discrete Fourier transform of `x`, from frequency zero to the Nyquist frequency: bin k has k periods over the length
/// of `x`. Overwrites `x`; empty for an empty `x`.
pub fn fourier_transform(x: &mut [f64]) -> Vec<Complex<f64>> {
    if x.is_empty() {
        return Vec::new();
    }
    let transform = RealFftPlanner::<f64>::new().plan_fft_forward(x.len());
    let mut spectrum = transform.make_output_vec();
    transform.process(x, &mut spectrum).expect("both buffers have the lengths that the plan asks for");
    spectrum
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;
    use std::f64::consts::TAU;

    #[test]
    fn power_is_that_of_the_definition() {
        for rows in [1, 2, 7, 30, 97] {
            let x: Vec<f64> = (0..rows).map(|k| (0.7 * k as f64).sin() + 0.2).collect();
            let bins = power_spectrum(&mut x.clone());
            assert_eq!(bins.len(), rows / 2 + 1);
            for (bin, value) in bins.into_iter().enumerate() {
                let part = |of: fn(f64) -> f64| {
                    let angle = |k: usize| TAU * (bin * k) as f64 / rows as f64;
                    x.iter().enumerate().map(|(k, x)| x * of(angle(k))).sum::<f64>()
                };
                assert_relative_eq!(value, part(f64::cos).powi(2) + part(f64::sin).powi(2), epsilon = 1e-9);
            }
        }
        assert!(power_spectrum(&mut []).is_empty());
    }
}
