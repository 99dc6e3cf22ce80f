//! A rudder that is put over and held, as a record shows it: its figures, and those of drawn ships under the same
//! rudder.

pub use crate::motion::Current;
use rand::RngExt;
use rand_distr::StandardNormal;
use ship::Polyline;
use simulate::{Purpose, StreamKey};
use trial::{Channel, Trial};

use crate::figures::{self, Figure};
use crate::passage::{self, SimulatedManoeuvre, Way};

/// Share of the largest angle above which a rudder is held.
const HELD: f64 = 0.8;

/// How much longer a rudder is held for ships that turn more slowly than that of the record, as a share of its time.
const LONGER: f64 = 2.0;

/// The uniform current that a circle of 720° or more shows; `None` for any other record, and without positions.
pub fn current_of(trial: &Trial) -> Option<Current> {
    let Turn { execute, until, .. } = Turn::of(trial.rudder_signal())?;
    let (north, east) = (trial.channel(Channel::North)?, trial.channel(Channel::East)?);
    let is_there = |row: &usize| north[*row].is_finite() && east[*row].is_finite();
    let is_turning = |row: &usize| (execute..=until).contains(&trial.time()[*row]);
    let rows: Vec<usize> = trial.observed_rows().filter(is_there).filter(is_turning).collect();
    let of = |values: &[f64]| -> Vec<f64> { rows.iter().map(|&row| values[row]).collect() };
    let track: Vec<[f64; 2]> = rows.iter().map(|&row| [north[row], east[row]]).collect();
    crate::motion::current(&of(trial.time()), &of(trial.heading()), &track)
}

/// A record whose positions no current has moved, and the current that was taken out: the one that is given, else the
/// one that the record shows, where it shows one.
pub fn without_current(trial: Trial, given: Option<Current>) -> (Trial, Option<Current>) {
    match given.or_else(|| current_of(&trial)).filter(|_| trial.channel(Channel::North).is_some()) {
        Some(current) => (trial.without_current([current.north_m_s, current.east_m_s]), Some(current)),
        None => (trial, None),
    }
}

/// A drawn passage with what is not known of a current, from its execute on.
pub(crate) fn in_doubt(passage: &SimulatedManoeuvre, current: &Current, number: u64) -> SimulatedManoeuvre {
    let mut rng = StreamKey { seed: 0, cell: 0, replicate: number }.indexed(Purpose::Specification, 3);
    let error = [current.north_sd_m_s, current.east_sd_m_s].map(|sd| sd * rng.sample::<f64, _>(StandardNormal));
    let mut passage = passage.clone();
    let period = passage.period;
    for (row, place) in passage.way.iter_mut().flat_map(|way| &mut way.track).enumerate() {
        *place = [0, 1].map(|axis| place[axis] + error[axis] * row as f64 * period);
    }
    passage
}

/// A rudder that is put over and held.
pub(crate) struct Turn {
    /// Time at which it leaves its beginning, s.
    pub execute: f64,
    /// Time until which it is held, s.
    pub until: f64,
    /// Side it is put to, ±1.
    pub side: f64,
    /// Largest rudder angle to that side, rad.
    pub rudder: f64,
    /// Rudder angle before, rad.
    pub before: f64,
}

impl Turn {
    /// The turn with the largest rudder; `None` for a rudder that never moves.
    pub fn of(signal: &Polyline) -> Option<Self> {
        let (times, values) = (signal.times(), signal.values());
        let away = |value: f64| value - values[0];
        let largest = values.iter().copied().map(away).max_by(|one, other| one.abs().total_cmp(&other.abs()))?;
        let side = largest.signum();
        let share = |row: usize| away(values[row]) * side / largest.abs();
        let mut start = (0..values.len()).find(|&row| share(row) > HELD)?;
        let until = (start..values.len()).find(|&row| share(row) < HELD).map_or(values.len() - 1, |row| row - 1);
        // Back along the ramp.
        while start > 0 && share(start - 1) > 0.01 {
            start -= 1;
        }
        let rudder = (largest + values[0]) * side;
        Some(Self { execute: times[start.saturating_sub(1)], until: times[until], side, rudder, before: values[0] })
    }

    /// Figures of a turn of which a passage holds this much; its clock begins with that of the record at `start`, s.
    pub fn figures(&self, passage: &SimulatedManoeuvre, start: f64) -> Vec<Figure> {
        let execute = self.execute - start;
        let first = (execute / passage.period).round() as usize;
        let begin = passage.at(&passage.heading, execute);
        let after = SimulatedManoeuvre {
            heading: passage.heading.iter().skip(first).map(|heading| heading - begin).collect(),
            yaw_rate: Vec::new(),
            rudder: Vec::new(),
            executes: Vec::new(),
            way: None,
            period: passage.period,
        };
        let mut figures = Vec::new();
        figures::turn(&after, self.side, &mut figures);
        figures::circle(passage, execute, &mut figures);
        figures
    }

    /// The rudder of the record up to the end of the turn, and held on from there.
    pub fn held_on(&self, signal: &Polyline) -> Option<Polyline> {
        let mut times: Vec<f64> = signal.times().iter().copied().take_while(|time| *time <= self.until).collect();
        let mut values: Vec<f64> = signal.values()[..times.len()].to_vec();
        times.push(self.until + LONGER * (self.until - self.execute));
        values.push(*values.last()?);
        Polyline::new(times, values).ok()
    }
}

/// The passage of a record on rows of a time of the ship, s; with its way where it has a track and the length is known,
/// m. `None` without headings.
pub(crate) fn recorded(trial: &Trial, timescale: f64, length: Option<f64>) -> Option<SimulatedManoeuvre> {
    let period = passage::period(timescale);
    let count = (trial.duration() / period) as usize + 1;
    let rows: Vec<usize> = trial.observed_rows().collect();
    let on_rows = |rows: &[usize], values: &[f64]| -> Option<Vec<f64>> {
        let rows: Vec<usize> = rows.iter().copied().filter(|&row| values[row].is_finite()).collect();
        let times: Vec<f64> = rows.iter().map(|&row| trial.time()[row] - trial.time()[0]).collect();
        let signal = Polyline::new(times, rows.iter().map(|&row| values[row]).collect()).ok()?;
        Some((0..count).map(|row| signal.at(row as f64 * period)).collect())
    };
    let heading = on_rows(&rows, trial.heading())?;
    let all: Vec<usize> = (0..trial.len()).collect();
    let channel = |channel: Channel| on_rows(&all, trial.channel(channel)?);
    let way = || {
        let length = length?;
        let [north, east] = [channel(Channel::North)?, channel(Channel::East)?];
        let rest = |channel: Option<Vec<f64>>| channel.unwrap_or_else(|| vec![f64::NAN; heading.len()]);
        let [surge, sway] = [Channel::Surge, Channel::Sway].map(|own| rest(channel(own)));
        Some(Way { length, surge, sway, track: north.into_iter().zip(east).map(|(n, e)| [n, e]).collect() })
    };
    let slope = |row: usize| match count {
        0 | 1 => 0.0,
        _ => (heading[row + 1] - heading[row]) / period,
    };
    let yaw_rate = (0..count).map(|row| slope(row.min(count.saturating_sub(2)))).collect();
    Some(SimulatedManoeuvre { period, yaw_rate, rudder: Vec::new(), executes: Vec::new(), way: way(), heading })
}
