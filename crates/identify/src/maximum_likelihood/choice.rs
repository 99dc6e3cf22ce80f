//! Selection of the noise law: every law is fitted, and the law with the lowest BIC is selected. Source: Schwarz
//! (1978), Estimating the dimension of a model, Annals of Statistics 6, 461–464.

use ship::FirstOrder;
use trial::Trial;

use super::outliers::{self, MAX_OUTLIER_SHARE, Suspects};
use super::point::{Point, Record, Start, evaluate, reading_count};
use super::search::{Maximum, Ranges, Search, gyro_start};
use super::settings::{CompassChoice, RudderChoice, Settings};
use crate::error::IdentifyError;
use crate::estimate::Estimate;
use crate::likelihood::NoiseVector;
use crate::likelihood::parameters::{COMPASS_INDEX, RUDDER_INDEX};
use crate::likelihood::track::{MotionCoefficients, MotionColumns, TrialSignals};
use crate::output_error::{self, MAX_CONDITION, MIN_ROWS};
use crate::replay::best_initial_state;
use crate::robust;
use crate::samples::checked_signals;
use trial::noise_model::MomentKind;

/// Maximum number of rounds of outlier search and refit.
const MAX_OUTLIER_ROUNDS: usize = 12;

/// Minimum gain in −2 log L, in addition to log n, for a jump of the compass.
const MIN_JUMP_GAIN: f64 = 25.0;

/// Number of values of 1/T per decade, for each sign, that are evaluated under the selected noise.
const VALUES_PER_DECADE: usize = 2;

/// Minimum weight of a kept noise law.
const MIN_WEIGHT: f64 = 0.01;

/// Minimum gain in −2 log of the restricted likelihood for a moment.
const MIN_MOMENT_GAIN: f64 = 0.1;

/// Minimum gain in −2 log of the restricted likelihood by a white moment or a walk for the fit of a correlated moment.
const MIN_GUST_GAIN: f64 = 2.0;

/// Records with their outliers and the estimate of `output-error` as start.
pub(super) struct PreparedRecords {
    records: Vec<Record>,
    start: FirstOrder,
    pub outliers: Vec<Suspects>,
    has_too_many_outliers: bool,
    evaluations: usize,
}

/// Selected noise law and its fit.
pub(super) struct ChosenLaw {
    pub records: Vec<Record>,
    /// Fits under the plausible noise laws with their weights, the most plausible first.
    pub maxima: Vec<(f64, Maximum)>,
    /// Spikes and jumps of every record, by row of its signals.
    pub outliers: Vec<Suspects>,
    /// `true` if there are too many spikes to leave out.
    pub has_too_many_outliers: bool,
    /// Kind of moment and BIC of every fitted law, and of every moment without gain.
    pub bic_by_moment: Vec<(MomentKind, f64)>,
    /// Number of evaluations of the likelihood, and of `output-error`.
    pub evaluations: usize,
    /// `true` if 1/T is at the edge of the range of `output-error`.
    pub is_at_bound: bool,
}

impl PreparedRecords {
    /// Finds the outliers of the records and fits `output-error` to the other readings. Fails as `output-error` does.
    pub fn new(settings: &Settings, trials: &[Trial]) -> Result<Self, IdentifyError> {
        let whole =
            trials.iter().map(|trial| checked_signals(trial, MIN_ROWS)).collect::<Result<Vec<_>, IdentifyError>>()?;
        let finest = trials.iter().map(Trial::sampling_period).fold(f64::INFINITY, f64::min);
        let method = output_error::Settings::default().build().expect("default settings are valid");
        // Readings far from any possible course would spoil the first fit: a very quick ship could follow a sentinel in
        // the first row by its initial yaw rate.
        let gross = |signals: &TrialSignals| match settings.removes_outliers {
            true => Suspects { jump_rows: Vec::new(), ..outliers::find_suspects(signals, &signals.heading, &[]) },
            false => Suspects::default(),
        };
        let mut suspects: Vec<Suspects> = whole.iter().map(gross).collect();
        let mut has_too_many_outliers = false;
        let mut trial_signals: Vec<TrialSignals> =
            whole.iter().zip(&suspects).map(|(signals, rows)| signals.without_headings(&rows.spike_rows)).collect();
        let mut first = method.fit(trial_signals.clone(), finest);
        let mut evaluations = 0;
        for _ in 0..if settings.removes_outliers { MAX_OUTLIER_ROUNDS } else { 0 } {
            evaluations += first.as_ref().map_or(0, |estimate| estimate.evaluations);
            let fitted = first.as_ref().ok();
            let again = |(signals, excluded): (&TrialSignals, &Suspects)| {
                outliers::find_suspects(signals, &residual(signals, fitted, &excluded.spike_rows), &excluded.spike_rows)
            };
            let next: Vec<Suspects> = whole.iter().zip(&suspects).map(again).collect();
            let share =
                |(signals, rows): (&TrialSignals, &Suspects)| rows.spike_rows.len() as f64 / signals.len() as f64;
            has_too_many_outliers = whole.iter().zip(&next).map(share).fold(0.0, f64::max) > MAX_OUTLIER_SHARE;
            if has_too_many_outliers
                || next.iter().zip(&suspects).all(|(next, last)| next.spike_rows == last.spike_rows)
            {
                suspects = next;
                break;
            }
            trial_signals =
                whole.iter().zip(&next).map(|(signals, rows)| signals.without_headings(&rows.spike_rows)).collect();
            suspects = next;
            first = method.fit(trial_signals.clone(), finest);
        }
        if has_too_many_outliers {
            suspects.iter_mut().for_each(|rows| rows.spike_rows.clear());
            trial_signals = whole.clone();
            first = method.fit(trial_signals.clone(), finest);
        }
        let first = first?;
        let gyro = settings.uses_yaw_rate
            && trials.iter().all(|trial| trial.yaw_rate().is_some() && !trial.is_heading_integrated());
        let declared_sd = |trial: &Trial| trial.noise().rudder_sd.filter(|&sd| sd > 0.0);
        let declared = settings.rudder == RudderChoice::Declared && trials.iter().all(|run| declared_sd(run).is_some());
        let by_row = declared || settings.rudder == RudderChoice::Estimated;
        let records = trial_signals
            .into_iter()
            .zip(trials)
            .map(|(signals, trial)| {
                let signals = signals.with_rates(trial.yaw_rate().filter(|_| gyro), trial);
                Record::new(signals, by_row, declared_sd(trial).filter(|_| declared))
            })
            .collect();
        Ok(Self { records, start: first.response, outliers: suspects, has_too_many_outliers, evaluations })
    }

    /// Times of the spikes of every record, s.
    pub fn spike_times(&self) -> Vec<Vec<f64>> {
        let times = |(record, suspects): (&Record, &Suspects)| {
            suspects.spike_rows.iter().map(|&row| record.signals.time[row]).collect()
        };
        self.records.iter().zip(&self.outliers).map(times).collect()
    }

    /// Fits every noise law and selects the law with the lowest BIC.
    pub fn choose(self, settings: &Settings) -> Result<ChosenLaw, IdentifyError> {
        let Self { mut records, start, outliers, has_too_many_outliers, evaluations } = self;
        let ranges: Vec<Ranges> = records.iter().map(|record| ranges(record, &start)).collect();
        let a = start.inverse_T;
        let estimated = settings.rudder == RudderChoice::Estimated;
        let blank = |(record, ranges): (&Record, &Ranges)| {
            gyro_start(
                ranges,
                &NoiseVector {
                    has_rudder_error: estimated || record.declared_rudder_sd.is_some(),
                    ..NoiseVector::default()
                },
            )
        };
        let none: Vec<NoiseVector> = records.iter().zip(&ranges).map(blank).collect();

        let mut spent = evaluations;
        let (mut all, mut bic_by_moment) = fit_laws(&records, &ranges, settings, a, &none, &mut spent);
        // A jump is kept if it improves the likelihood enough under the selected noise.
        let suspected: usize = outliers.iter().map(|rows| rows.jump_rows.len()).sum();
        let mut kept = outliers;
        if let Some((_, maximum)) = all.first().filter(|_| suspected > 0) {
            keep_jumps(&mut records, &mut kept, &maximum.point);
            if records.iter().any(|record| !record.jump_rows.is_empty()) {
                (all, bic_by_moment) = fit_laws(&records, &ranges, settings, a, &none, &mut spent);
            }
        }
        kept.iter_mut().zip(&records).for_each(|(rows, record)| rows.jump_rows.clone_from(&record.jump_rows));
        let Some(&(lowest, _)) = all.first() else {
            return Err(IdentifyError::Singular { condition: f64::INFINITY, limit: MAX_CONDITION });
        };
        let sum: f64 = all.iter().map(|(bic, _)| (-0.5 * (bic - lowest)).exp()).sum();
        let weigh = |(bic, maximum): (f64, Maximum)| ((-0.5 * (bic - lowest)).exp() / sum, maximum);
        let maxima: Vec<(f64, Maximum)> = all.into_iter().map(weigh).filter(|(share, _)| *share > MIN_WEIGHT).collect();
        let end = maxima[0].1.point.inverse_T;
        let is_at_bound = end == a && start.inverse_T.abs() * ranges[0].spacing >= 2.0 - 1e-6;
        Ok(ChosenLaw {
            records,
            maxima,
            outliers: kept,
            has_too_many_outliers,
            bic_by_moment,
            evaluations: spent,
            is_at_bound,
        })
    }
}

/// Residual of `output-error` at every heading of the whole record, rad, with an initial state fitted without the
/// `excluded` spikes; the heading itself without an estimate.
fn residual(signals: &TrialSignals, fitted: Option<&Estimate>, excluded: &[usize]) -> Vec<f64> {
    let Some(estimate) = fitted else { return signals.heading.clone() };
    let ship = estimate.response;
    let mut columns = MotionColumns::default();
    signals.fill_columns(ship.inverse_T, &mut columns);
    let MotionCoefficients { K_over_T, offset, .. } = MotionCoefficients::from_response(&ship);
    let forced = columns.rudder.iter().zip(&columns.constant);
    let free: Vec<f64> =
        signals.heading.iter().zip(forced).map(|(psi, (g, h))| psi - K_over_T * g - offset * h).collect();
    let without_spikes = |values: &[f64]| -> Vec<f64> {
        let rows = signals.heading_rows.iter().zip(values);
        rows.filter(|(row, _)| !excluded.contains(row)).map(|(_, &value)| value).collect()
    };
    let start = best_initial_state(&without_spikes(&free), &without_spikes(&columns.homogeneous));
    let motion = columns.homogeneous.iter().map(|column| start.heading + start.yaw_rate * column);
    free.iter().zip(motion).map(|(heading, motion)| heading - motion).collect()
}

fn ranges(record: &Record, start: &FirstOrder) -> Ranges {
    let signals = &record.signals;
    let plain =
        evaluate(std::slice::from_ref(record), &[(start.inverse_T, vec![NoiseVector::default()])]).pop().flatten();
    let spacing = signals.duration() / (signals.len() - 1) as f64;
    let residual = plain.map_or(1.0, |point| {
        let part = &point.parts[0];
        // Second differences of white noise have six times its variance; a moment leaves little in them.
        let differences: Vec<f64> = part.innovations.windows(3).map(|w| (w[0] - 2.0 * w[1] + w[2]).powi(2)).collect();
        let white = differences.iter().sum::<f64>() / differences.len().max(1) as f64 / 6.0;
        (part.variance / white.max(f64::MIN_POSITIVE)).sqrt().clamp(1.0, 1e6)
    });
    Ranges { duration: signals.duration(), spacing, residual }
}

/// BIC: restricted −2 log L plus log n per active entry of the noise, with n readings over all records; a declared
/// rudder error does not count.
fn bic(records: &[Record], point: &Point) -> f64 {
    let noise: usize = records
        .iter()
        .zip(&point.vectors)
        .map(|(record, vector)| {
            // The entry of a declared rudder error represents the size of the compass error, which all laws count.
            vector
                .active_entries(record.has_gyro())
                .filter(|&entry| entry != RUDDER_INDEX || record.declared_rudder_sd.is_none())
                .count()
        })
        .sum();
    point.restricted_deviance + noise as f64 * (reading_count(records) as f64).ln()
}

/// Fits of all noise laws, each with its BIC.
type Ranked = Vec<(f64, Maximum)>;

/// Fits every noise law that the settings allow, the lowest BIC first; also returns [`ChosenLaw::bic_by_moment`].
fn fit_laws(
    records: &[Record],
    ranges: &[Ranges],
    settings: &Settings,
    a: f64,
    none: &[NoiseVector],
    evaluations: &mut usize,
) -> (Ranked, Vec<(MomentKind, f64)>) {
    let mut search =
        Search { records, ranges, iterations: settings.iterations, evaluations: 0, moments_without_gain: Vec::new() };
    let mut all = fit_moments(&mut search, settings.moment.kinds(), a, none);
    let coloured_starts = coloured_compass_starts(&all, settings.compass);
    if settings.compass == CompassChoice::Coloured {
        all.clear();
    }
    for (a, vectors) in coloured_starts {
        let starts = search.entry_starts(a, &vectors, COMPASS_INDEX);
        let start = search.best_start(&starts, |point| point.restricted_deviance);
        all.extend(start.and_then(|start| search.highest(start)));
    }
    // Under the selected noise another 1/T may be better; under white instrument errors alone the start is already
    // optimal.
    let is_coloured = |v: &NoiseVector| v.moment != MomentKind::None || v.has_coloured_compass || v.has_rudder_error;
    if let Some((_, best)) = lowest(&all).filter(|(_, best)| best.point.vectors.iter().any(is_coloured)) {
        let elsewhere = best_inverse_T(&mut search, best.point.inverse_T, &best.point.vectors);
        if elsewhere.as_ref().is_some_and(|point| point.deviance < best.point.deviance) {
            all.extend(elsewhere.and_then(|better| search.highest(better)));
        }
    }
    all.sort_by(|a, b| a.0.total_cmp(&b.0));
    *evaluations += search.evaluations;
    let bic_by_moment = all
        .iter()
        .map(|(bic, maximum)| (maximum.point.vectors[0].moment, *bic))
        .chain(search.moments_without_gain)
        .collect();
    (all, bic_by_moment)
}

impl Search<'_> {
    /// Maximum of the likelihood uphill from a start, preceded by its BIC.
    fn highest(&mut self, start: Point) -> Option<(f64, Maximum)> {
        let maximum = self.maximise(start)?;
        Some((bic(self.records, &maximum.point), maximum))
    }
}

/// Fits with every moment in `kinds`, each from its best start at 1/T = `a`; `none` are the noise vectors without a
/// moment.
fn fit_moments(search: &mut Search, kinds: &[MomentKind], a: f64, none: &[NoiseVector]) -> Ranked {
    let mut none = none.to_vec();
    let mut all: Ranked = Vec::new();
    // The starts of gusts are the fits of a white moment and of a walk.
    let (mut white, mut walk) = (None, None);
    for kind in [MomentKind::None, MomentKind::White, MomentKind::Walk, MomentKind::OrnsteinUhlenbeck] {
        let gusts =
            kinds.contains(&MomentKind::OrnsteinUhlenbeck) && matches!(kind, MomentKind::White | MomentKind::Walk);
        let plain = all.iter().find(|(_, maximum)| maximum.point.vectors[0].moment == MomentKind::None);
        let random = [&white, &walk]
            .into_iter()
            .flatten()
            .map(|point: &Point| point.restricted_deviance)
            .fold(f64::INFINITY, f64::min);
        // Gusts lie between a white moment and a walk: without either, gusts are not fitted.
        let hopeless = kind == MomentKind::OrnsteinUhlenbeck
            && plain.is_some_and(|(_, plain)| plain.point.restricted_deviance - random < MIN_GUST_GAIN);
        if (!kinds.contains(&kind) && !gusts) || hopeless {
            continue;
        }
        let restricted = |point: &Point| point.restricted_deviance;
        let start = match kind {
            MomentKind::None if none[0].has_rudder_error => {
                search.best_start(&search.entry_starts(a, &none, RUDDER_INDEX), restricted)
            }
            MomentKind::None => search.evaluate((a, none.clone())),
            MomentKind::White | MomentKind::Walk => search.best_level(
                &search.level_starts(a, &none, kind),
                plain.map(|(_, plain)| plain.point.restricted_deviance),
            ),
            MomentKind::OrnsteinUhlenbeck => {
                search.best_start(&search.gust_starts(white.as_ref(), walk.as_ref()), restricted)
            }
        };
        // A moment without gain at any size is absent; the BIC still counts its entries.
        let is_without_gain = |start: &Point| {
            matches!(kind, MomentKind::White | MomentKind::Walk)
                && plain.is_some_and(|(_, plain)| {
                    start.restricted_deviance > plain.point.restricted_deviance - MIN_MOMENT_GAIN
                })
        };
        if let Some((bic, _)) = plain.filter(|_| start.as_ref().is_some_and(is_without_gain)) {
            let entries = search.records.len() as f64;
            search.moments_without_gain.push((kind, bic + entries * (reading_count(search.records) as f64).ln()));
            continue;
        }
        let fitted = start.and_then(|start| search.highest(start));
        let point = fitted.as_ref().map(|(_, maximum)| &maximum.point);
        match kind {
            MomentKind::White => white = point.cloned(),
            MomentKind::Walk => walk = point.cloned(),
            // Later kinds start from the fitted instrument errors.
            MomentKind::None => none = point.map_or(none, |point| point.vectors.clone()),
            MomentKind::OrnsteinUhlenbeck => {}
        }
        all.extend(fitted.filter(|_| kinds.contains(&kind)));
    }
    all
}

/// Starts of the search for a correlated compass error, if the innovations are correlated: with the best noise law, and
/// alone, because a large white moment can hide the correlation.
fn coloured_compass_starts(all: &Ranked, compass: CompassChoice) -> Vec<Start> {
    let is_correlated = |maximum: &&Maximum| {
        let readings: usize = maximum.point.parts.iter().map(|part| part.readings).sum();
        let whites = maximum.point.parts.iter().map(|part| part.innovations.as_slice());
        match compass {
            CompassChoice::Chosen => robust::lag1_autocorrelation(whites).abs() > 3.0 / (readings as f64).sqrt(),
            CompassChoice::White => false,
            CompassChoice::Coloured => true,
        }
    };
    let is_plain = |maximum: &Maximum| maximum.point.vectors[0].moment == MomentKind::None;
    let best = lowest(all).map(|(_, maximum)| maximum);
    let alone = all.iter().map(|(_, maximum)| maximum).find(|maximum| is_plain(maximum));
    let alone = alone.filter(|_| best.is_some_and(|best| !is_plain(best)));
    let coloured = |maximum: &Maximum| {
        let vectors = maximum.point.vectors.iter().map(|vector| NoiseVector { has_coloured_compass: true, ..*vector });
        (maximum.point.inverse_T, vectors.collect())
    };
    [best, alone].into_iter().flatten().filter(is_correlated).map(coloured).collect()
}

fn lowest(all: &[(f64, Maximum)]) -> Option<&(f64, Maximum)> {
    all.iter().min_by(|a, b| a.0.total_cmp(&b.0))
}

/// Point with the lowest −2 log L on a grid of other values of 1/T, of both signs, under unchanged noise; `None` if no
/// value gives a positive K/T and a finite likelihood.
fn best_inverse_T(search: &mut Search, inverse_T: f64, vectors: &[NoiseVector]) -> Option<Point> {
    let longest = search.ranges.iter().map(|ranges| ranges.duration).fold(0.0, f64::max);
    let finest = search.ranges.iter().map(|ranges| ranges.spacing).fold(f64::INFINITY, f64::min);
    let (slowest, fastest) = (0.2 / longest, 0.5 / finest);
    let decades = (fastest / slowest).log10();
    let points = (decades * VALUES_PER_DECADE as f64).ceil() as usize;
    let sizes = (0..=points).map(|k| slowest * 10f64.powf(decades * k as f64 / points as f64));
    let starts: Vec<f64> = sizes.flat_map(|a| [a, -a]).filter(|a| (a - inverse_T).abs() > 0.2 * a.abs()).collect();
    let starts: Vec<Start> = starts.into_iter().map(|a| (a, vectors.to_vec())).collect();
    search.best_start(&starts, |point| point.deviance)
}

/// Keeps the suspected jumps that raise the likelihood enough under the noise of a point.
fn keep_jumps(records: &mut [Record], outliers: &mut [Suspects], point: &Point) {
    for number in 0..records.len() {
        for jump in outliers[number].jump_rows.clone() {
            let start = [(point.inverse_T, point.vectors.clone())];
            let height = |records: &[Record]| Some(evaluate(records, &start).pop()??.deviance);
            let before = height(records);
            records[number].jump_rows.push(jump);
            let gain = before.zip(height(records)).map_or(0.0, |(before, after)| before - after);
            if gain < MIN_JUMP_GAIN + (records[number].len() as f64).ln() {
                records[number].jump_rows.pop();
            }
        }
    }
}
