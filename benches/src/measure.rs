//! Times measured again and again, work and rival in turn, so that whatever else the machine does slows both alike; and
//! the median with an interval that assumes nothing about how times are distributed.

use std::time::Duration;

use crate::work::Work;

/// A quantity known from repeated measurements.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Measured {
    /// Its value: the median, or criterion's estimate.
    pub value: f64,
    /// 95 % interval of it.
    pub interval: [f64; 2],
    /// The least that was seen; `None` where single samples are not known.
    pub least: Option<f64>,
    /// How many samples there are; 0 where they are not known.
    pub samples: usize,
}

/// Standard deviations that hold 95 % of a normal distribution.
const NORMAL95: f64 = 1.96;

impl Measured {
    /// Median of samples; its interval between order statistics (binomial, normal approximation), which is the whole
    /// range below six samples. `None` without samples.
    pub fn median(samples: impl IntoIterator<Item = f64>) -> Option<Self> {
        let mut sorted: Vec<f64> = samples.into_iter().filter(|sample| sample.is_finite()).collect();
        sorted.sort_by(f64::total_cmp);
        let (last, n) = (sorted.len().checked_sub(1)?, sorted.len() as f64);
        let half = 0.5 * NORMAL95 * n.sqrt();
        let at = |place: f64| sorted[place.clamp(0.0, last as f64) as usize];
        let value = 0.5 * (sorted[last / 2] + sorted[sorted.len() / 2]);
        let interval = [at((0.5 * n - half).floor()), at((0.5 * n + half).ceil())];
        Some(Self { value, interval, least: sorted.first().copied(), samples: sorted.len() })
    }

    /// Half the width of the interval.
    pub fn half_width(&self) -> f64 {
        0.5 * (self.interval[1] - self.interval[0])
    }

    /// The same, so many times as large.
    pub fn times(self, factor: f64) -> Self {
        Self {
            value: self.value * factor,
            interval: self.interval.map(|end| end * factor),
            least: self.least.map(|least| least * factor),
            ..self
        }
    }

    /// This over another quantity that was measured apart from it; the interval is that of the worst case.
    pub fn over(self, other: &Self) -> Self {
        let interval = [self.interval[0] / other.interval[1], self.interval[1] / other.interval[0]];
        Self { value: self.value / other.value, interval, least: None, samples: 0 }
    }
}

/// How much to measure.
#[derive(Debug, Clone, Copy)]
pub struct Effort {
    /// Samples of every work.
    pub rounds: usize,
    /// Samples that are taken however long they last.
    pub fewest: usize,
    /// Time a sample should last at least.
    pub sample: Duration,
    /// Time after which a work is not sampled again.
    pub limit: Duration,
}

impl Effort {
    /// For numbers that are published.
    pub const FULL: Self =
        Self { rounds: 41, fewest: 7, sample: Duration::from_millis(10), limit: Duration::from_secs(12) };

    /// To see that everything works.
    pub const QUICK: Self =
        Self { rounds: 3, fewest: 1, sample: Duration::from_micros(200), limit: Duration::from_millis(500) };
}

/// Samples of every work in s per unit, one per round, the works of a round after each other.
pub fn in_turn(works: &[&Work], effort: &Effort) -> Vec<Vec<f64>> {
    let goes: Vec<u64> = works.iter().map(|work| goes(work, effort.sample)).collect();
    let mut samples = vec![Vec::with_capacity(effort.rounds); works.len()];
    let mut spent = vec![Duration::ZERO; works.len()];
    for round in 0..effort.rounds {
        for (index, work) in works.iter().enumerate() {
            if round >= effort.fewest && spent[index] >= effort.limit {
                continue;
            }
            let time = work.time(goes[index]);
            spent[index] += time;
            samples[index].push(time.as_secs_f64() / (goes[index] as f64 * work.units));
        }
    }
    samples
}

/// How often the work has to be done to last so long; doing so warms it up as well.
fn goes(work: &Work, sample: Duration) -> u64 {
    let mut goes = 1;
    loop {
        let time = work.time(goes);
        if time >= sample {
            return goes;
        }
        let missing = sample.as_secs_f64() / time.as_secs_f64().max(1e-9);
        goes = (goes as f64 * missing.clamp(1.2, 10.0)).ceil() as u64;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn median_and_interval() {
        let found = Measured::median((1..=101).map(f64::from)).expect("samples");
        assert_eq!((found.value, found.least, found.samples), (51.0, Some(1.0), 101));
        // 101/2 ∓ 0.98 √101 = 40.65 and 60.35: the 41st and the 62nd in order.
        assert_eq!(found.interval, [41.0, 62.0]);
        let few = Measured::median([3.0, 1.0, 2.0]).expect("samples");
        assert_eq!((few.value, few.interval), (2.0, [1.0, 3.0]));
        assert_eq!(Measured::median([]), None);
    }

    #[test]
    fn every_work_is_sampled_and_counted_per_unit() {
        let sleep = |name| Work::new(name, || std::thread::sleep(Duration::from_millis(2)));
        let (once, twice) = (sleep("once"), sleep("per unit").of_units(2));
        let effort = Effort { rounds: 4, fewest: 4, sample: Duration::from_millis(1), limit: Duration::ZERO };
        let samples = in_turn(&[&once, &twice], &effort);
        assert!(samples.iter().all(|samples| samples.len() == 4));
        assert!(samples[0].iter().all(|time| *time >= 2e-3) && samples[1].iter().all(|time| *time >= 1e-3));
    }
}
