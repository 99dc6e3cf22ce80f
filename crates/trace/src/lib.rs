//! From a residual to the effect the model lacks: fit the base, look at what is left, decide whether anything is
//! missing, name it, add it, and say how far the model is from the records before and after.
//!
//! There is no path from here to the simulator: a record is all that is known of a ship.
//!
//! | to learn about | read |
//! |---|---|
//! | the whole analysis and its result | [`analysis`] |
//! | what may be missing, with bounds and starts | [`candidates`] |
//! | how terms are added, tested and dropped | [`search`] |
//! | what a user asks for or excludes | [`wanted`] |
//! | random explanations that compete with effects | [`noise`] and [`waves`] |
//! | the fit itself | [`fit`], [`structure`], [`record`] |
//! | whether a noise model holds | [`innovations`] |
//! | where a squall was | [`transient`] |
//! | errors before and after | [`replay_errors`], [`held_out`], [`own_moment`] |
//! | how far a record may be from a replay by chance | [`band`] |
//! | what a record cannot tell, and which trial could | [`separation`] |
//! | the yaw moment that the base lacks, over time and over what it may depend on | [`missing_moment`] |
//! | what is left in the end | [`diagnostics`], [`monomial`], [`offset`], [`change`] |

pub mod analysis;
pub mod band;
pub mod candidates;
pub mod change;
pub mod diagnostics;
pub mod fit;
pub mod held_out;
pub mod index;
pub mod innovations;
pub mod missing_moment;
pub mod monomial;
pub mod noise;
pub mod offset;
pub mod own_moment;
pub mod record;
pub mod replay_errors;
pub mod search;
pub mod separation;
pub mod structure;
pub mod transient;
pub mod wanted;
pub mod waves;

pub use analysis::{Analysis, Settings, TraceError, trace};
pub use wanted::{EffectId, Wanted};

#[cfg(test)]
mod made_up;
