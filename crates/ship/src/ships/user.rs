//! Ships from the numbers of a user: indices K and T, or particulars.

use std::sync::Arc;

use thiserror::Error;

use super::{Ship, ShipModel};
use crate::effects::{Effect, Parameter, SecondOrder};
use crate::first_order::FirstOrder;
use crate::linear::SecondOrderNomotoIndices;
use crate::particulars::Particulars;
use crate::response::{Response, ResponseModel};
use crate::short_number::ShortNumber;
use crate::vessel::mmg::{Mmg, MmgError};
use crate::vessel::prior::{self, HullParticulars, ParticularsError};

/// Error of numbers that are not valid for a ship.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
pub enum ShipError {
    /// Number without physical meaning.
    #[error("{symbol} = {} is not valid: {reason}", ShortNumber(*.value))]
    Value {
        /// Symbol of the number.
        symbol: &'static str,
        /// Value of the number.
        value: f64,
        /// Reason, a sentence.
        reason: &'static str,
    },
    /// Number that gives a parameter of the response outside the range of ships.
    #[error(
        "{symbol} gives {} = {}, outside the range {} to {} {}",
        .parameter.symbol, ShortNumber(*.value), ShortNumber(.parameter.lowest), ShortNumber(.parameter.highest), .parameter.unit
    )]
    Range {
        /// Symbol of the number.
        symbol: &'static str,
        /// Parameter of the response.
        parameter: &'static Parameter,
        /// Value of the parameter, in SI and radians.
        value: f64,
    },
}

fn check(symbol: &'static str, value: f64, holds: bool, reason: &'static str) -> Result<(), ShipError> {
    if holds && value.is_finite() { Ok(()) } else { Err(ShipError::Value { symbol, value, reason }) }
}

fn check_particulars(particulars: Option<Particulars>) -> Result<(), ShipError> {
    let Some(Particulars { length, speed }) = particulars else { return Ok(()) };
    check("length", length, length > 0.0, "it must be positive")?;
    check("speed", speed, speed > 0.0, "it must be positive")
}

fn check_indices(K: f64, T: f64, symbol: &'static str) -> Result<(), ShipError> {
    check("K", K, K != 0.0, "it must be finite and not zero")?;
    check(symbol, T, T != 0.0, "it must be finite and not zero")?;
    check("K", K, K / T > 0.0, "K and T must have the same sign, or the ship turns away from its rudder")
}

/// Check of the parameters of a response against their ranges; `symbols` are the numbers that gave them, in the same
/// order. Fails with the first parameter outside its range. A time constant of a nanosecond, for example, would make a
/// simulation endless.
fn check_range(response: &Response, symbols: &[&'static str]) -> Result<(), ShipError> {
    let values = response.model().parameters().zip(response.parameters()).zip(symbols);
    for ((parameter, &value), symbol) in values {
        if !parameter.is_in_range(value) {
            return Err(ShipError::Range { symbol, parameter, value });
        }
    }
    Ok(())
}

fn ship(name: String, source: &'static str, particulars: Option<Particulars>, model: ShipModel) -> Ship {
    let (id, source) = ("user".into(), source.into());
    Ship { id, name: name.into(), source, particulars, rudder_rate: None, largest_rudder: None, model }
}

/// First-order ship T r' + r = K (δ + δ_r), with the identifier `user`.
///
/// `K` (1/s) and `T` (s) both negative make a course-unstable ship. `rudder_bias` δ_r in rad. Fails for numbers that
/// are not finite, K or T of zero, K and T of different sign, particulars that are not positive, and if 1/T, K/T or δ_r
/// lies outside the range that [`crate::response::BASE_PARAMETERS`] declares.
pub fn first_order(K: f64, T: f64, rudder_bias: f64, particulars: Option<Particulars>) -> Result<Ship, ShipError> {
    check_indices(K, T, "T")?;
    check("rudder bias", rudder_bias, true, "it must be finite")?;
    check_particulars(particulars)?;
    let response = Response::first_order_ship(FirstOrder::from_indices(K, T, rudder_bias));
    check_range(&response, &["T", "K", "rudder bias"])?;
    let name = format!("first order, K = {K} 1/s, T = {T} s");
    Ok(ship(name, "user", particulars, ShipModel::Response(response)))
}

/// Second-order ship T1 T2 r'' + (T1 + T2) r' + r = K (δ + δ_r) + K T3 δ', with the identifier `user`.
///
/// Fails if [`first_order`] fails for K and T1, if T2 is not positive, if T3 is not finite, and if T2 or T3 lies
/// outside the range that [`SecondOrder`] declares.
pub fn second_order(
    indices: SecondOrderNomotoIndices,
    rudder_bias: f64,
    particulars: Option<Particulars>,
) -> Result<Ship, ShipError> {
    let SecondOrderNomotoIndices { K, T1, T2, T3 } = indices;
    check_indices(K, T1, "T1")?;
    check("T2", T2, T2 > 0.0, "it must be positive; for a course-unstable ship T1 is negative")?;
    check("T3", T3, true, "it must be finite")?;
    check("rudder bias", rudder_bias, true, "it must be finite")?;
    check_particulars(particulars)?;
    let name = format!("second order, K = {K} 1/s, T1 = {T1} s, T2 = {T2} s, T3 = {T3} s");
    let response = second_order_response(indices, rudder_bias, Vec::new(), &[]);
    check_range(&response, &["T1", "K", "rudder bias", "T2", "T3"])?;
    Ok(ship(name, "user", particulars, ShipModel::Response(response)))
}

/// Error of particulars from which no hull can be made.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum HullError {
    /// Particulars outside the range of ships.
    #[error(transparent)]
    Particulars(#[from] ParticularsError),
    /// Mean hull without a steady approach.
    #[error(transparent)]
    Mmg(#[from] MmgError),
}

/// MMG hull from particulars, with the identifier `user`: every coefficient has its prior mean.
///
/// Fails for particulars outside the range of ships, or whose mean hull has no steady approach.
pub fn hull(particulars: &HullParticulars) -> Result<Ship, HullError> {
    let hull = Mmg::at_speed(prior::hull_prior(particulars)?.mean_parameters, particulars.speed)?;
    let HullParticulars { length, speed, .. } = *particulars;
    let name = format!("MMG hull by particulars, L = {length} m, U = {speed} m/s");
    let scale = Some(Particulars { length, speed });
    Ok(ship(name, "regressions on the particulars", scale, ShipModel::Hull(Arc::new(hull))))
}

/// Second-order response with further effects and their parameter values.
pub(super) fn second_order_response(
    indices: SecondOrderNomotoIndices,
    rudder_bias: f64,
    further: Vec<Arc<dyn Effect>>,
    values: &[f64],
) -> Response {
    let SecondOrderNomotoIndices { K, T1, T2, T3 } = indices;
    let mut effects: Vec<Arc<dyn Effect>> = vec![Arc::new(SecondOrder)];
    effects.extend(further);
    let mut parameters = vec![1.0 / T1, K / T1, rudder_bias, T2, T3];
    parameters.extend_from_slice(values);
    ResponseModel::new(effects).with_parameters(parameters)
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    #[test]
    fn keeps_the_numbers_it_is_given() {
        let particulars = Some(Particulars { length: 105.0, speed: 8.0 });
        let ship = first_order(0.1, 16.3, 0.01, particulars).expect("a ship");
        let base = ship.first_order().expect("exactly first order");
        assert_relative_eq!(base.K(), 0.1, max_relative = 1e-14);
        assert_relative_eq!(base.T(), 16.3, max_relative = 1e-14);
        assert_eq!(base.rudder_bias, 0.01);
        assert_eq!(ship.particulars, particulars);
        let second = SecondOrderNomotoIndices { K: 0.1, T1: 20.0, T2: 2.5, T3: 6.2 };
        let ship = second_order(second, 0.0, None).expect("a ship");
        assert!(ship.first_order().is_none(), "a second-order ship has no exact K and T");
    }

    #[test]
    fn refuses_ships_that_no_simulation_could_follow() {
        for (K, T, expected) in [
            (0.125, 0.0625, "T gives 1/T = 16, outside the range -10 to 10 1/s"),
            (-0.1, -0.03125, "T gives 1/T = -32, outside the range -10 to 10 1/s"),
            (1e300, 1.0, "K gives K/T = 1e300, outside the range 0 to 100 1/s²"),
        ] {
            let error = first_order(K, T, 0.0, None).err().expect("beyond any ship");
            assert_eq!(error.to_string(), expected);
        }
        let fast = SecondOrderNomotoIndices { K: 0.1, T1: 20.0, T2: 1e-9, T3: 0.0 };
        let error = second_order(fast, 0.0, None).err().expect("beyond any ship");
        assert!(matches!(error, ShipError::Range { symbol: "T2", .. }), "{error}");
    }

    #[test]
    fn refuses_numbers_that_make_no_ship() {
        for (K, T, symbol) in
            [(0.1, 0.0, "T"), (0.0, 16.3, "K"), (0.1, -16.3, "K"), (f64::NAN, 16.3, "K"), (0.1, f64::INFINITY, "T")]
        {
            let Err(ShipError::Value { symbol: refused, .. }) = first_order(K, T, 0.0, None) else {
                panic!("K = {K}, T = {T} was taken for a ship")
            };
            assert_eq!(refused, symbol);
        }
        assert!(first_order(0.1, 16.3, 0.0, Some(Particulars { length: 0.0, speed: 8.0 })).is_err());
        let unstable_twice = SecondOrderNomotoIndices { K: -0.1, T1: -20.0, T2: -2.5, T3: 6.2 };
        assert!(second_order(unstable_twice, 0.0, None).is_err());
    }
}
