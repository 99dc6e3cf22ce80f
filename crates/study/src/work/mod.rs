//! What a command works out before anything is drawn, written or said; what a program that calls this crate asks for.

pub mod alone;
pub mod every_scale;
pub mod fit;
mod planned;
pub mod predict;
pub mod simulate;
pub mod steady;
pub mod trace;
