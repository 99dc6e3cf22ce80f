//! From what happened to what was written down: instruments, clocks and drop-outs applied to the samples of a run.
#![expect(non_snake_case, reason = "U is the symbol of the field for the speed of a ship")]

use std::collections::BTreeMap;

use rand::rngs::ChaCha8Rng;
use ship::Particulars;
use trial::{Channel, Columns};

use crate::display::Reading;
use crate::disturbance::{Wind, gusting_speed};
use crate::gear::RudderPath;
use crate::propagate::Sample;
use crate::run::Wake;
use crate::sensor::{DropOut, Loses, Sensors, quantise};
use crate::simulation::Execute;
use crate::stream::{Purpose, StreamKey, normal, uniform};
use crate::wave_path::Waves;

/// Two instants closer together than this, s, are one.
const SAME_INSTANT: f64 = 1e-9;

/// What the instruments are held against, row by row.
pub(crate) struct Scene<'a> {
    /// Stamps of the rows, s.
    pub stamps: &'a [f64],
    /// What moves, at the instants it is read.
    pub samples: &'a [Sample],
    /// Deviation of the sampling instants from their stamps, s; empty for none.
    pub jitter: &'a [f64],
    /// Rudder, executes and readings of the helmsman.
    pub wake: &'a Wake,
    /// The rudder as somebody rebuilds it from the orders; `None` where it is recorded.
    pub assumed: Option<&'a RudderPath>,
    /// Rudder order before the first execute, rad; `None` where nobody gave orders.
    pub first_order: Option<f64>,
    /// The wind, where it blows.
    pub wind: Option<Wind>,
    /// Length and approach speed of the ship, where known.
    pub particulars: Option<Particulars>,
}

/// The record as columns, and which rows are left of it.
pub(crate) struct Written {
    pub columns: Columns,
    /// `None` when every row is left.
    pub kept: Option<Vec<bool>>,
}

/// Reads every instrument in every row.
pub(crate) fn write(sensors: &Sensors, scene: &Scene, waves: Waves, key: &StreamKey) -> Written {
    let (mut heading, yaw_rate) = compass_and_rate(sensors, scene, waves, key);
    let jitter = |row: usize| scene.jitter.get(row).copied().unwrap_or(0.0);

    let mut rng = key.rng(Purpose::Rudder);
    let feedback = |(row, &stamp): (usize, &f64)| {
        let noise = if sensors.rudder.noise > 0.0 { sensors.rudder.noise * normal(&mut rng) } else { 0.0 };
        quantise(scene.wake.path.at(stamp + jitter(row)) + noise, sensors.rudder.quantum)
    };
    let rudder = match scene.assumed {
        None => scene.stamps.iter().enumerate().map(feedback).collect(),
        Some(path) => scene.stamps.iter().map(|&stamp| path.at(stamp)).collect(),
    };

    let mut channels = BTreeMap::new();
    channels.insert(Channel::Rudder, rudder);
    if let Some(first) = scene.first_order {
        let order = |(row, &stamp): (usize, &f64)| order_at(&scene.wake.executes, first, stamp + jitter(row));
        channels.insert(Channel::RudderOrder, scene.stamps.iter().enumerate().map(order).collect());
    }
    if let Some(yaw_rate) = yaw_rate {
        channels.insert(Channel::YawRate, yaw_rate);
    }
    if let Some(speed) = scene.samples.iter().map(|sample| sample.motion.speed).collect() {
        channels.insert(Channel::Speed, speed);
    }
    if let Some(sway) = scene.samples.iter().map(|sample| sample.motion.sway).collect() {
        channels.insert(Channel::Sway, sway);
    }
    write_wind(scene, &mut channels);

    let lost = lost_rows(&sensors.drop_out, scene.stamps.len(), key);
    let mut kept: Option<Vec<bool>> = None;
    if let Some(lost) = lost {
        match sensors.drop_out.loses {
            Loses::Heading => {
                for (psi, _) in heading.iter_mut().zip(&lost).filter(|(_, lost)| **lost) {
                    *psi = f64::NAN;
                }
            }
            Loses::Row => kept = Some(lost.into_iter().map(|lost| !lost).collect()),
        }
    }
    channels.insert(Channel::Heading, heading);
    let mut columns = Columns { time: scene.stamps.to_vec(), channels, unknown: Vec::new() };
    if let Some(kept) = &kept {
        keep(&mut columns.time, kept);
        columns.channels.values_mut().for_each(|values| keep(values, kept));
    }
    Written { columns, kept }
}

/// Leaves the rows that are kept.
pub(crate) fn keep<T>(values: &mut Vec<T>, kept: &[bool]) {
    let mut rows = kept.iter();
    values.retain(|_| *rows.next().unwrap_or(&false));
}

fn compass_and_rate(
    sensors: &Sensors,
    scene: &Scene,
    mut waves: Waves,
    key: &StreamKey,
) -> (Vec<f64>, Option<Vec<f64>>) {
    let compass = &sensors.heading;
    let (mut heading_rng, mut rate_rng) = (key.rng(Purpose::Heading), key.rng(Purpose::YawRate));
    let mut heading = Vec::with_capacity(scene.samples.len());
    let mut yaw_rate = sensors.yaw_rate.map(|_| Vec::with_capacity(scene.samples.len()));
    for sample in scene.samples {
        let [wave, wave_rate] = waves.at(sample.time);
        // Drawn in every row, whether used or not, so that what the helmsman reads shifts no later draw.
        let noise = if compass.noise > 0.0 { compass.noise * normal(&mut heading_rng) } else { 0.0 };
        heading.push(match reading_at(&scene.wake.readings, sample.time) {
            Some(reading) => reading.heading,
            None => quantise(sample.gyro + wave + compass.bias + noise, compass.quantum),
        });
        if let (Some(yaw_rate), Some(sensor)) = (&mut yaw_rate, &sensors.yaw_rate) {
            let r = sample.motion.yaw_rate + wave_rate;
            let noise = sensor.noise * normal(&mut rate_rng);
            yaw_rate.push((1.0 + sensor.scale_error) * r + sensor.bias + noise);
        }
    }
    (heading, yaw_rate)
}

/// What the helmsman read at time `t`, if he did.
fn reading_at(readings: &[Reading], t: f64) -> Option<&Reading> {
    let at = readings.partition_point(|reading| reading.time < t - SAME_INSTANT);
    readings.get(at).filter(|reading| reading.time <= t + SAME_INSTANT)
}

fn order_at(executes: &[Execute], first: f64, t: f64) -> f64 {
    let given = executes.partition_point(|execute| execute.time <= t);
    if given == 0 { first } else { executes[given - 1].order }
}

fn write_wind(scene: &Scene, channels: &mut BTreeMap<Channel, Vec<f64>>) {
    let Some(wind) = scene.wind else { return };
    let Some(mean) = wind.speed else { return };
    let speeds: Vec<f64> = scene.samples.iter().map(|sample| gusting_speed(mean, sample.gust)).collect();
    let ship = |sample: &Sample| sample.motion.speed.or(scene.particulars.map(|particulars| particulars.speed));
    let relative: Option<Vec<(f64, f64)>> = scene
        .samples
        .iter()
        .zip(&speeds)
        .map(|(sample, &speed)| ship(sample).map(|U| wind.relative(speed, U, sample.motion.heading)))
        .collect();
    if let Some(relative) = relative {
        let (speed, from) = relative.into_iter().unzip();
        channels.insert(Channel::WindRelativeSpeed, speed);
        channels.insert(Channel::WindRelativeFrom, from);
    }
    channels.insert(Channel::WindTrueFrom, vec![wind.from; speeds.len()]);
    channels.insert(Channel::WindTrueSpeed, speeds);
}

/// Which rows are lost; `None` when none can be.
fn lost_rows(drop_out: &DropOut, rows: usize, key: &StreamKey) -> Option<Vec<bool>> {
    if drop_out.probability <= 0.0 && drop_out.bursts.is_none() {
        return None;
    }
    let mut rng: ChaCha8Rng = key.rng(Purpose::DropOut);
    let mut lost: Vec<bool> = (0..rows).map(|_| uniform(&mut rng) < drop_out.probability).collect();
    if let Some(bursts) = drop_out.bursts {
        let mut rng = key.rng(Purpose::Burst);
        let mut inside = false;
        for lost in &mut lost {
            let draw = uniform(&mut rng);
            inside = if inside { draw >= 1.0 / bursts.mean_rows } else { draw < bursts.probability };
            *lost |= inside;
        }
    }
    Some(lost)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sensor::Bursts;
    use approx::assert_relative_eq;

    #[test]
    fn bursts_have_their_mean_length_and_frequency() {
        let bursts = Bursts { probability: 0.01, mean_rows: 8.0 };
        let drop_out = DropOut { bursts: Some(bursts), ..DropOut::default() };
        let rows = 200_000;
        let lost = lost_rows(&drop_out, rows, &StreamKey::default()).expect("bursts are asked for");
        let begun = lost.windows(2).filter(|pair| !pair[0] && pair[1]).count();
        let share = lost.iter().filter(|lost| **lost).count() as f64 / rows as f64;
        // Stationary share p/(p + 1/m); some 1800 bursts, so the mean length is known to about 2.4 %.
        assert_relative_eq!(share, 0.01 / (0.01 + 0.125), max_relative = 0.08);
        assert_relative_eq!(share * rows as f64 / begun as f64, 8.0, max_relative = 0.08);
    }
}
