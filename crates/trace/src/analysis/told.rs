//! Which fit of a model is told, replayed and held against other records: that of the likelihood where its noise model
//! holds, otherwise the one that is nearest to the records.
//!
//! Under the noise that is there, the likelihood has the smallest errors and intervals that hold (Åström and Källström
//! 1976). Where the noise model is itself no description of what is left, its optimum looks after the next heading
//! only, and a replay of minutes is better served by the parameters that minimise the replay error, with errors that
//! ask nothing of the noise (Ljung 1999, section 8.5).

use ship::FirstOrder;
use trial::Trial;

use super::replays::{add_bands, on_records};
use super::result::OnRecord;
use super::settings::TraceError;
use super::side::Side;
use crate::fit::{Fit, Problem};
use crate::innovations::Innovations;
use crate::search::Model;
use crate::structure::Structure;

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
    /// Whether there is one and the noise model holds: the fit is then that of the likelihood under it.
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
        let random = model.judged.colour.moment.is_some();
        let sides = [start, model].map(|model| Side::new(problem, model, &model.plain));
        let mut told = Self { sides, before, after, random, noise_holds: false };
        if random && Innovations::of(problem, &model.judged).agree() {
            let likelihood = Side::new(problem, model, &model.judged);
            let replay = |side: &Side, thorough| {
                let response = side.is_first_order().then(|| side.first_order());
                on_records(trials, (&side.structure, &side.fit), first, response.as_ref(), thorough)
            };
            let on = replay(&likelihood, thorough)?;
            if likelihood.structure.terms.is_empty() {
                (told.sides[0], told.before) = (likelihood.clone(), on.clone());
                told.noise_holds = true;
            } else {
                let windows = |side: &Side| replay(side, true).map(|on| restarted(&on));
                told.noise_holds = windows(&likelihood)? <= windows(&told.sides[0])?;
            }
            if told.noise_holds {
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
        let white = self.sides[1].fit.colour.is_white();
        !self.noise_holds && (self.random || (white && lag1.abs() > COLOURED))
    }
}

/// Mean square error of replays that are restarted every 20 s, rad²; 0 where the windows hold too few headings.
fn restarted(on: &[OnRecord]) -> f64 {
    let rows: usize = on.iter().map(|on| on.errors.rows).sum();
    let square = |on: &OnRecord| on.errors.horizon[0].map_or(0.0, |error| error.powi(2) * on.errors.rows as f64);
    on.iter().map(square).sum::<f64>() / rows as f64
}
