//! Dual numbers for the sensitivities of a replay to the parameters of a response.

use estimation::number::Dual;

/// Number of derivatives of a [`Tangent`]: enough for a first-order response and an effect with two parameters.
pub const DIRECTIONS: usize = 6;

/// Dual number in which a response is replayed.
pub type Tangent = Dual<DIRECTIONS>;
