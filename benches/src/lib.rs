//! What the work of this project costs, beside rivals and beside what is to be reached.
//!
//! Every piece of work is defined once, in [`works`], with what stands beside it and the limit it is held to. The
//! benches (`cargo bench -p kempf-benches`) measure all of it with criterion and print one table of ratios each; the
//! program `performance` (`cargo run --release -p kempf-benches --bin performance -- results/performance`) measures it
//! again with work and rival in turn, adds how times grow with samples and trials, and writes a report with figures.
//! The program `shards` measures the bookkeeping of a study in thousands of shards.
//!
//! | to learn about | read |
//! |---|---|
//! | records that are identified | [`records`] |
//! | pieces of work and their limits | [`work`], [`works`] |
//! | identification by another library | [`rivals`] |
//! | many nonlinear ships at once | [`batch`], [`norrbin`] |
//! | repeated measurements and their intervals | [`measure`] |
//! | tables of ratios | [`verdict`] |
//! | peak memory of a process | [`process`] |
//! | criterion and its estimates | [`harness`] |

pub mod batch;
pub mod harness;
pub mod measure;
pub mod norrbin;
pub mod process;
pub mod records;
pub mod rivals;
pub mod verdict;
pub mod work;
pub mod works;
