//! Figures over replicates, each with its own Monte-Carlo uncertainty, in memory that does not grow with the number of
//! replicates: [`Sample`] for everything that depends on order, [`Sums`] for everything that depends on moments,
//! [`Moments`] for the running moments of one quantity.

mod bootstrap;
mod moments;
mod sample;
mod statistic;
mod sums;

pub use bootstrap::Resamples;
pub use moments::Moments;
pub use sample::{Ordered, Sample};
pub use statistic::{Statistic, Z95, share};
pub use sums::{BATCHES, BatchSums, PairSums, Sums};
