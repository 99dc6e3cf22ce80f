//! Mean and spread of every coefficient of an MMG hull from the particulars of a ship, in the prime system ½ρLdU².
//!
//! Formulas were held against the published derivatives of KVLCC2 and of the 3 m model of Esso Osaka; the spread of a
//! coefficient is about the error found there. Three that circulate with slips are given as they fit those hulls:
//! Yvvv' = −(0.185 L/B + 0.48), not −0.185 L/B + 0.48; N_r' is not −k (0.54 + k); the Y_r' of Lee (1998) already
//! contains −(m' + m_x') and is not used.

use std::f64::consts::PI;

use super::particulars::HullDimensions;

/// Standard deviation of a coefficient whose particulars are all known.
#[derive(Debug, Clone, Copy)]
pub(super) enum Spread {
    /// As a share of the mean.
    Share(f64),
    /// As it is.
    Absolute(f64),
}
use Spread::{Absolute, Share};

/// How a coefficient follows from the particulars.
#[derive(Debug)]
pub(super) struct Formula {
    pub key: &'static str,
    pub symbol: &'static str,
    pub of: fn(&HullDimensions) -> f64,
    pub spread: Spread,
    pub text: &'static str,
    pub source: &'static str,
}

impl HullDimensions {
    /// Aspect ratio of the hull, k = 2 d/L.
    fn k(&self) -> f64 {
        2.0 * self.d / self.L
    }

    /// C_b B/L.
    fn fullness(&self) -> f64 {
        self.Cb * self.B / self.L
    }

    /// m' = ∇/(½ L² d).
    fn mass(&self) -> f64 {
        2.0 * self.fullness()
    }

    /// m_x'.
    fn added_surge(&self) -> f64 {
        let (lb, db) = (self.L / self.B, self.d / self.B);
        let share = 0.398 + 11.97 * self.Cb * (1.0 + 3.73 * db) - 2.89 * self.Cb * lb * (1.0 + 1.13 * db)
            + 0.175 * self.Cb * lb * lb * (1.0 + 0.541 * db)
            - 1.107 * lb * db;
        // Very slender hulls are beyond the charts, and the regression falls below zero.
        0.01 * share.max(2.0) * self.mass()
    }

    /// m_y'.
    fn added_sway(&self) -> f64 {
        let (lb, db) = (self.L / self.B, self.d / self.B);
        let share = 0.882 - 0.54 * self.Cb * (1.0 - 1.6 * db) - 0.156 * lb * (1.0 - 0.673 * self.Cb)
            + 0.826 * lb * db * (1.0 - 0.678 * db)
            - 0.638 * self.Cb * lb * db * (1.0 - 0.669 * db);
        share * self.mass()
    }

    /// Wake fraction of a single screw. Source: Taylor.
    fn wake(&self) -> f64 {
        0.5 * self.Cb - 0.05
    }

    /// Thrust over resistance at an advance ratio of one: R0' J² at K_T = [`SERVICE_THRUST`].
    ///
    /// From R0' = (1 − t_P) 2 D_P⁴ n² K_T/(L d U²) with n D_P = U (1 − w_P0)/J.
    fn thrust_at_one(&self) -> f64 {
        let stream = self.DP * (1.0 - self.wake());
        2.0 * (1.0 - DEDUCTION) * stream * stream * SERVICE_THRUST / (self.L * self.d)
    }

    /// Advance ratio of the straight approach: by the revolutions, else so that thrust balances [`RESISTANCE`].
    pub(super) fn advance(&self) -> f64 {
        let by_revolutions = |n: f64| self.U * (1.0 - self.wake()) / (n * self.DP);
        self.n.map_or_else(|| (self.thrust_at_one() / RESISTANCE).sqrt(), by_revolutions)
    }

    /// R0': by the revolutions, else [`RESISTANCE`].
    fn resistance(&self) -> f64 {
        self.n.map_or(RESISTANCE, |_| self.thrust_at_one() / self.advance().powi(2))
    }

    /// Aspect ratio of the rudder Λ.
    fn aspect(&self) -> f64 {
        self.HR * self.HR / self.AR
    }
}

/// R0' between those of KVLCC2, 0.022, and of the SEIUN-like ship, 0.016.
const RESISTANCE: f64 = 0.018;
/// K_T on the straight approach, of KVLCC2 0.20 and of the SEIUN-like ship 0.16.
const SERVICE_THRUST: f64 = 0.18;
/// Slope of K_T over J there, −0.36 and −0.4.
const THRUST_SLOPE: f64 = -0.38;
/// Thrust deduction of both, and of Esso Osaka.
const DEDUCTION: f64 = 0.22;

const LEE: &str = "Lee (1998)";
const KIJIMA: &str = "Kijima (1990)";
const YOSHIMURA: &str = "Yoshimura and Masumoto (2012)";
const ZHOU: &str = "Motora's charts, regression of Zhou (1983)";
const FUJII: &str = "Fujii and Tsuda (1961)";
const MANSIM: &str = "Sukas, Kinaci and Bal (2019)";
const PUBLISHED: &str = "typical: KVLCC2, Esso Osaka, SEIUN-like";
const KVLCC2: &str = "as KVLCC2, Yasukawa and Yoshimura (2015)";

/// Symbols: k = 2 d/L, m' = 2 C_b B/L, Λ = H_R²/A_R, J the advance ratio of the straight approach.
pub(super) const FORMULAS: &[Formula] = &[
    Formula {
        key: "mx",
        symbol: "m_x'",
        of: HullDimensions::added_surge,
        spread: Absolute(0.008),
        text: "m' f(C_b, L/B, d/B)",
        source: ZHOU,
    },
    Formula {
        key: "my",
        symbol: "m_y'",
        of: HullDimensions::added_sway,
        spread: Share(0.15),
        text: "m' f(C_b, L/B, d/B)",
        source: ZHOU,
    },
    Formula {
        key: "Jz",
        symbol: "J_z'",
        of: |f| {
            let radius = 0.01 * (33.0 - 76.85 * f.Cb * (1.0 - 0.784 * f.Cb) + 3.43 * f.L / f.B * (1.0 - 0.63 * f.Cb));
            radius * radius * f.mass()
        },
        spread: Share(0.2),
        text: "m' (.33 − .7685 C_b (1 − .784 C_b) + .0343 L/B (1 − .63 C_b))²",
        source: ZHOU,
    },
    Formula {
        key: "R0",
        symbol: "R_0'",
        of: HullDimensions::resistance,
        spread: Share(0.3),
        text: "2 (1 − t_P) (1 − w_P0)² D_P² .18/(L d J²); without propeller-rps .018",
        source: PUBLISHED,
    },
    Formula {
        key: "Xvv",
        symbol: "X_vv'",
        of: |f| 1.15 * f.fullness() - 0.18,
        spread: Absolute(0.04),
        text: "1.15 C_b B/L − .18",
        source: YOSHIMURA,
    },
    Formula {
        key: "Xvr",
        symbol: "X_vr'",
        of: |f| 0.08 - 1.91 * f.fullness() + f.added_sway(),
        spread: Absolute(0.04),
        text: "m_y' − 1.91 C_b B/L + .08",
        source: YOSHIMURA,
    },
    Formula { key: "Xrr", symbol: "X_rr'", of: |_| 0.012, spread: Absolute(0.012), text: ".012", source: PUBLISHED },
    Formula {
        key: "Xvvvv",
        symbol: "X_vvvv'",
        of: |f| 1.1 - 6.68 * f.fullness(),
        spread: Absolute(0.5),
        text: "1.1 − 6.68 C_b B/L",
        source: YOSHIMURA,
    },
    Formula {
        key: "Yv",
        symbol: "Y_v'",
        of: |f| -(0.5 * PI * f.k() + 1.4 * f.fullness()),
        spread: Share(0.25),
        text: "−(π k/2 + 1.4 C_b B/L)",
        source: KIJIMA,
    },
    Formula {
        key: "Yr",
        symbol: "Y_r'",
        of: |f| f.added_surge() + 0.5 * f.fullness(),
        spread: Share(0.2),
        text: "m_x' + .5 C_b B/L",
        source: YOSHIMURA,
    },
    Formula {
        key: "Yvvv",
        symbol: "Y_vvv'",
        of: |f| -(0.185 * f.L / f.B + 0.48),
        spread: Share(0.2),
        text: "−(.185 L/B + .48)",
        source: YOSHIMURA,
    },
    Formula {
        key: "Yvvr",
        symbol: "Y_vvr'",
        of: |_| 0.0,
        spread: Absolute(0.5),
        text: "0; formulas can have the wrong sign",
        source: PUBLISHED,
    },
    Formula {
        key: "Yvrr",
        symbol: "Y_vrr'",
        of: |f| -(0.26 * (1.0 - f.Cb) * f.L / f.B + 0.11),
        spread: Share(0.3),
        text: "−(.26 (1 − C_b) L/B + .11)",
        source: YOSHIMURA,
    },
    Formula {
        key: "Yrrr", symbol: "Y_rrr'", of: |_| -0.051, spread: Absolute(0.05), text: "−.051", source: YOSHIMURA
    },
    Formula { key: "Nv", symbol: "N_v'", of: |f| -f.k(), spread: Share(0.15), text: "−k", source: KIJIMA },
    Formula {
        key: "Nr",
        symbol: "N_r'",
        of: |f| {
            let dl = f.d / f.L;
            (-0.003724 + 0.10446 * dl - 1.393 * dl * dl) / dl
        },
        spread: Share(0.15),
        text: "L/d (−.003724 + .10446 d/L − 1.393 (d/L)²)",
        source: LEE,
    },
    Formula {
        key: "Nvvv",
        symbol: "N_vvv'",
        of: |f| -(0.66 - 0.69 * f.Cb),
        spread: Share(1.0),
        text: "−(.66 − .69 C_b)",
        source: YOSHIMURA,
    },
    Formula {
        key: "Nvvr",
        symbol: "N_vvr'",
        of: |f| 1.55 * f.fullness() - 0.76,
        spread: Share(1.0),
        text: "1.55 C_b B/L − .76",
        source: YOSHIMURA,
    },
    Formula {
        key: "Nvrr",
        symbol: "N_vrr'",
        of: |_| 0.0,
        spread: Absolute(0.2),
        text: "0; formulas can have the wrong sign",
        source: PUBLISHED,
    },
    Formula {
        key: "Nrrr",
        symbol: "N_rrr'",
        of: |f| 0.25 * f.fullness() - 0.056,
        spread: Absolute(0.02),
        text: ".25 C_b B/L − .056",
        source: YOSHIMURA,
    },
    Formula {
        key: "wP0",
        symbol: "w_P0",
        of: HullDimensions::wake,
        spread: Absolute(0.08),
        text: ".5 C_b − .05",
        source: "Taylor",
    },
    Formula { key: "C1", symbol: "C_1", of: |_| 2.0, spread: Absolute(0.6), text: "2", source: KVLCC2 },
    Formula {
        key: "C2-starboard",
        symbol: "C_2, β_P > 0",
        of: |_| 1.6,
        spread: Absolute(0.25),
        text: "1.6",
        source: KVLCC2,
    },
    Formula {
        key: "C2-port",
        symbol: "C_2, β_P < 0",
        of: |_| 1.1,
        spread: Absolute(0.25),
        text: "1.1",
        source: KVLCC2,
    },
    Formula { key: "tP", symbol: "t_P", of: |_| DEDUCTION, spread: Absolute(0.04), text: ".22", source: PUBLISHED },
    Formula { key: "xP", symbol: "x_P'", of: |_| -0.48, spread: Absolute(0.02), text: "−.48", source: KVLCC2 },
    Formula {
        key: "k0",
        symbol: "k_0",
        of: |f| SERVICE_THRUST - THRUST_SLOPE * f.advance(),
        spread: Share(0.15),
        text: ".18 + .38 J",
        source: PUBLISHED,
    },
    Formula { key: "k1", symbol: "k_1", of: |_| THRUST_SLOPE, spread: Share(0.2), text: "−.38", source: PUBLISHED },
    Formula { key: "k2", symbol: "k_2", of: |_| 0.0, spread: Absolute(0.1), text: "0", source: PUBLISHED },
    Formula {
        key: "f_alpha",
        symbol: "f_α",
        of: |f| 6.13 * f.aspect() / (2.25 + f.aspect()),
        spread: Share(0.12),
        text: "6.13 Λ/(2.25 + Λ)",
        source: FUJII,
    },
    Formula { key: "epsilon", symbol: "ε", of: |_| 1.1, spread: Absolute(0.2), text: "1.1", source: PUBLISHED },
    Formula { key: "kappa", symbol: "κ", of: |_| 0.5, spread: Absolute(0.15), text: ".5", source: PUBLISHED },
    Formula { key: "tR", symbol: "t_R", of: |_| 0.31, spread: Absolute(0.1), text: ".31", source: PUBLISHED },
    Formula {
        key: "aH",
        symbol: "a_H",
        of: |f| 0.627 * f.Cb - 0.153,
        spread: Absolute(0.08),
        text: ".627 C_b − .153",
        source: "Quadvlieg (2013)",
    },
    Formula { key: "xH", symbol: "x_H'", of: |_| -0.44, spread: Absolute(0.05), text: "−.44", source: PUBLISHED },
    Formula { key: "xR", symbol: "x_R'", of: |_| -0.5, spread: Absolute(0.01), text: "−.5", source: PUBLISHED },
    Formula { key: "lR", symbol: "ℓ_R'", of: |_| -0.9, spread: Absolute(0.2), text: "−.9", source: YOSHIMURA },
    Formula {
        key: "gammaR-starboard",
        symbol: "γ_R, β_R > 0",
        of: |f| 2.06 * f.fullness() + 0.14,
        spread: Share(0.3),
        text: "2.06 C_b B/L + .14",
        source: MANSIM,
    },
    Formula {
        key: "gammaR-port",
        symbol: "γ_R, β_R < 0",
        of: |f| 2.06 * f.fullness() + 0.14,
        spread: Share(0.3),
        text: "2.06 C_b B/L + .14",
        source: MANSIM,
    },
    Formula { key: "kzz", symbol: "k_zz", of: |_| 0.25, spread: Absolute(0.015), text: ".25", source: KVLCC2 },
];
