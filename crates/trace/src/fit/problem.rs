//! The records that are fitted together: replays of a structure through them, and how these change with its unknowns.

use ship::Tangent;
use ship::number::DIRECTIONS;

use super::linear::{Block, Column, Linear};
use super::memory::Memory;
use super::outcome::Fit;
use crate::index::{RecordNumber, ThetaPlace};
use crate::noise::{Colour, RecordNoise, Whitener};
use crate::record::Record;
use crate::structure::{Entry, Structure, fitted, headings};

/// No heading is believed to be better than this, rad: a thousandth of a degree.
const FINEST: f64 = 1.75e-5;

/// Share of the rows whose rudder bends most, by which the error of the rudder between rows is judged.
const BENT: f64 = 0.05;

/// Heading error, rad, that a rudder sampled at rows leaves: a corner between two rows is cut, which changes the
/// integral of the rudder by up to an eighth of its second difference times the step, and the heading by that times K.
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
    noise: Vec<RecordNoise>,
    inverse_time: f64,
    inverse_time_scale: f64,
    gain_scale: f64,
    floor: f64,
    pub(super) memory: Memory,
}

impl Problem {
    /// Prepares records of a ship whose base response is about 1/T, K/T.
    pub fn new(records: Vec<Record>, inverse_time: f64, gain: f64) -> Self {
        let longest = records.iter().map(Record::duration).fold(0.0, f64::max);
        let full = full_readings(&records);
        let noise = records.iter().map(|record| RecordNoise::new(record, inverse_time, longest, full)).collect();
        let inverse_time_scale = inverse_time.abs().max(1.0 / longest);
        let time = inverse_time_scale.recip().min(0.1 * longest);
        let floor = records.iter().map(|record| blur(record, gain * time)).fold(FINEST, f64::max).powi(2);
        let memory = Memory::default();
        Self { records, noise, inverse_time, inverse_time_scale, gain_scale: gain, floor, memory }
    }

    /// The same ship on other records.
    pub fn on(&self, records: Vec<Record>) -> Self {
        let (damping, full) = (self.inverse_time, full_readings(&records));
        let noise = records.iter().map(|record| RecordNoise::new(record, damping, self.longest(), full)).collect();
        Self { records, noise, memory: Memory::default(), ..*self }
    }

    /// Length of the longest record, s.
    pub fn longest(&self) -> f64 {
        self.noise.iter().map(RecordNoise::longest).fold(0.0, f64::max)
    }

    /// −2 log L of a whitened sum of squares (rad²) and Σ log S, up to a constant of the records, the variance at its
    /// best value but not below what the rudder between rows leaves unknown.
    pub fn deviance(&self, rss: f64, log_variance: f64) -> f64 {
        let n = self.observations() as f64;
        if rss.is_finite() && rss >= 0.0 { n * (rss / n + self.floor).ln() + log_variance } else { f64::INFINITY }
    }

    /// Variance that the rudder between rows leaves unknown, rad².
    pub(crate) fn floor(&self) -> f64 {
        self.floor
    }

    /// Variance of one whitened heading, rad².
    pub fn variance(&self, fit: &Fit) -> f64 {
        fit.rss / self.observations() as f64 + self.floor
    }

    /// Standard deviation of the white noise of one reading, rad: rows may be means of several.
    pub fn noise_of_reading(&self, fit: &Fit) -> f64 {
        self.noise_of_row(fit) * (self.full_readings() as f64).sqrt()
    }

    /// Readings behind the heading of a full row.
    pub(crate) fn full_readings(&self) -> usize {
        full_readings(&self.records)
    }

    /// Standard deviation of the white noise of a full row, rad.
    pub fn noise_of_row(&self, fit: &Fit) -> f64 {
        (fit.rss / self.observations() as f64).sqrt()
    }

    /// The noise of one record.
    pub(crate) fn noise_of_record(&self, record: RecordNumber) -> &RecordNoise {
        &self.noise[record.0]
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
        self.noise.iter().map(|noise| noise.whitener(colour)).collect()
    }

    /// Replayed headings of every record, rad.
    pub fn replay(&self, structure: &Structure, theta: &[f64], initial: &[[f64; 2]]) -> Vec<Vec<f64>> {
        let replayed = |(record, source): (usize, &Record)| {
            let mut out = vec![0.0; source.observed.len()];
            let response = structure.response(RecordNumber(record), theta);
            headings(&response, source, initial[record], |number, heading| out[number] = heading);
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

    /// Replayed headings of one record, rad, and their derivatives by some of its `variables`: places in θ, and after
    /// it the initial heading and yaw rate.
    fn tangents(
        &self,
        structure: &Structure,
        record: RecordNumber,
        theta: &[f64],
        initial: [f64; 2],
        variables: &[ThetaPlace],
    ) -> (Vec<f64>, Vec<Vec<f64>>) {
        let source = &self.records[record.0];
        let rows = source.observed.len();
        let (mut replayed, mut columns) = (vec![0.0; rows], vec![vec![0.0; rows]; variables.len()]);
        let constant: Vec<Tangent> = theta.iter().chain(&initial).map(|&value| Tangent::from(value)).collect();
        for (variables, columns) in variables.chunks(DIRECTIONS).zip(columns.chunks_mut(DIRECTIONS)) {
            let mut point = constant.clone();
            for (direction, &ThetaPlace(variable)) in variables.iter().enumerate() {
                point[variable] = Tangent::variable(point[variable].value, direction);
            }
            let (theta, initial) = point.split_at(theta.len());
            let response = structure.response(record, theta);
            headings(&response, source, [initial[0], initial[1]], |number, heading| {
                replayed[number] = heading.value;
                columns.iter_mut().zip(heading.by).for_each(|(column, by)| column[number] = by);
            });
        }
        (replayed, columns)
    }

    /// Residual and sensitivities at a point. Unknowns are the fitted entries of θ in order, then heading and yaw rate
    /// at the beginning of every record.
    pub fn linear(&self, structure: &Structure, theta: &[f64], initial: &[[f64; 2]]) -> Linear {
        let entries = self.entries(structure);
        let fitted = fitted(&entries);
        let blocks = (0..self.records.len()).map(|record| {
            let acts = |at: &ThetaPlace| entries[at.0].only.is_none_or(|only| only == RecordNumber(record));
            let acting = fitted.iter().copied().enumerate().filter(|(_, at)| acts(at));
            let (mut places, mut variables): (Vec<usize>, Vec<ThetaPlace>) = acting.unzip();
            let of_state = fitted.len() + 2 * record;
            places.push(of_state + 1);
            variables.push(ThetaPlace(theta.len() + 1));
            if structure.sees_heading() {
                places.push(of_state);
                variables.push(ThetaPlace(theta.len()));
            }
            let (mut replayed, columns) =
                self.tangents(structure, RecordNumber(record), theta, initial[record], &variables);
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

    /// What the last term of a structure does to the heading: the replay with it less the headings `without` it, and
    /// the derivatives by its fitted parameters.
    pub fn columns_of_last(
        &self,
        structure: &Structure,
        theta: &[f64],
        initial: &[[f64; 2]],
        without: &[Vec<f64>],
    ) -> (Column, Vec<Column>) {
        let Some(last) = structure.places().next_back() else {
            return (Column::new(), Vec::new());
        };
        let term = structure.term(last);
        let own = structure.range(last).enumerate().filter(|(k, _)| !term.held.contains(k));
        let variables: Vec<ThetaPlace> = own.map(|(_, at)| ThetaPlace(at)).collect();
        let mut presence = Column::new();
        let mut tangents = vec![Column::new(); variables.len()];
        for record in 0..self.records.len() {
            if term.only.is_some_and(|only| only != RecordNumber(record)) {
                presence.push(None);
                tangents.iter_mut().for_each(|column| column.push(None));
                continue;
            }
            let (mut with, columns) =
                self.tangents(structure, RecordNumber(record), theta, initial[record], &variables);
            with.iter_mut().zip(&without[record]).for_each(|(with, without)| *with -= without);
            presence.push(Some(with));
            tangents.iter_mut().zip(columns).for_each(|(all, column)| all.push(Some(column)));
        }
        (presence, tangents)
    }
}

/// Puts measured less replayed headings in the place of the replayed ones.
fn subtract_from(record: &Record, headings: &mut [f64]) {
    for (value, &row) in headings.iter_mut().zip(&record.observed) {
        *value = record.heading[row] - *value;
    }
}
