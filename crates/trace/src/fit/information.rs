//! How much of what white noise would tell of the unknowns a coloured noise takes away.
//!
//! A random moment wanders as a bias or a slow term does, so under it the records tell little of these, however many
//! rows they have. The k log n of BIC is the price of k unknowns of which every row tells as much as under white noise;
//! where it tells less, the same prior leaves less to pay.

use nalgebra::DMatrix;

use super::linear::{Columns, Linear, log_determinant};
use super::problem::Problem;
use crate::noise::Colour;

/// log det(XᵀX/n + (1 − 1/n) WᵀW) − log det XᵀX, from XᵀX and WᵀW: to be added to k log n.
///
/// X are the sensitivities of n headings under white noise, W the same whitened for the noise. With k log n it is the
/// log det(I + n (XᵀX)⁻¹ WᵀW) of a prior as wide as one white heading tells, up to 1/n: zero for white noise, at most
/// −k log n for one under which the records tell nothing.
///
/// Source: Kass and Wasserman (1995) for the prior of BIC; Berger, Bayarri and Pericchi (2014) for the number of
/// observations that dependent ones are worth.
pub(crate) fn lost(plain: &DMatrix<f64>, whitened: &DMatrix<f64>, n: f64) -> f64 {
    log_determinant(&prior_and(plain, whitened, n)) - log_determinant(plain)
}

/// XᵀX/n + (1 − 1/n) WᵀW.
pub(crate) fn prior_and(plain: &DMatrix<f64>, whitened: &DMatrix<f64>, n: f64) -> DMatrix<f64> {
    plain / n + whitened * (1.0 - n.recip())
}

impl Problem {
    /// The sensitivities under white noise.
    pub(crate) fn under_white(&self, linear: &Linear) -> Columns {
        linear.whitened(&self.whiteners(&Colour::WHITE))
    }

    /// [`lost`] for sensitivities whitened for a colour, of which `plain` gives those under white noise.
    pub(super) fn lost(&self, colour: &Colour, plain: impl FnOnce() -> Columns, whitened: &Columns) -> f64 {
        if colour.is_white() { 0.0 } else { lost(&plain().matrix, &whitened.matrix, self.observations() as f64) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// One unknown, n = 100: all of it told, a quarter, nothing.
    #[test]
    fn the_price_of_an_unknown_is_what_the_records_tell_of_it() {
        let of = |value: f64| DMatrix::from_element(1, 1, value);
        let price = |told: f64| 100f64.ln() + lost(&of(4.0), &of(4.0 * told), 100.0);
        assert!((price(1.0) - 100f64.ln()).abs() < 1e-9);
        assert!((price(0.25) - (1.0 + 99.0 * 0.25f64).ln()).abs() < 1e-9);
        assert!(price(0.0).abs() < 1e-9);
    }
}
