//! Studies: scenario files, the engine that runs them, and the command line.
//!
//! This is the only crate that seeds generators and writes result folders.
//!
//! | to learn about | read |
//! |---|---|
//! | scenario files | [`scenario`] |
//! | what may be a name or a label | [`name`] |
//! | one trial | [`engine`] |
//! | many of them, in order | [`plan`], [`stopping`], [`collect`], [`unfinished`], [`merge`] |
//! | what is stored | [`rows`], [`store`], [`manifest`], [`showcase`], [`timings`]; how, [`folder`] |
//! | what is said about it | [`summary`], [`statistics`], [`present`], [`publish`], [`overview`] |
//! | measured records | [`fit`], [`mod@trace`] |
//! | commands and exit codes | [`cli`], [`failure`], [`screen`] |

pub mod check;
pub mod cli;
pub mod collect;
mod disk;
pub mod engine;
pub mod failure;
#[cfg(test)]
mod faults;
pub mod fit;
pub mod folder;
mod interrupt;
pub mod json;
pub mod list;
pub mod manifest;
pub mod merge;
pub mod name;
pub mod overview;
pub mod plan;
pub mod present;
mod progress;
pub mod publish;
mod records;
pub mod rows;
pub mod run;
pub mod scenario;
pub mod screen;
pub mod showcase;
pub mod statistics;
pub mod stopping;
pub mod store;
pub mod summary;
pub mod timings;
pub mod trace;
pub mod unfinished;
