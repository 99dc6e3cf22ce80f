//! Particulars of two ships beside each other: whether one is the other, at another scale or in another condition, and
//! what one says of the other.

use super::particulars::{HullParticulars, PARTICULARS};

/// Share by which numbers of one ship differ for the rounding of their sources.
const ROUNDING: f64 = 0.02;

/// Difference of x_G that is one of loading, in L.
const SHIFTED: f64 = 0.005;

/// Powers of the length that a particular grows with at the same Froude number.
fn power_of_length(key: &str) -> f64 {
    match key {
        "block-coefficient" => 0.0,
        "speed-m-s" => 0.5,
        "propeller-rps" => -0.5,
        "rudder-area-m2" => 2.0,
        "displacement-t" => 3.0,
        _ => 1.0,
    }
}

/// Whether a particular says something of the hull, and not of its size or of one trial.
fn is_of_hull(key: &str) -> bool {
    !matches!(key, "length-m" | "speed-m-s" | "propeller-rps" | "displacement-t")
}

impl HullParticulars {
    /// Whether two lengths are one, but for rounding.
    pub fn has_length_of(&self, other: &Self) -> bool {
        (self.length / other.length - 1.0).abs() <= ROUNDING
    }

    /// Froude number U/√(g L).
    pub fn froude_number(&self) -> f64 {
        self.speed / (super::particulars::GRAVITY * self.length).sqrt()
    }

    /// Keys of what is given of both and differs once both have one length: by more than 2 %, of x_G by more than
    /// 0.005 L.
    pub fn differing(&self, other: &Self) -> Vec<&'static str> {
        let ratio = self.length / other.length;
        let differs = |own: &&super::Particular| {
            let values = own.get(self).zip(own.get(other));
            values.is_some_and(|(one, other)| {
                let other = other * ratio.powf(power_of_length(own.key));
                match own.key {
                    "x-g-m" => (one - other).abs() > SHIFTED * self.length,
                    _ => (one / other - 1.0).abs() > ROUNDING,
                }
            })
        };
        PARTICULARS.iter().filter(|own| is_of_hull(own.key)).filter(differs).map(|own| own.key).collect()
    }

    /// The same ship with what is missing from another, at her own length. Nothing that stands already changes. Mass
    /// and revolutions are of the water and of the trial; they are not taken over.
    #[must_use]
    pub fn filled_from(&self, other: &Self) -> Self {
        let ratio = self.length / other.length;
        let mut filled = *self;
        for own in PARTICULARS.iter().filter(|own| is_of_hull(own.key)) {
            if let (None, Some(value)) = (own.get(self), own.get(other)) {
                own.set(&mut filled, value * ratio.powf(power_of_length(own.key)));
            }
        }
        filled
    }
}

#[cfg(test)]
mod tests {
    use super::super::tests::KVLCC2;
    use super::*;

    /// KVLCC2 and her model of 7 m: 1.27 m, 0.455 m, 0.0539 m² (SIMMAN 2008).
    #[test]
    fn a_model_has_the_particulars_of_her_ship() {
        let bare = HullParticulars { length: 7.0, speed: 1.18, ..HullParticulars::default() };
        let model = bare.filled_from(&KVLCC2);
        let near = |one: Option<f64>, other: f64| (one.expect("filled") / other - 1.0).abs() < 0.005;
        assert!(near(model.beam, 1.27) && near(model.draught, 0.455) && near(model.rudder_area, 0.0539), "{model:?}");
        assert_eq!((model.block_coefficient, model.propeller_rate, model.length), (Some(0.81), None, 7.0));
        assert!(model.differing(&KVLCC2).is_empty() && bare.differing(&KVLCC2).is_empty());
        assert!(!model.has_length_of(&KVLCC2) && (model.froude_number() / KVLCC2.froude_number() - 1.0).abs() < 0.01);
    }

    #[test]
    fn another_loading_differs() {
        let ballast = HullParticulars { draught: Some(12.0), x_g: Some(5.0), ..KVLCC2 };
        assert_eq!(ballast.differing(&KVLCC2), ["draught-m", "x-g-m"]);
        assert_eq!(ballast.filled_from(&KVLCC2).draught, Some(12.0));
        assert!(HullParticulars { draught: Some(20.7), ..KVLCC2 }.differing(&KVLCC2).is_empty(), "rounding");
    }
}
