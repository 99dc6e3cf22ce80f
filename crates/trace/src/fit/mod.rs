//! Output error for a structure with terms: the parameters, bounded, and the initial state of every record that bring
//! the whitened heading of the replay nearest to the record.
//!
//! | to learn about | read |
//! |---|---|
//! | the records, replays and sensitivities | [`Problem`] |
//! | what comes out | [`Fit`] |
//! | the search for the minimum | `minimise` |
//! | what a noise takes from the information | `information` |
//! | linear equations at one point | [`Linear`], [`Columns`] |
//! | what candidates on one fit share | [`Linearised`] |

mod information;
mod linear;
mod linearised;
mod memory;
mod minimise;
mod moments;
mod outcome;
mod problem;
#[cfg(test)]
mod tests;

pub(crate) use information::prior_and;
pub use linear::{Column, Columns, Linear};
pub(crate) use linear::{Normal, acts, log_determinant, log_variance, part_of, whiten};
pub use linearised::Linearised;
pub use moments::Restricted;
pub(crate) use moments::minimum;
pub use outcome::Fit;
pub use problem::Problem;
