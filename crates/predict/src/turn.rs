//! Recorded turn with a held rudder: its characteristics, and the characteristics of drawn ships under the same
//! rudder.

use rand::RngExt;
use rand_distr::StandardNormal;
use ship::Polyline;
pub use simulate::motion::Current;
use simulate::{RngPurpose, StreamKey};
use trial::{Channel, Trial, ZigZag};

use crate::figures::{self, Characteristics};
use crate::median_track::{MAX_TRACK_RAD, TurnTrack, median_track};
use crate::simulated_manoeuvre::{self, PlanarMotion, SimulatedManoeuvre};

/// Minimum rudder angle of a held rudder, relative to the maximum.
const MIN_HELD: f64 = 0.8;

/// Extension of the held rudder for ships that turn more slowly than the recorded ship, relative to the recorded time.
const EXTENSION: f64 = 2.0;

/// Assumed duration of a record of unknown length and speed, in timescales of the ship.
const DEFAULT_TIMESCALES: f64 = 40.0;

/// Number of drawn ships whose tracks are kept.
const DRAWN_TRACKS: usize = 40;

/// Uniform current from a circle of 720° or more; `None` for any other record, and without positions.
pub fn estimated_current(trial: &Trial) -> Option<Current> {
    let turn = HeldTurn::from_trial(trial)?;
    let (north, east) = (trial.channel(Channel::North)?, trial.channel(Channel::East)?);
    let has_position = |row: &usize| north[*row].is_finite() && east[*row].is_finite();
    let is_turning = |row: &usize| (turn.execute_time..=turn.end_time).contains(&trial.time()[*row]);
    let rows: Vec<usize> = trial.observed_rows().filter(has_position).filter(is_turning).collect();
    let at_rows = |values: &[f64]| -> Vec<f64> { rows.iter().map(|&row| values[row]).collect() };
    let track: Vec<[f64; 2]> = rows.iter().map(|&row| [north[row], east[row]]).collect();
    simulate::motion::estimate_current(&at_rows(trial.time()), &at_rows(trial.heading()), &track)
}

/// Record with the current removed from the positions, and that current: the given current, or else the current that
/// the record determines. `None` without a current or without positions.
pub fn without_current(trial: Trial, given: Option<Current>) -> (Trial, Option<Current>) {
    match given.or_else(|| estimated_current(&trial)).filter(|_| trial.channel(Channel::North).is_some()) {
        Some(current) => (trial.without_current([current.north_m_s, current.east_m_s]), Some(current)),
        None => (trial, None),
    }
}

/// Motion of a drawn ship whose track drifts from the first row on, by a random error of the removed current.
pub(crate) fn with_current_error(passage: &SimulatedManoeuvre, current: &Current, number: u64) -> SimulatedManoeuvre {
    let mut rng = StreamKey { seed: 0, cell: 0, replicate: number }.indexed_rng(RngPurpose::Specification, 3);
    let error = [current.north_sd_m_s, current.east_sd_m_s].map(|sd| sd * rng.sample::<f64, _>(StandardNormal));
    let mut passage = passage.clone();
    let period = passage.period;
    for (row, place) in passage.planar_motion.iter_mut().flat_map(|planar| &mut planar.track).enumerate() {
        *place = [0, 1].map(|axis| place[axis] + error[axis] * row as f64 * period);
    }
    passage
}

/// Turn with a rudder that is put over and held; times on the clock of the record, s.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HeldTurn {
    /// Time of the first row of the record.
    start: f64,
    /// Time of the execute.
    pub execute_time: f64,
    /// End of the held rudder.
    pub end_time: f64,
    /// Side of the rudder, ±1.
    pub side: f64,
    /// Maximum rudder angle to that side, rad.
    pub max_rudder: f64,
    /// Rudder angle before the execute, rad.
    pub rudder_before: f64,
}

impl HeldTurn {
    /// Turn with the maximum rudder; `None` for a rudder that never moves.
    pub fn from_trial(trial: &Trial) -> Option<Self> {
        let (times, values) = (trial.rudder_signal().times(), trial.rudder_signal().values());
        let away = |value: f64| value - values[0];
        let largest = values.iter().copied().map(away).max_by(|a, b| a.abs().total_cmp(&b.abs()))?;
        let side = largest.signum();
        let share = |row: usize| away(values[row]) * side / largest.abs();
        let mut first = (0..values.len()).find(|&row| share(row) > MIN_HELD)?;
        let until = (first..values.len()).find(|&row| share(row) < MIN_HELD).map_or(values.len() - 1, |row| row - 1);
        // Back to the first row of the ramp.
        while first > 0 && share(first - 1) > 0.01 {
            first -= 1;
        }
        Some(Self {
            start: trial.time()[0],
            execute_time: times[first.saturating_sub(1)],
            end_time: times[until],
            side,
            max_rudder: (largest + values[0]) * side,
            rudder_before: values[0],
        })
    }

    /// Duration from the first row to the execute, s.
    pub(crate) fn approach_duration(&self) -> f64 {
        self.execute_time - self.start
    }

    /// Row of the execute.
    fn first_row(&self, passage: &SimulatedManoeuvre) -> usize {
        (self.approach_duration() / passage.period).round() as usize
    }

    /// Headings from the execute on.
    fn headings<'a>(&self, passage: &'a SimulatedManoeuvre) -> &'a [f64] {
        &passage.heading[self.first_row(passage).min(passage.heading.len())..]
    }

    /// Characteristics of a turn up to the end of the recorded turn.
    pub(crate) fn characteristics_within_record(&self, passage: &SimulatedManoeuvre) -> Characteristics {
        self.characteristics_to_end(&passage.until(self.end_time - self.start))
    }

    /// Characteristics of a turn up to its end; the clock starts with the record.
    pub(crate) fn characteristics_to_end(&self, passage: &SimulatedManoeuvre) -> Characteristics {
        let first = self.first_row(passage);
        let begin = passage.interpolated(&passage.heading, self.approach_duration());
        let heading = passage.heading.iter().skip(first).map(|heading| heading - begin).collect();
        let after = SimulatedManoeuvre { heading, period: passage.period, ..SimulatedManoeuvre::default() };
        let mut figures = figures::turn_characteristics(&after, self.side);
        figures.extend(figures::circle_characteristics(passage, self.approach_duration()));
        figures
    }

    /// Track from the execute on, turned so that the heading at the execute points north: north and east in ship
    /// lengths, up to a heading change of one and a half circles. `None` without a track, or if the run ends before the
    /// execute.
    fn track(&self, passage: &SimulatedManoeuvre) -> Option<Vec<[f64; 2]>> {
        let (track, length) = (passage.track()?, passage.planar_motion.as_ref()?.length);
        let first = self.first_row(passage);
        let (begin, heading) = (*track.get(first)?, *passage.heading.get(first)?);
        let (sin, cos) = heading.sin_cos();
        let place = |row: usize| {
            let [north, east] = [0, 1].map(|axis| (track[row][axis] - begin[axis]) / length);
            [north * cos + east * sin, east * cos - north * sin]
        };
        let is_shown = |row: &usize| (passage.heading[*row] - heading).abs() < MAX_TRACK_RAD;
        Some((first..track.len()).take_while(is_shown).map(place).collect())
    }

    /// Rudder of the record up to the end of the turn, and held from there; `None` if the signal begins after that end.
    pub(crate) fn extended_rudder(&self, signal: &Polyline) -> Option<Polyline> {
        let mut times: Vec<f64> = signal.times().iter().copied().take_while(|time| *time <= self.end_time).collect();
        let mut values: Vec<f64> = signal.values()[..times.len()].to_vec();
        times.push(self.end_time + EXTENSION * (self.end_time - self.execute_time));
        values.push(*values.last()?);
        Polyline::new(times, values).ok()
    }
}

/// Recorded turning circle.
#[derive(Debug, Clone, PartialEq)]
pub struct MeasuredCircle {
    /// Held rudder.
    pub turn: HeldTurn,
    /// Characteristics of the turn.
    pub figures: Characteristics,
    /// Track from the execute on, turned so that the heading at the execute points north: north and east in ship
    /// lengths; `None` without positions or length.
    pub track: Option<Vec<[f64; 2]>>,
}

impl MeasuredCircle {
    /// Turning circle of a record, with its current removed; `None` for a zig-zag, and for a turn of less than 90°.
    pub fn from_trial(trial: &Trial) -> Option<Self> {
        if ZigZag::from_trial(trial).is_ok() {
            return None;
        }
        let (trial, _) = without_current(trial.clone(), None);
        let turn = HeldTurn::from_trial(&trial)?;
        let ship = trial.particulars();
        let timescale = ship.map_or_else(|| trial.duration() / DEFAULT_TIMESCALES, |ship| ship.length / ship.speed);
        let passage = resampled_record(&trial, timescale, ship.map(|ship| ship.length))?;
        let figures = turn.characteristics_within_record(&passage);
        figures.get("time_to_90_s").copied().flatten()?;
        let track = turn.track(&passage);
        Some(Self { turn, figures, track })
    }
}

/// Plan view of a recorded turn with its prediction: tracks of north and east in ship lengths, from the execute on.
#[derive(Debug, Clone, PartialEq)]
pub struct TurnTracks {
    /// Recorded track.
    pub measured: Vec<[f64; 2]>,
    /// Track of the most probable ship.
    pub most_probable: Vec<[f64; 2]>,
    /// Tracks of some drawn ships.
    pub drawn: Vec<Vec<[f64; 2]>>,
    /// Median position of the drawn ships at every change of heading.
    pub median: Vec<[f64; 2]>,
}

impl TurnTracks {
    /// Tracks of a recorded turn; `None` without positions, and for a model without drift.
    pub(crate) fn from_ships(
        turn: &HeldTurn,
        record: &SimulatedManoeuvre,
        most_probable: &SimulatedManoeuvre,
        made: &[SimulatedManoeuvre],
    ) -> Option<Self> {
        let drawn: Vec<(&[f64], Vec<[f64; 2]>)> =
            made.iter().filter_map(|passage| Some((turn.headings(passage), turn.track(passage)?))).collect();
        let turns: Vec<TurnTrack> = drawn.iter().map(|(heading, track)| TurnTrack { heading, track }).collect();
        let median = median_track(&turns, turn.side);
        Some(Self {
            measured: turn.track(record)?,
            most_probable: turn.track(most_probable)?,
            drawn: drawn.into_iter().take(DRAWN_TRACKS).map(|(_, track)| track).collect(),
            median,
        })
    }
}

/// Record resampled to the rows of a simulation with this timescale, s; with velocity and track if it has positions and
/// a length, m. `None` without headings.
pub(crate) fn resampled_record(trial: &Trial, timescale: f64, length: Option<f64>) -> Option<SimulatedManoeuvre> {
    let period = simulated_manoeuvre::row_interval(timescale);
    let count = (trial.duration() / period) as usize + 1;
    let on_rows = |rows: &mut dyn Iterator<Item = usize>, values: &[f64]| -> Option<Vec<f64>> {
        let read = rows.filter(|&k| values[k].is_finite()).map(|k| (trial.time()[k] - trial.time()[0], values[k]));
        let (times, values) = read.unzip();
        let signal = Polyline::new(times, values).ok()?;
        Some((0..count).map(|row| signal.value_at(row as f64 * period)).collect())
    };
    let heading = on_rows(&mut trial.observed_rows(), trial.heading())?;
    let channel = |channel: Channel| on_rows(&mut (0..trial.len()), trial.channel(channel)?);
    let pairs = |x: Vec<f64>, y: Vec<f64>| x.into_iter().zip(y).map(|(x, y)| [x, y]).collect();
    let planar_motion = || {
        let (length, track) = (length?, pairs(channel(Channel::North)?, channel(Channel::East)?));
        let [surge, sway] =
            [Channel::Surge, Channel::Sway].map(|axis| channel(axis).unwrap_or_else(|| vec![f64::NAN; count]));
        Some(PlanarMotion { length, velocity: pairs(surge, sway), track })
    };
    let slope = |row: usize| match count {
        0 | 1 => 0.0,
        _ => (heading[row + 1] - heading[row]) / period,
    };
    let yaw_rate = (0..count).map(|row| slope(row.min(count.saturating_sub(2)))).collect();
    Some(SimulatedManoeuvre {
        period,
        yaw_rate,
        planar_motion: planar_motion(),
        heading,
        ..SimulatedManoeuvre::default()
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use trial::{Columns, RecordOrigin};

    /// Circle of radius 50 m after a straight approach to the north-east, in lengths of 10 m; the rudder moves in the
    /// second before it, on the last metre of the approach.
    #[test]
    fn a_recorded_circle_has_its_advance_and_diameter() {
        let (course, radius, rate) = (0.8, 50.0, 0.02);
        let time: Vec<f64> = (0..600).map(f64::from).collect();
        let angle = |t: f64| rate * (t - 20.0).max(0.0);
        let heading: Vec<f64> = time.iter().map(|t| course + angle(*t)).collect();
        let ahead = |t: f64| if t < 20.0 { t - 20.0 } else { radius * angle(t).sin() };
        let aside = |t: f64| radius * (1.0 - angle(t).cos());
        let north = time.iter().map(|t| ahead(*t) * course.cos() - aside(*t) * course.sin()).collect();
        let east = time.iter().map(|t| ahead(*t) * course.sin() + aside(*t) * course.cos()).collect();
        let rudder = time.iter().map(|t| if *t < 20.0 { 0.0 } else { 0.35 }).collect();
        let channels =
            [(Channel::Heading, heading), (Channel::Rudder, rudder), (Channel::North, north), (Channel::East, east)];
        let columns = Columns { time, channels: channels.into(), unknown_columns: Vec::new() };
        let trial =
            Trial::new("circle", RecordOrigin::Measured { file: "made up".into(), sha256: String::new() }, columns);
        let trial = trial.expect("a record");
        let record = resampled_record(&trial, 10.0, Some(10.0)).expect("headings");
        let track = HeldTurn::from_trial(&trial).expect("a turn").track(&record).expect("positions");
        // The heading begins to change a second after the execute.
        let row = |angle: f64| track[((angle / rate + 1.0) / record.period).round() as usize];
        let (quarter, half) = (row(std::f64::consts::FRAC_PI_2), row(std::f64::consts::PI));
        assert!((quarter[0] - 5.1).abs() < 0.03 && (half[1] - 10.0).abs() < 0.03, "{quarter:?} {half:?}");
        assert!((track.len() as f64 * record.period * rate - MAX_TRACK_RAD).abs() < 0.1);
    }
}
