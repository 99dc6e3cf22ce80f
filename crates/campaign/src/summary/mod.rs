//! Summary of rows: bias, spread, failures, coverage and predictive error of every method, by cell and over all cells,
//! with their uncertainty; and the comparison of every method with a reference on the same trials.
//!
//! Rows are read once, in order. Only sums of the current cell and of all cells are kept, so memory does not grow with
//! the number of replicates.

mod blind_spots;
mod detail;
mod judgement;
mod performance;
mod predictions;
mod records;
mod tally;
mod tracing;

pub use blind_spots::{BlindSpot, blind_spots, effect_size_axis};
pub use detail::{CellDetail, ErrorDensity, JointErrors, MethodDetail};
pub use judgement::{Judgement, MAX_PERIOD_ERROR, MAX_TIME_ERROR_S};
pub use performance::{ErrorComparison, IndexErrors, MethodPerformance, MethodSummary, ReferenceComparison, Summary};
pub use predictions::{ConformalScaling, ImoDecisionTally, PredictionSummary};
pub use records::{RecordSummary, record_summaries};
pub use tally::{Tally, summarise};
pub use tracing::{CALIBRATION_BIN_EDGES, CalibrationBin, MIN_CLEAR_MARGIN, TraceSummary, effect_ids};

#[cfg(test)]
mod tests;
