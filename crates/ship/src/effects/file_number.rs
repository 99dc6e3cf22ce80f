//! How a parameter of an effect stands in a scenario file.

use crate::angle::DEGREE;

/// The inverse of a degree.
pub(super) const PER_DEGREE: f64 = 1.0 / DEGREE;

/// The inverse of a square degree.
pub(super) const PER_DEGREE_SQUARED: f64 = PER_DEGREE * PER_DEGREE;

/// The number behind a parameter in a scenario file.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FileNumber {
    /// Its key below the effect, which ends in the unit.
    pub key: &'static str,
    /// Size of that unit in SI and radians.
    pub unit: f64,
    /// What it means.
    pub meaning: &'static str,
    /// What the parameter is of it.
    pub role: FileRole,
    /// What holds when it is left out; `None` of a number that cannot be.
    pub default: Option<f64>,
}

/// What a parameter is of the number in the file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FileRole {
    /// The number.
    Value,
    /// The number over T: files write T r' + r, models r'.
    OverT,
    /// With the parameter before, a strength and the direction ψ_w it comes from: strength sin 2(ψ_w − ψ) by its parts
    /// along cos 2ψ and sin 2ψ.
    Direction,
}
