//! Empirical terms: monomials in yaw rate, rudder, heading and speed, with and without magnitudes, as candidates in
//! addition to the named effects.

use ship::effects::{
    CandidateEffect, Effect, EffectDescription, EffectEquations, EffectTarget, OperatingPoint, Parameter, RecordScales,
};
use ship::particulars::Dimension;
use ship::{EffectReal, RegressorChannel};

use std::sync::{Arc, LazyLock};

use trial::Trial;

use crate::candidates::{mean_square, record_scales};
use crate::model::Term;
use crate::record::PreparedRecord;

/// Monomial c r^i δ^j ψ^k U^l added to the rudder angle; r, δ, ψ and U are divided by their scales in the records.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Monomial {
    /// Exponents and magnitudes.
    pub powers: &'static MonomialPowers,
    /// Scales: 0.2 U/L for r (rad/s), the maximum rudder angle for δ (rad), root mean squares for ψ (rad) and U (m/s).
    pub scales: [f64; 4],
}

/// Exponents of r, δ, ψ and U in one monomial of the library of empirical terms.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct MonomialPowers {
    /// Exponents of r, δ, ψ and U.
    pub exponents: [i32; 4],
    /// `true` for a power with one factor as a magnitude, in the order of the exponents.
    magnitude: [bool; 4],
    /// Notation, such as "δ|δ||ψ|".
    pub form: &'static str,
    equation: String,
}

impl MonomialPowers {
    /// Parses the notation: "δ|δ||ψ|" is δ to the second power, one factor of it a magnitude, times the magnitude of ψ.
    fn from_notation(form: &'static str) -> Self {
        let (mut exponents, mut magnitude, mut factor, mut inside) = ([0; 4], [false; 4], 0, false);
        for letter in form.chars() {
            match letter {
                '|' => inside = !inside,
                '²' => exponents[factor] += 1,
                '³' => exponents[factor] += 2,
                name => {
                    factor = "rδψU".chars().position(|symbol| symbol == name).expect("a factor of the library");
                    exponents[factor] += 1;
                    magnitude[factor] |= inside;
                }
            }
        }
        Self { exponents, magnitude, form, equation: format!("T r' + r = K (δ + δ_r + c {form})") }
    }

    /// Text that [`Formula::parse`](ship::effects::Formula::parse) reads, such as "proposal = c * r^2 * delta".
    pub fn formula_text(&self) -> String {
        let factor = |(place, name): (usize, &str)| match (self.exponents[place], self.magnitude[place]) {
            (0, _) => String::new(),
            (1, false) => format!(" * {name}"),
            (1, true) => format!(" * abs({name})"),
            (power, false) => format!(" * {name}^{power}"),
            (2, true) => format!(" * {name} * abs({name})"),
            (power, true) => format!(" * {name}^{} * abs({name})", power - 1),
        };
        let factors = ["r", "delta", "psi", "U"].into_iter().enumerate().map(factor);
        format!("proposal = c{}", factors.collect::<String>())
    }
}

/// Monomials up to the third degree that are not named effects.
const PLAIN: &str = "ψ ψ² ψ³ δ² rδ rψ δψ r²δ rδ² r²ψ rψ² δ²ψ δψ² rδψ U rU δU ψU";

/// Monomials up to the third degree with magnitudes that are not named effects: candidates for tests of a rule with
/// many competitors, never proposed to a user.
const WITH_MAGNITUDES: &str = "|ψ| |r| ψ|ψ| δ|δ| δ|ψ| ψ|δ| |δ||ψ| r|ψ| ψ|r| |r||ψ| r|δ| δ|r| |r||δ| |ψ|³ |δ|³ |r|³ δψ|ψ| ψ²|δ| \
    ψ|δ||ψ| δ²|ψ| δψ|δ| δ|δ||ψ| rψ|ψ| ψ²|r| ψ|r||ψ| rδ|δ| δ²|r| δ|r||δ| r²|ψ| rψ|r| r|r||ψ| r²|δ| rδ|r| \
    r|r||δ| rδ|ψ| rψ|δ| r|δ||ψ| δψ|r| δ|r||ψ| ψ|r||δ| |r||δ||ψ|";

/// All monomials; those with magnitudes are last.
static LIBRARY: LazyLock<Vec<MonomialPowers>> =
    LazyLock::new(|| PLAIN.split(' ').chain(WITH_MAGNITUDES.split(' ')).map(MonomialPowers::from_notation).collect());

/// All monomials; those with magnitudes are last.
pub fn all_monomials() -> &'static [MonomialPowers] {
    &LIBRARY
}

/// Monomials without magnitudes.
pub fn monomials_without_magnitudes() -> &'static [MonomialPowers] {
    &LIBRARY[..PLAIN.split(' ').count()]
}

/// Log prior odds of an empirical term.
const LOG_ODDS: f64 = -4.0;

/// Candidate terms of the monomials whose channels the records have; `ship_length_time` is L/U, s.
pub fn monomial_terms(
    records: &[PreparedRecord],
    trials: &[Trial],
    ship_length_time: f64,
) -> impl Iterator<Item = Arc<Term>> {
    let about = record_scales(records, trials, ship_length_time, &records[0]);
    let rms = |values: &mut dyn Iterator<Item = f64>| {
        let (square, count) = values.fold((0.0, 0usize), |(sum, n), x| (sum + x * x, n + 1));
        (square / count.max(1) as f64).sqrt().max(1e-9)
    };
    let heading = rms(&mut records.iter().flat_map(|r| r.observed_rows.iter().map(|&row| r.heading[row])));
    let speed = mean_square(records, |record| record.speed.as_ref()).map(f64::sqrt);
    let scales = [0.2 / ship_length_time, about.max_rudder, heading, speed.unwrap_or(1.0)];
    all_monomials().iter().filter(move |powers| speed.is_some() || powers.exponents[3] == 0).filter_map(move |powers| {
        let CandidateEffect { effect, priors } = Monomial { powers, scales }.candidate(&about)?;
        Some(Arc::new(Term { effect, record_index: None, priors, log_odds: LOG_ODDS }))
    })
}

/// Prior standard deviation of a coefficient, rad.
pub const PRIOR_SD_RAD: f64 = 0.05;

/// Coefficient of an empirical term, rad of rudder, for factors divided by their scales.
pub const COEFFICIENT: Parameter = Parameter::even(["c", "c", "rad"], [0.0, 0.02], [-10.0, 10.0]);

const PARAMETERS: [Parameter; 1] = [COEFFICIENT];

impl Effect for Monomial {
    fn description(&self) -> EffectDescription {
        EffectDescription {
            id: "empirical",
            form: self.powers.form,
            equation: &self.powers.equation,
            parameters: &PARAMETERS,
        }
    }

    fn constants(&self) -> Vec<(f64, Dimension)> {
        self.scales.into_iter().zip([[-1, 0], [0, 0], [0, 0], [-1, 1]]).collect()
    }

    fn is_heading_dependent(&self) -> bool {
        self.powers.exponents[2] > 0
    }

    fn candidate(&self, _about: &RecordScales) -> Option<CandidateEffect> {
        Some(CandidateEffect::with_normal_prior(*self, PRIOR_SD_RAD))
    }

    fn acts_on(&self) -> EffectTarget {
        EffectTarget::MOMENT
    }

    fn needs(&self) -> Option<RegressorChannel> {
        (self.powers.exponents[3] > 0).then_some(RegressorChannel::Speed)
    }
}

impl<R: EffectReal> EffectEquations<R> for Monomial {
    fn yaw_acceleration(&self, p: &[R], _z: &[R], now: &OperatingPoint<R>) -> R {
        let speed = R::from(now.measured.speed.unwrap_or(0.0));
        let factors = [now.yaw_rate, now.rudder, now.heading, speed];
        let power = |k: usize| {
            let (x, exponent) = (factors[k] / self.scales[k], self.powers.exponents[k]);
            if self.powers.magnitude[k] { x.powi(exponent - 1) * x.abs() } else { x.powi(exponent) }
        };
        (0..factors.len()).fold(now.K_over_T * p[0], |product, k| product * power(k))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn monomials_are_read_as_they_are_written() {
        let none = [false; 4];
        let cases = [
            ("ψ³", [0, 0, 3, 0], none),
            ("rδ²", [1, 2, 0, 0], none),
            ("δU", [0, 1, 0, 1], none),
            ("|ψ|³", [0, 0, 3, 0], [false, false, true, false]),
            ("δ|δ||ψ|", [0, 2, 1, 0], [false, true, true, false]),
            ("ψ²|r|", [1, 0, 2, 0], [true, false, false, false]),
        ];
        for (form, exponents, magnitude) in cases {
            let powers = MonomialPowers::from_notation(form);
            assert_eq!((powers.exponents, powers.magnitude), (exponents, magnitude), "{form}");
        }
        assert_eq!(MonomialPowers::from_notation("r²δ").formula_text(), "proposal = c * r^2 * delta");
        assert_eq!(
            MonomialPowers::from_notation("δ|δ||ψ|").formula_text(),
            "proposal = c * delta * abs(delta) * abs(psi)"
        );
        assert!(all_monomials().iter().all(|powers| ship::effects::Formula::parse(&powers.formula_text()).is_ok()));
        assert_eq!((monomials_without_magnitudes().len(), all_monomials().len()), (18, 59));
    }
}
