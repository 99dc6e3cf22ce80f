//! ErrorSums over replicates in batches: replicate r belongs to batch r mod 256. A bootstrap over batches gives intervals
//! for every function of moments; with no more than 256 replicates each batch is one trial, and it is the ordinary
//! bootstrap.

use std::iter::Sum;

/// Number of batches.
pub const BATCHES: usize = 256;

/// Number, sum and sum of squares.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct BatchSums {
    /// Number of values.
    pub count: f64,
    /// Sum of values less the shift.
    pub first: f64,
    /// Sum of squares of the same.
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

/// The batch of a replicate.
fn batch_of(batches: &mut Vec<BatchSums>, replicate: u64) -> &mut BatchSums {
    let place = (replicate % BATCHES as u64) as usize;
    if batches.len() <= place {
        batches.resize(place + 1, BatchSums::default());
    }
    &mut batches[place]
}

/// ErrorSums of one quantity.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct ErrorSums {
    /// First value: taken off every value, so that a large common error does not drown a small scatter.
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

    /// The batches, up to the last that has a value.
    pub fn batches(&self) -> &[BatchSums] {
        &self.batches
    }

    /// Mean of a total; `None` of nothing.
    pub fn mean(&self, total: &BatchSums) -> Option<f64> {
        (total.count > 0.0).then(|| self.shift + total.first / total.count)
    }

    /// Standard deviation of a total; `None` below two values.
    pub fn sd(&self, total: &BatchSums) -> Option<f64> {
        let n = total.count;
        (n > 1.0).then(|| ((total.second - total.first * total.first / n).max(0.0) / (n - 1.0)).sqrt())
    }

    /// Root mean square of a total; `None` of nothing.
    pub fn rms(&self, total: &BatchSums) -> Option<f64> {
        let (n, c) = (total.count, self.shift);
        (n > 0.0).then(|| ((total.second + 2.0 * c * total.first) / n + c * c).max(0.0).sqrt())
    }
}

/// ErrorSums of the squares of two quantities on trials where both are known: [`BatchSums::first`] belongs to the one,
/// [`BatchSums::second`] to the other.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct PairSums {
    batches: Vec<BatchSums>,
    /// Trials in which the one is the smaller, counting a tie half.
    pub smaller: f64,
}

impl PairSums {
    /// Adds a replicate.
    pub fn add(&mut self, replicate: u64, one: f64, other: f64) {
        let batch = batch_of(&mut self.batches, replicate);
        batch.count += 1.0;
        batch.first += one * one;
        batch.second += other * other;
        self.smaller += match one.abs().total_cmp(&other.abs()) {
            std::cmp::Ordering::Less => 1.0,
            std::cmp::Ordering::Equal => 0.5,
            std::cmp::Ordering::Greater => 0.0,
        };
    }

    /// The batches.
    pub fn batches(&self) -> &[BatchSums] {
        &self.batches
    }

    /// Trials in which both are known.
    pub fn trials(&self) -> u64 {
        self.batches.iter().map(|batch| batch.count).sum::<f64>() as u64
    }

    /// Difference of the root mean squares of a total.
    pub fn difference(total: &BatchSums) -> Option<f64> {
        (total.count > 0.0).then(|| (total.first / total.count).sqrt() - (total.second / total.count).sqrt())
    }

    /// Their ratio; `None` where the other is zero.
    pub fn ratio(total: &BatchSums) -> Option<f64> {
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
        assert_eq!(sums.batches().len(), BATCHES);
        let sd = sums.sd(&total).expect("enough");
        assert!((sd / 0.5e-9 - 1.0).abs() < 1e-3, "{sd}");
        assert!((sums.rms(&total).expect("some") - 6.53).abs() < 1e-8);
        assert!((sums.mean(&total).expect("some") + 6.53).abs() < 1e-8);
    }

    #[test]
    fn pairs_compare_root_mean_squares() {
        let mut pairs = PairSums::default();
        [(3.0, 1.0), (-3.0, 1.0), (3.0, -3.0)].iter().zip(0..).for_each(|(&(one, other), r)| pairs.add(r, one, other));
        let total = total(pairs.batches());
        let rms = (11.0_f64 / 3.0).sqrt();
        assert!((PairSums::difference(&total).expect("some") - (3.0 - rms)).abs() < 1e-12);
        assert!((PairSums::ratio(&total).expect("some") - 3.0 / rms).abs() < 1e-12);
        assert_eq!(pairs.smaller, 0.5);
    }
}
