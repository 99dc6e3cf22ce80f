//! The wind of a record.

use super::Trial;
use crate::channel::Channel;

/// Relative wind, m/s, and the angle that it comes from, clockwise from the bow, rad, −π to π: of a true wind of
/// `speed` (m/s) from `from` (rad, clockwise from north) on a ship that makes `ahead` (m/s). Her drift angle is left
/// out.
pub fn relative_wind(speed: f64, from: f64, ahead: f64, heading: f64) -> (f64, f64) {
    let (side, bow) = (from - heading).sin_cos();
    let (bow, side) = (speed * bow + ahead, speed * side);
    (bow.hypot(side), side.atan2(bow))
}

impl Trial {
    /// Relative wind, m/s, and the angle that it comes from, clockwise from the bow, rad: as measured, else from the
    /// true one and the speed of the ship.
    pub fn relative_wind(&self) -> Option<[Vec<f64>; 2]> {
        let own = [Channel::WindRelativeSpeed, Channel::WindRelativeFrom].map(|own| self.channel(own));
        if let [Some(speed), Some(from)] = own {
            return Some([speed.to_vec(), from.to_vec()]);
        }
        let [speed, from, ship] =
            [Channel::WindTrueSpeed, Channel::WindTrueFrom, Channel::Speed].map(|own| self.channel(own));
        let (speed, from, ship) = (speed?, from?, ship?);
        let rows = (0..self.len()).map(|row| relative_wind(speed[row], from[row], ship[row], self.heading()[row]));
        let (speed, from) = rows.unzip();
        Some([speed, from])
    }

    /// True wind of the record as one wind: root mean square of its speed, m/s, and the mean direction that it comes
    /// from, clockwise from north, rad. `None` without the relative wind and the speed of the ship.
    pub fn mean_wind(&self) -> Option<[f64; 2]> {
        let ([speed, from], ship) = (self.relative_wind()?, self.channel(Channel::Speed)?);
        let to_north_and_east = |row: usize| {
            let (side, ahead) = from[row].sin_cos();
            let (side, ahead) = (speed[row] * side, speed[row] * ahead - ship[row]);
            let (sin, cos) = self.heading()[row].sin_cos();
            [ahead * cos - side * sin, ahead * sin + side * cos]
        };
        let read = self.observed_rows().map(to_north_and_east).filter(|own| own.iter().all(|one| one.is_finite()));
        let read: Vec<[f64; 2]> = read.collect();
        let square = read.iter().flatten().map(|one| one * one).sum::<f64>() / read.len() as f64;
        let [north, east] = [0, 1].map(|axis| read.iter().map(|own| own[axis]).sum::<f64>());
        (!read.is_empty()).then(|| [square.sqrt(), east.atan2(north)])
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::record::{Columns, Origin};

    /// A true wind of 5 m/s from 0.7 rad on a ship that turns at 2 m/s: one is found from the other.
    #[test]
    fn relative_and_true_wind_tell_one_another() {
        let rows: Vec<f64> = (0..100).map(f64::from).collect();
        let channel = |of: fn(f64) -> f64| rows.iter().copied().map(of).collect::<Vec<f64>>();
        let ship = [
            (Channel::Rudder, channel(|_| 0.1)),
            (Channel::Heading, channel(|t| 0.05 * t)),
            (Channel::Speed, channel(|_| 2.0)),
        ];
        let of = |wind: [(Channel, Vec<f64>); 2]| {
            let channels = ship.clone().into_iter().chain(wind).collect();
            let columns = Columns { time: rows.clone(), channels, unknown: Vec::new() };
            let origin = Origin::Measured { file: "run.csv".into(), sha256: String::new() };
            Trial::new("run", origin, columns).expect("a record")
        };
        let from_true = of([(Channel::WindTrueSpeed, channel(|_| 5.0)), (Channel::WindTrueFrom, channel(|_| 0.7))]);
        let [speed, from] = from_true.relative_wind().expect("known");
        assert!((speed[14] - 7.0).abs() < 1e-12 && from[14].abs() < 1e-12, "ahead: {} {}", speed[14], from[14]);
        let from_relative = of([(Channel::WindRelativeSpeed, speed), (Channel::WindRelativeFrom, from)]);
        for trial in [from_true, from_relative] {
            let [speed, from] = trial.mean_wind().expect("known");
            assert!((speed - 5.0).abs() < 1e-12 && (from - 0.7).abs() < 1e-12, "{speed} {from}");
        }
        assert_eq!(of([(Channel::Sway, channel(|_| 0.0)), (Channel::North, channel(|t| t))]).mean_wind(), None);
    }
}
