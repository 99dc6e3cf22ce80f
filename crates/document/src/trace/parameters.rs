//! Parameters, with a dimension and without.

use serde::{Deserialize, Serialize};
use ship::Particulars;

use crate::quantity::Quantity;

/// K, T and δ_r.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[expect(non_snake_case, reason = "K and T are the symbols of the field")]
pub struct Indices {
    /// K, 1/s.
    pub K_per_s: Quantity,
    /// T, s.
    pub T_s: Quantity,
    /// δ_r, deg.
    pub delta_r_deg: Quantity,
    /// K' and T', where length and speed of the ship are known.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub prime: Option<PrimeIndices>,
}

/// K' = K L/U and T' = T U/L.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[expect(non_snake_case, reason = "K and T are the symbols of the field")]
pub struct PrimeIndices {
    /// K'.
    pub K: Quantity,
    /// T'.
    pub T: Quantity,
}

impl PrimeIndices {
    /// Those of K and T of a ship of these particulars.
    pub fn of([k, t]: [Quantity; 2], ship: Particulars) -> Self {
        Self { K: k.scaled(ship.prime([-1, 0])), T: t.scaled(ship.prime([1, 0])) }
    }
}

/// A parameter, averaged over the structures that have it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct ParameterEntry {
    /// Name in files.
    pub key: String,
    /// Symbol, as in the equation.
    pub symbol: String,
    /// Value, standard deviation and 95 % interval.
    #[serde(flatten)]
    pub quantity: Quantity,
    /// Unit.
    pub unit: String,
    /// The same without dimension, where length and speed of the ship are known and it has one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub prime: Option<PrimeEntry>,
    /// The one record it belongs to.
    pub only: Option<String>,
    /// Whether it ends at an end of its range; left out where it does not.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub at_bound: bool,
}

/// A number without dimension; angles in radians.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct PrimeEntry {
    /// Value, standard deviation and 95 % interval.
    #[serde(flatten)]
    pub quantity: Quantity,
    /// Unit: 1, or one of angles.
    pub unit: String,
}
