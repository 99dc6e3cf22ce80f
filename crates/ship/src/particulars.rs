//! Length and speed of a ship, and the prime system: quantities made nondimensional with them.
//!
//! Source: ITTC Dictionary of Hydrodynamics, prime system.

/// Length and approach speed of a ship, the units of the prime system.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Particulars {
    /// Length between perpendiculars L, m.
    pub length: f64,
    /// Approach speed V, m/s.
    pub speed: f64,
}

/// Usual range of K′ = K L/V of ships and models in zig-zags: KVLCC2 0.75 (35/5) to 3.6 (10/10), Esso Osaka 1.2 to 1.5
/// (records of SIMMAN 2008; Wakita et al. 2022), the Mariner 0.8 to 2.4.
pub const USUAL_K_PRIME: [f64; 2] = [0.4, 5.0];

/// Usual range of T′ = T V/L: KVLCC2 1.3 to 8.3, Esso Osaka 0.4 to 1.4, the Mariner 1.1 to 2.8.
pub const USUAL_T_PRIME: [f64; 2] = [0.3, 12.0];

/// Usual range of K′/T′, which varies less with the rudder angle: KVLCC2 0.42 to 0.67, Esso Osaka 0.85 to 1.9, the
/// Mariner 0.7 to 0.9.
pub const USUAL_K_OVER_T_PRIME: [f64; 2] = [0.25, 2.0];

/// Usual range of the rudder rate of ships, deg/s; SOLAS II-1/29 requires 65° in 28 s, 2.3 deg/s.
const SHIP_RUDDER_RATE_DEG_S: [f64; 2] = [2.0, 7.0];

/// Minimum length of a full-scale ship, m; a shorter ship is a model.
const MIN_SHIP_LENGTH_M: f64 = 30.0;

/// Range of the lengths of full-scale ships that are tested as models, m.
const MODELLED_LENGTHS_M: [f64; 2] = [100.0, 400.0];

/// Usual range of the rudder rate, deg/s, for a length, m: 2 to 7 for ships, multiplied by √(L_ship/L) for models
/// (Froude scaling).
pub fn usual_rudder_rate_deg_s(length: f64) -> [f64; 2] {
    let froude = |ship: f64| if length < MIN_SHIP_LENGTH_M { (ship / length).sqrt() } else { 1.0 };
    [0, 1].map(|end| SHIP_RUDDER_RATE_DEG_S[end] * froude(MODELLED_LENGTHS_M[end]))
}

/// Exponents of second and metre in a dimension; angles have none.
pub type Dimension = [i32; 2];

impl Particulars {
    /// Ship-length time L/V, s.
    pub fn ship_length_time(self) -> f64 {
        self.length / self.speed
    }

    /// Factor (V/L)^a L^(−b) that makes a quantity of dimension s^a m^b nondimensional: K' = K L/V, T' = T V/L,
    /// r' = r L/V, u' = u/V.
    ///
    /// Not finite if length or speed is zero.
    pub fn prime_factor(self, [seconds, metres]: Dimension) -> f64 {
        self.ship_length_time().powi(-seconds) * self.length.powi(-metres)
    }

    /// Factor on a quantity from this ship to a geometrically similar ship, at equal prime value.
    pub fn similarity_factor_to(self, other: Self, dimension: Dimension) -> f64 {
        self.prime_factor(dimension) / other.prime_factor(dimension)
    }
}

/// Superscripts of the exponents from 2 to 9.
const POWERS: [char; 8] = ['²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'];

/// Dimension of a unit such as "rad s²/m²".
pub fn unit_dimension(unit: &str) -> Dimension {
    let mut exponents = [0; 2];
    let (above, below) = unit.split_once('/').unwrap_or((unit, ""));
    for (part, sign) in [(above, 1), (below, -1)] {
        for symbol in part.split(' ') {
            let base = symbol.trim_end_matches(POWERS);
            let power = symbol.chars().next_back().and_then(|last| POWERS.iter().position(|power| *power == last));
            let power = power.map_or(1, |place| place as i32 + 2);
            match base {
                "s" => exponents[0] += sign * power,
                "m" => exponents[1] += sign * power,
                _ => {}
            }
        }
    }
    exponents
}

/// Unit of a dimension, without angles: "s²/m".
pub fn dimension_unit(dimension: Dimension) -> String {
    let part = |sign: i32| {
        let symbols = ["s", "m"].into_iter().zip(dimension).filter(|(_, power)| power * sign > 0);
        let symbols = symbols.map(|(base, power)| match power.unsigned_abs() as usize {
            1 => base.to_owned(),
            power => format!("{base}{}", POWERS.get(power - 2).unwrap_or(&'?')),
        });
        symbols.collect::<Vec<_>>().join(" ")
    };
    fraction(part(1), part(-1))
}

/// Unit from its numerator and denominator.
fn fraction(above: String, below: String) -> String {
    let above = if above.is_empty() { String::from("1") } else { above };
    if below.is_empty() { above } else { format!("{above}/{below}") }
}

/// Unit of a prime value, without seconds and metres: "1/rad²" from "s/rad²", "1" from "1/s".
pub fn prime_unit(unit: &str) -> String {
    let angles = |part: &str| {
        let kept = part.split(' ').filter(|symbol| !matches!(symbol.trim_end_matches(POWERS), "s" | "m" | "1"));
        kept.collect::<Vec<&str>>().join(" ")
    };
    let (above, below) = unit.split_once('/').unwrap_or((unit, ""));
    fraction(angles(above), angles(below))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_unit_has_its_dimension_again() {
        for (dimension, expected) in
            [([2, -1], "s²/m"), ([0, 0], "1"), ([-1, 0], "1/s"), ([3, 1], "s³ m"), ([-2, -3], "1/s² m³")]
        {
            assert_eq!(dimension_unit(dimension), expected);
            assert_eq!(super::unit_dimension(expected), dimension);
        }
    }

    #[test]
    fn units_are_read() {
        assert_eq!(unit_dimension("rad s²/m²"), [2, -2]);
        assert_eq!(unit_dimension("1/s²"), [-2, 0]);
        assert_eq!(unit_dimension("s/rad²"), [1, 0]);
        assert_eq!(unit_dimension("rad s/m"), [1, -1]);
        assert_eq!(unit_dimension("1"), [0, 0]);
        let prime = ["rad s²/m²", "1/s²", "s/rad²", "1/rad", "rad/s", "1", "s"].map(prime_unit);
        assert_eq!(prime, ["rad", "1", "1/rad²", "1/rad", "rad", "1", "1"]);
    }

    /// YUKUN, K = 0.1 1/s and T = 16.3 s, L = 105 m at 8.59 m/s: K' = 1.22, T' = 1.33.
    #[test]
    fn indices_lose_their_dimension() {
        let yukun = Particulars { length: 105.0, speed: 8.59 };
        assert!((0.1 * yukun.prime_factor(unit_dimension("1/s")) - 1.222).abs() < 1e-3);
        assert!((16.3 * yukun.prime_factor(unit_dimension("s")) - 1.3335).abs() < 1e-3);
        let model = Particulars { length: 4.2, speed: 8.59 / 5.0 };
        // Froude scaling: a ship of one twenty-fifth of the length is five times as fast in time.
        assert!((yukun.similarity_factor_to(model, unit_dimension("s")) - 0.2).abs() < 1e-12);
        assert!((yukun.similarity_factor_to(model, unit_dimension("m")) - 0.04).abs() < 1e-12);
    }
}
