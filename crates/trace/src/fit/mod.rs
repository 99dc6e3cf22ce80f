//! Output error for a structure with terms: the parameters, bounded, and the initial state of every record that bring the
//! whitened heading of the replay nearest to the record (Levenberg–Marquardt; Moré 1978).

mod linear;

use std::collections::HashMap;
use std::sync::{Arc, Mutex};

use lanes::column::dot;
use nalgebra::DVector;
use ship::Tangent;
use ship::narrow_band::NarrowBand;
use ship::number::DIRECTIONS;

use crate::noise::{Colour, Grain, Moment, Whitener};
use crate::record::Record;
use crate::search::Known;
use crate::structure::{Entry, Structure, TermName, headings};

pub(crate) use linear::whiten;
use linear::{Block, Normal, solve};
pub use linear::{Column, Columns, Linear};

/// A step that lowers RSS by less than this many mean squares ends the search: far below what any test could see.
const NEGLIGIBLE: f64 = 0.02;

/// Most steps.
const MOST_STEPS: usize = 25;

/// Damping of the first step: none to speak of.
const SMALLEST_DAMPING: f64 = 1e-9;

/// A step whose gain is further from what was promised than this share calls for new sensitivities.
const SURPRISE: f64 = 0.1;

/// Up to this share the old sensitivities are mended by what the step has taught (Broyden 1965).
const LESSON: f64 = 0.7;

/// Dampings of one step that are tried before it counts as a minimum.
const MOST_DAMPINGS: usize = 9;

/// No heading is believed to be better than this, rad: a thousandth of a degree.
const FINEST: f64 = 1.75e-5;

/// Share of the rows whose rudder bends most, by which the error of the rudder between rows is judged.
const BENT: f64 = 0.05;

/// Heading error, rad, that a rudder sampled at rows leaves: a corner between two rows is cut, which changes the integral of
/// the rudder by up to an eighth of its second difference times the step, and the heading by that times K.
///
/// `gain` is K, 1/s. Half the largest error is taken, root mean square over the corners.
fn blur(record: &Record, gain: f64) -> f64 {
    let rudder = record.rudder();
    let mut bends: Vec<f64> = rudder.windows(3).map(|w| (w[0] - 2.0 * w[1] + w[2]).powi(2)).collect();
    bends.sort_by(|one, other| other.total_cmp(one));
    let most = ((bends.len() as f64 * BENT) as usize).max(1);
    let square = bends.iter().take(most).sum::<f64>() / most as f64;
    gain * record.rudder_spacing * square.sqrt() / 16.0
}

/// Readings behind the heading of a full row of the records with the densest ones: the unit of the noise.
fn full_readings(records: &[Record]) -> usize {
    records.iter().map(|record| record.full_readings).max().unwrap_or(1)
}

/// The records of one analysis with what all fits need of them.
#[derive(Debug, Clone)]
pub struct Problem {
    /// The records.
    pub records: Vec<Record>,
    grains: Vec<Grain>,
    inverse_time: f64,
    inverse_time_scale: f64,
    gain_scale: f64,
    floor: f64,
    /// Fits that were asked for before: a search comes back to the same models, and a report to those of the search.
    finished: Arc<Mutex<HashMap<Question, Fit>>>,
}

/// What decides a fit: names of the terms and what of them is held, and every number that goes into it, by its bits.
type Question = (Vec<(TermName, &'static [usize])>, Vec<u64>);

/// A fitted structure.
#[derive(Debug, Clone)]
pub struct Fit {
    /// Parameters, in the order of [`Structure::entries`].
    pub theta: Vec<f64>,
    /// Initial heading (rad) and yaw rate (rad/s) of every record.
    pub initial: Vec<[f64; 2]>,
    /// Colour of the noise it was fitted under.
    pub colour: Colour,
    /// Measured less replayed heading at the observed rows of every record, rad, not whitened.
    pub residual: Vec<Vec<f64>>,
    /// Sum of squares of the whitened residual, rad².
    pub rss: f64,
    /// −2 log L, up to a constant of the record.
    pub deviance: f64,
    /// Number of fitted parameters, initial states and noise included.
    pub freedom: usize,
    /// −2 log L + freedom · log n (Schwarz 1978).
    pub bic: f64,
}

/// Where a search stands.
struct Point {
    theta: Vec<f64>,
    initial: Vec<[f64; 2]>,
    /// Measured less replayed headings, rad.
    residual: Vec<Vec<f64>>,
    /// The same, whitened.
    white: Vec<Vec<f64>>,
    rss: f64,
}

impl Point {
    fn new(theta: Vec<f64>, initial: Vec<[f64; 2]>, residual: Vec<Vec<f64>>, whiteners: &[Whitener]) -> Self {
        let white = whiten(&residual, whiteners);
        let rss = white.iter().map(|white| dot(white, white)).sum();
        Self { theta, initial, residual, white, rss }
    }

    /// The unknowns that lead from here to another point.
    fn step_to(&self, other: &Self, fitted: &[usize]) -> DVector<f64> {
        let parameters = fitted.iter().map(|&k| other.theta[k] - self.theta[k]);
        let states = self.initial.iter().zip(&other.initial).flat_map(|(from, to)| [to[0] - from[0], to[1] - from[1]]);
        DVector::from_vec(parameters.chain(states).collect())
    }
}

impl Problem {
    /// Prepares records of a ship whose base response is about 1/T, K/T.
    pub fn new(records: Vec<Record>, inverse_time: f64, gain: f64) -> Self {
        let longest = records.iter().map(Record::duration).fold(0.0, f64::max);
        let full = full_readings(&records);
        let grains = records.iter().map(|record| Grain::new(record, inverse_time, longest, full)).collect();
        let inverse_time_scale = inverse_time.abs().max(1.0 / longest);
        let time = inverse_time_scale.recip().min(0.1 * longest);
        let floor = records.iter().map(|record| blur(record, gain * time)).fold(FINEST, f64::max).powi(2);
        let finished = Arc::default();
        Self { records, grains, inverse_time, inverse_time_scale, gain_scale: gain, floor, finished }
    }

    /// The same ship on other records.
    pub fn on(&self, records: Vec<Record>) -> Self {
        let (damping, full) = (self.inverse_time, full_readings(&records));
        let grains = records.iter().map(|record| Grain::new(record, damping, self.longest(), full)).collect();
        Self { records, grains, finished: Arc::default(), ..*self }
    }

    /// Length of the longest record, s.
    pub fn longest(&self) -> f64 {
        self.grains.iter().map(Grain::longest).fold(0.0, f64::max)
    }

    /// −2 log L of a whitened sum of squares (rad²) and Σ log S, up to a constant of the records, the variance at its best
    /// value but not below what the rudder between rows leaves unknown.
    pub fn deviance(&self, rss: f64, log_variance: f64) -> f64 {
        let n = self.observations() as f64;
        if rss.is_finite() && rss >= 0.0 { n * (rss / n + self.floor).ln() + log_variance } else { f64::INFINITY }
    }

    /// Variance of one whitened heading, rad².
    pub fn variance(&self, fit: &Fit) -> f64 {
        fit.rss / self.observations() as f64 + self.floor
    }

    /// Standard deviation of the white noise of one reading, rad: rows may be means of several.
    pub fn noise_of_reading(&self, fit: &Fit) -> f64 {
        self.noise_of_row(fit) * (full_readings(&self.records) as f64).sqrt()
    }

    /// Standard deviation of the white noise of a full row, rad.
    pub fn noise_of_row(&self, fit: &Fit) -> f64 {
        (fit.rss / self.observations() as f64).sqrt()
    }

    /// Number of observed headings.
    pub fn observations(&self) -> usize {
        self.records.iter().map(|record| record.observed.len()).sum()
    }

    /// Every entry of θ.
    pub fn entries(&self, structure: &Structure) -> Vec<Entry> {
        structure.entries(self.inverse_time_scale, self.gain_scale)
    }

    /// The filters of all records for one colour of noise.
    pub fn whiteners(&self, colour: &Colour) -> Vec<Whitener> {
        self.grains.iter().map(|grain| grain.whitener(colour)).collect()
    }

    /// Replayed headings of every record, rad.
    pub fn replay(&self, structure: &Structure, theta: &[f64], initial: &[[f64; 2]]) -> Vec<Vec<f64>> {
        let replayed = |(record, source): (usize, &Record)| {
            let mut out = vec![0.0; source.observed.len()];
            let response = structure.response(record, theta);
            headings(&response, source, initial[record], |seat, heading| out[seat] = heading);
            out
        };
        self.records.iter().enumerate().map(replayed).collect()
    }

    /// Measured less replayed headings of every record, rad.
    pub fn residual(&self, structure: &Structure, theta: &[f64], initial: &[[f64; 2]]) -> Vec<Vec<f64>> {
        let mut headings = self.replay(structure, theta, initial);
        self.records.iter().zip(&mut headings).for_each(|(record, headings)| subtract_from(record, headings));
        headings
    }

    /// Replayed headings of one record, rad, and their derivatives by some of its `variables`: places in θ, and after it the
    /// initial heading and yaw rate.
    fn tangents(
        &self,
        structure: &Structure,
        record: usize,
        theta: &[f64],
        initial: [f64; 2],
        variables: &[usize],
    ) -> (Vec<f64>, Vec<Vec<f64>>) {
        let source = &self.records[record];
        let rows = source.observed.len();
        let (mut replayed, mut columns) = (vec![0.0; rows], vec![vec![0.0; rows]; variables.len()]);
        let constant: Vec<Tangent> = theta.iter().chain(&initial).map(|&value| Tangent::from(value)).collect();
        for (variables, columns) in variables.chunks(DIRECTIONS).zip(columns.chunks_mut(DIRECTIONS)) {
            let mut point = constant.clone();
            for (direction, &variable) in variables.iter().enumerate() {
                point[variable] = Tangent::variable(point[variable].value, direction);
            }
            let (theta, initial) = point.split_at(theta.len());
            let response = structure.response(record, theta);
            headings(&response, source, [initial[0], initial[1]], |seat, heading| {
                replayed[seat] = heading.value;
                columns.iter_mut().zip(heading.by).for_each(|(column, by)| column[seat] = by);
            });
        }
        (replayed, columns)
    }

    /// Residual and sensitivities at a point. Unknowns are the fitted entries of θ in order, then heading and yaw rate at
    /// the beginning of every record.
    pub fn linear(&self, structure: &Structure, theta: &[f64], initial: &[[f64; 2]]) -> Linear {
        let entries = self.entries(structure);
        let fitted: Vec<usize> = (0..entries.len()).filter(|&k| entries[k].fitted).collect();
        let blocks = (0..self.records.len()).map(|record| {
            let acts = |k: &usize| entries[*k].only.is_none_or(|only| only == record);
            let acting = fitted.iter().copied().enumerate().filter(|(_, k)| acts(k));
            let (mut places, mut variables): (Vec<usize>, Vec<usize>) = acting.unzip();
            let of_state = fitted.len() + 2 * record;
            places.push(of_state + 1);
            variables.push(theta.len() + 1);
            if structure.sees_heading() {
                places.push(of_state);
                variables.push(theta.len());
            }
            let (mut replayed, columns) = self.tangents(structure, record, theta, initial[record], &variables);
            subtract_from(&self.records[record], &mut replayed);
            let mut columns: Vec<(usize, Vec<f64>)> = places.into_iter().zip(columns).collect();
            if !structure.sees_heading() {
                // The whole heading turns with where it begins.
                columns.push((of_state, vec![1.0; replayed.len()]));
            }
            Block { residual: replayed, columns }
        });
        Linear { blocks: blocks.collect(), unknowns: fitted.len() + 2 * self.records.len() }
    }

    /// How the heading changes by the last term of a structure being there at all, against the `without` it, and with its
    /// fitted parameters.
    pub fn columns_of_last(
        &self,
        structure: &Structure,
        theta: &[f64],
        initial: &[[f64; 2]],
        without: &[Vec<f64>],
    ) -> (Column, Vec<Column>) {
        let Some((term, range)) = structure.terms.last().zip(structure.terms.len().checked_sub(1)) else {
            return (Column::new(), Vec::new());
        };
        let variables: Vec<usize> =
            structure.range(range).enumerate().filter(|(k, _)| !term.held.contains(k)).map(|(_, at)| at).collect();
        let mut being = Column::new();
        let mut tangents = vec![Column::new(); variables.len()];
        for record in 0..self.records.len() {
            if term.only.is_some_and(|only| only != record) {
                being.push(None);
                tangents.iter_mut().for_each(|column| column.push(None));
                continue;
            }
            let (mut with, columns) = self.tangents(structure, record, theta, initial[record], &variables);
            with.iter_mut().zip(&without[record]).for_each(|(with, without)| *with -= without);
            being.push(Some(with));
            tangents.iter_mut().zip(columns).for_each(|(all, column)| all.push(Some(column)));
        }
        (being, tangents)
    }

    /// Fits a structure from a start, under one colour of noise.
    pub fn fit(&self, structure: &Structure, theta: &[f64], initial: &[[f64; 2]], colour: &Colour) -> Fit {
        self.once(question(structure, theta, initial, colour, None), || {
            let theta = self.inside(structure, theta);
            let whiteners = self.whiteners(colour);
            let linear = self.linear(structure, &theta, initial);
            let columns = linear.whitened(&whiteners);
            let start = Point::new(theta, initial.to_vec(), linear.into_residual(), &whiteners);
            self.search(structure, start, (columns, true), &whiteners, colour)
        })
    }

    /// Fits a fitted model with one more term from a start of it; the sensitivities of the model are known.
    pub fn fit_with(&self, structure: &Structure, start: &[f64], from: &Fit, known: &Known) -> Fit {
        self.once(question(structure, &from.theta, &from.initial, &from.colour, Some(start)), || {
            let theta = [from.theta.as_slice(), start].concat();
            let (_, tangents) = self.columns_of_last(structure, &theta, &from.initial, &known.headings);
            let mut columns = known.columns.clone();
            let own = tangents.len();
            columns.insert(structure.free_count() - own, &tangents, &known.whiteners);
            let theta = self.inside(structure, &theta);
            let residual = self.residual(structure, &theta, &from.initial);
            let start = Point::new(theta, from.initial.clone(), residual, &known.whiteners);
            self.search(structure, start, (columns, false), &known.whiteners, &from.colour)
        })
    }

    /// The answer to a question, looked up where it was asked before.
    fn once(&self, question: Question, fit: impl FnOnce() -> Fit) -> Fit {
        let finished = || self.finished.lock().expect("no fit panics while it holds the lock");
        if let Some(known) = finished().get(&question) {
            return known.clone();
        }
        let fit = fit();
        finished().insert(question, fit.clone());
        fit
    }

    fn inside(&self, structure: &Structure, theta: &[f64]) -> Vec<f64> {
        let entries = self.entries(structure);
        theta.iter().zip(&entries).map(|(x, entry)| x.clamp(entry.lowest, entry.highest)).collect()
    }

    /// Searches for the minimum from a point with whitened sensitivities, which are fresh or those of a point near by.
    ///
    /// Sensitivities are computed anew only when a step did not do what they promised: most terms change the response so
    /// little that one set serves the whole search.
    fn search(
        &self,
        structure: &Structure,
        mut now: Point,
        known: (Columns, bool),
        whiteners: &[Whitener],
        colour: &Colour,
    ) -> Fit {
        let entries = self.entries(structure);
        let mut damping = SMALLEST_DAMPING;
        let negligible = |rss: f64| NEGLIGIBLE * rss / self.observations() as f64;
        let fitted: Vec<usize> = (0..entries.len()).filter(|&k| entries[k].fitted).collect();
        // Whitened columns; `None` when they have to be computed anew.
        let mut sensitivities = Some(known);
        for _ in 0..MOST_STEPS {
            if !now.rss.is_finite() {
                break;
            }
            let (mut columns, fresh) = sensitivities
                .take()
                .unwrap_or_else(|| (self.linear(structure, &now.theta, &now.initial).whitened(whiteners), true));
            let normal = columns.normal(&now.white);
            let mut improved = None;
            for _ in 0..if fresh { MOST_DAMPINGS } else { 1 } {
                let Some((step, promised)) = self.step(&normal, damping, &now.theta, &entries, &fitted) else {
                    damping = 10.0 * damping.max(1e-7);
                    continue;
                };
                if promised < negligible(now.rss) && fresh {
                    break;
                }
                let mut theta = now.theta.clone();
                for (place, &k) in fitted.iter().enumerate() {
                    theta[k] = (theta[k] + step[place]).clamp(entries[k].lowest, entries[k].highest);
                }
                let mut initial = now.initial.clone();
                for (record, initial) in initial.iter_mut().enumerate() {
                    initial[0] += step[fitted.len() + 2 * record];
                    initial[1] += step[fitted.len() + 2 * record + 1];
                }
                let residual = self.residual(structure, &theta, &initial);
                let next = Point::new(theta, initial, residual, whiteners);
                if next.rss < now.rss {
                    improved = Some((next, promised));
                    damping = if damping <= 1e-6 { SMALLEST_DAMPING } else { 0.1 * damping };
                    break;
                }
                damping = (damping * 8.0).max(1e-4);
            }
            let Some((next, promised)) = improved else {
                if fresh {
                    break;
                } else {
                    continue;
                };
            };
            let gain = now.rss - next.rss;
            let surprise = (gain - promised).abs() / promised;
            let before = std::mem::replace(&mut now, next);
            if damping <= 1e-6 && surprise < LESSON {
                if surprise < SURPRISE && promised < negligible(before.rss) {
                    break;
                }
                if surprise >= SURPRISE {
                    columns.learn(&before.step_to(&now, &fitted), &before.white, &now.white);
                }
                sensitivities = Some((columns, false));
            } else if gain < negligible(before.rss) && fresh {
                break;
            }
        }
        self.finished(structure, now, whiteners, colour)
    }

    /// A damped step and how much it lowers RSS if the heading is linear; parameters that would leave their range go to its
    /// end.
    fn step(
        &self,
        normal: &Normal,
        damping: f64,
        theta: &[f64],
        entries: &[Entry],
        fitted: &[usize],
    ) -> Option<(DVector<f64>, f64)> {
        let mut fixed: Vec<Option<f64>> = vec![None; normal.gradient.len()];
        for _ in 0..fitted.len() + 1 {
            let mut matrix = normal.matrix.clone();
            let mut gradient = normal.gradient.clone();
            for (place, &own) in fixed.iter().enumerate().filter_map(|(place, own)| Some((place, own.as_ref()?))) {
                gradient.axpy(-own, &normal.matrix.column(place), 1.0);
            }
            for place in (0..fixed.len()).filter(|&place| fixed[place].is_some()) {
                matrix.row_mut(place).fill(0.0);
                matrix.column_mut(place).fill(0.0);
                gradient[place] = 0.0;
            }
            let mut step = solve(&matrix, &gradient, damping)?;
            for (place, own) in fixed.iter().enumerate() {
                step[place] = own.unwrap_or(step[place]);
            }
            let beyond: Vec<(usize, f64)> = (0..fitted.len())
                .filter(|&place| fixed[place].is_none())
                .filter_map(|place| {
                    let (x, entry) = (theta[fitted[place]], &entries[fitted[place]]);
                    let inside = (x + step[place]).clamp(entry.lowest, entry.highest);
                    (inside != x + step[place]).then_some((place, inside - x))
                })
                .collect();
            if beyond.is_empty() {
                let promised = 2.0 * step.dot(&normal.gradient) - (&normal.matrix * &step).dot(&step);
                return Some((step, promised));
            }
            for (place, own) in beyond {
                fixed[place] = Some(own);
            }
        }
        None
    }

    fn finished(&self, structure: &Structure, point: Point, whiteners: &[Whitener], colour: &Colour) -> Fit {
        let n = self.observations() as f64;
        let fitted = self.entries(structure).iter().filter(|entry| entry.fitted).count();
        let freedom = fitted + 2 * self.records.len() + colour.freedom() + 1;
        let deviance = self.deviance(point.rss, log_variance(whiteners));
        let Point { theta, initial, residual, rss, .. } = point;
        let bic = deviance + freedom as f64 * n.ln();
        Fit { theta, initial, colour: *colour, residual, rss, deviance, freedom, bic }
    }

    /// The random moment of the given kind that explains best what a fit leaves, if it is worth its parameter.
    ///
    /// Level and parameters are found together: for every level the linearised fit is solved anew.
    pub fn best_moment(&self, linear: &Linear, kind: Moment, waves: Option<NarrowBand>) -> (Colour, f64) {
        let value = |level: f64| {
            let colour = Colour { moment: Some((kind, level.exp())), waves };
            let whiteners = self.whiteners(&colour);
            self.deviance(linear.projected(&whiteners), log_variance(&whiteners))
        };
        let (lo, hi) = (1e-3f64.ln(), 1e13f64.ln());
        let (level, deviance) = minimum(lo, hi, 12, value);
        (Colour { moment: Some((kind, level.exp())), waves }, deviance)
    }
}

/// What decides a fit; `start` are the parameters of a last term whose fit begins with known sensitivities.
fn question(
    structure: &Structure,
    theta: &[f64],
    initial: &[[f64; 2]],
    colour: &Colour,
    start: Option<&[f64]>,
) -> Question {
    let names = structure.terms.iter().map(|term| (term.name(), term.held)).collect();
    let constants: Vec<f64> = structure.terms.iter().flat_map(|term| term.effect.constants()).collect();
    let bounds = structure.terms.iter().flat_map(|term| [&term.lowest, &term.highest, &term.scale]).flatten();
    let moment = colour.moment.map_or([0.0; 3], |(kind, level)| [1.0, f64::from(kind == Moment::Walk), level]);
    let waves = colour.waves.map_or([0.0; 3], |waves| [waves.sd, waves.frequency, waves.damping]);
    let shape = [f64::from(structure.own_bias), f64::from(start.is_some())];
    let own = start.unwrap_or_default();
    let numbers = shape
        .iter()
        .chain(&moment)
        .chain(&waves)
        .chain(&constants)
        .chain(bounds)
        .chain(initial.as_flattened())
        .chain(theta)
        .chain(own);
    (names, numbers.map(|x| x.to_bits()).collect())
}

/// Puts measured less replayed headings in the place of the replayed ones.
fn subtract_from(record: &Record, headings: &mut [f64]) {
    for (value, &row) in headings.iter_mut().zip(&record.observed) {
        *value = record.heading[row] - *value;
    }
}

/// Σ log S of all records.
pub(crate) fn log_variance(whiteners: &[Whitener]) -> f64 {
    whiteners.iter().map(|whitener| whitener.log_variance).sum()
}

/// Smallest value on a range: a grid, then golden sections about its lowest point.
pub fn minimum(lo: f64, hi: f64, points: usize, mut value: impl FnMut(f64) -> f64) -> (f64, f64) {
    let at = |k: usize| lo + (hi - lo) * k as f64 / points as f64;
    let heights: Vec<f64> = (0..=points).map(|k| value(at(k))).collect();
    let best = (0..=points).min_by(|&i, &j| heights[i].total_cmp(&heights[j])).unwrap_or(0);
    let (mut left, mut right) = (at(best.saturating_sub(1)), at((best + 1).min(points)));
    let mut found = (at(best), heights[best]);
    let golden = 0.5 * (5f64.sqrt() - 1.0);
    let (mut one, mut two) = (right - golden * (right - left), left + golden * (right - left));
    let (mut f_one, mut f_two) = (value(one), value(two));
    for _ in 0..8 {
        for candidate in [(one, f_one), (two, f_two)] {
            if candidate.1 < found.1 {
                found = candidate;
            }
        }
        if f_one < f_two {
            (right, two, f_two) = (two, one, f_one);
            one = right - golden * (right - left);
            f_one = value(one);
        } else {
            (left, one, f_one) = (one, two, f_two);
            two = left + golden * (right - left);
            f_two = value(two);
        }
    }
    found
}
