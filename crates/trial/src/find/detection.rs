//! Result of a search: a manoeuvre with its part of the log, and the quality of the log there. The quality is for
//! information; no manoeuvre is refused because of it.

use ship::angle::to_deg;

use super::pattern::PreparedLog;
use crate::manoeuvre::Manoeuvre;
use crate::zigzag::holds::conventional_deg;

/// Maximum share of missing headings without a remark.
const MAX_MISSING_SHARE: f64 = 0.01;

/// Minimum length of a gap, usual time steps.
const GAP_STEPS: f64 = 10.0;

/// Maximum difference between the rudder angles held to a side without a remark, degrees.
const MAX_SPREAD_DEG: f64 = 1.5;

/// Maximum change of speed and revolutions in a steady approach, as a share, from its first third to its last: 5 % over
/// its full length.
pub(crate) const MAX_APPROACH_SPEED_CHANGE: f64 = 0.033;

/// State of the ship in the approach of a manoeuvre.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum ApproachState {
    /// Steady course and speed; the part begins with the end of the approach.
    Steady,
    /// Hand steering, a turn or a changing speed; the part begins with the first execute.
    Unsteady,
    /// The log begins in the manoeuvre.
    Absent,
}

/// Quality of the part of a log that contains a manoeuvre.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct RecordingQuality {
    /// Share of the rows without a heading, 0 to 1.
    pub missing_heading_share: f64,
    /// Maximum gap of the heading, s; `None` without a gap of more than ten usual time steps.
    pub longest_gap: Option<f64>,
    /// Maximum difference between the rudder angles held to a side of a zig-zag, rad; 0 for other manoeuvres.
    pub rudder_spread: f64,
    /// Approach; `None` for a pull-out and a straight piece.
    pub approach: Option<ApproachState>,
    /// Change of speed from the first to the last third of the approach (at most a time scale long), as a share of the
    /// larger; positive for an increase; `None` if no speed was recorded.
    pub speed_change: Option<f64>,
}

impl RecordingQuality {
    /// Quality of the rows of a part, without its approach and holds.
    pub(crate) fn from_rows(record: &PreparedLog, first: usize, last: usize) -> Self {
        let (time, heading) = (&record.log.time[first..=last], &record.log.heading[first..=last]);
        let mut longest = 0.0_f64;
        let (mut read, mut missing) = (time[0], 0);
        for (&t, psi) in time.iter().zip(heading) {
            longest = longest.max(t - read);
            if psi.is_finite() { read = t } else { missing += 1 }
        }
        Self {
            missing_heading_share: f64::from(missing) / time.len() as f64,
            longest_gap: (longest > GAP_STEPS * record.rudder.step).then_some(longest),
            rudder_spread: 0.0,
            approach: None,
            speed_change: None,
        }
    }

    /// Remarks on the quality, one sentence each; empty for a good log.
    pub fn remarks(&self) -> Vec<String> {
        let approach = match self.approach {
            Some(ApproachState::Unsteady) => {
                Some("The approach was not steady; the part begins at the first execute.".into())
            }
            Some(ApproachState::Absent) => Some("The log begins within the manoeuvre, without an approach.".into()),
            Some(ApproachState::Steady) | None => None,
        };
        let speed = self.speed_change.filter(|change| change.abs() > MAX_APPROACH_SPEED_CHANGE).map(|change| {
            let verb = if change > 0.0 { "grew" } else { "fell" };
            format!("The speed {verb} by {:.0} % during the approach.", 100.0 * change.abs())
        });
        let missing = (self.missing_heading_share > MAX_MISSING_SHARE)
            .then(|| format!("{:.0} % of the headings are missing.", 100.0 * self.missing_heading_share));
        let gap = self.longest_gap.map(|gap| format!("The longest gap of the heading is {gap:.1} s."));
        let spread = to_deg(self.rudder_spread);
        let spread = (spread > MAX_SPREAD_DEG)
            .then(|| format!("The rudder angles held to one side differ by up to {spread:.1}°."));
        [approach, speed, missing, gap, spread].into_iter().flatten().collect()
    }
}

/// Manoeuvre inside a log.
#[derive(Debug, Clone, PartialEq)]
pub struct DetectedManoeuvre {
    /// Kind of manoeuvre with its angles as executed: the rudder of a zig-zag is the mean of the medians over the holds
    /// to each side, its heading the median over the executes; `None` if the ship keeps her course.
    pub manoeuvre: Option<Manoeuvre>,
    /// Time of the first row of the part to analyse, s: the first execute, or earlier if the approach was steady.
    pub start_time: f64,
    /// Time of the last row of the part, s; the rudder is still held and the propeller turns.
    pub end_time: f64,
    /// Time of the first row in which the rudder moves for this manoeuvre, s; for a straight piece its first row.
    pub first_execute_time: f64,
    /// Number of executes up to `end_time`: 1 for a turning circle or pull-out, 0 for a straight piece.
    pub execute_count: usize,
    /// Quality of the log in the part.
    pub quality: RecordingQuality,
}

impl DetectedManoeuvre {
    /// Name in lists, with conventional angles: "zig-zag 10/10", "turning circle 35 to starboard", "pull-out",
    /// "spiral", "straight".
    pub fn name(&self) -> String {
        let Some(manoeuvre) = &self.manoeuvre else { return String::from("straight") };
        let rudder = conventional(manoeuvre.max_rudder(), 0.08, 0.08);
        match manoeuvre {
            Manoeuvre::ZigZag { heading, .. } => format!("zig-zag {rudder}/{}", conventional(*heading, 0.05, 0.25)),
            Manoeuvre::TurningCircle { side, .. } => format!("turning circle {rudder} to {side}"),
            _ => manoeuvre.name().to_owned(),
        }
    }

    /// Rudder angle and change of heading as executed, rad, positive to starboard; without a sign for a zig-zag. Both
    /// are `None` for a straight piece; the change of heading is `None` for a pull-out and a spiral, too.
    pub fn angles(&self) -> [Option<f64>; 2] {
        let Some(manoeuvre) = &self.manoeuvre else { return [None; 2] };
        let (rudder, sign) = (manoeuvre.max_rudder(), manoeuvre.first_side().sign());
        match manoeuvre {
            Manoeuvre::ZigZag { heading, .. } => [Some(rudder), Some(*heading)],
            Manoeuvre::TurningCircle { heading_change, .. } => {
                [Some(sign * rudder), heading_change.map(|change| sign * change)]
            }
            _ => [Some(sign * rudder), None],
        }
    }
}

/// Conventional angle near a measured angle (rad), as text for a name; see [`conventional_deg`].
fn conventional(angle: f64, below: f64, above: f64) -> String {
    let degrees = to_deg(angle);
    conventional_deg(degrees, below, above, 0.0).map_or_else(|| format!("{degrees:.1}"), |angle| format!("{angle:.0}"))
}
