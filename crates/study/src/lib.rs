//! Library of the command line `study`: options, the work of each command, and the form of the output. Hydrodynamics,
//! identification and statistics are in the crates below.
//!
//! | to learn about | read |
//! |---|---|
//! | commands and exit codes | [`cli`], [`commands`] |
//! | options | [`options`], `completed` |
//! | computations of the commands | [`work`] |
//! | files and JSON for other programs | [`documents`] |
//! | tables, figures and pages | [`views`] |
//! | the terminal | [`screen`], `terminal`, `progress`, `interrupt`, `threads` |

pub mod cli;
pub mod commands;
mod completed;
pub mod documents;
mod failures;
#[cfg(test)]
mod fault_tests;
pub mod formula_options;
mod interrupt;
pub mod options;
mod progress;
pub mod records;
pub mod scales;
pub mod screen;
mod ship_options;
pub mod style_options;
mod terminal;
mod threads;
pub mod views;
pub mod work;
