//! Which fit of a model is told, replayed and held against other records: that of the likelihood where its noise
//! model holds, otherwise the one that is nearest to the records. Where effects were found the replay of the likelihood
//! has to be as near, too: it is what they are shown by.
//!
//! Under the noise that is there, the likelihood has the smallest errors and intervals that hold (Åström and Källström
//! 1976). Where the noise model is itself no description of what is left, its optimum looks after the next heading
//! only, and a replay of minutes is better served by the parameters that minimise the replay error, with errors that
//! ask nothing of the noise (Ljung 1999, section 8.5).

use ship::FirstOrder;
use trial::Trial;

use super::fitted::heading_error;
use super::replays::{add_bands, on_records};
use super::result::OnRecord;
use super::settings::TraceError;
use super::side::Side;
use crate::fit::{Fit, Problem};
use crate::innovations::Innovations;
use crate::search::Model;
use crate::structure::Structure;

/// Share of the smallest heading error up to which a replay of a model with effects counts as near to the records.
const AS_NEAR: f64 = 1.05;

/// Autocorrelation above which a residual is called coloured.
const COLOURED: f64 = 0.2;

/// Models before and after with their replays of the fitted records.
pub(super) struct Told {
    /// Before and after.
    pub sides: [Side; 2],
    /// Replays of the base.
    pub before: Vec<OnRecord>,
    /// Replays of the final model.
    pub after: Vec<OnRecord>,
    /// Whether what is left needs a random moment.
    pub random: bool,
    /// Whether there is one and the noise model holds.
    pub noise_holds: bool,
}

impl Told {
    /// Takes the base and the final model with the replays of the fits that are nearest to the records. The base stays
    /// the nearest one as long as it lacks something, so that no first-order response makes "before" smaller.
    pub fn new(
        trials: &[Trial],
        problem: &Problem,
        [start, model]: [&Model; 2],
        first: &FirstOrder,
        [before, after]: [Vec<OnRecord>; 2],
        thorough: bool,
    ) -> Result<Self, TraceError> {
        let random = model.judged.colour.wander.is_some();
        let sides = [start, model].map(|model| Side::nearest(problem, model));
        let mut told = Self { sides, before, after, random, noise_holds: false };
        if random && Innovations::of(problem, &model.judged).agree() {
            let likelihood = Side { fit: model.judged.clone(), ..told.sides[1].clone() };
            let response = likelihood.structure.is_first_order().then(|| likelihood.first_order());
            let (structure, fit) = (&likelihood.structure, &likelihood.fit);
            let on = on_records(trials, (structure, fit), first, response.as_ref(), thorough)?;
            let mut is_told = true;
            told.noise_holds = true;
            if likelihood.structure.is_constant() {
                (told.sides[0], told.before) = (likelihood.clone(), on.clone());
            } else {
                is_told = heading_error(&on) <= AS_NEAR * heading_error(&told.after);
            }
            if is_told {
                (told.sides[1], told.after) = (likelihood, on);
            }
        }
        add_bands(problem, &told.sides[1], &mut told.after);
        if thorough {
            add_bands(problem, &told.sides[0], &mut told.before);
        }
        Ok(told)
    }

    /// Structure and fit of the final model.
    pub fn fitted(&self) -> (&Structure, &Fit) {
        (&self.sides[1].structure, &self.sides[1].fit)
    }

    /// Whether the noise has a colour that the fit does not know, when the residual has this autocorrelation.
    pub fn is_coloured(&self, lag1: f64) -> bool {
        let colour = &self.sides[1].fit.colour;
        colour.wander.is_none() && (self.random || (colour.is_white() && lag1.abs() > COLOURED))
    }
}
