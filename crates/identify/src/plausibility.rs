//! Plausibility of an estimate against the usual range of ships: errors in the scale of the rudder, the clock, or the
//! given length and speed, which a record alone cannot show, move K′, T′ and the rudder rate. Within the usual range no
//! error is detected, for example a rudder read a fifth too large. Sources of the ranges: [`ship::particulars`].

use document::{Warning, WarningCode};
use ship::Particulars;
use ship::angle::to_deg;
use ship::particulars::{USUAL_K_OVER_T_PRIME, USUAL_K_PRIME, USUAL_T_PRIME, usual_rudder_rate_deg_s};
use ship::vessel::prior::{HullParticulars, USUAL_FROUDE_NUMBER};
use trial::{Channel, Quantity, Trial, ZigZag};

use crate::estimate::{Estimate, Uncertainty};

/// Maximum distance of a value from the usual range, in standard deviations.
const MAX_DEVIATIONS: f64 = 2.0;

/// Relative tolerance of a rudder rate from a record.
const RATE_TOLERANCE: f64 = 0.05;

/// Maximum ratio between the largest speed of a record and its approach speed, either way: a current of 2 kn changes a
/// speed of 10 kn by a fifth, and a ship that gathers way has most of her speed at the first execute.
const MAX_SPEED_RATIO: f64 = 1.25;

/// Warning on unusual values of an estimate and of its records; `None` for usual values.
///
/// A contradiction between length and speed, or with the record, is reported first. The other checks need zig-zags: a
/// turn alone hardly determines K′ = K L/U, T′ = T U/L and K′/T′. `ship` is at the scale of the estimate, every one of
/// `records` at the scale of its measurement.
pub fn unusual_ship(estimate: &Estimate, ship: Option<Particulars>, records: &[Trial]) -> Option<Warning> {
    if let Some(contradiction) = records.iter().find_map(other_scale) {
        return Some(contradiction);
    }
    let zigzags: Option<Vec<ZigZag>> = records.iter().map(|record| ZigZag::from_trial(record).ok()).collect();
    let zigzags = zigzags?;
    let indices = ship.map(|ship| unusual_indices(estimate, ship));
    let rates = zigzags.iter().zip(records).filter_map(|(zigzag, record)| {
        let rate_deg_s = to_deg(zigzag.rudder_rate?);
        let [low, high] = usual_rudder_rate_deg_s(record.particulars()?.length);
        (!(low * (1.0 - RATE_TOLERANCE)..=high * (1.0 + RATE_TOLERANCE)).contains(&rate_deg_s))
            .then(|| format!("the rudder moves at {rate_deg_s:.1}°/s (usual {low:.0} to {high:.0} at this length)"))
    });
    let unusual: Vec<String> = indices.into_iter().flatten().chain(rates.take(1)).collect();
    // A recorded speed is compared above.
    let has_speed = records.iter().all(|record| record.channel(Channel::Speed).is_some());
    let given = if has_speed { "length" } else { "length and speed" };
    (!unusual.is_empty()).then(|| {
        WarningCode::UnusualShip.warning(format!(
            "{}: check the scale of the rudder, the clock, and the {given} given; the record alone cannot show such an error",
            unusual.join(", ")
        ))
    })
}

/// Advice for a length and speed of different scales.
const SAME_SCALE: &str = "length, speed and record must be of the same scale, all of the ship or all of the model";

/// Warning on an impossible Froude number: length and speed are not of the same scale. `None` for a usual number.
pub fn unusual_froude_number(Particulars { length, speed }: Particulars) -> Option<Warning> {
    let froude = HullParticulars { length, speed, ..HullParticulars::default() }.froude_number();
    let [low, high] = USUAL_FROUDE_NUMBER;
    (!(low..=high).contains(&froude)).then(|| {
        WarningCode::UnusualShip.warning(format!(
            "{length} m at {speed:.3} m/s is a Froude number of {froude:.3} (ships have {low} to {high}): {SAME_SCALE}"
        ))
    })
}

/// Warning on a record whose length and speed are not of the same scale, or whose speed differs from the given speed.
fn other_scale(record: &Trial) -> Option<Warning> {
    let particulars = record.particulars()?;
    if let Some(unusual) = unusual_froude_number(particulars) {
        return Some(unusual);
    }
    let speed = particulars.speed;
    let speeds = record.channel(Channel::Speed)?.iter().copied().filter(|speed| speed.is_finite());
    let largest = speeds.fold(0.0, f64::max);
    let is_other = largest > 0.0 && !(1.0 / MAX_SPEED_RATIO..=MAX_SPEED_RATIO).contains(&(largest / speed));
    is_other.then(|| {
        let name = record.title();
        WarningCode::UnusualShip.warning(format!(
            "{name} sails at {largest:.3} m/s at most, and {speed:.3} m/s is given as its approach speed: {SAME_SCALE}"
        ))
    })
}

fn unusual_indices(estimate: &Estimate, ship: Particulars) -> Vec<String> {
    let ratio_sd = match &estimate.uncertainty {
        Uncertainty::Covariance(covariance) => Some(covariance.matrix[(1, 1)].max(0.0).sqrt()),
        _ => None,
    };
    let [k, t] = [estimate.K().scaled(ship.prime_factor([-1, 0])), estimate.T().scaled(ship.prime_factor([1, 0]))];
    let ratio = Quantity::new(estimate.response.K_over_T, ratio_sd).scaled(ship.prime_factor([-2, 0]));
    let message = |(name, quantity, [low, high]): (&str, Quantity, [f64; 2])| {
        let margin = MAX_DEVIATIONS * quantity.sd.unwrap_or(0.0);
        (quantity.value + margin < low || quantity.value - margin > high)
            .then(|| format!("{name} is {:.2} (ships have {low} to {high})", quantity.value))
    };
    // A course-unstable ship has K and T below zero, but a usual ratio.
    let indices = [("K′", k, USUAL_K_PRIME), ("T′", t, USUAL_T_PRIME)];
    let for_stable = indices.into_iter().filter(|_| !estimate.response.is_course_unstable());
    for_stable.chain([("K′/T′", ratio, USUAL_K_OVER_T_PRIME)]).filter_map(message).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::Case;
    use crate::{Identifier, output_error};
    use trial::Columns;

    const YUKUN: Particulars = Particulars { length: 105.0, speed: 8.59 };

    /// Warning on a changed record of YUKUN (K′ = 1.22, T′ = 1.33, 2.5°/s) with a given length and speed.
    fn text(ship: Particulars, change: impl Fn(&mut Case)) -> Option<String> {
        let mut case = Case { noise_deg: 0.1, ..Case::default() };
        change(&mut case);
        let record = case.trial().with_particulars(ship);
        let method = output_error::Settings::default().build().expect("defaults");
        let estimate = method.identify(std::slice::from_ref(&record)).expect("a fit");
        unusual_ship(&estimate, Some(ship), &[record]).map(|warning| warning.text)
    }

    #[test]
    fn what_ships_have_is_not_suspected() {
        assert_eq!(text(YUKUN, |_| {}), None);
        // Rudder read a fifth too large.
        assert_eq!(text(YUKUN, |case| (case.K, case.rate_deg_s) = (0.1 / 1.2, 3.0)), None);
        // A model of 1:20 by Froude: every time is shorter by √20.
        let model = Particulars { length: 105.0 / 20.0, speed: 8.59 / 20.0_f64.sqrt() };
        let quicker = 20.0_f64.sqrt();
        let smaller = |case: &mut Case| {
            (case.K, case.T, case.rate_deg_s) = (0.1 * quicker, 16.3 / quicker, 2.5 * quicker);
            case.period_s = 1.0 / quicker;
        };
        assert_eq!(text(model, smaller), None);
    }

    /// A model of 7 m with the particulars of her ship of 320 m, by length alone or by length and speed.
    #[test]
    fn a_model_given_as_her_ship_is_suspected() {
        let cure = "all of the ship or all of the model";
        let slow = text(Particulars { length: 320.0, speed: 1.18 }, |_| {}).expect("a Froude number of 0.021");
        assert!(slow.contains("Froude number of 0.021 (ships have 0.025 to 0.6)") && slow.contains(cure), "{slow}");
        let model = Case::default().trial().with_particulars(Particulars { length: 320.0, speed: 7.97 });
        let channels = [Channel::Heading, Channel::Rudder].map(|key| (key, model.channel(key).expect("one").to_vec()));
        let speed = (Channel::Speed, vec![1.18; model.time().len()]);
        let columns = Columns {
            time: model.time().to_vec(),
            channels: channels.into_iter().chain([speed]).collect(),
            unknown_columns: Vec::new(),
        };
        let record = Trial::new("model", model.origin().clone(), columns).expect("a record");
        let given = |length, speed| {
            other_scale(&record.clone().with_particulars(Particulars { length, speed })).map(|warning| warning.text)
        };
        let other = given(320.0, 7.97).expect("another speed");
        assert!(other.starts_with("model sails at 1.180 m/s at most, and 7.970 m/s is given") && other.contains(cure));
        assert_eq!(given(7.0, 1.18), None);
        assert!(given(7.0, 2.0).is_some_and(|other| other.contains("1.180 m/s at most, and 2.000 m/s is given")));
    }

    #[test]
    fn a_wrong_length_speed_scale_or_clock_is_suspected() {
        let all = "check the scale of the rudder, the clock, and the length and speed given";
        let knots = text(Particulars { speed: 16.7, ..YUKUN }, |_| {}).expect("K′/T′ is a quarter of what it was");
        assert!(knots.contains("K′/T′ is 0.24 (ships have 0.25 to 2)") && knots.contains(all), "{knots}");
        let long = text(Particulars { length: 1050.0, ..YUKUN }, |_| {}).expect("K′ is 12");
        assert!(long.contains("K′ is 12.2") && long.contains("T′ is 0.13"), "{long}");
        let slow = text(YUKUN, |case| {
            (case.K, case.T, case.rate_deg_s, case.period_s) = (0.1 / 3.0, 48.9, 2.5 / 3.0, 3.0);
        });
        let slow = slow.expect("a clock that is three times too slow");
        assert!(slow.contains("the rudder moves at 0.8°/s (usual 2 to 7 at this length)"), "{slow}");
        assert!(text(YUKUN, |case| case.rate_deg_s = 9.0).expect("too fast").contains("moves at 9.0°/s"));
    }
}
