//! Square root of a covariance, by the eigenvalues of its correlation matrix.

use nalgebra::DMatrix;

use crate::error::PredictError;

/// Square root S U √Λ of a covariance with standard deviations S, whose correlation matrix has eigenvectors U and
/// eigenvalues Λ; small negative eigenvalues count as zero. Fails with [`PredictError::Covariance`] for a matrix that
/// is not a covariance.
pub(crate) fn covariance_root(covariance: &[Vec<f64>]) -> Result<DMatrix<f64>, PredictError> {
    let count = covariance.len();
    if count == 0 {
        return Ok(DMatrix::zeros(0, 0));
    }
    if covariance.iter().any(|row| row.len() != count) {
        return Err(PredictError::Covariance);
    }
    let matrix = DMatrix::from_fn(count, count, |i, j| covariance[i][j]);
    // Parameters have different units, so the test uses correlations.
    let sd: Vec<f64> = (0..count).map(|k| matrix[(k, k)].max(0.0).sqrt()).collect();
    let scale = |k: usize| if sd[k] > 0.0 { sd[k] } else { 1.0 };
    let correlation =
        DMatrix::from_fn(count, count, |i, j| 0.5 * (matrix[(i, j)] + matrix[(j, i)]) / (scale(i) * scale(j)));
    if correlation.iter().any(|entry| !entry.is_finite()) {
        return Err(PredictError::Covariance);
    }
    let eigen = correlation.symmetric_eigen();
    let largest = eigen.eigenvalues.iter().copied().fold(0.0, f64::max);
    if eigen.eigenvalues.iter().any(|value| *value < -1e-6 * largest.max(1.0)) {
        return Err(PredictError::Covariance);
    }
    let roots = eigen.eigenvalues.map(|value| value.max(0.0).sqrt());
    Ok(DMatrix::from_fn(count, count, |i, j| scale(i) * eigen.eigenvectors[(i, j)] * roots[j]))
}
