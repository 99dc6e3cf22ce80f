//! Writer of a record as CSV with `quantity_unit` column names, so that reading it gives the same record. A sidecar
//! contains length and speed of the ship, the declared weather and the declared noise; other declarations are not
//! written.

use std::io::Write;

use ship::Particulars;
use ship::angle::to_deg;

use crate::channel::{Channel, TIME_COLUMN};
use crate::record::{SensorNoise, Trial};

/// Writes `trial` as CSV: `t_s`, then its channels in the order of [`Channel::ALL`] (angles in degrees), then its
/// columns with unknown names. A missing value is an empty cell; a heading that is the integral of the yaw rate is
/// omitted.
///
/// Numbers have the digits required to read back the same `f64`. Fails if `output` does.
pub fn write_csv(trial: &Trial, output: impl Write) -> std::io::Result<()> {
    let channels: Vec<(Channel, f64, &[f64])> = Channel::ALL
        .into_iter()
        .filter(|&channel| channel != Channel::Heading || !trial.is_heading_integrated())
        .filter_map(|channel| Some((channel, channel.written_unit().si_factor(), trial.channel(channel)?)))
        .collect();
    let mut table = csv::Writer::from_writer(output);
    let names = channels.iter().map(|(channel, ..)| channel.column_name());
    table.write_record(
        std::iter::once(TIME_COLUMN.to_owned())
            .chain(names)
            .chain(trial.unknown_columns().iter().map(|(name, _)| name.clone())),
    )?;
    let mut cell = Vec::new();
    for (row, &time) in trial.time().iter().enumerate() {
        let readings = channels.iter().map(|(_, factor, values)| values[row] / factor);
        let unknown = trial.unknown_columns().iter().map(|(_, values)| values[row]);
        for value in std::iter::once(time).chain(readings).chain(unknown) {
            cell.clear();
            if !value.is_nan() {
                write!(cell, "{value}")?;
            }
            table.write_field(&cell)?;
        }
        table.write_record(None::<&[u8]>)?;
    }
    table.flush()
}

/// Sidecar of a record, as TOML: the declared calm, length and speed of the ship, and the declared noise of its
/// instruments. `None` without any of these.
pub fn sidecar_toml(trial: &Trial) -> Option<String> {
    let ship = |Particulars { length, speed }| format!("[ship]\nlength-m = {length:?}\nspeed-m-s = {speed:?}\n");
    let calm = trial.is_calm().then(|| String::from("weather = \"none\"\n"));
    let SensorNoise { heading_sd, yaw_rate_sd, rudder_sd } = trial.noise();
    let kinds = [("heading-deg", heading_sd), ("yaw-rate-deg-s", yaw_rate_sd), ("rudder-deg", rudder_sd)];
    let noise: String =
        kinds.iter().filter_map(|(key, sd)| Some(format!("{key} = {:?}\n", short(to_deg((*sd)?))))).collect();
    let noise = (!noise.is_empty()).then(|| format!("[noise]\n{noise}"));
    let text: String = calm.into_iter().chain(trial.particulars().map(ship)).chain(noise).collect();
    (!text.is_empty()).then_some(text)
}

/// Number rounded to 12 decimals, without the rounding errors of a change of units.
fn short(value: f64) -> f64 {
    (1e12 * value).round() / 1e12
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;
    use std::path::Path;

    use approx::assert_abs_diff_eq;

    use super::*;
    use crate::reader::read_from_reader;
    use crate::record::{Columns, RecordOrigin};
    use crate::{DeclaredConditions, DeclaredWeather, Sidecar};

    fn trial(without_heading: bool) -> Trial {
        let time: Vec<f64> = (0..200).map(|i| 1000.0 + 0.7 * f64::from(i) + 0.01 * f64::from(i % 3)).collect();
        let mut channels: BTreeMap<Channel, Vec<f64>> = Channel::ALL
            .into_iter()
            .enumerate()
            .map(|(k, channel)| (channel, time.iter().map(|t| (0.1 * t + k as f64).sin() / 3.0).collect()))
            .collect();
        // A heading that follows the rudder, so that the record is plausible.
        let (gain, lag) = (0.1, 16.0);
        let (mut psi, mut r) = (0.4, 0.0);
        let rudder = channels[&Channel::Rudder].clone();
        let mut heading = vec![psi];
        let mut rate = vec![r];
        for row in 1..time.len() {
            let h = time[row] - time[row - 1];
            r += h * (gain * rudder[row - 1] - r) / lag;
            psi += h * r;
            heading.push(psi);
            rate.push(r);
        }
        heading[7] = f64::NAN;
        channels.insert(Channel::Heading, heading);
        channels.insert(Channel::YawRate, rate);
        if without_heading {
            channels.remove(&Channel::Heading);
        }
        let unknown = vec![("thrust, \"N\"".to_owned(), time.iter().map(|t| t * 1e-7).collect())];
        let origin = RecordOrigin::Simulated { scenario: "writer".to_owned(), cell: 0, replicate: 0 };
        Trial::new("writer", origin, Columns { time, channels, unknown_columns: unknown })
            .expect("the columns are complete")
    }

    #[test]
    fn what_is_written_is_read_back() {
        for without_heading in [false, true] {
            let trial = trial(without_heading);
            let mut bytes = Vec::new();
            write_csv(&trial, &mut bytes).expect("a vector takes all bytes");
            let back = read_from_reader(Path::new("writer.csv"), &bytes[..], None, None)
                .expect("a written record is readable");
            let back = back.trial;
            assert_eq!(back.len(), trial.len());
            assert_eq!(back.is_heading_integrated(), without_heading);
            for (read, expected) in back.time().iter().zip(trial.time()) {
                assert_eq!(read, expected);
            }
            for channel in Channel::ALL {
                let (read, expected) = (back.channel(channel).expect("written"), trial.channel(channel).expect("made"));
                for (read, expected) in read.iter().zip(expected).filter(|(_, expected)| !expected.is_nan()) {
                    assert_abs_diff_eq!(read, expected, epsilon = 1e-12);
                }
                let missing = |values: &[f64]| values.iter().filter(|value| value.is_nan()).count();
                assert_eq!(missing(read), missing(expected), "{channel:?}");
            }
            assert_eq!(back.unknown_columns(), trial.unknown_columns());
        }
    }

    #[test]
    fn a_sidecar_has_the_ship_and_the_calm() {
        let trial = trial(false);
        assert_eq!(sidecar_toml(&trial), None);
        let particulars = Particulars { length: 7.0, speed: 1.18 };
        let calm = DeclaredConditions { weather: Some(DeclaredWeather::Calm), ..DeclaredConditions::default() };
        let text = sidecar_toml(&trial.with_particulars(particulars).with_conditions(calm)).expect("a sidecar");
        let back = Sidecar::parse(&text, Path::new("writer.trial.toml")).expect(&text).conditions;
        assert_eq!((back.particulars, back.weather), (Some(particulars), Some(DeclaredWeather::Calm)));
    }
}
