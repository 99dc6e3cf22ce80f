//! The command line as a user meets it: the built program on scenarios and records, good and bad. What is asserted is
//! the exit code, the one message, and what lies on disk afterwards; what the numbers mean is tested elsewhere.

mod answers;
mod benchmark;
mod book;
mod commands;
mod desk;
mod earlier;
mod formulas;
mod loadings;
mod logs;
mod monte_carlo;
mod names;
mod owner;
mod pages;
mod predictions;
mod priors;
mod programs;
mod publications;
mod record_studies;
mod records;
mod reference;
mod scales;
mod scenarios;
mod schemas;
mod scored;
mod stored;
mod traces;
mod tracks;
