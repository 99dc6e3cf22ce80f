//! Distributions of errors, for figures: over all cells, and in single cells where that was asked for.

use crate::statistics::Ordered;

/// Steps of an empirical distribution: more cannot be told apart in print.
const STEPS: u64 = 200;

/// Places of a density.
const PLACES: usize = 160;

/// Pairs of errors kept of a cell.
pub(super) const MOST_PAIRS: usize = 2000;

/// Pairs of errors shown of a cell.
const SHOWN_PAIRS: usize = 400;

/// Errors beyond so many robust standard deviations are drawn in before a covariance is taken: a few wild answers would
/// otherwise blow up the ellipse of all others.
const REACH: f64 = 4.0;

/// Standard deviation of a normal distribution over its median absolute deviation.
const SD_OVER_MAD: f64 = 1.482_602_2;

/// A distribution as a violin.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Violin {
    /// Places, per cent, and densities; empty where the values are all the same.
    pub density: Vec<(f64, f64)>,
    /// Quantiles 2.5, 25, 50, 75 and 97.5 %.
    pub quantiles: [f64; 5],
}

impl Violin {
    /// Of errors in per cent; `None` of nothing.
    pub(super) fn of(errors: &Ordered) -> Option<Self> {
        let quantile = |p: f64| errors.quantile(p);
        let quantiles = [quantile(0.025)?, quantile(0.25)?, quantile(0.5)?, quantile(0.75)?, quantile(0.975)?];
        Some(Self { density: errors.density(PLACES), quantiles })
    }
}

/// Errors of K and T together, per cent.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Cloud {
    /// The first of them.
    pub points: Vec<(f64, f64)>,
    /// Their centre.
    pub centre: (f64, f64),
    /// Their covariance, wild answers drawn in.
    pub covariance: [[f64; 2]; 2],
}

impl Cloud {
    /// Of errors of K and T; `None` below ten.
    pub(super) fn of(pairs: &[(f64, f64)]) -> Option<Self> {
        if pairs.len() < 10 {
            return None;
        }
        let drawn_in = |get: fn(&(f64, f64)) -> f64| -> Vec<f64> {
            let mut sample = crate::statistics::Sample::default();
            pairs.iter().for_each(|pair| sample.add(get(pair)));
            let ordered = sample.ordered();
            let centre = ordered.quantile(0.5).unwrap_or(0.0);
            let reach = REACH * SD_OVER_MAD * ordered.mad().map_or(0.0, |mad| mad.value);
            pairs.iter().map(|pair| get(pair).clamp(centre - reach, centre + reach)).collect()
        };
        let (k, t) = (drawn_in(|pair| pair.0), drawn_in(|pair| pair.1));
        let n = pairs.len() as f64;
        let mean = |values: &[f64]| values.iter().sum::<f64>() / n;
        let centre = (mean(&k), mean(&t));
        let covariance = |one: &[f64], a: f64, other: &[f64], b: f64| {
            one.iter().zip(other).map(|(x, y)| (x - a) * (y - b)).sum::<f64>() / (n - 1.0)
        };
        let cross = covariance(&k, centre.0, &t, centre.1);
        Some(Self {
            points: pairs[..pairs.len().min(SHOWN_PAIRS)].to_vec(),
            centre,
            covariance: [
                [covariance(&k, centre.0, &k, centre.0), cross],
                [cross, covariance(&t, centre.1, &t, centre.1)],
            ],
        })
    }
}

/// Distributions of the errors of one method.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct MethodDetail {
    /// Steps (size of the error of K in per cent, share of all trials); failures never come.
    pub ecdf_k: Vec<(f64, f64)>,
    /// The same of T.
    pub ecdf_t: Vec<(f64, f64)>,
    /// Errors of K, in single cells only.
    pub violin_k: Option<Violin>,
    /// Errors of T, in single cells only.
    pub violin_t: Option<Violin>,
    /// Errors of K and T together, in single cells only.
    pub cloud: Option<Cloud>,
}

impl MethodDetail {
    /// From the errors of K and T on so many trials of a cell.
    pub(super) fn of(k: &Ordered, t: &Ordered, trials: u64, pairs: &[(f64, f64)]) -> Self {
        Self {
            violin_k: Violin::of(k),
            violin_t: Violin::of(t),
            cloud: Cloud::of(pairs),
            ..Self::of_all_cells(k, t, trials)
        }
    }

    /// From the errors of K and T on so many trials of all cells, of which only the sizes are shown.
    pub(super) fn of_all_cells(k: &Ordered, t: &Ordered, trials: u64) -> Self {
        let steps = |errors: &Ordered| errors.distances(0.0).steps(trials, STEPS);
        Self { ecdf_k: steps(k), ecdf_t: steps(t), ..Self::default() }
    }
}

/// Distributions in one cell.
#[derive(Debug, Clone, PartialEq)]
pub struct CellDetail {
    /// Index of the cell.
    pub cell: usize,
    /// Per method.
    pub methods: Vec<MethodDetail>,
}
