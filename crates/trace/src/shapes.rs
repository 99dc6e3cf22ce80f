//! What no effect on the list is: moments of a shape that chance does not have. A random moment can follow almost any
//! heading, so it describes what is left only if no shape does it better.
//!
//! Every shape is a moment over time, as an equivalent rudder angle; the heading answers it as that of the base does:
//! a term in r, δ and ψ, the way made good to one side (a bank), a ship that is another one from an instant on, a
//! moment for a while. They are scanned beside all unknowns of the best structure; the noise of the best ones is then
//! found anew, since without them it had to hold what they explain.

use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;
use ship::Replayable;
use ship::dynamics::Dynamics;
use ship::first_order::{State, Transition};
use ship::replay::replay_states;

use estimation::column::dot;

use crate::empirical::{PRIOR_SD, plain};
use crate::fit::{FittedRecords, StructureFit};
use crate::full::Full;
use crate::law::{ChosenLaw, LinearisedFit};
use crate::linear::HeadingSensitivities;
use crate::model::step;
use crate::noise::{CorrelatedNoise, NoiseColour};
use crate::structures::WeighedStructure;
use crate::weights::NoiseLaw;

/// Log of the prior odds that there is anything of each kind.
const LOG_ODDS: f64 = -7.0;

/// Gain in the log of the evidence, odds counted, from which a shape is believed, and within which two are alike.
const BELIEVED: f64 = 2.0;
const ALIKE: f64 = 3.0;

/// Shapes that are taken together at most.
const MOST: usize = 3;

/// Shapes of each scan whose noise is found anew.
const FINALISTS: usize = 2;

/// Lengths of moments for a while, and of the time between instants, as shares of the record.
const LENGTHS: [f64; 5] = [1.0 / 40.0, 1.0 / 20.0, 1.0 / 10.0, 1.0 / 5.0, 1.0];
const BETWEEN: f64 = 1.0 / 40.0;

/// Standard deviation of the share by which a ship may change.
const CHANGE_SD: f64 = 0.3;

/// Solver steps for each shortest time constant.
const STEPS: f64 = 2.0;

/// A moment, or two that come together, with what the heading answers.
#[derive(Debug, Clone)]
struct MomentShape {
    form: String,
    log_odds: f64,
    /// Prior standard deviation of the coefficients, rad.
    sd: f64,
    /// For every coefficient: the records in which it acts, with the change of the heading for 1 rad.
    columns: Vec<Vec<(usize, Vec<f64>)>>,
}

/// Shapes that explain what is left.
#[derive(Debug, Clone)]
pub struct Empirical {
    /// The best, and those that the records cannot tell from it; several together are one entry.
    pub group: Vec<String>,
    /// Coefficients with standard deviations, rad of rudder at the root mean square of the shape.
    pub coefficients: Vec<(f64, f64)>,
    /// Gain in the log of the evidence, prior odds counted.
    pub gain: f64,
    /// Root mean square heading error with them, rad.
    pub error: f64,
}

/// One record as the best structure replays it.
struct ReplayedMotion<'a> {
    problem: &'a FittedRecords,
    number: usize,
    base: [f64; 2],
    rate: Vec<f64>,
    heading: Vec<f64>,
    rudder: Vec<f64>,
}

impl<'a> ReplayedMotion<'a> {
    fn of(problem: &'a FittedRecords, fit: &StructureFit, number: usize) -> Self {
        let record = &problem.records[number];
        let response = fit.structure.response(Some(number), &fit.theta);
        let recorded = record.recorded(&response);
        let mut state = vec![0.0; response.dimension()];
        let [heading, rate] = fit.initial[number];
        response.enter(heading, rate, &recorded.input(record.time[0], response.dead_time()), &mut state);
        let mut own = Self {
            problem,
            number,
            base: [fit.theta[0], fit.theta[1]],
            rate: Vec::new(),
            heading: Vec::new(),
            rudder: Vec::new(),
        };
        let step = step(&response, record.spacing, STEPS);
        replay_states(&response, &recorded, &record.time, step, &mut state, |_, state, input| {
            own.heading.push(state[0]);
            own.rate.push(state[1]);
            own.rudder.push(input.rudder + fit.theta[2]);
        });
        own
    }

    fn time(&self) -> &[f64] {
        &self.problem.records[self.number].time
    }

    /// Change of the heading at the observed rows for a moment over the rows, rad for rad of rudder.
    fn answer(&self, moment: impl Fn(usize) -> f64) -> Vec<f64> {
        let [inverse_time, gain] = self.base;
        let time = self.time();
        let mut state = State::default();
        let mut all = vec![0.0; time.len()];
        let mut known: Option<Transition> = None;
        for row in 1..time.len() {
            let h = time[row] - time[row - 1];
            let transition = *match &mut known {
                Some(own) if own.h == h => own,
                other => other.insert(Transition::new(inverse_time, h)),
            };
            let [from, to] = [gain * moment(row - 1), gain * moment(row)];
            state = transition.advance(state, from, (to - from) / h);
            all[row] = state.heading;
        }
        self.problem.records[self.number].observed.iter().map(|&row| all[row]).collect()
    }

    /// The way to one side for every metre made good, as a time: ∫ sin(ψ − ψ₀) dt, s.
    fn aside(&self) -> Vec<f64> {
        let (time, mut sum) = (self.time(), 0.0);
        let mut all = vec![0.0];
        for row in 1..time.len() {
            let sine = |row: usize| (self.heading[row] - self.heading[0]).sin();
            sum += 0.5 * (time[row] - time[row - 1]) * (sine(row) + sine(row - 1));
            all.push(sum);
        }
        all
    }
}

/// One coefficient of a shape that all records share, in units of the root mean square of its moment.
fn shared(motions: &[ReplayedMotion], form: &str, log_odds: f64, moments: &[Vec<f64>]) -> Option<MomentShape> {
    let (square, rows) = moments.iter().flatten().fold((0.0, 0.0), |(sum, n), m| (sum + m * m, n + 1.0));
    let size = (square / rows).sqrt();
    if !(size.is_finite() && size > 0.0) {
        return None;
    }
    let column = |(motion, own): (&ReplayedMotion, &Vec<f64>)| (motion.number, motion.answer(|row| own[row] / size));
    let columns = vec![motions.iter().zip(moments).map(column).collect()];
    Some(MomentShape { form: form.into(), log_odds, sd: PRIOR_SD, columns })
}

/// Every shape.
fn library(motions: &[ReplayedMotion]) -> Vec<MomentShape> {
    let odds = LOG_ODDS - (plain().len() as f64).ln();
    let monomial = |powers: &crate::empirical::Powers| {
        let of = |motion: &ReplayedMotion| -> Vec<f64> {
            let value = |row: usize| powers.at([motion.rate[row], motion.rudder[row], motion.heading[row]]);
            (0..motion.rate.len()).map(value).collect()
        };
        shared(motions, powers.form, odds, &motions.iter().map(of).collect::<Vec<_>>())
    };
    let mut all: Vec<MomentShape> = plain().iter().filter(|powers| powers.of[3] == 0).filter_map(monomial).collect();
    let aside: Vec<Vec<f64>> = motions.iter().map(ReplayedMotion::aside).collect();
    all.extend(shared(motions, "distance to one side", LOG_ODDS, &aside));
    all.extend(motions.iter().flat_map(of_time));
    all
}

/// Shapes that belong to an instant of one record.
fn of_time(motion: &ReplayedMotion) -> Vec<MomentShape> {
    let time = motion.time();
    let (start, duration) = (time[0], time[time.len() - 1] - time[0]);
    let odds = |places: usize| LOG_ODDS - (places as f64).ln();
    let single = |column: Vec<f64>| vec![(motion.number, column)];
    let mut all = Vec::new();
    let instants = (1.0 / BETWEEN) as usize;
    for k in 4..instants - 3 {
        let at = start + BETWEEN * duration * k as f64;
        let after = |row: usize| if time[row] >= at { 1.0 } else { 0.0 };
        // 1/T times 1 + a, K/T times 1 + b: moments −a r/b₀ and b (δ + δ_r).
        let slower = motion.answer(|row| after(row) * motion.rate[row] * motion.base[0] / motion.base[1]);
        let weaker = motion.answer(|row| after(row) * motion.rudder[row]);
        all.push(MomentShape {
            form: format!("another K and T from {at:.0} s on"),
            log_odds: odds(instants),
            sd: CHANGE_SD,
            columns: vec![single(slower), single(weaker)],
        });
    }
    for share in LENGTHS {
        let (length, lasts) = (share * duration, share >= 1.0);
        let step = if lasts { 0.5 * BETWEEN * duration } else { 0.5 * length };
        let places = ((duration - if lasts { 0.0 } else { length }) / step) as usize;
        for k in 1..places {
            let from = start + step * k as f64;
            let form = match lasts {
                true => format!("moment from {from:.0} s on"),
                false => format!("moment from {from:.0} to {:.0} s", from + length),
            };
            let column = motion.answer(|row| if (from..from + length).contains(&time[row]) { 1.0 } else { 0.0 });
            all.push(MomentShape {
                form,
                log_odds: odds(places * LENGTHS.len()),
                sd: PRIOR_SD,
                columns: vec![single(column)],
            });
        }
    }
    all
}

/// A linearised structure with shapes behind its unknowns, and the noise that this leaves.
#[derive(Clone)]
struct ShapedFit<'a> {
    linearised: LinearisedFit<'a>,
    shapes: Vec<MomentShape>,
    law: NoiseLaw,
    /// −2 log of the evidence, odds counted.
    height: f64,
}

impl<'a> ShapedFit<'a> {
    fn new(linearised: LinearisedFit<'a>, shapes: Vec<MomentShape>, start: &NoiseLaw) -> Self {
        let ChosenLaw { law, height, .. } = linearised.law(start, &CorrelatedNoise::all().collect::<Vec<_>>());
        let of = |shape: &MomentShape| 2.0 * (shape.columns.len() as f64 * shape.sd.ln() - shape.log_odds);
        let height = height + shapes.iter().map(of).sum::<f64>();
        Self { linearised, shapes, law, height }
    }

    /// The same with one more shape.
    fn with(&self, shape: &MomentShape) -> Self {
        let mut linearised = self.linearised.clone();
        for column in &shape.columns {
            for (record, values) in column {
                linearised.linear.blocks[*record].columns.push((linearised.linear.unknowns, values.clone()));
            }
            linearised.linear.unknowns += 1;
            linearised.prior.push((shape.sd.powi(-2), 0.0));
        }
        Self::new(linearised, [self.shapes.as_slice(), std::slice::from_ref(shape)].concat(), &self.law)
    }

    /// Places of the shapes that explain most under a law.
    fn scan(&self, law: &NoiseLaw, library: &[MomentShape]) -> Vec<usize> {
        let weights = self.linearised.problem.weights(law);
        let Some((factor, step)) = self.linearised.solved(&weights) else { return Vec::new() };
        let blocks = self.linearised.linear.blocks.iter().enumerate();
        let white: Vec<HeadingSensitivities> = blocks.map(|(record, block)| block.white(record, &weights)).collect();
        let gain = |shape: &MomentShape| {
            let mut own = shape.columns.clone();
            own.iter_mut().flatten().for_each(|(record, column)| weights.apply(*record, &mut [column]));
            let cross = own.iter().map(|column| {
                let mut cross = DVector::zeros(step.len());
                column.iter().for_each(|(record, values)| white[*record].products(values, &mut cross));
                cross
            });
            let cross: Vec<DVector<f64>> = cross.collect();
            let matrix = DMatrix::from_fn(own.len(), own.len(), |i, j| {
                let both = own[i].iter().zip(&own[j]).map(|((_, one), (_, other))| dot(one, other)).sum::<f64>();
                both - cross[i].dot(&factor.solve(&cross[j])) + if i == j { shape.sd.powi(-2) } else { 0.0 }
            });
            let with = DVector::from_fn(own.len(), |i, _| {
                let residual = |(record, values): &(usize, Vec<f64>)| dot(values, &white[*record].residual);
                own[i].iter().map(residual).sum::<f64>() - cross[i].dot(&step)
            });
            matrix.cholesky().map_or(0.0, |own| with.dot(&own.solve(&with))) + 2.0 * shape.log_odds
        };
        let gains: Vec<f64> = library.par_iter().map(gain).collect();
        let mut order: Vec<usize> = (0..library.len()).collect();
        order.sort_by(|&one, &other| gains[other].total_cmp(&gains[one]));
        order.truncate(FINALISTS);
        order
    }

    /// The best with one more shape, and those that are alike: shapes are looked for under the noise as it stands, and
    /// under white noise, which hides none.
    fn next(&self, library: &[MomentShape]) -> Vec<Self> {
        let white = NoiseLaw { colour: NoiseColour { wander: None, ..self.law.colour }, ..self.law.clone() };
        let mut places = self.scan(&self.law, library);
        places.extend(self.scan(&white, library));
        places.sort_unstable();
        places.dedup();
        let mut all: Vec<Self> = places.into_par_iter().map(|place| self.with(&library[place])).collect();
        all.sort_by(|one, other| one.height.total_cmp(&other.height));
        all
    }
}

/// Shapes that explain what the best structure leaves better than any noise; `None` where none clearly does.
pub fn explain(problem: &FittedRecords, full: &Full, member: &WeighedStructure) -> Option<Empirical> {
    let fit = &member.fit;
    let motions: Vec<ReplayedMotion> =
        (0..problem.records.len()).map(|number| ReplayedMotion::of(problem, fit, number)).collect();
    let library = library(&motions);
    let first = ShapedFit::new(LinearisedFit::of(problem, fit), Vec::new(), &full.law);
    // A second shape may pay only beside the first, and the first only beside the second.
    let mut rounds: Vec<Vec<ShapedFit>> = Vec::new();
    for _ in 0..MOST {
        let stand = rounds.last().map_or(&first, |all| &all[0]);
        let all = stand.next(&library);
        if all.is_empty() {
            break;
        }
        rounds.push(all);
    }
    let all = rounds.into_iter().min_by(|one, other| one[0].height.total_cmp(&other[0].height))?;
    let best = &all[0];
    let gain = 0.5 * (first.height - best.height);
    if gain < BELIEVED {
        return None;
    }
    let form =
        |stand: &ShapedFit| stand.shapes.iter().map(|shape| shape.form.as_str()).collect::<Vec<_>>().join(" and ");
    let group = all.iter().filter(|one| one.height < best.height + 2.0 * ALIKE).map(form).collect();
    let weights = problem.weights(&best.law);
    let (factor, step) = best.linearised.solved(&weights)?;
    let covariance = factor.inverse();
    let of_shapes = first.linearised.linear.unknowns..step.len();
    let (mut square, mut rows) = (0.0, 0.0);
    for block in &best.linearised.linear.blocks {
        for (row, residual) in block.residual.iter().enumerate() {
            let answer: f64 = block.columns.iter().map(|(unknown, column)| step[*unknown] * column[row]).sum();
            square += (residual - answer).powi(2);
            rows += 1.0;
        }
    }
    Some(Empirical {
        group,
        coefficients: of_shapes.map(|k| (step[k], covariance[(k, k)].sqrt())).collect(),
        gain,
        error: (square / rows).sqrt(),
    })
}
