//! Number with its uncertainty, for records, estimates, models and files.

use serde::{Deserialize, Deserializer, Serialize};

/// Number with its standard deviation (GUM: standard uncertainty) and its 95 % interval, as far as known.
///
/// For a quantity read from a record, `sd` includes the white noise of heading and rudder, but not slow errors such as
/// rate-gyro bias, drift or waves longer than the local fits. For an estimate, both are those of the method.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct Quantity {
    /// Value, in SI units and radians unless a name states otherwise; in files `null` if infinite (T of a
    /// neutrally stable ship), read back as NaN.
    #[serde(deserialize_with = "number_or_null")]
    #[schemars(with = "Option<f64>")]
    pub value: f64,
    /// Standard deviation, in the unit of the value.
    pub sd: Option<f64>,
    /// 95 % interval, if known and bounded.
    pub ci95: Option<[f64; 2]>,
}

fn number_or_null<'de, D: Deserializer<'de>>(from: D) -> Result<f64, D::Error> {
    Ok(Option::deserialize(from)?.unwrap_or(f64::NAN))
}

impl Quantity {
    /// Quantity without an interval.
    pub fn new(value: f64, sd: Option<f64>) -> Self {
        Self { value, sd, ci95: None }
    }

    /// Quantity of unknown uncertainty.
    pub fn without_uncertainty(value: f64) -> Self {
        Self::new(value, None)
    }

    /// Quantity times an exact factor.
    pub fn scaled(self, factor: f64) -> Self {
        let ends = |[low, high]: [f64; 2]| if factor < 0.0 { [high, low] } else { [low, high] };
        Self {
            value: factor * self.value,
            sd: self.sd.map(|sd| factor.abs() * sd),
            ci95: self.ci95.map(|ci95| ends(ci95.map(|end| factor * end))),
        }
    }

    /// Difference of two quantities with independent errors, without an interval; `sd` is `None` if either `sd` is.
    pub fn minus(self, other: Self) -> Self {
        Self::new(self.value - other.value, root_sum_of_squares(self.sd, other.sd))
    }

    /// Quantity with an additional independent error of standard deviation `sd`, without an interval; the result has no
    /// `sd` if either is `None`.
    pub fn widened(self, sd: Option<f64>) -> Self {
        Self::new(self.value, root_sum_of_squares(self.sd, sd))
    }

    /// Mean of quantities with independent errors, without an interval, and without `sd` if one quantity has none;
    /// `None` for an empty list.
    pub fn mean(quantities: &[Self]) -> Option<Self> {
        if quantities.is_empty() {
            return None;
        }
        let n = quantities.len() as f64;
        let value = quantities.iter().map(|quantity| quantity.value).sum::<f64>() / n;
        let variance: Option<f64> = quantities.iter().map(|quantity| quantity.sd.map(|sd| sd * sd)).sum();
        Some(Self::new(value, variance.map(|sum| sum.sqrt() / n)))
    }
}

fn root_sum_of_squares(a: Option<f64>, b: Option<f64>) -> Option<f64> {
    Some(a?.hypot(b?))
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
    fn a_factor_below_zero_turns_the_interval_round() {
        let turned = Quantity { value: 2.0, sd: Some(0.5), ci95: Some([1.0, 3.5]) }.scaled(-2.0);
        assert_eq!(turned, Quantity { value: -4.0, sd: Some(1.0), ci95: Some([-7.0, -2.0]) });
    }
}
