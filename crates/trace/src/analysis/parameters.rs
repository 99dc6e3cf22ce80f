//! Parameters of the final model with their errors, and its random part.

use identify::estimate::{Covariance, Quantity};
use nalgebra::{DMatrix, Matrix3};
use ship::FirstOrder;
use ship::narrow_band::NarrowBand;

use super::{Randomness, Value};
use crate::fit::Problem;
use crate::search::Model;

/// Autocorrelation above which a residual is called coloured.
const COLOURED: f64 = 0.2;

/// Covariance of the fitted parameters of the final model; from the scores where the residual is coloured.
pub(super) fn parameter_covariance(problem: &Problem, model: &Model, lag1: f64) -> Option<DMatrix<f64>> {
    let fit = &model.plain;
    let whiteners = problem.whiteners(&fit.colour);
    let linear = problem.linear(&model.structure, &fit.theta, &fit.initial);
    let columns = linear.whitened(&whiteners);
    let inverse = columns.covariance()?;
    let observations = problem.observations() as f64;
    let freedom = observations - columns.unknowns() as f64;
    let coloured = model.judged.colour.moment.is_some() || (fit.colour.is_white() && lag1.abs() > COLOURED);
    if !coloured {
        return Some(inverse * (fit.rss / freedom));
    }
    let middle = identify::robust::newey_west(&columns.scores(&linear.whitened_residual(&whiteners)));
    Some(&inverse * middle * &inverse * (observations / freedom))
}

pub(super) fn parameters(
    problem: &Problem,
    model: &Model,
    covariance: Option<&DMatrix<f64>>,
    names: &[String],
) -> Vec<Value> {
    let mut place = 0;
    problem
        .entries(&model.structure)
        .iter()
        .zip(&model.plain.theta)
        .map(|(entry, &value)| {
            let sd = entry.fitted.then(|| {
                place += 1;
                covariance.map(|covariance| covariance[(place - 1, place - 1)].max(0.0).sqrt())
            });
            Value {
                symbol: entry.symbol.to_owned(),
                unit: entry.unit,
                value,
                sd: sd.flatten().filter(|sd| sd.is_finite()),
                only: entry.only.map(|only| names[only].clone()),
            }
        })
        .collect()
}

pub(super) fn indices(model: &Model, covariance: Option<&DMatrix<f64>>) -> [Quantity; 3] {
    let theta = &model.plain.theta;
    let response = FirstOrder { inverse_T: theta[0], K_over_T: theta[1], rudder_bias: theta[2] };
    match covariance {
        Some(all) => {
            let matrix = Matrix3::from_fn(|i, j| all[(i, j)]);
            let covariance = Covariance { matrix, degrees_of_freedom: None };
            let (k, t) = covariance.indices(&response);
            let sd = matrix[(2, 2)].max(0.0).sqrt();
            let reach = covariance.quantile95() * sd;
            let ci95 = Some([response.rudder_bias - reach, response.rudder_bias + reach]);
            [k, t, Quantity { value: response.rudder_bias, sd: Some(sd), ci95 }]
        }
        None => {
            [response.K(), response.T(), response.rudder_bias].map(|value| Quantity { value, sd: None, ci95: None })
        }
    }
}

pub(super) fn randomness(problem: &Problem, model: &Model) -> Randomness {
    let fit = &model.judged;
    let white = (fit.rss / problem.observations() as f64).sqrt();
    Randomness {
        white,
        moment: fit.colour.moment.map(|(kind, _)| kind),
        wander: fit.colour.moment.map_or(0.0, |(_, level)| level.sqrt() * white),
        waves: fit.colour.waves.map(|waves| NarrowBand { sd: waves.sd * white, ..waves }),
    }
}
