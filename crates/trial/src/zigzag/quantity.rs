//! A number read off a noisy record, with its standard uncertainty.

/// A value read off a record and the standard deviation (GUM: standard uncertainty) that the heading and rudder noise
/// of the record gives it.
///
/// `sd` is `None` where the noise of the record is neither declared nor could be estimated. It covers white noise of
/// the two channels; it does not cover slow errors such as gyro bias, drift or waves longer than the local fits.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Quantity {
    /// The value, in SI units and radians.
    pub value: f64,
    /// Its standard deviation, in the unit of the value.
    pub sd: Option<f64>,
}

impl Quantity {
    pub(super) fn new(value: f64, sd: Option<f64>) -> Self {
        Self { value, sd }
    }

    /// The difference of two quantities whose errors are independent.
    pub(super) fn minus(self, other: Self) -> Self {
        Self { value: self.value - other.value, sd: root_sum_of_squares(self.sd, other.sd) }
    }

    /// The same value with another, independent error added.
    pub(super) fn widened(self, sd: Option<f64>) -> Self {
        Self { sd: root_sum_of_squares(self.sd, sd), ..self }
    }

    /// The same times a factor that has no error.
    pub(super) fn scaled(self, factor: f64) -> Self {
        Self { value: factor * self.value, sd: self.sd.map(|sd| factor.abs() * sd) }
    }

    /// Mean of quantities whose errors are independent; `None` where there are none.
    pub(super) fn mean(quantities: &[Self]) -> Option<Self> {
        if quantities.is_empty() {
            return None;
        }
        let n = quantities.len() as f64;
        let value = quantities.iter().map(|quantity| quantity.value).sum::<f64>() / n;
        let variance: Option<f64> = quantities.iter().map(|quantity| quantity.sd.map(|sd| sd * sd)).sum();
        Some(Self { value, sd: variance.map(|sum| sum.sqrt() / n) })
    }
}

fn root_sum_of_squares(a: Option<f64>, b: Option<f64>) -> Option<f64> {
    Some(a?.hypot(b?))
}

/// Median; the mean of the two middle values where their number is even, so that a mirrored set has the mirrored
/// median.
///
/// `None` for an empty set. The values are reordered and must be finite.
pub(super) fn median(values: &mut [f64]) -> Option<f64> {
    if values.is_empty() {
        return None;
    }
    values.sort_unstable_by(f64::total_cmp);
    let middle = values.len() / 2;
    Some(if values.len() % 2 == 1 { values[middle] } else { 0.5 * (values[middle - 1] + values[middle]) })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn errors_add_in_quadrature_and_an_unknown_one_stays_unknown() {
        let a = Quantity::new(5.0, Some(3.0));
        let b = Quantity::new(1.0, Some(4.0));
        assert_eq!(a.minus(b), Quantity::new(4.0, Some(5.0)));
        assert_eq!(a.minus(Quantity::new(1.0, None)).sd, None);
        assert_eq!(Quantity::mean(&[a, b]), Some(Quantity::new(3.0, Some(2.5))));
        assert_eq!(Quantity::mean(&[]), None);
    }

    #[test]
    fn median_of_a_mirrored_set_is_mirrored() {
        assert_eq!(median(&mut [3.0, 1.0, 2.0, 7.0]), Some(2.5));
        assert_eq!(median(&mut [-3.0, -1.0, -2.0, -7.0]), Some(-2.5));
        assert_eq!(median(&mut []), None);
    }
}
