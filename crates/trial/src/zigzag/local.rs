//! Local least-squares polynomials: value, slope, peak and crossings of a sampled signal near an instant, each with its
//! gain for white noise. The width of the fit is chosen in `heading`.
//!
//! Source: Savitzky & Golay (1964), Smoothing and differentiation of data by simplified least squares procedures,
//! doi:10.1021/ac60214a047.

use nalgebra::{SMatrix, SVector};

use document::Quantity;

/// Polynomial with `N` coefficients, fitted with equal weights to the samples within `half_width` of `centre`.
///
/// y(t) = Σ cₖ xᵏ, x = (t − centre)/half_width, k = 0..N−1.
#[derive(Debug, Clone)]
pub(super) struct LocalPolynomial<const N: usize> {
    pub centre: f64,
    pub half_width: f64,
    /// Number of samples in the window.
    pub samples: usize,
    coefficients: SVector<f64, N>,
    /// (XᵀX)⁻¹: the covariance of the coefficients over the noise variance.
    inverse_gram: SMatrix<f64, N, N>,
}

/// Local parabola.
pub(super) type Parabola = LocalPolynomial<3>;
/// Local cubic.
pub(super) type Cubic = LocalPolynomial<4>;

impl<const N: usize> LocalPolynomial<N> {
    /// Fit to the samples within `half_width` of `centre`; NaN values are skipped.
    ///
    /// `None` if the window contains fewer than `N` values or they do not determine the polynomial. `time` must
    /// increase.
    pub fn fit(time: &[f64], value: &[f64], centre: f64, half_width: f64) -> Option<Self> {
        // Times such as 0.1 k have rounding errors: a sample at the edge of the window counts as inside.
        let reach = half_width * (1.0 + 1e-9);
        let first = time.partition_point(|&t| t < centre - reach);
        let last = time.partition_point(|&t| t <= centre + reach);
        let mut gram = SMatrix::<f64, N, N>::zeros();
        let mut right = SVector::<f64, N>::zeros();
        let mut samples = 0;
        for (&t, &y) in time[first..last].iter().zip(&value[first..last]) {
            if !y.is_finite() {
                continue;
            }
            let powers = powers::<N>((t - centre) / half_width);
            gram += powers * powers.transpose();
            right += powers * y;
            samples += 1;
        }
        if samples < N {
            return None;
        }
        let inverse_gram = gram.cholesky()?.inverse();
        let coefficients = inverse_gram * right;
        coefficients.iter().all(|c| c.is_finite()).then_some(Self {
            centre,
            half_width,
            samples,
            coefficients,
            inverse_gram,
        })
    }

    /// Value at time `t`.
    pub fn value(&self, t: f64) -> f64 {
        self.coefficients.dot(&powers(self.x(t)))
    }

    /// Slope at time `t`, per second.
    pub fn slope(&self, t: f64) -> f64 {
        self.coefficients.dot(&slopes(self.x(t))) / self.half_width
    }

    /// Second derivative at time `t`, per second squared.
    pub fn curvature(&self, t: f64) -> f64 {
        let x = self.x(t);
        let mut sum = 0.0;
        for k in (2..N).rev() {
            sum = sum * x + (k * (k - 1)) as f64 * self.coefficients[k];
        }
        sum / (self.half_width * self.half_width)
    }

    /// Standard deviation of [`value`](Self::value) per unit standard deviation of white noise.
    pub fn value_gain(&self, t: f64) -> f64 {
        let powers = powers::<N>(self.x(t));
        powers.dot(&(self.inverse_gram * powers)).max(0.0).sqrt()
    }

    /// Standard deviation of [`slope`](Self::slope) per unit standard deviation of white noise, 1/s.
    pub fn slope_gain(&self, t: f64) -> f64 {
        let slopes = slopes::<N>(self.x(t));
        slopes.dot(&(self.inverse_gram * slopes)).max(0.0).sqrt() / self.half_width
    }

    /// Value at time `t`, with its standard deviation if `noise` gives that of the white noise.
    pub fn value_at(&self, t: f64, noise: Option<f64>) -> Quantity {
        Quantity::new(self.value(t), noise.map(|sd| sd * self.value_gain(t)))
    }

    /// Slope at time `t`, per second, with its standard deviation if `noise` gives that of the white noise.
    pub fn slope_at(&self, t: f64, noise: Option<f64>) -> Quantity {
        Quantity::new(self.slope(t), noise.map(|sd| sd * self.slope_gain(t)))
    }

    /// Time `t` of a stationary point, s, with its standard deviation if `noise` gives that of the white noise.
    pub fn time_of_peak(&self, t: f64, noise: Option<f64>) -> Quantity {
        Quantity::new(t, noise.map(|sd| sd * self.slope_gain(t) / self.curvature(t).abs()))
    }

    /// Time `t` of a crossing, s, with its standard deviation if `noise` gives that of the white noise.
    pub fn time_of_crossing(&self, t: f64, noise: Option<f64>) -> Quantity {
        Quantity::new(t, noise.map(|sd| sd * self.value_gain(t) / self.slope(t).abs()))
    }

    /// Time near the centre, s, at which the polynomial has the value `level`; `None` if Newton's iteration leaves
    /// the window.
    pub fn crossing(&self, level: f64) -> Option<f64> {
        let mut t = self.centre;
        for _ in 0..20 {
            let step = (level - self.value(t)) / self.slope(t);
            let x = self.x(t + step).abs();
            // A flat signal gives 0/0, NaN.
            if x.is_nan() || x > 1.0 + 1e-9 {
                return None;
            }
            t += step;
            if step.abs() <= 1e-12 * self.half_width {
                break;
            }
        }
        Some(t)
    }

    /// Time, s, of the stationary point of a parabola or cubic at which the curvature has the sign of that at the
    /// centre; `None` if it is outside the window or does not exist.
    pub fn stationary_point(&self) -> Option<f64> {
        let [c1, c2, c3] = [1, 2, 3].map(|k| self.coefficients.get(k).copied().unwrap_or(0.0));
        // c₁ + 2 c₂ x + 3 c₃ x² = 0, in the form that is regular at c₃ = 0.
        let x = -c1 / (c2 + (c2 * c2 - 3.0 * c1 * c3).sqrt().copysign(c2));
        // NaN, from a cubic without a stationary point or a flat signal, fails the comparison.
        (x.abs() <= 1.0 + 1e-9).then_some(self.centre + self.half_width * x)
    }

    fn x(&self, t: f64) -> f64 {
        (t - self.centre) / self.half_width
    }
}

fn powers<const N: usize>(x: f64) -> SVector<f64, N> {
    let mut power = 1.0;
    SVector::from_fn(|_, _| {
        let this = power;
        power *= x;
        this
    })
}

fn slopes<const N: usize>(x: f64) -> SVector<f64, N> {
    let mut power = 1.0;
    SVector::from_fn(|k, _| {
        if k == 0 {
            return 0.0;
        }
        let this = k as f64 * power;
        power *= x;
        this
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    fn samples(function: impl Fn(f64) -> f64) -> (Vec<f64>, Vec<f64>) {
        // Uneven, with a missing value.
        let time: Vec<f64> = (0..40).map(|k| 0.5 * f64::from(k) + 0.1 * f64::from(k % 3)).collect();
        let mut value: Vec<f64> = time.iter().map(|&t| function(t)).collect();
        value[19] = f64::NAN;
        (time, value)
    }

    #[test]
    fn a_cubic_is_recovered_with_its_peak_and_crossing() {
        let (time, value) = samples(|t| (t - 4.0) * (t - 9.0) * (t - 30.0) / 100.0);
        let fit = Cubic::fit(&time, &value, 8.0, 3.0).expect("enough samples");
        assert_relative_eq!(fit.value(7.0), 3.0 * -2.0 * -23.0 / 100.0, max_relative = 1e-10);
        assert_relative_eq!(fit.crossing(0.0).expect("crosses"), 9.0, max_relative = 1e-10);
        let peak = Cubic::fit(&time, &value, 6.0, 3.0).expect("enough").stationary_point().expect("has a peak");
        // 3t² − 86t + 426 = 0
        assert_relative_eq!(peak, (86.0 - (86.0_f64 * 86.0 - 12.0 * 426.0).sqrt()) / 6.0, max_relative = 1e-10);
        assert_relative_eq!(fit.curvature(8.0), (6.0 * 8.0 - 86.0) / 100.0, max_relative = 1e-9);
    }

    /// On a dense symmetric window the slope of a line fit has the variance 3σ²/(n h²), and its value σ²/n.
    #[test]
    fn gains_are_those_of_the_textbook() {
        let time: Vec<f64> = (-500..=500).map(|k| 0.01 * f64::from(k)).collect();
        let fit = LocalPolynomial::<2>::fit(&time, &vec![1.0; 1001], 0.0, 5.0).expect("enough samples");
        assert_relative_eq!(fit.value_gain(0.0), 1001.0_f64.sqrt().recip(), max_relative = 1e-6);
        assert_relative_eq!(fit.slope_gain(0.0), (3.0_f64 / 1001.0).sqrt() / 5.0, max_relative = 2e-3);
    }

    #[test]
    fn too_few_samples_or_no_crossing_give_nothing() {
        let (time, value) = samples(|t| t);
        assert!(Cubic::fit(&time, &value, 8.0, 0.5).is_none());
        let fit = Cubic::fit(&time, &value, 8.0, 3.0).expect("enough samples");
        assert_eq!(fit.crossing(20.0), None);
        let flat = Parabola::fit(&time, &vec![0.0; time.len()], 8.0, 3.0).expect("enough samples");
        assert_eq!(flat.stationary_point(), None);
    }
}
