//! Interface of a propagator, and event location: the instant within a step at which the heading reaches the angle of
//! the next execute.

use ship::first_order::YawState;

use crate::gear::{RudderPath, RudderSegment};
use crate::recording::Sampler;
use crate::root;
use crate::sample::Sample;

/// Motion of a ship through one run.
pub(crate) trait Propagator {
    /// Current time, s.
    fn time(&self) -> f64;

    /// Heading and yaw rate at the current time.
    fn state(&self) -> YawState;

    /// End of the next smooth step, at most `until` and after the current time, s.
    fn stride(&mut self, path: &RudderPath, until: f64) -> f64;

    /// Trial state: heading and yaw rate `h` seconds ahead, within the last stride.
    fn probe(&mut self, path: &RudderPath, h: f64) -> YawState;

    /// Advances to the state of the last probe, at time `to`.
    fn commit(&mut self, path: &RudderPath, to: f64);

    /// Sample at the current time.
    fn sample(&mut self, path: &RudderPath) -> Sample;

    /// Records rows up to the first event, bit for bit equal to single steps; stops before the first row that requires
    /// the stepwise search, which can be the next row.
    fn record_rows(&mut self, _path: &RudderPath, _limits: &RowLimits, _rows: &mut Sampler) {}
}

/// Limits up to which rows are recorded in one call: time, heading of the next execute and base course.
#[derive(Debug, Clone, Copy)]
pub(crate) struct RowLimits {
    /// End of the recorded rows, s; a row at this time is not recorded.
    pub before: f64,
    /// Heading whose crossing ends the sequence; `None` if no heading triggers the next execute.
    pub watch: Option<AwaitedHeading>,
    /// Base course, rad, for the check of divergence.
    pub base: f64,
}

/// Maximum deviation from the base course, rad: a hundred turns; beyond it a run has diverged.
const MAX_DEVIATION_RAD: f64 = 100.0 * std::f64::consts::TAU;

/// `true` if the motion has diverged from the base course (rad).
pub(crate) fn has_diverged(state: YawState, base: f64) -> bool {
    let is_valid = state.yaw_rate.is_finite() && (state.heading - base).abs() < MAX_DEVIATION_RAD;
    !is_valid
}

/// Acting segment at time `t` after the dead time; `cursor` moves forward to it.
pub(crate) fn acting_segment<'a>(
    path: &'a RudderPath,
    cursor: &mut usize,
    t: f64,
    dead_time: f64,
) -> &'a RudderSegment {
    let segments = path.segments();
    // Same sum as the end of a stride, so that a stride never has zero length.
    while segments[*cursor].end + dead_time <= t {
        *cursor += 1;
    }
    &segments[*cursor]
}

/// Heading that triggers the next execute: `side` · (ψ − base) ≥ `angle`.
#[derive(Debug, Clone, Copy)]
pub(crate) struct AwaitedHeading {
    /// Base course, rad.
    pub base: f64,
    /// +1 to starboard, −1 to port.
    pub side: f64,
    /// Deviation, rad.
    pub angle: f64,
}

/// Width of the bracket, s, below which an event is located.
const EVENT_TOLERANCE: f64 = 1e-13;

impl AwaitedHeading {
    /// Excess of the deviation of a heading (rad) over the deviation at the execute, rad; negative before the execute.
    pub fn excess(&self, heading: f64) -> f64 {
        self.side * (heading - self.base) - self.angle
    }

    /// Time from the beginning of a step to the first crossing in it, s; `None` without a crossing.
    ///
    /// The step leads from `from`, before the crossing, to `end` in `h` seconds. The yaw rate is monotone in the step,
    /// so the heading has at most one extremum, which is located when the yaw rate changes sign.
    pub fn first_crossing(
        &self,
        from: YawState,
        end: YawState,
        h: f64,
        mut probe: impl FnMut(f64) -> YawState,
    ) -> Option<f64> {
        let before = (0.0, self.excess(from.heading));
        let mut after = (h, self.excess(end.heading));
        if after.1 < 0.0 && self.side * from.yaw_rate > 0.0 && self.side * end.yaw_rate < 0.0 {
            let rate = |h| probe(h).yaw_rate;
            let peak = root::bracketed_root(rate, (0.0, from.yaw_rate), (h, end.yaw_rate), EVENT_TOLERANCE);
            after = (peak, self.excess(probe(peak).heading));
        }
        if after.1 < 0.0 {
            return None;
        }
        Some(root::bracketed_root(|h| self.excess(probe(h).heading), before, after, EVENT_TOLERANCE))
    }
}
