//! Dimensionless record for the fit of a hull.

use estimation::statistics::upper_median;
use ship::vessel::prime::wind_accelerations;
use trial::{Channel, Trial};

use super::error::{HullFitError, MAX_DURATION_LENGTHS, MAX_INTERVAL_LENGTHS, MIN_HEADINGS};

/// Interval between averaged rows, in L/U₀.
const SPACING: f64 = 0.05;

/// Duration of the windows of a restarted replay, in L/U₀: about half a period of a zig-zag.
const WINDOW: f64 = 3.5;

/// Time over which positions are differenced for a speed, in L/U₀: over a ship length errors of a position weigh
/// little, and the path is nearly straight.
const SPEED_BASE: f64 = 1.0;

/// Minimum speed at the start of a record, relative to the approach speed: the priors do not apply to a ship that
/// gathers way.
const MIN_START_SPEED: f64 = 0.4;

/// Reference quantities that make a record dimensionless.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HullReference {
    /// Length L, m.
    pub length: f64,
    /// Approach speed U₀, m/s.
    pub speed: f64,
    /// Rate of the propeller at that speed, 1/s; `None` if it was not recorded.
    pub propeller_rate: Option<f64>,
}

impl HullReference {
    /// Reference of a trial; `None` if its length or speed is not declared.
    pub fn from_trial(trial: &Trial) -> Option<Self> {
        let particulars = trial.particulars()?;
        let rates = trial.channel(Channel::PropellerRate);
        let propeller_rate = rates.and_then(|rates| upper_median(rates.iter().copied())).filter(|rate| *rate > 0.0);
        Some(Self { length: particulars.length, speed: particulars.speed, propeller_rate })
    }

    /// Ship-length time L/U₀, s.
    pub fn ship_length_time(&self) -> f64 {
        self.length / self.speed
    }
}

/// Record in units of L and U₀.
#[derive(Debug, Clone)]
pub(super) struct HullSignals {
    /// Time, L/U₀.
    pub time: Vec<f64>,
    /// L/U₀, s.
    pub ship_length_time: f64,
    /// Heading, rad; NaN if it was not recorded.
    pub heading: Vec<f64>,
    /// Rudder angle, rad.
    pub rudder: Vec<f64>,
    /// Propeller rate relative to the rate at approach speed.
    pub n_ratio: Vec<f64>,
    /// Yaw moment as rudder angle, rad: zero for a record.
    pub moment: Vec<f64>,
    /// Surge, sway and yaw accelerations by the relative wind, divided by Y_w; `None` without a recorded wind.
    pub wind: Option<[Vec<f64>; 3]>,
    /// Speed, in units of U₀; `None` if it was not recorded and does not follow from positions.
    pub speed: Option<Vec<f64>>,
    /// Surge and sway velocity in the first row, in units of U₀.
    pub initial_velocity: [f64; 2],
    /// First rows of the windows, and the number of rows.
    pub window_bounds: Vec<usize>,
    /// First row and number of rows of the record, as a single window.
    pub whole_record: [usize; 2],
}

impl HullSignals {
    /// Signals of a record. Fails for a record with too few headings, a clock that does not fit this length and speed,
    /// or a start near rest.
    pub fn from_trial(trial: &Trial, reference: &HullReference) -> Result<Self, HullFitError> {
        let ship_length_time = reference.ship_length_time();
        let [row_interval, whole] = [trial.sampling_period(), trial.duration()].map(|time| time / ship_length_time);
        if row_interval > MAX_INTERVAL_LENGTHS || whole > MAX_DURATION_LENGTHS {
            return Err(HullFitError::ImplausibleTimes { trial: trial.name().to_owned(), row_interval, whole });
        }
        let too_few = || HullFitError::TooFewHeadings(trial.name().to_owned());
        let signals = Self::cut(trial, reference).ok_or_else(too_few)?;
        // Approach speed at the propeller rate of this record, which may differ from the reference.
        let approach = trial.particulars().map_or(reference.speed, |particulars| particulars.speed);
        let speed_ratio = signals.initial_velocity[0] * reference.length / (signals.ship_length_time * approach);
        match speed_ratio < MIN_START_SPEED {
            true => Err(HullFitError::StartsNearRest { trial: trial.name().to_owned(), speed_ratio }),
            false => Ok(signals),
        }
    }

    /// Signals of a rudder (rad) put over instantaneously on a steady approach and held for `duration` (L/U₀), without
    /// headings.
    pub fn from_held_rudder(rudder: f64, duration: f64) -> Self {
        Self {
            heading: vec![f64::NAN; 2],
            rudder: vec![rudder; 2],
            n_ratio: vec![1.0; 2],
            moment: vec![0.0; 2],
            wind: None,
            window_bounds: vec![0, 2],
            whole_record: [0, 2],
            initial_velocity: [1.0, 0.0],
            ship_length_time: 1.0,
            speed: None,
            time: vec![0.0, duration],
        }
    }

    fn cut(trial: &Trial, reference: &HullReference) -> Option<Self> {
        let rows: Vec<usize> = trial.observed_rows().collect();
        let (first, last) = (*rows.first()?, *rows.last()?);
        let record_reference = HullReference::from_trial(trial).unwrap_or(*reference);
        // Without a propeller rate the unit of speed comes from the record.
        let approach_rate =
            reference.propeller_rate.zip(record_reference.propeller_rate).map(|(reference, _)| reference);
        let speed_unit = if approach_rate.is_some() { reference.speed } else { record_reference.speed };
        let ship_length_time = reference.length / speed_unit;
        let group = ((SPACING * ship_length_time / trial.sampling_period()) as usize).max(1);
        let take = |values: &[f64]| -> Vec<f64> { values[first..=last].chunks(group).map(mean_of_read).collect() };
        let channel = |channel: Channel, unit: f64| {
            let values = filled(take(trial.channel(channel)?))?;
            Some(values.into_iter().map(|value| value / unit).collect::<Vec<f64>>())
        };
        let sway = channel(Channel::Sway, speed_unit);
        let speed = channel(Channel::Speed, speed_unit).or_else(|| {
            let surge = channel(Channel::Surge, speed_unit)?;
            Some(surge.iter().zip(sway.as_ref()?).map(|(u, v)| u.hypot(*v)).collect())
        });
        let time: Vec<f64> = take(trial.time()).into_iter().map(|t| t / ship_length_time).collect();
        let speed = speed.or_else(|| {
            let [north, east] = [Channel::North, Channel::East].map(|axis| trial.channel(axis).map(take));
            filled(over_ground(&time, &north?, &east?))
                .map(|speed| speed.iter().map(|speed| speed / reference.length).collect())
        });
        let drift = sway.as_ref().map_or(0.0, |sway| sway[0]);
        let surge = speed.as_ref().map_or(1.0, |speed| (speed[0] * speed[0] - drift * drift).max(0.0).sqrt());
        let n_ratio = approach_rate.and_then(|reference| channel(Channel::PropellerRate, reference));
        let wind = trial.relative_wind().and_then(|[speed, from]| {
            let blown: Vec<[f64; 3]> =
                speed.iter().zip(&from).map(|(wind, from)| wind_accelerations(wind / speed_unit, *from)).collect();
            let [surge, sway, yaw] = [0, 1, 2]
                .map(|axis| filled(take(&blown.iter().map(|accelerations| accelerations[axis]).collect::<Vec<f64>>())));
            Some([surge?, sway?, yaw?])
        });
        let count = time.len();
        (rows.len() >= MIN_HEADINGS).then(|| Self {
            heading: take(trial.heading()),
            rudder: take(trial.rudder()),
            n_ratio: n_ratio.unwrap_or_else(|| vec![1.0; count]),
            moment: vec![0.0; count],
            wind,
            window_bounds: window_bounds(&time),
            whole_record: [0, count],
            initial_velocity: [surge, drift],
            ship_length_time,
            time,
            speed,
        })
    }

    /// Duration of the record, L/U₀.
    pub fn duration(&self) -> f64 {
        self.time[self.time.len() - 1] - self.time[0]
    }
}

/// Speed over ground in every row: the distance between the first and the last position within half a [`SPEED_BASE`] of
/// the row, divided by the time between them (L/U₀). NaN with fewer than two positions.
///
/// It includes the current. A usual current is below 0.1 U₀, the minimum deviation of a speed; with a stronger current
/// the replay begins at a wrong speed.
fn over_ground(time: &[f64], north: &[f64], east: &[f64]) -> Vec<f64> {
    let read: Vec<usize> = (0..time.len()).filter(|&row| north[row].is_finite() && east[row].is_finite()).collect();
    let speed_at = |now: &f64| {
        let first = read.partition_point(|&row| time[row] < now - 0.5 * SPEED_BASE);
        let after = read.partition_point(|&row| time[row] <= now + 0.5 * SPEED_BASE);
        match read[first..after] {
            [from, .., to] => (north[to] - north[from]).hypot(east[to] - east[from]) / (time[to] - time[from]),
            _ => f64::NAN,
        }
    };
    time.iter().map(speed_at).collect()
}

/// First rows of successive windows, and the number of rows; a remainder of less than half a window is part of the
/// window before.
fn window_bounds(time: &[f64]) -> Vec<usize> {
    let mut window_bounds = vec![0];
    let mut from = 0;
    while time[time.len() - 1] >= time[from] + 1.5 * WINDOW {
        from = time.partition_point(|t| *t < time[from] + WINDOW);
        window_bounds.push(from);
    }
    window_bounds.push(time.len());
    window_bounds
}

/// Mean of the finite values; NaN without any.
fn mean_of_read(values: &[f64]) -> f64 {
    let read = || values.iter().filter(|value| value.is_finite());
    read().sum::<f64>() / read().count() as f64
}

/// Gaps filled with the value before, or after at the start; `None` if there is no finite value.
fn filled(mut values: Vec<f64>) -> Option<Vec<f64>> {
    let mut last = *values.iter().find(|value| value.is_finite())?;
    for value in &mut values {
        if value.is_finite() {
            last = *value;
        }
        *value = last;
    }
    Some(values)
}
