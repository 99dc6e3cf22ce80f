//! Training ship similar to SEIUN MARU, 105 m, as an MMG hull; contains estimates.
//!
//! No number was verified in a publication of measurements on SEIUN MARU. Of the twelve derivatives of sway force and
//! yaw moment seven (Yvvr, Yvrr, Yrrr, Nv, Nvvv, Nvvr, Nvrr) equal, to the printed digits, the regression of Yoshimura
//! and Masumoto (2012) for L/B = 5.86, C_b = 0.508 and d/L: they are regression values, e.g. Nv = −2d/L. Xvv and Xvr
//! are regression values, too; m_y' is the regression of Zhou (1983), and w_P0 = 0.5 C_b − 0.05. The remaining five
//! (Yv, Yr, Yvvv, Nr, Nrrr) differ from that regression; according to the compiler of the set they were published for
//! SEIUN MARU, which was not verified. Thrust deduction, the linear thrust curve, resistance and several rudder
//! coefficients are estimates or regressions of the compiler. The formulas are in [`crate::vessel::prior`]. The hull
//! moves plausibly for a ship of its size; it does not represent SEIUN MARU.

use std::sync::Arc;

use super::{KNOT, Ship, ShipModel};
use crate::vessel::Hull;
use crate::vessel::mmg::{BySign, HullDerivatives, Mmg, MmgParameters, Propeller, Rudder, Wake};

/// Parameters; the volume is 0.3877 m³ of a 1:24.5 model.
pub const PARAMETERS: MmgParameters = MmgParameters {
    Lpp: 105.0,
    d: 5.966,
    volume: 5701.565,
    xG: -2.249,
    kzz: 0.25,
    hull: HullDerivatives {
        mx: 0.0167,
        my: 0.1576,
        Jz: 0.009,
        R0: 0.016,
        Xvv: -0.0804,
        Xvr: 0.072,
        Xrr: 0.022,
        Xvvvv: 0.439,
        Yv: -0.317,
        Yr: 0.052,
        Yvvv: -1.604,
        Yvvr: -0.75,
        Yvrr: -0.8599,
        Yrrr: -0.051,
        Nv: -0.1136,
        Nr: -0.0795,
        Nvvv: -0.3095,
        Nvvr: -0.6257,
        Nvrr: -0.3143,
        Nrrr: -0.0502,
    },
    propeller: Propeller { DP: 4.7, wP0: 0.204, wake: Wake::Gaussian, tP: 0.21, xP: -0.5, k: [0.4, -0.4, 0.0] },
    rudder: Rudder {
        AR: 13.405,
        eta: 0.960,
        f_alpha: 2.88,
        epsilon: 1.033,
        kappa: 0.676,
        tR: 0.341,
        aH: 0.236,
        xH: -0.4,
        xR: -0.5,
        lR: -0.947,
        gammaR: BySign { positive: 0.394, negative: 0.312 },
    },
};

/// SEIUN-like ship at 16.7 kn, propeller at 2.438 1/s.
///
/// Source: the regression of Yoshimura and Masumoto (2012) with estimates, as compiled in the open-source package
/// mmgdynamics.
pub fn ship() -> Ship {
    let hull = Mmg::at_speed(PARAMETERS, 16.7 * KNOT).expect("the set balances thrust and resistance");
    Ship {
        id: "seiun-like".into(),
        name: "SEIUN-like training ship, 16.7 kn (contains estimates)".into(),
        source: "Regression of Yoshimura and Masumoto (2012) and estimates, in mmgdynamics".into(),
        particulars: Some(hull.particulars()),
        rudder_rate: None,
        largest_rudder: None,
        model: ShipModel::Hull(Arc::new(hull)),
    }
}
