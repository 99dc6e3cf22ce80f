//! What is known of a ship: the structures that records cannot tell apart with their parameters and covariances, the
//! noise, the steering gear, and the range in which the ship was seen. This is what `fit.json` and `trace.json` hold.

use std::sync::Arc;

use serde::{Deserialize, Serialize};
use ship::effects::{self, Effect, Parameter, SteeringLag};
use ship::vessel::prime::is_of_wind;
use ship::{Particulars, ResponseModel};

use crate::error::IdentifiedShipError;
use crate::noise::{HeadingNoise, RandomMoment};
use crate::stored_hull::StoredHull;

/// An effect as it is written down.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct StoredEffect {
    /// Identifier.
    pub id: String,
    /// Form.
    pub form: String,
    /// Constants that are not fitted: an approach speed, m/s, or a rate of the propeller, 1/s.
    #[serde(default)]
    pub constants: Vec<f64>,
}

/// One structure with its parameters.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct WeightedStructure {
    /// Probability among the structures of its file.
    pub weight: f64,
    /// Effects in the order in which the rudder passes through them.
    pub effects: Vec<StoredEffect>,
    /// 1/T (1/s), K/T (1/s²), δ_r (rad) and the parameters of the effects, in the units these declare.
    pub parameters: Vec<f64>,
    /// Places among the parameters of those that were fitted.
    pub fitted: Vec<usize>,
    /// Covariance of the fitted ones, by rows; empty where the records do not tell them apart.
    pub covariance: Vec<Vec<f64>>,
    /// Degrees of freedom of the covariance; none for a normal law.
    pub degrees_of_freedom: Option<f64>,
}

/// The steering gear as records show it.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct KnownGear {
    /// Rate of the rudder, rad/s.
    pub rate_rad_s: f64,
    /// Standard deviation of the rate, rad/s.
    pub sd_rad_s: f64,
}

/// The range in which the ship was seen; outside, a prediction is extrapolation.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct ValidityRange {
    /// Largest rudder angle, rad.
    pub rudder_rad: f64,
    /// Largest yaw rate, rad/s.
    pub yaw_rate_rad_s: f64,
}

/// What is known of a ship.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct IdentifiedShip {
    /// The structures, the most probable first.
    pub members: Vec<WeightedStructure>,
    /// Noise of the records.
    pub noise: HeadingNoise,
    /// Steering gear; none where the records do not show it: the rudder then jumps.
    pub gear: Option<KnownGear>,
    /// Root mean square of the yaw rate at the end of straight approaches, rad/s; 0 where no record shows one.
    pub approach_yaw_rate_rad_s: f64,
    /// Where the ship was seen.
    pub seen: ValidityRange,
    /// Length between perpendiculars, m.
    pub length_m: Option<f64>,
    /// Approach speed, m/s.
    pub speed_m_s: Option<f64>,
    /// Hulls of three degrees of freedom that the records speak for, the nearest first; predictions are then made with
    /// them and not with the structures.
    #[serde(default)]
    pub hulls: Vec<StoredHull>,
}

impl WeightedStructure {
    /// The model; fails for an effect that is not known and for numbers that do not fit it.
    pub fn model(&self) -> Result<ResponseModel, IdentifiedShipError> {
        let effect = |written: &StoredEffect| -> Result<Arc<dyn Effect>, IdentifiedShipError> {
            effects::named(&written.id, &written.form, &written.constants)
                .ok_or_else(|| IdentifiedShipError::Effect { id: written.id.clone(), form: written.form.clone() })
        };
        let model = ResponseModel::new(self.effects.iter().map(effect).collect::<Result<_, _>>()?);
        let (expected, found) = (model.parameter_count(), self.parameters.len());
        if expected != found {
            return Err(IdentifiedShipError::Count { what: "parameters", expected, found });
        }
        for (parameter, value) in model.parameters().zip(&self.parameters) {
            if !value.is_finite() {
                return Err(IdentifiedShipError::Value { key: parameter.key, value: *value });
            }
        }
        let count = self.fitted.len();
        let wrong = |what, expected, found| Err(IdentifiedShipError::Count { what, expected, found });
        if !self.covariance.is_empty() && self.covariance.len() != count {
            return wrong("rows of the covariance", count, self.covariance.len());
        }
        if let Some(row) = self.covariance.iter().find(|row| row.len() != count) {
            return wrong("columns of the covariance", count, row.len());
        }
        if let Some(place) = self.fitted.iter().find(|place| **place >= expected) {
            return wrong("the parameters `fitted` counts", expected, place + 1);
        }
        Ok(model)
    }

    /// Places among the parameters of the dead times of its effects.
    pub fn dead_times(&self, model: &ResponseModel) -> Vec<usize> {
        let named = (SteeringLag::DeadTime.id(), SteeringLag::DeadTime.form());
        let dead_times = model.placed().filter(|(effect, _)| (effect.id(), effect.form()) == named);
        dead_times.map(|(_, own)| own.start).collect()
    }
}

/// Difference of two lengths, as a share, below which they are of one ship.
const SAME_LENGTH: f64 = 1e-3;

/// Whether two lengths, m, are of one ship, as far as lengths tell.
pub fn is_same_length(one: f64, other: f64) -> bool {
    (one / other - 1.0).abs() < SAME_LENGTH
}

impl IdentifiedShip {
    /// Length and speed, where both are known.
    pub fn particulars(&self) -> Option<Particulars> {
        Some(Particulars { length: self.length_m?, speed: self.speed_m_s? })
    }

    /// The same ship at another length and approach speed: every time grows by (L₂/U₂)/(L₁/U₁), every length by L₂/L₁,
    /// and what has no dimension stays (K′, T′ and all others). With U ~ √L this is the scaling of Froude (1868).
    ///
    /// Noise scales as the ship does: the weather of a model basin is that of a sea as many times larger. Fails where
    /// length or speed of the known ship are not known.
    pub fn scaled_to(&self, length: f64, speed: Option<f64>) -> Result<Self, IdentifiedShipError> {
        let own = self.particulars().ok_or(IdentifiedShipError::NoParticulars)?;
        let metre = length / own.length;
        let speed = speed.unwrap_or(own.speed * metre.sqrt());
        let second = metre * own.speed / speed;
        let factor = |[seconds, metres]: [i32; 2]| second.powi(seconds) * metre.powi(metres);
        let mut scaled = self.clone();
        for member in &mut scaled.members {
            let model = member.model()?;
            if let Some(own) = model.effects().iter().find(|own| own.parameters().iter().any(Parameter::has_no_unit)) {
                return Err(IdentifiedShipError::NoUnit(own.id()));
            }
            let factors: Vec<f64> = model.parameters().map(|parameter| factor(parameter.dimension())).collect();
            for (value, factor) in member.parameters.iter_mut().zip(&factors) {
                *value *= factor;
            }
            for (row, place) in member.covariance.iter_mut().zip(&member.fitted) {
                for (entry, other) in row.iter_mut().zip(&member.fitted) {
                    *entry *= factors[*place] * factors[*other];
                }
            }
            for (effect, written) in model.effects().iter().zip(&mut member.effects) {
                let scaled = effect.constants().into_iter().map(|(constant, dimension)| constant * factor(dimension));
                written.constants = scaled.collect();
            }
        }
        scaled.noise.moment = self.noise.moment.scaled(second);
        if let Some(gear) = &mut scaled.gear {
            *gear = KnownGear { rate_rad_s: gear.rate_rad_s / second, sd_rad_s: gear.sd_rad_s / second };
        }
        scaled.approach_yaw_rate_rad_s /= second;
        scaled.seen.yaw_rate_rad_s /= second;
        scaled.hulls = self.hulls.iter().map(|hull| hull.scaled_to(length, speed)).collect();
        scaled.length_m = Some(length);
        scaled.speed_m_s = Some(speed);
        Ok(scaled)
    }

    /// The same ship in a calm: without a random moment, and without what steady wind does.
    pub fn in_calm(&self) -> Result<Self, IdentifiedShipError> {
        let mut calm = self.clone();
        calm.noise.moment = RandomMoment::None;
        for hull in &mut calm.hulls {
            (hull.moment.deviation_rudder_rad, hull.beginning_yaw_rate_rad_s) = (0.0, 0.0);
            if let Some(place) = hull.coefficients.iter().position(|own| is_of_wind(&own.key)) {
                hull.coefficients[place].value = 0.0;
                hull.covariance.iter_mut().for_each(|row| row[place] = 0.0);
                hull.covariance[place].fill(0.0);
            }
        }
        for member in &mut calm.members {
            let model = member.model()?;
            for (effect, own) in model.placed().filter(|(effect, _)| effect.sees_heading()) {
                for (place, parameter) in own.clone().zip(effect.parameters()) {
                    member.parameters[place] = parameter.neutral;
                }
                let kept: Vec<bool> = member.fitted.iter().map(|place| !own.contains(place)).collect();
                let mut row = kept.iter();
                member.covariance.retain(|_| *row.next().unwrap_or(&true));
                for covariance in &mut member.covariance {
                    let mut column = kept.iter();
                    covariance.retain(|_| *column.next().unwrap_or(&true));
                }
                member.fitted.retain(|place| !own.contains(place));
            }
        }
        Ok(calm)
    }

    /// How much later than it acted the rudder was logged, s: a negative dead time of the most probable structure.
    pub fn rudder_logged_late(&self) -> Option<f64> {
        let likeliest = self.members.iter().max_by(|one, other| one.weight.total_cmp(&other.weight))?;
        let places = likeliest.dead_times(&likeliest.model().ok()?);
        let late = -places.iter().map(|place| likeliest.parameters[*place]).sum::<f64>();
        (late > 0.0).then_some(late)
    }

    /// A time of the ship, s: L/U where they are known, else (K/T)^(−1/2) of the most probable structure, which is
    /// about that.
    pub fn timescale(&self) -> Option<f64> {
        if let Some(own) = self.particulars() {
            return Some(own.time());
        }
        let gain = *self.members.first()?.parameters.get(1)?;
        (gain > 0.0).then(|| gain.sqrt().recip())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ship() -> IdentifiedShip {
        let effect = StoredEffect { id: "nonlinear_damping".into(), form: "r³".into(), constants: Vec::new() };
        let member = WeightedStructure {
            weight: 1.0,
            effects: vec![effect],
            parameters: vec![1.0 / 16.3, 0.1 / 16.3, 0.0, 60.0],
            fitted: vec![0, 1, 2, 3],
            covariance: vec![vec![0.0; 4]; 4],
            degrees_of_freedom: None,
        };
        IdentifiedShip {
            members: vec![member],
            length_m: Some(75.0),
            speed_m_s: Some(6.0),
            ..IdentifiedShip::default()
        }
    }

    /// There and back is where one was, and K′ = K L/U does not change on the way.
    #[test]
    fn another_scale_keeps_what_has_no_dimension() {
        let known = ship();
        let ship = known.scaled_to(25.0 * known.length_m.expect("made up"), None).expect("particulars");
        let prime = |known: &IdentifiedShip| {
            let [a, b] = [known.members[0].parameters[0], known.members[0].parameters[1]];
            b / a * known.length_m.expect("known") / known.speed_m_s.expect("known")
        };
        assert!((prime(&ship) - prime(&known)).abs() < 1e-12);
        let back = ship.scaled_to(known.length_m.expect("made up"), known.speed_m_s).expect("particulars");
        for (one, other) in back.members[0].parameters.iter().zip(&known.members[0].parameters) {
            assert!((one - other).abs() <= 1e-12 * other.abs());
        }
        let unknown = IdentifiedShip { length_m: None, ..known };
        assert!(unknown.scaled_to(100.0, None).is_err());
    }

    #[test]
    fn numbers_that_do_not_fit_are_refused() {
        let refused = |change: fn(&mut WeightedStructure)| {
            let mut member = ship().members.remove(0);
            change(&mut member);
            member.model().expect_err("refused").to_string()
        };
        assert!(refused(|member| member.effects[0].id = "magic".into()).contains("magic"));
        assert!(refused(|member| member.parameters.push(1.0)).contains("parameters"));
        assert!(refused(|member| member.parameters[0] = f64::NAN).contains("inverse_T"));
        assert!(refused(|member| member.covariance.truncate(1)).contains("rows"));
        assert!(refused(|member| member.fitted[0] = 9).contains("fitted"));
    }
}
