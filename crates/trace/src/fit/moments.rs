//! How strong a random moment has to be to explain what a fit leaves.

use ship::narrow_band::NarrowBand;

use super::linear::{Linear, log_variance};
use super::problem::Problem;
use crate::noise::{Colour, GUSTS, Moment};

impl Problem {
    /// The random moment of the given kind that explains best what a fit leaves, if it is worth its parameter.
    ///
    /// Level and parameters are found together: for every level the linearised fit is solved anew. The level is that of
    /// the restricted likelihood, −2 log L_R = (n − p) log(RSS/(n − p)) + Σ log S + log det XᵀX of the whitened
    /// sensitivities X, which knows that p unknowns were fitted as well (Patterson and Thompson 1971).
    pub fn best_moment(&self, linear: &Linear, kind: Moment, waves: Option<NarrowBand>) -> (Colour, f64) {
        let at = |level: f64| {
            let colour = Colour { moment: Some((kind, level.exp())), waves };
            let whiteners = self.whiteners(&colour);
            let columns = linear.whitened(&whiteners);
            let rss = columns.normal(&linear.whitened_residual(&whiteners)).projected(columns.unknowns());
            (colour, rss, log_variance(&whiteners), columns.log_determinant())
        };
        let (lo, hi) = (1e-3f64.ln(), 1e13f64.ln());
        let restricted = |level: f64| {
            let (_, rss, log_variance, log_determinant) = at(level);
            self.restricted(rss, linear.unknowns, log_variance + log_determinant)
        };
        let (colour, rss, log_variance, _) = at(minimum(lo, hi, 12, restricted).0);
        (colour, self.deviance(rss, log_variance))
    }

    /// The one of some kinds of random moment with the lowest BIC.
    pub fn best_of(&self, linear: &Linear, kinds: &[Moment], waves: Option<NarrowBand>) -> Option<(Colour, f64)> {
        let log_n = (self.observations() as f64).ln();
        let found = kinds.iter().map(|&kind| self.best_moment(linear, kind, waves));
        let bic = |(colour, deviance): &(Colour, f64)| deviance + colour.freedom() as f64 * log_n;
        found.min_by(|one, other| bic(one).total_cmp(&bic(other)))
    }

    /// Kinds of random moment that are worth a look: white, a walk, and the gusts that explain best what a fit leaves.
    pub fn kinds(&self, linear: &Linear, waves: Option<NarrowBand>) -> Vec<Moment> {
        let gusts: Vec<Moment> = (0..GUSTS.len()).map(Moment::OrnsteinUhlenbeck).collect();
        let best = self.best_of(linear, &gusts, waves).and_then(|(colour, _)| colour.moment);
        [Moment::White, Moment::Walk].into_iter().chain(best.map(|(kind, _)| kind)).collect()
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
