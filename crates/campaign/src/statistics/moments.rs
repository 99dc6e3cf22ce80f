//! Running central moments of one quantity, up to the fourth, without its values.

/// Running central moments of a quantity, up to the fourth (Pébay 2008).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Moments {
    /// Number of values.
    pub count: f64,
    /// Arithmetic mean of the values, in their unit; 0 without values.
    pub mean: f64,
    /// Σ (x − mean)².
    pub squared_deviation_sum: f64,
    /// Σ (x − mean)³.
    pub cubed_deviation_sum: f64,
    /// Σ (x − mean)⁴.
    pub fourth_power_sum: f64,
    /// Minimum value; infinite without values.
    pub min_value: f64,
}

impl Default for Moments {
    fn default() -> Self {
        Self {
            count: 0.0,
            mean: 0.0,
            squared_deviation_sum: 0.0,
            cubed_deviation_sum: 0.0,
            fourth_power_sum: 0.0,
            min_value: f64::INFINITY,
        }
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
        self.fourth_power_sum += term * step * step * (n * n - 3.0 * n + 3.0)
            + 6.0 * step * step * self.squared_deviation_sum
            - 4.0 * step * self.cubed_deviation_sum;
        self.cubed_deviation_sum += term * step * (n - 2.0) - 3.0 * step * self.squared_deviation_sum;
        self.squared_deviation_sum += term;
        self.min_value = self.min_value.min(x);
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
        self.fourth_power_sum += other.fourth_power_sum
            + square * square * a * q * (a * a - a * b + b * b) / (n * n)
            + 6.0 * square * (p * p * other.squared_deviation_sum + q * q * self.squared_deviation_sum)
            + 4.0 * delta * (p * other.cubed_deviation_sum - q * self.cubed_deviation_sum);
        self.cubed_deviation_sum += other.cubed_deviation_sum
            + square * delta * a * q * (a - b) / n
            + 3.0 * delta * (p * other.squared_deviation_sum - q * self.squared_deviation_sum);
        self.mean += delta * b / n;
        self.squared_deviation_sum += other.squared_deviation_sum + square * a * b / n;
        self.count = n;
        self.min_value = self.min_value.min(other.min_value);
    }

    /// Standard deviation; 0 below two values.
    pub fn sd(&self) -> f64 {
        if self.count > 1.0 { (self.squared_deviation_sum / (self.count - 1.0)).sqrt() } else { 0.0 }
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
            let actual = [
                moments.mean,
                moments.squared_deviation_sum,
                moments.cubed_deviation_sum,
                moments.fourth_power_sum,
                moments.min_value,
            ];
            let expected = [6.0, central(2), central(3), central(4), 3.0];
            assert!(actual.iter().zip(expected).all(|(x, y)| (x - y).abs() < 1e-10), "{actual:?}");
            assert!((moments.sd() - 8.5_f64.sqrt()).abs() < 1e-12);
        }
    }
}
