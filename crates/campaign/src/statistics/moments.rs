//! Running central moments of one quantity, up to the fourth, without its values.

/// Running central moments of a quantity, up to the fourth (Pébay 2008).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Moments {
    /// Number of values.
    pub count: f64,
    /// Mean.
    pub mean: f64,
    /// Σ (x − mean)².
    pub second: f64,
    /// Σ (x − mean)³.
    pub third: f64,
    /// Σ (x − mean)⁴.
    pub fourth: f64,
    /// Minimum value; infinite without values.
    pub smallest: f64,
}

impl Default for Moments {
    fn default() -> Self {
        Self { count: 0.0, mean: 0.0, second: 0.0, third: 0.0, fourth: 0.0, smallest: f64::INFINITY }
    }
}

impl FromIterator<f64> for Moments {
    fn from_iter<I: IntoIterator<Item = f64>>(values: I) -> Self {
        let mut moments = Self::default();
        values.into_iter().for_each(|value| moments.add(value));
        moments
    }
}

impl Moments {
    /// Adds a value.
    pub fn add(&mut self, x: f64) {
        let before = self.count;
        self.count += 1.0;
        let n = self.count;
        let delta = x - self.mean;
        let step = delta / n;
        let term = delta * step * before;
        self.mean += step;
        self.fourth +=
            term * step * step * (n * n - 3.0 * n + 3.0) + 6.0 * step * step * self.second - 4.0 * step * self.third;
        self.third += term * step * (n - 2.0) - 3.0 * step * self.second;
        self.second += term;
        self.smallest = self.smallest.min(x);
    }

    /// Adds the moments of other values.
    pub fn merge(&mut self, other: &Self) {
        let (a, b) = (self.count, other.count);
        let n = a + b;
        if n == 0.0 {
            return;
        }
        let delta = other.mean - self.mean;
        let (p, q) = (a / n, b / n);
        let square = delta * delta;
        self.fourth += other.fourth
            + square * square * a * q * (a * a - a * b + b * b) / (n * n)
            + 6.0 * square * (p * p * other.second + q * q * self.second)
            + 4.0 * delta * (p * other.third - q * self.third);
        self.third +=
            other.third + square * delta * a * q * (a - b) / n + 3.0 * delta * (p * other.second - q * self.second);
        self.mean += delta * b / n;
        self.second += other.second + square * a * b / n;
        self.count = n;
        self.smallest = self.smallest.min(other.smallest);
    }

    /// Standard deviation; 0 below two values.
    pub fn sd(&self) -> f64 {
        if self.count > 1.0 { (self.second / (self.count - 1.0)).sqrt() } else { 0.0 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Comparison with the sums over all values.
    #[test]
    fn joined_parts_have_the_moments_of_the_whole() {
        let values = [3.0_f64, 5.0, 4.0, 10.0, 8.0];
        let of = |values: &[f64]| {
            let mut moments = Moments::default();
            values.iter().for_each(|&value| moments.add(value));
            moments
        };
        let mut joined = of(&values[..2]);
        joined.merge(&of(&values[2..]));
        let central = |p: i32| values.iter().map(|value| (value - 6.0).powi(p)).sum::<f64>();
        for moments in [joined, of(&values)] {
            let actual = [moments.mean, moments.second, moments.third, moments.fourth, moments.smallest];
            let expected = [6.0, central(2), central(3), central(4), 3.0];
            assert!(actual.iter().zip(expected).all(|(x, y)| (x - y).abs() < 1e-10), "{actual:?}");
            assert!((moments.sd() - 8.5_f64.sqrt()).abs() < 1e-12);
        }
    }
}
