//! Shapes on records of known truth.

use std::f64::consts::{PI, TAU};
use std::sync::Arc;

use document::trace::Dependence;
use estimation::column::dot;
use nalgebra::{DMatrix, DVector};
use ship::angle::{from_deg, to_deg};
use ship::effects::{Effect, Formula};
use trial::Trial;

use super::criterion::{LinearisedStructure, WhitenedStructure};
use super::dictionary::{ShipSignal, SignalFunction};
use super::library::shapes;
use super::*;
use crate::base::FittedBase;
use crate::candidates::ship_length_time;
use crate::fit::StoppingRule;
use crate::full::start_point;
use crate::linear::{HeadingSensitivities, Linearisation};
use crate::model::Structure;
use crate::noise::RecordNoise;
use crate::record::PreparedRecord;
use crate::testing::{BASE, TrialPlan, moved, of_columns, record, ship, wandering};

/// Heading noise of the records, deg.
const NOISE_DEG: f64 = 0.1;

fn plan(seed: u64) -> TrialPlan {
    TrialPlan { noise_deg: NOISE_DEG, seed, ..TrialPlan::default() }
}

/// Record of a first-order ship under a moment (deg of rudder) against time (s).
fn in_moment(seed: u64, moment_deg: impl Fn(f64) -> f64) -> Trial {
    moved(&record(&ship(Vec::new()), plan(seed)), |t| from_deg(moment_deg(t)))
}

/// Record of a ship with a moment given as a formula with coefficient `c`.
fn with_formula(formula: &str, c: f64) -> Trial {
    let effect: Arc<dyn Effect> = Formula::parse(formula).expect("a formula");
    record(&ship(vec![(effect, vec![c])]), plan(5))
}

/// Shape analysis of the residual of the base.
fn analysed(trials: &[Trial]) -> ShapeAnalysis {
    let base = FittedBase::fit(trials).expect("a base");
    let response = base.estimate.response;
    let time = ship_length_time(trials, response.K_over_T);
    let records = trials.iter().map(|trial| PreparedRecord::averaged(trial, time)).collect();
    let problem = FittedRecords::new(records, response.inverse_T, time);
    let law = NoiseLaw::white(trials.len(), base.mean_square());
    let structure = Structure::base(trials.len(), time);
    let theta = start_point(&structure, &response, std::iter::empty());
    let fit = problem.fit(&structure, theta, base.initial(), &problem.whitening(&law), StoppingRule::FINE);
    analyse_shapes(&problem, &fit, &law).expect("an analysis")
}

/// Clearest shape with its record.
fn clearest(analysis: &ShapeAnalysis) -> (Shape, Option<usize>) {
    let named = analysis.named_shapes(|_| 300.0);
    named.first().map(|named| (named.candidate.shape, named.candidate.record_index)).expect("a shape")
}

#[test]
fn moments_that_depend_on_time_are_located() {
    let step = analysed(&[in_moment(1, |t| if t > 150.0 { 1.0 } else { 0.0 })]);
    let (shape, _) = clearest(&step);
    assert!(step.has_significant_shapes() && shape.dependence() == Dependence::Time, "{shape:?}");
    assert!(shape.span(300.0).is_some_and(|[from, _]| (from - 150.0).abs() < 6.0), "{shape:?}");
    let size = step.named_shapes(|_| 300.0)[0].rudder_rms;
    assert!((to_deg(size) - 0.5_f64.sqrt()).abs() < 0.15, "{} deg", to_deg(size));

    let periodic = analysed(&[in_moment(2, |t| (TAU * t / 70.0).sin())]);
    assert!(matches!(clearest(&periodic).0, Shape::Sinusoid(cycles) if (300.0 / cycles - 70.0).abs() < 3.0));

    let squalls = analysed(&[in_moment(3, |t| {
        let squall =
            |middle: f64| if (t - middle).abs() < 15.0 { (PI * (t - middle) / 30.0).cos().powi(2) } else { 0.0 };
        6.0 * (squall(90.0) - squall(210.0))
    })]);
    let spans: Vec<[f64; 2]> =
        squalls.named_shapes(|_| 300.0).iter().filter_map(|named| named.candidate.shape.span(300.0)).collect();
    let is_held = |middle: f64| spans.iter().any(|[from, until]| (from..=until).contains(&&middle));
    assert!(is_held(90.0) && is_held(210.0), "{spans:?}");
}

#[test]
fn moments_of_the_motion_are_located() {
    let cases = [
        ("bank = c * y", -1.5e-3, Dependence::LateralDistance),
        ("tug = c * max(psi, 0)", -0.1, Dependence::Heading),
        ("cubic = c * psi^3", -1.0, Dependence::Heading),
    ];
    for (formula, c, dependence) in cases {
        let analysis = analysed(&[with_formula(formula, c)]);
        assert!(analysis.has_significant_shapes(), "{formula}: {}", analysis.gain_nats);
        assert_eq!(clearest(&analysis).0.dependence(), dependence, "{formula}");
    }
}

/// Instrument noise alone gives no shape; a random-walk moment gives a random moment of its size and no shape.
#[test]
fn chance_is_no_shape() {
    for seed in 1..4 {
        let calm = analysed(&[in_moment(seed, |_| 0.0)]);
        assert!(!calm.has_significant_shapes() && calm.random_moment.is_none() && !calm.is_smooth_moment, "{calm:?}");
        assert!((to_deg(calm.white_heading_sd[0]) / NOISE_DEG - 1.0).abs() < 0.15, "{:?}", calm.white_heading_sd);
        let walk = analysed(&[wandering(30.0, seed)]);
        // 30 deg at the end of 300 s without damping: a walk of √(20/300⁵) 30 deg/s² √s, over K/T as a rudder angle.
        let size = 30.0 * (20.0 / 300f64.powi(5)).sqrt() / BASE[1] * 150f64.sqrt();
        let ratio = to_deg(walk.random_moment.expect("a random moment").rudder_rms) / size;
        assert!(!walk.has_significant_shapes() && (0.4..2.5).contains(&ratio), "{ratio} {:?}", walk.best_explanation);
    }
}

/// A moment of one record is located in that record only.
#[test]
fn shapes_of_time_belong_to_their_record() {
    let trials = [in_moment(7, |_| 0.0), in_moment(8, |t| if t > 120.0 { 1.5 } else { 0.0 })];
    let analysis = analysed(&trials);
    let (shape, only) = clearest(&analysis);
    assert_eq!((only, shape.is_time_dependent()), (Some(1), true), "{shape:?}");
}

/// Criterion by dense matrices: (n − p) log s² + log det(XᵀX) − Σ log |x|² + penalties, and with one more column.
#[test]
fn criteria_are_those_of_dense_matrices() {
    let rows = 40;
    let column = |k: usize| (0..rows).map(|row| (0.3 * (k * row + row) as f64).sin() + 0.1 * k as f64).collect();
    let columns: Vec<Vec<f64>> = (1..5).map(column).collect();
    let residual: Vec<f64> = (0..rows).map(|row| 0.02 * (1.7 * row as f64).cos() + 0.01 * columns[3][row]).collect();
    let block =
        HeadingSensitivities { residual: residual.clone(), columns: (0..).zip(columns[..3].to_vec()).collect() };
    let structure = LinearisedStructure {
        linear: Linearisation { blocks: vec![block], unknowns: 3 },
        integrated: 2,
        prior: vec![(0.0, 0.0); 2],
        departures_from_neutral: vec![0.7],
        min_variance: 0.0,
    };
    let time: Vec<f64> = (0..rows).map(|row| row as f64).collect();
    let made = of_columns(time, residual.clone(), vec![0.0; rows]);
    let noise = RecordNoise::new(&PreparedRecord::unaveraged(&made), 0.1, 40.0, 1);
    let whitening = RecordWhitening { whiteners: vec![noise.whitener(&NoiseColour::WHITE)], scale: vec![10.0] };
    let (log_n, freedom) = ((rows as f64).ln(), rows as f64 - 2.0);
    let dense = |count: usize| {
        let x = DMatrix::from_fn(rows, count, |i, k| 10.0 * columns[k][i]);
        let e = DVector::from_fn(rows, |i, _| 10.0 * residual[i]);
        let matrix = x.transpose() * &x;
        let step = matrix.clone().cholesky().expect("independent").solve(&(x.transpose() * &e));
        let variance = (&e - &x * &step).norm_squared() / freedom;
        let integrated = matrix.view((0, 0), (2, 2)).determinant();
        // Sequential t value of a coefficient, from its neutral value.
        let penalty = |k: usize, away: f64| {
            let before = x.columns(0, k).into_owned();
            let column = x.column(k).into_owned();
            let inverse = (before.transpose() * &before).try_inverse().expect("independent");
            let independent = &column - &before * (inverse * (before.transpose() * &column));
            let later: f64 = (k + 1..count).map(|j| step[j] * independent.dot(&x.column(j))).sum();
            let c = (step[k] + away) * independent.norm() + later / independent.norm();
            log_n.max((c * c / variance).ln_1p()) + 1.0
        };
        let sizes: f64 = (0..2).map(|k| x.column(k).norm_squared().ln()).sum();
        let penalties = penalty(2, 0.7) + if count > 3 { penalty(3, 0.0) } else { 0.0 };
        freedom * variance.ln() - 2.0 * rows as f64 * 10f64.ln() + integrated.ln() - sizes + log_n + penalties
    };
    let whitened = WhitenedStructure::new(&structure, &whitening, 1).expect("independent");
    assert!((whitened.criterion() - dense(3)).abs() < 1e-8, "{} {}", whitened.criterion(), dense(3));
    let mut white = vec![vec![(0, columns[3].clone())]];
    white[0][0].1.iter_mut().for_each(|x| *x *= 10.0);
    let with = whitened.extended(&white).expect("independent");
    assert!((whitened.criterion_with(&white) - dense(4)).abs() < 1e-8 && (with.criterion() - dense(4)).abs() < 1e-8);
    assert!(
        (with.gauss_newton_step()[3] - 0.01).abs() < 0.01
            && whitened.criterion_with(&[vec![(0, vec![0.0; rows])]]).is_infinite()
    );
    let left = with.innovations();
    assert!((dot(&left[0], &left[0]) - freedom).abs() < 1e-8);
}

/// The sizes of the laws agree with the moments in their filters.
#[test]
fn laws_have_the_sizes_they_say() {
    let (gain, longest) = (BASE[1], 300.0);
    let all = laws::random_laws(gain, longest, 1.0, None);
    assert_eq!(all.len(), 1 + 7 + 17 + 3 * 6 + 4 * 6 + 4 * 4);
    for law in all.iter().filter(|law| law.is_moment()) {
        let (kind, level) = law.colour.correlated.expect("a moment");
        let size = kind.size(level, longest) / gain;
        assert!((size / law.size - 1.0).abs() < 1e-9, "{kind:?} {size} {}", law.size);
    }
    // With waves of the noise law no other waves are tried, and rows far apart exclude short waves.
    let sea = Some(ship::narrow_band::NarrowBandProcess { sd: 1.0, frequency: 0.7, damping: 0.1 });
    assert!(laws::random_laws(gain, longest, 1.0, sea).iter().all(|law| law.colour.waves == sea));
    assert_eq!(laws::random_laws(gain, longest, 3.0, None).len(), all.len() - 2 * 4);
    let walk =
        all.iter().position(|law| law.size > 0.09 && law.size < 0.11 && law.parameter_count == 1).expect("a law");
    let tried = laws::screening_law_indices(&all, walk);
    assert!(tried.contains(&0) && tried.contains(&walk) && tried.len() < 16, "{tried:?}");
}

#[test]
fn shapes_can_be_moved_and_typed() {
    let all = shapes([300.0, 1.0], 1.0);
    assert!(all.len() > 600, "{}", all.len());
    for (shape, _) in &all {
        if let Some(formula) = shape.formula() {
            assert!(Formula::parse(&format!("located = {formula}")).is_ok(), "{formula}");
        }
        for place in 0..shape.parameter_count() {
            let back = shape.moved(place, 1.0, [300.0, 1.0]).and_then(|moved| moved.moved(place, -1.0, [300.0, 1.0]));
            let text = |shape: &Shape| shape.description([0.0, 300.0]);
            assert!(back.is_some_and(|back| text(&back) == text(shape)), "{shape:?}");
        }
    }
    let tug = Shape::Powers(Dependence::Heading, (ShipSignal::Heading, SignalFunction::Positive), None);
    assert_eq!(tug.formula().as_deref(), Some("c * max(psi, 0)"));
    assert_eq!(Shape::Pulse(91.0, 24.0).description([0.0, 300.0]), "moment from 91 to 115 s");
    assert_eq!(Shape::Pulse(91.0, 2.0).moved(1, -1.0, [300.0, 1.0]), None);
}

#[test]
fn tried_beside_the_best_law_are_weaker_ones_walks_and_an_error_of_the_compass() {
    let laws = laws::random_laws(0.01, 600.0, 1.0, None);
    let kind = |law: &RandomLaw| law.colour.correlated.map(|(kind, _)| kind);
    let sea = |law: &RandomLaw| law.colour.waves.map(|sea| sea.frequency);
    let tried = |best: &dyn Fn(&RandomLaw) -> bool| {
        let places = laws::screening_law_indices(&laws, laws.iter().position(best).expect("a law"));
        places.into_iter().map(|place| laws[place]).collect::<Vec<_>>()
    };
    let sizes = |among: &[RandomLaw], is: &dyn Fn(&RandomLaw) -> bool| -> Vec<f64> {
        among.iter().filter(|law| is(law)).map(|law| (100.0 * law.size.log10()).round() / 100.0).collect()
    };
    let gusts = Some(CorrelatedNoise::OrnsteinUhlenbeck(0));
    let beside_gusts = tried(&|law| kind(law) == gusts && (law.size - 10.0).abs() < 1e-9);
    assert_eq!(sizes(&beside_gusts, &|law| kind(law) == gusts), [-0.5, 0.0, 0.5, 1.0]);
    let walk = Some(CorrelatedNoise::WalkMoment);
    assert_eq!(sizes(&beside_gusts, &|law| kind(law) == walk), [-2.0, -1.0, 0.0, 1.0, 2.0]);
    assert_eq!(sizes(&beside_gusts, &|law| kind(law) == Some(CorrelatedNoise::CompassError(1))), [0.0]);
    assert_eq!(beside_gusts.len(), 1 + 4 + 5 + 1);
    let waves = Some(TAU / 7.0);
    let beside_waves = tried(&|law| sea(law) == waves && law.size == 3.0);
    assert!(beside_waves.iter().all(|law| sea(law).is_none() || sea(law) == waves), "{beside_waves:?}");
}
