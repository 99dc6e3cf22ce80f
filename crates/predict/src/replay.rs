//! Replay of a recorded rudder, compared with its record: the record is not fitted, so it tests the intervals.

use indexmap::IndexMap;
use rand::RngExt;
use rand_distr::StandardNormal;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use ship::Polyline;
use ship::angle::to_deg;
use simulate::disturbance::Wind;
use simulate::motion::Current;
use simulate::{Manoeuvre, RngPurpose, StreamKey};
use trial::{Quantity, RecordOrigin, Trial, ZigZag as Measured};

use crate::error::PredictError;
use crate::figures::{self, Characteristics};
use crate::helm_replay::{self, SteeredZigZag};
use crate::interval::{PredictionInterval, quantiles};
use crate::line::StraightLine;
use crate::mixture::{ShipMixture, UncertaintySource};
use crate::prediction::{BandedCurve, check_completed, parallel_draws, too_few_error};
use crate::simulated_manoeuvre::SimulatedManoeuvre;
use crate::turn::{self, HeldTurn, TurnTracks};

/// Duration of the fit of the initial heading and yaw rate of a record, in timescales of the ship.
const BEGINNING: f64 = 1.0;

/// Minimum number of readings for that fit.
const MIN_READINGS: usize = 5;

/// Figure of merit of a record with its prediction.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[schemars(rename = "Compared")]
pub struct ComparedFigure {
    /// Measured value.
    pub measured: f64,
    /// Predicted interval, with the error of the measured value if the record gives it.
    #[serde(flatten)]
    pub interval: PredictionInterval,
    /// `true` if the 90 % interval contains the measured value.
    pub inside90: bool,
}

/// Record with its prediction; the curves are in a separate file (PredictCurves).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct RecordReplay {
    /// File, as the user named it.
    pub file: String,
    /// Share of the measured headings inside the 90 % band of a reading.
    pub band_coverage_90: f64,
    /// Root mean square difference between the headings and the most probable ship.
    pub heading_rmse_deg: f64,
    /// `true` if rudder or yaw rate of the record are beyond the range of the fitted records.
    #[serde(default)]
    pub extrapolated: bool,
    /// Current removed from the track.
    pub current: Option<Current>,
    /// Figures of merit that the record shows, by name.
    pub figures: IndexMap<String, ComparedFigure>,
    /// Name of the record.
    #[serde(default)]
    pub name: String,
    /// Tracks of a turn with positions.
    #[serde(skip)]
    pub tracks: Option<TurnTracks>,
    /// Time from the first row, s, and rudder, rad.
    #[serde(skip)]
    pub rudder_times_and_angles: [Vec<f64>; 2],
    /// Heading with the band of a reading, at the rows of the record.
    #[serde(skip)]
    pub heading_band: BandedCurve,
    /// Measured headings at these rows, rad.
    #[serde(skip)]
    pub measured_heading: Vec<f64>,
}

/// File of a measured record, as the user named it; the name of a simulated record.
pub fn record_file(trial: &Trial) -> &str {
    match trial.origin() {
        RecordOrigin::Measured { file, .. } => file,
        RecordOrigin::Simulated { .. } => trial.name(),
    }
}

/// Tolerance of a straight rudder between two readings, rad: a hundredth of a degree.
const STRAIGHT_TOLERANCE_RAD: f64 = 2e-4;

/// Corners of a rudder (Douglas and Peucker 1973), at which the steps of the solver end.
pub(crate) fn simplified(signal: &Polyline) -> Polyline {
    let (times, values) = (signal.times(), signal.values());
    let last = times.len() - 1;
    let mut kept = vec![false; times.len()];
    (kept[0], kept[last]) = (true, true);
    let mut open = vec![(0, last)];
    while let Some((from, to)) = open.pop() {
        let slope = (values[to] - values[from]) / (times[to] - times[from]);
        let off = |row: usize| (values[row] - values[from] - slope * (times[row] - times[from])).abs();
        let worst = (from + 1..to).max_by(|a, b| off(*a).total_cmp(&off(*b)));
        if let Some(row) = worst.filter(|row| off(*row) > STRAIGHT_TOLERANCE_RAD) {
            kept[row] = true;
            open.extend([(from, row), (row, to)]);
        }
    }
    let kept_values = |all: &[f64]| all.iter().zip(&kept).filter(|(_, kept)| **kept).map(|(value, _)| *value).collect();
    Polyline::new(kept_values(times), kept_values(values)).unwrap_or_else(|_| signal.clone())
}

impl ShipMixture {
    /// Replays the rudder of a record and compares the prediction with it; the ship must be at the scale of the record.
    ///
    /// The band is for the recorded rudder from the first heading and yaw rate on. Characteristics of a zig-zag are
    /// computed with a helm that reverses the rudder at the recorded headings, because a replayed rudder does not
    /// follow the heading. A hull is in the mean wind of the record, if it was measured. `current` is the current
    /// removed from the positions of the record ([`without_current`](turn::without_current)). `None` if the record has
    /// too few headings at its beginning.
    ///
    /// Fails if less than half of the drawn ships complete the replay.
    pub fn replay(
        &self,
        trial: &Trial,
        draws: usize,
        current: Option<Current>,
    ) -> Result<Option<RecordReplay>, PredictError> {
        let start = trial.time()[0];
        let manoeuvre = Manoeuvre::replay(simplified(trial.rudder_signal()));
        let ships = self.in_wind_of(trial);
        let Some([first, rate]) = ships.initial_motion(trial)? else { return Ok(None) };
        let sail = |number: u64, sources: &[UncertaintySource]| {
            let mut ship = ships.draw_ship(number, sources);
            let mut rng = ship.moment_key.rng(RngPurpose::Heading);
            let [of_heading, of_rate]: [f64; 2] = std::array::from_fn(|_| rng.sample(StandardNormal));
            let noise_factor = if sources.is_empty() { 0.0 } else { 1.0 };
            ship.initial_yaw_rate = rate.0 + noise_factor * rate.1 * of_rate;
            let mut passage = SimulatedManoeuvre::simulate(&ship, &manoeuvre, self.timescale()).ok()?;
            passage.rotate_course(first.0 + noise_factor * first.1 * of_heading);
            Some((passage, rng))
        };
        let rows: Vec<usize> = trial.observed_rows().collect();
        let time: Vec<f64> = rows.iter().map(|&row| trial.time()[row] - start).collect();
        let at_rows = |passage: &SimulatedManoeuvre| -> Vec<f64> {
            time.iter().map(|time| passage.interpolated(&passage.heading, *time)).collect()
        };
        let of_draw = |number| {
            let (passage, mut rng) = sail(number, &UncertaintySource::ALL)?;
            let noise = self.first_ship().noise.heading_sd_rad;
            let mut headings = at_rows(&passage);
            headings.iter_mut().for_each(|heading| *heading += noise * rng.sample::<f64, _>(StandardNormal));
            Some((passage, headings))
        };
        let (made, headings): (Vec<SimulatedManoeuvre>, Vec<Vec<f64>>) =
            parallel_draws(draws, of_draw).into_iter().flatten().unzip();
        check_completed(trial.name(), made.len(), draws)?;
        let (most_probable, _) = sail(0, &[]).ok_or_else(|| too_few_error(trial.name(), made.len(), draws))?;
        let measured: Vec<f64> = rows.iter().map(|&row| trial.heading()[row]).collect();
        let bands = (0..rows.len()).map(|row| quantiles(&mut headings.iter().map(|psi| psi[row]).collect::<Vec<_>>()));
        let heading = BandedCurve { quantiles: bands.collect(), most_probable: at_rows(&most_probable), time };
        let inside = |(measured, band): (&f64, &[f64; 5])| (band[0]..=band[4]).contains(measured);
        let held = measured.iter().zip(&heading.quantiles).filter(|pair| inside(*pair)).count();
        let largest_rates = made.iter().map(SimulatedManoeuvre::max_yaw_rate);
        let (figures, tracks) = match Measured::from_trial(trial) {
            Ok(zigzag) if zigzag.executes.len() > 1 => (ships.zig_zag(trial, &zigzag, draws)?, None),
            _ => turns(trial, &most_probable, &made, self.timescale(), current),
        };
        Ok(Some(RecordReplay {
            file: record_file(trial).to_owned(),
            name: trial.name().to_owned(),
            rudder_times_and_angles: [trial.time().iter().map(|time| time - start).collect(), trial.rudder().to_vec()],
            band_coverage_90: held as f64 / rows.len() as f64,
            heading_rmse_deg: to_deg(rms_difference(&measured, &heading.most_probable)),
            extrapolated: ships.is_extrapolated(trial.largest_rudder(), largest_rates),
            figures,
            tracks,
            current,
            heading_band: heading,
            measured_heading: measured,
        }))
    }

    /// Same ships in the mean wind of a record, if measured; it acts on hulls only.
    fn in_wind_of(&self, trial: &Trial) -> Self {
        let approach = trial.observed_rows().next().map(|row| trial.heading()[row]);
        let mut ships = self.clone();
        ships.wind = approach.zip(trial.mean_true_wind()).map(|(heading, [speed, from])| Wind {
            moment: 0.0,
            from_direction: from - heading,
            speed: Some(speed),
            gusting: None,
        });
        ships
    }

    /// Overshoots, times and period of a measured zig-zag, compared with its simulation.
    fn zig_zag(&self, trial: &Trial, measured: &Measured, draws: usize) -> Result<ByName, PredictError> {
        let Some(steered) = SteeredZigZag::from_measured(measured, self.first_ship().approach_yaw_rate_rad_s) else {
            return Ok(ByName::new());
        };
        let drawn = steered.draws(self, draws).into_iter().flatten();
        let drawn: Vec<Characteristics> = drawn.map(|result| result.figures).collect();
        check_completed(&steered.manoeuvre, drawn.len(), draws)?;
        Ok(compared(&drawn, |name| self.measured_characteristic(trial, measured, name)))
    }

    /// Characteristic of a measured zig-zag; `None` if the record does not show it. For a model without speed the
    /// distance of the initial turning is V times the time if the record has no distance.
    pub(crate) fn measured_characteristic(&self, trial: &Trial, measured: &Measured, name: &str) -> Option<Quantity> {
        let particulars = self.particulars();
        let has_way = !self.first_ship().hulls.is_empty();
        let stand_in = trial.particulars().or(particulars).filter(|_| !has_way);
        helm_replay::measured_characteristic(trial, measured, name, particulars.map(|ship| ship.length), stand_in)
    }

    /// First heading (rad) and yaw rate (rad/s) of a record, with standard deviations: ordinate and slope of a straight
    /// line through the differences between the first readings and the replay of the most probable ship from zero
    /// heading and yaw rate. `None` if the record has too few headings at its beginning; fails if that replay does.
    pub(crate) fn initial_motion(&self, trial: &Trial) -> Result<Option<[(f64, f64); 2]>, PredictError> {
        let manoeuvre = Manoeuvre::replay(simplified(trial.rudder_signal()));
        let at_rest = SimulatedManoeuvre::simulate(&self.most_probable(), &manoeuvre, self.timescale());
        let at_rest = at_rest.map_err(|_| too_few_error(trial.name(), 0, 1))?;
        let read = |row: usize| {
            let time = trial.time()[row] - trial.time()[0];
            (time, trial.heading()[row] - at_rest.interpolated(&at_rest.heading, time))
        };
        let rows: Vec<(f64, f64)> = trial.observed_rows().map(read).collect();
        let count = rows.iter().take_while(|(time, _)| *time <= BEGINNING * self.timescale()).count();
        let line = StraightLine::through(rows.into_iter().take(count.max(MIN_READINGS)));
        Ok(line.map(|line| [line.at_zero(), (line.slope, line.slope_sd())]))
    }
}

/// Root mean square difference of two curves at the same rows.
fn rms_difference(one: &[f64], other: &[f64]) -> f64 {
    let squares: f64 = one.iter().zip(other).map(|(one, other)| (one - other).powi(2)).sum();
    (squares / one.len() as f64).sqrt()
}

/// Comparisons by name.
type ByName = IndexMap<String, ComparedFigure>;

/// Comparison of measured characteristics with their draws, each draw with the error of the measured characteristic.
fn compared(drawn: &[Characteristics], shown: impl Fn(&str) -> Option<Quantity>) -> ByName {
    let figure = |(number, &name): (usize, &&'static str)| {
        let Quantity { value: measured, sd, .. } = shown(name)?;
        let mut rng = StreamKey::default().indexed_rng(RngPurpose::Heading, 1 + number as u32);
        let mut read = |value: f64| value + sd.unwrap_or(0.0) * rng.sample::<f64, _>(StandardNormal);
        let mut values: Vec<f64> = drawn.iter().filter_map(|figures| figures[name].map(&mut read)).collect();
        let interval =
            PredictionInterval::from_samples(&mut values).filter(|interval| figures::is_possible(name, interval))?;
        Some((name.to_owned(), ComparedFigure { measured, interval, inside90: interval.contains_90(measured) }))
    };
    drawn.first().into_iter().flat_map(|first| first.keys().enumerate()).filter_map(figure).collect()
}

/// Characteristics of a recorded turn, and its tracks.
///
/// The uncertainty of a removed current is included in the prediction.
fn turns(
    trial: &Trial,
    most_probable: &SimulatedManoeuvre,
    made: &[SimulatedManoeuvre],
    timescale: f64,
    current: Option<Current>,
) -> (ByName, Option<TurnTracks>) {
    let length = made.first().and_then(|first| Some(first.planar_motion.as_ref()?.length));
    let turn = HeldTurn::from_trial(trial).zip(turn::resampled_record(trial, timescale, length));
    let Some((turn, record)) = turn.filter(|_| trial.duration() > timescale) else { return (ByName::new(), None) };
    let measured = turn.characteristics_within_record(&record);
    let drawn_figures = |(number, passage): (usize, &SimulatedManoeuvre)| match current {
        None => turn.characteristics_within_record(passage),
        Some(current) => {
            turn.characteristics_within_record(&turn::with_current_error(passage, &current, number as u64))
        }
    };
    let drawn: Vec<Characteristics> = made.iter().enumerate().map(drawn_figures).collect();
    let figures = compared(&drawn, |name| measured.get(name).copied().flatten().map(Quantity::without_uncertainty));
    (figures, TurnTracks::from_ships(&turn, &record, most_probable, made))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing;
    use document::IdentifiedShip;
    use ship::angle::from_deg;
    use trial::{Channel, Columns};

    /// Records of ships drawn as in the prediction lie within its 90 % intervals nine times out of ten.
    #[test]
    fn intervals_hold_the_records_of_such_ships() {
        let mixture = testing::mixture(testing::identified_ship());
        let (mut inside, mut all, mut band) = (0, 0, 0.0);
        let records = 40;
        for number in 0..records {
            let trial = testing::record(&mixture, "zig-zag:20/20", 1000 + number, from_deg(0.1), 1.0);
            let replayed = mixture.replay(&trial, 100, None).expect("it sails").expect("it begins");
            let held = replayed.figures.values().filter(|figure| figure.inside90).count();
            inside += held;
            all += replayed.figures.len();
            band += replayed.band_coverage_90 / f64::from(records as u32);
        }
        let share = inside as f64 / all as f64;
        assert!((0.80..=0.97).contains(&share), "{inside} of {all}");
        assert!((0.80..=0.97).contains(&band), "{band}");
    }

    /// A helm that is late reverses the rudder at 11.5° in a 10/10 zig-zag; the initial turning ends at 10°.
    #[test]
    fn the_initial_turning_ends_at_the_nominal_heading() {
        let mixture = testing::mixture(testing::identified_ship());
        let trial = testing::record(&mixture, "zig-zag:10/11.5", 0, from_deg(0.001), 0.5);
        let replayed = mixture.replay(&trial, 100, None).expect("it sails").expect("it begins");
        let [turning, second] = ["initial_turning_time_s", "second_execute_s"].map(|name| &replayed.figures[name]);
        assert!(turning.measured < 0.95 * second.measured, "{turning:?} {second:?}");
        for figure in [turning, second] {
            assert!((figure.interval.median / figure.measured - 1.0).abs() < 0.03, "{figure:?}");
        }
    }

    #[test]
    fn a_rudder_is_its_corners() {
        let times: Vec<f64> = (0..400).map(f64::from).collect();
        let angle = |t: f64| (0.02 * (t - 50.0)).clamp(0.0, 0.3) - (0.02 * (t - 200.0)).clamp(0.0, 0.6);
        let signal = Polyline::new(times.clone(), times.iter().map(|t| angle(*t)).collect()).expect("increasing");
        let thin = simplified(&signal);
        assert!(thin.times().len() <= 8, "{:?}", thin.times());
        assert!(times.iter().all(|t| (thin.value_at(*t) - signal.value_at(*t)).abs() <= STRAIGHT_TOLERANCE_RAD));
    }

    /// The mean wind of a record acts on a hull relative to the course of the approach, but not on a structure and not
    /// in a calm.
    #[test]
    fn hulls_meet_the_wind_of_a_record() {
        let ship = IdentifiedShip { hulls: vec![testing::hull("quadratic")], ..testing::identified_ship() };
        let wind = [(Channel::WindTrueSpeed, 9.0), (Channel::WindTrueFrom, 0.5), (Channel::Speed, 6.0)];
        let time: Vec<f64> = (0..100).map(f64::from).collect();
        let channels = [(Channel::Rudder, 0.1), (Channel::Heading, 0.2)].into_iter().chain(wind);
        let channels = channels.map(|(channel, value)| (channel, vec![value; time.len()])).collect();
        let origin = RecordOrigin::Measured { file: "made up".into(), sha256: String::new() };
        let trial =
            Trial::new("blown", origin, Columns { time, channels, unknown_columns: Vec::new() }).expect("a record");
        let of = |ship: IdentifiedShip| testing::mixture(ship).in_wind_of(&trial).draw_ship(1, &UncertaintySource::ALL);
        let met = of(ship.clone()).disturbances.wind.expect("a wind");
        assert!((met.from_direction - 0.3).abs() < 1e-12 && (met.speed.expect("known") - 9.0).abs() < 1e-12, "{met:?}");
        assert_eq!(of(testing::identified_ship()).disturbances.wind, None);
        assert_eq!(of(ship.in_calm().expect("known")).hull.expect("a hull").hull.windage, 0.0);
    }

    #[test]
    fn a_circle_has_the_figures_of_a_turn() {
        let mixture = testing::mixture(testing::identified_ship());
        let trial = testing::record(&mixture, "turning-circle:-15", 3, from_deg(0.1), 1.0);
        let replayed = mixture.replay(&trial, 50, None).expect("it sails").expect("it begins");
        let names: Vec<&String> = replayed.figures.keys().collect();
        assert_eq!(names, ["time_to_90_s", "time_to_180_s", "steady_rate_deg_s"]);
        let beyond = testing::record(&mixture, "turning-circle:35", 3, from_deg(0.1), 1.0);
        let beyond = mixture.replay(&beyond, 50, None).expect("it sails").expect("it begins");
        assert!(beyond.extrapolated && !replayed.extrapolated, "the records have 20° of rudder");
        for figure in replayed.figures.values() {
            assert!((figure.measured / figure.interval.median - 1.0).abs() < 0.2, "{figure:?}");
        }
    }
}
