//! Computation of the commands, before any output; also called by the Python package.

pub mod earlier_trials;
pub mod fit;
pub mod fit_each;
mod loading;
mod planned;
pub mod predict;
pub mod predicted_circle;
pub mod scale_comparison;
pub mod simulate;
pub mod single_records;
pub mod steady;
mod stored_ships;
mod target_scale;
pub mod trace;
