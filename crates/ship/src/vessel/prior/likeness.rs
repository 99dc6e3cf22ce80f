//! Comparison of the particulars of two ships: test for another scale or loading of one ship, and transfer of missing
//! particulars.

use super::particulars::{HullParticulars, PARTICULARS};

/// Relative tolerance for rounding in the sources.
const ROUNDING_TOLERANCE: f64 = 0.02;

/// Difference of x_G, in L, that indicates another loading.
const LOADING_SHIFT: f64 = 0.005;

/// Exponent of the length by which a particular scales at equal Froude number.
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

/// `true` if a particular describes the form of the hull, not its size or one trial.
fn is_of_hull(key: &str) -> bool {
    !matches!(key, "length-m" | "speed-m-s" | "propeller-rps" | "displacement-t")
}

impl HullParticulars {
    /// `true` if both lengths are equal to within 2 %, for rounding in the sources.
    pub fn has_equal_length(&self, other: &Self) -> bool {
        (self.length / other.length - 1.0).abs() <= ROUNDING_TOLERANCE
    }

    /// Froude number U/√(g L).
    pub fn froude_number(&self) -> f64 {
        self.speed / (super::particulars::GRAVITY * self.length).sqrt()
    }

    /// Keys of particulars that are given for both ships and differ at equal length: by more than 2 %, x_G by more than
    /// 0.005 L.
    pub fn differing_keys(&self, other: &Self) -> Vec<&'static str> {
        let ratio = self.length / other.length;
        let differs = |particular: &&super::Particular| {
            let values = particular.get(self).zip(particular.get(other));
            values.is_some_and(|(value, other)| {
                let scaled = other * ratio.powf(power_of_length(particular.key));
                match particular.key {
                    "x-g-m" => (value - scaled).abs() > LOADING_SHIFT * self.length,
                    _ => (value / scaled - 1.0).abs() > ROUNDING_TOLERANCE,
                }
            })
        };
        PARTICULARS.iter().filter(|p| is_of_hull(p.key)).filter(differs).map(|p| p.key).collect()
    }

    /// Particulars with missing values taken from another ship, scaled to the length of this ship; given values are
    /// kept. Mass and revolutions depend on the water and the trial and are not transferred.
    #[must_use]
    pub fn with_missing_from(&self, other: &Self) -> Self {
        let ratio = self.length / other.length;
        let mut filled = *self;
        for particular in PARTICULARS.iter().filter(|p| is_of_hull(p.key)) {
            if let (None, Some(value)) = (particular.get(self), particular.get(other)) {
                particular.set(&mut filled, value * ratio.powf(power_of_length(particular.key)));
            }
        }
        filled
    }
}

#[cfg(test)]
mod tests {
    use super::super::tests::KVLCC2;
    use super::*;

    /// KVLCC2 and its 7 m model: 1.27 m, 0.455 m, 0.0539 m² (SIMMAN 2008).
    #[test]
    fn a_model_has_the_particulars_of_her_ship() {
        let bare = HullParticulars { length: 7.0, speed: 1.18, ..HullParticulars::default() };
        let model = bare.with_missing_from(&KVLCC2);
        let near = |value: Option<f64>, expected: f64| (value.expect("filled") / expected - 1.0).abs() < 0.005;
        assert!(near(model.beam, 1.27) && near(model.draught, 0.455) && near(model.rudder_area, 0.0539), "{model:?}");
        assert_eq!((model.block_coefficient, model.propeller_rate, model.length), (Some(0.81), None, 7.0));
        assert!(model.differing_keys(&KVLCC2).is_empty() && bare.differing_keys(&KVLCC2).is_empty());
        assert!(
            !model.has_equal_length(&KVLCC2) && (model.froude_number() / KVLCC2.froude_number() - 1.0).abs() < 0.01
        );
    }

    #[test]
    fn another_loading_differs() {
        let ballast = HullParticulars { draught: Some(12.0), x_g: Some(5.0), ..KVLCC2 };
        assert_eq!(ballast.differing_keys(&KVLCC2), ["draught-m", "x-g-m"]);
        assert_eq!(ballast.with_missing_from(&KVLCC2).draught, Some(12.0));
        assert!(HullParticulars { draught: Some(20.7), ..KVLCC2 }.differing_keys(&KVLCC2).is_empty(), "rounding");
    }
}
