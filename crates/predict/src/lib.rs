//! What an identified ship will do in a trial that was not made.
//!
//! A fit leaves a model with a covariance and a noise. Ships are drawn from it, each is steered through the manoeuvre,
//! and what they do is told as medians with intervals of 50 and 90 %. An interval holds the errors of the parameters,
//! the structures that the records cannot tell apart, the random moment of one trial, the rate of the rudder and the
//! yaw rate of the approach; the share of each is told beside it.
//!
//! | to learn about | read |
//! |---|---|
//! | ships drawn from it | [`mixture`], [`drawn_parameters`] |
//! | the manoeuvres, and what ends them | [`standard`] |
//! | figures of merit | [`figures`] |
//! | a manoeuvre predicted | [`prediction`] |
//! | a recorded rudder replayed, held against the record | [`replay`] |
//! | a record that is a turn, and the current it shows | [`turn`] |
//! | steady turns and the unstable loop | [`steady`] |
//! | the criteria of IMO | [`imo`] |
//! | a trial in ballast corrected to another loading | [`correction`] |
//! | the form of MSC/Circ.1053 | [`form`] |
//! | all of it as a file holds it | [`document`] |
//!
//! Time is in seconds from the first execute; everything else is in SI units and radians unless a name says otherwise.

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
pub use drawn_parameters::{DrawnEstimate, DrawnParameters, EstimateDraws};
pub use error::PredictError;
pub use interval::PredictionInterval;
pub use mixture::{ShipMixture, UncertaintySource};
pub use prediction::Prediction;
