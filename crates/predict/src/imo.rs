//! The criteria of IMO resolution MSC.137(76), as the probability that the ship passes them.

use ship::Particulars;
use trial::imo;

use crate::interval::Interval;
use crate::kind::Kind;
use crate::prediction::Prediction;

/// One criterion.
#[derive(Debug, Clone, PartialEq)]
pub struct Criterion {
    /// What is limited.
    pub name: &'static str,
    /// The manoeuvre it is read from.
    pub manoeuvre: String,
    /// Largest value allowed.
    pub limit: f64,
    /// Unit of limit and interval.
    pub unit: imo::Unit,
    /// Predicted value.
    pub interval: Interval,
    /// Share of the drawn ships that keep within the limit; a ship without the figure does not.
    pub probability: f64,
    /// Whether the manoeuvre is beyond what the records have seen.
    pub extrapolated: bool,
}

/// The criteria that some predicted manoeuvres answer, for a ship of this length and speed.
pub fn criteria(predictions: &[Prediction], particulars: Particulars) -> Vec<Criterion> {
    let angle = |kind: &Kind, deg: f64| match *kind {
        Kind::ZigZag { rudder, heading, .. } => {
            let is = |angle: f64| (ship::angle::to_deg(angle) - deg).abs() < 1e-6;
            is(rudder) && is(heading)
        }
        _ => false,
    };
    let is_initial_turning = |kind: &Kind| {
        let ten = |rudder: f64| (ship::angle::to_deg(rudder) - 10.0).abs() < 1e-6;
        angle(kind, 10.0) || matches!(*kind, Kind::InitialTurning { rudder, .. } if ten(rudder))
    };
    let mut criteria = Vec::new();
    for prediction in predictions {
        let kind = &prediction.kind;
        let mut add = |name: &'static str, figure: &str, limit: f64, unit: imo::Unit| {
            let Some(figure) = prediction.figures.iter().find(|own| own.name == figure) else { return };
            criteria.push(Criterion {
                name,
                manoeuvre: kind.to_string(),
                limit,
                unit,
                interval: figure.interval,
                probability: figure.share_within(limit),
                extrapolated: prediction.extrapolated,
            });
        };
        if is_initial_turning(kind) {
            add("initial turning", "initial_turning_lengths", imo::INITIAL_TURNING_LENGTHS, imo::Unit::ShipLengths);
        }
        if angle(kind, 10.0) {
            let first = imo::first_overshoot_10_10_limit_deg(particulars);
            let second = imo::second_overshoot_10_10_limit_deg(particulars);
            add("10/10 first overshoot", "first_overshoot_deg", first, imo::Unit::Degrees);
            add("10/10 second overshoot", "second_overshoot_deg", second, imo::Unit::Degrees);
        }
        if angle(kind, 20.0) {
            let limit = imo::FIRST_OVERSHOOT_20_20_DEG;
            add("20/20 first overshoot", "first_overshoot_deg", limit, imo::Unit::Degrees);
        }
        if let Kind::TurningCircle { .. } = kind {
            add("advance", "advance_lengths", imo::ADVANCE_LENGTHS, imo::Unit::ShipLengths);
            add(
                "tactical diameter",
                "tactical_diameter_lengths",
                imo::TACTICAL_DIAMETER_LENGTHS,
                imo::Unit::ShipLengths,
            );
        }
    }
    criteria
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::made_up;
    use crate::mixture::Mixture;

    #[test]
    fn probabilities_are_shares_of_the_draws() {
        let mixture = Mixture::new(vec![(made_up::known(), 1.0)]).expect("made up");
        let predictions: Vec<Prediction> =
            Kind::of_imo().iter().map(|kind| mixture.predict(kind, 100, false).expect("a manoeuvre")).collect();
        let found = criteria(&predictions, mixture.particulars().expect("made up"));
        let names: Vec<&str> = found.iter().map(|criterion| criterion.name).collect();
        assert_eq!(
            names,
            ["initial turning", "10/10 first overshoot", "10/10 second overshoot", "20/20 first overshoot"],
            "a response without speed and drift has no track"
        );
        for criterion in &found {
            let passes = criterion.interval.ci90[1] <= criterion.limit;
            assert!(!passes || criterion.probability >= 0.95, "{criterion:?}");
        }
        // L/V = 12.5 s.
        assert!((found[1].limit - 11.25).abs() < 1e-12);
    }
}
