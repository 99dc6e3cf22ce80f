//! Structure and parameters of a drawn ship or estimate, for other programs.

use document::IdentifiedShip;
use ship::ResponseModel;
use simulate::{RngPurpose, StreamKey};

use crate::error::PredictError;
use crate::mixture::{
    DrawnShip, GOLDEN_STEP, ShipMixture, StructureSampler, UncertaintySource, structure_at_probability,
};

/// Structure and parameters of a drawn ship; SI units and radians.
#[derive(Debug, Clone, PartialEq)]
pub struct DrawnParameters {
    /// Index of the file in the mixture.
    pub file_index: usize,
    /// Form of the hull, or the effects of the response, joined by ` + `; `first_order` for a response without effects.
    pub structure: String,
    /// Probability of this structure or hull in the mixture.
    pub weight: f64,
    /// Rate of the rudder, rad/s; `None` for an instantaneous rudder.
    pub gear_rate_rad_s: Option<f64>,
    /// Initial yaw rate, rad/s.
    pub yaw_rate_rad_s: f64,
    /// Parameters by name: `inverse_T`, `K_over_T`, `rudder_bias` and `EFFECT.KEY` of a response, or `FORM.KEY` of a
    /// hull, which replaces the response.
    pub parameters: Vec<(String, f64)>,
}

impl ShipMixture {
    /// Structure and parameters of ship `number`, drawn from all sources of uncertainty as for the prediction of
    /// manoeuvres.
    pub fn draw_parameters(&self, number: u64) -> DrawnParameters {
        let part = self.drawn_structure(number);
        let DrawnShip { response, hull_coefficients: coefficients, gear, initial_yaw_rate: yaw_rate, .. } =
            self.draw_ship(number, &UncertaintySource::ALL);
        let (structure, parameters) = match &part.hull {
            Some(hull) => {
                let form = hull.stored.form.clone();
                let keys = hull.stored.coefficients.iter().map(|coefficient| format!("{form}.{}", coefficient.key));
                let parameters = keys.zip(coefficients).collect();
                (form, parameters)
            }
            None => named(response.model(), response.parameters()),
        };
        let (file, weight) = (part.file_index, part.weight);
        DrawnParameters {
            file_index: file,
            structure,
            weight,
            gear_rate_rad_s: gear.rudder_rate,
            yaw_rate_rad_s: yaw_rate,
            parameters,
        }
    }
}

/// Name of a structure, and its parameters by name.
fn named(model: &ResponseModel, values: &[f64]) -> (String, Vec<(String, f64)>) {
    let base = ship::response::BASE_PARAMETERS.iter().map(|parameter| parameter.key.to_owned());
    let of_effects = model.effects().iter().flat_map(|effect| {
        effect.parameters().iter().map(move |parameter| format!("{}.{}", effect.id(), parameter.key))
    });
    let effects: Vec<&str> = model.effects().iter().map(|effect| effect.id()).collect();
    let structure = if effects.is_empty() { "first_order".to_owned() } else { effects.join(" + ") };
    (structure, base.chain(of_effects).zip(values.iter().copied()).collect())
}

/// Structure and parameters of a response, drawn from the law of an estimate; SI units and radians.
#[derive(Debug, Clone, PartialEq)]
pub struct DrawnEstimate {
    /// Effects of the response, joined by ` + `; `first_order` for a response without effects.
    pub structure: String,
    /// Probability of this structure.
    pub weight: f64,
    /// Parameters by name: `inverse_T`, `K_over_T`, `rudder_bias`, `EFFECT.KEY`.
    pub parameters: Vec<(String, f64)>,
}

/// Sampler of an estimate: a structure by its probability, the parameters by their covariance. A draw is a response,
/// not a ship: it has no hull, no steering gear and no random moment.
#[derive(Debug, Clone)]
pub struct EstimateSampler {
    structures: Vec<StructureSampler>,
    seed: u64,
}

impl EstimateSampler {
    /// Sampler of an estimate with this seed; fails if the estimate is not valid.
    pub fn new(estimate: &IdentifiedShip, seed: u64) -> Result<Self, PredictError> {
        let total: f64 = estimate.members.iter().map(|member| member.weight).sum();
        let structures = estimate.members.iter().map(|member| StructureSampler::new(member, member.weight / total, 0));
        let structures = structures.collect::<Result<Vec<_>, _>>()?;
        if structures.is_empty() { Err(PredictError::Empty) } else { Ok(Self { structures, seed }) }
    }

    /// Draw number `number`, which depends on the seed and the number alone.
    pub fn sample(&self, number: u64) -> DrawnEstimate {
        let share = (0.5 + number as f64 * GOLDEN_STEP).fract();
        let structure = structure_at_probability(&self.structures, share).unwrap_or(&self.structures[0]);
        let mut rng = StreamKey { seed: self.seed, cell: 0, replicate: number }.rng(RngPurpose::Specification);
        let (name, parameters) = named(&structure.model, &structure.sample(&mut rng));
        DrawnEstimate { structure: name, weight: structure.weight, parameters }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing;

    /// Draws of a seed are repeatable and have the mean of the estimate.
    #[test]
    fn an_estimate_is_drawn_again_with_its_seed() {
        let estimate = testing::identified_ship();
        let draws = |seed: u64| -> Vec<DrawnEstimate> {
            let draws = EstimateSampler::new(&estimate, seed).expect("made up");
            (0..2000).map(|number| draws.sample(number)).collect()
        };
        let drawn = draws(7);
        assert_eq!(drawn, draws(7));
        assert_ne!(drawn, draws(8));
        let (place, count) = (estimate.members[0].fitted[0], drawn.len() as f64);
        let mean = drawn.iter().map(|draw| draw.parameters[place].1).sum::<f64>() / count;
        let sd = estimate.members[0].covariance[0][0].sqrt();
        assert!((mean - estimate.members[0].parameters[place]).abs() < 4.0 * sd / count.sqrt());
        assert!(drawn[0].structure == "nonlinear_damping" && drawn[0].weight == 1.0);
        let none = IdentifiedShip { members: Vec::new(), ..estimate };
        assert_eq!(EstimateSampler::new(&none, 0).err(), Some(PredictError::Empty));
    }

    /// Structure, parameters and weight agree with the steered ship.
    #[test]
    fn a_drawn_ship_is_reported_as_it_is_steered() {
        let mixture = testing::mixture(testing::identified_ship());
        let (drawn, ship) = (mixture.draw_parameters(7), mixture.draw_ship(7, &UncertaintySource::ALL));
        let keys = drawn.parameters.iter().map(|(key, _)| key.as_str()).collect::<Vec<_>>();
        assert_eq!(keys[..3], ["inverse_T", "K_over_T", "rudder_bias"]);
        assert!(keys.len() == 4 && keys[3].starts_with("nonlinear_damping."), "{keys:?}");
        let values: Vec<f64> = drawn.parameters.iter().map(|(_, value)| *value).collect();
        assert_eq!(values, ship.response.parameters());
        assert_eq!((drawn.gear_rate_rad_s, drawn.yaw_rate_rad_s), (ship.gear.rudder_rate, ship.initial_yaw_rate));
        assert_eq!((drawn.structure.as_str(), drawn.weight), ("nonlinear_damping", 1.0));

        let hulls = ["quadratic", "mmg"].map(testing::hull).to_vec();
        let mixture = testing::mixture(IdentifiedShip { hulls, ..testing::identified_ship() });
        let mmg = (0..20).map(|number| mixture.draw_parameters(number)).find(|drawn| drawn.structure == "mmg");
        let drawn = mmg.expect("half of them");
        assert!(drawn.parameters.iter().all(|(key, _)| key.starts_with("mmg.")) && drawn.weight == 0.5, "{drawn:?}");
    }
}
