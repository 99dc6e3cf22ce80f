//! Terms without a name in the field: monomials in yaw rate, rudder, heading and speed, for what no named effect
//! carries.

use ship::effects::{Acts, Effect, Manoeuvres, Now, Parameter, Places, Proposal};
use ship::{EffectReal, Regressor};

/// c r^i δ^j ψ^k U^l as an addition to the yaw acceleration; every factor in units of its own size in the records.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Monomial {
    /// Which one, in [`LIBRARY`].
    pub place: usize,
    /// Sizes of r (rad/s), δ (rad), ψ (rad) and U (m/s).
    pub size: [f64; 4],
}

/// One monomial of the library.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Powers {
    /// Exponents of r, δ, ψ and U.
    pub of: [i32; 4],
    /// The monomial, as it is written.
    pub form: &'static str,
    /// The equation.
    pub equation: &'static str,
}

macro_rules! library {
    ($($form:literal = $of:expr),* $(,)?) => {
        &[$(Powers { of: $of, form: $form, equation: concat!("T r' + r = K (δ + δ_r + c ", $form, ")") }),*]
    };
}

/// Monomials up to the third degree that no named effect is.
pub const LIBRARY: &[Powers] = library![
    "ψ" = [0, 0, 1, 0],
    "ψ²" = [0, 0, 2, 0],
    "ψ³" = [0, 0, 3, 0],
    "δ²" = [0, 2, 0, 0],
    "rδ" = [1, 1, 0, 0],
    "rψ" = [1, 0, 1, 0],
    "δψ" = [0, 1, 1, 0],
    "r²δ" = [2, 1, 0, 0],
    "rδ²" = [1, 2, 0, 0],
    "r²ψ" = [2, 0, 1, 0],
    "rψ²" = [1, 0, 2, 0],
    "δ²ψ" = [0, 2, 1, 0],
    "δψ²" = [0, 1, 2, 0],
    "rδψ" = [1, 1, 1, 0],
    "U" = [0, 0, 0, 1],
    "rU" = [1, 0, 0, 1],
    "δU" = [0, 1, 0, 1],
    "ψU" = [0, 0, 1, 1],
];

const PARAMETERS: [Parameter; 1] = [Parameter {
    key: "c",
    symbol: "c",
    unit: "rad",
    neutral: 0.0,
    typical: 0.02,
    lowest: -10.0,
    highest: 10.0,
    odd: false,
}];

impl Effect for Monomial {
    fn id(&self) -> &'static str {
        "empirical"
    }

    fn form(&self) -> &'static str {
        LIBRARY[self.place].form
    }

    fn equation(&self) -> &'static str {
        LIBRARY[self.place].equation
    }

    fn parameters(&self) -> &'static [Parameter] {
        &PARAMETERS
    }

    fn constants(&self) -> Vec<f64> {
        self.size.into()
    }

    fn sees_heading(&self) -> bool {
        LIBRARY[self.place].of[2] > 0
    }

    fn proposal(&self, _about: &Manoeuvres) -> Option<Proposal> {
        Some(Proposal::of_one(*self, 0.02, 0.0, 1.0))
    }

    fn places(&self) -> Places {
        Places::MOMENT
    }

    fn needs(&self) -> Option<Regressor> {
        (LIBRARY[self.place].of[3] > 0).then_some(Regressor::Speed)
    }
}

impl<R: EffectReal> Acts<R> for Monomial {
    fn yaw_acceleration(&self, p: &[R], _z: &[R], now: &Now<R>) -> R {
        let speed = R::from(now.measured.speed.unwrap_or(0.0));
        let factors = [now.yaw_rate, now.rudder, now.heading, speed];
        let power = |k: usize| (factors[k] / self.size[k]).powi(LIBRARY[self.place].of[k]);
        (0..factors.len()).fold(now.gain * p[0], |product, k| product * power(k))
    }
}
