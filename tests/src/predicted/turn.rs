//! The way of a ship that turns, in lengths of the ship, from the execute on: recorded or predicted.

use std::f64::consts::{FRAC_PI_2, PI};

use predict::simulated_manoeuvre::SimulatedManoeuvre;
use predict::turn::HeldTurn;
use trial::{Channel, Trial};

/// Change of heading after which a track is not drawn on, rad: one and a half circles.
const SHOWN: f64 = 3.0 * PI;

/// A track from the execute on, north being the course there: north and east in lengths of the ship, and heading, rad.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct TurnTrack {
    places: Vec<[f64; 2]>,
    headings: Vec<f64>,
}

impl TurnTrack {
    fn new(rows: impl Iterator<Item = ([f64; 2], f64)>) -> Self {
        let (places, headings) = rows.take_while(|(_, heading)| heading.abs() < SHOWN).unzip();
        Self { places, headings }
    }

    /// That of a record with positions, from which a current has been taken out; `None` without positions.
    pub fn recorded(trial: &Trial, length: f64) -> Option<Self> {
        let (north, east) = (trial.channel(Channel::North)?, trial.channel(Channel::East)?);
        let first = HeldTurn::of(trial)?.execute;
        let is_whole = |row: &usize| north[*row].is_finite() && east[*row].is_finite();
        let rows: Vec<usize> =
            trial.observed_rows().filter(|row| trial.time()[*row] >= first).filter(is_whole).collect();
        let begin = *rows.first()?;
        let (sin, cos) = trial.heading()[begin].sin_cos();
        let place = |row: usize| {
            let [n, e] = [north[row] - north[begin], east[row] - east[begin]];
            [(n * cos + e * sin) / length, (e * cos - n * sin) / length]
        };
        Some(Self::new(rows.into_iter().map(|row| (place(row), trial.heading()[row] - trial.heading()[begin]))))
    }

    /// That of a simulated manoeuvre; `None` where nothing is known of drift.
    pub fn predicted(of: &SimulatedManoeuvre) -> Option<Self> {
        let (track, length) = (of.track()?, of.way.as_ref()?.length);
        let places = track.iter().map(|place| place.map(|metres| metres / length));
        Some(Self::new(places.zip(of.heading.iter().copied())))
    }

    /// East and north of every place, lengths.
    pub fn curve(&self) -> (Vec<f64>, Vec<f64>) {
        self.places.iter().map(|[north, east]| (*east, *north)).unzip()
    }

    fn reached(&self, angle: f64) -> Option<[f64; 2]> {
        let row = self.headings.iter().position(|heading| heading.abs() >= angle)?;
        Some(self.places[row])
    }

    /// Where the heading has changed by 90° (the north of it is the advance) and by 180° (the east of it is the
    /// tactical diameter); east and north, lengths.
    pub fn quarters(&self) -> [Option<(f64, f64)>; 2] {
        [FRAC_PI_2, PI].map(|angle| self.reached(angle).map(|[north, east]| (east, north)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use trial::Columns;

    /// A circle of radius 50 m after a straight approach to the north-east, in lengths of 10 m; the rudder moves in the
    /// second before it, on the last metre of the approach.
    #[test]
    fn a_recorded_circle_has_its_advance_and_diameter() {
        let (course, radius, rate) = (0.8, 50.0, 0.02);
        let time: Vec<f64> = (0..400).map(f64::from).collect();
        let angle = |t: f64| rate * (t - 20.0).max(0.0);
        let heading: Vec<f64> = time.iter().map(|t| course + angle(*t)).collect();
        let ahead = |t: f64| if t < 20.0 { t - 20.0 } else { radius * angle(t).sin() };
        let aside = |t: f64| radius * (1.0 - angle(t).cos());
        let north = time.iter().map(|t| ahead(*t) * course.cos() - aside(*t) * course.sin()).collect();
        let east = time.iter().map(|t| ahead(*t) * course.sin() + aside(*t) * course.cos()).collect();
        let rudder = time.iter().map(|t| if *t < 20.0 { 0.0 } else { 0.35 }).collect();
        let channels =
            [(Channel::Heading, heading), (Channel::Rudder, rudder), (Channel::North, north), (Channel::East, east)];
        let columns = Columns { time, channels: channels.into(), unknown: Vec::new() };
        let origin = trial::Origin::Simulated { scenario: "circle".into(), cell: 0, replicate: 0 };
        let trial = Trial::new("circle", origin, columns).expect("a record");
        let [quarter, half] = TurnTrack::recorded(&trial, 10.0).expect("positions").quarters();
        assert!((quarter.expect("90°").1 - 5.1).abs() < 0.01, "{quarter:?}");
        assert!((half.expect("180°").0 - 10.0).abs() < 0.01, "{half:?}");
    }
}
