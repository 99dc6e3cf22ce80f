//! Smooth step at an instant: ½ [1 + tanh((t − t₀)/w)] with a narrow edge w, so that t₀ can be fitted.

use super::effect::Parameter;

/// Parameter t₀ of a step: the instant at which a moment sets in, s.
pub const ONSET_TIME: Parameter = Parameter::even(["t_0", "t₀", "s"], [100.0, 100.0], [-1e7, 1e7]);

/// Width w of an edge, in rows of the record.
pub const EDGE_ROWS: f64 = 2.0;

/// Distance from an instant, in widths, at which 1 − tanh is 10⁻¹³.
pub const REACH_WIDTHS: f64 = 15.0;
