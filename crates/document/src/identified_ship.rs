//! Identified ship, as in `fit.json` and `trace.json`: weighted structures with parameters and covariances, noise,
//! steering gear, and the range of validity.

use std::sync::Arc;

use serde::{Deserialize, Serialize};
use ship::effects::{self, Effect, Parameter, SteeringLag};
use ship::vessel::prime::is_wind_coefficient;
use ship::{Particulars, ResponseModel};

use crate::error::IdentifiedShipError;
use crate::identified_hull::IdentifiedHull;
use crate::noise::{HeadingNoise, RandomMoment};

/// Effect in a file.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct IdentifiedEffect {
    /// Identifier.
    pub id: String,
    /// Form.
    pub form: String,
    /// Constants that are not fitted: approach speed, m/s, or propeller rate, 1/s.
    #[serde(default)]
    pub constants: Vec<f64>,
}

/// Structure with its weight, parameters and covariance.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct WeightedStructure {
    /// Probability among the structures of the file.
    pub weight: f64,
    /// Effects in the order in which the rudder passes through them.
    pub effects: Vec<IdentifiedEffect>,
    /// 1/T (1/s), K/T (1/s²), δ_r (rad) and the parameters of the effects, in the units these declare.
    pub parameters: Vec<f64>,
    /// Indices of the fitted parameters.
    pub fitted: Vec<usize>,
    /// Covariance of the fitted parameters, by rows; empty if it is singular.
    pub covariance: Vec<Vec<f64>>,
    /// Degrees of freedom of the covariance (Student t); `null` for a normal distribution.
    pub degrees_of_freedom: Option<f64>,
}

/// Steering gear identified from records.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct IdentifiedGear {
    /// Rudder rate, rad/s.
    pub rate_rad_s: f64,
    /// Standard deviation of the rudder rate, rad/s.
    pub sd_rad_s: f64,
}

/// Range of the records; a prediction outside it is an extrapolation.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct ValidityRange {
    /// Maximum rudder angle, rad.
    pub rudder_rad: f64,
    /// Maximum yaw rate, rad/s.
    pub yaw_rate_rad_s: f64,
}

/// Identified ship: model, uncertainty, noise and steering gear.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct IdentifiedShip {
    /// Structures, the most probable first.
    pub members: Vec<WeightedStructure>,
    /// Heading noise of the records.
    pub noise: HeadingNoise,
    /// Steering gear; `null` if the records do not determine it; then the rudder moves in steps.
    pub gear: Option<IdentifiedGear>,
    /// Root mean square yaw rate at the end of straight approaches, rad/s; 0 without a straight approach.
    pub approach_yaw_rate_rad_s: f64,
    /// Range of validity.
    #[serde(rename = "seen")]
    pub validity_range: ValidityRange,
    /// Length between perpendiculars, m.
    pub length_m: Option<f64>,
    /// Approach speed, m/s.
    pub speed_m_s: Option<f64>,
    /// Hull models of three degrees of freedom, the nearest to the records first. If there are any, predictions use
    /// them instead of the structures.
    #[serde(default)]
    pub hulls: Vec<IdentifiedHull>,
}

impl WeightedStructure {
    /// Response model. Fails for an unknown effect, for parameters or a covariance of the wrong size, for a parameter
    /// that is not finite, and if `fitted` has an index beyond the parameters.
    pub fn model(&self) -> Result<ResponseModel, IdentifiedShipError> {
        let effect = |written: &IdentifiedEffect| -> Result<Arc<dyn Effect>, IdentifiedShipError> {
            effects::find_effect(&written.id, &written.form, &written.constants)
                .ok_or_else(|| IdentifiedShipError::Effect { id: written.id.clone(), form: written.form.clone() })
        };
        let model = ResponseModel::new(self.effects.iter().map(effect).collect::<Result<_, _>>()?);
        let (expected, length) = (model.parameter_count(), self.parameters.len());
        if expected != length {
            return Err(IdentifiedShipError::Count { list: "parameters", expected, length });
        }
        for (parameter, value) in model.parameters().zip(&self.parameters) {
            if !value.is_finite() {
                return Err(IdentifiedShipError::Value { key: parameter.key, value: *value });
            }
        }
        let count = self.fitted.len();
        let wrong = |list, expected, length| Err(IdentifiedShipError::Count { list, expected, length });
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

    /// Indices of the parameters that are dead times.
    pub fn dead_time_indices(&self, model: &ResponseModel) -> Vec<usize> {
        let named = (SteeringLag::DeadTime.id(), SteeringLag::DeadTime.form());
        let dead_times = model.effects_with_ranges().filter(|(effect, _)| (effect.id(), effect.form()) == named);
        dead_times.map(|(_, range)| range.start).collect()
    }
}

/// Relative tolerance of equal lengths.
const LENGTH_TOLERANCE: f64 = 1e-3;

/// `true` if two lengths differ by less than 0.1 %.
pub fn is_same_length(a: f64, b: f64) -> bool {
    (a / b - 1.0).abs() < LENGTH_TOLERANCE
}

impl IdentifiedShip {
    /// Length (m) and approach speed (m/s); `None` if one of them is unknown.
    pub fn particulars(&self) -> Option<Particulars> {
        Some(Particulars { length: self.length_m?, speed: self.speed_m_s? })
    }

    /// Ship scaled to another length (m) and approach speed (m/s): times are multiplied by (L₂/U₂)/(L₁/U₁), lengths by
    /// L₂/L₁, and dimensionless numbers, such as K′ and T′, stay. `None` for a speed proportional to √L, the scaling of
    /// Froude (1868).
    ///
    /// The random moment scales with the ship, as if the sea were scaled. Fails if length or speed of the ship is
    /// unknown or a constant has no unit, and as [`WeightedStructure::model`] does.
    pub fn scaled_to(&self, length: f64, speed: Option<f64>) -> Result<Self, IdentifiedShipError> {
        let ship = self.particulars().ok_or(IdentifiedShipError::NoParticulars)?;
        let metre = length / ship.length;
        let speed = speed.unwrap_or(ship.speed * metre.sqrt());
        let second = metre * ship.speed / speed;
        let factor = |[seconds, metres]: [i32; 2]| second.powi(seconds) * metre.powi(metres);
        let mut scaled = self.clone();
        for member in &mut scaled.members {
            let model = member.model()?;
            if let Some(e) = model.effects().iter().find(|e| e.parameters().iter().any(Parameter::has_no_unit)) {
                return Err(IdentifiedShipError::NoUnit(e.id()));
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
            *gear = IdentifiedGear { rate_rad_s: gear.rate_rad_s / second, sd_rad_s: gear.sd_rad_s / second };
        }
        scaled.approach_yaw_rate_rad_s /= second;
        scaled.validity_range.yaw_rate_rad_s /= second;
        scaled.hulls = self.hulls.iter().map(|hull| hull.scaled_to(length, speed)).collect();
        scaled.length_m = Some(length);
        scaled.speed_m_s = Some(speed);
        Ok(scaled)
    }

    /// Ship in a calm: without random moments, the error of the initial yaw rate and the effects of wind. Fails as
    /// [`WeightedStructure::model`] does.
    pub fn in_calm(&self) -> Result<Self, IdentifiedShipError> {
        let mut calm = self.clone();
        calm.noise.moment = RandomMoment::None;
        for hull in &mut calm.hulls {
            (hull.model_error_moment.sd_rudder_rad, hull.beginning_yaw_rate_rad_s) = (0.0, 0.0);
            if let Some(place) = hull.coefficients.iter().position(|coefficient| is_wind_coefficient(&coefficient.key))
            {
                hull.coefficients[place].value = 0.0;
                hull.covariance.iter_mut().for_each(|row| row[place] = 0.0);
                hull.covariance[place].fill(0.0);
            }
        }
        for member in &mut calm.members {
            let model = member.model()?;
            for (effect, range) in model.effects_with_ranges().filter(|(effect, _)| effect.is_heading_dependent()) {
                for (place, parameter) in range.clone().zip(effect.parameters()) {
                    member.parameters[place] = parameter.neutral;
                }
                let kept: Vec<bool> = member.fitted.iter().map(|place| !range.contains(place)).collect();
                let mut row = kept.iter();
                member.covariance.retain(|_| *row.next().unwrap_or(&true));
                for covariance in &mut member.covariance {
                    let mut column = kept.iter();
                    covariance.retain(|_| *column.next().unwrap_or(&true));
                }
                member.fitted.retain(|place| !range.contains(place));
            }
        }
        Ok(calm)
    }

    /// Delay of the logged rudder behind the acting one, s: the negative of the dead time of the most probable
    /// structure. `None` unless that dead time is negative.
    pub fn logged_rudder_delay(&self) -> Option<f64> {
        let likeliest = self.members.iter().max_by(|a, b| a.weight.total_cmp(&b.weight))?;
        let places = likeliest.dead_time_indices(&likeliest.model().ok()?);
        let late = -places.iter().map(|place| likeliest.parameters[*place]).sum::<f64>();
        (late > 0.0).then_some(late)
    }

    /// Time scale of the ship, s: L/U if known, otherwise (K/T)^(−1/2) of the most probable structure, which is
    /// similar. `None` if L/U is unknown and K/T is not positive.
    pub fn timescale(&self) -> Option<f64> {
        if let Some(particulars) = self.particulars() {
            return Some(particulars.ship_length_time());
        }
        let gain = *self.members.first()?.parameters.get(1)?;
        (gain > 0.0).then(|| gain.sqrt().recip())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ship() -> IdentifiedShip {
        let effect = IdentifiedEffect { id: "nonlinear_damping".into(), form: "r³".into(), constants: Vec::new() };
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

    /// Scaling there and back is the identity, and K′ = K L/U does not change.
    #[test]
    fn scaling_keeps_dimensionless_numbers() {
        let model = ship();
        let ship = model.scaled_to(25.0 * model.length_m.expect("a length"), None).expect("particulars");
        let prime = |ship: &IdentifiedShip| {
            let [a, b] = [ship.members[0].parameters[0], ship.members[0].parameters[1]];
            b / a * ship.length_m.expect("a length") / ship.speed_m_s.expect("a speed")
        };
        assert!((prime(&ship) - prime(&model)).abs() < 1e-12);
        let back = ship.scaled_to(model.length_m.expect("a length"), model.speed_m_s).expect("particulars");
        for (back, before) in back.members[0].parameters.iter().zip(&model.members[0].parameters) {
            assert!((back - before).abs() <= 1e-12 * before.abs());
        }
        let unknown = IdentifiedShip { length_m: None, ..model };
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
