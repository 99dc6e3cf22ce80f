//! Wind of a record: the relative wind from the true wind, and the mean true wind from the relative wind.

use super::Trial;
use crate::channel::Channel;

/// Relative wind: speed, m/s, and the direction from which it comes, clockwise from the bow, rad, −π to π.
///
/// The true wind blows at `speed` (m/s) from `from` (rad, clockwise from north); the ship makes `ahead` (m/s) on
/// `heading` (rad). The drift angle is neglected.
pub fn relative_wind(speed: f64, from: f64, ahead: f64, heading: f64) -> (f64, f64) {
    let (side, bow) = (from - heading).sin_cos();
    let (bow, side) = (speed * bow + ahead, speed * side);
    (bow.hypot(side), side.atan2(bow))
}

impl Trial {
    /// Relative wind of every row: speed, m/s, and the direction from which it comes, clockwise from the bow, rad:
    /// measured, else from the true wind and the speed of the ship. `None` if these were not recorded either.
    pub fn relative_wind(&self) -> Option<[Vec<f64>; 2]> {
        let measured = [Channel::WindRelativeSpeed, Channel::WindRelativeFrom].map(|channel| self.channel(channel));
        if let [Some(speed), Some(from)] = measured {
            return Some([speed.to_vec(), from.to_vec()]);
        }
        let [speed, from, ship] =
            [Channel::WindTrueSpeed, Channel::WindTrueFrom, Channel::Speed].map(|channel| self.channel(channel));
        let (speed, from, ship) = (speed?, from?, ship?);
        let rows = (0..self.len()).map(|row| relative_wind(speed[row], from[row], ship[row], self.heading()[row]));
        let (speed, from) = rows.unzip();
        Some([speed, from])
    }

    /// Mean true wind: root mean square speed, m/s, and mean direction from which it comes, clockwise from north, rad.
    /// `None` unless some row has a heading, a relative wind and a speed of the ship.
    pub fn mean_true_wind(&self) -> Option<[f64; 2]> {
        let ([speed, from], ship) = (self.relative_wind()?, self.channel(Channel::Speed)?);
        let to_north_and_east = |row: usize| {
            let (side, ahead) = from[row].sin_cos();
            let (side, ahead) = (speed[row] * side, speed[row] * ahead - ship[row]);
            let (sin, cos) = self.heading()[row].sin_cos();
            [ahead * cos - side * sin, ahead * sin + side * cos]
        };
        let is_finite = |wind: &[f64; 2]| wind.iter().all(|component| component.is_finite());
        let winds: Vec<[f64; 2]> = self.observed_rows().map(to_north_and_east).filter(is_finite).collect();
        let square = winds.iter().flatten().map(|component| component * component).sum::<f64>() / winds.len() as f64;
        let [north, east] = [0, 1].map(|axis| winds.iter().map(|wind| wind[axis]).sum::<f64>());
        (!winds.is_empty()).then(|| [square.sqrt(), east.atan2(north)])
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::record::{Columns, RecordOrigin};

    /// A true wind of 5 m/s from 0.7 rad on a ship that turns at 2 m/s: relative and true wind follow from each other.
    #[test]
    fn relative_and_true_wind_tell_one_another() {
        let rows: Vec<f64> = (0..100).map(f64::from).collect();
        let channel = |value: fn(f64) -> f64| rows.iter().copied().map(value).collect::<Vec<f64>>();
        let ship = [
            (Channel::Rudder, channel(|_| 0.1)),
            (Channel::Heading, channel(|t| 0.05 * t)),
            (Channel::Speed, channel(|_| 2.0)),
        ];
        let trial_in = |wind: [(Channel, Vec<f64>); 2]| {
            let channels = ship.clone().into_iter().chain(wind).collect();
            let columns = Columns { time: rows.clone(), channels, unknown_columns: Vec::new() };
            let origin = RecordOrigin::Measured { file: "run.csv".into(), sha256: String::new() };
            Trial::new("run", origin, columns).expect("a record")
        };
        let from_true =
            trial_in([(Channel::WindTrueSpeed, channel(|_| 5.0)), (Channel::WindTrueFrom, channel(|_| 0.7))]);
        let [speed, from] = from_true.relative_wind().expect("known");
        assert!((speed[14] - 7.0).abs() < 1e-12 && from[14].abs() < 1e-12, "ahead: {} {}", speed[14], from[14]);
        let from_relative = trial_in([(Channel::WindRelativeSpeed, speed), (Channel::WindRelativeFrom, from)]);
        for trial in [from_true, from_relative] {
            let [speed, from] = trial.mean_true_wind().expect("known");
            assert!((speed - 5.0).abs() < 1e-12 && (from - 0.7).abs() < 1e-12, "{speed} {from}");
        }
        assert_eq!(
            trial_in([(Channel::Sway, channel(|_| 0.0)), (Channel::North, channel(|t| t))]).mean_true_wind(),
            None
        );
    }
}
