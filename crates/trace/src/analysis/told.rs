//! Which fit of a model is told and replayed: that of the likelihood where its noise model holds, otherwise the one
//! that is nearest to the records.
//!
//! Under the noise that is there, the likelihood has the smallest errors and intervals that hold (Åström and Källström
//! 1976). Where the noise model is itself no description of what is left, its optimum looks after the next heading
//! only, and a replay of minutes is better served by the parameters that minimise the replay error, with errors that
//! ask nothing of the noise (Ljung 1999, section 8.5).

use crate::fit::{Fit, Problem};
use crate::innovations::Innovations;
use crate::search::Model;

/// Autocorrelation above which a residual is called coloured.
const COLOURED: f64 = 0.2;

/// The fit that is told.
#[derive(Debug, Clone)]
pub struct Told {
    /// Parameters and initial states.
    pub fit: Fit,
    /// Innovations of the fit under the noise that suits the model best.
    pub innovations: Innovations,
    /// Whether what is left needs a random moment.
    pub random: bool,
    /// Whether there is a random moment and the noise model holds, so that the fit is that of the likelihood under it.
    pub noise_holds: bool,
}

impl Told {
    /// Chooses between the two fits of a model.
    pub fn new(problem: &Problem, model: &Model) -> Self {
        let innovations = Innovations::of(problem, &model.judged);
        let random = model.judged.colour.moment.is_some();
        let noise_holds = random && innovations.agree();
        let fit = if noise_holds { &model.judged } else { &model.plain };
        Self { fit: fit.clone(), innovations, random, noise_holds }
    }

    /// Whether the noise has a colour that the fit does not know, when the residual has this autocorrelation.
    pub fn is_coloured(&self, lag1: f64) -> bool {
        !self.noise_holds && (self.random || (self.fit.colour.is_white() && lag1.abs() > COLOURED))
    }
}
