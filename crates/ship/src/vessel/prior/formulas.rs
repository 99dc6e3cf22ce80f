//! Formulas for mean and standard deviation of every coefficient of an MMG hull, in the prime system ½ρLdU².
//!
//! The formulas were checked against the published derivatives of KVLCC2 and of the 3 m model of Esso Osaka; the
//! standard deviation of a coefficient is about the error for these hulls. Three formulas circulate with errors: Yvvv'
//! = −(0.185 L/B + 0.48), not −0.185 L/B + 0.48; N_r' is not −k (0.54 + k); the Y_r' of Lee (1998) already contains
//! −(m' + m_x') and is not used.

use std::f64::consts::PI;

use super::particulars::HullDimensions;

/// Standard deviation of a coefficient if all particulars are given.
#[derive(Debug, Clone, Copy)]
pub(super) enum Spread {
    /// Relative to the mean.
    Share(f64),
    /// Absolute.
    Absolute(f64),
}
use Spread::{Absolute, Share};

/// Formula of a coefficient from the particulars, with spread and source.
#[derive(Debug)]
pub struct CoefficientFormula {
    /// Name of the coefficient in files: "Nvvr", "gammaR-port".
    pub key: &'static str,
    /// Symbol.
    pub symbol: &'static str,
    pub(super) mean: fn(&HullDimensions) -> f64,
    pub(super) spread: Spread,
    /// Formula as text: an equation in L, B, d, C_b and other particulars, or a number.
    pub text: &'static str,
    /// Author and year.
    pub source: &'static str,
}

/// Row of the table: key, symbol, formula, spread, formula as text, source.
const fn row(
    key: &'static str,
    symbol: &'static str,
    mean: fn(&HullDimensions) -> f64,
    spread: Spread,
    text: &'static str,
    source: &'static str,
) -> CoefficientFormula {
    CoefficientFormula { key, symbol, mean, spread, text, source }
}

impl HullDimensions {
    /// Aspect ratio of the hull, k = 2 d/L.
    fn k(&self) -> f64 {
        2.0 * self.d / self.L
    }

    /// Fullness C_b B/L.
    fn fullness(&self) -> f64 {
        self.Cb * self.B / self.L
    }

    /// Prime mass m' = ∇/(½ L² d).
    fn mass(&self) -> f64 {
        2.0 * self.fullness()
    }

    /// Added mass in surge m_x'.
    fn added_surge(&self) -> f64 {
        let (lb, db) = (self.L / self.B, self.d / self.B);
        let share = 0.398 + 11.97 * self.Cb * (1.0 + 3.73 * db) - 2.89 * self.Cb * lb * (1.0 + 1.13 * db)
            + 0.175 * self.Cb * lb * lb * (1.0 + 0.541 * db)
            - 1.107 * lb * db;
        // For very slender hulls, outside the charts, the regression is negative.
        0.01 * share.max(2.0) * self.mass()
    }

    /// Added mass in sway m_y'.
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

    /// Resistance coefficient R0' that the thrust balances at an advance ratio of one: R0' J² at K_T =
    /// [`SERVICE_THRUST`].
    ///
    /// From R0' = (1 − t_P) 2 D_P⁴ n² K_T/(L d U²) with n D_P = U (1 − w_P0)/J.
    fn thrust_at_one(&self) -> f64 {
        let stream = self.DP * (1.0 - self.wake());
        2.0 * (1.0 - DEDUCTION) * stream * stream * SERVICE_THRUST / (self.L * self.d)
    }

    /// Advance ratio of the straight approach, from the revolutions, else from the balance of thrust and
    /// [`RESISTANCE`].
    pub(super) fn advance_ratio(&self) -> f64 {
        let by_revolutions = |n: f64| self.U * (1.0 - self.wake()) / (n * self.DP);
        self.n.map_or_else(|| (self.thrust_at_one() / RESISTANCE).sqrt(), by_revolutions)
    }

    /// Resistance coefficient R0', from the revolutions, else [`RESISTANCE`].
    fn resistance(&self) -> f64 {
        self.n.map_or(RESISTANCE, |_| self.thrust_at_one() / self.advance_ratio().powi(2))
    }

    /// Aspect ratio of the rudder, Λ = H_R²/A_R.
    fn aspect(&self) -> f64 {
        self.HR * self.HR / self.AR
    }
}

/// Typical R0', between 0.022 of KVLCC2 and 0.016 of the SEIUN-like ship.
const RESISTANCE: f64 = 0.018;
/// Typical K_T on the straight approach, between 0.20 of KVLCC2 and 0.16 of the SEIUN-like ship.
const SERVICE_THRUST: f64 = 0.18;
/// Typical slope of K_T over J at this point, between −0.36 and −0.4.
const THRUST_SLOPE: f64 = -0.38;
/// Typical thrust deduction, that of KVLCC2 and Esso Osaka; the SEIUN-like ship has 0.21.
const DEDUCTION: f64 = 0.22;

const LEE: &str = "Lee (1998)";
const KIJIMA: &str = "Kijima (1990)";
const YOSHIMURA: &str = "Yoshimura and Masumoto (2012)";
const ZHOU: &str = "Motora's charts, regression of Zhou (1983)";
const FUJII: &str = "Fujii and Tsuda (1961)";
const MANSIM: &str = "Sukas, Kinaci and Bal (2019)";
const PUBLISHED: &str = "typical: KVLCC2, Esso Osaka, SEIUN-like";
const KVLCC2: &str = "as KVLCC2, Yasukawa and Yoshimura (2015)";

/// Table of formulas. Symbols: k = 2 d/L, m' = 2 C_b B/L, Λ = H_R²/A_R, J the advance ratio of the straight approach.
pub(super) const FORMULAS: &[CoefficientFormula] = &[
    row("mx", "m_x'", HullDimensions::added_surge, Absolute(0.008), "m' f(C_b, L/B, d/B)", ZHOU),
    row("my", "m_y'", HullDimensions::added_sway, Share(0.15), "m' f(C_b, L/B, d/B)", ZHOU),
    row(
        "Jz",
        "J_z'",
        |f| {
            let radius = 0.01 * (33.0 - 76.85 * f.Cb * (1.0 - 0.784 * f.Cb) + 3.43 * f.L / f.B * (1.0 - 0.63 * f.Cb));
            radius * radius * f.mass()
        },
        Share(0.2),
        "m' (.33 − .7685 C_b (1 − .784 C_b) + .0343 L/B (1 − .63 C_b))²",
        ZHOU,
    ),
    row(
        "R0",
        "R_0'",
        HullDimensions::resistance,
        Share(0.3),
        "2 (1 − t_P) (1 − w_P0)² D_P² .18/(L d J²); without propeller-rps .018",
        PUBLISHED,
    ),
    row("Xvv", "X_vv'", |f| 1.15 * f.fullness() - 0.18, Absolute(0.04), "1.15 C_b B/L − .18", YOSHIMURA),
    row(
        "Xvr",
        "X_vr'",
        |f| 0.08 - 1.91 * f.fullness() + f.added_sway(),
        Absolute(0.04),
        "m_y' − 1.91 C_b B/L + .08",
        YOSHIMURA,
    ),
    row("Xrr", "X_rr'", |_| 0.012, Absolute(0.012), ".012", PUBLISHED),
    row("Xvvvv", "X_vvvv'", |f| 1.1 - 6.68 * f.fullness(), Absolute(0.5), "1.1 − 6.68 C_b B/L", YOSHIMURA),
    row("Yv", "Y_v'", |f| -(0.5 * PI * f.k() + 1.4 * f.fullness()), Share(0.25), "−(π k/2 + 1.4 C_b B/L)", KIJIMA),
    row("Yr", "Y_r'", |f| f.added_surge() + 0.5 * f.fullness(), Share(0.2), "m_x' + .5 C_b B/L", YOSHIMURA),
    row("Yvvv", "Y_vvv'", |f| -(0.185 * f.L / f.B + 0.48), Share(0.2), "−(.185 L/B + .48)", YOSHIMURA),
    row("Yvvr", "Y_vvr'", |_| 0.0, Absolute(0.5), "0; formulas can have the wrong sign", PUBLISHED),
    row(
        "Yvrr",
        "Y_vrr'",
        |f| -(0.26 * (1.0 - f.Cb) * f.L / f.B + 0.11),
        Share(0.3),
        "−(.26 (1 − C_b) L/B + .11)",
        YOSHIMURA,
    ),
    row("Yrrr", "Y_rrr'", |_| -0.051, Absolute(0.05), "−.051", YOSHIMURA),
    row("Nv", "N_v'", |f| -f.k(), Share(0.15), "−k", KIJIMA),
    row(
        "Nr",
        "N_r'",
        |f| {
            let dl = f.d / f.L;
            (-0.003724 + 0.10446 * dl - 1.393 * dl * dl) / dl
        },
        Share(0.15),
        "L/d (−.003724 + .10446 d/L − 1.393 (d/L)²)",
        LEE,
    ),
    row("Nvvv", "N_vvv'", |f| -(0.66 - 0.69 * f.Cb), Share(1.0), "−(.66 − .69 C_b)", YOSHIMURA),
    row("Nvvr", "N_vvr'", |f| 1.55 * f.fullness() - 0.76, Share(1.0), "1.55 C_b B/L − .76", YOSHIMURA),
    row("Nvrr", "N_vrr'", |_| 0.0, Absolute(0.2), "0; formulas can have the wrong sign", PUBLISHED),
    row("Nrrr", "N_rrr'", |f| 0.25 * f.fullness() - 0.056, Absolute(0.02), ".25 C_b B/L − .056", YOSHIMURA),
    row("wP0", "w_P0", HullDimensions::wake, Absolute(0.08), ".5 C_b − .05", "Taylor"),
    row("C1", "C_1", |_| 2.0, Absolute(0.6), "2", KVLCC2),
    row("C2-starboard", "C_2, β_P > 0", |_| 1.6, Absolute(0.25), "1.6", KVLCC2),
    row("C2-port", "C_2, β_P < 0", |_| 1.1, Absolute(0.25), "1.1", KVLCC2),
    row("tP", "t_P", |_| DEDUCTION, Absolute(0.04), ".22", PUBLISHED),
    row("xP", "x_P'", |_| -0.48, Absolute(0.02), "−.48", KVLCC2),
    row("k0", "k_0", |f| SERVICE_THRUST - THRUST_SLOPE * f.advance_ratio(), Share(0.15), ".18 + .38 J", PUBLISHED),
    row("k1", "k_1", |_| THRUST_SLOPE, Share(0.2), "−.38", PUBLISHED),
    row("k2", "k_2", |_| 0.0, Absolute(0.1), "0", PUBLISHED),
    row("f_alpha", "f_α", |f| 6.13 * f.aspect() / (2.25 + f.aspect()), Share(0.12), "6.13 Λ/(2.25 + Λ)", FUJII),
    row("epsilon", "ε", |_| 1.1, Absolute(0.2), "1.1", PUBLISHED),
    row("kappa", "κ", |_| 0.5, Absolute(0.15), ".5", PUBLISHED),
    row("tR", "t_R", |_| 0.31, Absolute(0.1), ".31", PUBLISHED),
    row("aH", "a_H", |f| 0.627 * f.Cb - 0.153, Absolute(0.08), ".627 C_b − .153", "Quadvlieg (2013)"),
    row("xH", "x_H'", |_| -0.44, Absolute(0.05), "−.44", PUBLISHED),
    row("xR", "x_R'", |_| -0.5, Absolute(0.01), "−.5", PUBLISHED),
    row("lR", "ℓ_R'", |_| -0.9, Absolute(0.2), "−.9", YOSHIMURA),
    row("gammaR-starboard", "γ_R, β_R > 0", |f| 2.06 * f.fullness() + 0.14, Share(0.3), "2.06 C_b B/L + .14", MANSIM),
    row("gammaR-port", "γ_R, β_R < 0", |f| 2.06 * f.fullness() + 0.14, Share(0.3), "2.06 C_b B/L + .14", MANSIM),
    row("kzz", "k_zz", |_| 0.25, Absolute(0.015), ".25", KVLCC2),
];
