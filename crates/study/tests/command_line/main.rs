//! Tests of the command line: the built program on valid and invalid scenarios and records. They check exit codes,
//! messages and files; the numbers are tested in the crates that compute them.

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
