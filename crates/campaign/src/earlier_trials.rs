//! Priors of hull coefficients from earlier trials, stored in `fit.json` or `trace.json`.

use document::IdentifiedShip;
use document::identified_hull::IdentifiedHull;
use identify::hull::EarlierHull;
use nalgebra::{DMatrix, DVector};
use predict::{PredictError, drawable_hull};
use ship::vessel::prior::HullParticulars;

/// Hulls of an identified ship, as priors of later fits.
///
/// Fails for a stored hull that this program cannot read.
pub fn earlier_hulls(ship: &IdentifiedShip) -> Result<Vec<EarlierHull>, PredictError> {
    ship.hulls.iter().map(earlier_hull).collect()
}

fn earlier_hull(stored: &IdentifiedHull) -> Result<EarlierHull, PredictError> {
    drawable_hull::check(stored)?;
    let particulars = HullParticulars { length: stored.length_m, speed: stored.speed_m_s, ..stored.particulars()? };
    let size = stored.coefficients.len();
    Ok(EarlierHull {
        form: stored.form()?,
        particulars,
        coefficients: DVector::from_vec(stored.values()),
        covariance: DMatrix::from_fn(size, size, |row, column| stored.covariance[row][column]),
    })
}
