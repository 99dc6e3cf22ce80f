//! A record cut into windows that begin at measured states, and the hull stepped through them.

use super::coefficients::{FASTEST, LARGEST_STEP, PlanarCoefficients};
use super::record::{filled, smoothed};
use super::yaw::Yaw;
use nalgebra::DMatrix;
use trial::{Channel, Trial};

/// Length of a window in units of L/U₀: half a zig-zag of a full ship, too short for its instability to rule.
pub(crate) const WINDOW: f64 = 10.0;

/// Half width of the window in which states are smoothed, in units of L/U₀.
pub(crate) const SMOOTHED: f64 = 0.25;

/// A last window is kept if it has this share of the others.
const KEPT: f64 = 0.25;

/// Kinds of outputs: heading, yaw rate, surge, sway.
pub(crate) const OUTPUTS: usize = 4;

/// Those of the yaw equation alone.
const OUTPUTS_OF_YAW: usize = 2;

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

    /// States of the hull minus readings in all rows of a window that begins at the measured state, zero where nothing
    /// was read: a column an output. Without coefficients of surge and sway these are as measured, and no outputs.
    pub fn errors(&self, window: usize, planar: Option<&PlanarCoefficients>, yaw: &Yaw) -> DMatrix<f64> {
        let [first, last] = self.windows[window];
        let states = self.replay(planar, yaw, [first, last]);
        let outputs = if planar.is_some() { OUTPUTS } else { OUTPUTS_OF_YAW };
        DMatrix::from_fn(states.len(), outputs, |row, output| {
            let reading = self.readings[output][first + row];
            if reading.is_finite() { states[row][output] - reading } else { 0.0 }
        })
    }

    fn replay(&self, planar: Option<&PlanarCoefficients>, yaw: &Yaw, [first, last]: [usize; 2]) -> Vec<[f64; OUTPUTS]> {
        let bounded = |value: f64| value.clamp(-FASTEST, FASTEST);
        let mut state: [f64; OUTPUTS] = std::array::from_fn(|i| self.states[i][first]);
        let mut found = vec![state];
        for row in first + 1..=last {
            let span = self.time[row] - self.time[row - 1];
            let pieces = (span / LARGEST_STEP).ceil().max(1.0);
            let step = span / pieces;
            let between = |values: &[f64], share: f64| values[row - 1] + share * (values[row] - values[row - 1]);
            for piece in 0..pieces as usize {
                let rates = |[_, r, u, v]: [f64; OUTPUTS], place: f64| {
                    let share = place / pieces;
                    let rudder = between(&self.rudder, share);
                    let driven = || [2, 3].map(|i| between(&self.states[i], share));
                    let [u, v] = if planar.is_some() { [u, v] } else { driven() };
                    let [surge, sway] = planar.map_or([0.0; 2], |planar| planar.rates(u, v, r, rudder));
                    [r, yaw.rate(u, v, r, rudder, 0.0), surge, sway]
                };
                let begin = rates(state, piece as f64);
                let middle = std::array::from_fn(|i| state[i] + 0.5 * step * begin[i]);
                let rate = rates(middle, piece as f64 + 0.5);
                let next: [f64; OUTPUTS] = std::array::from_fn(|i| state[i] + step * rate[i]);
                state = [next[0], bounded(next[1]), bounded(next[2]), bounded(next[3])];
            }
            found.push(state);
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
