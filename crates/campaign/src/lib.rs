//! A campaign: the trials of a scenario, run to rows that are stored, joined and summarised.
//!
//! [`collect::collect`] runs a scenario into a folder, [`collect::in_memory`] without one. Nothing here draws, prints
//! or reads the command line; who wants to see how far a campaign is implements [`Observer`].
//!
//! | to learn about | read |
//! |---|---|
//! | one trial, simulated or of measured records | [`engine`], `judged` |
//! | many of them, in order | [`task`], [`block`], [`plan`], [`stopping`], [`collect`] |
//! | answers from elsewhere | [`answers`] |
//! | what is stored | [`design`], [`rows`], [`blocks`], [`store`], [`manifest`], [`showcase`], [`timings`] |
//! | how it gets to the disk | [`files`], [`folder`], [`disk`] |
//! | what is said about it | [`summary`], [`statistics`] |
//! | records and answers for figures and other programs | [`curves`], [`stored_figures`] |
//! | what is known of a ship, for a prediction | [`known`] |
//! | methods against each other on measured and simulated records | [`benchmark`] |

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
mod judged;
pub mod known;
pub mod manifest;
pub mod observer;
pub mod parquet_table;
pub mod plan;
mod prediction_check;
mod reference;
pub mod rows;
pub mod scenario;
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
