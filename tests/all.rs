//! The tests of the whole workspace, one file a subject.

mod architecture;
mod benchmark;
mod claims;
mod constants;
mod effects;
mod golden;
mod identifiers;
mod invariance;
mod links;
mod logs;
mod logs_properties;
mod measured;
mod ships;
mod size;
mod tracing;
mod unlisted;
mod validation;
