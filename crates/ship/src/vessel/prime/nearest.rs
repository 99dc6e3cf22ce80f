//! Priors of the polynomials: the polynomial nearest to an MMG hull, with the spread that follows from its priors.
//!
//! The mean is the least-squares fit θ = argmin Σ |a(θ) − a_MMG|² of the accelerations over states of trials. The
//! covariance follows from hulls one standard deviation away, in one coefficient of the MMG model or in one assumed
//! ratio: with the Jacobian J of a, J⁺ = (JᵀJ)⁻¹Jᵀ, and the accelerations a± of these hulls,
//!
//! Cov θ = f² Σ d dᵀ, d = J⁺ (a₊ − a₋)/2.
//!
//! Coefficients that act together in these states, such as N_v and N_vv or N_δ and Y_δ, are therefore correlated. The
//! formulas of the MMG model were checked on two hulls, so departures of other ships are larger: f is the square root
//! of the median of D²/p over the hulls of this project that entered no formula, with D the Mahalanobis distance of
//! their nearest polynomials and p the number of coefficients. It changes by less than a tenth if one of these hulls is
//! left out.

use estimation::number::{Dual, Real};
use nalgebra::{DMatrix, DVector};

use super::equations::{COMMON_TERMS, CUBIC_TERMS, CalmHull, PolynomialTerm, QUADRATIC_TERMS};
use crate::vessel::mmg::{Mmg, MmgParameters};
use crate::vessel::prior::HullPrior;

/// Factor f on the standard deviations of the formulas.
const SPREAD_FACTOR: f64 = 1.6;

/// Surge velocities u of the states of zig-zags and circles, in U.
const SURGES: [f64; 3] = [1.0, 0.8, 0.6];

/// Curvatures r L/u of the states.
const CURVATURES: [f64; 5] = [-0.8, -0.4, 0.0, 0.4, 0.8];

/// Drifts of the states relative to the turn, v/u + 0.35 r L/u.
const DRIFTS: [f64; 4] = [-0.12, -0.04, 0.04, 0.12];

/// Rudder angles of the states, rad.
const RUDDERS: [f64; 3] = [-0.6, 0.0, 0.6];

/// Position of the pivot point of a turn ahead of midship, in L.
const PIVOT: f64 = 0.35;

/// Number of Gauss–Newton steps; only e, b, k and δ_r are nonlinear.
const STEPS: usize = 8;

/// Start value of a coefficient; from a distant start value, k leaves its bounds.
fn begin(term: &PolynomialTerm) -> f64 {
    match term.key {
        "Nd" => 1.0,
        "Yd" => -0.1,
        "x0" => 0.05,
        "e" | "k" => 0.5,
        _ => 0.0,
    }
}

/// Normal prior of the coefficients of a polynomial: mean and covariance.
type PolynomialLaw = (DVector<f64>, DMatrix<f64>);

/// Priors of the quadratic and the cubic polynomial; `None` if the prior of the hull is not valid.
pub(super) fn polynomial_priors(prior: &HullPrior) -> Option<[PolynomialLaw; 2]> {
    let of_mmg = |parameters: &MmgParameters| {
        let hull = Mmg::at_speed(parameters.at_unit_length(), 1.0).ok()?;
        Some(DVector::from_vec(accelerations(&CalmHull::Mmg(Box::new(hull), 0.0))))
    };
    let differences =
        prior.deviated_parameters.iter().filter_map(|[above, below]| Some(of_mmg(above)? - of_mmg(below)?));
    let differences = DMatrix::from_columns(&differences.collect::<Vec<_>>()) * (0.5 * SPREAD_FACTOR);
    laws(&of_mmg(&prior.mean_parameters)?, &differences)
}

/// Priors of both polynomials, from the accelerations of the mean hull and their half differences times f; `None` if a
/// fit fails.
fn laws(truth: &DVector<f64>, differences: &DMatrix<f64>) -> Option<[PolynomialLaw; 2]> {
    Some([
        law(CalmHull::<Dual<{ COMMON_TERMS.len() + QUADRATIC_TERMS.len() }>>::Quadratic, truth, differences)?,
        law(CalmHull::<Dual<{ COMMON_TERMS.len() + CUBIC_TERMS.len() }>>::Cubic, truth, differences)?,
    ])
}

/// States of zig-zags and circles: surge, sway and yaw rate in units of L and U, and rudder angle, rad.
fn states() -> impl Iterator<Item = ([f64; 3], f64)> {
    let velocity = |(u, curvature, drift): (f64, f64, f64)| [u, u * (drift - PIVOT * curvature), u * curvature];
    SURGES.into_iter().flat_map(move |u| {
        CURVATURES.into_iter().flat_map(move |curvature| {
            DRIFTS.into_iter().flat_map(move |drift| RUDDERS.map(|rudder| (velocity((u, curvature, drift)), rudder)))
        })
    })
}

/// Accelerations u', v' and r' in every state.
fn accelerations<R: Real>(hull: &CalmHull<R>) -> Vec<R> {
    states().flat_map(|(state, rudder)| hull.accelerations(state.map(R::from), R::from(rudder), 1.0, 0.0)).collect()
}

/// Nearest polynomial by Gauss–Newton steps, and its covariance from differences of the accelerations.
fn law<const N: usize>(
    polynomial: fn([Dual<N>; N]) -> CalmHull<Dual<N>>,
    truth: &DVector<f64>,
    differences: &DMatrix<f64>,
) -> Option<PolynomialLaw> {
    let mut values = DVector::from_fn(N, |place, _| COMMON_TERMS.get(place).map_or(0.0, begin));
    let linearised = |values: &DVector<f64>| {
        let variables = std::array::from_fn(|place| Dual::variable(values[place], place, 1.0));
        let rows = accelerations(&polynomial(variables));
        let by = DMatrix::from_fn(rows.len(), N, |row, column| rows[row].derivatives[column]);
        let residual = DVector::from_fn(rows.len(), |row, _| truth[row] - rows[row].value);
        Some((by.tr_mul(&by).cholesky()?, by, residual))
    };
    for _ in 0..STEPS {
        let (normal, by, residual) = linearised(&values)?;
        values += normal.solve(&by.tr_mul(&residual));
    }
    let (normal, by, _) = linearised(&values)?;
    let spread = normal.solve(&by.tr_mul(differences));
    Some((values, &spread * spread.transpose()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dynamics::ShipInput;
    use crate::ships::{self, ShipModel};
    use crate::vessel::prime::HullModel;
    use crate::vessel::state::{SURGE, SWAY, YAW_RATE};
    use estimation::statistics::median;

    /// u', v' and r' of a hull in every state; `None` for a ship that is a response model.
    fn published(ship: &ships::Ship) -> Option<DVector<f64>> {
        let (ShipModel::Hull(hull), Some(scale)) = (&ship.model, ship.particulars) else { return None };
        let second = scale.length / scale.speed;
        let mut state = vec![0.0; hull.dimension()];
        hull.approach(0.0, 0.0, &mut state);
        let mut rates = state.clone();
        let mut accelerations = Vec::new();
        for ([u, v, r], rudder) in states() {
            (state[SURGE], state[SWAY], state[YAW_RATE]) = (u * scale.speed, v * scale.speed, r / second);
            hull.rates(0.0, &state, &ShipInput { rudder, ..ShipInput::default() }, &mut rates);
            let [u, v, r] = [SURGE, SWAY, YAW_RATE].map(|place| rates[place]);
            accelerations.extend([u * second / scale.speed, v * second / scale.speed, r * second * second]);
        }
        Some(DVector::from_vec(accelerations))
    }

    /// Factor f: from the hulls that entered no formula, from all of them and with each left out. KVLCC2, which entered
    /// some formulas, is nearer.
    #[test]
    fn published_hulls_depart_from_the_formulas_by_so_much() {
        let forms = HullModel::candidates(None);
        let distances = |ship: &ships::Ship| {
            let truth = published(ship)?;
            let nearest = laws(&truth, &DMatrix::zeros(truth.len(), 0)).expect("independent terms");
            let square = |form: &HullModel, (values, _): PolynomialLaw| {
                // Without Y_w, the last coefficient.
                let count = values.len();
                let left = values - DVector::from_fn(count, |place, _| form.coefficients()[place].mean);
                let covariance = form.covariance().view((0, 0), (count, count)).into_owned();
                let precision = covariance.cholesky().expect("a covariance").inverse();
                SPREAD_FACTOR * SPREAD_FACTOR * left.dot(&(precision * &left)) / left.len() as f64
            };
            let squares: Vec<f64> = nearest.into_iter().zip(&forms).map(|(law, form)| square(form, law)).collect();
            Some((ship.name.to_string(), squares))
        };
        let all: Vec<(String, Vec<f64>)> = ships::all_ships().iter().filter_map(distances).collect();
        let (kvlcc2, independent): (Vec<_>, Vec<_>) = all.into_iter().partition(|(name, _)| name.contains("KVLCC2"));
        assert!(kvlcc2.iter().all(|(_, squares)| squares.iter().all(|square| *square < 1.0)), "{kvlcc2:?}");
        for form in 0..2 {
            for left_out in 0..=independent.len() {
                let kept = independent.iter().enumerate().filter(|(place, _)| *place != left_out);
                let mut kept: Vec<f64> = kept.map(|(_, (_, squares))| squares[form]).collect();
                let factor = median(&mut kept).expect("some are left").sqrt();
                assert!(
                    (factor / SPREAD_FACTOR - 1.0).abs() < 0.1,
                    "{form} without {left_out}: {factor} {independent:?}"
                );
            }
        }
    }
}
