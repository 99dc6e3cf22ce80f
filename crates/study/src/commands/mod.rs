//! The commands, one file each: they read options, ask the crates below for work, and hand the answer to
//! [`crate::views`].

mod alone;
pub mod check;
pub mod find;
pub mod fit;
pub mod list;
pub mod merge;
pub mod overview;
mod planned;
pub mod predict;
pub mod report;
pub mod run;
pub mod sidecar;
pub mod simulate;
mod steady;
pub mod trace;
