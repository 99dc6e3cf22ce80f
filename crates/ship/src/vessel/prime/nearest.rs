//! What is expected of the coefficients of a polynomial: those of the polynomial that is nearest to an MMG hull.
//!
//! Nearest is θ = argmin Σ |a(θ) − a_MMG|², the sum of squares of differences of accelerations over states that trials
//! visit. How θ varies among ships follows from hulls that depart from that one by a standard deviation, in one
//! coefficient of the MMG model or in one ratio that was filled in: with J the derivatives of a, J⁺ = (JᵀJ)⁻¹Jᵀ and a±
//! their accelerations,
//!
//! Cov θ = f² Σ d dᵀ, d = J⁺ (a₊ − a₋)/2.
//!
//! So coefficients that a state ties together, such as N_v and N_vv or N_δ and Y_δ, are correlated. The formulas of the
//! MMG model were held against two hulls, so other ships depart from them by more: f is the root of the median of D²/p
//! over the hulls of this project that no formula was made with, with D the Mahalanobis distance of their nearest
//! polynomials and p the number of coefficients. It is the same to a tenth whichever of them is left out.

use estimation::number::{Dual, Real};
use nalgebra::{DMatrix, DVector};

use super::equations::{COMMON, CUBIC, CalmHull, PolynomialTerm, QUADRATIC};
use crate::vessel::mmg::{Mmg, Parameters};
use crate::vessel::prior::HullPrior;

/// f: how many times the standard deviations of the formulas ships depart.
const OTHER_SHIPS: f64 = 1.6;

/// Surge, curvature r L/u, drift beyond that of the turn, v/u + 0.35 r L/u, and rudder (rad) of zig-zags and circles.
const SURGES: [f64; 3] = [1.0, 0.8, 0.6];
const CURVATURES: [f64; 5] = [-0.8, -0.4, 0.0, 0.4, 0.8];
const DRIFTS: [f64; 4] = [-0.12, -0.04, 0.04, 0.12];
const RUDDERS: [f64; 3] = [-0.6, 0.0, 0.6];

/// Where the pivot point of a turn lies ahead of midship, L.
const PIVOT: f64 = 0.35;

/// Steps of the search: only e, b, k and δ_r are not linear.
const STEPS: usize = 8;

/// Where the search begins: far from it, k leaves what a ship can have.
fn begin(term: &PolynomialTerm) -> f64 {
    match term.key {
        "Nd" => 1.0,
        "Yd" => -0.1,
        "x0" => 0.05,
        "e" | "k" => 0.5,
        _ => 0.0,
    }
}

/// Values of the coefficients and their covariance.
type PolynomialLaw = (DVector<f64>, DMatrix<f64>);

/// Of the quadratic and of the cubic polynomial; `None` where the prior makes no ship.
pub(super) fn polynomials(prior: &HullPrior) -> Option<[PolynomialLaw; 2]> {
    let of_mmg = |parameters: &Parameters| {
        let hull = Mmg::at_speed(parameters.of_length_one(), 1.0).ok()?;
        Some(DVector::from_vec(accelerations(&CalmHull::Mmg(Box::new(hull), 0.0))))
    };
    let differences = prior.deviations.iter().filter_map(|[above, below]| Some(of_mmg(above)? - of_mmg(below)?));
    let differences = DMatrix::from_columns(&differences.collect::<Vec<_>>()) * (0.5 * OTHER_SHIPS);
    laws(&of_mmg(&prior.parameters)?, &differences)
}

/// The same of a hull with these accelerations.
fn laws(truth: &DVector<f64>, differences: &DMatrix<f64>) -> Option<[PolynomialLaw; 2]> {
    Some([
        law(CalmHull::<Dual<{ COMMON.len() + QUADRATIC.len() }>>::Quadratic, truth, differences)?,
        law(CalmHull::<Dual<{ COMMON.len() + CUBIC.len() }>>::Cubic, truth, differences)?,
    ])
}

/// Surge, sway, yaw rate and rudder of every state.
fn states() -> impl Iterator<Item = ([f64; 3], f64)> {
    let of = |(u, curvature, drift): (f64, f64, f64)| [u, u * (drift - PIVOT * curvature), u * curvature];
    SURGES.into_iter().flat_map(move |u| {
        CURVATURES.into_iter().flat_map(move |curvature| {
            DRIFTS.into_iter().flat_map(move |drift| RUDDERS.map(|rudder| (of((u, curvature, drift)), rudder)))
        })
    })
}

/// u', v' and r' in every state.
fn accelerations<R: Real>(hull: &CalmHull<R>) -> Vec<R> {
    states().flat_map(|(state, rudder)| hull.accelerations(state.map(R::from), R::from(rudder), 1.0, 0.0)).collect()
}

/// The nearest polynomial by Gauss and Newton, and how it follows differences of the accelerations.
fn law<const N: usize>(
    polynomial: fn([Dual<N>; N]) -> CalmHull<Dual<N>>,
    truth: &DVector<f64>,
    differences: &DMatrix<f64>,
) -> Option<PolynomialLaw> {
    let mut values = DVector::from_fn(N, |place, _| COMMON.get(place).map_or(0.0, begin));
    let linearised = |values: &DVector<f64>| {
        let variables = std::array::from_fn(|place| Dual::variable(values[place], place, 1.0));
        let rows = accelerations(&polynomial(variables));
        let by = DMatrix::from_fn(rows.len(), N, |row, column| rows[row].by[column]);
        let left = DVector::from_fn(rows.len(), |row, _| truth[row] - rows[row].value);
        Some((by.tr_mul(&by).cholesky()?, by, left))
    };
    for _ in 0..STEPS {
        let (normal, by, left) = linearised(&values)?;
        values += normal.solve(&by.tr_mul(&left));
    }
    let (normal, by, _) = linearised(&values)?;
    let spread = normal.solve(&by.tr_mul(differences));
    Some((values, &spread * spread.transpose()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dynamics::Input;
    use crate::ships::{self, Model};
    use crate::vessel::prime::HullForm;
    use crate::vessel::state::{SURGE, SWAY, YAW_RATE};
    use estimation::statistics::median;

    /// u', v' and r' of a hull in every state; `None` for a ship that is a response model.
    fn published(ship: &ships::Ship) -> Option<DVector<f64>> {
        let (Model::Hull(hull), Some(own)) = (&ship.model, ship.particulars) else { return None };
        let second = own.length / own.speed;
        let mut state = vec![0.0; hull.dimension()];
        hull.approach(0.0, 0.0, &mut state);
        let mut rates = state.clone();
        let mut accelerations = Vec::new();
        for ([u, v, r], rudder) in states() {
            (state[SURGE], state[SWAY], state[YAW_RATE]) = (u * own.speed, v * own.speed, r / second);
            hull.rates(0.0, &state, &Input { rudder, ..Input::default() }, &mut rates);
            let [u, v, r] = [SURGE, SWAY, YAW_RATE].map(|place| rates[place]);
            accelerations.extend([u * second / own.speed, v * second / own.speed, r * second * second]);
        }
        Some(DVector::from_vec(accelerations))
    }

    /// f by the hulls that no formula was made with, by all and with each left out; KVLCC2, with which some were, is
    /// nearer.
    #[test]
    fn published_hulls_depart_from_the_formulas_by_so_much() {
        let forms = HullForm::of_ship(None);
        let of = |ship: &ships::Ship| {
            let truth = published(ship)?;
            let own = laws(&truth, &DMatrix::zeros(truth.len(), 0)).expect("independent terms");
            let square = |form: &HullForm, (own, _): PolynomialLaw| {
                // Without Y_w, the last.
                let count = own.len();
                let left = own - DVector::from_fn(count, |place, _| form.coefficients()[place].mean);
                let covariance = form.covariance().view((0, 0), (count, count)).into_owned();
                let precision = covariance.cholesky().expect("a covariance").inverse();
                OTHER_SHIPS * OTHER_SHIPS * left.dot(&(precision * &left)) / left.len() as f64
            };
            let squares: Vec<f64> = own.into_iter().zip(&forms).map(|(own, form)| square(form, own)).collect();
            Some((ship.name.to_string(), squares))
        };
        let found: Vec<(String, Vec<f64>)> = ships::all().iter().filter_map(of).collect();
        let (known, others): (Vec<_>, Vec<_>) = found.into_iter().partition(|(name, _)| name.contains("KVLCC2"));
        assert!(known.iter().all(|(_, own)| own.iter().all(|square| *square < 1.0)), "{known:?}");
        for form in 0..2 {
            for left_out in 0..=others.len() {
                let kept = others.iter().enumerate().filter(|(place, _)| *place != left_out);
                let mut kept: Vec<f64> = kept.map(|(_, (_, own))| own[form]).collect();
                let factor = median(&mut kept).expect("some are left").sqrt();
                assert!((factor / OTHER_SHIPS - 1.0).abs() < 0.1, "{form} without {left_out}: {factor} {others:?}");
            }
        }
    }
}
