//! Effects missing from a first-order model, identified from the residual of recorded zig-zags.
//!
//! Every subset of the candidate effects is weighed by its marginal likelihood (Laplace approximation) under the noise
//! law of the residual of the full model. [`trace`] runs the whole analysis; [`analysis`] lists its stages.

pub mod analysis;
pub mod average;
mod band;
pub mod base;
pub mod candidates;
pub mod comparison;
pub mod empirical;
pub mod fit;
mod fold_observer;
pub mod full;
mod hulls;
pub mod inclusion_path;
pub mod law;
mod leave_one_out;
pub mod linear;
mod location;
mod missing;
pub mod missing_moment;
pub mod model;
pub mod naming;
pub mod noise;
pub mod noise_law;
pub mod prospects;
pub mod record;
pub mod record_moment;
pub mod replay_errors;
mod report;
mod residual_analysis;
mod residual_peak;
mod rudder;
pub mod selection;
mod sentences;
pub mod settings;
pub mod shape;
pub mod structures;
pub mod transient;
pub mod waves;

pub use analysis::{Analysis, trace, trace_with_observer, without_spikes};
pub use document::trace::{AnalysisDocument, TraceVerdict};
pub use fold_observer::FoldObserver;
pub use residual_analysis::{Innovations, SIGNIFICANCE_LEVEL};
pub use selection::{EffectId, Selection};
pub use settings::{Settings, TraceError, WeightingRule};

#[cfg(test)]
mod analysis_tests;
#[cfg(test)]
mod testing;
