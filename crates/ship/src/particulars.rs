//! Length and speed of a ship, and what they make of a quantity that has a dimension.

/// Length and speed, the two numbers every nondimensional index needs.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Particulars {
    /// Length between perpendiculars L, m.
    pub length: f64,
    /// Approach speed V, m/s.
    pub speed: f64,
}

/// Exponents of second and metre in a dimension; angles have none.
pub type Dimension = [i32; 2];

impl Particulars {
    /// The time in which the ship sails its own length, L/V, s.
    pub fn time(self) -> f64 {
        self.length / self.speed
    }

    /// What a quantity of a dimension s^a m^b is multiplied with to have none: (V/L)^a L^(−b). So K' = K L/V,
    /// T' = T V/L, r' = r L/V, u' = u/V.
    ///
    /// Not finite where length or speed are zero. Source: ITTC Dictionary of Hydrodynamics, prime system.
    pub fn prime(self, [seconds, metres]: Dimension) -> f64 {
        self.time().powi(-seconds) * self.length.powi(-metres)
    }

    /// What a quantity of a dimension is multiplied with when a ship of these particulars becomes a similar one of
    /// others: its prime value stays.
    pub fn factor_to(self, other: Self, dimension: Dimension) -> f64 {
        self.prime(dimension) / other.prime(dimension)
    }
}

/// The dimension of a unit such as "rad s²/m²".
pub fn dimension(unit: &str) -> Dimension {
    let mut exponents = [0; 2];
    let (above, below) = unit.split_once('/').unwrap_or((unit, ""));
    for (part, sign) in [(above, 1), (below, -1)] {
        for symbol in part.split(' ') {
            let (base, power) = symbol.strip_suffix('²').map_or((symbol, 1), |base| (base, 2));
            match base {
                "s" => exponents[0] += sign * power,
                "m" => exponents[1] += sign * power,
                _ => {}
            }
        }
    }
    exponents
}

/// The unit of a prime value: what is left of a unit without seconds and metres, "1/rad²" of "s/rad²", "1" of "1/s".
pub fn prime_unit(unit: &str) -> String {
    let angles = |part: &str| {
        let kept = part.split(' ').filter(|symbol| !matches!(symbol.trim_end_matches('²'), "s" | "m" | "1"));
        kept.collect::<Vec<&str>>().join(" ")
    };
    let (above, below) = unit.split_once('/').unwrap_or((unit, ""));
    match (angles(above), angles(below)) {
        (above, below) if below.is_empty() && above.is_empty() => String::from("1"),
        (above, below) if below.is_empty() => above,
        (above, below) if above.is_empty() => format!("1/{below}"),
        (above, below) => format!("{above}/{below}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn units_are_read() {
        assert_eq!(dimension("rad s²/m²"), [2, -2]);
        assert_eq!(dimension("1/s²"), [-2, 0]);
        assert_eq!(dimension("s/rad²"), [1, 0]);
        assert_eq!(dimension("rad s/m"), [1, -1]);
        assert_eq!(dimension("1"), [0, 0]);
        let prime = ["rad s²/m²", "1/s²", "s/rad²", "1/rad", "rad/s", "1", "s"].map(prime_unit);
        assert_eq!(prime, ["rad", "1", "1/rad²", "1/rad", "rad", "1", "1"]);
    }

    /// YUKUN, K = 0.1 1/s and T = 16.3 s, L = 105 m at 8.59 m/s: K' = 1.22, T' = 1.33.
    #[test]
    fn indices_lose_their_dimension() {
        let yukun = Particulars { length: 105.0, speed: 8.59 };
        assert!((0.1 * yukun.prime(dimension("1/s")) - 1.222).abs() < 1e-3);
        assert!((16.3 * yukun.prime(dimension("s")) - 1.3335).abs() < 1e-3);
        let model = Particulars { length: 4.2, speed: 8.59 / 5.0 };
        // Froude: a twenty-fifth of the length is five times as quick.
        assert!((yukun.factor_to(model, dimension("s")) - 0.2).abs() < 1e-12);
        assert!((yukun.factor_to(model, dimension("m")) - 0.04).abs() < 1e-12);
    }
}
