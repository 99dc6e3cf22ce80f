//! Statistics over replicates with their Monte-Carlo uncertainty, in memory independent of the number of replicates:
//! [`ErrorSample`] for quantiles, [`ErrorSums`] for functions of moments, [`Moments`] for running moments of one
//! quantity.

mod bootstrap;
mod clusters;
mod groups;
mod logistic;
mod moments;
mod sample;
mod statistic;
mod sums;

pub use bootstrap::Resamples;
pub use clusters::{percentile_interval, resample_clusters, resample_sets};
pub use groups::{distinct, grouped};
pub use logistic::{DetectionCount, detection_size};
pub use moments::Moments;
pub use sample::{ErrorSample, OrderedSample};
pub use statistic::{MIN_INTERVAL_VALUES, MIN_SUMMARISED_VALUES, NORMAL_QUANTILE_95, Statistic, wilson_share};
pub use sums::{BATCH_COUNT, BatchSums, ErrorSums, PairedErrorSums};
