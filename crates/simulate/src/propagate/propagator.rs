//! The interface of everything that moves a ship, and the search for a heading inside a step.

use ship::first_order::State;

use crate::gear::{RudderPath, Segment};
use crate::recording::Sampler;
use crate::root;
use crate::sample::Sample;

/// A ship on its way through one run.
pub(crate) trait Propagator {
    /// Time, s.
    fn time(&self) -> f64;

    /// Heading and yaw rate now.
    fn state(&self) -> State;

    /// End of the next smooth step, at most `until`; later than now.
    fn stride(&mut self, path: &RudderPath, until: f64) -> f64;

    /// Heading and yaw rate `h` seconds from now, without going there; within the last stride.
    fn probe(&mut self, path: &RudderPath, h: f64) -> State;

    /// Goes where the last probe looked; that time is called `to`.
    fn commit(&mut self, path: &RudderPath, to: f64);

    /// What can be recorded now.
    fn sample(&mut self, path: &RudderPath) -> Sample;

    /// Records row after row as long as nothing happens on the way, as going there step by step would, bit for bit;
    /// stops before the first row that needs a closer look, which may be the next one.
    fn coast(&mut self, _path: &RudderPath, _limits: &Limits, _rows: &mut Sampler) {}
}

/// What ends a stretch in which nothing happens.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Limits {
    /// Time before which it has to end, s.
    pub before: f64,
    /// Heading whose crossing ends it.
    pub watch: Option<AwaitedHeading>,
    /// Base course, rad, from which a diverging ship goes away.
    pub base: f64,
}

/// Heading, rad, beyond which a run has diverged: a hundred turns.
const TOO_FAR: f64 = 100.0 * std::f64::consts::TAU;

/// Whether a ship with this base course (rad) has left what can be a manoeuvre.
pub(crate) fn has_diverged(state: State, base: f64) -> bool {
    let sane = state.yaw_rate.is_finite() && (state.heading - base).abs() < TOO_FAR;
    !sane
}

/// The segment that acts at time `t` behind a dead time, found by moving `cursor` forward.
pub(crate) fn acting<'a>(path: &'a RudderPath, cursor: &mut usize, t: f64, dead_time: f64) -> &'a Segment {
    let segments = path.segments();
    // The same sum as the end of a stride, so that a stride can never have no length.
    while segments[*cursor].end + dead_time <= t {
        *cursor += 1;
    }
    &segments[*cursor]
}

/// A heading that is waited for: `side` · (ψ − base) ≥ `angle`.
#[derive(Debug, Clone, Copy)]
pub(crate) struct AwaitedHeading {
    /// Base course, rad.
    pub base: f64,
    /// +1 to starboard, −1 to port.
    pub side: f64,
    /// Deviation, rad.
    pub angle: f64,
}

/// Width, s, of the bracket at which an event counts as located.
const EVENT_TOLERANCE: f64 = 1e-13;

impl AwaitedHeading {
    /// How far the heading is beyond the deviation waited for, rad.
    pub fn excess(&self, heading: f64) -> f64 {
        self.side * (heading - self.base) - self.angle
    }

    /// Time from the beginning of a step to the first crossing in it, s.
    ///
    /// The step leads from `from`, which has not crossed, to `end` in `h` seconds, and the yaw rate is monotone in it:
    /// so the heading has at most one extremum, which is looked for when the yaw rate changes sign.
    pub fn locate(&self, from: State, end: State, h: f64, mut probe: impl FnMut(f64) -> State) -> Option<f64> {
        let before = (0.0, self.excess(from.heading));
        let mut after = (h, self.excess(end.heading));
        if after.1 < 0.0 && self.side * from.yaw_rate > 0.0 && self.side * end.yaw_rate < 0.0 {
            let rate = |h| probe(h).yaw_rate;
            let peak = root::bracketed(rate, (0.0, from.yaw_rate), (h, end.yaw_rate), EVENT_TOLERANCE);
            after = (peak, self.excess(probe(peak).heading));
        }
        if after.1 < 0.0 {
            return None;
        }
        Some(root::bracketed(|h| self.excess(probe(h).heading), before, after, EVENT_TOLERANCE))
    }
}
