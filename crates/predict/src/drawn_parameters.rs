//! Structure and parameters of a drawn ship, for other programs.

use crate::mixture::{DrawnShip, ShipMixture, UncertaintySource};

/// Structure and parameters of a drawn ship; SI units and radians.
#[derive(Debug, Clone, PartialEq)]
pub struct DrawnParameters {
    /// Place of its file among those of the mixture.
    pub file: usize,
    /// Form of its hull, or the effects of its response, joined by ` + `; `first_order` for none.
    pub structure: String,
    /// Probability of this structure or hull among all of the mixture.
    pub weight: f64,
    /// Rate of the rudder, rad/s; `None` where the rudder moves at once.
    pub gear_rate_rad_s: Option<f64>,
    /// Initial yaw rate, rad/s.
    pub yaw_rate_rad_s: f64,
    /// Parameters by name: `K_over_T` and `EFFECT.KEY` of a response, `FORM.KEY` of a hull, which replaces the
    /// response.
    pub parameters: Vec<(String, f64)>,
}

impl ShipMixture {
    /// Structure and parameters of ship `number`, drawn from all sources of uncertainty as for the prediction of
    /// manoeuvres.
    pub fn parameters(&self, number: u64) -> DrawnParameters {
        let part = self.chosen(number);
        let DrawnShip { response, coefficients, gear, yaw_rate, .. } = self.draw(number, &UncertaintySource::ALL);
        let model = response.model();
        let base = ship::response::BASE.iter().map(|parameter| parameter.key.to_owned());
        let effect_keys = model.effects().iter().flat_map(|effect| {
            effect.parameters().iter().map(move |parameter| format!("{}.{}", effect.id(), parameter.key))
        });
        let effects: Vec<&str> = model.effects().iter().map(|effect| effect.id()).collect();
        let (structure, parameters) = match &part.hull {
            Some(hull) => {
                let form = hull.stored.form.clone();
                let keys = hull.stored.coefficients.iter().map(|coefficient| format!("{form}.{}", coefficient.key));
                let parameters = keys.zip(coefficients).collect();
                (form, parameters)
            }
            None => {
                let parameters = base.chain(effect_keys).zip(response.parameters().iter().copied()).collect();
                let structure = if effects.is_empty() { "first_order".to_owned() } else { effects.join(" + ") };
                (structure, parameters)
            }
        };
        let (file, weight) = (part.file, part.weight);
        DrawnParameters { file, structure, weight, gear_rate_rad_s: gear.rate, yaw_rate_rad_s: yaw_rate, parameters }
    }
}

#[cfg(test)]
mod tests {
    use document::IdentifiedShip;

    use super::*;
    use crate::testing;

    /// Structure, parameters and weight are those that the ship is steered with.
    #[test]
    fn a_drawn_ship_is_reported_as_it_is_steered() {
        let mixture = testing::mixture(testing::identified_ship());
        let (drawn, ship) = (mixture.parameters(7), mixture.draw(7, &UncertaintySource::ALL));
        let keys = drawn.parameters.iter().map(|(key, _)| key.as_str()).collect::<Vec<_>>();
        assert_eq!(keys[..3], ["inverse_T", "K_over_T", "rudder_bias"]);
        assert!(keys.len() == 4 && keys[3].starts_with("nonlinear_damping."), "{keys:?}");
        let values: Vec<f64> = drawn.parameters.iter().map(|(_, value)| *value).collect();
        assert_eq!(values, ship.response.parameters());
        assert_eq!((drawn.gear_rate_rad_s, drawn.yaw_rate_rad_s), (ship.gear.rate, ship.yaw_rate));
        assert_eq!((drawn.structure.as_str(), drawn.weight), ("nonlinear_damping", 1.0));

        let hulls = ["quadratic", "mmg"].map(testing::hull).to_vec();
        let mixture = testing::mixture(IdentifiedShip { hulls, ..testing::identified_ship() });
        let mmg = (0..20).map(|number| mixture.parameters(number)).find(|drawn| drawn.structure == "mmg");
        let drawn = mmg.expect("half of them");
        assert!(drawn.parameters.iter().all(|(key, _)| key.starts_with("mmg.")) && drawn.weight == 0.5, "{drawn:?}");
    }
}
