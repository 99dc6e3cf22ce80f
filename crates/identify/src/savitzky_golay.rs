//! Local polynomials by least squares: smoothed values and derivatives of a record, evenly sampled or not. With even
//! sampling they are the Savitzky-Golay filters. Rows within half a window of an end are left to the caller. Source:
//! Savitzky and Golay (1964), Smoothing and differentiation of data by simplified least squares procedures, Analytical
//! Chemistry 36, 1627–1639.

use std::ops::Range;

use nalgebra::{Cholesky, Const, Matrix6, Vector6};
use serde::{Deserialize, Serialize};

use crate::settings::{SettingsError, require};

/// Maximum order of a local polynomial.
pub const MAX_ORDER: usize = 5;

/// Number of coefficients of a local polynomial; coefficients above its order are zero.
pub const MAX_COEFFICIENTS: usize = MAX_ORDER + 1;

/// Window and order of the local polynomials.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case", default)]
pub struct SavitzkyGolay {
    /// Number of rows in the window, odd, at most 10,001.
    pub window_samples: usize,
    /// Order of the polynomial, 2 to 5, less than the number of rows in the window.
    pub order: usize,
}

/// Maximum number of rows of a window, which limits the computation per row of a record.
const MAX_WINDOW_ROWS: usize = 10_001;

impl Default for SavitzkyGolay {
    fn default() -> Self {
        Self { window_samples: 15, order: 3 }
    }
}

impl SavitzkyGolay {
    /// Central differences: three rows and a parabola.
    pub const CENTRAL_DIFFERENCES: Self = Self { window_samples: 3, order: 2 };

    /// Checks window and order: fails if the window is even, the order is outside 2..=5, the window does not hold
    /// order + 1 rows, or exceeds 10 001 rows.
    pub fn check(&self) -> Result<(), SettingsError> {
        let Self { window_samples: rows, order } = *self;
        require((2..=MAX_ORDER).contains(&order), "order", order, "2, 3, 4 or 5")?;
        let is_valid = !rows.is_multiple_of(2) && rows > order;
        require(is_valid, "window-samples", rows, "an odd number above the order")?;
        require(rows <= MAX_WINDOW_ROWS, "window-samples", rows, "at most 10001")
    }

    /// Rows of the window around row `k`; `None` if it does not fit into `len` rows.
    pub fn window(&self, k: usize, len: usize) -> Option<Range<usize>> {
        let half = self.window_samples / 2;
        let window = k.checked_sub(half)?..(k + half + 1);
        (window.end <= len).then_some(window)
    }
}

/// Weights of every row of a window in c₀, c₁ and c₂ (value, slope and half the second derivative), kept while the
/// spacing of the rows repeats: with even sampling they are computed once.
#[derive(Debug)]
pub struct WindowWeights<'a> {
    filter: &'a SavitzkyGolay,
    /// Times relative to the middle row, s, that the weights belong to.
    relative: Vec<f64>,
    weights: Vec<[f64; 3]>,
}

impl<'a> WindowWeights<'a> {
    /// Weights for windows and polynomials of `filter`.
    pub fn new(filter: &'a SavitzkyGolay) -> Self {
        Self { filter, relative: Vec::new(), weights: Vec::new() }
    }

    /// Rows of the window around row `k` with their weights.
    ///
    /// `None` if the window does not fit into the record or the fit is singular.
    pub fn weights_at(&mut self, time: &[f64], k: usize) -> Option<(Range<usize>, &[[f64; 3]])> {
        let window = self.filter.window(k, time.len())?;
        let times = &time[window.clone()];
        // Rounding errors of times such as 0.1 k are not a change of spacing.
        let tolerance = 1e-9 * (times[times.len() - 1] - times[0]);
        let repeats = self.relative.len() == times.len()
            && times.iter().zip(&self.relative).all(|(t, before)| (t - time[k] - before).abs() <= tolerance);
        if !repeats {
            self.relative.clear();
            self.weights.clear();
            self.relative.extend(times.iter().map(|t| t - time[k]));
            let fit = LocalFit::new(&self.relative, 0.0, self.filter.order)?;
            let weights = |p: usize| fit.weights(std::array::from_fn(|i| if i == p { 1.0 } else { 0.0 }));
            self.weights.extend(weights(0).zip(weights(1)).zip(weights(2)).map(|((c0, c1), c2)| [c0, c1, c2]));
        }
        (self.weights.len() == window.len()).then_some((window, &self.weights))
    }

    /// c₀, c₁ and c₂ at row `k`; `None` as for [`weights_at`](Self::weights_at).
    pub fn apply(&mut self, time: &[f64], value: &[f64], k: usize) -> Option<[f64; 3]> {
        let (window, weights) = self.weights_at(time, k)?;
        Some(
            value[window]
                .iter()
                .zip(weights)
                .fold([0.0; 3], |sum, (y, w)| [sum[0] + w[0] * y, sum[1] + w[1] * y, sum[2] + w[2] * y]),
        )
    }
}

/// Coefficients cₚ of Σ cₚ (t − `centre`)ᵖ, p ≤ `order`, fitted by least squares to points of equal weight; zero above.
///
/// `time` and `value` have the same length; times differ. cₚ has the unit of the value over sᵖ. `None` if there are not
/// more points than the order, if the order exceeds [`MAX_ORDER`], or if the equations are singular.
///
/// Source: Savitzky and Golay (1964), here for any spacing.
pub fn local_polynomial(time: &[f64], value: &[f64], centre: f64, order: usize) -> Option<[f64; MAX_COEFFICIENTS]> {
    let coefficients = LocalFit::new(time, centre, order)?.coefficients(value);
    coefficients.iter().all(|c| c.is_finite()).then_some(coefficients)
}

/// Linear map from the values of a window to the coefficients of the local polynomial.
#[derive(Debug)]
pub struct LocalFit<'a> {
    time: &'a [f64],
    centre: f64,
    order: usize,
    /// Maximum distance from `centre`, s, by which distances are scaled.
    reach: f64,
    normal: Cholesky<f64, Const<MAX_COEFFICIENTS>>,
}

impl<'a> LocalFit<'a> {
    /// Fit for the rows at `time` (s), a polynomial of `order` in t − `centre`; `None` as for [`local_polynomial`].
    pub fn new(time: &'a [f64], centre: f64, order: usize) -> Option<Self> {
        if time.len() <= order || order > MAX_ORDER {
            return None;
        }
        let reach = time.iter().fold(0.0_f64, |reach, t| reach.max((t - centre).abs()));
        // Unused orders keep a unit diagonal and a zero right-hand side, so that one size fits all.
        let mut normal = Matrix6::from_fn(|i, j| if i == j && i > order { 1.0 } else { 0.0 });
        for t in time {
            let powers = powers((t - centre) / reach, order);
            // Cholesky reads the lower triangle only.
            for i in 0..=order {
                for j in 0..=i {
                    normal[(i, j)] += powers[i] * powers[j];
                }
            }
        }
        Some(Self { time, centre, order, reach, normal: normal.cholesky()? })
    }

    /// Coefficients for one value per row.
    pub fn coefficients(&self, value: &[f64]) -> [f64; MAX_COEFFICIENTS] {
        let right =
            self.time.iter().zip(value).fold(Vector6::zeros(), |right, (t, &y)| {
                right + powers((t - self.centre) / self.reach, self.order) * y
            });
        self.rescaled(self.normal.solve(&right).into())
    }

    /// Weight of every row in Σ `functional`ₚ cₚ.
    pub fn weights(&self, functional: [f64; MAX_COEFFICIENTS]) -> impl Iterator<Item = f64> {
        let scaled = Vector6::from(self.rescaled(functional));
        let used = Vector6::from_fn(|p, _| if p <= self.order { scaled[p] } else { 0.0 });
        let solved = self.normal.solve(&used);
        self.time.iter().map(move |t| solved.dot(&powers((t - self.centre) / self.reach, self.order)))
    }

    /// Coefficients divided by powers of the reach: from powers of the scaled distance to powers of seconds.
    fn rescaled(&self, mut coefficients: [f64; MAX_COEFFICIENTS]) -> [f64; MAX_COEFFICIENTS] {
        let mut scale = 1.0;
        for coefficient in &mut coefficients {
            *coefficient *= scale;
            scale /= self.reach;
        }
        coefficients
    }
}

/// 1, u, … u^`order`, then zeros.
fn powers(u: f64, order: usize) -> Vector6<f64> {
    let mut powers = Vector6::zeros();
    let mut power = 1.0;
    for p in 0..=order {
        powers[p] = power;
        power *= u;
    }
    powers
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_abs_diff_eq;

    /// Weights of coefficient `p` in a window of five rows, from unit impulses.
    fn weights(order: usize, p: usize) -> Vec<f64> {
        let time = [0.0, 1.0, 2.0, 3.0, 4.0];
        let impulse = |k: usize| std::array::from_fn::<f64, 5, _>(|i| if i == k { 1.0 } else { 0.0 });
        let filter = SavitzkyGolay { window_samples: 5, order };
        (0..5).map(|k| WindowWeights::new(&filter).apply(&time, &impulse(k), 2).expect("regular")[p]).collect()
    }

    /// Five-point tables of Savitzky and Golay (1964).
    #[test]
    fn weights_are_those_of_the_published_tables() {
        let tables = [
            (2, 0, 35.0, [-3.0, 12.0, 17.0, 12.0, -3.0]),
            (3, 0, 35.0, [-3.0, 12.0, 17.0, 12.0, -3.0]),
            (2, 1, 10.0, [-2.0, -1.0, 0.0, 1.0, 2.0]),
            (3, 1, 12.0, [1.0, -8.0, 0.0, 8.0, -1.0]),
            // The second derivative is twice the coefficient.
            (2, 2, 14.0, [2.0, -1.0, -2.0, -1.0, 2.0]),
        ];
        for (order, p, norm, table) in tables {
            for (found, expected) in weights(order, p).into_iter().zip(table) {
                assert_abs_diff_eq!(found, expected / norm, epsilon = 1e-12);
            }
        }
    }

    #[test]
    fn a_polynomial_is_recovered_from_uneven_rows() {
        let time = [0.0, 0.3, 1.1, 1.2, 2.5, 3.0, 4.4, 4.9];
        for order in 0..=MAX_ORDER {
            let truth = [0.3, -1.0, 0.5, 0.2, -0.05, 0.01];
            let value = time.map(|t| (0..=order).map(|p| truth[p] * f64::powi(t - 2.0, p as i32)).sum::<f64>());
            let found = local_polynomial(&time, &value, 2.0, order).expect("regular");
            for p in 0..=MAX_ORDER {
                assert_abs_diff_eq!(found[p], if p <= order { truth[p] } else { 0.0 }, epsilon = 1e-9);
            }
        }
    }

    #[test]
    fn weights_give_what_the_coefficients_give() {
        let time = [0.0, 0.3, 1.1, 1.2, 2.5, 3.0, 4.4];
        let value = [1.0, -2.0, 0.5, 0.7, 3.0, -1.0, 0.2];
        let fit = LocalFit::new(&time, 1.5, 3).expect("regular");
        let functional = [0.5, -1.0, 2.0, 0.25, 9.0, 9.0];
        let direct: f64 = fit.coefficients(&value).iter().zip(functional).map(|(c, by)| c * by).sum();
        let weighted: f64 = fit.weights(functional).zip(value).map(|(w, y)| w * y).sum();
        assert_abs_diff_eq!(direct, weighted, epsilon = 1e-12);
    }

    #[test]
    fn weights_follow_a_change_of_spacing() {
        let time: Vec<f64> =
            (0..30).map(|k| if k < 15 { 0.1 * f64::from(k) } else { 1.4 + f64::from(k - 14) }).collect();
        let value: Vec<f64> = time.iter().map(|t| (0.2 * t).sin()).collect();
        let filter = SavitzkyGolay { window_samples: 7, order: 3 };
        let mut weights = WindowWeights::new(&filter);
        for k in 3..27 {
            let kept = weights.apply(&time, &value, k).expect("regular");
            let fresh = local_polynomial(&time[k - 3..k + 4], &value[k - 3..k + 4], time[k], 3).expect("regular");
            for p in 0..3 {
                assert_abs_diff_eq!(kept[p], fresh[p], epsilon = 1e-8);
            }
        }
    }

    #[test]
    fn too_few_rows_give_nothing() {
        assert!(local_polynomial(&[0.0, 1.0], &[0.0, 1.0], 0.5, 2).is_none());
        assert!(local_polynomial(&[1.0], &[0.0], 1.0, 0).is_none());
        assert!(SavitzkyGolay::default().window(6, 20).is_none());
        assert!(SavitzkyGolay::default().window(13, 20).is_none());
        assert_eq!(SavitzkyGolay::default().window(7, 20), Some(0..15));
        assert!(SavitzkyGolay { window_samples: 4, order: 2 }.check().is_err());
        assert!(SavitzkyGolay { window_samples: 5, order: 6 }.check().is_err());
    }
}
