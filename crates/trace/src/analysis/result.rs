//! What an analysis says.

use identify::Estimate;
use identify::replay::Replay;
use ship::Particulars;
use ship::effects::Parameter;
use ship::narrow_band::NarrowBand;
use trial::Quantity;

use super::side::Side;
use super::steps::Step;
use crate::candidates::Candidate;
use crate::diagnostics::{Signature, Whiteness};
use crate::fit::{Fit, Problem};
use crate::noise::Wander;
use crate::replay_errors::Errors;
use crate::search::{Evidence, Model, Thresholds, Tried, Weights};
use crate::structure::Structure;

/// What the analysis says.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Verdict {
    /// Nothing is missing.
    Clean,
    /// What is missing has a name, and what is left is noise.
    Traced,
    /// Structure is left that no candidate carries.
    Unexplained,
}

impl Verdict {
    /// All verdicts.
    pub const ALL: [Self; 3] = [Self::Clean, Self::Traced, Self::Unexplained];

    /// The word used in files.
    pub fn as_str(self) -> &'static str {
        match self {
            Self::Clean => "clean",
            Self::Traced => "traced",
            Self::Unexplained => "unexplained",
        }
    }
}

/// What became of a candidate.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Outcome {
    /// It is part of the model.
    Added,
    /// The records cannot tell it from one that is.
    Alias,
    /// The records speak against it, or do not need it.
    Rejected,
    /// The records could not show it.
    NotObservable,
}

impl Outcome {
    /// The word used in files.
    pub fn as_str(self) -> &'static str {
        match self {
            Self::Added => "added",
            Self::Alias => "alias",
            Self::Rejected => "rejected",
            Self::NotObservable => "not_observable",
        }
    }
}

/// A parameter of the final model.
#[derive(Debug, Clone, PartialEq)]
pub struct Fitted {
    /// What it is called and measured in.
    pub parameter: &'static Parameter,
    /// Its value and error: no standard deviation where it is not determined or was not fitted; the interval is
    /// Fieller's for δ_r, which is the ratio of two parameters, otherwise that of a normal error.
    pub quantity: Quantity,
    /// Name of the one record it belongs to.
    pub only: Option<String>,
    /// Whether it ends at an end of its range: the search stopped there, not at the best value.
    pub at_bound: bool,
}

impl Fitted {
    /// A parameter of all records whose error is not known.
    pub(super) fn bare(parameter: &'static Parameter, value: f64) -> Self {
        Self { parameter, quantity: Quantity::bare(value), only: None, at_bound: false }
    }

    /// The same without dimension, for a ship of these particulars.
    pub fn prime(&self, particulars: Particulars) -> Quantity {
        self.quantity.scaled(particulars.prime(self.parameter.dimension()))
    }
}

/// An effect that was found.
#[derive(Debug, Clone, PartialEq)]
pub struct Traced {
    /// Identifier.
    pub id: &'static str,
    /// Form.
    pub form: &'static str,
    /// Equation.
    pub equation: &'static str,
    /// Name of the one record in which it acts.
    pub only: Option<String>,
    /// Effects that these records cannot tell from it: identifier and form.
    pub aliases: Vec<(&'static str, &'static str)>,
    /// Its parameters.
    pub parameters: Vec<Fitted>,
    /// Whether it is in the model on request, whatever its evidence.
    pub asked: bool,
    /// Probability that the effect is present where this term acts, in any form, from the fitted records alone.
    pub probability: f64,
    /// How much it explains, against the best model without it.
    pub evidence: Evidence,
    /// Share of the mean square of the residual of the base that it took away when it was added; `None` for waves,
    /// which are part of the residual.
    pub residual_share: Option<f64>,
    /// One sentence on it.
    pub sentence: String,
}

/// A candidate and what became of it.
#[derive(Debug, Clone, PartialEq)]
pub struct Considered {
    /// Identifier.
    pub id: &'static str,
    /// Form.
    pub form: &'static str,
    /// Name of the one record in which it would act.
    pub only: Option<String>,
    /// Probability that it is present in this form, from the fitted records alone.
    pub probability: f64,
    /// What became of it.
    pub outcome: Outcome,
    /// Evidence on top of the final model (for an added one: of its removal). `None` when the records lack its channel.
    pub evidence: Option<Evidence>,
    /// Gain in BIC when it is added to the base alone, under white noise.
    pub gain_alone: Option<f64>,
    /// Gain in BIC it needs to be believed.
    pub needed: f64,
    /// Expected gain in −2 log L if it were as large as it can be expected.
    pub visibility: Option<f64>,
    /// Why, in words, where a number does not say it.
    pub reason: Option<&'static str>,
}

/// A term without a name that carries what no named effect does.
#[derive(Debug, Clone, PartialEq)]
pub struct Empirical {
    /// The best, and those that these records cannot tell from it.
    pub group: Vec<&'static str>,
    /// Equation of the best.
    pub equation: &'static str,
    /// Its parameters, SI and rad.
    pub parameters: Vec<Fitted>,
    /// Its evidence.
    pub evidence: Evidence,
    /// Root mean square heading error with it, rad.
    pub error: f64,
}

/// The candidate that is nearest to being believed, and how much more record would decide.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RunnerUp {
    /// Identifier.
    pub id: &'static str,
    /// Form.
    pub form: &'static str,
    /// How many times as much of the same record would make it gain what it needs, if it is there: its likelihood ratio
    /// grows with the length, the price of its parameters with the logarithm of it.
    pub times: f64,
}

/// Random part of the records, as the final model sees it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Randomness {
    /// Standard deviation of white heading noise, rad.
    pub white: f64,
    /// What wanders beside it, where something does.
    pub wander: Option<Wander>,
    /// Standard deviation of the heading that this leaves, rad: of a random moment that at the end of the longest
    /// record of a ship without damping.
    pub heading: f64,
    /// A random moment as an angle of the rudder, rad: the standard deviation of gusts, of the mean of a white moment
    /// over one second, of what a walk adds in one second. 0 without one.
    pub rudder: f64,
    /// Correlation time of gusts, or of an error of the compass, s.
    pub correlation: Option<f64>,
    /// Whether this noise is a description of what is left: its innovations are white, of one variance, and without a
    /// surprise.
    pub holds: bool,
    /// What came nearest to being believed beside a random moment.
    pub runner_up: Option<RunnerUp>,
    /// Waves; `sd` in rad.
    pub waves: Option<NarrowBand>,
}

/// A model on one record.
#[derive(Debug, Clone, PartialEq)]
pub struct OnRecord {
    /// Replay.
    pub replay: Replay,
    /// Errors.
    pub errors: Errors,
    /// Half the width of the 95 % band of a reading at every row of the replay, rad; `None` where it was not asked for
    /// and where the records do not tell the parameters apart.
    pub band: Option<Vec<f64>>,
}

impl OnRecord {
    /// Share of the measured headings that lie inside the band.
    pub fn coverage(&self) -> Option<f64> {
        let pairs = self.replay.residual.iter().zip(self.band.as_ref()?).filter(|(residual, _)| residual.is_finite());
        let (inside, rows) = pairs.fold((0usize, 0usize), |(inside, rows), (residual, half)| {
            (inside + usize::from(residual.abs() <= *half), rows + 1)
        });
        (rows > 0).then(|| inside as f64 / rows as f64)
    }
}

/// One record with the models before and after.
#[derive(Debug, Clone)]
pub struct Judged {
    /// Name.
    pub name: String,
    /// Base model.
    pub before: OnRecord,
    /// Final model.
    pub after: OnRecord,
    /// Final model with a moment of the record's own, where it was not fitted and the fitted records have such moments.
    pub own_moment: Option<OnRecord>,
}

/// The result.
pub struct Analysis {
    /// The base of constant K and T, fitted alone: no first-order response is nearer to the records.
    pub base: Estimate,
    /// Base indices K (1/s) and T (s) of the final model.
    pub indices: [Quantity; 2],
    /// Rudder bias δ_r (rad) of the ship; `None` when several records have one each, which are among the parameters.
    pub rudder_bias: Option<Quantity>,
    /// All parameters of the final model.
    pub parameters: Vec<Fitted>,
    /// The verdict.
    pub verdict: Verdict,
    /// What was found, in the order of discovery.
    pub effects: Vec<Traced>,
    /// The way from the base to the final model, term by term.
    pub steps: Vec<Step>,
    /// All candidates.
    pub candidates: Vec<Considered>,
    /// All structures that were tried, with their probabilities from the fitted records alone.
    pub weights: Weights,
    /// What is left, where structure is.
    pub unexplained: Option<Signature>,
    /// A proposal for it.
    pub empirical: Option<Empirical>,
    /// Random part.
    pub randomness: Randomness,
    /// Records that were fitted.
    pub identification: Vec<Judged>,
    /// Records that were not.
    pub validation: Vec<Judged>,
    /// Each of several records as if it had been held out, where none was: parameters are those of the other records,
    /// the structure is that of all. `None` where the others have no base or no finite replay.
    pub left_out: Vec<Option<Judged>>,
    /// Whiteness of the residual before and after.
    pub whiteness: [Whiteness; 2],
    /// Terms that explained the records but made an error larger, there or elsewhere: a sentence each that says so.
    pub refused: Vec<String>,
    /// Times, s, of the headings that belong to no ship and were left out, of every record, the held-out ones last.
    pub outliers: Vec<Vec<f64>>,
    /// The thresholds it was judged by.
    pub thresholds: Thresholds,
    pub(super) problem: Problem,
    /// The base of constant K and T.
    pub(super) constant: Model,
    /// The base that the search began from.
    pub(super) start: Model,
    /// All candidates on the base, lowest BIC first.
    pub(super) tried: Vec<Tried>,
    pub(super) candidate_terms: Vec<Candidate>,
    pub(super) model: Model,
    /// The final model as it is told.
    pub(super) told: Side,
    /// Structures that cannot be told apart with their weights and fits.
    pub(super) rivals: Vec<(f64, Structure, Fit)>,
    /// Whether the noise has a colour that the fit does not know.
    pub(super) coloured: bool,
}

impl Analysis {
    /// The speed, m/s, of which K and T of the final model are told, where K ~ U and T ~ 1/U with the measured speed
    /// explain the records better than constant ones, and the fall of BIC.
    pub fn speed_scaling(&self) -> Option<(f64, f64)> {
        let scaling = self.start.structure.scaling.as_ref()?;
        Some((scaling.approach_speed, self.constant.judged.bic - self.start.judged.bic))
    }

    /// Whether K, T and δ_r of the final model rest on a parameter at an end of its range: K = (K/T)/(1/T), T =
    /// 1/(1/T).
    pub fn indices_at_bound(&self) -> [bool; 3] {
        let ends = |key: &str| self.parameters.iter().any(|fitted| fitted.parameter.key == key && fitted.at_bound);
        let [inverse, ratio] = ["inverse_T", "K_over_T"].map(ends);
        [inverse || ratio, inverse, self.rudder_bias.is_some() && ends("rudder_bias")]
    }
}

/// Gain in BIC below which two rivals cannot be told apart.
pub(super) const ALIAS: f64 = 10.0;
