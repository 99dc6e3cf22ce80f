//! One file per kind of figure: the data it shows, as plain numbers in display units, and the function that draws it.
//! What they share is in `shared`.

mod amplitude;
mod confusion;
mod dots;
mod error_curves;
mod evidence;
mod heat_map;
mod index_plane;
mod intervals;
mod over_time;
mod panels;
mod planes;
mod replays;
mod rows;
mod scatter;
mod shared;
mod track;
mod violins;
mod zigzag_trial;

pub use amplitude::{Amplitude, AmplitudePanel, AmplitudePoint, COLUMNS as AMPLITUDES, amplitude};
pub use confusion::{Confusion, ConfusionCell, ConfusionRow, confusion};
pub use dots::{Dot, DotColumn, DotPlot, dots};
pub use error_curves::{AxisMark, ErrorCell, ErrorCurve, ErrorCurves, ErrorPoint, Scale, error_curves};
pub use evidence::{Evidence, EvidenceRow, Fate, evidence};
pub use heat_map::{HeatMap, HeatPanel, heat_map};
pub use index_plane::{IndexAnswer, IndexPlane, index_plane};
pub use intervals::{Intervals, MethodEstimate, PointEstimate, Reference, intervals};
pub use over_time::{
    CurveFit, Derivatives, Fit, FitBand, MotionCurves, PredictionBands, RecordFit, curve_fit, derivatives,
    prediction_bands, record_fit,
};
pub use panels::{Division, Drawn, Layer, Layers, Panels, Pen, Ruler, Stack, panels};
pub use planes::{PhaseCurve, PhasePlane, SteadyCurves, phase_plane, steady_curves};
pub use replays::{Replay, Replays, replays};
pub use rows::{OvershootRow, Overshoots, RowPart, Rows, overshoots, rows};
pub use scatter::{Ellipse, KtPanel, KtScatter, scatter};
pub use shared::Reference95;
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
