//! Which noise a record shows: every kind is fitted, and the lowest BIC wins.

use ship::FirstOrder;
use trial::Trial;

use super::outliers::{self, LARGEST_SHARE, Suspects};
use super::point::{Point, Record, evaluate, readings};
use super::search::{Maximum, Ranges, Search, Start, gyro_start};
use super::settings::{CompassChoice, RudderChoice, Settings};
use crate::error::IdentifyError;
use crate::estimate::Estimate;
use crate::likelihood::NoiseVector;
use crate::likelihood::parameters::{COMPASS, RUDDER};
use crate::likelihood::track::{Coefficients, MotionColumns, Track};
use crate::output_error::{self, CONDITION_LIMIT, FEWEST_ROWS};
use crate::replay::best_start;
use crate::robust;
use crate::samples::track;
use trial::noise_model::Moment;

/// Rounds in which outliers are looked for again in the fit without the last ones.
const ROUNDS: usize = 12;

/// Gain in −2 log L, beside log n, that a jump of the compass needs.
const JUMP_GAIN: f64 = 25.0;

/// Values of 1/T per decade, for each sign, that are asked again under the noise that was found.
const ASKED_PER_DECADE: usize = 2;

/// Weight below which a kind of noise is not a doubt.
const NEGLIGIBLE: f64 = 0.01;

/// Gain in −2 log of the restricted likelihood below which a moment is not seen at all.
const UNSEEN: f64 = 0.1;

/// Gain in −2 log of the restricted likelihood from which on a moment is looked at more closely.
const SEEN: f64 = 2.0;

/// Records ready to be fitted, with the answer of `output-error` to begin with.
pub(super) struct PreparedRecords {
    records: Vec<Record>,
    start: FirstOrder,
    pub outliers: Vec<Suspects>,
    too_many: bool,
    evaluations: usize,
}

/// The noise that was chosen and its fit.
pub(super) struct Chosen {
    pub records: Vec<Record>,
    /// The kinds of noise that cannot be told apart, with their weights, the most likely first.
    pub found: Vec<(f64, Maximum)>,
    /// Spikes and jumps of every record, by row of its track.
    pub outliers: Vec<Suspects>,
    /// Whether there were too many spikes to leave them out.
    pub too_many: bool,
    /// BIC of every kind of moment that was fitted.
    pub tried: Vec<(Moment, f64)>,
    pub evaluations: usize,
    /// Whether 1/T is at the end of the range of `output-error`.
    pub at_bound: bool,
}

impl PreparedRecords {
    /// Takes the records, looks for outliers, and fits `output-error` to the rest. Fails as it does.
    pub fn new(settings: &Settings, trials: &[Trial]) -> Result<Self, IdentifyError> {
        let whole = trials.iter().map(|trial| track(trial, FEWEST_ROWS)).collect::<Result<Vec<_>, IdentifyError>>()?;
        let finest = trials.iter().map(Trial::sampling_period).fold(f64::INFINITY, f64::min);
        let method = output_error::Settings::default().build().expect("default settings are valid");
        // What is far from any course a ship can steer would spoil the first fit: a very quick ship could follow a
        // sentinel in the first row by its initial yaw rate.
        let gross = |track: &Track| match settings.outliers {
            true => Suspects { jumps: Vec::new(), ..outliers::find(track, &track.heading, &[]) },
            false => Suspects::default(),
        };
        let mut suspects: Vec<Suspects> = whole.iter().map(gross).collect();
        let mut too_many = false;
        let mut tracks: Vec<Track> =
            whole.iter().zip(&suspects).map(|(track, found)| track.without(&found.spikes)).collect();
        let mut first = method.fit(tracks.clone(), finest);
        let mut evaluations = 0;
        for _ in 0..if settings.outliers { ROUNDS } else { 0 } {
            evaluations += first.as_ref().map_or(0, |estimate| estimate.evaluations);
            let fitted = first.as_ref().ok();
            let again = |(track, known): (&Track, &Suspects)| {
                outliers::find(track, &left_over(track, fitted, &known.spikes), &known.spikes)
            };
            let next: Vec<Suspects> = whole.iter().zip(&suspects).map(again).collect();
            let share = |(track, found): (&Track, &Suspects)| found.spikes.len() as f64 / track.len() as f64;
            too_many = whole.iter().zip(&next).map(share).fold(0.0, f64::max) > LARGEST_SHARE;
            if too_many || next.iter().zip(&suspects).all(|(next, last)| next.spikes == last.spikes) {
                suspects = next;
                break;
            }
            tracks = whole.iter().zip(&next).map(|(track, found)| track.without(&found.spikes)).collect();
            suspects = next;
            first = method.fit(tracks.clone(), finest);
        }
        if too_many {
            suspects.iter_mut().for_each(|found| found.spikes.clear());
            tracks = whole.clone();
            first = method.fit(tracks.clone(), finest);
        }
        let first = first?;
        let gyro = settings.yaw_rate
            && trials.iter().all(|trial| trial.yaw_rate().is_some() && !trial.heading_from_yaw_rate());
        let of_rudder = |trial: &Trial| trial.noise().rudder.filter(|&sd| sd > 0.0);
        let declared =
            settings.rudder == RudderChoice::Declared && trials.iter().all(|trial| of_rudder(trial).is_some());
        let by_row = declared || settings.rudder == RudderChoice::Estimated;
        let records = tracks
            .into_iter()
            .zip(trials)
            .map(|(track, trial)| {
                let track = track.with_rates(trial.yaw_rate().filter(|_| gyro), trial);
                Record { declared: of_rudder(trial).filter(|_| declared), ..Record::new(track, by_row) }
            })
            .collect();
        Ok(Self { records, start: first.response, outliers: suspects, too_many, evaluations })
    }

    /// Times of the spikes of every record, s.
    pub fn spikes(&self) -> Vec<Vec<f64>> {
        let times = |(record, found): (&Record, &Suspects)| {
            let time = &record.track.time;
            found.spikes.iter().map(|&row| time[row]).collect()
        };
        self.records.iter().zip(&self.outliers).map(times).collect()
    }

    /// Fits every kind of noise and takes the one with the lowest BIC.
    pub fn choose(self, settings: &Settings) -> Result<Chosen, IdentifyError> {
        let Self { mut records, start, outliers, too_many, evaluations } = self;
        let ranges: Vec<Ranges> = records.iter().map(|record| ranges(record, &start)).collect();
        let a = start.inverse_T;
        let estimated = settings.rudder == RudderChoice::Estimated;
        let blank = |(record, ranges): (&Record, &Ranges)| {
            gyro_start(
                ranges,
                &NoiseVector { rudder: estimated || record.declared.is_some(), ..NoiseVector::default() },
            )
        };
        let none: Vec<NoiseVector> = records.iter().zip(&ranges).map(blank).collect();

        let mut spent = evaluations;
        let (mut all, mut tried) = contest(&records, &ranges, settings, a, &none, &mut spent);
        // Jumps are believed where they pay under the noise that was found.
        let suspected: usize = outliers.iter().map(|found| found.jumps.len()).sum();
        let mut kept = outliers;
        if let Some((_, found)) = all.first().filter(|_| suspected > 0) {
            believe_jumps(&mut records, &mut kept, &found.point);
            if records.iter().any(|record| !record.jumps.is_empty()) {
                (all, tried) = contest(&records, &ranges, settings, a, &none, &mut spent);
            }
        }
        kept.iter_mut().zip(&records).for_each(|(found, record)| found.jumps.clone_from(&record.jumps));
        let Some(&(lowest, _)) = all.first() else {
            return Err(IdentifyError::Singular { condition: f64::INFINITY, limit: CONDITION_LIMIT });
        };
        let sum: f64 = all.iter().map(|(bic, _)| (-0.5 * (bic - lowest)).exp()).sum();
        let weigh = |(bic, found): (f64, Maximum)| ((-0.5 * (bic - lowest)).exp() / sum, found);
        let found: Vec<(f64, Maximum)> =
            all.into_iter().map(weigh).filter(|(weight, _)| *weight > NEGLIGIBLE).collect();
        let end = found[0].1.point.inverse_time;
        let at_bound = end == a && start.inverse_T.abs() * ranges[0].spacing >= 2.0 - 1e-6;
        Ok(Chosen { records, found, outliers: kept, too_many, tried, evaluations: spent, at_bound })
    }
}

/// What `output-error` leaves of every heading of the whole track, with a start that `known` spikes have no say in; the
/// heading itself when there is no answer.
fn left_over(track: &Track, fitted: Option<&Estimate>, known: &[usize]) -> Vec<f64> {
    let Some(estimate) = fitted else { return track.heading.clone() };
    let ship = estimate.response;
    let mut columns = MotionColumns::default();
    track.fill(ship.inverse_T, &mut columns);
    let Coefficients { gain, offset, .. } = Coefficients::of(&ship);
    let forced = columns.rudder.iter().zip(&columns.constant);
    let rest: Vec<f64> = track.heading.iter().zip(forced).map(|(psi, (g, h))| psi - gain * g - offset * h).collect();
    let honest = |values: &[f64]| -> Vec<f64> {
        let rows = track.observed.iter().zip(values);
        rows.filter(|(row, _)| !known.contains(row)).map(|(_, &value)| value).collect()
    };
    let start = best_start(&honest(&rest), &honest(&columns.homogeneous));
    let motion = columns.homogeneous.iter().map(|free| start.heading + start.yaw_rate * free);
    rest.iter().zip(motion).map(|(rest, motion)| rest - motion).collect()
}

fn ranges(record: &Record, start: &FirstOrder) -> Ranges {
    let track = &record.track;
    let plain = evaluate(std::slice::from_ref(record), start.inverse_T, &[NoiseVector::default()]);
    let spacing = track.duration() / (track.len() - 1) as f64;
    let residual = plain.map_or(1.0, |point| {
        let part = &point.parts[0];
        // Second differences of white noise have six times its variance; a moment leaves little in them.
        let differences: Vec<f64> = part.innovations.windows(3).map(|w| (w[0] - 2.0 * w[1] + w[2]).powi(2)).collect();
        let white = differences.iter().sum::<f64>() / differences.len().max(1) as f64 / 6.0;
        (part.variance / white.max(f64::MIN_POSITIVE)).sqrt().clamp(1.0, 1e6)
    });
    Ranges { duration: track.duration(), spacing, residual }
}

/// BIC of a point.
fn bic(records: &[Record], point: &Point) -> f64 {
    let noise: usize = records
        .iter()
        .zip(&point.places)
        .map(|(record, place)| {
            // The entry of a declared rudder error stands for the size of the compass error, which is counted with all.
            place.entries(record.has_gyro()).filter(|&entry| entry != RUDDER || record.declared.is_none()).count()
        })
        .sum();
    point.restricted + noise as f64 * (readings(records) as f64).ln()
}

/// Fits of all kinds of noise, each behind its BIC.
type Ranked = Vec<(f64, Maximum)>;

/// Fits every kind of noise that the settings allow, the lowest BIC first; also tells the BIC of every moment.
fn contest(
    records: &[Record],
    ranges: &[Ranges],
    settings: &Settings,
    a: f64,
    none: &[NoiseVector],
    evaluations: &mut usize,
) -> (Ranked, Vec<(Moment, f64)>) {
    let mut search = Search { records, ranges, iterations: settings.iterations, evaluations: 0, unseen: Vec::new() };
    let mut all = of_moments(&mut search, settings.moment.kinds(), a, none);
    let froms = with_memory(&all, settings.compass);
    if settings.compass == CompassChoice::Coloured {
        all.clear();
    }
    for (a, places) in froms {
        let starts = search.spread(a, &places, COMPASS);
        let start = search.best(starts, |point| point.restricted);
        all.extend(start.and_then(|start| search.highest(start)));
    }
    // Under the noise that was found another 1/T may be better; under white errors of the instruments alone the start
    // is the best one already.
    let is_more = |place: &NoiseVector| place.moment != Moment::None || place.coloured || place.rudder;
    if let Some((_, found)) = lowest(&all).filter(|(_, found)| found.point.places.iter().any(is_more)) {
        let elsewhere = asked_again(&mut search, found.point.inverse_time, &found.point.places);
        if elsewhere.as_ref().is_some_and(|point| point.deviance < found.point.deviance) {
            all.extend(elsewhere.and_then(|better| search.highest(better)));
        }
    }
    all.sort_by(|one, other| one.0.total_cmp(&other.0));
    *evaluations += search.evaluations;
    let tried = all.iter().map(|(bic, found)| (found.point.places[0].moment, *bic)).chain(search.unseen).collect();
    (all, tried)
}

impl Search<'_> {
    /// The largest likelihood from a start, behind its BIC.
    fn highest(&mut self, start: Point) -> Option<(f64, Maximum)> {
        let found = self.maximise(start)?;
        Some((bic(self.records, &found.point), found))
    }
}

/// Fits with every kind of moment.
fn of_moments(search: &mut Search, kinds: &[Moment], a: f64, none: &[NoiseVector]) -> Ranked {
    let mut none = none.to_vec();
    let mut all: Ranked = Vec::new();
    // Gusts begin where a white moment and a walk end.
    let (mut white, mut walk) = (None, None);
    for kind in [Moment::None, Moment::White, Moment::Walk, Moment::OrnsteinUhlenbeck] {
        let gusts = kinds.contains(&Moment::OrnsteinUhlenbeck) && matches!(kind, Moment::White | Moment::Walk);
        let plain = all.iter().find(|(_, found)| found.point.places[0].moment == Moment::None);
        let random =
            [&white, &walk].into_iter().flatten().map(|point: &Point| point.restricted).fold(f64::INFINITY, f64::min);
        // Gusts are between a white moment and a walk: where neither is seen, nor are they.
        let hopeless =
            kind == Moment::OrnsteinUhlenbeck && plain.is_some_and(|(_, plain)| plain.point.restricted - random < SEEN);
        if (!kinds.contains(&kind) && !gusts) || hopeless {
            continue;
        }
        let starts = match kind {
            Moment::None if none[0].rudder => search.spread(a, &none, RUDDER),
            Moment::None => vec![(a, none.clone())],
            Moment::White | Moment::Walk => search.levels(a, &none, kind),
            Moment::OrnsteinUhlenbeck => search.gusts(white.as_ref(), walk.as_ref()),
        };
        let start = search.best(starts, |point| point.restricted);
        // A moment that helps at no size is none: it costs what an entry costs and gains nothing.
        let is_unseen = |start: &Point| {
            matches!(kind, Moment::White | Moment::Walk)
                && plain.is_some_and(|(_, plain)| start.restricted > plain.point.restricted - UNSEEN)
        };
        if let Some((bic, _)) = plain.filter(|_| start.as_ref().is_some_and(is_unseen)) {
            let entries = search.records.len() as f64;
            search.unseen.push((kind, bic + entries * (readings(search.records) as f64).ln()));
            continue;
        }
        let found = start.and_then(|start| search.highest(start));
        let point = found.as_ref().map(|(_, found)| &found.point);
        match kind {
            Moment::White => white = point.cloned(),
            Moment::Walk => walk = point.cloned(),
            // What is known of the other noises by then.
            Moment::None => none = point.map_or(none, |point| point.places.clone()),
            Moment::OrnsteinUhlenbeck => {}
        }
        all.extend(found.filter(|_| kinds.contains(&kind)));
    }
    all
}

/// 1/T and noises with which a compass error with a memory is looked for: where innovations have one, beside the best
/// noise, and alone, since a white moment may be large enough to make anything white.
fn with_memory(all: &Ranked, compass: CompassChoice) -> Vec<Start> {
    let has_memory = |found: &&Maximum| {
        let readings: usize = found.point.parts.iter().map(|part| part.readings).sum();
        let whites = found.point.parts.iter().map(|part| part.innovations.as_slice());
        match compass {
            CompassChoice::Chosen => robust::lag1_autocorrelation(whites).abs() > 3.0 / (readings as f64).sqrt(),
            CompassChoice::White => false,
            CompassChoice::Coloured => true,
        }
    };
    let is_plain = |found: &Maximum| found.point.places[0].moment == Moment::None;
    let best = lowest(all).map(|(_, found)| found);
    let alone = all.iter().map(|(_, found)| found).find(|found| is_plain(found));
    let alone = alone.filter(|_| best.is_some_and(|best| !is_plain(best)));
    let coloured = |found: &Maximum| {
        let places = found.point.places.iter().map(|place| NoiseVector { coloured: true, ..*place });
        (found.point.inverse_time, places.collect())
    };
    [best, alone].into_iter().flatten().filter(has_memory).map(coloured).collect()
}

fn lowest(all: &[(f64, Maximum)]) -> Option<&(f64, Maximum)> {
    all.iter().min_by(|one, other| one.0.total_cmp(&other.0))
}

/// The best of other values of 1/T, of both signs, under the same noise.
fn asked_again(search: &mut Search, inverse_time: f64, places: &[NoiseVector]) -> Option<Point> {
    let longest = search.ranges.iter().map(|ranges| ranges.duration).fold(0.0, f64::max);
    let finest = search.ranges.iter().map(|ranges| ranges.spacing).fold(f64::INFINITY, f64::min);
    let (slowest, fastest) = (0.2 / longest, 0.5 / finest);
    let decades = (fastest / slowest).log10();
    let points = (decades * ASKED_PER_DECADE as f64).ceil() as usize;
    let sizes = (0..=points).map(|k| slowest * 10f64.powf(decades * k as f64 / points as f64));
    let starts: Vec<f64> = sizes.flat_map(|a| [a, -a]).filter(|a| (a - inverse_time).abs() > 0.2 * a.abs()).collect();
    search.best(starts.into_iter().map(|a| (a, places.to_vec())).collect(), |point| point.deviance)
}

/// Keeps the suspected jumps that make the record much more likely under the noise of a point.
fn believe_jumps(records: &mut [Record], outliers: &mut [Suspects], point: &Point) {
    for number in 0..records.len() {
        for jump in outliers[number].jumps.clone() {
            let height = |records: &[Record]| evaluate(records, point.inverse_time, &point.places).map(|p| p.deviance);
            let before = height(records);
            records[number].jumps.push(jump);
            let gain = before.zip(height(records)).map_or(0.0, |(before, after)| before - after);
            if gain < JUMP_GAIN + (records[number].len() as f64).ln() {
                records[number].jumps.pop();
            }
        }
    }
}
