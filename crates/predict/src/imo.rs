//! Criteria of IMO resolution MSC.137(76), with the probability that the ship passes them.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use ship::Particulars;
use ship::angle::{DEGREE, to_deg};
use simulate::Manoeuvre;
use trial::imo::{self, CriterionUnit};

use crate::interval::PredictionInterval;
use crate::prediction::Prediction;

/// Criterion with the predicted value.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct PredictedCriterion {
    /// Limited quantity.
    pub criterion: String,
    /// Manoeuvre of the quantity.
    pub manoeuvre: String,
    /// Maximum value allowed.
    pub limit: f64,
    /// Unit of limit and interval.
    pub unit: String,
    /// Predicted value.
    #[serde(flatten)]
    pub interval: PredictionInterval,
    /// Share of the drawn ships within the limit; a ship without the characteristic counts as outside.
    pub probability_of_passing: f64,
    /// `true` if the manoeuvre is beyond the range of the records.
    pub extrapolated: bool,
}

/// Manoeuvre of the criteria and of the form of MSC/Circ.1053, at a positive rudder.
pub(crate) type FormManoeuvre = &'static str;

pub(crate) const ZIG_ZAG_10_10: FormManoeuvre = "zig-zag 10/10";
pub(crate) const ZIG_ZAG_20_20: FormManoeuvre = "zig-zag 20/20";
pub(crate) const TURNING_CIRCLE_35: FormManoeuvre = "turning-circle 35";

/// Rudder angle of the turning circle, rad. The resolution also allows the maximum rudder angle, which no model gives.
pub(crate) const CIRCLE_RUDDER: f64 = 35.0 * DEGREE;

/// Tolerance of the rudder angle of the turning circle, rad.
pub(crate) const CIRCLE_RUDDER_TOLERANCE: f64 = 0.05 * CIRCLE_RUDDER;

/// Limit of IMO resolution MSC.137(76) on a characteristic.
pub(crate) struct ImoLimit {
    /// Name of the limit.
    pub name: &'static str,
    /// Section of the form.
    pub section: &'static str,
    /// Field of the form.
    pub field: &'static str,
    /// Manoeuvre.
    pub manoeuvre: FormManoeuvre,
    /// Name of the characteristic.
    pub figure: &'static str,
    /// Unit of the limit.
    pub unit: CriterionUnit,
    /// Maximum value; `None` if it depends on an unknown L/V.
    pub value: fn(Option<Particulars>) -> Option<f64>,
}

const ADVANCE_LIMIT: ImoLimit = ImoLimit {
    name: "advance",
    section: "turning circle, rudder 35°",
    field: "advance",
    manoeuvre: TURNING_CIRCLE_35,
    figure: "advance_lengths",
    unit: CriterionUnit::ShipLengths,
    value: |_| Some(imo::MAX_ADVANCE_LENGTHS),
};

const FIRST_OVERSHOOT_10_10_LIMIT: ImoLimit = ImoLimit {
    name: "10/10 first overshoot",
    section: "zig-zag 10°/10°",
    field: "1st overshoot angle",
    manoeuvre: ZIG_ZAG_10_10,
    figure: "first_overshoot_deg",
    unit: CriterionUnit::Degrees,
    value: |scale| scale.map(imo::first_overshoot_10_10_limit_deg),
};

/// Limits of the resolution. Source: MSC.137(76), 5.3.
pub(crate) const IMO_LIMITS: [ImoLimit; 6] = [
    ImoLimit {
        name: "initial turning",
        section: "initial turning",
        field: "distance to turn 10° with 10° rudder",
        figure: "initial_turning_lengths",
        unit: CriterionUnit::ShipLengths,
        value: |_| Some(imo::MAX_INITIAL_TURNING_LENGTHS),
        ..FIRST_OVERSHOOT_10_10_LIMIT
    },
    FIRST_OVERSHOOT_10_10_LIMIT,
    ImoLimit {
        name: "10/10 second overshoot",
        field: "2nd overshoot angle",
        figure: "second_overshoot_deg",
        value: |scale| scale.map(imo::second_overshoot_10_10_limit_deg),
        ..FIRST_OVERSHOOT_10_10_LIMIT
    },
    ImoLimit {
        name: "20/20 first overshoot",
        section: "zig-zag 20°/20°",
        manoeuvre: ZIG_ZAG_20_20,
        value: |_| Some(imo::MAX_FIRST_OVERSHOOT_20_20_DEG),
        ..FIRST_OVERSHOOT_10_10_LIMIT
    },
    ADVANCE_LIMIT,
    ImoLimit {
        name: "tactical diameter",
        field: "tactical diameter",
        figure: "tactical_diameter_lengths",
        value: |_| Some(imo::MAX_TACTICAL_DIAMETER_LENGTHS),
        ..ADVANCE_LIMIT
    },
];

impl ImoLimit {
    /// `true` if a manoeuvre to either side gives the limited characteristic: for the 10/10 also an initial turning
    /// with 10°.
    fn is_answered_by(&self, kind: &Manoeuvre) -> bool {
        let is = |angle: f64, deg: f64| (to_deg(angle) - deg).abs() < 1e-6;
        let is_pair =
            |deg| matches!(*kind, Manoeuvre::ZigZag { rudder, heading, .. } if is(heading, deg) && is(rudder, deg));
        match self.manoeuvre {
            TURNING_CIRCLE_35 => {
                matches!(*kind, Manoeuvre::TurningCircle { rudder, .. } if (rudder - CIRCLE_RUDDER).abs() <= CIRCLE_RUDDER_TOLERANCE)
            }
            ZIG_ZAG_20_20 => is_pair(20.0),
            _ => is_pair(10.0) || matches!(*kind, Manoeuvre::InitialTurning { rudder, .. } if is(rudder, 10.0)),
        }
    }
}

/// Criterion that limits a characteristic of a manoeuvre (such as `zig-zag 10/10 first_overshoot_deg`), and its limit
/// for a ship with this L/V, s; `None` for a characteristic without a limit.
pub fn imo_limit(figure: &str, length_over_speed: f64) -> Option<(&'static str, f64)> {
    let scale = Particulars { length: length_over_speed, speed: 1.0 };
    let is_limited =
        |limit: &&ImoLimit| figure.strip_prefix(limit.manoeuvre).is_some_and(|name| name.trim() == limit.figure);
    IMO_LIMITS.iter().find(is_limited).and_then(|limit| Some((limit.name, (limit.value)(Some(scale))?)))
}

/// IMO criteria with the predicted values, for a ship of this length and speed; a criterion without a prediction is
/// left out.
pub fn predicted_criteria(predictions: &[Prediction], particulars: Particulars) -> Vec<PredictedCriterion> {
    let answer = |prediction: &Prediction, limit: &ImoLimit| {
        let figure = prediction.figures.get(limit.figure)?;
        let largest = (limit.value)(Some(particulars))?;
        Some(PredictedCriterion {
            criterion: limit.name.to_owned(),
            manoeuvre: prediction.kind.to_string(),
            limit: largest,
            unit: limit.unit.symbol().to_owned(),
            interval: figure.interval,
            probability_of_passing: figure.share_within(largest),
            extrapolated: figure.extrapolated,
        })
    };
    let mut criteria = Vec::new();
    for prediction in predictions {
        let limits = IMO_LIMITS.iter().filter(|limit| limit.is_answered_by(&prediction.kind));
        criteria.extend(limits.filter_map(|limit| answer(prediction, limit)));
    }
    criteria
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing;

    #[test]
    fn probabilities_are_shares_of_the_draws() {
        let mixture = testing::mixture(testing::identified_ship());
        let predictions: Vec<Prediction> = crate::standard::imo_manoeuvres()
            .iter()
            .map(|kind| mixture.predict(kind, 100, false).expect("a manoeuvre"))
            .collect();
        let predicted = predicted_criteria(&predictions, mixture.particulars().expect("made up"));
        let names: Vec<&str> = predicted.iter().map(|criterion| criterion.criterion.as_str()).collect();
        assert_eq!(
            names,
            ["initial turning", "10/10 first overshoot", "10/10 second overshoot", "20/20 first overshoot"],
            "a response without speed and drift has no track"
        );
        for criterion in &predicted {
            let passes = criterion.interval.ci90[1] <= criterion.limit;
            assert!(!passes || criterion.probability_of_passing >= 0.95, "{criterion:?}");
        }
        // L/V = 12.5 s.
        assert!((predicted[1].limit - 11.25).abs() < 1e-12);
        let (name, limit) = imo_limit("zig-zag 10/10 first_overshoot_deg", 12.5).expect("it is limited");
        assert_eq!((name, limit), ("10/10 first overshoot", predicted[1].limit));
        assert_eq!(imo_limit("zig-zag 20/20 second_overshoot_deg", 12.5), None);
    }
}
