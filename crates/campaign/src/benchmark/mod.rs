//! A benchmark of methods that identify ships from zig-zag trials.
//!
//! A [`Definition`] says which records are fitted and which are scored. Measured records are found by name and
//! checksum, simulated ones are made by the engine of studies. Every [`BenchMethod`] gets the same records; an answer
//! is scored by what it says of a record or a ship, a failed one is a row with its reason.
//!
//! | to learn about | read |
//! |---|---|
//! | the definition as a file, and its checks | [`definition`], `wire`, `embedded` |
//! | how measured records are found | [`record_store`] |
//! | who takes part, and what an answer can do | [`method`] |
//! | what is asked and answered | [`mod@run`], [`cases`] |
//! | leaderboards | [`board`], [`naming`], [`overall`], `statistics` |
//! | the whole result, as it is stored | [`results`] |

pub mod board;
pub mod cases;
pub mod definition;
mod embedded;
pub mod method;
pub mod naming;
pub mod overall;
pub mod record_store;
pub mod results;
pub mod run;
mod statistics;
mod wire;

pub use cases::BenchTask;
pub use definition::Definition;
pub use method::BenchMethod;
pub use record_store::RecordStore;
pub use results::BenchDocument;
pub use run::run;
pub use wire::DefinitionWire;
