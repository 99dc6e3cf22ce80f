//! What the words, tables, figures and JSON of one analysis are made from.

use ::trace::Analysis;
use ::trace::missing_moment::MissingMoment;
use predict::KnownShip;
use predict::known::Seen;
use predict::steady::SteadyCurve;
use ship::Particulars;
use trial::Trial;

use super::scale_comparison::ScalesEntry;
use crate::views::index_figures::Amplitudes;

/// Everything that is said about one analysis.
pub struct TraceReport {
    /// Length and speed at which numbers with a dimension are told, where they are known.
    pub ship: Option<Particulars>,
    /// Length and speed of the ship of every record as it was read.
    pub sailed_by: Vec<Option<Particulars>>,
    /// Every zig-zag alone, and zig-zags of the model, where there are several records.
    pub amplitudes: Option<Amplitudes>,
    /// What is known of the ship, for a prediction.
    pub known: KnownShip,
    /// Steady turns of the model, where it has any.
    pub steady: Option<(Vec<SteadyCurve>, Seen)>,
    /// What was done to records of several scales, in a sentence.
    pub scaled: Option<String>,
    /// Where the fitted records are of several scales: which terms scale.
    pub scales: Option<ScalesEntry>,
    /// Records that were fitted.
    pub trials: Vec<Trial>,
    /// Records that were not.
    pub others: Vec<Trial>,
    /// A name for every record, no two the same: first the fitted ones.
    pub names: Vec<String>,
    /// The analysis.
    pub analysis: Analysis,
    /// What planned trials would tell, best first.
    pub prospects: Vec<::trace::analysis::Prospect>,
    /// The yaw moment that the base lacks on every fitted record; `None` where it has too few headings.
    pub missing: Vec<Option<MissingMoment>>,
}
