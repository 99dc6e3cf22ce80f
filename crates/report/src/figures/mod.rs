//! One file per kind of figure: the data it shows, as plain numbers in display units, and the function that draws it.
//! What they share is in `shared`.

mod amplitude;
mod confusion;
mod curve_fit;
mod derivatives;
mod dots;
mod error_curves;
mod evidence;
mod heat_map;
mod index_plane;
mod intervals;
mod missing_moment;
mod named_rows;
mod overshoot_replays;
mod overshoots;
mod phase_plane;
mod power;
mod prediction_bands;
mod raw_record;
mod record_fit;
mod replays;
mod residual_panels;
mod scatter;
mod shared;
mod steady_curves;
mod track;
mod violins;
mod zigzag_trial;

pub use amplitude::{Amplitude, AmplitudePanel, AmplitudePoint, COLUMNS as AMPLITUDES, amplitude};
pub use confusion::{Confusion, ConfusionCell, ConfusionRow, confusion};
pub use curve_fit::{CurveFit, curve_fit};
pub use derivatives::{Derivatives, MotionCurves, derivatives};
pub use dots::{Dot, DotColumn, DotPlot, dots};
pub use error_curves::{AxisMark, ErrorCell, ErrorCurve, ErrorCurves, ErrorPoint, Scale, error_curves};
pub use evidence::{Evidence, EvidenceRow, Fate, evidence};
pub use heat_map::{HeatMap, HeatPanel, heat_map};
pub use index_plane::{IndexAnswer, IndexPlane, index_plane};
pub use intervals::{Intervals, MethodEstimate, PointEstimate, Reference, intervals};
pub use missing_moment::{Banded, MissingMoment, MomentPanel, missing_moment};
pub use overshoot_replays::{OvershootReplays, ReplayedOvershoot, overshoot_replays};
pub use overshoots::{OvershootRow, Overshoots, overshoots};
pub use phase_plane::{PhaseCurve, PhasePlane, phase_plane};
pub use power::{Power, PowerSeries, power};
pub use prediction_bands::{PredictionBands, prediction_bands};
pub use raw_record::{RawRecord, raw_record};
pub use record_fit::{Fit, FitBand, RecordFit, record_fit};
pub use replays::{Replay, Replays, replays};
pub use residual_panels::{ResidualPanel, ResidualPanels, residual_panels};
pub use scatter::{Ellipse, KtPanel, KtScatter, scatter};
pub use shared::Reference95;
pub use steady_curves::{SteadyCurves, steady_curves};
pub use track::{Track, track};
pub use violins::{Violin, ViolinPanel, Violins, violins};
pub use zigzag_trial::{Mark, Overshoot, Span, ZigzagTrial, zigzag_trial};

#[cfg(test)]
mod indices_tests;
#[cfg(test)]
mod prediction_tests;
#[cfg(test)]
mod study_tests;
#[cfg(test)]
mod tests;
