//! Scenario files: one question each, read strictly, resolved completely before anything runs.
//!
//! A value of [`Scenario`] has been checked in every cell of its design.
//!
//! | to learn about | read |
//! |---|---|
//! | the file as written, and its reader | `wire`, `ship`, `effect`, `number_table`, `reader`, [`part`], [`prose`] |
//! | the physics that a ship lacks | `physics` |
//! | faults and their position | [`problem`], `locate`, [`crate::failure`] |
//! | the design: sweeps, draws, cells, methods | [`sweep`], `draw`, [`cell`], [`method`], [`stop`], [`predictions`] |
//! | measured records in place of simulated ships | [`records`] |
//! | estimates of outside estimators | [`outside_estimates`] |
//! | the checks | `resolve`, `checks`, `limits`, [`name`] |
//! | scenarios with equal rows | [`identity`] |
//! | schema and keys for editors | [`schema`], [`keys`] |
//! | a scenario with every default written out | `resolved`, [`Scenario::resolved`] |

pub mod cell;
mod checked;
mod checks;
mod draw;
mod effect;
pub mod identity;
mod key_units;
pub mod keys;
mod limits;
mod locate;
pub mod method;
pub mod name;
mod number_table;
pub mod outside_estimates;
pub mod part;
mod physics;
pub mod predictions;
pub mod problem;
pub mod prose;
mod reader;
pub mod records;
mod resolve;
mod resolved;
pub mod schema;
mod ship;
mod specification;
pub mod stop;
pub mod sweep;
mod wire;

pub use cell::{DesignCell, InvalidSample, SampledSpecification};
pub use checked::Scenario;
pub use identity::hex_digits;
pub use method::{Method, MethodName, Procedure, STRAIGHT_ON_ID, TRACE_ID};
pub use outside_estimates::OutsideEstimates;
pub use physics::MissingPhysics;
pub use predictions::PredictionSettings;

pub use prose::{Highlight, MarkedValue, Presentation, Prose, Published};
pub use specification::{HULL_ID, Specification};
pub use stop::{NomotoIndex, StopFigure, StopRule};
