//! Bootstrap over batches (Efron 1979). The resamples are drawn once and used for all statistics, so that statistics
//! of two methods are paired.

use rand::rngs::ChaCha8Rng;
use rand::{RngExt, SeedableRng};

use super::statistic::{MIN_INTERVAL_VALUES, Statistic};
use super::sums::BatchSums;

/// Number of bootstrap resamples, sufficient for the 2.5 and 97.5 % points to two digits.
pub const RESAMPLE_COUNT: usize = 1000;

/// Fixed seed of the bootstrap, so that equal rows give equal intervals.
pub const BOOTSTRAP_SEED: u64 = 1979;

/// Multiplicity of each batch in each resample.
#[derive(Debug, Clone)]
pub struct Resamples {
    batches: usize,
    /// [`RESAMPLE_COUNT`] counts of every batch, batch by batch.
    counts: Vec<u8>,
}

impl Resamples {
    /// 1000 resamples of `batches` batches, drawn with replacement from a fixed seed.
    pub fn new(batches: usize) -> Self {
        let mut rng = ChaCha8Rng::seed_from_u64(BOOTSTRAP_SEED);
        let mut counts = vec![0u8; RESAMPLE_COUNT * batches];
        for resample in 0..RESAMPLE_COUNT {
            for _ in 0..batches {
                let drawn: usize = rng.random_range(0..batches);
                let count = &mut counts[drawn * RESAMPLE_COUNT + resample];
                *count = count.saturating_add(1);
            }
        }
        Self { batches, counts }
    }

    /// Number of batches.
    pub fn batches(&self) -> usize {
        self.batches
    }

    /// Statistics of the sum of all batches, with percentile 95 % intervals; `None` for an undefined statistic. No
    /// interval below six values, for more batches than were resampled, and unless most resamples define the statistic.
    pub fn bootstrap<const N: usize>(
        &self,
        batches: &[BatchSums],
        statistics: impl Fn(&BatchSums) -> [Option<f64>; N],
    ) -> [Option<Statistic>; N] {
        let whole = batches.iter().copied().sum::<BatchSums>();
        let values = statistics(&whole);
        if whole.count < MIN_INTERVAL_VALUES as f64 || batches.len() > self.batches {
            return values.map(|value| value.map(|value| Statistic { value, ci95: None }));
        }
        let mut resampled: [Vec<f64>; N] = std::array::from_fn(|_| Vec::with_capacity(RESAMPLE_COUNT));
        for total in self.totals(batches) {
            for (all, value) in resampled.iter_mut().zip(statistics(&total)) {
                all.extend(value.filter(|value| value.is_finite()));
            }
        }
        std::array::from_fn(|k| {
            let value = values[k]?;
            let all = &mut resampled[k];
            // No interval for a statistic that is undefined in most resamples.
            let ci95 = (all.len() > RESAMPLE_COUNT / 2).then(|| {
                let rank = |p: f64| ((all.len() - 1) as f64 * p).round() as usize;
                let (low, high) = (rank(0.025), rank(0.975));
                let (below, &mut high, _) = all.select_nth_unstable_by(high, f64::total_cmp);
                let (_, &mut low, _) = below.select_nth_unstable_by(low, f64::total_cmp);
                [low, high]
            });
            Some(Statistic { value, ci95 })
        })
    }

    /// Sums of every resample, accumulated batch by batch so that the inner loop is vectorised over resamples.
    fn totals(&self, batches: &[BatchSums]) -> impl Iterator<Item = BatchSums> {
        let [mut counts, mut firsts, mut seconds] = [const { [0.0; RESAMPLE_COUNT] }; 3];
        for (batch, times) in batches.iter().zip(self.counts.chunks_exact(RESAMPLE_COUNT)) {
            let sums = counts.iter_mut().zip(&mut firsts).zip(&mut seconds);
            for (((count, first), second), &n) in sums.zip(times) {
                let n = f64::from(n);
                *count += n * batch.count;
                *first += n * batch.first;
                *second += n * batch.second;
            }
        }
        counts.into_iter().zip(firsts).zip(seconds).map(|((count, first), second)| BatchSums { count, first, second })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::statistics::{BATCH_COUNT, ErrorSums};
    use rand_distr::StandardNormal;

    /// Intervals of the sd of normal samples cover 95 % within the error of 400 samples, for batches of one value and
    /// of several.
    #[test]
    fn intervals_cover_what_they_say() {
        for (size, fewest) in [(200, 0.91), (2000, 0.92)] {
            let resamples = Resamples::new(BATCH_COUNT.min(size));
            let samples = 400;
            let mut rng = ChaCha8Rng::seed_from_u64(5);
            let covered = (0..samples).filter(|_| {
                let mut sums = ErrorSums::default();
                (0..size as u64).for_each(|replicate| sums.add(replicate, rng.sample::<f64, _>(StandardNormal)));
                let [sd] = resamples.bootstrap(sums.batches(), |total| [sums.sd(total)]);
                let [lo, hi] = sd.and_then(|figure| figure.ci95).expect("enough values");
                lo <= 1.0 && 1.0 <= hi
            });
            let share = covered.count() as f64 / f64::from(samples);
            assert!((fewest..0.985).contains(&share), "{size}: {share}");
        }
    }

    #[test]
    fn few_values_have_no_interval() {
        let mut sums = ErrorSums::default();
        (0..5).for_each(|replicate| sums.add(replicate, replicate as f64));
        let [mean, none] = Resamples::new(5).bootstrap(sums.batches(), |total| [sums.mean(total), None]);
        assert_eq!((mean, none), (Some(Statistic { value: 2.0, ci95: None }), None));
    }
}
