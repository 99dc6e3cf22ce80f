//! How far a record may be from a replay if the model is right: 95 % bands from the noise of the record and the errors
//! of the parameters, to first order.
//!
//! The residual of a replay whose initial state was fitted to the record itself is
//!
//! e = M (w − J (θ̂ − θ)), M = I − C (Cᵀ R C)⁻¹ Cᵀ R,
//!
//! with the noise w of the record, the sensitivities C to the initial state and J to the parameters, and the readings R
//! behind every row. What the noise of the record itself has done to the parameters is a linear functional of it,
//! s = Σ lₖ wₖ, so that e is w less a few such sums; all else that moves them is independent of w and adds its
//! covariance. The noise is that of [`crate::noise`], a linear system with white heading noise, in which the covariance
//! of a sum with every row comes from one recursion forward and one backward in time: the work is linear in the rows.
//!
//! A band holds chance only. It does not know of effects that are on no list, nor of the search that chose the
//! structure.
//!
//! Sources: the delta method; Ljung (1999), chapter 9, for the covariance of a parameter under another noise than the
//! one it was weighted with; Anderson and Moore (1979) for the recursions.

use nalgebra::{DMatrix, DVector, Matrix2, Vector2};
use ship::Polyline;
use ship::narrow_band::NarrowBand;

use crate::fit::{Fit, Linear, Problem, Restricted};
use crate::held_out;
use crate::index::RecordNumber;
use crate::noise::{Colour, MOST, System, propagate, transposed};
use crate::record::Record;
use crate::structure::Structure;

/// Standard deviations on either side of 95 % of a normal error.
const QUANTILE: f64 = 1.959_963_984_540_054;

/// The noise of the records as one fit sees it, on their own scale.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Noise {
    /// Variance of the white noise of one reading of the heading, rad².
    pub reading: f64,
    /// Variance of what the rudder between rows leaves unknown, which no averaging makes smaller, rad².
    pub floor: f64,
    /// What wanders with its variance in rad², waves with their standard deviation in rad.
    pub colour: Colour,
    /// How much larger the variance of what wanders is on average over what the records leave open. On the records
    /// from which it was estimated the best value counts, since they are what it describes; elsewhere the average does.
    pub elsewhere: f64,
}

impl Noise {
    /// No noise at all.
    pub const NONE: Self = Self { reading: 0.0, floor: 0.0, colour: Colour::WHITE, elsewhere: 1.0 };

    /// The noise of a fit, its size that of [`Problem::restricted`].
    pub fn of(problem: &Problem, structure: &Structure, fit: &Fit) -> Self {
        let linear = problem.linear(structure, &fit.theta, &fit.initial);
        let Restricted { row, level, mean } = problem.restricted(&linear, &fit.colour);
        let Colour { wander, waves } = fit.colour;
        Self {
            reading: row * problem.full_readings() as f64,
            floor: problem.floor(),
            colour: Colour {
                wander: wander.map(|(kind, _)| (kind, level * row)),
                waves: waves.map(|waves| NarrowBand { sd: waves.sd * row.sqrt(), ..waves }),
            },
            elsewhere: mean,
        }
    }

    /// The same on records from which it was not estimated.
    fn elsewhere(self) -> Self {
        let wander = self.colour.wander.map(|(kind, variance)| (kind, variance * self.elsewhere));
        Self { colour: Colour { wander, ..self.colour }, elsewhere: 1.0, ..self }
    }
}

/// What varies in the residual of one record.
#[derive(Debug, Clone, PartialEq)]
pub struct Spread {
    time: Vec<f64>,
    /// Variance without the white noise of the row itself, rad²; it changes smoothly from row to row.
    variance: Vec<f64>,
    /// Variance of the white noise of a reading, rad².
    white: f64,
}

impl Spread {
    /// Half the width of the 95 % band of a reading at every one of some times (s), rad; `None` where a variance is
    /// not finite.
    pub fn band(&self, time: &[f64]) -> Option<Vec<f64>> {
        let variance = Polyline::new(self.time.clone(), self.variance.clone()).ok()?;
        let half = |&t: &f64| QUANTILE * (variance.at(t) + self.white).max(0.0).sqrt();
        Some(time.iter().map(half).collect())
    }
}

/// The noise of one record: a linear system, and the variance of the white noise of every observed row, rad².
struct Rows {
    system: System,
    white: Vec<f64>,
}

impl Rows {
    fn new(problem: &Problem, record: RecordNumber, noise: &Noise) -> Self {
        let source = &problem.records[record.0];
        let white = |&row: &usize| noise.reading / source.readings[row] as f64 + noise.floor;
        let system = problem.noise_of_record(record).system(&noise.colour);
        Self { system, white: source.observed.iter().map(white).collect() }
    }
}

/// Sums Σ lₖ wₖ of the noise of one record, rad².
struct Sums {
    /// Variance of every row without its white noise.
    of_row: Vec<f64>,
    /// Covariance of every sum with every row.
    with_row: Vec<Vec<f64>>,
    /// Covariance of the sums.
    own: DMatrix<f64>,
}

impl Sums {
    fn new(rows: &Rows, weights: &[Vec<f64>]) -> Self {
        let Rows { system: System { steps, of_row: step, observe, initial, .. }, white } = rows;
        let dot = |one: &[f64; MOST], other: &[f64; MOST]| (0..MOST).map(|i| one[i] * other[i]).sum::<f64>();
        let forward = |row: usize, x: &[f64; MOST]| steps[step[row]].0.map(|f| dot(&f, x));
        // Covariance of the state with the heading it is seen through, row by row.
        let mut covariance = *initial;
        let mut seen = Vec::with_capacity(white.len());
        for row in 0..white.len() {
            if row > 0 {
                let (f, q) = &steps[step[row]];
                covariance = propagate(f, &covariance, q);
            }
            seen.push(covariance.map(|own| dot(&own, observe)));
        }
        let with_row: Vec<Vec<f64>> = weights
            .iter()
            .map(|weights| {
                // Covariance of the sum so far with the state, then what the state will add to it.
                let (mut so_far, mut later) = ([0.0; MOST], [0.0; MOST]);
                let mut sums = Vec::with_capacity(white.len());
                for (row, weight) in weights.iter().enumerate() {
                    if row > 0 {
                        so_far = forward(row, &so_far);
                    }
                    (0..MOST).for_each(|i| so_far[i] += weight * seen[row][i]);
                    sums.push(dot(&so_far, observe) + weight * white[row]);
                }
                for row in (0..white.len()).rev() {
                    sums[row] += dot(&later, &seen[row]);
                    (0..MOST).for_each(|i| later[i] += weights[row] * observe[i]);
                    later = transposed(&steps[step[row]].0, &later);
                }
                sums
            })
            .collect();
        let count = weights.len();
        let own = DMatrix::from_fn(count, count, |i, j| lanes::column::dot(&with_row[i], &weights[j]));
        Self { of_row: seen.iter().map(|seen| dot(seen, observe)).collect(), with_row, own }
    }
}

/// Sensitivities of the headings of one record: to its initial state, and to the fitted entries of θ.
struct Sensitivities {
    state: [Vec<f64>; 2],
    parameters: Vec<Vec<f64>>,
}

impl Sensitivities {
    /// Out of linear equations with `fitted` entries of θ; zeros where an entry does not act.
    fn of(linear: &Linear, record: RecordNumber, fitted: usize) -> Self {
        let first = fitted + 2 * record.0;
        let column = |place: usize| linear.column(record.0, place);
        Self { state: [column(first), column(first + 1)], parameters: (0..fitted).map(column).collect() }
    }
}

/// Takes from a column what the initial state of the record, fitted to all of its readings, can do.
struct Projection<'a> {
    state: &'a [Vec<f64>; 2],
    /// The states times the readings of the rows.
    weighted: [Vec<f64>; 2],
    inverse: Matrix2<f64>,
}

impl<'a> Projection<'a> {
    /// `None` where the two cannot be told apart.
    fn new(record: &Record, state: &'a [Vec<f64>; 2]) -> Option<Self> {
        let readings = |column: &Vec<f64>| -> Vec<f64> {
            column.iter().zip(&record.observed).map(|(c, &row)| c * record.readings[row] as f64).collect()
        };
        let weighted = [readings(&state[0]), readings(&state[1])];
        let matrix = Matrix2::from_fn(|i, j| lanes::column::dot(&state[i], &weighted[j]));
        Some(Self { state, inverse: matrix.try_inverse()?, weighted })
    }

    fn state_at(&self, row: usize) -> Vector2<f64> {
        self.inverse * Vector2::new(self.state[0][row], self.state[1][row])
    }

    fn apply(&self, column: &[f64]) -> Vec<f64> {
        let [one, other] = [0, 1].map(|k| lanes::column::dot(&self.weighted[k], column));
        let left = |(row, value): (usize, &f64)| value - self.state_at(row).dot(&Vector2::new(one, other));
        column.iter().enumerate().map(left).collect()
    }
}

/// Variance of the residual of one record.
///
/// `own` has what the noise of this record has done to parameters: their columns, and weights gₖ of the rows with
/// θ̂ − θ = Σ gₖ wₖ. `others` are columns of parameters whose errors have a covariance of their own.
fn spread(
    record: &Record,
    rows: &Rows,
    state: &[Vec<f64>; 2],
    own: (&[Vec<f64>], &[Vec<f64>]),
    others: Option<(&[Vec<f64>], &DMatrix<f64>)>,
    white: f64,
) -> Option<Spread> {
    let projection = Projection::new(record, state)?;
    let columns: Vec<Vec<f64>> = own.0.iter().map(|column| projection.apply(column)).collect();
    let outside: Vec<Vec<f64>> =
        others.iter().flat_map(|(columns, _)| *columns).map(|column| projection.apply(column)).collect();
    let weights: Vec<Vec<f64>> = projection.weighted.iter().chain(own.1).cloned().collect();
    let sums = Sums::new(rows, &weights);
    let variance = |row: usize| {
        let of_state = projection.state_at(row);
        let by = DVector::from_iterator(
            weights.len(),
            of_state.iter().copied().chain(columns.iter().map(|column| column[row])),
        );
        let with = DVector::from_iterator(weights.len(), sums.with_row.iter().map(|sum| sum[row]));
        let noise = sums.of_row[row] - 2.0 * by.dot(&with) + by.dot(&(&sums.own * &by));
        let outside = DVector::from_iterator(outside.len(), outside.iter().map(|column| column[row]));
        noise + others.map_or(0.0, |(_, covariance)| outside.dot(&(covariance * &outside)))
    };
    let variance: Vec<f64> = (0..record.observed.len()).map(variance).collect();
    let time = record.observed.iter().map(|&row| record.time[row]).collect();
    variance.iter().all(|v| v.is_finite()).then_some(Spread { time, variance, white })
}

/// Weights gₖ of the noise of every record in the errors of the fitted entries of θ, Σ over records of Σ gₖ wₖ, for
/// parameters and initial states that were fitted together under one colour. `None` when they cannot be told apart.
fn weights(problem: &Problem, linear: &Linear, colour: &Colour, fitted: usize) -> Option<Vec<Vec<Vec<f64>>>> {
    let whiteners = problem.whiteners(colour);
    let white = linear.whitened(&whiteners);
    let inverse = white.covariance()?;
    let of_record = |(record, whitener): (usize, &crate::noise::Whitener)| {
        let mut weights = vec![vec![0.0; problem.records[record].observed.len()]; fitted];
        for (place, column) in white.of_record(record) {
            let mut column = column.to_vec();
            whitener.apply_transposed(&mut column);
            for (parameter, weights) in weights.iter_mut().enumerate() {
                let share = inverse[(parameter, place)];
                weights.iter_mut().zip(&column).for_each(|(weight, c)| *weight += share * c);
            }
        }
        weights
    };
    Some(whiteners.iter().enumerate().map(of_record).collect())
}

/// The spread of the residual of every record that a fit was made to. `None` when its unknowns cannot be told apart.
pub fn of_fitted(problem: &Problem, structure: &Structure, fit: &Fit, noise: &Noise) -> Option<Vec<Spread>> {
    let linear = problem.linear(structure, &fit.theta, &fit.initial);
    let fitted = structure.free_count();
    let weights = weights(problem, &linear, &fit.colour, fitted)?;
    let numbers = || (0..problem.records.len()).map(RecordNumber);
    let rows: Vec<Rows> = numbers().map(|record| Rows::new(problem, record, noise)).collect();
    let is_alone = rows.len() == 1;
    let errors: Vec<DMatrix<f64>> = match is_alone {
        true => Vec::new(),
        false => rows.iter().zip(&weights).map(|(rows, weights)| Sums::new(rows, weights).own).collect(),
    };
    numbers()
        .map(|record| {
            let RecordNumber(number) = record;
            let by = Sensitivities::of(&linear, record, fitted);
            let mut of_others = DMatrix::zeros(fitted, fitted);
            errors.iter().enumerate().filter(|(other, _)| *other != number).for_each(|(_, own)| of_others += own);
            let (columns, weights) = (by.parameters.as_slice(), weights[number].as_slice());
            let others = (!is_alone).then_some((columns, &of_others));
            let white = noise.reading + noise.floor;
            spread(&problem.records[number], &rows[number], &by.state, (columns, weights), others, white)
        })
        .collect()
}

/// Covariance of the fitted entries of θ of a fit under a noise, whatever noise it was weighted with. `None` when they
/// cannot be told apart.
pub fn covariance(problem: &Problem, structure: &Structure, fit: &Fit, noise: &Noise) -> Option<DMatrix<f64>> {
    let linear = problem.linear(structure, &fit.theta, &fit.initial);
    let fitted = structure.free_count();
    let weights = weights(problem, &linear, &fit.colour, fitted)?;
    let of_record = |(record, weights): (usize, &Vec<Vec<f64>>)| {
        Sums::new(&Rows::new(problem, RecordNumber(record), noise), weights).own
    };
    Some(weights.iter().enumerate().map(of_record).fold(DMatrix::zeros(fitted, fitted), |sum, own| sum + own))
}

/// A model that was fitted to other records than the one it is held against.
#[derive(Debug, Clone)]
pub struct Elsewhere<'a> {
    /// The records it was fitted to.
    pub problem: &'a Problem,
    /// Its structure there.
    pub structure: &'a Structure,
    /// Its parameters.
    pub theta: &'a [f64],
    /// Covariance of the fitted ones, in order, where they can be told apart.
    pub covariance: Option<DMatrix<f64>>,
    /// The noise of the other record.
    pub noise: Noise,
}

impl<'a> Elsewhere<'a> {
    /// A fitted structure in the noise of the records.
    pub fn new(problem: &'a Problem, structure: &'a Structure, fit: &'a Fit, noise: Noise) -> Self {
        let noise = noise.elsewhere();
        let covariance = covariance(problem, structure, fit, &noise);
        Self { problem, structure, theta: &fit.theta, covariance, noise }
    }

    /// The band at some times (s) of a record that is replayed from about `initial`, rad: that of what
    /// [`held_out::portable`] keeps of the model.
    pub fn band(&self, record: Record, initial: [f64; 2], time: &[f64]) -> Option<Vec<f64>> {
        self.spread(record, initial)?.band(time)
    }

    /// The spread of its residual there.
    pub fn spread(&self, record: Record, initial: [f64; 2]) -> Option<Spread> {
        let (structure, theta) = held_out::portable_structure(self.structure, self.theta);
        let problem = self.problem.on(vec![record]);
        let linear = problem.linear(&structure, &theta, &[initial]);
        let by = Sensitivities::of(&linear, RecordNumber(0), structure.free_count());
        self.on(&problem, &by.state, (&[], &[]), &by.parameters)
    }

    /// The same where a moment of the record's own was fitted to it with white noise: the last term of `structure`,
    /// the ship being known.
    pub fn spread_with_own(&self, record: Record, structure: &Structure, fit: &Fit) -> Option<Spread> {
        let problem = self.problem.on(vec![record]);
        let known = problem.linear(structure, &fit.theta, &fit.initial);
        let own = structure.free_count();
        let weights = weights(&problem, &known, &fit.colour, own)?.pop()?;
        let free = Structure { ship_known: false, ..structure.clone() };
        let all = problem.linear(&free, &fit.theta, &fit.initial);
        let Sensitivities { state, mut parameters } = Sensitivities::of(&all, RecordNumber(0), free.free_count());
        let moment = parameters.split_off(parameters.len().checked_sub(own)?);
        // An error of the ship moves the moment as well.
        for column in &mut parameters {
            let moved: Vec<f64> = weights.iter().map(|weights| lanes::column::dot(weights, column)).collect();
            for (moment, moved) in moment.iter().zip(moved) {
                column.iter_mut().zip(moment).for_each(|(value, m)| *value -= moved * m);
            }
        }
        self.on(&problem, &state, (&moment, &weights), &parameters)
    }

    fn on(
        &self,
        problem: &Problem,
        state: &[Vec<f64>; 2],
        own: (&[Vec<f64>], &[Vec<f64>]),
        ship: &[Vec<f64>],
    ) -> Option<Spread> {
        let covariance = held_out::portable_covariance(self.problem, self.structure, self.covariance.as_ref()?);
        let rows = Rows::new(problem, RecordNumber(0), &self.noise);
        let white = self.noise.reading + self.noise.floor;
        spread(&problem.records[0], &rows, state, own, Some((ship, &covariance)), white)
    }
}

#[cfg(test)]
mod tests;
