//! Judgement of a trace against the physics stated in a study.

use std::fmt;

use ::trace::TraceVerdict;

use crate::rows::{LocatedMoment, NamedEffect, TraceRow};
use crate::scenario::MissingPhysics;

/// Tolerance of the time of an effect or of a located moment, s.
pub const MAX_TIME_ERROR_S: f64 = 20.0;

/// Relative tolerance of a located period.
pub const MAX_PERIOD_ERROR: f64 = 0.15;

/// Time-dependent effects, which are not properties of the ship.
const TIME_EFFECTS: [&str; 2] = ["moment_drift", "transient_disturbance"];

/// Agreement of the verdict of a trace with the missing physics of the simulated ship.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Judgement {
    /// Only correct effects were named.
    Right,
    /// A moment with the correct dependence was located, at the correct time, if any; or only time-dependent
    /// effects were named, all near a change.
    Located,
    /// Verdict unexplained, without a named effect or located moment.
    Unexplained,
    /// Verdict disturbed: only a random moment.
    Disturbed,
    /// Verdict clean.
    Clean,
    /// Wrong effect or moment that the trace reports as an alias of the correct one.
    Alias,
    /// A wrong moment was located, or a wrong time-dependent effect named.
    WrongMoment,
    /// A wrong effect was named, or any effect although none is missing.
    Wrong,
}

impl Judgement {
    /// All judgements, first those that can be correct.
    pub const ALL: [Self; 8] = [
        Self::Right,
        Self::Located,
        Self::Unexplained,
        Self::Disturbed,
        Self::Clean,
        Self::Alias,
        Self::WrongMoment,
        Self::Wrong,
    ];

    /// Judgement of a trace of a ship with this missing physics.
    pub fn from_trace_row(answer: &TraceRow, physics: &MissingPhysics) -> Self {
        if answer.named_effects.is_empty() && answer.located_moments.is_empty() {
            return match answer.verdict {
                TraceVerdict::Unexplained => Self::Unexplained,
                TraceVerdict::Disturbed => Self::Disturbed,
                _ => Self::Clean,
            };
        }
        match physics {
            MissingPhysics::Nothing { .. } => Self::Wrong,
            MissingPhysics::Listed { effects } => Self::from_names(answer, effects),
            MissingPhysics::Unlisted { .. } => Self::from_moments(answer, physics),
        }
    }

    /// `true` if the judgement is correct for a ship with this missing physics.
    pub fn is_right(self, physics: &MissingPhysics) -> bool {
        match physics {
            MissingPhysics::Listed { .. } => self == Self::Right,
            MissingPhysics::Unlisted { .. } => matches!(self, Self::Located | Self::Unexplained),
            MissingPhysics::Nothing { disturbed } => self == Self::Clean || (*disturbed && self == Self::Disturbed),
        }
    }

    /// Judgement on a ship that lacks listed effects, by the effects named; `right` are those that it lacks.
    fn from_names(answer: &TraceRow, right: &[String]) -> Self {
        let is_right = |id: &str| right.iter().any(|effect| effect == id);
        let is_alias = |effect: &NamedEffect| right.iter().any(|id| effect.includes(id));
        let TraceRow { named_effects: named, located_moments: located, .. } = answer;
        let is_alternative = || located.iter().flat_map(|moment| &moment.alternatives).any(|id| is_right(id));
        match named.is_empty() {
            true if is_alternative() => Self::Alias,
            true => Self::WrongMoment,
            false if named.iter().all(|effect| is_right(&effect.id)) => Self::Right,
            false if named.iter().all(is_alias) => Self::Alias,
            false => Self::Wrong,
        }
    }

    /// Judgement on a ship with a moment on no list, by the dependence of the moment and by its times, if any.
    fn from_moments(answer: &TraceRow, physics: &MissingPhysics) -> Self {
        let mut of_ship = answer.named_effects.iter().filter(|effect| !is_time_effect(&effect.id)).peekable();
        if of_ship.peek().is_some() {
            let is_alias = of_ship.all(|effect| effect.aliases.iter().any(|id| is_time_effect(id)));
            return if is_alias { Self::Alias } else { Self::Wrong };
        }
        let is_placed = match answer.located_moments.is_empty() {
            true => answer.named_effects.iter().all(|effect| effect.time_s.is_some_and(|time| is_near(time, physics))),
            false => answer.located_moments.iter().any(|moment| agrees_with(moment, physics)),
        };
        if is_placed { Self::Located } else { Self::WrongMoment }
    }
}

impl fmt::Display for Judgement {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Right => "named right",
            Self::Located => "located right",
            Self::Unexplained => "unexplained",
            Self::Disturbed => "disturbed",
            Self::Clean => "clean",
            Self::Alias => "alias",
            Self::WrongMoment => "located elsewhere",
            Self::Wrong => "wrong",
        })
    }
}

fn is_time_effect(id: &str) -> bool {
    TIME_EFFECTS.contains(&id)
}

/// `true` if a time, s, is within the tolerance of a change.
fn is_near(time: f64, physics: &MissingPhysics) -> bool {
    let MissingPhysics::Unlisted { changes_s, .. } = physics else { return false };
    changes_s.iter().any(|change| (change - time).abs() <= MAX_TIME_ERROR_S)
}

/// `true` if a located moment has the dependence and the times of the missing physics.
fn agrees_with(moment: &LocatedMoment, physics: &MissingPhysics) -> bool {
    let MissingPhysics::Unlisted { depends_on, changes_s, period_s } = physics else { return false };
    let is_timed = match period_s {
        Some([from, to]) => {
            let is_of_ship =
                |period: f64| (from * (1.0 - MAX_PERIOD_ERROR)..=to * (1.0 + MAX_PERIOD_ERROR)).contains(&period);
            let harmonics = if moment.form.contains("harmonics") { 3 } else { 1 };
            let mut periods = moment.form.split(' ').filter_map(|word| word.parse::<f64>().ok());
            let is_near = |period: f64| (1..=harmonics).any(|harmonic| is_of_ship(period / f64::from(harmonic)));
            moment.form.contains("period") && periods.all(is_near)
        }
        None if changes_s.is_empty() => true,
        None => {
            let middle = moment.from_s.zip(moment.until_s).map(|(from, until)| 0.5 * (from + until));
            [moment.from_s, moment.until_s, middle].into_iter().flatten().any(|time| is_near(time, physics))
        }
    };
    moment.depends_on == *depends_on && is_timed
}

#[cfg(test)]
mod tests {
    use super::*;
    use Judgement::{Alias, Clean, Disturbed, Located, Right, Unexplained, Wrong, WrongMoment};
    use document::trace::Dependence::{self, LateralDistance, Time, YawRate};

    fn located(depends_on: Dependence, form: &str, from_s: Option<f64>, until_s: Option<f64>) -> LocatedMoment {
        LocatedMoment { depends_on, form: form.into(), from_s, until_s, alternatives: vec!["speed_loss".into()] }
    }

    /// Judgement of named effects, each with an alias and a time, and of a located moment.
    fn judged(names: &[(&str, &str, f64)], located: Option<LocatedMoment>, physics: &MissingPhysics) -> Judgement {
        let effect = |&(id, alias, time_s): &(&str, &str, f64)| NamedEffect {
            id: id.into(),
            aliases: vec![alias.into()],
            time_s: Some(time_s),
            ..NamedEffect::default()
        };
        let (named, located) = (names.iter().map(effect).collect(), located.into_iter().collect());
        Judgement::from_trace_row(
            &TraceRow {
                verdict: TraceVerdict::Traced,
                named_effects: named,
                located_moments: located,
                ..TraceRow::default()
            },
            physics,
        )
    }

    fn timed(changes_s: &[f64], period_s: Option<[f64; 2]>) -> MissingPhysics {
        MissingPhysics::Unlisted { depends_on: Time, changes_s: changes_s.to_vec(), period_s }
    }

    #[test]
    fn another_formula_is_judged_by_the_effects_it_stands_for_and_nothing_by_silence() {
        let [physics, other] =
            ["speed_loss", "wind_moment"].map(|id| MissingPhysics::Listed { effects: vec![id.into()] });
        let shape = || Some(located(YawRate, "moment with r²", None, None));
        let [right, alias, wrong] = [("speed_loss", ""), ("second_order", "speed_loss"), ("second_order", "")]
            .map(|(id, alias)| (id, alias, 0.0));
        assert_eq!(judged(&[right], shape(), &physics), Right);
        assert_eq!(judged(&[right, alias], None, &physics), Alias);
        assert_eq!(judged(&[right, wrong], None, &physics), Wrong);
        assert_eq!([&physics, &other].map(|physics| judged(&[], shape(), physics)), [Alias, WrongMoment]);
        let silent = |verdict| Judgement::from_trace_row(&TraceRow { verdict, ..TraceRow::default() }, &physics);
        let verdicts = [TraceVerdict::Clean, TraceVerdict::Unexplained, TraceVerdict::Disturbed];
        assert_eq!(verdicts.map(silent), [Clean, Unexplained, Disturbed]);
        let nothing = [true, false].map(|disturbed| MissingPhysics::Nothing { disturbed });
        assert_eq!(judged(&[], shape(), &nothing[0]), Wrong);
        assert_eq!(nothing.map(|nothing| Disturbed.is_right(&nothing)), [true, false]);
    }

    #[test]
    fn what_changes_is_located_by_an_instant_near_it() {
        let physics = timed(&[100.0, 200.0], None);
        let [squall, wind] = ["transient_disturbance", "wind_moment"];
        let from = |from, until| Some(located(Time, "moment", Some(from), until));
        // A lasting moment has no centre.
        for (names, moment, judgement) in [
            (&[(squall, "", 119.0), (squall, "", 181.0)][..], None, Located),
            (&[(squall, "", 119.0), (squall, "", 150.0)], None, WrongMoment),
            (&[(wind, "", 100.0)], None, Wrong),
            (&[(wind, "", 100.0)], from(110.0, None), Wrong),
            (&[(wind, squall, 100.0)], None, Alias),
            (&[(wind, squall, 100.0), (wind, "", 100.0)], None, Wrong),
            (&[], from(110.0, None), Located),
            (&[], from(140.0, None), WrongMoment),
            (&[], from(60.0, Some(130.0)), Located),
            (&[], from(60.0, Some(250.0)), WrongMoment),
            (&[], Some(located(LateralDistance, "moment with y", None, None)), WrongMoment),
        ] {
            assert_eq!(judged(names, moment.clone(), &physics), judgement, "{names:?}, {moment:?}");
        }
    }

    #[test]
    fn a_dependence_or_a_period_is_enough_where_nothing_changes() {
        let (period, always) = (timed(&[], Some([90.0; 2])), timed(&[], None));
        for (form, physics, judgement) in [
            ("moment with a period of 100 s", &period, Located),
            ("moment with a period of 45 s", &period, WrongMoment),
            ("moment with a period of 180 s and its harmonics", &period, Located),
            ("moment whose period runs from 80 s to 100 s", &period, Located),
            ("moment whose period runs from 90 s to 30 s", &period, WrongMoment),
            ("moment that grows with time", &period, WrongMoment),
            ("anything", &always, Located),
        ] {
            assert_eq!(judged(&[], Some(located(Time, form, None, None)), physics), judgement, "{form}");
        }
    }
}
