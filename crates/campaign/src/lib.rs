//! A Monte-Carlo campaign: runs the trials of a scenario, stores their rows and summarises them.
//!
//! [`collect::collect`] runs a scenario into a folder, [`collect::in_memory`] without one. This crate neither plots,
//! prints nor reads the command line; an [`Observer`] receives progress and warnings.
//!
//! | to learn about | read |
//! |---|---|
//! | one trial, simulated or of measured records | [`engine`], `shared_fit` |
//! | many of them, in order | [`task`], [`block`], [`plan`], [`stopping`], [`collect`] |
//! | estimates of outside estimators | [`answers`] |
//! | stored files | [`design`], [`rows`], [`blocks`], [`store`], [`manifest`], [`showcase`], [`timings`] |
//! | writing to disk | [`files`], [`folder`], [`disk`] |
//! | summaries and their statistics | [`summary`], [`statistics`] |
//! | plot data and document entries | [`curves`], [`stored_figures`] |
//! | the identified ship, for predictions | [`identified_ship`] |
//! | comparison of methods on measured and simulated records | [`benchmark`] |

pub mod answers;
pub mod benchmark;
pub mod block;
pub mod blocks;
mod bound;
pub mod collect;
pub mod curves;
pub mod design;
pub mod disk;
pub mod earlier;
pub mod engine;
pub mod failure;
pub mod files;
pub mod folder;
pub mod identified_ship;
pub mod manifest;
pub mod observer;
pub mod parquet_table;
pub mod plan;
mod prediction_check;
mod reference;
pub mod rows;
pub mod scenario;
mod shared_fit;
pub mod showcase;
pub mod statistics;
pub mod stopping;
pub mod store;
pub mod stored_figures;
pub mod summary;
pub mod task;
#[cfg(test)]
mod testing;
#[cfg(test)]
mod tests;
pub mod timings;
mod writer;

pub use observer::{NoObserver, Observer};
