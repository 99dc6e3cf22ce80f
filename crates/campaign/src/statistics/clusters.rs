//! Cluster bootstrap: intervals by resampling clusters with replacement (Efron 1979; Field and Welsh 2007).

use rand::rngs::ChaCha8Rng;
use rand::{RngExt, SeedableRng};

use super::bootstrap::{BOOTSTRAP_SEED, RESAMPLE_COUNT};
use super::statistic::MIN_INTERVAL_VALUES;

/// Values of `compute` on the cases of each of 1000 resamples of the clusters; a cluster is a list of case indices.
pub fn resample_clusters<T>(clusters: &[Vec<usize>], compute: impl Fn(&[usize]) -> T) -> Vec<T> {
    draws(|rng, cases| draw_clusters(clusters, rng, cases), compute)
}

/// Values of `compute` on the cases of each of 1000 two-stage resamples: of the sets, and of the clusters in each set.
pub fn resample_sets<T>(sets: &[Vec<Vec<usize>>], compute: impl Fn(&[usize]) -> T) -> Vec<T> {
    let draw = |rng: &mut ChaCha8Rng, cases: &mut Vec<usize>| {
        (0..sets.len()).for_each(|_| draw_clusters(&sets[rng.random_range(0..sets.len())], rng, cases));
    };
    draws(draw, compute)
}

/// Percentile 95 % interval of resampled values, in any order; `None` below six clusters, and without values.
pub fn percentile_interval(clusters: usize, mut values: Vec<f64>) -> Option<[f64; 2]> {
    values.sort_by(f64::total_cmp);
    let end = |p: f64| values[((values.len() - 1) as f64 * p).round() as usize];
    (clusters as u64 >= MIN_INTERVAL_VALUES && !values.is_empty()).then(|| [end(0.025), end(0.975)])
}

fn draw_clusters(clusters: &[Vec<usize>], rng: &mut ChaCha8Rng, cases: &mut Vec<usize>) {
    (0..clusters.len()).for_each(|_| cases.extend(&clusters[rng.random_range(0..clusters.len())]));
}

fn draws<T>(draw: impl Fn(&mut ChaCha8Rng, &mut Vec<usize>), compute: impl Fn(&[usize]) -> T) -> Vec<T> {
    let mut rng = ChaCha8Rng::seed_from_u64(BOOTSTRAP_SEED);
    let mut cases = Vec::new();
    let value = |_| {
        cases.clear();
        draw(&mut rng, &mut cases);
        compute(&cases)
    };
    (0..RESAMPLE_COUNT).map(value).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A sampled set contributes all its clusters, for sets of very different size.
    #[test]
    fn sets_are_drawn_whole() {
        let sets = vec![vec![vec![0]; 30], vec![vec![1]; 2]];
        let sizes = resample_sets(&sets, <[usize]>::len);
        assert!(sizes.iter().all(|size| [4, 32, 60].contains(size)), "{sizes:?}");
    }
}
