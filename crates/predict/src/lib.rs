//! Prediction of manoeuvres of an identified ship, with intervals.
//!
//! A fit gives a model with a covariance and a noise law. Ships are drawn from it, each is steered through the
//! manoeuvre, and the results are medians with intervals of 50 and 90 %. An interval includes the errors of the
//! parameters, the structures that the records do not distinguish, the random moment of one trial, the rudder rate and
//! the yaw rate of the approach; the share of each source is reported.
//!
//! | to learn about | read |
//! |---|---|
//! | drawn ships | [`mixture`], [`drawn_parameters`] |
//! | the manoeuvres and their ends | [`standard`] |
//! | characteristics of a manoeuvre | [`figures`] |
//! | the prediction of a manoeuvre | [`prediction`] |
//! | the replay of a recorded rudder, compared with the record | [`replay`] |
//! | a recorded turn and its current | [`turn`] |
//! | steady turns and the unstable loop | [`steady`] |
//! | the criteria of IMO | [`imo`] |
//! | a trial in ballast corrected to another loading | [`correction`] |
//! | the form of MSC/Circ.1053 | [`form`] |
//! | the document of a prediction | [`document`] |
//!
//! Time is in seconds from the first execute; other quantities are in SI units and radians unless a name states another
//! unit.

pub mod correction;
pub mod document;
pub mod drawable_hull;
pub mod drawn_parameters;
pub mod error;
pub mod figures;
pub mod form;
mod helm_replay;
pub mod imo;
pub mod interval;
mod line;
mod median_track;
pub mod mixture;
pub mod prediction;
pub mod replay;
mod root;
pub mod simulated_manoeuvre;
pub mod standard;
pub mod steady;
#[cfg(test)]
mod testing;
pub mod turn;

pub use document::PredictDocument;
pub use drawn_parameters::{DrawnEstimate, DrawnParameters, EstimateSampler};
pub use error::PredictError;
pub use interval::PredictionInterval;
pub use mixture::{ShipMixture, UncertaintySource};
pub use prediction::Prediction;
