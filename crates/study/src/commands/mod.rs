//! The commands, one file each: they read options, have the work done by [`crate::work`] or the crates below, and hand
//! the answer to [`crate::views`].

pub mod bench;
pub mod check;
pub mod doctor;
pub mod find;
pub mod fit;
pub mod list;
pub mod merge;
pub mod overview;
pub mod predict;
pub mod report;
pub mod run;
pub mod schema;
pub mod score;
pub mod shell;
pub mod sidecar;
pub mod simulate;
pub mod trace;
