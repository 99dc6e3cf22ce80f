//! Points handed to a figure. They are plain numbers in display units; nothing here interpolates or fits.

use serde::{Deserialize, Deserializer, Serialize, Serializer};

/// A curve or a cloud of points: `y[i]` at `x[i]`, in the units the figure states.
///
/// A pair with an undefined (NaN or infinite) number is a gap: it is skipped, and a line is broken there. When the
/// lengths differ the surplus is ignored. In JSON a gap is `null`.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Curve {
    /// Abscissae.
    #[serde(serialize_with = "with_gaps", deserialize_with = "from_gaps")]
    pub x: Vec<f64>,
    /// Ordinates.
    #[serde(serialize_with = "with_gaps", deserialize_with = "from_gaps")]
    pub y: Vec<f64>,
}

impl Curve {
    /// A curve from its two columns.
    pub fn new(x: impl Into<Vec<f64>>, y: impl Into<Vec<f64>>) -> Self {
        Self { x: x.into(), y: y.into() }
    }

    /// The pairs, gaps included.
    pub fn pairs(&self) -> impl Iterator<Item = (f64, f64)> + '_ {
        self.x.iter().copied().zip(self.y.iter().copied())
    }

    /// The pairs that can be drawn.
    pub(crate) fn finite(&self) -> impl Iterator<Item = (f64, f64)> + '_ {
        self.pairs().filter(|(x, y)| x.is_finite() && y.is_finite())
    }
}

fn with_gaps<S: Serializer>(values: &[f64], serializer: S) -> Result<S::Ok, S::Error> {
    serializer.collect_seq(values.iter().map(|v| v.is_finite().then_some(*v)))
}

fn from_gaps<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Vec<f64>, D::Error> {
    let values = Vec::<Option<f64>>::deserialize(deserializer)?;
    Ok(values.into_iter().map(|v| v.unwrap_or(f64::NAN)).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn gaps_and_surplus_are_skipped() {
        let curve = Curve::new([0.0, 1.0, f64::NAN, 3.0], [5.0, f64::INFINITY, 7.0]);
        assert_eq!(curve.finite().collect::<Vec<_>>(), [(0.0, 5.0)]);
        assert_eq!(curve.pairs().count(), 3);
    }
}
