//! Error distributions of the cells shown in detail.

use crate::statistics::OrderedSample;

/// Number of abscissae of a density.
const PLACES: usize = 160;

/// Maximum number of error pairs kept per cell and method.
pub(super) const MAX_PAIRS: usize = 2000;

/// Maximum number of error pairs plotted per cell and method.
const MAX_DRAWN_PAIRS: usize = 400;

/// Limit of winsorising, in robust standard deviations; without it a few outliers inflate the covariance (Huber
/// 1981).
const REACH: f64 = 4.0;

/// Standard deviation of a normal distribution over its median absolute deviation.
const SD_OVER_MAD: f64 = 1.482_602_2;

/// Distribution of the errors of one index.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct ErrorDensity {
    /// Pairs of an error, %, and its density, 1/%; empty for too few values and for equal quartiles.
    pub density: Vec<(f64, f64)>,
    /// 2.5, 25, 50, 75 and 97.5 % quantiles of the error, %.
    pub quantiles: [f64; 5],
}

impl ErrorDensity {
    /// Distribution of errors, %; `None` without values.
    pub(super) fn from_errors(errors: &OrderedSample) -> Option<Self> {
        errors.quantile(0.5)?;
        let quantiles = [0.025, 0.25, 0.5, 0.75, 0.975].map(|p| errors.quantile(p).unwrap_or_default());
        Some(Self { density: errors.density(PLACES), quantiles })
    }
}

/// Joint distribution of the errors of K and T, %.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct JointErrors {
    /// First pairs of errors of K and T, %, at most 400.
    pub points: Vec<(f64, f64)>,
    /// Mean of the winsorised errors, %.
    pub centre: (f64, f64),
    /// Covariance of the winsorised errors, %².
    pub covariance: [[f64; 2]; 2],
}

impl JointErrors {
    /// Joint distribution of errors of K and T; `None` below ten pairs.
    pub(super) fn from_pairs(pairs: &[(f64, f64)]) -> Option<Self> {
        if pairs.len() < 10 {
            return None;
        }
        let winsorised = |get: fn(&(f64, f64)) -> f64| -> Vec<f64> {
            let mut sample = crate::statistics::ErrorSample::default();
            pairs.iter().for_each(|pair| sample.add(get(pair)));
            let ordered = sample.ordered();
            let centre = ordered.quantile(0.5).unwrap_or(0.0);
            let reach = REACH * SD_OVER_MAD * ordered.mad().map_or(0.0, |mad| mad.value);
            pairs.iter().map(|pair| get(pair).clamp(centre - reach, centre + reach)).collect()
        };
        let errors = [winsorised(|pair| pair.0), winsorised(|pair| pair.1)];
        let n = pairs.len() as f64;
        let centre = errors.each_ref().map(|values| values.iter().sum::<f64>() / n);
        let covariance = |i: usize, j: usize| {
            let products = errors[i].iter().zip(&errors[j]).map(|(x, y)| (x - centre[i]) * (y - centre[j]));
            products.sum::<f64>() / (n - 1.0)
        };
        Some(Self {
            points: pairs[..pairs.len().min(MAX_DRAWN_PAIRS)].to_vec(),
            centre: centre.into(),
            covariance: [0, 1].map(|i| [0, 1].map(|j| covariance(i, j))),
        })
    }
}

/// Distributions of the errors of one method.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct MethodDetail {
    /// Errors of K; `None` without values.
    pub k_errors: Option<ErrorDensity>,
    /// Errors of T; `None` without values.
    pub t_errors: Option<ErrorDensity>,
    /// Errors of K and T together; `None` below ten pairs.
    pub joint_errors: Option<JointErrors>,
}

/// Error distributions in one cell.
#[derive(Debug, Clone, PartialEq)]
pub struct CellDetail {
    /// Index of the cell.
    pub cell: usize,
    /// Distributions of the methods.
    pub methods: Vec<MethodDetail>,
}
