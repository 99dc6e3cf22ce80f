//! What comes, goes or changes at an instant: ½ [1 + tanh((t − t₀)/w)] with a narrow edge, so that t₀ can be fitted.

use super::effect::Parameter;

/// The instant t₀, s.
pub const INSTANT: Parameter = Parameter {
    key: "t_0",
    symbol: "t₀",
    unit: "s",
    neutral: 100.0,
    typical: 100.0,
    lowest: -1e7,
    highest: 1e7,
    odd: false,
};

/// Width w of an edge, in rows.
pub const EDGE_ROWS: f64 = 2.0;

/// Widths beyond an instant at which tanh is one to 10⁻¹³.
pub const REACH: f64 = 15.0;
