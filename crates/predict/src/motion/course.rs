//! A record cut into windows that begin at measured states, and the hull stepped through them.

use super::coefficients::PlanarCoefficients;
use super::model::LARGEST_STEP;
use super::record::{filled, smoothed};
use super::yaw::Yaw;
use trial::{Channel, Trial};

/// Length of a window in units of L/U₀: half a zig-zag of a full ship, too short for its instability to rule.
pub(crate) const WINDOW: f64 = 10.0;

/// Half width of the window in which states are smoothed, in units of L/U₀.
pub(crate) const SMOOTHED: f64 = 0.25;

/// A last window is kept if it has this share of the others.
const KEPT: f64 = 0.25;

/// Velocities beyond this many U₀ and yaw rates beyond as many U₀/L are no ship's; a bad trial step stays finite.
const FASTEST: f64 = 10.0;

/// Kinds of outputs: heading, yaw rate, surge, sway.
pub(crate) const OUTPUTS: usize = 4;

/// A record in units of L and U₀.
#[derive(Debug, Clone)]
pub(crate) struct WindowedRecord {
    /// L/U₀.
    pub time: Vec<f64>,
    /// rad.
    pub rudder: Vec<f64>,
    /// Readings of heading, yaw rate, surge and sway; NaN where there is none.
    pub readings: [Vec<f64>; OUTPUTS],
    /// The same smoothed, without gaps.
    pub states: [Vec<f64>; OUTPUTS],
    /// First and last row of every window.
    pub windows: Vec<[usize; 2]>,
}

impl WindowedRecord {
    /// `None` for a record without surge or sway.
    pub fn of(trial: &Trial, length: f64, speed: f64) -> Option<Self> {
        let has = |channel| trial.channel(channel).filter(|values| values.iter().any(|value| value.is_finite()));
        let (surge, sway) = (has(Channel::Surge)?, has(Channel::Sway)?);
        let second = length / speed;
        let time: Vec<f64> = trial.time().iter().map(|t| t / second).collect();
        let over = |values: &[f64], unit: f64| values.iter().map(|value| value / unit).collect::<Vec<_>>();
        let heading = trial.heading().to_vec();
        let (turning, slope) = smoothed(&time, &filled(&time, &heading), SMOOTHED);
        let (rate, smooth_rate) = match has(Channel::YawRate) {
            Some(rate) => {
                let rate = over(rate, 1.0 / second);
                let smooth = smoothed(&time, &filled(&time, &rate), SMOOTHED).0;
                (rate, smooth)
            }
            None => (vec![f64::NAN; time.len()], slope),
        };
        let heading = if trial.heading_from_yaw_rate() { vec![f64::NAN; time.len()] } else { heading };
        let (surge, sway) = (over(surge, speed), over(sway, speed));
        let smooth = |values: &[f64]| smoothed(&time, &filled(&time, values), SMOOTHED).0;
        let states = [turning, smooth_rate, smooth(&surge), smooth(&sway)];
        let windows = cut(&time);
        Some(Self { rudder: trial.rudder().to_vec(), readings: [heading, rate, surge, sway], states, windows, time })
    }

    /// Heading, yaw rate, surge and sway at one row.
    pub fn state(&self, row: usize) -> [f64; OUTPUTS] {
        std::array::from_fn(|i| self.states[i][row])
    }

    /// States of the hull in all rows of a window that begins at the measured state. With `driven`, surge and sway are
    /// those of the record.
    pub fn replay(
        &self,
        planar: &PlanarCoefficients,
        yaw: &Yaw,
        [first, last]: [usize; 2],
        driven: bool,
    ) -> Vec<[f64; OUTPUTS]> {
        let bounded = |value: f64| value.clamp(-FASTEST, FASTEST);
        let mut state = self.state(first);
        let mut found = Vec::with_capacity(last + 1 - first);
        found.push(state);
        for row in first + 1..=last {
            let span = self.time[row] - self.time[row - 1];
            let pieces = (span / LARGEST_STEP).ceil().max(1.0);
            let step = span / pieces;
            let between = |values: &[f64], share: f64| values[row - 1] + share * (values[row] - values[row - 1]);
            for piece in 0..pieces as usize {
                let rates = |state: [f64; OUTPUTS], place: f64| {
                    let share = place / pieces;
                    let rudder = between(&self.rudder, share);
                    let [_, r, u, v] = state;
                    let [u, v] = if driven { [2, 3].map(|i| between(&self.states[i], share)) } else { [u, v] };
                    let [surge, sway] = if driven { [0.0; 2] } else { planar.rates(u, v, r, rudder) };
                    [r, yaw.rate(u, v, r, rudder, 0.0), surge, sway]
                };
                let begin = rates(state, piece as f64);
                let middle = std::array::from_fn(|i| state[i] + 0.5 * step * begin[i]);
                let rate = rates(middle, piece as f64 + 0.5);
                let next: [f64; OUTPUTS] = std::array::from_fn(|i| state[i] + step * rate[i]);
                state = [next[0], bounded(next[1]), bounded(next[2]), bounded(next[3])];
            }
            found.push(if driven { [state[0], state[1], self.states[2][row], self.states[3][row]] } else { state });
        }
        found
    }
}

/// First and last rows of windows that follow one another.
fn cut(time: &[f64]) -> Vec<[usize; 2]> {
    let mut windows = Vec::new();
    let rows = time.len();
    let mut first = 0;
    while first + 1 < rows {
        let last = (time.partition_point(|t| *t <= time[first] + WINDOW) - 1).max(first + 1);
        if time[last] - time[first] >= KEPT * WINDOW {
            windows.push([first, last]);
        }
        first = last;
    }
    windows
}
