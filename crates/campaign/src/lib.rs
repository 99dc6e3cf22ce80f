//! Monte-Carlo campaigns: the trials of a scenario are run, their rows stored and summarised.
//!
//! [`collect::collect`] runs a scenario into a folder, [`collect::collect_in_memory`] without one. This crate neither
//! plots, prints nor reads the command line; an [`Observer`] receives progress and warnings.
//!
//! | to learn about | read |
//! |---|---|
//! | the scenario file and its checks | [`scenario`] |
//! | one trial, simulated or of measured records | [`engine`], `shared_fit` |
//! | many trials, in order | [`shard`], [`block`], [`plan`], [`stopping`], [`collect`] |
//! | estimates of outside estimators | [`outside_estimates`] |
//! | stored files | [`design`], [`rows`], [`block_store`], [`store`], [`manifest`], [`showcase`], [`timings`] |
//! | writing to disk | [`files`], [`folder`], [`disk`], [`parquet_table`] |
//! | failures, warnings and progress | [`failure`], [`observer`] |
//! | summaries and their statistics | [`summary`], [`statistics`] |
//! | plot data and document entries | [`curves`], [`stored_figures`] |
//! | the identified ship, for predictions; priors from earlier trials | [`identified_ship`], [`earlier_trials`] |
//! | comparison of methods on measured and simulated records | [`benchmark`] |

pub mod benchmark;
pub mod block;
pub mod block_store;
mod bound;
pub mod collect;
pub mod curves;
pub mod design;
pub mod disk;
pub mod earlier_trials;
pub mod engine;
pub mod failure;
pub mod files;
pub mod folder;
pub mod identified_ship;
pub mod manifest;
pub mod observer;
pub mod outside_estimates;
pub mod parquet_table;
pub mod plan;
mod prediction_check;
mod reference;
pub mod rows;
pub mod scenario;
pub mod shard;
mod shared_fit;
pub mod showcase;
pub mod statistics;
pub mod stopping;
pub mod store;
pub mod stored_figures;
pub mod summary;
#[cfg(test)]
mod testing;
#[cfg(test)]
mod tests;
pub mod timings;
mod writer;

pub use observer::{NoObserver, Observer};
