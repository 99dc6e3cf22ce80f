//! Plausibility checks of a record: movement of rudder and heading, units of the columns, and the signs of rudder,
//! heading and yaw rate. The checks use ratios that hold for ships of every size; they do not judge the execution of a
//! trial or the quality of its sensors.
//!
//! An improbable record is an error with a remedy; an unusual record gets a warning. A sidecar with
//! `plausibility = false` under `[check]` turns errors into warnings.

mod alternation;
pub(crate) mod derivative;
mod motion;
pub(crate) mod readings;
pub(crate) mod regression;
mod rudder;

use document::{Warning, WarningCode};
use estimation::statistics::upper_median;
use ship::angle::to_deg;
use thiserror::Error;

use crate::channel::Channel;
use crate::record::{RejectedReading, Trial};
use crate::wording::counted;
use alternation::sensor_disagreement;
pub use motion::count_reversals;
pub(crate) use motion::{changes, extremes, mean_rate, range};
use regression::{PartialSlope, first_order_gain, heading_on_yaw_rate, steady_turn_gain};
use rudder::rudder_movements;

/// Implausibility of a record, with angles in degrees for messages.
#[derive(Debug, Clone, PartialEq, Error)]
#[expect(missing_docs, reason = "the message of a variant says what its fields are")]
pub enum Implausibility {
    /// Neither heading nor rudder changes.
    #[error(
        "nothing moves: the heading changes by {heading_deg:.4}° and the rudder by {rudder_deg:.4}°; check that the right \
         columns and the right part of the record are used"
    )]
    NothingMoves { heading_deg: f64, rudder_deg: f64 },
    /// The rudder moves and the heading does not.
    #[error(
        "the heading stays within {heading_deg:.4}° while the rudder moves through {rudder_deg:.1}°; check that the \
         heading sensor was recorded and the right column is used"
    )]
    HeadingConstant { heading_deg: f64, rudder_deg: f64 },
    /// Rudder in degrees, in a column named in radians.
    #[error(
        "the rudder reaches {largest_deg:.0}°, expected less than 92°: it looks like degrees under a name that says radians; \
         name the column rudder_deg, or write `is = \"rudder_deg\"` for it in a sidecar NAME.trial.toml; if it already has \
         that name, its numbers have another scale"
    )]
    RudderInDegrees { largest_deg: f64 },
    /// Rudder in radians, in a column named in degrees.
    #[error(
        "the rudder never exceeds {largest_deg:.3}° while the heading moves through {heading_deg:.0}°: it looks like radians \
         under a name that says degrees; name the column rudder_rad, or write `is = \"rudder_rad\"` for it in a sidecar \
         NAME.trial.toml; if it already has that name, its numbers have another scale"
    )]
    RudderInRadians { largest_deg: f64, heading_deg: f64 },
    /// Heading in degrees, in a column named in radians.
    #[error(
        "the heading moves through {heading_deg:.0}° while the rudder moves through {rudder_deg:.1}°: it looks like degrees \
         under a name that says radians; name the column heading_deg, or write `is = \"heading_deg\"` for it in a sidecar \
         NAME.trial.toml; if it already has that name, its numbers have another scale"
    )]
    HeadingInDegrees { heading_deg: f64, rudder_deg: f64 },
    /// Yaw rate in another unit than its column name states, in a record whose heading is its integral.
    #[error(
        "the yaw rate adds up to a turn of {heading_deg:.0}° while the rudder moves through {rudder_deg:.1}°: it looks \
         like deg/min under a name that says deg/s (a factor of 60), or degrees under a name that says radians (57.3); \
         name the column yaw_rate_deg_min (yaw_rate_deg_s), or write `is = \"yaw_rate_deg_min\"` for it in a sidecar \
         NAME.trial.toml"
    )]
    YawRateInMinutes { heading_deg: f64, rudder_deg: f64 },
    /// Heading in radians, in a column named in degrees.
    #[error(
        "the heading moves through {heading_deg:.2}° only while the rudder moves through {rudder_deg:.1}°: it looks like \
         radians under a name that says degrees; name the column heading_rad, or write `is = \"heading_rad\"` for it in a \
         sidecar NAME.trial.toml (if it already has that name, its numbers have another scale; if the record is right, \
         write `plausibility = false` under [check] there)"
    )]
    HeadingInRadians { heading_deg: f64, rudder_deg: f64 },
    /// A channel alternates between two sensors.
    #[error(
        "the {channel} alternates between two inputs that disagree by {apart_deg:.1}°: two sensors, or a delayed copy of \
         one; leave one of them out of the log (of a table `ignore = true` for its column, in a sidecar NAME.trial.toml)"
    )]
    TwoInputs { channel: &'static str, apart_deg: f64 },
    /// Heading and integrated yaw rate differ by the factor between two units.
    #[error(
        "the heading changes {ratio:.3} times as much as the integral of the yaw rate, expected 1: one of the two has the wrong \
         unit in its name (degrees for radians: a factor of 57.3, minutes for seconds: 60); correct the name, or write \
         `is = \"yaw_rate_rad_s\"` (yaw_rate_deg_s, yaw_rate_deg_min, heading_rad, heading_deg) for the column in a sidecar \
         NAME.trial.toml"
    )]
    YawRateUnit { ratio: f64 },
    /// Heading and integrated yaw rate have opposite signs.
    #[error(
        "heading and yaw rate have opposite signs: the heading changes {ratio:.3} times as much as the integral of the yaw \
         rate, expected 1; both are positive to starboard (clockwise), write `flip = true` for the {culprit} column in a \
         sidecar NAME.trial.toml"
    )]
    YawRateSign { ratio: f64, culprit: &'static str },
    /// The ship turns by more than a circle away from its rudder.
    #[error(
        "the rudder sign looks flipped: the heading moves through {heading_deg:.0}°, {share_percent:.0} % of it to port \
         under positive rudder; write `flip = true` for the rudder column in a sidecar NAME.trial.toml (for the heading \
         column, if the heading grows to port)"
    )]
    TurnsAgainstRudder { heading_deg: f64, share_percent: f64 },
    /// The ship turns away from its rudder.
    #[error(
        "the rudder sign looks flipped: the ship turns to port under positive rudder (K/T = {gain:.2e} 1/s², which explains \
         {share_percent:.0} % of the heading); positive rudder has to turn the ship to starboard: write `flip = true` for \
         the rudder column in a sidecar NAME.trial.toml, under [[column]] with its `name`, such as \"rudder_deg\" (for the \
         heading column, if the heading grows to port)"
    )]
    RudderFlipped { gain: f64, share_percent: f64 },
}

/// Minimum range of a movement, deg; smaller ranges are the resolution of an instrument.
const MIN_RANGE_DEG: f64 = 0.01;

/// Minimum range of a rudder that is compared with the heading, deg. The minimum amplitude in use is 5° (10° range).
const MIN_RUDDER_RANGE_DEG: f64 = 4.0;

/// Minimum range of a heading that determines the sign of the rudder, deg. A zig-zag to 1° moves it through 2° and
/// more.
const MIN_RESPONSE_DEG: f64 = 1.0;

/// Bounds of the mean rate of turn of ships and models in a manoeuvre, deg/s: minimum, maximum.
pub(crate) const MEAN_RATE_RANGE_DEG_S: [f64; 2] = [0.01, 15.0];

/// Maximum number of reversals of a manoeuvre; a dither, a pseudo-random sequence or an autopilot in waves has more
/// reversals.
const MAX_REVERSALS: usize = 24;

/// Maximum range of a heading outside a turning circle, deg. In a circle the integrals of heading and rudder grow
/// alike, and a regression cannot separate them.
const MAX_SWING_DEG: f64 = 360.0;

/// Minimum share of the heading explained by a flipped rudder, for an error. The zig-zags of KVLCC2 and Esso Osaka
/// reach 0.82 to 0.99 with the right sign (SIMMAN 2008; Wakita et al. 2022, in wind).
const ERROR_SHARE: f64 = 0.7;

/// Minimum share of the heading explained by a flipped rudder, for a warning.
const WARNING_SHARE: f64 = 0.4;

/// Checks a record and returns the warnings.
///
/// Fails with [`Implausibility`] if rudder and heading do not move, a unit is wrong by the factor between degrees and
/// radians or minutes and seconds, a channel alternates between two sensors, or the signs of rudder, heading and yaw
/// rate contradict each other. The sign of the rudder is the sign of b
/// = K/T in ψ = c₀ + c₁ t + c₂ t²/2 − a ∫ψ + b ∬δ (the first-order response, integrated twice), in a turning circle of
/// ∫δ dψ.
pub fn check_plausibility(trial: &Trial) -> Result<Vec<Warning>, Implausibility> {
    let mut warnings = Vec::from_iter(ranges(trial)?);
    two_inputs(trial)?;
    let turns = range_deg(trial.heading()) > MAX_SWING_DEG;
    let response = if turns { steady_turn_gain(trial) } else { first_order_gain(trial) };
    warnings.extend(yaw_rate(trial, response)?);
    warnings.extend(rudder_sign(trial, response)?);
    warnings.extend(rudder_movements(trial));
    warnings.extend([rate_of_turn(trial), gaps(trial), missing_headings(trial)].into_iter().flatten());
    Ok(warnings)
}

/// Range of an angle that is given in rad, deg.
fn range_deg(values: &[f64]) -> f64 {
    to_deg(range(values))
}

/// `true` if a heading in "degrees" steps by 2π: 6.28 between two readings, and no other large steps.
pub(crate) fn wraps_at_two_pi_degrees(heading: &[f64]) -> bool {
    let mut last = f64::NAN;
    let (mut wraps, mut large_steps) = (0, 0);
    for &psi in heading.iter().filter(|psi| psi.is_finite()) {
        let step_deg = to_deg(psi - last).abs();
        wraps += usize::from((step_deg - std::f64::consts::TAU).abs() < 0.3);
        large_steps += usize::from((1.0..std::f64::consts::TAU - 0.3).contains(&step_deg));
        last = psi;
    }
    wraps > 0 && large_steps == 0
}

/// Check of movement and angle units: heading and rudder move by comparable amounts.
fn ranges(trial: &Trial) -> Result<Option<Warning>, Implausibility> {
    let (heading_deg, rudder_deg) = (range_deg(trial.heading()), range_deg(trial.rudder()));
    let largest_deg = to_deg(trial.largest_rudder());
    if heading_deg < MIN_RANGE_DEG && rudder_deg < MIN_RANGE_DEG {
        return Err(Implausibility::NothingMoves { heading_deg, rudder_deg });
    }
    // 1.6 rad: no rudder exceeds 90°.
    if largest_deg > 92.0 {
        return Err(Implausibility::RudderInDegrees { largest_deg });
    }
    if heading_deg < MIN_RANGE_DEG && rudder_deg >= 1.0 {
        return Err(Implausibility::HeadingConstant { heading_deg, rudder_deg });
    }
    if rudder_deg < MIN_RANGE_DEG {
        let text = format!("the rudder stays at {largest_deg:.2}°; this record alone does not show the response to it");
        return Ok(Some(WarningCode::RudderAtRest.warning(text)));
    }
    let ratio = heading_deg / rudder_deg;
    // 40° are 0.70 rad. In a zig-zag the heading moves 0.9 to 3 times as far as the rudder, in a turning circle up to
    // about 20 times; radians in place of degrees make that 50 and more.
    if largest_deg < 0.72 {
        if heading_deg > 1.0 && ratio > 20.0 {
            return Err(Implausibility::RudderInRadians { largest_deg, heading_deg });
        }
        return Ok(Some(WarningCode::AngleUnit.warning(format!(
            "the rudder never exceeds {largest_deg:.3}°; if the angles are in radians, name the columns rudder_rad and \
             heading_rad"
        ))));
    }
    let reversals = count_reversals(trial.rudder());
    if ratio > if reversals >= 2 { 40.0 } else { 500.0 } {
        return Err(match trial.is_heading_integrated() {
            true => Implausibility::YawRateInMinutes { heading_deg, rudder_deg },
            false => Implausibility::HeadingInDegrees { heading_deg, rudder_deg },
        });
    }
    let in_radians = Implausibility::HeadingInRadians { heading_deg, rudder_deg };
    if rudder_deg >= MIN_RUDDER_RANGE_DEG && heading_deg <= 13.0 && wraps_at_two_pi_degrees(trial.heading()) {
        return Err(in_radians);
    }
    if rudder_deg >= MIN_RUDDER_RANGE_DEG && ratio < 0.05 {
        if reversals <= MAX_REVERSALS {
            return Err(in_radians);
        }
        return Ok(Some(WarningCode::AngleUnit.warning(in_radians.to_string())));
    }
    Ok(None)
}

/// Check that heading and rudder each come from a single sensor.
fn two_inputs(trial: &Trial) -> Result<(), Implausibility> {
    for (channel, values) in [(Channel::Heading, trial.heading()), (Channel::Rudder, trial.rudder())] {
        if let Some(apart) = sensor_disagreement(trial.time(), values) {
            return Err(Implausibility::TwoInputs { channel: channel.label(), apart_deg: to_deg(apart) });
        }
    }
    Ok(())
}

/// Check of the yaw rate against the heading.
fn yaw_rate(trial: &Trial, response: Option<PartialSlope>) -> Result<Option<Warning>, Implausibility> {
    let Some(slope) = heading_on_yaw_rate(trial).filter(|_| range_deg(trial.heading()) > MIN_RANGE_DEG) else {
        return Ok(None);
    };
    let ratio = slope.value;
    if slope.share < 0.9 {
        let percent = 100.0 * slope.share;
        let text = format!("the yaw rate explains only {percent:.0} % of the change of heading; check its column");
        return Ok((slope.share < 0.5).then(|| WarningCode::YawRate.warning(text)));
    }
    if (40.0..=75.0).contains(&ratio.abs()) || (40.0..=75.0).contains(&ratio.abs().recip()) {
        return Err(Implausibility::YawRateUnit { ratio });
    }
    if ratio < 0.0 {
        let heading_follows_rudder = response.is_none_or(|response| response.value > 0.0);
        let culprit = if heading_follows_rudder { "yaw-rate" } else { "heading" };
        return Err(Implausibility::YawRateSign { ratio, culprit });
    }
    Ok((!(0.8..=1.25).contains(&ratio)).then(|| {
        WarningCode::YawRate.warning(format!(
            "the heading changes {ratio:.2} times as much as the integral of the yaw rate; check the calibration of both"
        ))
    }))
}

/// Check that the ship turns to the side of the rudder.
fn rudder_sign(trial: &Trial, response: Option<PartialSlope>) -> Result<Option<Warning>, Implausibility> {
    let moved = range_deg(trial.rudder()) >= MIN_RUDDER_RANGE_DEG && range_deg(trial.heading()) >= MIN_RESPONSE_DEG;
    let Some(slope) = response.filter(|slope| moved && slope.value < 0.0) else { return Ok(None) };
    let (heading_deg, share_percent) = (range_deg(trial.heading()), 100.0 * slope.share);
    let warning = |flipped: Implausibility| Some(WarningCode::RudderSign.warning(flipped.to_string()));
    if heading_deg > MAX_SWING_DEG {
        // A circle is a single movement of the rudder: sufficient for a warning, not for an error.
        return Ok(warning(Implausibility::TurnsAgainstRudder { heading_deg, share_percent }));
    }
    let flipped = Implausibility::RudderFlipped { gain: slope.value, share_percent };
    match slope.share {
        ERROR_SHARE.. => Err(flipped),
        WARNING_SHARE.. => Ok(warning(flipped)),
        _ => Ok(None),
    }
}

/// Check of the mean rate of turn, which depends on the unit of the time.
fn rate_of_turn(trial: &Trial) -> Option<Warning> {
    if range_deg(trial.rudder()) < MIN_RUDDER_RANGE_DEG || range_deg(trial.heading()) < MIN_RESPONSE_DEG {
        return None;
    }
    let rate_deg_s = to_deg(mean_rate(trial.time(), trial.heading()));
    (!(MEAN_RATE_RANGE_DEG_S[0]..MEAN_RATE_RANGE_DEG_S[1]).contains(&rate_deg_s)).then(|| {
        WarningCode::TimeUnit.warning(format!(
            "the ship turns at {rate_deg_s:.2e}°/s on average, expected {} to {}°/s for a ship or model in a manoeuvre: \
             check the unit of the time (t_s, t_ms, t_min)",
            MEAN_RATE_RANGE_DEG_S[0], MEAN_RATE_RANGE_DEG_S[1]
        ))
    })
}

/// Maximum interval between two headings without a missing heading, usual intervals.
const MAX_INTERVAL: f64 = 1.5;

/// Warning of missing headings with their maximum gap; rejected readings have a separate warning.
fn missing_headings(trial: &Trial) -> Option<Warning> {
    let (time, read) = (trial.time(), trial.observed_rows().collect::<Vec<_>>());
    let usual = upper_median(read.windows(2).map(|rows| time[rows[1]] - time[rows[0]]))?;
    let (mut count, mut longest) = (0, (0.0, 0.0));
    for (from, to) in read.windows(2).map(|rows| (rows[0], rows[1])) {
        let (begin, gap) = (time[from], time[to] - time[from]);
        let is_in_gap = |x: &RejectedReading| x.channel == Channel::Heading && (begin..time[to]).contains(&x.time);
        if to > from + 1 && gap > MAX_INTERVAL * usual && !trial.rejected().iter().any(is_in_gap) {
            count += (gap / usual).round() as usize - 1;
            longest = if gap > longest.1 { (begin, gap) } else { longest };
        }
    }
    let (begin, gap) = longest;
    let text = || format!("{} missing; the longest gap, {gap:.1} s, begins at {begin:.1} s", counted(count, "heading"));
    (count > 0).then(|| WarningCode::MissingValues.warning(text()))
}

/// Warning of gaps in time that are long against the sampling period.
fn gaps(trial: &Trial) -> Option<Warning> {
    let period = trial.sampling_period();
    let steps = trial.time().windows(2).map(|pair| (pair[0], pair[1] - pair[0]));
    let mut longest = (0.0, 0.0);
    let (mut count, mut moved) = (0, 0);
    for (row, (begin, step)) in steps.enumerate().filter(|(_, (_, step))| *step > 10.0 * period) {
        count += 1;
        moved += usize::from(to_deg((trial.rudder()[row + 1] - trial.rudder()[row]).abs()) > MIN_RUDDER_RANGE_DEG);
        if step > longest.1 {
            longest = (begin, step);
        }
    }
    (count > 0).then(|| {
        let (begin, step) = longest;
        let under_way = match moved {
            0 => String::new(),
            _ => format!("; the rudder moved in {moved} of them at an unknown time, which makes K and T wrong"),
        };
        WarningCode::Gap.warning(format!(
            "{count} {} longer than ten sampling periods ({period:.3} s); the longest, {step:.1} s, begins at {begin:.1} s{under_way}",
            if count == 1 { "gap" } else { "gaps" }
        ))
    })
}

#[cfg(test)]
mod tests;
