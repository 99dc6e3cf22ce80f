//! Quantiles and ranks of scores, with infinite scores for failed estimates and bootstrap intervals (Efron 1979).

use std::cmp::Ordering;

use estimation::statistics::quantile;
use serde::{Deserialize, Serialize};

use crate::statistics::{Moments, percentile_interval};

/// Statistic of scores with its 95 % interval.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ScoreFigure {
    /// Value; `null` if it falls on a failed estimate.
    pub value: Option<f64>,
    /// 95 % interval, for six clusters or more; an end is `null` if it falls on a failed estimate.
    pub ci95: Option<[Option<f64>; 2]>,
}

impl ScoreFigure {
    /// Statistic with the percentile interval of its resampled values, in any order; no interval below six clusters.
    pub fn new(value: f64, clusters: usize, resampled: Vec<f64>) -> Self {
        let finite = |value: f64| value.is_finite().then_some(value);
        Self { value: finite(value), ci95: percentile_interval(clusters, resampled).map(|ends| ends.map(finite)) }
    }

    /// Order by value; a statistic that falls on a failed estimate comes last.
    pub(super) fn order(&self, other: &Self) -> Ordering {
        let [value, other] = [self, other].map(|figure| figure.value.unwrap_or(f64::INFINITY));
        value.total_cmp(&other)
    }
}

/// Mean; NaN without values.
pub(super) fn mean(values: impl Iterator<Item = f64>) -> f64 {
    let mut moments = Moments::default();
    values.for_each(|value| moments.add(value));
    if moments.count > 0.0 { moments.mean } else { f64::NAN }
}

/// Median and 90 % quantile of scores; infinite if it falls on a failed estimate.
pub fn median_and_p90(mut scores: Vec<f64>) -> [f64; 2] {
    scores.sort_by(f64::total_cmp);
    [0.5, 0.9].map(|p| quantile(&scores, p))
}

/// Ratio of a score to the reference score in the same case: 1 if both failed, infinite if only the method failed, 0 if
/// only the reference failed.
pub fn ratio(score: f64, reference: f64) -> f64 {
    if score == reference { 1.0 } else { score / reference }
}

/// Ranks of scores from 1, in increasing order; ties share their mean rank.
pub fn ranks(scores: &[f64]) -> Vec<f64> {
    let rank = |score: &f64| {
        let smaller = scores.iter().filter(|other| *other < score).count();
        let equal = scores.iter().filter(|other| *other == score).count();
        smaller as f64 + 0.5 * (equal as f64 + 1.0)
    };
    scores.iter().map(rank).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::statistics::resample_clusters;
    use rand::rngs::ChaCha8Rng;
    use rand::{RngExt, SeedableRng};
    use std::f64::consts::LN_2;

    const WORST: f64 = f64::INFINITY;

    #[test]
    fn quantiles_know_answers_that_failed() {
        assert_eq!(median_and_p90(vec![3.0, 1.0, 2.0]), [2.0, 2.8]);
        assert_eq!(median_and_p90(vec![1.0, WORST, 2.0, 3.0]), [2.5, WORST]);
        assert_eq!(median_and_p90(vec![1.0, WORST]), [WORST, WORST]);
        assert_eq!(median_and_p90(vec![WORST; 4]), [WORST, WORST]);
    }

    #[test]
    fn equal_scores_share_a_rank() {
        assert_eq!(ranks(&[2.0, 1.0, WORST, 2.0, WORST]), [2.5, 1.0, 4.5, 2.5, 4.5]);
        assert_eq!(
            [ratio(WORST, WORST), ratio(WORST, 1.0), ratio(1.0, WORST), ratio(0.0, 0.0)],
            [1.0, WORST, 0.0, 1.0]
        );
    }

    /// Intervals of the median of exponential random numbers, whose median is ln 2: they repeat and cover 95 % within
    /// the error of 300 samples; equal pairs count as one.
    #[test]
    fn intervals_cover_what_they_say() {
        let mut rng = ChaCha8Rng::seed_from_u64(3);
        let samples = 300;
        let covered = (0..samples).filter(|sample| {
            let values: Vec<f64> = (0..40).map(|_| -rng.random::<f64>().ln()).collect();
            // Every number twice, in a cluster of its own.
            let clusters: Vec<Vec<usize>> = (0..40).map(|place| vec![place, place]).collect();
            let of = |cases: &[usize]| median_and_p90(cases.iter().map(|&case| values[case]).collect())[0];
            let figure = ScoreFigure::new(of(&clusters.concat()), clusters.len(), resample_clusters(&clusters, of));
            if *sample == 0 {
                assert_eq!(
                    figure,
                    ScoreFigure::new(of(&clusters.concat()), clusters.len(), resample_clusters(&clusters, of))
                );
            }
            let [Some(low), Some(high)] = figure.ci95.expect("enough clusters") else { panic!("finite") };
            low <= LN_2 && LN_2 <= high
        });
        let share = covered.count() as f64 / f64::from(samples);
        assert!((0.91..0.985).contains(&share), "{share}");
    }

    #[test]
    fn few_clusters_have_no_interval() {
        assert_eq!(ScoreFigure::new(1.0, 5, vec![1.0; 10]), ScoreFigure { value: Some(1.0), ci95: None });
        assert_eq!(
            ScoreFigure::new(WORST, 6, vec![1.0, WORST]),
            ScoreFigure { value: None, ci95: Some([Some(1.0), None]) }
        );
    }
}
