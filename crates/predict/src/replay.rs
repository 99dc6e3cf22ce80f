//! A recorded rudder replayed and held against its record: the record is not fitted, so it says whether intervals hold.

use motion::Current;
use rand::RngExt;
use rand_distr::StandardNormal;
use rayon::prelude::*;
use ship::Polyline;
use simulate::manoeuvre::{ZigZag, ZigZagEnd};
use simulate::{Manoeuvre, Purpose, Side};
use trial::{Trial, ZigZag as Measured};

use crate::error::PredictError;
use crate::figures::{self, EXECUTE_TIMES, Figure, OVERSHOOTS};
use crate::interval::{Interval, band};
use crate::kind::{EXECUTES, Kind};
use crate::mixture::{Mixture, Source};
use crate::passage::Passage;
use crate::prediction::{Bands, enough};
use crate::turn;

/// Beginning of a record from which its first heading and yaw rate are read, in times of the ship.
const BEGINNING: f64 = 1.0;

/// Share by which a mean angle of a zig-zag may be off the nominal one that was ordered.
const NOMINAL: f64 = 0.05;

/// Fewest readings for it.
const FEWEST: usize = 5;

/// A figure of a record with its prediction.
#[derive(Debug, Clone, PartialEq)]
pub struct Compared {
    /// Its name, with the unit.
    pub name: &'static str,
    /// What the record shows.
    pub measured: f64,
    /// What was predicted.
    pub interval: Interval,
}

/// A record with its prediction.
#[derive(Debug, Clone, PartialEq)]
pub struct Replayed {
    /// Share of the measured headings inside the 90 % band of a reading.
    pub band_coverage_90: f64,
    /// Root mean square difference between the headings and the most probable ship, rad.
    pub rms: f64,
    /// Figures that the record shows.
    pub figures: Vec<Compared>,
    /// The current that was taken out of the track of the record.
    pub current: Option<Current>,
    /// Heading with the band of a reading, at the rows of the record.
    pub heading: Bands,
    /// Measured headings at these rows, rad.
    pub measured: Vec<f64>,
}

/// First heading (rad) and yaw rate (rad/s) of a record with their standard deviations: a straight line through what
/// the readings of its beginning are away from a ship that begins on heading 0 without a yaw rate.
fn beginning(trial: &Trial, at_rest: &Passage, timescale: f64) -> Option<[(f64, f64); 2]> {
    let start = trial.time()[0];
    let read = |row: usize| {
        let time = trial.time()[row] - start;
        (time, trial.heading()[row] - at(at_rest, &at_rest.heading, time))
    };
    let rows: Vec<(f64, f64)> = trial.observed_rows().map(read).collect();
    let count = rows.iter().take_while(|(time, _)| *time <= BEGINNING * timescale).count();
    let rows = &rows[..count.max(FEWEST.min(rows.len()))];
    let n = rows.len() as f64;
    let [time, heading] = [0, 1].map(|k| rows.iter().map(|row| [row.0, row.1][k]).sum::<f64>() / n);
    let spread: f64 = rows.iter().map(|row| (row.0 - time).powi(2)).sum();
    if rows.len() < 3 || spread <= 0.0 {
        return None;
    }
    let rate = rows.iter().map(|row| (row.0 - time) * (row.1 - heading)).sum::<f64>() / spread;
    let residual: f64 = rows.iter().map(|row| (row.1 - heading - rate * (row.0 - time)).powi(2)).sum();
    let variance = residual / (n - 2.0);
    let first = (heading - rate * time, (variance / n + variance * time * time / spread).sqrt());
    Some([first, (rate, (variance / spread).sqrt())])
}

/// Difference up to which a rudder is straight between two readings, rad: a hundredth of a degree.
const STRAIGHT: f64 = 2e-4;

/// The corners of a rudder (Douglas and Peucker 1973): a step of the solver ends at every one.
fn thinned(signal: &Polyline) -> Polyline {
    let (times, values) = (signal.times(), signal.values());
    let last = times.len() - 1;
    let mut kept = vec![false; times.len()];
    (kept[0], kept[last]) = (true, true);
    let mut open = vec![(0, last)];
    while let Some((from, to)) = open.pop() {
        let slope = (values[to] - values[from]) / (times[to] - times[from]);
        let off = |row: usize| (values[row] - values[from] - slope * (times[row] - times[from])).abs();
        let worst = (from + 1..to).max_by(|one, other| off(*one).total_cmp(&off(*other)));
        if let Some(row) = worst.filter(|row| off(*row) > STRAIGHT) {
            kept[row] = true;
            open.extend([(from, row), (row, to)]);
        }
    }
    let only = |all: &[f64]| all.iter().zip(&kept).filter(|(_, kept)| **kept).map(|(value, _)| *value).collect();
    Polyline::new(only(times), only(values)).unwrap_or_else(|_| signal.clone())
}

impl Mixture {
    /// Replays the rudder of a record and holds the prediction against it; the ship has to be of its scale.
    ///
    /// The band is that of the recorded rudder from the first heading and yaw rate on. Figures of a zig-zag are those
    /// of a helm that reverses the rudder where the record did, because a rudder that is replayed knows nothing of the
    /// heading. The track of a turn is that without the current of another record where one is given, else without its
    /// own where it goes on for two rounds. `None` where the record has too few headings at its beginning.
    pub fn replay(
        &self,
        trial: &Trial,
        draws: usize,
        current: Option<Current>,
    ) -> Result<Option<Replayed>, PredictError> {
        let start = trial.time()[0];
        let manoeuvre = Manoeuvre::Replay(thinned(trial.rudder_signal()));
        let lost = |made: usize| PredictError::Lost { kind: trial.name().to_owned(), made, draws };
        let at_rest = Passage::sail(&self.most_probable(), &manoeuvre, self.timescale()).map_err(|_| lost(0))?;
        let Some([first, rate]) = beginning(trial, &at_rest, self.timescale()) else { return Ok(None) };
        let sail = |number: usize, sources: &[Source]| {
            let mut ship = self.draw(number as u64, sources);
            let mut rng = ship.key.rng(Purpose::Heading);
            let [of_heading, of_rate]: [f64; 2] = std::array::from_fn(|_| rng.sample(StandardNormal));
            let doubt = if sources.is_empty() { 0.0 } else { 1.0 };
            ship.yaw_rate = rate.0 + doubt * rate.1 * of_rate;
            let mut passage = Passage::sail(&ship, &manoeuvre, self.timescale()).ok()?;
            let offset = first.0 + doubt * first.1 * of_heading;
            passage.turn_about(offset);
            Some((passage, rng))
        };
        let rows: Vec<usize> = trial.observed_rows().collect();
        let at_rows = |passage: &Passage| -> Vec<f64> {
            rows.iter().map(|&row| at(passage, &passage.heading, trial.time()[row] - start)).collect()
        };
        let made: Vec<(Passage, Vec<f64>)> = (0..draws)
            .into_par_iter()
            .filter_map(|number| {
                let (passage, mut rng) = sail(number, &Source::ALL)?;
                let noise = self.first().noise.heading_sd_rad;
                let mut headings = at_rows(&passage);
                headings.iter_mut().for_each(|heading| *heading += noise * rng.sample::<f64, _>(StandardNormal));
                Some((passage, headings))
            })
            .collect();
        let most_probable = sail(0, &[]).map(|(passage, _)| passage);
        enough(trial.name(), made.len(), draws)?;
        let Some(most_probable) = most_probable else { return Err(lost(made.len())) };
        let measured: Vec<f64> = rows.iter().map(|&row| trial.heading()[row]).collect();
        let mut heading = Bands {
            time: rows.iter().map(|&row| trial.time()[row] - start).collect(),
            most_probable: at_rows(&most_probable),
            quantiles: Vec::with_capacity(rows.len()),
        };
        let mut values = Vec::with_capacity(made.len());
        for row in 0..rows.len() {
            values.clear();
            values.extend(made.iter().map(|(_, headings)| headings[row]));
            heading.quantiles.push(band(&mut values));
        }
        let inside = |(measured, band): (&f64, &[f64; 5])| (band[0]..=band[4]).contains(measured);
        let held = measured.iter().zip(&heading.quantiles).filter(|pair| inside(*pair)).count();
        let square: f64 = measured.iter().zip(&heading.most_probable).map(|(one, other)| (one - other).powi(2)).sum();
        let (figures, current) = match Measured::of(trial) {
            Ok(zigzag) if zigzag.executes.len() > 1 => (self.zig_zag(&zigzag, draws)?, None),
            _ => turn::turns(trial, &made, self.timescale(), current),
        };
        Ok(Some(Replayed {
            band_coverage_90: held as f64 / rows.len() as f64,
            rms: (square / rows.len() as f64).sqrt(),
            figures,
            current,
            heading,
            measured,
        }))
    }

    /// Overshoots, times and period of a measured zig-zag, steered anew.
    fn zig_zag(&self, measured: &Measured, draws: usize) -> Result<Vec<Compared>, PredictError> {
        let Some(side) = measured.side else { return Ok(Vec::new()) };
        let executes = &measured.executes;
        let base = measured.base_course.heading.value;
        let mean = |values: Vec<f64>| values.iter().sum::<f64>() / values.len() as f64;
        let rudder = mean(executes.iter().map(|execute| execute.rudder_after.abs()).collect());
        let heading = mean(executes[1..].iter().map(|execute| (execute.heading.value - base).abs()).collect());
        // Orders are whole numbers where readings are near to them.
        let [rudder, heading] = match measured.pair {
            Some(pair) => [(rudder, pair.rudder), (heading, pair.heading)]
                .map(|(read, nominal)| if (read - nominal).abs() < NOMINAL * nominal { nominal } else { read }),
            None => [rudder, heading],
        };
        let first = if side.sign() > 0.0 { Side::Starboard } else { Side::Port };
        let kind = Kind::ZigZag { rudder, heading, first };
        let end = ZigZagEnd::Executes(EXECUTES);
        let manoeuvre = Manoeuvre::ZigZag(ZigZag { rudder, heading, first, end });
        // An approach is nearly straight, and a slope that is read off a few headings is not known well.
        let approach = self.first().approach_yaw_rate_rad_s;
        let rate = executes[0].yaw_rate.map_or(0.0, |rate| {
            let doubt = rate.sd.unwrap_or(0.0);
            if approach + doubt > 0.0 {
                rate.value * approach.powi(2) / (approach.powi(2) + doubt.powi(2))
            } else {
                0.0
            }
        });
        let drawn: Vec<Vec<Figure>> = (0..draws)
            .into_par_iter()
            .filter_map(|number| {
                let mut ship = self.draw(number as u64, &Source::ALL);
                ship.yaw_rate = rate;
                if let Some(rate) = measured.rudder_rate {
                    ship.gear.rate = rate;
                }
                let passage = Passage::sail(&ship, &manoeuvre, self.timescale()).ok()?;
                Some(figures::of(&kind, &passage, None))
            })
            .collect();
        enough(kind, drawn.len(), draws)?;
        let begin = executes[0].time.value;
        let value = |name: &str| -> Option<f64> {
            let overshoot = |n| measured.nth_overshoot(n).map(|overshoot| ship::angle::to_deg(overshoot.angle.value));
            let execute = |n: usize| executes.get(n).map(|execute| execute.time.value - begin);
            let place = |names: &[&str]| names.iter().position(|own| *own == name).map(|place| place + 1);
            match (place(&OVERSHOOTS), place(&EXECUTE_TIMES), name) {
                (Some(number), ..) => overshoot(number),
                (_, Some(number), _) => execute(number),
                (.., "initial_turning_time_s") => measured.initial_turning_time.map(|time| time.value),
                (.., "period_s") => measured.period.map(|period| period.value),
                _ => None,
            }
        };
        Ok(compared(&drawn, value))
    }
}

/// Figures that were measured, beside their draws.
pub(crate) fn compared(drawn: &[Vec<Figure>], measured: impl Fn(&str) -> Option<f64>) -> Vec<Compared> {
    let Some(names) = drawn.first() else { return Vec::new() };
    names
        .iter()
        .enumerate()
        .filter_map(|(place, &(name, _))| {
            let measured = measured(name)?;
            let mut values: Vec<f64> = drawn.iter().filter_map(|figures| figures[place].1).collect();
            Some(Compared { name, measured, interval: Interval::of(&mut values)? })
        })
        .collect()
}

/// A series on the rows of a passage at a time, s.
pub(crate) fn at(passage: &Passage, values: &[f64], time: f64) -> f64 {
    let place = (time / passage.period).clamp(0.0, (values.len() - 1) as f64);
    let (low, share) = (place.floor() as usize, place.fract());
    let high = (low + 1).min(values.len() - 1);
    values[low] + share * (values[high] - values[low])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::made_up;
    use ship::angle::from_deg;
    use simulate::{Simulation, StreamKey, Vessel};

    /// A record of the ship that is known, with the noise that is known.
    fn record(mixture: &Mixture, manoeuvre: Manoeuvre, number: u64) -> Trial {
        let ship = mixture.draw(number, &Source::ALL);
        let mut simulation = Simulation::new(Vessel::response(ship.response), manoeuvre);
        simulation.gear = ship.gear;
        simulation.disturbances = ship.disturbances;
        simulation.sensors.heading.noise = from_deg(0.1);
        simulation.recording.period = 1.0;
        let key = StreamKey { seed: 5, cell: 0, replicate: number };
        simulation.run(&key).expect("a trial").trial
    }

    /// Records of ships that are drawn as the prediction draws them lie in its intervals nine times out of ten.
    #[test]
    fn intervals_hold_the_records_of_such_ships() {
        let mixture = Mixture::new(vec![(made_up::known(), 1.0)]).expect("made up");
        let kind: Kind = "zig-zag:20/20".parse().expect("known");
        let manoeuvre = kind.manoeuvre(mixture.timescale()).expect("steered");
        let (mut inside, mut all, mut band) = (0, 0, 0.0);
        let records = 40;
        for number in 0..records {
            let trial = record(&mixture, manoeuvre.clone(), 1000 + number);
            let replayed = mixture.replay(&trial, 100, None).expect("it sails").expect("it begins");
            let held = replayed.figures.iter().filter(|figure| figure.interval.holds90(figure.measured)).count();
            inside += held;
            all += replayed.figures.len();
            band += replayed.band_coverage_90 / f64::from(records as u32);
        }
        let share = inside as f64 / all as f64;
        assert!((0.80..=0.97).contains(&share), "{inside} of {all}");
        assert!((0.80..=0.97).contains(&band), "{band}");
    }

    #[test]
    fn a_rudder_is_its_corners() {
        let times: Vec<f64> = (0..400).map(f64::from).collect();
        let angle = |t: f64| (0.02 * (t - 50.0)).clamp(0.0, 0.3) - (0.02 * (t - 200.0)).clamp(0.0, 0.6);
        let signal = Polyline::new(times.clone(), times.iter().map(|t| angle(*t)).collect()).expect("increasing");
        let thin = thinned(&signal);
        assert!(thin.times().len() <= 8, "{:?}", thin.times());
        assert!(times.iter().all(|t| (thin.at(*t) - signal.at(*t)).abs() <= STRAIGHT));
    }

    #[test]
    fn a_circle_has_the_figures_of_a_turn() {
        let mixture = Mixture::new(vec![(made_up::known(), 1.0)]).expect("made up");
        let kind: Kind = "turning-circle:-15".parse().expect("known");
        let trial = record(&mixture, kind.manoeuvre(mixture.timescale()).expect("steered"), 3);
        let replayed = mixture.replay(&trial, 50, None).expect("it sails").expect("it begins");
        let names: Vec<&str> = replayed.figures.iter().map(|figure| figure.name).collect();
        assert_eq!(names, ["time_to_90_s", "time_to_180_s", "steady_rate_deg_s"]);
        for figure in &replayed.figures {
            assert!((figure.measured / figure.interval.median - 1.0).abs() < 0.2, "{figure:?}");
        }
    }
}
