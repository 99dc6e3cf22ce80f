//! How strong a random moment has to be to explain what a fit leaves.

use ship::narrow_band::NarrowBand;

use super::linear::{Linear, log_variance};
use super::problem::Problem;
use crate::noise::{Colour, Moment};

impl Problem {
    /// The random moment of the given kind that explains best what a fit leaves, if it is worth its parameter.
    ///
    /// Level and parameters are found together: for every level the linearised fit is solved anew.
    pub fn best_moment(&self, linear: &Linear, kind: Moment, waves: Option<NarrowBand>) -> (Colour, f64) {
        let value = |level: f64| {
            let colour = Colour { moment: Some((kind, level.exp())), waves };
            let whiteners = self.whiteners(&colour);
            self.deviance(linear.projected(&whiteners), log_variance(&whiteners))
        };
        let (lo, hi) = (1e-3f64.ln(), 1e13f64.ln());
        let (level, deviance) = minimum(lo, hi, 12, value);
        (Colour { moment: Some((kind, level.exp())), waves }, deviance)
    }
}

/// Range about the level of highest likelihood, in its logarithm, that the means of a level are taken over, and points
/// in it.
const RANGE: [f64; 2] = [-3.0, 6.0];
const POINTS: usize = 24;

/// The size of the noise under the restricted likelihood.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Restricted {
    /// Variance of the white noise of a full row, rad².
    pub row: f64,
    /// Level of the random moment, where there is one: its geometric mean.
    pub level: f64,
    /// Its mean over the geometric one.
    pub mean: f64,
}

impl Problem {
    /// The size of the noise of a colour that a fit has found, at the mean over the restricted likelihood, every level
    /// being as likely before as its multiple.
    ///
    /// The likelihood of the fit counts what the unknowns have taken from the noise as if it had not been there, and of
    /// a slow moment they take much: its level is too small. The restricted one is that of all contrasts without the
    /// unknowns, −2 log L = (n − u) log(RSS/(n − u)) + Σ log S + log det XᵀΣ⁻¹X.
    ///
    /// Source: Patterson and Thompson (1971); Harville (1974) for its reading as a posterior.
    pub fn restricted(&self, linear: &Linear, colour: &Colour) -> Restricted {
        let free = (self.observations() as f64 - linear.unknowns as f64).max(1.0);
        // −2 log L, and the variance of a row.
        let at = |colour: &Colour| {
            let whiteners = self.whiteners(colour);
            let columns = linear.whitened(&whiteners);
            let rss = columns.normal(&linear.whitened_residual(&whiteners)).projected(linear.unknowns);
            let row = rss / free;
            (free * (row + self.floor()).ln() + log_variance(&whiteners) + columns.log_determinant(), row)
        };
        let Some((kind, level)) = colour.moment else {
            return Restricted { row: at(colour).1, level: 0.0, mean: 1.0 };
        };
        let [lo, hi] = RANGE;
        let points = (0..=POINTS).map(|k| level * (lo + (hi - lo) * k as f64 / POINTS as f64).exp());
        let points: Vec<(f64, (f64, f64))> =
            points.map(|level| (level, at(&Colour { moment: Some((kind, level)), ..*colour }))).collect();
        let lowest = points.iter().map(|(_, (deviance, _))| *deviance).fold(f64::INFINITY, f64::min);
        let mut sums = [0.0; 4];
        for (level, (deviance, row)) in points {
            let weight = (0.5 * (lowest - deviance)).exp();
            let values = [1.0, row, level * row, (level * row).max(f64::MIN_POSITIVE).ln()];
            values.iter().zip(&mut sums).for_each(|(value, sum)| *sum += weight * value);
        }
        let [row, mean, logarithm] = [1, 2, 3].map(|k| sums[k] / sums[0]);
        let moment = logarithm.exp();
        Restricted { row, level: moment / row, mean: mean / moment }
    }
}

/// Smallest value on a range: a grid, then golden sections about its lowest point.
pub(crate) fn minimum(lo: f64, hi: f64, points: usize, mut value: impl FnMut(f64) -> f64) -> (f64, f64) {
    let at = |k: usize| lo + (hi - lo) * k as f64 / points as f64;
    let heights: Vec<f64> = (0..=points).map(|k| value(at(k))).collect();
    let best = (0..=points).min_by(|&i, &j| heights[i].total_cmp(&heights[j])).unwrap_or(0);
    let (mut left, mut right) = (at(best.saturating_sub(1)), at((best + 1).min(points)));
    let mut found = (at(best), heights[best]);
    let golden = 0.5 * (5f64.sqrt() - 1.0);
    let (mut one, mut two) = (right - golden * (right - left), left + golden * (right - left));
    let (mut f_one, mut f_two) = (value(one), value(two));
    for _ in 0..8 {
        for candidate in [(one, f_one), (two, f_two)] {
            if candidate.1 < found.1 {
                found = candidate;
            }
        }
        if f_one < f_two {
            (right, two, f_two) = (two, one, f_one);
            one = right - golden * (right - left);
            f_one = value(one);
        } else {
            (left, one, f_one) = (one, two, f_two);
            two = left + golden * (right - left);
            f_two = value(two);
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_lowest_point_of_a_range_is_found_inside_and_at_its_ends() {
        let (place, value) = minimum(-1.0, 3.0, 12, |x| (x - 0.7).powi(2) - 2.0);
        assert!((place - 0.7).abs() < 0.02 && (value + 2.0).abs() < 1e-3, "{place}, {value}");
        assert_eq!(minimum(-1.0, 3.0, 12, |x| x).0, -1.0);
        assert_eq!(minimum(-1.0, 3.0, 12, |x| -x).0, 3.0);
        // Two valleys: the grid sees both.
        let (place, _) = minimum(-2.0, 2.0, 12, |x: f64| (x * x - 1.0).powi(2) + 0.3 * x);
        assert!((place + 1.0).abs() < 0.1, "{place}");
    }
}
