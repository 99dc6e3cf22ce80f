//! Parameters of effects in a scenario file: keys, units and conversion.

use crate::angle::DEGREE;

/// Inverse of a degree, 1/rad.
pub(super) const PER_DEGREE: f64 = 1.0 / DEGREE;

/// Inverse of a square degree, 1/rad².
pub(super) const PER_DEGREE_SQUARED: f64 = PER_DEGREE * PER_DEGREE;

/// Number of a scenario file that sets a parameter of an effect: key, unit, conversion and default.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ScenarioKey {
    /// Key below the effect; it ends in the unit.
    pub key: &'static str,
    /// Size of the unit of the key, in SI and radians.
    pub unit: f64,
    /// Meaning, for the reference of keys.
    pub meaning: &'static str,
    /// Conversion from the entry to the parameter.
    pub conversion: NumberConversion,
    /// Default, in the unit of the key; `None` for a required entry.
    pub default: Option<f64>,
}

/// Conversion from an entry of a scenario file to a parameter.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum NumberConversion {
    /// Entry used directly as the parameter.
    Value,
    /// Entry divided by T: a file gives the coefficient of T r' + r = …, the parameter is that of r' = ….
    OverT,
    /// Direction ψ_w of the strength in the preceding entry: strength sin 2(ψ_w − ψ), whose components along cos 2ψ and
    /// sin 2ψ are the two parameters.
    Direction,
}
