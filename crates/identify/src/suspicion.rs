//! What a record cannot show by itself: whether the scale of the rudder, the clock, or the length and speed that were
//! given are right. All of them move K′, T′ and the rate of the rudder, so numbers that ships hardly have are a reason
//! to look. Within what ships have nothing is noticed: a rudder that is read a fifth too large is not.

use document::{Code, Warning};
use ship::Particulars;
use ship::angle::to_deg;
use ship::particulars::{USUAL_K_OVER_T_PRIME, USUAL_K_PRIME, USUAL_T_PRIME, usual_rudder_rate_deg_s};
use ship::vessel::prior::{HullParticulars, USUAL_FROUDE_NUMBER};
use trial::{Channel, Quantity, Trial, ZigZag};

use crate::estimate::{Estimate, Uncertainty};

/// Standard deviations by which a value may be off for its own error.
const ERRORS: f64 = 2.0;

/// Share by which the rate of a rudder that is read off a record may be off.
const READ: f64 = 0.05;

/// Times by which the largest speed of a record and its approach speed may differ: a current of two knots is a fifth of
/// ten. A ship that gathers way is steered when she has most of it.
const OTHER_SPEED: f64 = 1.25;

/// What is unusual of an estimate and of the records it is from; `None` where nothing is.
///
/// Length and speed that contradict each other or the record go before all else. For the rest the records have to be
/// zig-zags: a turn alone hardly tells K′ = K L/U, T′ = T U/L and K′/T′. `ship` belongs to the clock of the estimate,
/// `records` have their own.
pub fn suspicion(estimate: &Estimate, ship: Option<Particulars>, records: &[Trial]) -> Option<Warning> {
    if let Some(scale) = records.iter().find_map(other_scale) {
        return Some(scale);
    }
    let zigzags: Option<Vec<ZigZag>> = records.iter().map(|record| ZigZag::of(record).ok()).collect();
    let zigzags = zigzags?;
    let indices = ship.map(|ship| unusual_indices(estimate, ship));
    let rates = zigzags.iter().zip(records).filter_map(|(zigzag, record)| {
        let rate_deg_s = to_deg(zigzag.rudder_rate?);
        let [low, high] = usual_rudder_rate_deg_s(record.particulars()?.length);
        (!(low * (1.0 - READ)..=high * (1.0 + READ)).contains(&rate_deg_s))
            .then(|| format!("the rudder moves at {rate_deg_s:.1}°/s (usual {low:.0} to {high:.0} at this length)"))
    });
    let found: Vec<String> = indices.into_iter().flatten().chain(rates.take(1)).collect();
    // Where the records have a speed, it is that which was given.
    let has_speed = records.iter().all(|record| record.channel(Channel::Speed).is_some());
    let given = if has_speed { "length" } else { "length and speed" };
    (!found.is_empty()).then(|| {
        Code::UnusualShip.warning(format!(
            "{}: check the scale of the rudder, the clock, and the {given} given; the record alone cannot show such an error",
            found.join(", ")
        ))
    })
}

/// What mends them.
const ONE_SCALE: &str =
    "length and speed have to be of one scale and that of the record, both of the ship or both of the model";

/// Why length and speed are not of one scale, with the cure: no ship has their Froude number.
pub fn unusual_froude_number(Particulars { length, speed }: Particulars) -> Option<Warning> {
    let froude = HullParticulars { length, speed, ..HullParticulars::default() }.froude_number();
    let [low, high] = USUAL_FROUDE_NUMBER;
    (!(low..=high).contains(&froude)).then(|| {
        Code::UnusualShip.warning(format!(
            "{length} m at {speed:.3} m/s is a Froude number of {froude:.3} (ships have {low} to {high}): {ONE_SCALE}"
        ))
    })
}

/// The same of a record, which may also sail at another speed than is given.
fn other_scale(record: &Trial) -> Option<Warning> {
    let own = record.particulars()?;
    if let Some(unusual) = unusual_froude_number(own) {
        return Some(unusual);
    }
    let speed = own.speed;
    let speeds = record.channel(Channel::Speed)?.iter().copied().filter(|own| own.is_finite());
    let largest = speeds.fold(0.0, f64::max);
    let is_other = largest > 0.0 && !(1.0 / OTHER_SPEED..=OTHER_SPEED).contains(&(largest / speed));
    is_other.then(|| {
        let name = record.title();
        Code::UnusualShip.warning(format!(
            "{name} sails at {largest:.3} m/s at most, and {speed:.3} m/s is given as its approach speed: {ONE_SCALE}"
        ))
    })
}

fn unusual_indices(estimate: &Estimate, ship: Particulars) -> Vec<String> {
    let ratio_sd = match &estimate.uncertainty {
        Uncertainty::Covariance(covariance) => Some(covariance.matrix[(1, 1)].max(0.0).sqrt()),
        _ => None,
    };
    let [k, t] = [estimate.K().scaled(ship.prime([-1, 0])), estimate.T().scaled(ship.prime([1, 0]))];
    let ratio = Quantity::new(estimate.response.K_over_T, ratio_sd).scaled(ship.prime([-2, 0]));
    let told = |(name, quantity, [low, high]): (&str, Quantity, [f64; 2])| {
        let doubt = ERRORS * quantity.sd.unwrap_or(0.0);
        (quantity.value + doubt < low || quantity.value - doubt > high)
            .then(|| format!("{name} is {:.2} (ships have {low} to {high})", quantity.value))
    };
    // A course-unstable ship has K and T below zero, and their ratio as any other.
    let indices = [("K′", k, USUAL_K_PRIME), ("T′", t, USUAL_T_PRIME)];
    let of_stable = indices.into_iter().filter(|_| !estimate.response.is_course_unstable());
    of_stable.chain([("K′/T′", ratio, USUAL_K_OVER_T_PRIME)]).filter_map(told).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::Case;
    use crate::{Identifier, output_error};
    use trial::Columns;

    const YUKUN: Particulars = Particulars { length: 105.0, speed: 8.59 };

    /// What is said of a record of YUKUN (K′ = 1.22, T′ = 1.33, 2.5°/s) that is changed, and of its length and speed.
    fn told(ship: Particulars, change: impl Fn(&mut Case)) -> Option<String> {
        let mut case = Case { noise_deg: 0.1, ..Case::default() };
        change(&mut case);
        let record = case.trial().with_particulars(ship);
        let method = output_error::Settings::default().build().expect("defaults");
        let estimate = method.identify(std::slice::from_ref(&record)).expect("a fit");
        suspicion(&estimate, Some(ship), &[record]).map(|warning| warning.text)
    }

    #[test]
    fn what_ships_have_is_not_suspected() {
        assert_eq!(told(YUKUN, |_| {}), None);
        // A rudder that is read a fifth too large.
        assert_eq!(told(YUKUN, |case| (case.K, case.rate_deg_s) = (0.1 / 1.2, 3.0)), None);
        // A model of 1:20 by Froude: every time is shorter by √20.
        let model = Particulars { length: 105.0 / 20.0, speed: 8.59 / 20.0_f64.sqrt() };
        let quicker = 20.0_f64.sqrt();
        let smaller = |case: &mut Case| {
            (case.K, case.T, case.rate_deg_s) = (0.1 * quicker, 16.3 / quicker, 2.5 * quicker);
            case.period_s = 1.0 / quicker;
        };
        assert_eq!(told(model, smaller), None);
    }

    /// A model of 7 m given as her ship of 320 m, by length alone or by both.
    #[test]
    fn a_model_given_as_her_ship_is_suspected() {
        let cure = "both of the ship or both of the model";
        let slow = told(Particulars { length: 320.0, speed: 1.18 }, |_| {}).expect("a Froude number of 0.021");
        assert!(slow.contains("Froude number of 0.021 (ships have 0.025 to 0.6)") && slow.contains(cure), "{slow}");
        let model = Case::default().trial().with_particulars(Particulars { length: 320.0, speed: 7.97 });
        let channels = [Channel::Heading, Channel::Rudder].map(|own| (own, model.channel(own).expect("one").to_vec()));
        let speed = (Channel::Speed, vec![1.18; model.time().len()]);
        let columns = Columns {
            time: model.time().to_vec(),
            channels: channels.into_iter().chain([speed]).collect(),
            unknown: Vec::new(),
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
        let knots = told(Particulars { speed: 16.7, ..YUKUN }, |_| {}).expect("K′/T′ is a quarter of what it was");
        assert!(knots.contains("K′/T′ is 0.24 (ships have 0.25 to 2)") && knots.contains(all), "{knots}");
        let long = told(Particulars { length: 1050.0, ..YUKUN }, |_| {}).expect("K′ is 12");
        assert!(long.contains("K′ is 12.2") && long.contains("T′ is 0.13"), "{long}");
        let slow = told(YUKUN, |case| {
            (case.K, case.T, case.rate_deg_s, case.period_s) = (0.1 / 3.0, 48.9, 2.5 / 3.0, 3.0);
        });
        let slow = slow.expect("a clock that is three times too slow");
        assert!(slow.contains("the rudder moves at 0.8°/s (usual 2 to 7 at this length)"), "{slow}");
        assert!(told(YUKUN, |case| case.rate_deg_s = 9.0).expect("too fast").contains("moves at 9.0°/s"));
    }
}
