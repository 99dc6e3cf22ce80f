//! Points of a figure: plain numbers in display units, without interpolation or fit.

use serde::{Deserialize, Deserializer, Serialize, Serializer};

/// Curve or cloud of points: `y[i]` at `x[i]`, in the units of the figure.
///
/// A pair with an undefined (NaN or infinite) number is a gap: it is skipped, and a line is broken there. If the
/// lengths differ, the surplus is ignored. In JSON a gap is `null`. A curve from [`PlotCurve::new`] has no more pairs
/// than a figure can show.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize, schemars::JsonSchema)]
pub struct PlotCurve {
    /// Abscissae.
    #[serde(serialize_with = "with_gaps", deserialize_with = "from_gaps")]
    #[schemars(with = "Vec<Option<f64>>")]
    pub x: Vec<f64>,
    /// Ordinates.
    #[serde(serialize_with = "with_gaps", deserialize_with = "from_gaps")]
    #[schemars(with = "Vec<Option<f64>>")]
    pub y: Vec<f64>,
}

/// Maximum number of pairs kept of every run of a longer curve: first, lowest, highest, last, and a gap.
const KEPT_OF_RUN: usize = 5;

/// 95 % quantile of χ² with two degrees of freedom.
const CHI_SQUARED: f64 = 5.991_464_547;

/// Number of corners of a drawn contour.
const CORNERS: usize = 96;

impl PlotCurve {
    /// Maximum number of pairs of a curve.
    pub const MAX_PAIRS: usize = 4000;

    /// Curve from its two columns.
    ///
    /// A curve with more than [`Self::MAX_PAIRS`] pairs is thinned to its visible extent: of every run of neighbours,
    /// all of equal length, the first, the lowest, the highest and the last pair are kept, and a gap if there is one.
    pub fn new(x: impl Into<Vec<f64>>, y: impl Into<Vec<f64>>) -> Self {
        let curve = Self { x: x.into(), y: y.into() };
        if curve.x.len().min(curve.y.len()) > Self::MAX_PAIRS { curve.thinned() } else { curve }
    }

    fn thinned(&self) -> Self {
        let length = self.x.len().min(self.y.len());
        let mut thin = Self { x: Vec::with_capacity(Self::MAX_PAIRS), y: Vec::with_capacity(Self::MAX_PAIRS) };
        let run = length.div_ceil(Self::MAX_PAIRS / KEPT_OF_RUN);
        for start in (0..length).step_by(run) {
            let rows = start..length.min(start + run);
            let is_gap = |row: &usize| !(self.x[*row].is_finite() && self.y[*row].is_finite());
            let gap = rows.clone().find(is_gap);
            let drawn = || rows.clone().filter(|row| !is_gap(row));
            let by_height = |a: &usize, b: &usize| self.y[*a].total_cmp(&self.y[*b]);
            let kept = [drawn().next(), drawn().min_by(by_height), drawn().max_by(by_height), drawn().next_back(), gap];
            let mut kept: Vec<usize> = kept.into_iter().flatten().collect();
            kept.sort_unstable();
            kept.dedup();
            thin.x.extend(kept.iter().map(|&row| self.x[row]));
            thin.y.extend(kept.iter().map(|&row| self.y[row]));
        }
        thin
    }

    /// Closed 95 % contour of a bivariate normal distribution, from its mean and covariance matrix; empty if the
    /// covariance is not finite or its first variance is not positive.
    pub fn contour95([x, y]: [f64; 2], [[a, b], [_, c]]: [[f64; 2]; 2]) -> Self {
        // Cholesky: a point of the unit circle is multiplied by L.
        let l11 = a.sqrt();
        let l21 = b / l11;
        let l22 = (c - l21 * l21).max(0.0).sqrt();
        if !(l11 > 0.0 && l21.is_finite() && l22.is_finite()) {
            return Self::default();
        }
        let corner = |k: usize| {
            let angle = 2.0 * std::f64::consts::PI * k as f64 / CORNERS as f64;
            let (u, v) = (CHI_SQUARED.sqrt() * angle.cos(), CHI_SQUARED.sqrt() * angle.sin());
            (x + l11 * u, y + l21 * u + l22 * v)
        };
        let (x, y) = (0..=CORNERS).map(corner).unzip();
        Self { x, y }
    }

    /// Pairs (x, y) of the curve, with the gaps, in which a number is not finite.
    pub fn pairs(&self) -> impl Iterator<Item = (f64, f64)> + '_ {
        self.x.iter().copied().zip(self.y.iter().copied())
    }

    /// Finite pairs of the curve.
    pub fn finite_pairs(&self) -> impl Iterator<Item = (f64, f64)> + '_ {
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
        let curve = PlotCurve::new([0.0, 1.0, f64::NAN, 3.0], [5.0, f64::INFINITY, 7.0]);
        assert_eq!(curve.finite_pairs().collect::<Vec<_>>(), [(0.0, 5.0)]);
        assert_eq!(curve.pairs().count(), 3);
    }

    #[test]
    fn a_curve_that_can_be_shown_is_kept_to_the_bit() {
        let x: Vec<f64> = (0..PlotCurve::MAX_PAIRS).map(|k| 0.1 * k as f64).collect();
        let y: Vec<f64> = x.iter().map(|x| x.sin()).collect();
        assert_eq!(PlotCurve::new(x.as_slice(), y.as_slice()), PlotCurve { x, y });
    }

    #[test]
    fn a_dense_curve_keeps_its_ends_extremes_and_gaps() {
        let rows = 1_000_003;
        let x: Vec<f64> = (0..rows).map(f64::from).collect();
        let mut y: Vec<f64> = x.iter().map(|x| (1e-4 * x).sin()).collect();
        (y[123_456], y[654_321]) = (7.0, -7.0);
        y[300_000..310_000].fill(f64::NAN);
        y[500_000] = f64::NAN;
        let thin = PlotCurve::new(x.as_slice(), y.as_slice());
        assert!(
            thin.x.len() <= PlotCurve::MAX_PAIRS && thin.x.len() > PlotCurve::MAX_PAIRS / 4,
            "{} pairs",
            thin.x.len()
        );
        assert_eq!((thin.x[0], thin.x.last()), (0.0, x.last()));
        assert!(thin.x.is_sorted());
        let kept: Vec<(f64, f64)> = thin.finite_pairs().collect();
        assert!(kept.contains(&(123_456.0, 7.0)) && kept.contains(&(654_321.0, -7.0)));
        // The line is broken at both gaps.
        for gap in [300_000.0..310_000.0, 500_000.0..500_001.0] {
            assert!(thin.pairs().any(|(x, y)| gap.contains(&x) && y.is_nan()), "{gap:?}");
        }
    }

    #[test]
    fn a_dense_curve_of_gaps_alone_draws_nothing() {
        assert_eq!(
            PlotCurve::new(vec![f64::NAN; 2 * PlotCurve::MAX_PAIRS], vec![0.0; 2 * PlotCurve::MAX_PAIRS])
                .finite_pairs()
                .count(),
            0
        );
    }
}
