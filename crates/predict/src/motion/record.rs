//! One record as the fit sees it: what turned the ship, what is to be explained, and how fast the ship approached.

use estimation::statistics::upper_median;
use serde::{Deserialize, Serialize};
use ship::Polyline;
use trial::{Channel, Trial};

use super::error::MotionError;
use crate::line::StraightLine;

/// A kind of output that the equations are fitted to.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum MotionOutput {
    /// Surge velocity.
    Surge,
    /// Sway velocity.
    Sway,
    /// Speed √(u² + v²).
    Speed,
    /// Position north and east.
    Position,
}

impl MotionOutput {
    /// All kinds.
    pub const ALL: [MotionOutput; 4] =
        [MotionOutput::Surge, MotionOutput::Sway, MotionOutput::Speed, MotionOutput::Position];
}

/// Half width of the window in which the slope of the heading is taken for the yaw rate, in units of L/U₀.
const WINDOW: f64 = 0.25;

/// Rows on each side of that window at least.
const FEWEST_ROWS: usize = 2;

/// Rudder angle from its first value at which the approach ends, rad (1°).
const MOVED: f64 = 0.017;

/// Heading from its first value at which it ends as well, rad (3°).
const STRAIGHT: f64 = 0.05;

/// Rows of an approach that show a speed.
const APPROACH_ROWS: usize = 5;

/// Standard deviation of a declared approach speed, and of that from the first readings, as a share of it.
const DECLARED: f64 = 0.01;

/// An approach is never steadier than this share of its speed.
const SUREST: f64 = 1e-3;

/// Range of the heading from which a record of positions tells a current, rad: one circle.
const CIRCLE: f64 = std::f64::consts::TAU;

/// The approach speed and how surely it is known, m/s.
#[derive(Debug, Clone, Copy)]
pub(crate) struct ApproachSpeed {
    /// From which the fit begins.
    pub speed: f64,
    pub deviation: f64,
    /// Whether what is known is that it equals the surge of the first row, and not the speed above.
    pub is_start: bool,
}

/// A record ready to be fitted.
#[derive(Debug, Clone)]
pub(crate) struct MotionRecord<'a> {
    pub name: &'a str,
    pub time: &'a [f64],
    pub rudder: &'a [f64],
    /// rad, without gaps.
    pub heading: Vec<f64>,
    /// rad/s, without gaps.
    pub yaw_rate: Vec<f64>,
    /// Columns of the outputs; one column each, two of a position.
    pub outputs: Vec<(MotionOutput, Vec<&'a [f64]>)>,
    /// What is known of the approach speed before the fit.
    pub approach: ApproachSpeed,
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

/// Readings that are missing lie on the straight line between their neighbours, or are the nearest one; NaN without
/// any.
pub(crate) fn filled(time: &[f64], values: &[f64]) -> Vec<f64> {
    let (known, read) = time.iter().zip(values).filter(|(_, value)| value.is_finite()).unzip();
    let line = Polyline::new(known, read);
    time.iter().map(|time| line.as_ref().map_or(f64::NAN, |line| line.at(*time))).collect()
}

/// Value and slope of a signal in every row: a parabola by least squares over the rows within `half` seconds, at least
/// two on each side. At the ends of a record the window is one-sided and both are those of the parabola there.
pub(crate) fn smoothed(time: &[f64], values: &[f64], half: f64) -> (Vec<f64>, Vec<f64>) {
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
                right += column * (values[other] - values[row]);
            }
            normal
                .lu()
                .solve(&right)
                .map_or((values[row], 0.0), |solution| (values[row] + solution[0], solution[1] / scale))
        })
        .unzip()
}

/// Mean and its standard deviation.
fn mean(values: &[f64]) -> Option<[f64; 2]> {
    let there: Vec<f64> = values.iter().copied().filter(|value| value.is_finite()).collect();
    let count = there.len() as f64;
    let mean = there.iter().sum::<f64>() / count;
    let square: f64 = there.iter().map(|value| (value - mean).powi(2)).sum();
    (there.len() >= 2).then(|| [mean, (square / (count - 1.0) / count).sqrt()])
}

/// Speed and its standard deviation from the straight lines through positions, m/s.
fn way_made(time: &[f64], position: [&[f64]; 2]) -> Option<[f64; 2]> {
    let line = |values: &[f64]| StraightLine::through(time.iter().copied().zip(values.iter().copied()));
    let [north, east] = position.map(line);
    let (north, east) = (north?, east?);
    Some([north.slope.hypot(east.slope), north.slope_sd().max(east.slope_sd())])
}

impl<'a> MotionRecord<'a> {
    /// `None` for a record without speed and position.
    ///
    /// Outputs are surge and sway where the record has them, the speed where it has no surge, positions where it lacks
    /// surge or sway. [`fit()`](super::fit::fit()) says where the approach speed is from.
    pub(crate) fn of(trial: &'a Trial, length: f64) -> Result<Option<Self>, MotionError> {
        let has = |channel| trial.channel(channel).filter(|values| values.iter().any(|value| value.is_finite()));
        let (surge, sway, speed) = (has(Channel::Surge), has(Channel::Sway), has(Channel::Speed));
        let position = has(Channel::North).zip(has(Channel::East)).filter(|_| surge.is_none() || sway.is_none());
        let mut outputs: Vec<(MotionOutput, Vec<&[f64]>)> = Vec::new();
        outputs.extend(surge.map(|values| (MotionOutput::Surge, vec![values])));
        outputs.extend(sway.map(|values| (MotionOutput::Sway, vec![values])));
        outputs.extend(speed.filter(|_| surge.is_none()).map(|values| (MotionOutput::Speed, vec![values])));
        outputs.extend(position.map(|(north, east)| (MotionOutput::Position, vec![north, east])));
        if surge.is_none() && speed.is_none() && position.is_none() {
            return Ok(None);
        }
        let (time, rudder) = (trial.time(), trial.rudder());
        let current = position.is_some() && range(trial.heading()) > CIRCLE;
        let heading = filled(time, trial.heading());
        let is_straight =
            |row: &usize| (rudder[*row] - rudder[0]).abs() < MOVED && (heading[*row] - heading[0]).abs() < STRAIGHT;
        let still = (0..time.len()).take_while(is_straight).count();
        let of_rows = |rows: usize| match (surge.or(speed), position) {
            (Some(values), _) => mean(&values[..rows]),
            (None, Some((north, east))) => way_made(&time[..rows], [&north[..rows], &east[..rows]]),
            (None, None) => None,
        };
        let sound = |[speed, deviation]: &[f64; 2]| speed.is_finite() && *speed > 0.0 && deviation.is_finite();
        let declared = trial.particulars().map(|own| [own.speed, DECLARED * own.speed]).filter(sound);
        let shown = Some(still).filter(|still| *still >= APPROACH_ROWS).and_then(of_rows).filter(sound);
        let first = of_rows(APPROACH_ROWS.min(time.len())).filter(sound).map(|[speed, _]| [speed, DECLARED * speed]);
        let over_ground = surge.is_none() && speed.is_none() && current;
        let known = if over_ground { declared } else { shown.or(declared).or(first) };
        let [guess, deviation] = known
            .or(shown.or(first).map(|[speed, _]| [speed, 0.0]))
            .ok_or_else(|| MotionError::NoApproachSpeed { record: trial.name().to_owned() })?;
        let deviation = deviation.max(SUREST * guess);
        let approach = ApproachSpeed { speed: guess, deviation, is_start: known.is_none() };
        let yaw_rate = match has(Channel::YawRate) {
            Some(rate) => filled(time, rate),
            None => smoothed(time, &heading, WINDOW * length / guess).1,
        };
        let beginning =
            |values: Option<&[f64]>| values.and_then(|v| upper_median(v.iter().copied().take(APPROACH_ROWS)));
        let start = [beginning(surge.or(speed)).unwrap_or(guess), beginning(sway).unwrap_or(0.0)];
        Ok(Some(Self { name: trial.name(), time, rudder, heading, yaw_rate, outputs, approach, start, current }))
    }
}
