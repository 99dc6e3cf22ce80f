//! A model as it is told: structure, fit and noise.

use ship::FirstOrder;

use crate::band::Noise;
use crate::fit::{Fit, Problem};
use crate::search::Model;
use crate::structure::Structure;

/// A model as it is told: before or after what is missing was added.
#[derive(Debug, Clone)]
pub(super) struct Side {
    /// Structure.
    pub structure: Structure,
    /// Parameters and initial states.
    pub fit: Fit,
    /// The noise of the records as the model sees it.
    pub noise: Noise,
}

impl Side {
    /// The fit of a model that is nearest to the records, in the noise that suits the model best.
    pub fn nearest(problem: &Problem, model: &Model) -> Self {
        let noise = Noise::of(problem, &model.structure, &model.judged);
        Self { structure: model.structure.clone(), fit: model.plain.clone(), noise }
    }

    /// The first-order response of the parameters: their base, with the mean of several rudder biases.
    pub fn first_order(&self) -> FirstOrder {
        let theta = &self.fit.theta;
        let biases = &theta[2..self.structure.base_count()];
        let rudder_bias = biases.iter().sum::<f64>() / biases.len() as f64;
        FirstOrder { inverse_T: theta[0], K_over_T: theta[1], rudder_bias }
    }
}
