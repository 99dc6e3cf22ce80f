//! How strong a random moment has to be to explain what a fit leaves.

use ship::narrow_band::NarrowBand;

use super::linear::{Columns, Linear, log_determinant, log_variance};
use super::problem::Problem;
use crate::noise::{COMPASS, Colour, GUSTS, Wander};

impl Problem {
    /// The random moment of the given kind that explains best what a fit leaves, with its −2 log L and what it takes
    /// from the price of the unknowns.
    ///
    /// Level and parameters are found together: for every level the linearised fit is solved anew. The level is that of
    /// the restricted likelihood, [`Problem::restricted`].
    pub fn best_moment(&self, linear: &Linear, kind: Wander, waves: Option<NarrowBand>) -> (Colour, f64) {
        let of = |level: f64| Colour { wander: Some((kind, level.exp())), waves };
        let (lo, hi) = (1e-3f64.ln(), 1e13f64.ln());
        let colour = of(minimum(lo, hi, 12, |level| self.under(linear, &of(level)).restricted).0);
        let found = self.under(linear, &colour);
        let lost = self.lost(&colour, || self.under_white(linear), &found.columns);
        (colour, self.deviance(found.rss, found.log_variance) + lost)
    }

    /// The one of some kinds of random moment with the lowest BIC.
    pub fn best_of(&self, linear: &Linear, kinds: &[Wander], waves: Option<NarrowBand>) -> Option<(Colour, f64)> {
        let log_n = (self.observations() as f64).ln();
        let found = kinds.iter().map(|&kind| self.best_moment(linear, kind, waves));
        let bic = |(colour, deviance): &(Colour, f64)| deviance + colour.freedom() as f64 * log_n;
        found.min_by(|one, other| bic(one).total_cmp(&bic(other)))
    }

    /// Kinds of wandering that are worth a look: a white moment, a walk, and the gusts and the error of the compass
    /// that explain best what a fit leaves.
    pub fn kinds(&self, linear: &Linear, waves: Option<NarrowBand>) -> Vec<Wander> {
        let nearest = |kinds: Vec<Wander>| {
            let best = self.best_of(linear, &kinds, waves).and_then(|(colour, _)| colour.wander);
            best.map(|(kind, _)| kind)
        };
        let gusts = nearest((0..GUSTS.len()).map(Wander::OrnsteinUhlenbeck).collect());
        let compass = nearest((0..COMPASS.len()).map(Wander::Compass).collect());
        [Wander::White, Wander::Walk].into_iter().chain(gusts).chain(compass).collect()
    }
}

/// Range about the level of highest likelihood, in its logarithm, that the means of a level are taken over, and points
/// in it.
const RANGE: [f64; 2] = [-3.0, 6.0];
const POINTS: usize = 24;

/// What the best linear step of all unknowns leaves under one colour.
struct Under {
    /// Sum of squares, whitened, rad².
    rss: f64,
    /// Σ log S.
    log_variance: f64,
    /// Whitened sensitivities.
    columns: Columns,
    /// −2 log of the restricted likelihood.
    restricted: f64,
}

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
    /// Number of contrasts that the unknowns leave.
    fn contrasts(&self, linear: &Linear) -> f64 {
        (self.observations() as f64 - linear.unknowns as f64).max(1.0)
    }

    fn under(&self, linear: &Linear, colour: &Colour) -> Under {
        let whiteners = self.whiteners(colour);
        let columns = linear.whitened(&whiteners);
        let rss = columns.normal(&linear.whitened_residual(&whiteners)).projected(linear.unknowns);
        let (free, log_variance) = (self.contrasts(linear), log_variance(&whiteners));
        let of_size = if rss.is_finite() { free * (rss / free + self.floor()).ln() } else { f64::INFINITY };
        let restricted = of_size + log_variance + log_determinant(&columns.matrix);
        Under { rss, log_variance, columns, restricted }
    }

    /// The size of the noise of a colour that a fit has found, at the mean over the restricted likelihood, every level
    /// being as likely before as its multiple.
    ///
    /// The likelihood of the fit counts what the unknowns have taken from the noise as if it had not been there, and of
    /// a slow moment they take much: its level is too small. The restricted one is that of all contrasts without the
    /// unknowns, −2 log L = (n − u) log(RSS/(n − u)) + Σ log S + log det XᵀΣ⁻¹X.
    ///
    /// Source: Patterson and Thompson (1971); Harville (1974) for its reading as a posterior.
    pub fn restricted(&self, linear: &Linear, colour: &Colour) -> Restricted {
        let free = self.contrasts(linear);
        // −2 log L, and the variance of a row.
        let at = |colour: &Colour| {
            let Under { rss, restricted, .. } = self.under(linear, colour);
            (restricted, rss / free)
        };
        let Some((kind, level)) = colour.wander else {
            return Restricted { row: at(colour).1, level: 0.0, mean: 1.0 };
        };
        let [lo, hi] = RANGE;
        let points = (0..=POINTS).map(|k| level * (lo + (hi - lo) * k as f64 / POINTS as f64).exp());
        let points: Vec<(f64, (f64, f64))> =
            points.map(|level| (level, at(&Colour { wander: Some((kind, level)), ..*colour }))).collect();
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
