//! Training ship YUKUN, the first-order ship of the paper that identifies K and T by a Fourier fit of the heading.
//!
//! K and T are printed there without units; 1/s and s are the only plausible units for a ship of this size. Length and
//! speed are not in the paper and were not found in a source that could be checked: 105 m and 16.7 kn (8.59 m/s) are
//! nominal values, for nondimensional numbers only (K' = 1.22, T' = 1.33). Rudder rate and rudder bias are not given.

use super::{KNOT, Ship, ShipModel};
use crate::first_order::FirstOrder;
use crate::particulars::Particulars;
use crate::response::Response;

/// YUKUN with K = 0.1 1/s and T = 16.3 s.
///
/// Source: Ge, Hu, Yin and Sun, Identification of Ship Maneuverability Indexes by Fourier Method. The particulars are
/// not verified.
pub fn ship() -> Ship {
    Ship {
        id: "yukun".into(),
        name: "training ship YUKUN (length and speed not verified)".into(),
        source: "Ge, Hu, Yin, Sun: Identification of Ship Maneuverability Indexes by Fourier Method".into(),
        particulars: Some(Particulars { length: 105.0, speed: 16.7 * KNOT }),
        rudder_rate: None,
        largest_rudder: None,
        model: ShipModel::Response(Response::first_order_ship(FirstOrder::from_indices(0.1, 16.3, 0.0))),
    }
}
