//! Tanker KVLCC2 at full scale and as the 7 m model L7: the MMG benchmark hull.
//!
//! Ship and model share one set of hull, propeller and rudder coefficients; they differ in size and in the wake of the
//! straight approach (0.35 and 0.40), so the model is not an exact miniature. The hull is neutrally stable to within
//! rounding, so its linear indices are meaningless.
//!
//! Sources: Yasukawa and Yoshimura (2015); coefficients agree between three published implementations of that article
//! (the open-water coefficient k2 is printed as −0.1359 in one of them; −0.1385 is correct). Rudder rates: SIMMAN 2020,
//! case 1.2 (2.32 deg/s at full scale, 15.68 deg/s for the model). Radius of gyration: 0.25 L.

use std::sync::Arc;

use super::{KNOT, Ship, ShipModel};
use crate::vessel::Hull;
use crate::vessel::mmg::{BySign, HullDerivatives, Mmg, MmgParameters, Propeller, Rudder, Wake};

const HULL: HullDerivatives = HullDerivatives {
    mx: 0.022,
    my: 0.223,
    Jz: 0.011,
    R0: 0.022,
    Xvv: -0.040,
    Xvr: 0.002,
    Xrr: 0.011,
    Xvvvv: 0.771,
    Yv: -0.315,
    Yr: 0.083,
    Yvvv: -1.607,
    Yvvr: 0.379,
    Yvrr: -0.391,
    Yrrr: 0.008,
    Nv: -0.137,
    Nr: -0.049,
    Nvvv: -0.030,
    Nvvr: -0.294,
    Nvrr: 0.055,
    Nrrr: -0.013,
};

const PROPELLER: Propeller = Propeller {
    DP: 9.86,
    wP0: 0.35,
    wake: Wake::Exponential { C1: 2.0, C2: BySign { positive: 1.6, negative: 1.1 } },
    tP: 0.220,
    xP: -0.48,
    k: [0.2931, -0.2753, -0.1385],
};

const RUDDER: Rudder = Rudder {
    AR: 112.5,
    eta: 9.86 / 15.8,
    f_alpha: 2.747,
    epsilon: 1.09,
    kappa: 0.50,
    tR: 0.387,
    aH: 0.312,
    xH: -0.464,
    xR: -0.5,
    lR: -0.710,
    gammaR: BySign { positive: 0.640, negative: 0.395 },
};

/// Parameters at full scale.
pub const FULL_SCALE: MmgParameters = MmgParameters {
    Lpp: 320.0,
    d: 20.8,
    volume: 312_600.0,
    xG: 11.2,
    kzz: 0.25,
    hull: HULL,
    propeller: PROPELLER,
    rudder: RUDDER,
};

/// Parameters of the 7 m model, with the draught as published; the scale of the ship would give 0.455 m, which
/// increases the second 10/10 overshoot by 0.2°.
pub const MODEL_L7: MmgParameters = MmgParameters {
    Lpp: 7.0,
    d: 0.46,
    volume: 3.27,
    xG: 0.25,
    kzz: 0.25,
    hull: HULL,
    propeller: Propeller { DP: 0.216, wP0: 0.40, ..PROPELLER },
    rudder: Rudder { AR: 0.0539, eta: 0.216 / 0.345, ..RUDDER },
};

fn ship(id: &'static str, name: &'static str, parameters: MmgParameters, speed: f64, rudder_rate_deg: f64) -> Ship {
    let hull = Mmg::at_speed(parameters, speed).expect("the published set balances thrust and resistance");
    Ship {
        id: id.into(),
        name: name.into(),
        source: "Yasukawa and Yoshimura (2015)".into(),
        particulars: Some(hull.particulars()),
        rudder_rate: Some(rudder_rate_deg.to_radians()),
        largest_rudder: None,
        model: ShipModel::Hull(Arc::new(hull)),
    }
}

/// KVLCC2 at full scale and 15.5 kn, propeller at 1.778 1/s.
pub fn full_scale() -> Ship {
    ship("kvlcc2", "tanker KVLCC2, full scale, 15.5 kn", FULL_SCALE, 15.5 * KNOT, 2.32)
}

/// 7 m model of KVLCC2 at 1.179 m/s, which is 15.5 kn at full scale.
pub fn model_l7() -> Ship {
    ship("kvlcc2-l7", "tanker KVLCC2, model L7 of 7 m, 1.179 m/s", MODEL_L7, 1.179, 15.68)
}
