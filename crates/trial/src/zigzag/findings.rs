//! Characteristics of a zig-zag: pair, base course, executes, overshoots and times, and the errors of a record that is
//! not a zig-zag.

use std::fmt;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use ship::angle::to_deg;
use thiserror::Error;

use document::Quantity;

/// Error of a record without zig-zag characteristics.
#[derive(Debug, Clone, PartialEq, Error)]
#[expect(missing_docs, reason = "the message of a variant says what its fields are")]
pub enum ZigZagError {
    /// Rudder that stays near amidships in the whole record.
    #[error("not a zig-zag: the largest rudder angle is {largest_deg:.2} deg, a zig-zag needs {needed_deg:.1} deg")]
    NoRudder { largest_deg: f64, needed_deg: f64 },
    /// Too few movements of the rudder from one side to the opposite side.
    #[error("not a zig-zag: the rudder has {reversals} reversals from side to side, a zig-zag needs {needed}")]
    TooFewReversals { reversals: usize, needed: usize },
    /// Rudder that moves all the time, as under an autopilot or in a random manoeuvre.
    #[error(
        "not a zig-zag: the rudder is held for {:.0} % of the rows, a zig-zag needs {:.0} %", 100.0 * share, 100.0 * needed
    )]
    NotHeld { share: f64, needed: f64 },
    /// Heading that moves against the rudder between two reversals: a flipped sign, or another manoeuvre.
    #[error(
        "not a zig-zag: from {from:.1} s to {to:.1} s the rudder is at {rudder_deg:.1} deg and the heading changes by \
         {change_deg:.2} deg; is the rudder sign flipped?"
    )]
    HeadingAgainstRudder { from: f64, to: f64, rudder_deg: f64, change_deg: f64 },
    /// Missing headings at a reversal of the rudder.
    #[error("no heading within {reach:.1} s of the execute at {time:.1} s")]
    NoHeading { time: f64, reach: f64 },
}

/// Side of the ship.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Side {
    /// Right, seen forward: positive rudder, increasing heading.
    #[default]
    Starboard,
    /// Left, seen forward.
    Port,
}

impl Side {
    /// Side of a signed angle.
    pub fn from_angle(angle: f64) -> Self {
        if angle < 0.0 { Self::Port } else { Self::Starboard }
    }

    /// +1 to starboard, −1 to port.
    pub fn sign(self) -> f64 {
        match self {
            Self::Port => -1.0,
            Self::Starboard => 1.0,
        }
    }
}

impl fmt::Display for Side {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.serialize(f)
    }
}

/// Nominal rudder and heading angle δ/ψ of a zig-zag, rad; shown in whole degrees, as in 10/20 (rudder 10, heading 20).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NominalAngles {
    /// Rudder angle δ, rad.
    pub rudder: f64,
    /// Change of heading ψ at which the rudder is reversed, rad.
    pub heading: f64,
}

impl NominalAngles {
    /// `true` for the pair δ/ψ in degrees.
    pub fn is_deg(&self, delta_deg: f64, psi_deg: f64) -> bool {
        (to_deg(self.rudder) - delta_deg).abs() < 1e-6 && (to_deg(self.heading) - psi_deg).abs() < 1e-6
    }
}

impl fmt::Display for NominalAngles {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:.0}/{:.0}", to_deg(self.rudder), to_deg(self.heading))
    }
}

/// Source of the base course.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum BaseCourseSource {
    /// Mean heading of the approach, from the last change of rudder before the first execute.
    Approach,
    /// First heading: the record begins with, or less than three headings before, the first execute.
    FirstHeading,
    /// Midway between the mean headings at the executes to starboard and to port: the record begins within the trial.
    Executes,
}

/// Base course of a zig-zag.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BaseCourse {
    /// Course, rad, unwrapped.
    pub heading: Quantity,
    /// Source of the course.
    pub source: BaseCourseSource,
}

/// Execute: a movement of the rudder from one side to the other, or the first from amidships to one side.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Execute {
    /// Time at which the rudder starts to move, s, on the clock of the record.
    pub time: Quantity,
    /// Heading at that time (execute heading angle, ITTC), rad, not relative to the base course.
    pub heading: Quantity,
    /// Yaw rate at that time, rad/s; `None` if headings are missing around it.
    pub yaw_rate: Option<Quantity>,
    /// Rudder angle before, rad.
    pub rudder_before: f64,
    /// Rudder angle after, rad.
    pub rudder_after: f64,
}

impl Execute {
    /// Side to which the rudder is put.
    pub fn side(&self) -> Side {
        Side::from_angle(self.rudder_after)
    }
}

/// Overshoot: the further change of heading after the rudder is reversed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Overshoot {
    /// Index of the execute before it, in [`ZigZag::executes`].
    pub execute: usize,
    /// Time of the peak, s.
    pub peak_time: Quantity,
    /// Heading at the peak, rad.
    pub peak_heading: Quantity,
    /// Overshoot angle, rad, positive: from the heading at the execute to the peak, in the direction of the previous
    /// turn.
    ///
    /// Source: MSC.137(76); ITTC 7.5-04-02-01.
    pub angle: Quantity,
    /// Time to check yaw, s: from the execute to the peak.
    pub time_to_check_yaw: Quantity,
}

/// Characteristics of a zig-zag trial. Angles in rad, times in s; `None` or empty if the record does not contain them.
///
/// A record that begins within the trial has no first execute, and all times from it are `None`. Times from a
/// first execute are `None` if the record begins within its movement.
///
/// Source of the definitions: ITTC 7.5-04-02-01 (2017).
#[derive(Debug, Clone, PartialEq)]
pub struct ZigZag {
    /// Nominal δ/ψ, from the held rudder and the headings at the executes; `None` if the changes of heading differ by
    /// more than half their median, or if no conventional angle is near.
    pub nominal_angles: Option<NominalAngles>,
    /// Side of the first execute; `None` if the record begins within the trial.
    pub first_side: Option<Side>,
    /// Base course of the trial.
    pub base_course: BaseCourse,
    /// Executes in the order of time, including the first execute if it was recorded.
    pub executes: Vec<Execute>,
    /// Initial turning time t_a, s: from the first execute to a change of heading by the nominal ψ.
    pub initial_turning_time: Option<Quantity>,
    /// Distance travelled in that time, m: integral of the recorded speed; `None` without a speed.
    pub initial_turning_distance: Option<f64>,
    /// `true` if the record begins too near to its first reversal for a measurement of the heading there.
    pub begins_at_reversal: bool,
    /// Overshoots in the order of time, for every reversal with recorded beginning and peak.
    pub overshoots: Vec<Overshoot>,
    /// Period, s: mean time between executes to the same side. The cycle that begins with the second execute contains
    /// the initial transient and is used only if it is the only cycle.
    pub period: Option<Quantity>,
    /// Reach t_A, s: from the first execute to the base course after the second execute.
    pub reach: Option<Quantity>,
    /// Time of a complete cycle t_B, s: from the first execute to the base course after the third execute.
    pub complete_cycle_time: Option<Quantity>,
    /// Maximum |yaw rate| between the first execute and the end of the last hold, rad/s. As the maximum of many noisy
    /// slopes it is biased upwards by about one standard deviation.
    pub largest_yaw_rate: Option<Quantity>,
    /// Rate of the rudder, rad/s: median over the reversals that the sampling resolves; a lower bound if a ramp is
    /// about as long as a sampling interval; `None` if it is shorter.
    pub rudder_rate: Option<f64>,
    /// Standard deviation of the heading noise, from which the uncertainties follow, rad: declared, or a robust
    /// estimate from the record ([`super::noise_sd`]).
    pub heading_noise_sd: Option<f64>,
}

/// Maximum yaw rate at the first execute after a straight approach, as a share of the maximum of the record.
pub const MAX_APPROACH_RATE_SHARE: f64 = 0.1;

/// Tolerance of a yaw rate, standard deviations.
const TOLERANCE_SDS: f64 = 3.0;

impl ZigZag {
    /// Yaw rate at the first execute after a straight approach, rad/s: at most [`MAX_APPROACH_RATE_SHARE`] of the
    /// maximum yaw rate, within its error. `None` for a record that begins in a turn or within the trial.
    pub fn straight_yaw_rate(&self) -> Option<Quantity> {
        self.first_side?;
        let (rate, largest) = (self.executes.first()?.yaw_rate?, self.largest_yaw_rate?);
        let limit = MAX_APPROACH_RATE_SHARE * largest.value + TOLERANCE_SDS * rate.sd.unwrap_or(0.0);
        (rate.value.abs() <= limit).then_some(rate)
    }

    /// Yaw rate at the first execute after a recorded straight approach, rad/s; `None` without such an approach.
    pub fn approach_yaw_rate(&self) -> Option<Quantity> {
        self.straight_yaw_rate().filter(|_| self.base_course.source == BaseCourseSource::Approach)
    }

    /// Period over the first `executes` executes, s; `None` without a complete cycle.
    pub fn period_over(&self, executes: usize) -> Option<Quantity> {
        period(self.executes.get(..executes).unwrap_or(&self.executes), self.first_side.is_some())
    }

    /// `true` if the record begins within the trial, without its first execute.
    pub fn lacks_first_execute(&self) -> bool {
        self.first_side.is_none()
    }

    /// The n-th overshoot of the trial, counted from 1 at the second execute; `None` if the record begins within the
    /// trial (no overshoot can be counted) or does not contain that peak.
    pub fn nth_overshoot(&self, n: usize) -> Option<&Overshoot> {
        self.first_side?;
        self.overshoots.iter().find(|overshoot| overshoot.execute == n)
    }

    /// Overshoots by reversal, from the first reversal of the record to that of the last recorded peak; `None` for a
    /// reversal without a recorded peak.
    pub fn overshoots_by_execute(&self) -> impl Iterator<Item = Option<&Overshoot>> {
        let end = self.overshoots.last().map_or(0, |last| last.execute + 1);
        (usize::from(self.first_side.is_some())..end)
            .map(|execute| self.overshoots.iter().find(|overshoot| overshoot.execute == execute))
    }
}

/// Mean time between executes to the same side, s, of those that reverse the rudder; `None` without a complete cycle.
pub(super) fn period(executes: &[Execute], from_first_execute: bool) -> Option<Quantity> {
    let reversals = executes.get(usize::from(from_first_execute)..)?;
    let cycles = reversals.len().checked_sub(2).filter(|&cycles| cycles > 0)?;
    let first = usize::from(from_first_execute && cycles > 1);
    // Sums telescope: only the first and last two executes contribute an error, each divided by n.
    let cycles_used = (cycles - first) as f64;
    let total: f64 = (first..cycles).map(|index| reversals[index + 2].time.value - reversals[index].time.value).sum();
    let ends = 2.min(cycles - first);
    let ends = reversals[first..].iter().take(ends).chain(reversals[cycles..].iter().rev().take(ends));
    let variance: Option<f64> = ends.map(|execute| execute.time.sd.map(|sd| sd * sd)).sum();
    Some(Quantity::new(total / cycles_used, variance.map(|sum| sum.sqrt() / cycles_used)))
}
