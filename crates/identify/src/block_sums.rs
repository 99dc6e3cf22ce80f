//! Variance of a sum of correlated terms from the sums of consecutive blocks: what a least-squares estimate needs when
//! its residual is coloured, in one pass and without storing the terms.

use nalgebra::{Matrix3, Vector3};

/// Blocks that all records together are cut into. Few, so that a block outlasts the correlation of the residual
/// (waves, gusts); the price is a wide Student t.
const BLOCKS: usize = 16;

/// Fewest blocks that give a covariance.
const FEWEST: usize = 8;

/// Accumulates Σ_blocks (Σ s)(Σ s)ᵀ for scores s of three parameters.
///
/// Source: Bester, Conley and Hansen (2011), covariance estimators with time blocks as clusters.
#[derive(Debug, Clone)]
pub struct BlockSums {
    length: usize,
    filled: usize,
    blocks: usize,
    open: Vector3<f64>,
    outer: Matrix3<f64>,
}

impl BlockSums {
    /// For `terms` scores in total, over all records.
    pub fn new(terms: usize) -> Self {
        Self {
            length: terms.div_ceil(BLOCKS).max(1),
            filled: 0,
            blocks: 0,
            open: Vector3::zeros(),
            outer: Matrix3::zeros(),
        }
    }

    /// Adds the next score.
    #[inline]
    pub fn add(&mut self, score: Vector3<f64>) {
        self.open += score;
        self.filled += 1;
        if self.filled == self.length {
            self.close();
        }
    }

    /// Ends the open block, as at the end of a record.
    pub fn close(&mut self) {
        if self.filled > 0 {
            self.outer += self.open * self.open.transpose();
            self.blocks += 1;
            (self.filled, self.open) = (0, Vector3::zeros());
        }
    }

    /// Covariance of the sum of all scores and its degrees of freedom.
    ///
    /// The three parameters make the scores sum to zero, which takes three degrees of freedom from the blocks.
    /// `None` with fewer than `FEWEST` blocks, too poor a base for a 3 × 3 matrix.
    pub fn covariance(mut self) -> Option<(Matrix3<f64>, f64)> {
        self.close();
        let (blocks, freedom) = (self.blocks as f64, self.blocks as f64 - 3.0);
        (self.blocks >= FEWEST).then(|| (self.outer * (blocks / freedom), freedom))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    #[test]
    fn terms_that_repeat_in_a_block_count_as_one() {
        // Sixteen blocks of ten equal terms ±1: the variance of the sum is 16 · 10², not 160.
        let mut sums = BlockSums::new(160);
        for k in 0..160 {
            sums.add(Vector3::new(if (k / 10) % 2 == 0 { 1.0 } else { -1.0 }, 0.0, 0.0));
        }
        let (covariance, freedom) = sums.covariance().expect("sixteen blocks");
        assert_eq!(freedom, 13.0);
        assert_relative_eq!(covariance[(0, 0)], 1600.0 * 16.0 / 13.0, max_relative = 1e-12);
    }

    #[test]
    fn too_few_blocks_give_nothing() {
        let mut sums = BlockSums::new(4);
        (0..4).for_each(|_| sums.add(Vector3::new(1.0, 2.0, 3.0)));
        assert!(sums.covariance().is_none());
    }
}
