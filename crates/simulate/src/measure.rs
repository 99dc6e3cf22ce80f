//! Measurement: from the true motion to a record, with instruments, clocks and drop-outs. A [`PerfectReadings`]
//! contains the readings of perfect instruments; [`with_sensor_errors`] adds the random errors of one record.
//!
//! Source: Gilbert (1960), Bell System Technical Journal 39:1253-1265, for bursts of lost rows.
#![expect(non_snake_case, reason = "U is the symbol of the field for the speed of a ship")]

use std::collections::BTreeMap;

use rand::rngs::ChaCha8Rng;
use ship::Particulars;
use trial::{Channel, Columns};

use crate::compass_error::{CompassErrorPath, CompassErrorPoint, CompassReader};
use crate::display::DisplayReading;
use crate::disturbance::{Wind, gusting_speed};
use crate::gear::RudderPath;
use crate::helm::HelmOrder;
use crate::run::RunResult;
use crate::sample::Sample;
use crate::sensor::{DropOut, Sensors, quantise};
use crate::stream::{RngPurpose, StreamKey, normal, uniform};
use crate::wave_path::SeaWaves;

/// Tolerance, s, for equal instants.
const INSTANT_TOLERANCE_S: f64 = 1e-9;

/// True run at the instants of the instruments.
pub(crate) struct TrueRunView<'a> {
    /// Motion at the instants of the readings.
    pub samples: &'a [Sample],
    /// Deviation of the sampling instants from their stamps, s; empty without jitter.
    pub jitter: &'a [f64],
    /// Rudder path, executes and readings of the helmsman.
    pub run: &'a RunResult,
    /// Rudder path reconstructed from the orders; `None` if the rudder feedback is recorded.
    pub assumed: Option<&'a RudderPath>,
    /// Rudder order before the first execute, rad; `None` if there is no order.
    pub approach_order: Option<f64>,
    /// Wind; `None` in a calm.
    pub wind: Option<Wind>,
    /// Length and approach speed of the ship; `None` if unknown.
    pub particulars: Option<Particulars>,
}

/// Readings of perfect instruments, column by column, without waves.
#[derive(Debug, Clone)]
pub(crate) struct PerfectReadings {
    /// Time stamps of the rows, s.
    stamps: Vec<f64>,
    /// Instants of the readings of moving quantities, s.
    instants: Vec<f64>,
    /// Heading after the lag of the gyrocompass, rad.
    gyro: Vec<f64>,
    /// Yaw rate, rad/s.
    yaw_rate: Vec<f64>,
    /// Recorded rudder, rad.
    rudder: Vec<f64>,
    /// `true` if an instrument measures the rudder, `false` if it is reconstructed from the orders.
    rudder_is_read: bool,
    /// Channels without instrument errors.
    exact: Vec<(Channel, Vec<f64>)>,
    /// Readings of the helmsman, in the order of time.
    readings: Vec<DisplayReading>,
}

/// Record as columns without the lost rows, and the flags of the kept rows.
pub(crate) struct WrittenRows {
    pub columns: Columns,
    /// For every row before drop-outs, `true` if it is kept; `None` if all are kept.
    pub kept: Option<Vec<bool>>,
}

impl PerfectReadings {
    /// `true` if the records of all keys have the same times and the same rudder.
    pub fn has_common_rudder(&self, sensors: &Sensors) -> bool {
        let is_disturbed = self.rudder_is_read && sensors.rudder_noise > 0.0;
        let loses_rows = sensors.drop_out.whole_row && sensors.drop_out.can_lose_rows();
        !(is_disturbed || loses_rows)
    }

    /// Readings of all instruments in every row; `stamps` in s.
    pub fn new(stamps: Vec<f64>, view: &TrueRunView) -> Self {
        let column = |value: fn(&Sample) -> f64| view.samples.iter().map(value).collect::<Vec<f64>>();
        let jitter = |row: usize| view.jitter.get(row).copied().unwrap_or(0.0);
        let rows = || stamps.iter().enumerate();
        let path = &view.run.path;
        let rudder = match view.assumed {
            None => path.angles_at(rows().map(|(row, &stamp)| stamp + jitter(row))),
            Some(path) => path.angles_at(stamps.iter().copied()),
        };
        let mut exact = Vec::new();
        if let Some(first) = view.approach_order {
            let order = |(row, &stamp): (usize, &f64)| order_at(&view.run.executes, first, stamp + jitter(row));
            exact.push((Channel::RudderOrder, rows().map(order).collect()));
        }
        let optional = |value: fn(&Sample) -> Option<f64>| view.samples.iter().map(value).collect::<Option<Vec<f64>>>();
        exact.extend(optional(|sample| sample.motion.speed).map(|speed| (Channel::Speed, speed)));
        exact.extend(optional(|sample| sample.motion.sway).map(|sway| (Channel::Sway, sway)));
        exact.extend(wind_channels(view));
        Self {
            instants: column(|sample| sample.time),
            gyro: column(|sample| sample.gyro),
            yaw_rate: column(|sample| sample.motion.yaw_rate),
            rudder,
            rudder_is_read: view.assumed.is_none(),
            exact,
            readings: view.run.readings.clone(),
            stamps,
        }
    }
}

/// Record of `perfect_readings` with the random errors of `key`.
pub(crate) fn with_sensor_errors(
    sensors: &Sensors,
    perfect_readings: &PerfectReadings,
    waves: SeaWaves,
    key: &StreamKey,
) -> WrittenRows {
    let mut rudder = perfect_readings.rudder.clone();
    if perfect_readings.rudder_is_read {
        disturb(&mut rudder, sensors.rudder_noise, key.rng(RngPurpose::Rudder));
        quantise_all(&mut rudder, sensors.rudder_quantum);
    }
    let (channels, kept) = channels_with_errors(sensors, perfect_readings, waves, key);
    let mut columns = Columns { time: perfect_readings.stamps.clone(), channels, unknown_columns: Vec::new() };
    columns.channels.insert(Channel::Rudder, rudder);
    if let Some(kept) = &kept {
        retain_flagged(&mut columns.time, kept);
        columns.channels.values_mut().for_each(|values| retain_flagged(values, kept));
    }
    WrittenRows { columns, kept }
}

/// Channels of `perfect_readings`, all but the rudder, with the random errors of `key`, and the flags of
/// [`WrittenRows`].
pub(crate) fn channels_with_errors(
    sensors: &Sensors,
    perfect_readings: &PerfectReadings,
    waves: SeaWaves,
    key: &StreamKey,
) -> (BTreeMap<Channel, Vec<f64>>, Option<Vec<bool>>) {
    let (mut heading, yaw_rate) = compass_and_rate(sensors, perfect_readings, waves, key);
    let mut channels: BTreeMap<Channel, Vec<f64>> = perfect_readings.exact.iter().cloned().collect();
    if let Some(yaw_rate) = yaw_rate {
        channels.insert(Channel::YawRate, yaw_rate);
    }

    let lost = lost_rows(&sensors.drop_out, perfect_readings.stamps.len(), key);
    let mut kept: Option<Vec<bool>> = None;
    if let Some(lost) = lost {
        if sensors.drop_out.whole_row {
            kept = Some(lost.into_iter().map(|lost| !lost).collect());
        } else {
            for (psi, _) in heading.iter_mut().zip(&lost).filter(|(_, lost)| **lost) {
                *psi = f64::NAN;
            }
        }
    }
    channels.insert(Channel::Heading, heading);
    (channels, kept)
}

/// Removes the values of the rows whose flag is `false`.
pub(crate) fn retain_flagged<T>(values: &mut Vec<T>, kept: &[bool]) {
    let mut rows = kept.iter();
    values.retain(|_| *rows.next().unwrap_or(&false));
}

/// Adds white noise of standard deviation `sd`, in the unit of the column; for `sd` = 0 no random numbers are used.
fn disturb(column: &mut [f64], sd: f64, mut rng: ChaCha8Rng) {
    if sd > 0.0 {
        column.iter_mut().for_each(|x| *x += sd * normal(&mut rng));
    }
}

fn quantise_all(column: &mut [f64], quantum: f64) {
    if quantum > 0.0 {
        column.iter_mut().for_each(|x| *x = quantise(*x, quantum));
    }
}

fn compass_and_rate(
    sensors: &Sensors,
    perfect_readings: &PerfectReadings,
    mut waves: SeaWaves,
    key: &StreamKey,
) -> (Vec<f64>, Option<Vec<f64>>) {
    let (mut heading, mut yaw_rate) = (
        perfect_readings.gyro.clone(),
        sensors.has_rate_of_turn_indicator().then(|| perfect_readings.yaw_rate.clone()),
    );
    if !waves.is_empty() {
        for (row, &instant) in perfect_readings.instants.iter().enumerate() {
            let [wave, wave_rate] = waves.heading_and_rate_at(instant);
            heading[row] += wave;
            yaw_rate.iter_mut().for_each(|yaw_rate| yaw_rate[row] += wave_rate);
        }
    }
    heading.iter_mut().for_each(|psi| *psi += sensors.heading_bias);
    if let Some(process) = sensors.heading_wander {
        let points: Vec<CompassErrorPoint> =
            perfect_readings.readings.iter().map(DisplayReading::compass_error_point).collect();
        let errors =
            CompassErrorPath::new(process, CompassReader::Record, key).errors_at(&perfect_readings.instants, &points);
        heading.iter_mut().zip(errors).for_each(|(psi, error)| *psi += error);
    }
    // Sampled in every row, used or not, so that readings of the helmsman do not change later random numbers.
    disturb(&mut heading, sensors.heading_noise, key.rng(RngPurpose::Heading));
    quantise_all(&mut heading, sensors.heading_quantum);
    if !perfect_readings.readings.is_empty() {
        for (psi, &instant) in heading.iter_mut().zip(&perfect_readings.instants) {
            if let Some(reading) = reading_at(&perfect_readings.readings, instant) {
                *psi = reading.heading;
            }
        }
    }
    spoil(&mut heading, sensors, key);
    if let Some(yaw_rate) = &mut yaw_rate {
        let [noise, bias, scale_error] = [sensors.yaw_rate_noise, sensors.yaw_rate_bias, sensors.yaw_rate_scale_error]
            .map(Option::unwrap_or_default);
        yaw_rate.iter_mut().for_each(|r| *r = (1.0 + scale_error) * *r + bias);
        disturb(yaw_rate, noise, key.rng(RngPurpose::YawRate));
    }
    (heading, yaw_rate)
}

/// Adds the faults between compass and record to a heading (rad): spikes, and rows without a heading (NaN).
fn spoil(heading: &mut [f64], sensors: &Sensors, key: &StreamKey) {
    if let Some(spikes) = sensors.heading_spikes {
        let mut rng = key.rng(RngPurpose::HeadingSpikes);
        for psi in heading.iter_mut() {
            // Both are sampled in every row, so that another probability does not change later random numbers.
            let (hit, to_port) = (uniform(&mut rng) < spikes.probability, uniform(&mut rng) < 0.5);
            if hit {
                *psi = quantise(*psi + if to_port { -spikes.size } else { spikes.size }, sensors.heading_quantum);
            }
        }
    }
    if let Some(every) = sensors.heading_every_rows {
        let between = |(row, psi)| (row % every != 0).then_some(psi);
        heading.iter_mut().enumerate().filter_map(between).for_each(|psi: &mut f64| *psi = f64::NAN);
    }
}

/// Reading of the helmsman at time `t`, s; `None` without a reading at this time.
fn reading_at(readings: &[DisplayReading], t: f64) -> Option<&DisplayReading> {
    let at = readings.partition_point(|reading| reading.time < t - INSTANT_TOLERANCE_S);
    readings.get(at).filter(|reading| reading.time <= t + INSTANT_TOLERANCE_S)
}

fn order_at(executes: &[HelmOrder], first: f64, t: f64) -> f64 {
    let given = executes.partition_point(|execute| execute.time <= t);
    if given == 0 { first } else { executes[given - 1].ordered_rudder }
}

fn wind_channels(view: &TrueRunView) -> Vec<(Channel, Vec<f64>)> {
    let Some((wind, mean)) = view.wind.and_then(|wind| Some((wind, wind.speed?))) else { return Vec::new() };
    let speeds: Vec<f64> = view.samples.iter().map(|sample| gusting_speed(mean, sample.gust_factor)).collect();
    let ship = |sample: &Sample| sample.motion.speed.or(view.particulars.map(|particulars| particulars.speed));
    let relative: Option<Vec<(f64, f64)>> = view
        .samples
        .iter()
        .zip(&speeds)
        .map(|(sample, &speed)| ship(sample).map(|U| wind.relative_wind(speed, U, sample.motion.heading)))
        .collect();
    let mut channels = Vec::new();
    if let Some(relative) = relative {
        let (speed, from) = relative.into_iter().unzip();
        channels.extend([(Channel::WindRelativeSpeed, speed), (Channel::WindRelativeFrom, from)]);
    }
    channels.push((Channel::WindTrueFrom, vec![wind.from_direction; speeds.len()]));
    channels.push((Channel::WindTrueSpeed, speeds));
    channels
}

/// For every row, `true` if it is lost; `None` if no row can be lost.
fn lost_rows(drop_out: &DropOut, rows: usize, key: &StreamKey) -> Option<Vec<bool>> {
    if !drop_out.can_lose_rows() {
        return None;
    }
    let mut rng: ChaCha8Rng = key.rng(RngPurpose::DropOut);
    let mut lost: Vec<bool> = (0..rows).map(|_| uniform(&mut rng) < drop_out.probability).collect();
    if let (Some(probability), Some(mean_rows)) = (drop_out.burst_probability, drop_out.burst_mean_rows) {
        let mut rng = key.rng(RngPurpose::Burst);
        let mut inside = false;
        for lost in &mut lost {
            let draw = uniform(&mut rng);
            inside = if inside { draw >= 1.0 / mean_rows } else { draw < probability };
            *lost |= inside;
        }
    }
    Some(lost)
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    #[test]
    fn bursts_have_their_mean_length_and_frequency() {
        let drop_out = DropOut { burst_probability: Some(0.01), burst_mean_rows: Some(8.0), ..DropOut::default() };
        let rows = 200_000;
        let lost = lost_rows(&drop_out, rows, &StreamKey::default()).expect("bursts are asked for");
        let begun = lost.windows(2).filter(|pair| !pair[0] && pair[1]).count();
        let share = lost.iter().filter(|lost| **lost).count() as f64 / rows as f64;
        // Stationary share p/(p + 1/m); some 1800 bursts, so the standard error of the mean length is about 2.4 %.
        assert_relative_eq!(share, 0.01 / (0.01 + 0.125), max_relative = 0.08);
        assert_relative_eq!(share * rows as f64 / begun as f64, 8.0, max_relative = 0.08);
    }
}
