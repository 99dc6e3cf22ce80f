//! Manoeuvrability criteria of IMO resolution MSC.137(76), adopted 4 December 2002, for a zig-zag record, and the
//! limits of the turning circle, which a zig-zag does not measure.
//!
//! The criteria are for ships of 100 m and above (chemical and gas carriers of any length) at full load and even keel,
//! in deep unrestricted water and calm weather, at the test speed: at least 90 % of the speed at 85 % of the maximum
//! engine output. A record does not contain these conditions. L and V must be of the same scale as the record.

use document::Quantity;
use document::fit::CriterionVerdict;
use ship::Particulars;
use ship::angle::to_deg;

use crate::zigzag::{NominalAngles, ZigZag};

/// Minimum length of a ship under the criteria, m.
pub const MIN_LENGTH_M: f64 = 100.0;
/// Maximum advance of a turning circle, ship lengths.
pub const MAX_ADVANCE_LENGTHS: f64 = 4.5;
/// Maximum tactical diameter of a turning circle, ship lengths.
pub const MAX_TACTICAL_DIAMETER_LENGTHS: f64 = 5.0;
/// Maximum distance for a change of heading by 10 degrees with 10 degrees of rudder, ship lengths.
pub const MAX_INITIAL_TURNING_LENGTHS: f64 = 2.5;
/// Maximum first overshoot of the 20/20 zig-zag, degrees.
pub const MAX_FIRST_OVERSHOOT_20_20_DEG: f64 = 25.0;

/// Maximum first overshoot of the 10/10 zig-zag, degrees.
///
/// 10 for L/V < 10 s, 20 for L/V ≥ 30 s, else 5 + L/(2V). Source: MSC.137(76), 5.3.3.1.
pub fn first_overshoot_10_10_limit_deg(particulars: Particulars) -> f64 {
    between(particulars, 10.0, 20.0, |seconds| 5.0 + 0.5 * seconds)
}

/// Maximum second overshoot of the 10/10 zig-zag, degrees.
///
/// 25 for L/V < 10 s, 40 for L/V ≥ 30 s, else 17.5 + 0.75 L/V. Source: MSC.137(76), 5.3.3.2.
pub fn second_overshoot_10_10_limit_deg(particulars: Particulars) -> f64 {
    between(particulars, 25.0, 40.0, |seconds| 17.5 + 0.75 * seconds)
}

/// Limit as a function of L/V: constant below 10 s and from 30 s on, linear between.
fn between(Particulars { length, speed }: Particulars, short: f64, long: f64, line: impl Fn(f64) -> f64) -> f64 {
    match length / speed {
        seconds if seconds < 10.0 => short,
        seconds if seconds < 30.0 => line(seconds),
        _ => long,
    }
}

/// Text of the caution for a ship shorter than [`MIN_LENGTH_M`]; `None` for any other ship.
pub fn short_ship_caution(Particulars { length, speed }: Particulars) -> Option<String> {
    (length < MIN_LENGTH_M).then(|| {
        format!(
            "the criteria are for ships of 100 m and above (chemical tankers and gas carriers of any length); the limits \
             of the 10/10 zig-zag depend on L/V and are those of a ship of {length:.2} m at {speed:.2} m/s; for the \
             full-scale ship of a model run `study predict` with her --length-m and --speed-kn"
        )
    })
}

/// Unit of a criterion.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum CriterionUnit {
    /// Degrees.
    Degrees,
    /// Ship lengths L.
    ShipLengths,
}

impl CriterionUnit {
    /// Symbol after a number.
    pub fn symbol(self) -> &'static str {
        match self {
            Self::Degrees => "deg",
            Self::ShipLengths => "L",
        }
    }
}

/// Criterion with its measured value.
#[derive(Debug, Clone, PartialEq)]
pub struct ImoCriterion {
    /// Name of the limited quantity.
    pub name: &'static str,
    /// Measured value, in `unit`; `None` if the record does not give it. The verdict uses the value without its
    /// uncertainty.
    pub measured: Option<Quantity>,
    /// Maximum value, in `unit`.
    pub limit: f64,
    /// Unit of value and limit.
    pub unit: CriterionUnit,
}

impl ImoCriterion {
    /// Verdict: the measured value against the limit.
    pub fn verdict(&self) -> CriterionVerdict {
        match self.measured {
            None => CriterionVerdict::NotMeasured,
            Some(measured) if measured.value <= self.limit => CriterionVerdict::Pass,
            Some(_) => CriterionVerdict::Fail,
        }
    }
}

/// Criteria of a zig-zag with the measured values: overshoots and initial turning of a 10/10, the first overshoot of a
/// 20/20. Other pairs, and a record that begins within the trial, give no values. Initial turning and first overshoot
/// require a straight course until the first execute.
///
/// The distance of the initial turning is the integral of the recorded speed, or V t_a if the speed was not
/// recorded; the latter is slightly long, because a ship loses speed as it begins to turn.
pub fn imo_criteria(zigzag: &ZigZag, particulars: Particulars) -> Vec<ImoCriterion> {
    let is_pair =
        |angle_deg: f64| zigzag.nominal_angles.is_some_and(|pair: NominalAngles| pair.is_deg(angle_deg, angle_deg));
    let is_straight = zigzag.straight_yaw_rate().is_some();
    let overshoot = |angle_deg: f64, n: usize| {
        let angle = zigzag.nth_overshoot(n).filter(|_| is_pair(angle_deg) && (n > 1 || is_straight))?.angle;
        Some(angle.scaled(to_deg(1.0)))
    };
    let initial_turning = zigzag.initial_turning_time.filter(|_| is_pair(10.0) && is_straight).map(|time| {
        let Particulars { length, speed } = particulars;
        let way = zigzag.initial_turning_distance.unwrap_or(speed * time.value);
        Quantity::new(way / length, time.sd.map(|sd| sd * speed / length))
    });
    let criterion = |name, measured, limit, unit| ImoCriterion { name, measured, limit, unit };
    let [first, second] = [first_overshoot_10_10_limit_deg(particulars), second_overshoot_10_10_limit_deg(particulars)];
    vec![
        criterion("10/10 first overshoot", overshoot(10.0, 1), first, CriterionUnit::Degrees),
        criterion("10/10 second overshoot", overshoot(10.0, 2), second, CriterionUnit::Degrees),
        criterion("20/20 first overshoot", overshoot(20.0, 1), MAX_FIRST_OVERSHOOT_20_20_DEG, CriterionUnit::Degrees),
        criterion("initial turning", initial_turning, MAX_INITIAL_TURNING_LENGTHS, CriterionUnit::ShipLengths),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::{Plant, trial};
    use approx::assert_relative_eq;

    /// Length and speed of the training ship YUKUN as commonly quoted (no primary source seen): L/V = 12.2 s.
    const YUKUN: Particulars = Particulars { length: 105.0, speed: 8.59 };

    fn of_seconds(seconds: f64) -> Particulars {
        Particulars { length: seconds * 8.0, speed: 8.0 }
    }

    #[test]
    fn limits_are_those_of_the_resolution() {
        assert_relative_eq!(first_overshoot_10_10_limit_deg(YUKUN), 11.1, epsilon = 0.02);
        assert_relative_eq!(second_overshoot_10_10_limit_deg(YUKUN), 26.7, epsilon = 0.04);
        for (seconds, first, second) in
            [(9.9, 10.0, 25.0), (10.0, 10.0, 25.0), (20.0, 15.0, 32.5), (30.0, 20.0, 40.0), (60.0, 20.0, 40.0)]
        {
            assert_relative_eq!(first_overshoot_10_10_limit_deg(of_seconds(seconds)), first);
            assert_relative_eq!(second_overshoot_10_10_limit_deg(of_seconds(seconds)), second);
        }
    }

    fn table(delta_deg: f64, psi_deg: f64) -> Vec<ImoCriterion> {
        let (time, heading, rudder) = Plant::new(delta_deg, psi_deg, 2.5).record(300.0, 1.0);
        imo_criteria(&ZigZag::from_trial(&trial(time, heading, rudder)).expect("a zig-zag"), YUKUN)
    }

    fn values(table: &[ImoCriterion]) -> Vec<Option<f64>> {
        table.iter().map(|criterion| criterion.measured.map(|quantity| quantity.value)).collect()
    }

    /// Simulated YUKUN: 6.35 and 8.07 deg (10/10), 18.8 deg (20/20), 1.97 L, from an independent simulation.
    #[test]
    fn each_pair_measures_its_own_criteria() {
        let ten = table(10.0, 10.0);
        let measured = values(&ten);
        assert_relative_eq!(measured[0].expect("10/10"), 6.35, epsilon = 0.02);
        assert_relative_eq!(measured[1].expect("10/10"), 8.07, epsilon = 0.02);
        assert_eq!(measured[2], None);
        assert_relative_eq!(measured[3].expect("10/10"), 1.97, epsilon = 0.01);
        let verdicts: Vec<String> = ten.iter().map(|criterion| criterion.verdict().to_string()).collect();
        assert_eq!(verdicts, ["pass", "pass", "not measured", "pass"]);
        assert_eq!(ImoCriterion { limit: 6.0, ..ten[0].clone() }.verdict(), CriterionVerdict::Fail);

        let twenty = values(&table(20.0, 20.0));
        assert_eq!((twenty[0], twenty[1], twenty[3]), (None, None, None));
        assert_relative_eq!(twenty[2].expect("20/20"), 18.81, epsilon = 0.02);

        assert_eq!(values(&table(10.0, 20.0)), [None; 4]);
    }

    /// A ship that turns at the first execute, at a third of her maximum rate, has another first overshoot.
    #[test]
    fn a_turn_before_the_first_execute_leaves_the_second_overshoot() {
        let plant = Plant { approach: 40.0, ..Plant::new(10.0, 10.0, 2.5) };
        let (time, heading, rudder) = plant.record(300.0, 1.0);
        // The rate of the approach dies out in 10 s.
        let turned = time.iter().zip(heading).map(|(t, psi)| psi + 0.05 * (1.0 - (-(t - 40.0) / 10.0).exp().min(5.0)));
        let zigzag = ZigZag::from_trial(&trial(time.clone(), turned.collect(), rudder)).expect("a zig-zag");
        assert!(!zigzag.lacks_first_execute() && zigzag.straight_yaw_rate().is_none());
        let measured = values(&imo_criteria(&zigzag, YUKUN));
        assert!(measured[1].is_some(), "{measured:?}");
        assert_eq!([measured[0], measured[3]], [None, None]);
    }
}
