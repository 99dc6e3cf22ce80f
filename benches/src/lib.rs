//! What the work of this project costs, beside rivals and beside what is to be reached.
//!
//! Every piece of work is defined once, in [`works`], with its reference and its limit. `cargo bench -p kempf-benches`
//! measures all of it with criterion, and the program `ratios` (`cargo run --release -p kempf-benches --bin ratios --
//! results/published/performance`) makes the tables of ratios from what criterion has stored.
//!
//! | to learn about | read |
//! |---|---|
//! | records that are identified | [`records`] |
//! | pieces of work and their limits | [`work`], [`works`] |
//! | identification by another library | the package `kempf-rivals` |

pub mod records;
pub mod work;
pub mod works;
