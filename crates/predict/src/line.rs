//! A straight line by least squares.

/// Least-squares line y = ȳ + slope (x − x̄) of n points; the residual variance has n − 2 degrees of freedom.
#[derive(Debug, Clone, Copy)]
pub(crate) struct StraightLine {
    /// Mean abscissa and mean ordinate.
    pub mean: [f64; 2],
    /// Slope.
    pub slope: f64,
    /// Sum of squares of the abscissae about their mean.
    spread: f64,
    /// Variance of the residuals.
    variance: f64,
    count: f64,
}

impl StraightLine {
    /// Line through the finite points; `None` for fewer than three points, or if all have one abscissa.
    pub fn through(points: impl Iterator<Item = (f64, f64)>) -> Option<Self> {
        let points: Vec<(f64, f64)> = points.filter(|(_, y)| y.is_finite()).collect();
        let count = points.len() as f64;
        let mean = [points.iter().map(|p| p.0).sum::<f64>() / count, points.iter().map(|p| p.1).sum::<f64>() / count];
        let spread: f64 = points.iter().map(|(x, _)| (x - mean[0]).powi(2)).sum();
        let slope = points.iter().map(|(x, y)| (x - mean[0]) * (y - mean[1])).sum::<f64>() / spread;
        let square: f64 = points.iter().map(|(x, y)| (y - mean[1] - slope * (x - mean[0])).powi(2)).sum();
        let line = Self { mean, slope, spread, variance: square / (count - 2.0), count };
        (points.len() >= 3 && spread > 0.0).then_some(line)
    }

    /// Standard deviation of the slope.
    pub fn slope_sd(&self) -> f64 {
        (self.variance / self.spread).sqrt()
    }

    /// Ordinate at abscissa zero with its standard deviation.
    pub fn at_zero(&self) -> (f64, f64) {
        let [x, y] = self.mean;
        (y - self.slope * x, (self.variance / self.count + self.variance * x * x / self.spread).sqrt())
    }
}
