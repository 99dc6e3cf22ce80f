//! The numbers that a response is replayed in to see how it changes with its parameters.

use estimation::number::Dual;

/// Directions in which a [`Tangent`] is differentiated at once: those of a first-order response and of an effect with
/// two parameters.
pub const DIRECTIONS: usize = 6;

/// A number that a response is replayed in together with its derivatives.
pub type Tangent = Dual<DIRECTIONS>;
