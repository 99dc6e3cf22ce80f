//! What a trace said, and whether it is right.

use ship::angle::from_deg;
use trace::document::{EffectEntry, RecordNoiseEntry};
use trace::{Analysis, Verdict};

use super::truths::Kind;

/// How far, s, the time of an effect may be from a change to have located it.
pub const NEAR: f64 = 20.0;

/// Effects that are a matter of time and not of the ship.
const OF_TIME: [&str; 2] = ["moment_drift", "transient_disturbance"];

/// A term without a name.
const NAMELESS: &str = "empirical";

/// An effect that was named.
#[derive(Debug, Clone, PartialEq)]
pub struct Named {
    /// Identifier.
    pub id: String,
    /// Form.
    pub form: String,
    /// Other identifiers that the records cannot tell from it, each once.
    pub aliases: Vec<String>,
    /// When it acts, s: the middle of a passing moment, the beginning of a lasting one.
    pub time: Option<f64>,
}

/// What a trace said.
#[derive(Debug, Clone, PartialEq)]
pub struct Answer {
    /// Verdict.
    pub verdict: Verdict,
    /// What was named, the most probable first.
    pub named: Vec<Named>,
    /// Whether a random moment is a description of what is left.
    pub noise: bool,
    /// The shape without a name that was proposed.
    pub shape: Option<String>,
    /// Root mean square heading error of the nearest first-order response and of the final model, rad.
    pub heading: [f64; 2],
}

/// What that is, the truth being known.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Judgement {
    /// The right group was named, and nothing else.
    Right,
    /// What was named is not right, but the trace says that it cannot tell it from what is, or it counts as such.
    Alias,
    /// Something else was named.
    Wrong,
    /// Nothing but effects of time and shapes without a name, all effects of time near a change.
    Located,
    /// Nothing but effects of time, away from any change, and nothing said to be left.
    Elsewhere,
    /// Called unexplained, without an effect of the ship.
    Unexplained,
    /// Nothing named but a random moment.
    Noise,
    /// Called clean.
    Clean,
    /// There is no trace.
    Failed,
}

impl Judgement {
    /// The word used in files.
    pub fn as_str(self) -> &'static str {
        match self {
            Self::Right => "right",
            Self::Alias => "alias",
            Self::Wrong => "wrong",
            Self::Located => "located",
            Self::Elsewhere => "elsewhere",
            Self::Unexplained => "unexplained",
            Self::Noise => "noise",
            Self::Clean => "clean",
            Self::Failed => "failed",
        }
    }
}

impl Answer {
    /// What an analysis says.
    pub fn of(analysis: &Analysis) -> Self {
        let document = &analysis.document;
        let is_random = |noise: &RecordNoiseEntry| noise.moment != "none" && noise.describes_what_is_left;
        let base = &analysis.base.diagnostics;
        let (_, nearest) = base.iter().find(|(name, _)| *name == "heading_rmse_deg").expect("output error reports it");
        let errors = || analysis.identification.iter().map(|record| &record.after.errors);
        let square: f64 = errors().map(|errors| errors.rows as f64 * errors.heading.powi(2)).sum();
        let rows: usize = errors().map(|errors| errors.rows).sum();
        Self {
            verdict: document.verdict,
            named: document.effects.iter().map(Named::of).collect(),
            noise: document.noise.iter().all(is_random),
            shape: document.located.first().map(|shape| shape.form.clone()),
            heading: [from_deg(*nearest), (square / rows as f64).sqrt()],
        }
    }

    /// What that is.
    pub fn judged(&self, kind: &Kind) -> Judgement {
        if self.named.is_empty() {
            return match (self.verdict, self.noise) {
                (Verdict::Unexplained, _) => Judgement::Unexplained,
                (_, true) => Judgement::Noise,
                (_, false) => Judgement::Clean,
            };
        }
        match kind {
            Kind::Nothing => Judgement::Wrong,
            Kind::Listed { right, alias } => {
                let is_right = |named: &Named| right.contains(&named.id.as_str());
                let is_alias = |named: &Named| {
                    alias.contains(&named.id.as_str()) || named.aliases.iter().any(|id| right.contains(&id.as_str()))
                };
                if self.named.iter().all(is_right) {
                    Judgement::Right
                } else if self.named.iter().all(|named| is_right(named) || is_alias(named)) {
                    Judgement::Alias
                } else {
                    Judgement::Wrong
                }
            }
            Kind::Unlisted { changes } => {
                let is_of_ship = |named: &&Named| !OF_TIME.contains(&named.id.as_str()) && named.id != NAMELESS;
                let of_ship: Vec<&Named> = self.named.iter().filter(is_of_ship).collect();
                let is_near = |named: &Named| {
                    let near = |time: f64| changes.iter().any(|change| (change - time).abs() <= NEAR);
                    named.id == NAMELESS || named.time.is_some_and(near)
                };
                let has_alias = |named: &&Named| named.aliases.iter().any(|id| OF_TIME.contains(&id.as_str()));
                if !of_ship.is_empty() {
                    if of_ship.iter().all(has_alias) { Judgement::Alias } else { Judgement::Wrong }
                } else if self.named.iter().all(is_near) {
                    Judgement::Located
                } else if self.verdict == Verdict::Unexplained {
                    Judgement::Unexplained
                } else {
                    Judgement::Elsewhere
                }
            }
        }
    }
}

impl Named {
    fn of(effect: &EffectEntry) -> Self {
        let time = effect.parameters.values().find(|fitted| ["t_c", "t_0"].contains(&fitted.key.as_str()));
        let mut aliases: Vec<String> = effect.aliases.iter().filter(|id| **id != effect.id).cloned().collect();
        aliases.sort_unstable();
        aliases.dedup();
        let time = time.map(|fitted| fitted.quantity.value);
        Self { id: effect.id.clone(), form: effect.form.clone(), aliases, time }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn named(id: &str, aliases: &[&str], time: Option<f64>) -> Named {
        let aliases = aliases.iter().map(|&id| id.into()).collect();
        Named { id: id.into(), form: String::new(), aliases, time }
    }

    fn answer(verdict: Verdict, named: &[Named]) -> Answer {
        Answer { verdict, named: named.to_vec(), noise: false, shape: None, heading: [1.0, 1.0] }
    }

    #[test]
    fn another_formula_is_judged_by_its_group() {
        let kind = Kind::Listed { right: &["speed_loss"], alias: &["nonlinear_damping"] };
        let judged = |all: &[Named]| answer(Verdict::Traced, all).judged(&kind);
        let right = named("speed_loss", &[], None);
        assert_eq!(judged(std::slice::from_ref(&right)), Judgement::Right);
        assert_eq!(judged(&[named("nonlinear_damping", &[], None)]), Judgement::Alias);
        assert_eq!(judged(&[right.clone(), named("second_order", &["speed_loss"], None)]), Judgement::Alias);
        assert_eq!(judged(&[right, named("second_order", &[], None)]), Judgement::Wrong);
        assert_eq!(answer(Verdict::Clean, &[]).judged(&kind), Judgement::Clean);
        assert_eq!(answer(Verdict::Unexplained, &[]).judged(&kind), Judgement::Unexplained);
        assert_eq!(Answer { noise: true, ..answer(Verdict::Clean, &[]) }.judged(&kind), Judgement::Noise);
    }

    #[test]
    fn what_is_on_no_list_may_be_located_or_left_and_not_named() {
        let kind = Kind::Unlisted { changes: &[100.0, 200.0] };
        let squall = |time| named("transient_disturbance", &[], Some(time));
        let drift = named("moment_drift", &[], None);
        let judged = |verdict, all: &[Named]| answer(verdict, all).judged(&kind);
        assert_eq!(judged(Verdict::Traced, &[squall(119.0), squall(181.0)]), Judgement::Located);
        assert_eq!(judged(Verdict::Traced, &[squall(119.0), squall(150.0)]), Judgement::Elsewhere);
        assert_eq!(judged(Verdict::Traced, std::slice::from_ref(&drift)), Judgement::Elsewhere);
        assert_eq!(judged(Verdict::Unexplained, &[drift]), Judgement::Unexplained);
        assert_eq!(judged(Verdict::Traced, &[named("empirical", &[], None)]), Judgement::Located);
        assert_eq!(judged(Verdict::Unexplained, &[named("second_order", &[], None)]), Judgement::Wrong);
        let group = named("wind_moment", &["transient_disturbance"], None);
        assert_eq!(judged(Verdict::Traced, std::slice::from_ref(&group)), Judgement::Alias);
        assert_eq!(judged(Verdict::Traced, &[group, named("second_order", &[], None)]), Judgement::Wrong);
        assert_eq!(judged(Verdict::Clean, &[]), Judgement::Clean);
    }

    #[test]
    fn any_name_is_wrong_where_nothing_is_missing() {
        assert_eq!(
            answer(Verdict::Traced, &[named("moment_drift", &[], None)]).judged(&Kind::Nothing),
            Judgement::Wrong
        );
        assert_eq!(answer(Verdict::Clean, &[]).judged(&Kind::Nothing), Judgement::Clean);
    }
}
