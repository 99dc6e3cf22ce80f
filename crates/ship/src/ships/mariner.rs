//! Mariner-class cargo ship at 15 kn, as a hull and as the second-order response of that hull.
//!
//! The hull has a constant sway force and yaw moment (Y0, N0), the asymmetry of its single propeller: with the rudder
//! amidships the hull does not keep a straight course. The tabulated x_G' = −0.023 is prime and used as printed.

use std::sync::Arc;

use super::user::second_order_response;
use super::{Ship, ShipModel};
use crate::linear::SecondOrderNomotoIndices;
use crate::particulars::Particulars;
use crate::vessel::abkowitz::{Abkowitz, AbkowitzDerivatives, LateralDerivatives};

const PARTICULARS: Particulars = Particulars { length: 160.93, speed: 7.7175 };
/// Unit of the printed table.
const E5: f64 = 1e-5;

/// Derivatives of Chislett and Strøm-Tejsen (1965), as printed: prime, rudder positive to port.
pub const DERIVATIVES: AbkowitzDerivatives = AbkowitzDerivatives {
    m: 798.0 * E5,
    Iz: 39.2 * E5,
    xG: -0.023,
    Xudot: -42.0 * E5,
    Yvdot: -748.0 * E5,
    Yrdot: -9.354 * E5,
    Nvdot: 4.646 * E5,
    Nrdot: -43.8 * E5,
    Xu: -184.0 * E5,
    Xuu: -110.0 * E5,
    Xuuu: -215.0 * E5,
    Xvv: -899.0 * E5,
    Xrr: 18.0 * E5,
    Xdd: -95.0 * E5,
    Xudd: -190.0 * E5,
    Xrv: 798.0 * E5,
    Xvd: 93.0 * E5,
    Xuvd: 93.0 * E5,
    Y: LateralDerivatives {
        v: -1160.0 * E5,
        r: -499.0 * E5,
        vvv: -8078.0 * E5,
        vvr: 15356.0 * E5,
        vu: -1160.0 * E5,
        ru: -499.0 * E5,
        d: 278.0 * E5,
        ddd: -90.0 * E5,
        ud: 556.0 * E5,
        uud: 278.0 * E5,
        vdd: -4.0 * E5,
        vvd: 1190.0 * E5,
        zero: -4.0 * E5,
        zero_u: -8.0 * E5,
        zero_uu: -4.0 * E5,
    },
    N: LateralDerivatives {
        v: -264.0 * E5,
        r: -166.0 * E5,
        vvv: 1636.0 * E5,
        vvr: -5483.0 * E5,
        vu: -264.0 * E5,
        ru: -166.0 * E5,
        d: -139.0 * E5,
        ddd: 45.0 * E5,
        ud: -278.0 * E5,
        uud: -139.0 * E5,
        vdd: 13.0 * E5,
        vvd: -489.0 * E5,
        zero: 3.0 * E5,
        zero_u: 6.0 * E5,
        zero_uu: 3.0 * E5,
    },
};

/// Rounded indices of [`DERIVATIVES`]: K = 0.185 1/s, T1 = 118 s, T2 = 7.8 s, T3 = 18.5 s.
pub const INDICES: SecondOrderNomotoIndices = SecondOrderNomotoIndices { K: 0.185, T1: 118.0, T2: 7.8, T3: 18.5 };

fn mariner(id: &'static str, name: &'static str, source: &'static str, model: ShipModel) -> Ship {
    Ship {
        id: id.into(),
        name: name.into(),
        source: source.into(),
        particulars: Some(PARTICULARS),
        rudder_rate: Some(5f64.to_radians()),
        largest_rudder: Some(40f64.to_radians()),
        model,
    }
}

/// Equations of [`hull`].
pub fn hull_model() -> Abkowitz {
    Abkowitz::new(PARTICULARS, DERIVATIVES)
}

/// Mariner hull; rudder to 40° at 5 deg/s as in the source of the table.
///
/// Source: Chislett and Strøm-Tejsen (1965), report Hy-5, as tabulated in the Marine Systems Simulator (Lauvdal 1994,
/// Fossen 2021).
pub fn hull() -> Ship {
    mariner(
        "mariner",
        "Mariner class, 15 kn, hull",
        "Chislett and Strøm-Tejsen (1965), in the Marine Systems Simulator",
        ShipModel::Hull(Arc::new(hull_model())),
    )
}

/// Second-order response of [`INDICES`], without the asymmetry and the nonlinear damping of the hull.
///
/// Source: example of the Nomoto models in the Marine Systems Simulator (Fossen); reproduced by [`DERIVATIVES`].
pub fn second_order() -> Ship {
    mariner(
        "mariner-second-order",
        "Mariner class, 15 kn, second-order response",
        "Marine Systems Simulator (Fossen)",
        ShipModel::Response(second_order_response(INDICES, 0.0, Vec::new(), &[])),
    )
}
