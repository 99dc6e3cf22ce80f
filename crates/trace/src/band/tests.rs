use std::sync::Arc;

use nalgebra::DMatrix;
use ship::effects::{Effect, MomentDrift, NonlinearDamping};
use ship::narrow_band::NarrowBand;
use trial::Trial;

use super::*;
use crate::candidates::{Candidate, Sizes};
use crate::made_up::{BASE, Plan, of_columns, record, ship, wandering};
use crate::noise::Wander;
use crate::search::{Search, Thresholds};
use crate::structure::Term;

const WAVES: NarrowBand = NarrowBand { sd: 0.002, frequency: 0.6, damping: 0.1 };

/// A walk and waves, small beside a turn, rad.
const COLOURED: Noise = Noise {
    reading: 1e-6,
    floor: 1e-8,
    colour: Colour { wander: Some((Wander::Walk, 1e-3)), waves: Some(WAVES) },
    elsewhere: 1.0,
};

fn term(effect: Arc<dyn Effect>, records: &[Record]) -> Term {
    let about = Sizes { time: 16.3, rate: 0.01, rudder: 0.17, duration: 300.0, spacing: 1.0 };
    let proposal = effect.proposal(&about.manoeuvres(records, &records[0])).expect("it needs no channel");
    Candidate::new(proposal, None).term
}

fn fit(theta: Vec<f64>, initial: Vec<[f64; 2]>, colour: Colour) -> Fit {
    Fit { theta, initial, colour, residual: Vec::new(), rss: 1.0, deviance: 0.0, freedom: 0, lost: 0.0, bic: 0.0 }
}

/// Covariance of the noise of one record in full: what a system leaves at rows i ≥ j is h Φ(i, j) Pⱼ h.
fn dense(problem: &Problem, record: usize, colour: &Colour, white: impl Fn(f64) -> f64) -> DMatrix<f64> {
    let System { steps, of_row, observe, initial, .. } = problem.noise_of_record(RecordNumber(record)).system(colour);
    let source = &problem.records[record];
    let matrix = |m: &[[f64; MOST]; MOST]| DMatrix::from_fn(MOST, MOST, |i, j| m[i][j]);
    let h = DMatrix::from_fn(1, MOST, |_, i| observe[i]);
    let rows = of_row.len();
    let mut total = DMatrix::zeros(rows, rows);
    let mut p = matrix(&initial);
    for j in 0..rows {
        if j > 0 {
            let (f, q) = &steps[of_row[j]];
            p = matrix(f) * p * matrix(f).transpose() + matrix(q);
        }
        let mut forward = &p * h.transpose();
        for i in j..rows {
            if i > j {
                forward = matrix(&steps[of_row[i]].0) * forward;
            }
            let value = (&h * &forward)[0];
            (total[(i, j)], total[(j, i)]) = (value, value);
        }
        total[(j, j)] += white(source.readings[source.observed[j]] as f64);
    }
    total
}

/// Sensitivities of one record in full: fitted entries of θ, and the initial state.
fn sensitivities(linear: &Linear, record: usize, fitted: usize) -> [DMatrix<f64>; 2] {
    let by = Sensitivities::of(linear, RecordNumber(record), fitted);
    let rows = by.state[0].len();
    let columns = |all: &[Vec<f64>]| DMatrix::from_fn(rows, all.len(), |row, k| all[k][row]);
    [columns(&by.parameters), columns(&by.state)]
}

/// M of a record in full.
fn projection(record: &Record, state: &DMatrix<f64>) -> DMatrix<f64> {
    let rows = record.observed.len();
    let readings =
        DMatrix::from_fn(rows, rows, |i, j| if i == j { record.readings[record.observed[i]] as f64 } else { 0.0 });
    let weighted = state.transpose() * readings;
    DMatrix::identity(rows, rows) - state * (&weighted * state).try_inverse().expect("two columns") * weighted
}

fn assert_alike(spread: &Spread, white: &[f64], variance: &DMatrix<f64>, scale: f64) {
    for (row, white) in white.iter().enumerate() {
        let (one, other) = (spread.variance[row] + white, variance[(row, row)]);
        assert!((one - other).abs() < 1e-9 * scale, "row {row}: {one} and {other}, of {scale}");
    }
}

fn whites(record: &Record, noise: &Noise) -> Vec<f64> {
    record.observed.iter().map(|&row| noise.reading / record.readings[row] as f64 + noise.floor).collect()
}

fn largest(matrix: &DMatrix<f64>) -> f64 {
    matrix.diagonal().max()
}

/// Two records: one of averaged rows with a gap, one with every third heading missing.
fn two_records() -> Problem {
    let damping: Arc<dyn Effect> = Arc::new(NonlinearDamping::Cubic);
    let truth = ship(vec![(damping, vec![80.0])]);
    let dense = record(&truth, Plan { rows: 1001, period: 0.3, ..Plan::default() });
    let mut heading = dense.heading().to_vec();
    heading[400..440].fill(f64::NAN);
    heading[7] = f64::NAN;
    let dense = of_columns(dense.time().to_vec(), heading, dense.rudder().to_vec());
    let sparse = record(&truth, Plan { every: 3, rudder_deg: 15.0, ..Plan::default() });
    let records = vec![Record::averaged(&dense, 16.3), Record::averaged(&sparse, 16.3)];
    assert!(records[0].full_readings > 1);
    Problem::new(records, BASE[0], BASE[1])
}

/// The recursions are the dense matrices, whatever the weights of the fit and the colour of the noise.
#[test]
fn the_band_of_fitted_records_is_that_of_dense_matrices() {
    let both = two_records();
    let alone = both.on(both.records[..1].to_vec());
    for problem in [both, alone] {
        let records = problem.records.len();
        let structure = Structure::base(records, false).with(term(Arc::new(NonlinearDamping::Cubic), &problem.records));
        let waves = Some(NarrowBand { sd: 1.5, ..WAVES });
        let colours = [
            Colour::WHITE,
            Colour { wander: None, waves },
            Colour { wander: Some((Wander::White, 40.0)), waves: None },
            Colour { wander: Some((Wander::Walk, 40.0)), waves },
        ];
        for colour in colours {
            let fit = fit([BASE.to_vec(), vec![80.0]].concat(), vec![[0.01, 0.001]; records], colour);
            let linear = problem.linear(&structure, &fit.theta, &fit.initial);
            let fitted = structure.free_count();
            let unknowns = fitted + 2 * records;
            let mut normal = DMatrix::zeros(unknowns, unknowns);
            let mut scores = Vec::new();
            for (number, record) in problem.records.iter().enumerate() {
                let by = (0..unknowns).map(|place| linear.column(number, place)).collect::<Vec<_>>();
                let by = DMatrix::from_fn(record.observed.len(), unknowns, |row, k| by[k][row]);
                let full = problem.records.iter().map(|record| record.full_readings).max().expect("some") as f64;
                let weight =
                    dense(&problem, number, &colour, |readings| full / readings).try_inverse().expect("definite");
                normal += by.transpose() * &weight * &by;
                scores.push(by.transpose() * weight);
            }
            let scale =
                DMatrix::from_fn(unknowns, unknowns, |i, j| if i == j { normal[(i, i)].sqrt().recip() } else { 0.0 });
            let inverse = &scale * (&scale * normal * &scale).try_inverse().expect("told apart") * &scale;
            let errors: Vec<DMatrix<f64>> = scores.iter().map(|score| inverse.rows(0, fitted) * score).collect();
            let noises: Vec<DMatrix<f64>> = (0..records)
                .map(|number| dense(&problem, number, &COLOURED.colour, |n| COLOURED.reading / n + COLOURED.floor))
                .collect();
            let spreads = of_fitted(&problem, &structure, &fit, &COLOURED).expect("told apart");
            for (number, record) in problem.records.iter().enumerate() {
                let [by, state] = sensitivities(&linear, number, fitted);
                let left = projection(record, &state);
                let rows = record.observed.len();
                let mut variance = DMatrix::zeros(rows, rows);
                for other in 0..records {
                    let mut of = -(&by * &errors[other]);
                    if other == number {
                        of += DMatrix::<f64>::identity(rows, rows);
                    }
                    let of = &left * of;
                    variance += &of * &noises[other] * of.transpose();
                }
                assert_alike(&spreads[number], &whites(record, &COLOURED), &variance, largest(&noises[number]));
            }
        }
    }
}

/// A record that was not fitted: M Σ Mᵀ + (M J) Cov (M J)ᵀ, with the mean of the biases of the fitted records and
/// without their drift.
#[test]
fn the_band_elsewhere_is_that_of_dense_matrices() {
    let problem = two_records();
    let structure = Structure::base(2, true)
        .with(term(Arc::new(MomentDrift { reference_time: 0.0 }), &problem.records))
        .with(term(Arc::new(NonlinearDamping::Cubic), &problem.records));
    let theta = [&BASE[..2], &[0.008, 0.01, 1e-5, 80.0]].concat();
    let sd = [2e-3, 2e-4, 1e-3, 2e-3, 1e-5, 5.0];
    let covariance = DMatrix::from_fn(6, 6, |i, j| sd[i] * sd[j] * if i == j { 1.0 } else { 0.3 });
    let known = Elsewhere {
        problem: &problem,
        structure: &structure,
        theta: &theta,
        covariance: Some(covariance.clone()),
        noise: COLOURED,
    };
    // 1/T, K/T, the mean bias, the damping.
    let kept = DMatrix::from_row_slice(4, 6, &{
        let mut rows = [0.0; 24];
        (rows[0], rows[7], rows[14], rows[15], rows[23]) = (1.0, 1.0, 0.5, 0.5, 1.0);
        rows
    });
    let of_ship = &kept * &covariance * kept.transpose();
    let other = Record::whole(&record(&ship(Vec::new()), Plan { rudder_deg: 12.0, ..Plan::default() }));
    let initial = [0.01, 0.001];
    let on = problem.on(vec![other.clone()]);
    let (portable, values) = held_out::portable_structure(&structure, &theta);
    let [by, state] = sensitivities(&on.linear(&portable, &values, &[initial]), 0, 4);
    let noise = dense(&on, 0, &COLOURED.colour, |n| COLOURED.reading / n + COLOURED.floor);
    let left = projection(&other, &state);
    let variance = &left * (&noise + &by * &of_ship * by.transpose()) * left.transpose();
    let spread = known.spread(other.clone(), initial).expect("told apart");
    assert_alike(&spread, &whites(&other, &COLOURED), &variance, largest(&variance));

    // With a drift of its own, fitted by least squares together with the initial state.
    let drift = term(Arc::new(MomentDrift { reference_time: 0.0 }), &problem.records);
    let own = Structure { ship_known: true, ..portable }.with(drift);
    let fit = fit([values, vec![1e-5]].concat(), vec![initial], Colour::WHITE);
    let free = Structure { ship_known: false, ..own.clone() };
    let [by, state] = sensitivities(&on.linear(&free, &fit.theta, &fit.initial), 0, 5);
    let unknowns = DMatrix::from_fn(by.nrows(), 3, |row, k| if k < 2 { state[(row, k)] } else { by[(row, 4)] });
    let left = projection(&other, &unknowns);
    let of_noise = &left * &noise * left.transpose();
    let of_errors = &left * by.columns(0, 4) * of_ship * by.columns(0, 4).transpose() * left.transpose();
    let spread = known.spread_with_own(other.clone(), &own, &fit).expect("told apart");
    let variance = of_noise + of_errors;
    assert_alike(&spread, &whites(&other, &COLOURED), &variance, largest(&variance));
}

/// A reading of an averaged row has the noise of one reading.
#[test]
fn a_band_is_that_of_readings() {
    let spread = Spread { time: vec![0.0, 2.0], variance: vec![0.0, 8.0], white: 1.0 };
    let band = spread.band(&[0.0, 1.0, 2.0, 9.0]).expect("finite");
    let expected = [1.0, 5f64.sqrt(), 3.0, 3.0];
    assert!(band.iter().zip(expected).all(|(one, sd)| (one - 1.959_964 * sd).abs() < 1e-5), "{band:?}");
}

fn inside(band: &[f64], residual: &[f64]) -> f64 {
    let count = band.iter().zip(residual).filter(|(half, e)| e.abs() <= **half).count();
    count as f64 / band.len() as f64
}

/// Bands of a ship in a moment that walks hold 95 % of the headings, of the records that were fitted and of another,
/// whether the parameters are those of least squares or those of the likelihood.
#[test]
fn bands_hold_what_they_promise() {
    let mut shares = [0.0; 4];
    let replicates = 100;
    for seed in 0..replicates {
        let trials = [seed, seed + 500].map(|seed| wandering(60.0, seed));
        let other = wandering(60.0, seed + 1500);
        let problem = Problem::new(trials.iter().map(Record::whole).collect(), BASE[0], BASE[1]);
        let search = Search::new(&problem, &[], Thresholds::default());
        let model = search.base(Structure::base(2, false), &BASE, &[[0.0; 2]; 2]);
        let noise = Noise::of(&problem, &model.structure, &model.judged);
        for (fit, shares) in [&model.plain, &model.judged].into_iter().zip(shares.chunks_mut(2)) {
            let response = model.structure.response(RecordNumber(0), &fit.theta);
            let residual = |trial: &Trial| {
                crate::replay_errors::full(&response, &Record::whole(trial), &[[0.0; 2]]).expect("finite").residual
            };
            let spreads = of_fitted(&problem, &model.structure, fit, &noise).expect("told apart");
            for (trial, spread) in trials.iter().zip(spreads) {
                shares[0] += 0.5 * inside(&spread.band(trial.time()).expect("finite"), &residual(trial));
            }
            let known = Elsewhere::new(&problem, &model.structure, fit, noise);
            let band = known.band(Record::whole(&other), fit.initial[0], other.time()).expect("told apart");
            shares[1] += inside(&band, &residual(&other));
        }
    }
    let shares = shares.map(|share| share / replicates as f64);
    assert!(shares.iter().all(|share| (0.93..0.97).contains(share)), "{shares:?}");
}
