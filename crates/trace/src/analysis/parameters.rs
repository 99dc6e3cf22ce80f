//! Parameters of the final model with their errors, and its random part.

#![expect(non_snake_case, reason = "K and T are the symbols of the field")]

use identify::Estimate;
use identify::estimate::{Covariance, StopReason, Uncertainty};
use nalgebra::{DMatrix, Matrix3};
use ship::FirstOrder;
use ship::narrow_band::NarrowBand;
use statrs::distribution::{ContinuousCDF, Normal};
use trial::Quantity;

use super::result::{Considered, Fitted, Outcome, Randomness, RunnerUp};
use super::told::Told;
use crate::candidates::Candidate;
use crate::fit::{Fit, Problem};
use crate::noise::Wander;
use crate::search::Model;
use crate::structure::Structure;

/// Covariance of the fitted parameters: from the information matrix of the likelihood, or from the scores (Newey and
/// West 1987) where the noise is coloured in a way that the fit does not know.
pub(super) fn parameter_covariance(
    problem: &Problem,
    (structure, fit): (&Structure, &Fit),
    coloured: bool,
) -> Option<DMatrix<f64>> {
    let whiteners = problem.whiteners(&fit.colour);
    let linear = problem.linear(structure, &fit.theta, &fit.initial);
    let columns = linear.whitened(&whiteners);
    let inverse = columns.covariance()?;
    let observations = problem.observations() as f64;
    let freedom = observations - columns.unknowns() as f64;
    if !coloured {
        return Some(inverse * (fit.rss / freedom));
    }
    let middle = identify::robust::newey_west(&columns.scores(&linear.whitened_residual(&whiteners)));
    Some(&inverse * middle * &inverse * (observations / freedom))
}

/// The first-order part of a model with rudder bias number `bias`, and what is known of its error.
fn first_order(theta: &[f64], bias: usize, covariance: Option<&DMatrix<f64>>) -> Estimate {
    let places = [0, 1, 2 + bias];
    let [inverse_T, K_over_T, rudder_bias] = places.map(|place| theta[place]);
    let uncertainty = match covariance {
        Some(all) => {
            let matrix = Matrix3::from_fn(|i, j| all[(places[i], places[j])]);
            Uncertainty::Covariance(Covariance { matrix, degrees_of_freedom: None })
        }
        None => Uncertainty::None { reason: "the records do not tell the parameters apart" },
    };
    Estimate {
        response: FirstOrder { inverse_T, K_over_T, rudder_bias },
        uncertainty,
        robust: None,
        stop: StopReason::Converged,
        evaluations: 0,
        diagnostics: Vec::new(),
        warnings: Vec::new(),
    }
}

/// All parameters of a model, in the order of its entries.
pub(super) fn parameters(
    problem: &Problem,
    (structure, fit): (&Structure, &Fit),
    covariance: Option<&DMatrix<f64>>,
    names: &[String],
) -> Vec<Fitted> {
    let biases = 2..structure.base_count();
    let quantile = Normal::standard().inverse_cdf(0.975);
    let mut fitted = 0..;
    problem
        .entries(structure)
        .iter()
        .zip(&fit.theta)
        .enumerate()
        .map(|(number, (entry, &value))| {
            let place = entry.fitted.then(|| fitted.next()).flatten();
            let sd = place.zip(covariance).map(|(place, all)| all[(place, place)].max(0.0).sqrt());
            let sd = sd.filter(|sd| sd.is_finite());
            let ci95 = if biases.contains(&number) {
                first_order(&fit.theta, number - 2, covariance).rudder_bias().ci95
            } else {
                sd.map(|sd| [value - quantile * sd, value + quantile * sd])
            };
            let only = entry.only.map(|only| names[only.0].clone());
            Fitted {
                parameter: entry.parameter,
                quantity: Quantity { value, sd, ci95 },
                only,
                at_bound: entry.ends_at(value),
            }
        })
        .collect()
}

/// K and T of a model, and the rudder bias of the ship; `None` when every one of several records has its own.
pub(super) fn indices(
    (structure, fit): (&Structure, &Fit),
    covariance: Option<&DMatrix<f64>>,
) -> ([Quantity; 2], Option<Quantity>) {
    let estimate = first_order(&fit.theta, 0, covariance);
    let bias = (structure.base_count() == 3).then(|| estimate.rudder_bias());
    ([estimate.K(), estimate.T()], bias)
}

/// Likelihood ratio per parameter below which chance alone could have made it: nothing is said of such a candidate.
const CHANCE: f64 = 2.0;

/// The candidate nearest to being believed beside the random moment of a model.
pub(super) fn runner_up(problem: &Problem, candidates: &[Considered], terms: &[Candidate]) -> Option<RunnerUp> {
    let log_n = (problem.observations() as f64).ln();
    let of = |(one, candidate): (&Considered, &Candidate)| {
        let freedom = candidate.term.freedom() as f64;
        let ratio = one.evidence?.gain + freedom * log_n;
        let is_open = one.outcome != Outcome::Added && !candidate.term.effect.is_of_time() && ratio > CHANCE * freedom;
        // ratio · x − freedom · (log n + log x) = needed, by repeated substitution.
        let times = (0..50).fold(1.0_f64, |x, _| (one.needed + freedom * (log_n + x.ln())).max(ratio) / ratio);
        is_open.then_some(RunnerUp { id: one.id, form: one.form, times })
    };
    candidates.iter().zip(terms).filter_map(of).min_by(|one, other| one.times.total_cmp(&other.times))
}

/// The noise as the final model sees it; as an angle of the rudder by the K/T that is told.
pub(super) fn randomness(problem: &Problem, model: &Model, told: &Told, runner_up: Option<RunnerUp>) -> Randomness {
    let fit = &model.judged;
    let of_row = problem.noise_of_row(fit);
    let gain = told.sides[1].fit.theta[1].abs();
    let wander = fit.colour.wander;
    let moment = wander.filter(|(kind, _)| !kind.is_of_compass());
    let size = |(kind, level): (Wander, f64)| kind.size(level * of_row * of_row, problem.longest()) / gain;
    Randomness {
        white: problem.noise_of_reading(fit),
        wander: wander.map(|(kind, _)| kind),
        heading: wander.map_or(0.0, |(_, level)| level.sqrt() * of_row),
        rudder: moment.map_or(0.0, size),
        correlation: wander.and_then(|(kind, _)| kind.correlation(problem.longest())),
        holds: told.noise_holds,
        runner_up,
        waves: fit.colour.waves.map(|waves| NarrowBand { sd: waves.sd * of_row, ..waves }),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::made_up::{BASE, Plan, record, ship};
    use crate::noise::Colour;
    use crate::record::Record;

    /// Two records whose rudders are off by different angles.
    fn with_own_biases() -> (Problem, Structure, Fit) {
        let records = [-0.02, 0.03].map(|bias| {
            let ship = ship::ResponseModel::first_order().with(vec![BASE[0], BASE[1], bias]);
            Record::whole(&record(&ship, Plan::default()))
        });
        let problem = Problem::new(records.into(), BASE[0], BASE[1]);
        let structure = Structure::base(2, true);
        let fit = problem.fit(&structure, &[BASE[0], BASE[1], 0.0, 0.0], &[[0.0; 2]; 2], &Colour::WHITE);
        (problem, structure, fit)
    }

    #[test]
    fn a_bias_of_one_record_is_not_that_of_the_ship() {
        let (problem, structure, fit) = with_own_biases();
        let covariance = parameter_covariance(&problem, (&structure, &fit), false);
        let names = ["one", "other"].map(String::from);
        let all = parameters(&problem, (&structure, &fit), covariance.as_ref(), &names);
        assert!((all[2].quantity.value + 0.02).abs() < 1e-3 && (all[3].quantity.value - 0.03).abs() < 1e-3, "{all:?}");
        assert_eq!([all[2].only.as_deref(), all[3].only.as_deref()], [Some("one"), Some("other")]);
        assert_eq!(indices((&structure, &fit), covariance.as_ref()).1, None);
    }

    /// A ship that answers faster than the base can: its 1/T stops where the range of the base does.
    #[test]
    fn a_parameter_at_the_end_of_its_range_says_so() {
        let ends = |inverse_time: f64| {
            let theta = vec![inverse_time, 0.1 * inverse_time, 0.0];
            let ship = ship::ResponseModel::first_order().with(theta.clone());
            let plan = Plan { rows: 2001, period: 0.1, ..Plan::default() };
            let problem = Problem::new(vec![Record::whole(&record(&ship, plan))], theta[0], theta[1]);
            let structure = Structure::base(1, false);
            let fit = problem.fit(&structure, &theta, &[[0.0; 2]], &Colour::WHITE);
            let all = parameters(&problem, (&structure, &fit), None, &[String::from("one")]);
            (all[0].quantity.value, all.iter().map(|fitted| fitted.at_bound).collect::<Vec<_>>())
        };
        assert_eq!(ends(30.0), (ship::response::BASE[0].highest, vec![true, false, false]));
        assert_eq!(ends(0.1).1, [false; 3]);
    }

    /// One estimate has one interval: that of δ_r is Fieller's wherever it is told, which is no longer symmetric when
    /// K/T is not well known.
    #[test]
    fn the_rudder_bias_has_one_interval() {
        let truth = ship(Vec::new());
        let problem = Problem::new(vec![Record::whole(&record(&truth, Plan::default()))], BASE[0], BASE[1]);
        let structure = Structure::base(1, false);
        let fit = problem.fit(&structure, &BASE, &[[0.0; 2]], &Colour::WHITE);
        let mut covariance =
            parameter_covariance(&problem, (&structure, &fit), false).expect("a zig-zag tells them apart");
        covariance[(1, 1)] = (0.3 * BASE[1]).powi(2);
        covariance[(1, 2)] = 0.5 * (covariance[(1, 1)] * covariance[(2, 2)]).sqrt();
        covariance[(2, 1)] = covariance[(1, 2)];
        let (_, bias) = indices((&structure, &fit), Some(&covariance));
        let bias = bias.expect("of one record");
        let listed = &parameters(&problem, (&structure, &fit), Some(&covariance), &[String::from("one")])[2];
        assert_eq!(listed.quantity, bias);
        let [low, high] = bias.ci95.expect("bounded");
        assert!((high - bias.value) / (bias.value - low) > 1.2 || (bias.value - low) / (high - bias.value) > 1.2);
    }
}
