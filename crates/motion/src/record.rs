//! One record as the fit sees it: what turned the ship, what is to be explained, and how fast the ship approached.

use serde::{Deserialize, Serialize};
use trial::{Channel, Trial};

use crate::error::MotionError;

/// A kind of output that the equations are fitted to.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Output {
    /// Surge velocity.
    Surge,
    /// Sway velocity.
    Sway,
    /// Speed √(u² + v²).
    Speed,
    /// Position north and east.
    Position,
}

impl Output {
    /// All kinds.
    pub const ALL: [Output; 4] = [Output::Surge, Output::Sway, Output::Speed, Output::Position];

    /// Unit of its residuals.
    pub fn unit(self) -> &'static str {
        match self {
            Output::Surge | Output::Sway | Output::Speed => "m/s",
            Output::Position => "m",
        }
    }
}

/// Half width of the window in which the slope of the heading is taken for the yaw rate, in units of L/U₀.
const WINDOW: f64 = 0.25;

/// Rows on each side of that window at least.
const FEWEST_ROWS: usize = 2;

/// Rudder angle from its first value at which the approach ends, rad (1°).
const MOVED: f64 = 0.017;

/// Rows of an approach that show a speed.
const APPROACH_ROWS: usize = 5;

/// Range of the heading from which a record of positions tells a current, rad: one circle.
const CIRCLE: f64 = std::f64::consts::TAU;

/// A record ready to be fitted.
#[derive(Debug, Clone)]
pub(crate) struct Record<'a> {
    pub name: &'a str,
    pub time: &'a [f64],
    pub rudder: &'a [f64],
    /// rad, without gaps.
    pub heading: Vec<f64>,
    /// rad/s, without gaps.
    pub yaw_rate: Vec<f64>,
    /// Columns of the outputs; one column each, two of a position.
    pub outputs: Vec<(Output, Vec<&'a [f64]>)>,
    /// m/s; `None` when it is the surge of the first row, which the fit finds.
    pub approach_speed: Option<f64>,
    /// Surge and sway, m/s, from which the fit begins.
    pub start: [f64; 2],
    /// Whether the record tells a current.
    pub current: bool,
}

/// Range of the readings that are there.
pub(crate) fn range(values: &[f64]) -> f64 {
    let ends = values
        .iter()
        .filter(|value| value.is_finite())
        .fold([f64::INFINITY, f64::NEG_INFINITY], |ends, value| [ends[0].min(*value), ends[1].max(*value)]);
    (ends[1] - ends[0]).max(0.0)
}

/// The median of what is finite.
pub(crate) fn median(values: impl Iterator<Item = f64>) -> Option<f64> {
    let mut values: Vec<f64> = values.filter(|value| value.is_finite()).collect();
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied()
}

/// Readings that are missing lie on the straight line between their neighbours, or are the nearest one.
fn filled(time: &[f64], values: &[f64]) -> Vec<f64> {
    let there: Vec<usize> = (0..values.len()).filter(|&row| values[row].is_finite()).collect();
    let mut next = 0;
    let at = |row: usize, next: usize| match (next.checked_sub(1).map(|before| there[before]), there.get(next)) {
        (Some(before), Some(&after)) => {
            let share = (time[row] - time[before]) / (time[after] - time[before]);
            values[before] + share * (values[after] - values[before])
        }
        (Some(one), None) | (None, Some(&one)) => values[one],
        (None, None) => f64::NAN,
    };
    (0..values.len())
        .map(|row| {
            while there.get(next).is_some_and(|&there| there < row) {
                next += 1;
            }
            if values[row].is_finite() { values[row] } else { at(row, next) }
        })
        .collect()
}

/// Slope of the heading in every row: a parabola by least squares over the rows within `half` seconds, at least two on
/// each side. At the ends of a record the window is one-sided and the slope is that of the parabola there.
fn slope(time: &[f64], heading: &[f64], half: f64) -> Vec<f64> {
    let rows = time.len();
    (0..rows)
        .map(|row| {
            let first = time.partition_point(|t| *t < time[row] - half).min(row.saturating_sub(FEWEST_ROWS));
            let last = time.partition_point(|t| *t <= time[row] + half).max(row + FEWEST_ROWS + 1).min(rows);
            let mut normal = nalgebra::Matrix3::zeros();
            let mut right = nalgebra::Vector3::zeros();
            let scale = (time[last - 1] - time[first]).max(f64::MIN_POSITIVE);
            for other in first..last {
                let x = (time[other] - time[row]) / scale;
                let column = nalgebra::Vector3::new(1.0, x, x * x);
                normal += column * column.transpose();
                right += column * (heading[other] - heading[row]);
            }
            normal.lu().solve(&right).map_or(0.0, |solution| solution[1] / scale)
        })
        .collect()
}

/// Speed over the rows of the approach from positions, m/s.
fn way_made(time: &[f64], north: &[f64], east: &[f64]) -> Option<f64> {
    let there = |row: &usize| north[*row].is_finite() && east[*row].is_finite();
    let (first, last) = ((0..time.len()).find(there)?, (0..time.len()).rev().find(there)?);
    (last > first).then(|| (north[last] - north[first]).hypot(east[last] - east[first]) / (time[last] - time[first]))
}

impl<'a> Record<'a> {
    /// `None` for a record without speed and position.
    ///
    /// Outputs are surge and sway where the record has them, the speed where it has no surge, positions where it lacks
    /// surge or sway. The approach speed is the median speed before the rudder has moved by 1°, when that are at
    /// least five rows; of a record of positions, the way made in these rows; otherwise the declared speed, and without
    /// one the first readings. A record of positions that tells a current takes the declared speed first.
    pub(crate) fn of(trial: &'a Trial, length: f64) -> Result<Option<Self>, MotionError> {
        let has = |channel| trial.channel(channel).filter(|values| values.iter().any(|value| value.is_finite()));
        let (surge, sway, speed) = (has(Channel::Surge), has(Channel::Sway), has(Channel::Speed));
        let position = has(Channel::North).zip(has(Channel::East)).filter(|_| surge.is_none() || sway.is_none());
        let mut outputs: Vec<(Output, Vec<&[f64]>)> = Vec::new();
        outputs.extend(surge.map(|values| (Output::Surge, vec![values])));
        outputs.extend(sway.map(|values| (Output::Sway, vec![values])));
        outputs.extend(speed.filter(|_| surge.is_none()).map(|values| (Output::Speed, vec![values])));
        outputs.extend(position.map(|(north, east)| (Output::Position, vec![north, east])));
        if surge.is_none() && speed.is_none() && position.is_none() {
            return Ok(None);
        }
        let (time, rudder) = (trial.time(), trial.rudder());
        let current = position.is_some() && range(trial.heading()) > CIRCLE;
        let still = rudder.iter().take_while(|angle| (*angle - rudder[0]).abs() < MOVED).count();
        let of_rows = |rows: usize| match (surge.or(speed), position) {
            (Some(values), _) => median(values[..rows].iter().copied()),
            (None, Some((north, east))) => way_made(&time[..rows], &north[..rows], &east[..rows]),
            (None, None) => None,
        };
        let declared = trial.particulars().map(|particulars| particulars.speed);
        let shown = if still >= APPROACH_ROWS { of_rows(still) } else { None };
        let first = of_rows(APPROACH_ROWS.min(time.len()));
        let by_position = surge.is_none() && speed.is_none();
        let known = if by_position && current { declared } else { shown.or(declared).or(first) };
        let sound = |speed: &f64| speed.is_finite() && *speed > 0.0;
        let guess = known.or(shown).or(first).filter(sound);
        let guess = guess.ok_or_else(|| MotionError::NoApproachSpeed { record: trial.name().to_owned() })?;
        let heading = filled(time, trial.heading());
        let yaw_rate = match has(Channel::YawRate) {
            Some(rate) => filled(time, rate),
            None => slope(time, &heading, WINDOW * length / guess),
        };
        let beginning = |values: Option<&[f64]>| values.and_then(|v| median(v.iter().copied().take(APPROACH_ROWS)));
        let start = [beginning(surge.or(speed)).unwrap_or(guess), beginning(sway).unwrap_or(0.0)];
        let approach_speed = known.filter(sound);
        Ok(Some(Self { name: trial.name(), time, rudder, heading, yaw_rate, outputs, approach_speed, start, current }))
    }
}
