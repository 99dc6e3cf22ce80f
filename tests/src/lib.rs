//! Shared support for the tests of the workspace: reference numbers compared with our numbers, and records for tests of
//! methods. Properties of a single crate are tested in that crate.
//!
//! | to learn about | read |
//! |---|---|
//! | comparison with published numbers | [`validation`] |
//! | simulated records, and changes to a record | [`records`] |
//! | logs of one known ship in every format and with every fault | [`logs`] |
//! | damaged files for every reader | [`fuzz`] |
//! | measured records, which are not part of the project | [`measured`] |

pub mod fuzz;
pub mod logs;
pub mod measured;
pub mod records;
pub mod validation;
