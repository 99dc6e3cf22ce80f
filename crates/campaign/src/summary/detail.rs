//! Distributions of errors in the cells where that was asked for, for figures.

use serde::{Deserialize, Serialize};

use crate::statistics::Ordered;

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

/// The distribution of the errors of one index.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct ErrorDensity {
    /// Places, per cent, and densities; empty where the values are all the same.
    pub density: Vec<(f64, f64)>,
    /// Quantiles 2.5, 25, 50, 75 and 97.5 %.
    pub quantiles: [f64; 5],
}

impl ErrorDensity {
    /// Of errors in per cent; `None` of nothing.
    pub(super) fn of(errors: &Ordered) -> Option<Self> {
        errors.quantile(0.5)?;
        let quantiles = [0.025, 0.25, 0.5, 0.75, 0.975].map(|p| errors.quantile(p).unwrap_or_default());
        Some(Self { density: errors.density(PLACES), quantiles })
    }
}

/// Errors of K and T together, per cent.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
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
            let mut sample = crate::statistics::ErrorSample::default();
            pairs.iter().for_each(|pair| sample.add(get(pair)));
            let ordered = sample.ordered();
            let centre = ordered.quantile(0.5).unwrap_or(0.0);
            let reach = REACH * SD_OVER_MAD * ordered.mad().map_or(0.0, |mad| mad.value);
            pairs.iter().map(|pair| get(pair).clamp(centre - reach, centre + reach)).collect()
        };
        let errors = [drawn_in(|pair| pair.0), drawn_in(|pair| pair.1)];
        let n = pairs.len() as f64;
        let centre = errors.each_ref().map(|values| values.iter().sum::<f64>() / n);
        let covariance = |i: usize, j: usize| {
            let products = errors[i].iter().zip(&errors[j]).map(|(x, y)| (x - centre[i]) * (y - centre[j]));
            products.sum::<f64>() / (n - 1.0)
        };
        Some(Self {
            points: pairs[..pairs.len().min(SHOWN_PAIRS)].to_vec(),
            centre: centre.into(),
            covariance: [0, 1].map(|i| [0, 1].map(|j| covariance(i, j))),
        })
    }
}

/// Distributions of the errors of one method.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct MethodDetail {
    /// Errors of K.
    pub violin_k: Option<ErrorDensity>,
    /// Errors of T.
    pub violin_t: Option<ErrorDensity>,
    /// Errors of K and T together.
    pub cloud: Option<Cloud>,
}

/// Distributions in one cell.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct CellDetail {
    /// Index of the cell.
    pub cell: usize,
    /// Per method.
    pub methods: Vec<MethodDetail>,
}
