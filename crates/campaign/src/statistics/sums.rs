//! Batch sums over replicates: replicate r belongs to batch r mod 256. A bootstrap over batches (Efron 1979) gives
//! intervals for all functions of moments; up to 256 replicates each batch is one trial, as in the ordinary bootstrap.

use std::iter::Sum;

/// Number of batches of the bootstrap.
pub const BATCH_COUNT: usize = 256;

/// Two sums over the values or pairs of one batch; their meaning depends on the owner, [`ErrorSums`] or
/// [`PairedErrorSums`].
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct BatchSums {
    /// Number of values, or of pairs.
    pub count: f64,
    /// Sum of the differences of the values from a common shift; of pairs, the sum of the squared errors of the method.
    pub first: f64,
    /// Sum of the squares of these differences; of pairs, the sum of the squared errors of the reference.
    pub second: f64,
}

impl Sum for BatchSums {
    fn sum<I: Iterator<Item = Self>>(batches: I) -> Self {
        batches.fold(Self::default(), |sum, batch| Self {
            count: sum.count + batch.count,
            first: sum.first + batch.first,
            second: sum.second + batch.second,
        })
    }
}

/// Sums of the batch of a replicate, which is its number modulo [`BATCH_COUNT`]; missing batches are added.
fn batch_of(batches: &mut Vec<BatchSums>, replicate: u64) -> &mut BatchSums {
    let place = (replicate % BATCH_COUNT as u64) as usize;
    if batches.len() <= place {
        batches.resize(place + 1, BatchSums::default());
    }
    &mut batches[place]
}

/// Batch sums of one quantity, in its unit, from which mean, standard deviation and root mean square follow.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct ErrorSums {
    /// First value, subtracted from every value so that a large bias does not cancel the digits of a small scatter.
    shift: f64,
    batches: Vec<BatchSums>,
}

impl ErrorSums {
    /// Adds the value of a replicate.
    pub fn add(&mut self, replicate: u64, value: f64) {
        if self.batches.is_empty() {
            self.shift = value;
        }
        let x = value - self.shift;
        let batch = batch_of(&mut self.batches, replicate);
        batch.count += 1.0;
        batch.first += x;
        batch.second += x * x;
    }

    /// Batches, up to the last one with a value.
    pub fn batches(&self) -> &[BatchSums] {
        &self.batches
    }

    /// Mean of the values in a total of batches; `None` without values.
    pub fn mean(&self, total: &BatchSums) -> Option<f64> {
        (total.count > 0.0).then(|| self.shift + total.first / total.count)
    }

    /// Standard deviation of the values in a total of batches; `None` below two values.
    pub fn sd(&self, total: &BatchSums) -> Option<f64> {
        let n = total.count;
        (n > 1.0).then(|| ((total.second - total.first * total.first / n).max(0.0) / (n - 1.0)).sqrt())
    }

    /// Root mean square of the values in a total of batches; `None` without values.
    pub fn rms(&self, total: &BatchSums) -> Option<f64> {
        let (n, c) = (total.count, self.shift);
        (n > 0.0).then(|| ((total.second + 2.0 * c * total.first) / n + c * c).max(0.0).sqrt())
    }
}

/// Sums, batch by batch, over the trials with an estimate of both methods: of the squared errors of the method, in
/// [`BatchSums::first`], and of those of the reference method, in [`BatchSums::second`].
#[derive(Debug, Clone, Default, PartialEq)]
pub struct PairedErrorSums {
    batches: Vec<BatchSums>,
    /// Number of trials in which the error of the method is smaller; ties count half.
    pub smaller_error_count: f64,
}

impl PairedErrorSums {
    /// Adds the errors of the method and of the reference in a replicate.
    pub fn add(&mut self, replicate: u64, error: f64, reference: f64) {
        let batch = batch_of(&mut self.batches, replicate);
        batch.count += 1.0;
        batch.first += error * error;
        batch.second += reference * reference;
        self.smaller_error_count += match error.abs().total_cmp(&reference.abs()) {
            std::cmp::Ordering::Less => 1.0,
            std::cmp::Ordering::Equal => 0.5,
            std::cmp::Ordering::Greater => 0.0,
        };
    }

    /// Batches, up to the last one with a trial.
    pub fn batches(&self) -> &[BatchSums] {
        &self.batches
    }

    /// Number of trials with both errors.
    pub fn trial_count(&self) -> u64 {
        self.batches.iter().map(|batch| batch.count).sum::<f64>() as u64
    }

    /// Difference of the root mean square errors, method minus reference, in a total of batches; `None` without trials.
    pub fn rms_difference(total: &BatchSums) -> Option<f64> {
        (total.count > 0.0).then(|| (total.first / total.count).sqrt() - (total.second / total.count).sqrt())
    }

    /// Ratio of root mean square errors, method over reference, in a total of batches; `None` for a reference of zero.
    pub fn rms_ratio(total: &BatchSums) -> Option<f64> {
        (total.second > 0.0).then(|| (total.first / total.second).sqrt())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn total(batches: &[BatchSums]) -> BatchSums {
        batches.iter().copied().sum()
    }

    #[test]
    fn a_small_scatter_about_a_large_error_is_kept() {
        let mut sums = ErrorSums::default();
        (0..1000).for_each(|replicate| sums.add(replicate, -6.53 + 1e-9 * f64::from(u8::from(replicate % 2 == 0))));
        let total = total(sums.batches());
        assert_eq!(sums.batches().len(), BATCH_COUNT);
        let sd = sums.sd(&total).expect("enough");
        assert!((sd / 0.5e-9 - 1.0).abs() < 1e-3, "{sd}");
        assert!((sums.rms(&total).expect("some") - 6.53).abs() < 1e-8);
        assert!((sums.mean(&total).expect("some") + 6.53).abs() < 1e-8);
    }

    #[test]
    fn pairs_compare_root_mean_squares() {
        let mut pairs = PairedErrorSums::default();
        [(3.0, 1.0), (-3.0, 1.0), (3.0, -3.0)].iter().zip(0..).for_each(|(&(a, b), r)| pairs.add(r, a, b));
        let total = total(pairs.batches());
        let rms = (11.0_f64 / 3.0).sqrt();
        assert!((PairedErrorSums::rms_difference(&total).expect("some") - (3.0 - rms)).abs() < 1e-12);
        assert!((PairedErrorSums::rms_ratio(&total).expect("some") - 3.0 / rms).abs() < 1e-12);
        assert_eq!(pairs.smaller_error_count, 0.5);
    }
}
