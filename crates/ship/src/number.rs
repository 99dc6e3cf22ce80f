//! Dual numbers for the sensitivities of a replay to the parameters of a response.

use estimation::number::Dual;

/// Number of derivatives of a [`Tangent`]; a replay with more unknowns requires several passes.
pub const TANGENT_DERIVATIVES: usize = 6;

/// Dual number in which a response is replayed.
pub type Tangent = Dual<TANGENT_DERIVATIVES>;
