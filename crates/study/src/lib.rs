//! The command line `study`: what a user may ask for, which of the crates below answers, and how the answer looks. It
//! knows no hydrodynamics.
//!
//! | to learn about | read |
//! |---|---|
//! | commands and exit codes | [`cli`], [`commands`] |
//! | options | [`options`] |
//! | tables, figures, pages and JSON | [`views`] |
//! | the terminal | [`screen`], `terminal`, `progress`, `interrupt`, `threads` |

pub mod cli;
pub mod commands;
#[cfg(test)]
mod faults;
mod interrupt;
pub mod options;
mod progress;
mod records;
pub mod scales;
pub mod screen;
mod terminal;
mod threads;
pub mod views;
