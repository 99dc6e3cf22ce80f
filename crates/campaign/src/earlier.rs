//! Hulls that earlier trials left in `fit.json` or `trace.json`, as what is expected of the next ones.

use document::IdentifiedShip;
use document::stored_hull::StoredHull;
use identify::hull::EarlierHull;
use nalgebra::{DMatrix, DVector};
use predict::{PredictError, drawable_hull};
use ship::vessel::prior::HullParticulars;

/// The hulls of an identified ship.
///
/// Fails for a hull that is none of this program.
pub fn hulls_of(ship: &IdentifiedShip) -> Result<Vec<EarlierHull>, PredictError> {
    ship.hulls.iter().map(earlier).collect()
}

fn earlier(own: &StoredHull) -> Result<EarlierHull, PredictError> {
    drawable_hull::check(own)?;
    let particulars = HullParticulars { length: own.length_m, speed: own.speed_m_s, ..own.particulars()? };
    let size = own.coefficients.len();
    Ok(EarlierHull {
        form: own.form()?,
        particulars,
        values: DVector::from_vec(own.values()),
        covariance: DMatrix::from_fn(size, size, |row, column| own.covariance[row][column]),
    })
}
