//! Benchmark of methods that identify ships from zig-zag trials.
//!
//! It consists of a few studies, [`embedded`] with the program: simulated ships, and measured records identified by
//! their SHA-256. Their rows are scored, and methods are compared case by case.
//!
//! | to learn about | read |
//! |---|---|
//! | the studies of the program | [`embedded`] |
//! | tasks and results | `study_cases`, [`cases`] |
//! | leaderboards | [`board`], [`naming`], [`overall`], `statistics` |
//! | the whole result, as it is stored | [`results`] |

pub mod board;
pub mod cases;
pub mod embedded;
pub mod naming;
pub mod overall;
pub mod results;
mod statistics;
mod study_cases;

pub use cases::BenchTask;
pub use results::BenchDocument;
