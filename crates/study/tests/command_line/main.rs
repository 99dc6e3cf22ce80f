//! The command line as a user meets it: the built program on scenarios and records, good and bad. What is asserted is
//! the exit code, the one message, and what lies on disk afterwards; what the numbers mean is tested elsewhere.

mod commands;
mod desk;
mod logs;
mod monte_carlo;
mod names;
mod pages;
mod predictions;
mod records;
mod scales;
mod scenarios;
mod stored;
mod traces;
mod tracks;
mod troubles;
