//! What a trace said, and whether it is right.

use document::trace::{Dependence, EffectEntry, LocatedEntry};
use ship::angle::from_deg;
use trace::{Analysis, Verdict};

use super::records::ROWS;
use super::truths::{Kind, Times};

/// How far, s, the time of an effect or of a located moment may be from a change to be right.
pub const NEAR: f64 = 20.0;

/// By which share a located period may miss those of the truth.
pub const NEAR_PERIOD: f64 = 0.15;

/// Effects that are a matter of time and not of the ship.
const OF_TIME: [&str; 2] = ["moment_drift", "transient_disturbance"];

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
    /// Moments that are no effects of the list, the clearest first.
    pub located: Vec<LocatedEntry>,
    /// The random moment beside them as a rudder angle, deg.
    pub disturbance_deg: Option<f64>,
    /// Root mean square heading error of the nearest first-order response and of the final model, rad.
    pub heading: [f64; 2],
}

/// What that is, the truth being known.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Judgement {
    /// The right group was named, and no other.
    Right,
    /// What was named is not right, but the trace says that it cannot tell it from what is, or it counts as such.
    Alias,
    /// Something else was named, or anything said to be missing where nothing is.
    Wrong,
    /// A moment with the right dependence was located, at the right time where there is one; or nothing but effects of
    /// time was named, all near a change.
    Located,
    /// A moment was located, or an effect of time named, that is not right.
    Elsewhere,
    /// Called unexplained, and nothing named or located.
    Unexplained,
    /// Nothing but a random moment.
    Disturbed,
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
            Self::Disturbed => "disturbed",
            Self::Clean => "clean",
            Self::Failed => "failed",
        }
    }

    /// Whether that is right to say of a truth.
    pub fn is_right(self, kind: &Kind) -> bool {
        match kind {
            Kind::Listed { .. } => self == Self::Right,
            Kind::Unlisted { .. } => matches!(self, Self::Located | Self::Unexplained),
            Kind::Nothing { disturbed } => self == Self::Clean || (*disturbed && self == Self::Disturbed),
        }
    }
}

impl Answer {
    /// What an analysis says.
    pub fn of(analysis: &Analysis) -> Self {
        let document = &analysis.document;
        let base = &analysis.base.diagnostics;
        let (_, nearest) = base.iter().find(|(name, _)| *name == "heading_rmse_deg").expect("output error reports it");
        let errors = || analysis.identification.iter().map(|record| &record.after.errors);
        let square: f64 = errors().map(|errors| errors.rows as f64 * errors.heading.powi(2)).sum();
        let rows: usize = errors().map(|errors| errors.rows).sum();
        Self {
            verdict: document.verdict,
            named: document.effects.iter().map(Named::of).collect(),
            located: document.located.clone(),
            disturbance_deg: document.disturbance.map(|disturbance| disturbance.rudder_deg),
            heading: [from_deg(*nearest), (square / rows as f64).sqrt()],
        }
    }

    /// What that is.
    pub fn judged(&self, kind: &Kind) -> Judgement {
        if self.named.is_empty() && self.located.is_empty() {
            return match (self.verdict, self.disturbance_deg) {
                (Verdict::Unexplained, _) => Judgement::Unexplained,
                (_, Some(_)) => Judgement::Disturbed,
                (_, None) => Judgement::Clean,
            };
        }
        match kind {
            Kind::Nothing { .. } => Judgement::Wrong,
            Kind::Listed { right, alias } => self.judged_by_names(right, alias),
            Kind::Unlisted { depends_on, times } => self.judged_by_shapes(*depends_on, times),
        }
    }

    /// What that is where identifiers are right, or count as an alias.
    fn judged_by_names(&self, right: &[&str], alias: &[&str]) -> Judgement {
        let is_right = |id: &str| right.contains(&id);
        let is_alias =
            |named: &Named| alias.contains(&named.id.as_str()) || named.aliases.iter().any(|id| is_right(id));
        if self.named.is_empty() {
            let mut others = self.located.iter().flat_map(|entry| &entry.alternatives);
            let is_alternative = others.any(|words| words.split_once(" (").is_some_and(|(id, _)| is_right(id)));
            return if is_alternative { Judgement::Alias } else { Judgement::Elsewhere };
        }
        if self.named.iter().all(|named| is_right(&named.id)) {
            Judgement::Right
        } else if self.named.iter().all(|named| is_right(&named.id) || is_alias(named)) {
            Judgement::Alias
        } else {
            Judgement::Wrong
        }
    }

    /// What that is where a dependence and times are right.
    fn judged_by_shapes(&self, depends_on: Dependence, times: &Times) -> Judgement {
        let of_ship: Vec<&Named> = self.named.iter().filter(|named| !named.is_of_time()).collect();
        let has_alias = |named: &&Named| named.aliases.iter().any(|id| OF_TIME.contains(&id.as_str()));
        let (mut located, mut named) = (self.located.iter(), self.named.iter());
        let is_placed = match self.located.is_empty() {
            true => named.all(|named| named.is_near(times)),
            false => located.any(|entry| is_right(entry, depends_on, times)),
        };
        match (of_ship.is_empty(), is_placed) {
            (false, _) if of_ship.iter().all(has_alias) => Judgement::Alias,
            (false, _) => Judgement::Wrong,
            (true, true) => Judgement::Located,
            (true, false) => Judgement::Elsewhere,
        }
    }

    /// Whether it says more than what is right: a located moment beside names of the list, or a moment or an effect of
    /// time that is not right.
    pub fn says_more(&self, kind: &Kind) -> bool {
        match kind {
            Kind::Listed { .. } => !self.named.is_empty() && !self.located.is_empty(),
            Kind::Unlisted { depends_on, times } => {
                self.located.iter().any(|entry| !is_right(entry, *depends_on, times))
                    || self.named.iter().any(|named| !named.is_near(times))
            }
            Kind::Nothing { .. } => false,
        }
    }
}

/// Whether a located moment has the right dependence and times.
fn is_right(entry: &LocatedEntry, depends_on: Dependence, times: &Times) -> bool {
    let is_at = match times {
        Times::Always => true,
        Times::Instants(changes) => {
            // What stays until the end of the record has no end, and so no middle.
            let until = entry.until_s.filter(|until| *until < (ROWS - 1) as f64);
            let middle = entry.from_s.zip(until).map(|(from, until)| 0.5 * (from + until));
            let mut instants = [entry.from_s, until, middle].into_iter().flatten();
            instants.any(|instant| changes.iter().any(|change| (change - instant).abs() <= NEAR))
        }
        Times::Periods([from, to]) => {
            let is_of_truth = |period: f64| (from * (1.0 - NEAR_PERIOD)..=to * (1.0 + NEAR_PERIOD)).contains(&period);
            let most = if entry.form.contains("harmonics") { 3 } else { 1 };
            let periods: Vec<f64> = entry.form.split(' ').filter_map(|word| word.parse().ok()).collect();
            let is_near = |period: &f64| (1..=most).any(|harmonic| is_of_truth(period / f64::from(harmonic)));
            entry.form.contains("period") && periods.iter().all(is_near)
        }
    };
    entry.depends_on == depends_on && is_at
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

    fn is_of_time(&self) -> bool {
        OF_TIME.contains(&self.id.as_str())
    }

    /// Whether it is an effect of time near a change.
    fn is_near(&self, times: &Times) -> bool {
        let Times::Instants(changes) = times else { return false };
        let near = |time: f64| changes.iter().any(|change| (change - time).abs() <= NEAR);
        self.is_of_time() && self.time.is_some_and(near)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn named(id: &str, aliases: &[&str], time: Option<f64>) -> Named {
        let aliases = aliases.iter().map(|&id| id.into()).collect();
        Named { id: id.into(), form: String::new(), aliases, time }
    }

    fn located(depends_on: Dependence, form: &str, span: Option<[f64; 2]>) -> LocatedEntry {
        LocatedEntry {
            depends_on,
            form: form.into(),
            only: None,
            from_s: span.map(|[from, _]| from),
            until_s: span.map(|[_, until]| until),
            nats: 10.0,
            rudder_deg: 1.0,
            alternatives: vec!["speed_loss (modelled speed)".into()],
            formula: None,
        }
    }

    fn answer(verdict: Verdict, named: &[Named], located: &[LocatedEntry]) -> Answer {
        let (named, located) = (named.to_vec(), located.to_vec());
        Answer { verdict, named, located, disturbance_deg: None, heading: [1.0, 1.0] }
    }

    #[test]
    fn another_formula_is_judged_by_its_group() {
        let kind = Kind::Listed { right: &["speed_loss"], alias: &["nonlinear_damping"] };
        let judged = |all: &[Named]| answer(Verdict::Traced, all, &[]).judged(&kind);
        let right = named("speed_loss", &[], None);
        assert_eq!(judged(std::slice::from_ref(&right)), Judgement::Right);
        assert_eq!(judged(&[named("nonlinear_damping", &[], None)]), Judgement::Alias);
        assert_eq!(judged(&[right.clone(), named("second_order", &["speed_loss"], None)]), Judgement::Alias);
        assert_eq!(judged(&[right.clone(), named("second_order", &[], None)]), Judgement::Wrong);
        let silent = |verdict| answer(verdict, &[], &[]);
        assert_eq!(silent(Verdict::Clean).judged(&kind), Judgement::Clean);
        assert_eq!(silent(Verdict::Unexplained).judged(&kind), Judgement::Unexplained);
        let disturbed = Answer { disturbance_deg: Some(0.3), ..silent(Verdict::Disturbed) };
        assert_eq!(disturbed.judged(&kind), Judgement::Disturbed);
        let shape = located(Dependence::YawRate, "moment with r²", None);
        let beside = answer(Verdict::Located, &[right], std::slice::from_ref(&shape));
        assert_eq!((beside.judged(&kind), beside.says_more(&kind)), (Judgement::Right, true));
        let instead = answer(Verdict::Located, &[], &[shape]);
        assert_eq!(instead.judged(&kind), Judgement::Alias);
        assert_eq!(instead.judged(&Kind::Listed { right: &["wind_moment"], alias: &[] }), Judgement::Elsewhere);
    }

    #[test]
    fn what_changes_is_located_by_an_instant_near_it() {
        let kind = Kind::Unlisted { depends_on: Dependence::Time, times: Times::Instants(&[100.0, 200.0]) };
        let squall = |time| named("transient_disturbance", &[], Some(time));
        let drift = named("moment_drift", &[], None);
        let judged = |verdict, all: &[Named]| answer(verdict, all, &[]).judged(&kind);
        assert_eq!(judged(Verdict::Traced, &[squall(119.0), squall(181.0)]), Judgement::Located);
        assert_eq!(judged(Verdict::Traced, &[squall(119.0), squall(150.0)]), Judgement::Elsewhere);
        assert_eq!(judged(Verdict::Traced, &[drift]), Judgement::Elsewhere);
        assert_eq!(judged(Verdict::Unexplained, &[]), Judgement::Unexplained);
        assert_eq!(judged(Verdict::Unexplained, &[named("second_order", &[], None)]), Judgement::Wrong);
        let group = named("wind_moment", &["transient_disturbance"], None);
        assert_eq!(judged(Verdict::Traced, std::slice::from_ref(&group)), Judgement::Alias);
        assert_eq!(judged(Verdict::Traced, &[group, named("second_order", &[], None)]), Judgement::Wrong);
        let shaped = |named: &[Named], all: &[LocatedEntry]| answer(Verdict::Located, named, all).judged(&kind);
        let from = |from, until| located(Dependence::Time, "moment", Some([from, until]));
        assert_eq!(shaped(&[], &[from(110.0, 299.0)]), Judgement::Located);
        assert_eq!(shaped(&[], &[from(60.0, 130.0)]), Judgement::Located);
        assert_eq!(shaped(&[], &[from(60.0, 250.0)]), Judgement::Elsewhere);
        // A moment that stays has no middle.
        assert_eq!(shaped(&[], &[from(140.0, 299.0)]), Judgement::Elsewhere);
        assert_eq!(shaped(&[], &[located(Dependence::Way, "moment with y", None)]), Judgement::Elsewhere);
        assert_eq!(shaped(&[named("second_order", &[], None)], &[from(110.0, 299.0)]), Judgement::Wrong);
        assert!(answer(Verdict::Located, &[], &[from(110.0, 299.0), from(20.0, 40.0)]).says_more(&kind));
    }

    #[test]
    fn a_dependence_or_a_period_is_enough_where_nothing_changes() {
        let judged = |form: &str, depends_on, times| {
            let kind = Kind::Unlisted { depends_on: Dependence::Time, times };
            answer(Verdict::Located, &[], &[located(depends_on, form, None)]).judged(&kind)
        };
        let of_time = |form: &str| judged(form, Dependence::Time, Times::Periods([90.0, 90.0]));
        assert_eq!(of_time("moment with a period of 100 s"), Judgement::Located);
        assert_eq!(of_time("moment with a period of 45 s"), Judgement::Elsewhere);
        assert_eq!(of_time("moment with a period of 180 s and its harmonics"), Judgement::Located);
        assert_eq!(of_time("moment whose period runs from 80 s to 100 s"), Judgement::Located);
        assert_eq!(of_time("moment whose period runs from 90 s to 30 s"), Judgement::Elsewhere);
        assert_eq!(of_time("moment that grows with time"), Judgement::Elsewhere);
        assert_eq!(judged("moment with y²", Dependence::Way, Times::Always), Judgement::Elsewhere);
        assert_eq!(judged("anything", Dependence::Time, Times::Always), Judgement::Located);
    }

    #[test]
    fn anything_is_wrong_where_nothing_is_missing() {
        let kind = Kind::Nothing { disturbed: true };
        let shape = located(Dependence::Way, "moment with y", None);
        assert_eq!(answer(Verdict::Located, &[], &[shape]).judged(&kind), Judgement::Wrong);
        let drift = named("moment_drift", &[], None);
        assert_eq!(answer(Verdict::Traced, &[drift], &[]).judged(&kind), Judgement::Wrong);
        assert_eq!(answer(Verdict::Clean, &[], &[]).judged(&kind), Judgement::Clean);
        assert!(Judgement::Disturbed.is_right(&kind));
        assert!(!Judgement::Disturbed.is_right(&Kind::Nothing { disturbed: false }));
    }
}
