//! Support shared by the tests of the whole workspace: reference numbers held against ours, and records to test methods
//! with. What a single crate can show about itself is tested there.
//!
//! | to learn about | read |
//! |---|---|
//! | every number that is held against a published one | [`validation`] |
//! | simulated records, and what can be done to a record | [`records`] |
//! | logs in every format and with every trouble, of one known ship | [`logs`] |
//! | damaged files for every reader | [`fuzz`] |
//! | measured records, which are not part of the project | [`measured`] |

pub mod fuzz;
pub mod logs;
pub mod measured;
pub mod records;
pub mod validation;
