//! Hulls that earlier trials left in `fit.json` or `trace.json`, as what is expected of the next ones.

use identify::hull::EarlierHull;
use nalgebra::{DMatrix, DVector};
use predict::stored_hull::StoredHull;
use predict::{IdentifiedShip, PredictError};
use ship::vessel::prior::HullParticulars;

/// The hulls of an identified ship, each with the particulars of all.
///
/// Fails for a hull that is none of this program.
pub fn hulls_of(ship: &IdentifiedShip) -> Result<Vec<EarlierHull>, PredictError> {
    let most = ship.hulls.iter().max_by_key(|own| own.particulars.len());
    ship.hulls.iter().map(|own| earlier(own, most.unwrap_or(own))).collect()
}

fn earlier(own: &StoredHull, with_particulars: &StoredHull) -> Result<EarlierHull, PredictError> {
    own.check()?;
    let (length, speed) = (own.length_m, own.speed_m_s);
    let particulars = HullParticulars { length, speed, ..with_particulars.particulars()? };
    let size = own.coefficients.len();
    Ok(EarlierHull {
        form: own.form()?,
        particulars,
        values: DVector::from_vec(own.values()),
        covariance: DMatrix::from_fn(size, size, |row, column| own.covariance[row][column]),
    })
}
