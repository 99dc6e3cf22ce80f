//! Fitted Fourier curve and its derivatives.

/// Fitted Fourier curve of the heading; time runs from the first observed row of the record.
#[derive(Debug, Clone, PartialEq)]
pub struct FourierSeries {
    /// Fundamental w, rad/s.
    pub fundamental: f64,
    /// Constant term a₀, rad; it is the mean of the record only if the record holds whole periods.
    pub mean: f64,
    /// Cosine coefficients aₙ, n = 1..N, rad.
    pub cosine: Vec<f64>,
    /// Sine coefficients bₙ, n = 1..N, rad.
    pub sine: Vec<f64>,
    /// Share of the variance of the heading explained by the curve.
    pub r_squared: f64,
    /// Condition number of the basis on the instants of the record (√2 for whole periods).
    pub condition: f64,
}

impl FourierSeries {
    /// Heading ψ(t), rad.
    pub fn heading_at(&self, t: f64) -> f64 {
        self.mean + self.sum(t, |_, c, s, a, b| a * c + b * s)
    }

    /// Yaw rate ψ'(t), rad/s.
    pub fn yaw_rate_at(&self, t: f64) -> f64 {
        self.sum(t, |rate, c, s, a, b| rate * (b * c - a * s))
    }

    /// Yaw acceleration ψ''(t), rad/s².
    pub fn yaw_acceleration_at(&self, t: f64) -> f64 {
        self.sum(t, |rate, c, s, a, b| -rate * rate * (a * c + b * s))
    }

    /// Σ of a term of (n w, cos n w t, sin n w t, aₙ, bₙ).
    fn sum(&self, t: f64, term: impl Fn(f64, f64, f64, f64, f64) -> f64) -> f64 {
        let (s1, c1) = (self.fundamental * t).sin_cos();
        let (mut s, mut c) = (s1, c1);
        let mut total = 0.0;
        for (n, (a, b)) in self.cosine.iter().zip(&self.sine).enumerate() {
            total += term((n + 1) as f64 * self.fundamental, c, s, *a, *b);
            (s, c) = (s * c1 + c * s1, c * c1 - s * s1);
        }
        total
    }
}
