//! Benchmarks of the project: computing times compared with other libraries and with limits.
//!
//! Every benchmark is defined once, in [`works`], with its reference and its limit. `cargo bench -p kempf-benches`
//! measures all benchmarks with criterion, and the program `ratios` (`cargo run --release -p kempf-benches --bin ratios
//! -- results/published/performance`) makes the tables of ratios from the stored results of criterion.
//!
//! | to learn about | read |
//! |---|---|
//! | records that are identified | [`records`] |
//! | benchmarks and their limits | [`work`], [`works`] |
//! | identification by another library | the package `kempf-rivals` |

pub mod records;
pub mod work;
pub mod works;
