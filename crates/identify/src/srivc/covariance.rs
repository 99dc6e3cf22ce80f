//! Covariance of the estimate: of refined instrumental variables for a white residual (Young and Jakeman 1980), and the
//! sandwich of Newey and West (1987) for a coloured residual.

use nalgebra::{Matrix3, Vector3};

use super::filter::{Filters, InstrumentalEquations, Point};
use super::record::SrivcRecord;
use crate::robust;

/// Statistics of the residuals of the simulated heading at the estimate, and the covariance of the estimate.
pub(super) struct ResidualStatistics {
    /// Number of residuals.
    pub count: usize,
    /// Residual sum of squares, rad².
    pub rss: f64,
    /// Sum of squares of the heading about its mean, trial by trial, rad².
    pub total_sum_of_squares: f64,
    /// Correlation of neighbouring residuals.
    pub lag1_correlation: f64,
    /// Number of residuals minus unknowns: three shared unknowns and two per record.
    pub degrees_of_freedom: f64,
    /// Covariance of the shared unknowns for a white residual e, σ² (Z̃ᵀZ̃)⁻¹.
    pub white_covariance: Matrix3<f64>,
    /// Covariance of the shared unknowns for a coloured residual, (Z̃ᵀZ̃)⁻¹ Ω (Z̃ᵀZ̃)⁻¹, Ω the long-run covariance of
    /// z̃ e.
    pub robust_covariance: Matrix3<f64>,
}

impl ResidualStatistics {
    /// Statistics and covariance over all records, filtered with the final estimate.
    ///
    /// `None` if Z̃ᵀZ̃ is singular or without degrees of freedom for the variance.
    pub fn new(records: &[SrivcRecord], point: &Point, blocks: &[InstrumentalEquations]) -> Option<Self> {
        let count: usize = records.iter().map(|record| record.observed_headings).sum();
        let degrees_of_freedom = count as f64 - 3.0 - 2.0 * records.len() as f64;
        if degrees_of_freedom <= 0.0 {
            return None;
        }
        let (mut rss, mut total_sum_of_squares) = (0.0, 0.0);
        let mut residuals = Vec::with_capacity(records.len());
        let mut scores = Vec::with_capacity(records.len());
        for ((record, block), &start) in records.iter().zip(blocks).zip(&point.starts) {
            let mut record_residuals = Vec::with_capacity(record.observed_headings);
            let mut record_scores = [(); 3].map(|()| Vec::with_capacity(record.observed_headings));
            let (mut sum, mut squares) = (0.0, 0.0);
            Filters::run(record, point.shared, start, |row, filters| {
                let residual = row.heading - filters.motion.heading;
                let z = filters.instrumental_variables();
                let projected: Vector3<f64> = z.fixed_rows::<3>(0) - block.along * z.fixed_rows::<2>(3);
                record_scores
                    .iter_mut()
                    .zip(&projected)
                    .for_each(|(score, z): (&mut Vec<f64>, _)| score.push(z * residual));
                record_residuals.push(residual);
                rss += residual * residual;
                sum += row.heading;
                squares += row.heading * row.heading;
            });
            total_sum_of_squares += squares - sum * sum / record.observed_headings as f64;
            residuals.push(record_residuals);
            scores.push(record_scores);
        }
        let inverse = blocks.iter().map(|block| block.instruments).sum::<Matrix3<f64>>().try_inverse()?;
        let omega = robust::newey_west_three(&scores) * (count as f64 / degrees_of_freedom);
        Some(Self {
            count,
            rss,
            total_sum_of_squares,
            lag1_correlation: robust::lag1_autocorrelation(residuals.iter().map(Vec::as_slice)),
            degrees_of_freedom,
            white_covariance: inverse * (rss / degrees_of_freedom),
            robust_covariance: inverse * omega * inverse,
        })
    }
}
