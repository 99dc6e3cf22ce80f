//! Figures of a record that is a turn, held against what was predicted of its rudder.

pub use motion::Current;
use motion::without_current;
use rand::RngExt;
use rand_distr::StandardNormal;
use ship::Polyline;
use simulate::{Purpose, StreamKey};
use trial::{Channel, Trial};

use crate::figures::{self, Figure};
use crate::passage::{Passage, Way};
use crate::replay::{Compared, at, compared};

/// The uniform current that a circle of 720° or more shows; `None` for any other record, and without positions.
pub fn current_of(trial: &Trial) -> Option<Current> {
    let Turn { execute, until, .. } = Turn::of(trial.rudder_signal())?;
    let (north, east) = (trial.channel(Channel::North)?, trial.channel(Channel::East)?);
    let is_there = |row: &usize| north[*row].is_finite() && east[*row].is_finite();
    let is_turning = |row: &usize| (execute..=until).contains(&trial.time()[*row]);
    let rows: Vec<usize> = trial.observed_rows().filter(is_there).filter(is_turning).collect();
    let of = |values: &[f64]| -> Vec<f64> { rows.iter().map(|&row| values[row]).collect() };
    let track: Vec<[f64; 2]> = rows.iter().map(|&row| [north[row], east[row]]).collect();
    motion::current(&of(trial.time()), &of(trial.heading()), &track)
}

/// Figures of a record that is a turn, and the current that was taken out of its track: the one that is given, else its
/// own where it shows one. The doubt about the current is one of the prediction.
pub(crate) fn turns(
    trial: &Trial,
    made: &[(Passage, Vec<f64>)],
    timescale: f64,
    given: Option<Current>,
) -> (Vec<Compared>, Option<Current>) {
    let nothing = (Vec::new(), None);
    let Some(Turn { execute, until, side }) = Turn::of(trial.rudder_signal()) else { return nothing };
    let Some((sample, _)) = made.first() else { return nothing };
    let [execute, until] = [execute, until].map(|time| time - trial.time()[0]);
    let rows: Vec<usize> = trial.observed_rows().collect();
    let on_rows = |rows: &[usize], values: &[f64]| -> Option<Vec<f64>> {
        let rows: Vec<usize> = rows.iter().copied().filter(|&row| values[row].is_finite()).collect();
        let times: Vec<f64> = rows.iter().map(|&row| trial.time()[row] - trial.time()[0]).collect();
        let signal = Polyline::new(times, rows.iter().map(|&row| values[row]).collect()).ok()?;
        Some((0..sample.heading.len()).map(|row| signal.at(sample.time(row))).collect())
    };
    let Some(heading) = on_rows(&rows, trial.heading()) else { return nothing };
    let all: Vec<usize> = (0..trial.len()).collect();
    let channel = |channel: Channel| on_rows(&all, trial.channel(channel)?);
    let way = || {
        let length = sample.way.as_ref()?.length;
        let [north, east] = [channel(Channel::North)?, channel(Channel::East)?];
        let rest = |channel: Option<Vec<f64>>| channel.unwrap_or_else(|| vec![f64::NAN; heading.len()]);
        let [surge, sway] = [Channel::Surge, Channel::Sway].map(|own| rest(channel(own)));
        Some(Way { length, surge, sway, track: north.into_iter().zip(east).map(|(n, e)| [n, e]).collect() })
    };
    let slope = |row: usize| (heading[row + 1] - heading[row]) / sample.period;
    let count = heading.len();
    let mut record = Passage {
        period: sample.period,
        yaw_rate: (0..count).map(|row| slope(row.min(count.saturating_sub(2)))).collect(),
        rudder: sample.rudder.clone(),
        executes: Vec::new(),
        way: way(),
        heading,
    };
    let current = given.or_else(|| current_of(trial));
    if let Some(current) = current {
        drift(&mut record, current.velocity, execute);
    }
    let figures = |passage: &Passage| -> Vec<Figure> {
        let whole = passage.until(until);
        let passage = &whole;
        let first = (execute / passage.period).round() as usize;
        let start = at(passage, &passage.heading, execute);
        let after = Passage {
            heading: passage.heading.iter().skip(first).map(|heading| heading - start).collect(),
            yaw_rate: Vec::new(),
            rudder: Vec::new(),
            executes: Vec::new(),
            way: None,
            period: passage.period,
        };
        let mut figures = Vec::new();
        figures::turn(&after, side, &mut figures);
        figures::circle(&whole, execute, &mut figures);
        figures
    };
    let measured = figures(&record);
    let is_turn = trial.duration() > timescale && measured.iter().any(|(_, value)| value.is_some());
    if !is_turn {
        return nothing;
    }
    let doubtful = |(number, (passage, _)): (usize, &(Passage, Vec<f64>))| {
        let Some(current) = current else { return figures(passage) };
        let mut rng = StreamKey { seed: 0, cell: 0, replicate: number as u64 }.indexed(Purpose::Specification, 3);
        let error = current.deviation.map(|sd| sd * rng.sample::<f64, _>(StandardNormal));
        let mut passage = passage.clone();
        drift(&mut passage, error, execute);
        figures(&passage)
    };
    let drawn: Vec<Vec<Figure>> = made.iter().enumerate().map(doubtful).collect();
    let compared = compared(&drawn, |name| measured.iter().find(|(own, _)| *own == name).and_then(|(_, value)| *value));
    (compared, current)
}

/// Takes a current (m/s), which began to act at `execute` s, out of the track of a passage.
fn drift(passage: &mut Passage, velocity: [f64; 2], execute: f64) {
    let time: Vec<f64> = (0..passage.heading.len()).map(|row| passage.time(row)).collect();
    if let Some(way) = &mut passage.way {
        way.track = without_current(&time, &way.track, velocity, execute);
    }
}

/// A rudder that is put over and held.
struct Turn {
    /// Time at which it leaves its beginning, s.
    execute: f64,
    /// Time until which it is held, s.
    until: f64,
    /// Side it is put to, ±1.
    side: f64,
}

/// Share of the largest angle above which a rudder is held.
const HELD: f64 = 0.8;

impl Turn {
    /// The turn with the largest rudder; `None` for a rudder that never moves.
    fn of(signal: &Polyline) -> Option<Self> {
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
        Some(Self { execute: times[start.saturating_sub(1)], until: times[until], side })
    }
}
