//! Documents: the results that cross between crates and into files.

pub mod noise;
pub mod warning;

pub use noise::{HeadingNoise, HeadingWander, RandomMoment};
pub use warning::{Code, Severity, Source, Warning, Warnings};
