//! Sentences of a trace: headline, evidence, peak of the residual.

use document::names;
use document::trace::{
    DisturbanceEntry, EffectEntry, LocatedMomentEntry, ModelReplayErrors, RecordReplayErrors, ReplayErrorLists,
    TraceVerdict,
};
use ship::angle::to_deg;
use trial::{RecordOrigin, Trial};

use crate::comparison::ConfidenceBandCoverage;
use crate::naming::EffectNaming;
use crate::residual_peak::ResidualPeak;

/// Reason for a trace that keeps the replay of the base.
pub const KEPT_BASE_REASON: &str = "adding effects does not improve the replay; the misfit looks like a random yaw \
                                    moment, which no replay can reproduce";

/// Reason for a trace that names no effect because no noise law describes the residual.
pub const NO_NAMED_EFFECT_REASON: &str = "adding effects does not improve the replay, and no noise law describes the \
                                          residual, so no effect is named";

/// File name of a measured trial, or scenario of a simulated one.
pub fn record_label(trial: &Trial) -> String {
    match trial.origin() {
        RecordOrigin::Measured { file, .. } => file.clone(),
        RecordOrigin::Simulated { scenario, .. } => scenario.clone(),
    }
}

/// Value as text with three significant digits; three decimals below 1, none from 100.
fn short(value: f64) -> String {
    let digits = match value.abs() {
        size if size >= 100.0 => 0,
        size if size >= 10.0 => 1,
        size if size >= 1.0 => 2,
        _ => 3,
    };
    format!("{value:.digits$}")
}

/// Enumeration of items, such as "a, b and c".
fn listed(items: &[String]) -> String {
    match items {
        [] => String::new(),
        [item] => item.clone(),
        [first @ .., last] => format!("{} and {last}", first.join(", ")),
    }
}

/// Window of the restarted replays in the headline, s.
const WINDOW: &str = "60";

/// Minimum ratio of heading errors, after to before, that counts as unchanged.
const UNCHANGED_SHARE: f64 = 0.95;

/// Heading errors (deg) of several records, before and after, as root mean squares; `None` if no record has both.
fn mean_errors(all: &[RecordReplayErrors], of: impl Fn(&ModelReplayErrors) -> Option<f64>) -> Option<[f64; 2]> {
    let pairs: Vec<[f64; 2]> = all.iter().filter_map(|entry| Some([of(&entry.before)?, of(&entry.after)?])).collect();
    let mean = |when: usize| (pairs.iter().map(|pair| pair[when].powi(2)).sum::<f64>() / pairs.len() as f64).sqrt();
    (!pairs.is_empty()).then(|| [mean(0), mean(1)])
}

/// Ratio of the error after to the error before, such as "27 %"; `None` without errors, or if it is not finite.
fn percent(errors: Option<[f64; 2]>) -> Option<String> {
    let ratio = errors.map(|[before, after]| after / before).filter(|ratio| ratio.is_finite())?;
    Some(format!("{:.0} %", 100.0 * ratio))
}

/// Results that the headline of a trace states.
pub struct Headline<'a> {
    /// Verdict, which selects the sentence.
    pub verdict: TraceVerdict,
    /// Named effects.
    pub effects: &'a [EffectEntry],
    /// Replay errors of base and average.
    pub error: &'a ReplayErrorLists,
    /// Random moment in addition to the named effects; `None` without one.
    pub disturbance: Option<DisturbanceEntry>,
    /// Located shapes.
    pub located: &'a [LocatedMomentEntry],
    /// `true` if the reported replays of the average include fitted hulls.
    pub has_hulls: bool,
}

impl Headline<'_> {
    /// Result in a few sentences: the effects missing from the first-order response, the heading error with and without
    /// them on fitted and unfitted records, and the residual.
    pub fn text(&self) -> String {
        let name = |effect: &EffectEntry| match effect.aliases.is_empty() {
            true => names::effect_form_name(&effect.id, &effect.form),
            false => {
                let group = std::iter::once(&effect.id).chain(&effect.aliases);
                format!("one of {}", listed(&group.map(|id| names::effect_name(id)).collect::<Vec<_>>()))
            }
        };
        let names = listed(&self.effects.iter().map(name).collect::<Vec<_>>());
        let base = short(mean_errors(&self.error.identification, whole).map_or(f64::NAN, |[before, _]| before));
        let errors = self.errors();
        match (self.verdict, self.effects.is_empty()) {
            (TraceVerdict::Clean, _) => format!(
                "Instrument noise alone explains the records; no missing effect is visible. The heading error of the \
                 first-order response is {base}°."
            ),
            (TraceVerdict::Disturbed, _) => format!(
                "No effect is named, but the ship was disturbed: {} of the heading error of {base}°. Weather does \
                 this; so does an effect of a shape that was not searched for.",
                self.moment()
            ),
            (TraceVerdict::Located, true) => format!("The missing yaw moment depends on {}. {errors}", self.shapes()),
            (_, true) => format!(
                "The first-order response lacks something that no listed effect explains. {errors} The residual is \
                 neither random nor of a shape that was searched for."
            ),
            (verdict, false) => {
                let residual = match (verdict, self.disturbance) {
                    (TraceVerdict::Unexplained, _) => {
                        String::from(" This does not explain everything: the residual that remains is not noise.")
                    }
                    (TraceVerdict::Located, _) => format!(" The residual depends on {}.", self.shapes()),
                    (_, Some(_)) => format!(" The residual is random: {} of it.", self.moment()),
                    (_, None) => String::new(),
                };
                format!("The first-order response lacks {names}. {}{errors}{residual}", self.one_step())
            }
        }
    }

    /// Heading errors with and without the effects, of full replays and of windows.
    fn errors(&self) -> String {
        let condition = ["With the probable effects", "With it", "With them"][self.effects.len().min(2)];
        let (errors, kind) = match self.error.validation.is_empty() {
            true => (&self.error.leave_one_out, "records left out in turn"),
            false => (&self.error.validation, "held-out records"),
        };
        let ratios = |of: fn(&ModelReplayErrors) -> Option<f64>| {
            let fitted = percent(mean_errors(&self.error.identification, of))?;
            let unfitted = percent(mean_errors(errors, of)).map(|ratio| format!("; {kind} {ratio}"));
            Some(fitted + &unfitted.unwrap_or_default())
        };
        let replays = ratios(whole).map_or_else(String::new, |ratios| format!(" ({ratios})"));
        let windows = ratios(|errors| errors.horizon_rmse_deg.get(WINDOW).copied().flatten());
        let windows =
            windows.map_or_else(String::new, |ratios| format!(" In replays restarted every {WINDOW} s: {ratios}."));
        let [before, after] = mean_errors(&self.error.identification, whole).unwrap_or([f64::NAN; 2]).map(short);
        let hulls = if self.has_hulls { ", averaged with fitted hulls," } else { "" };
        format!("{condition}{hulls} the heading error is {after}° instead of {before}°{replays}.{windows}")
    }

    /// Sentence on effects that improve one-step predictions, with the falls of the BIC, but hardly the full replay;
    /// empty if the heading error of the full replay of the fitted records is at most [`UNCHANGED_SHARE`] of the base.
    fn one_step(&self) -> String {
        let errors = mean_errors(&self.error.identification, whole);
        if errors.is_none_or(|[before, after]| after <= UNCHANGED_SHARE * before) {
            return String::new();
        }
        let decreases: Vec<String> = self.effects.iter().map(|effect| format!("{:.0}", -effect.delta_bic)).collect();
        let decreases = listed(&decreases);
        format!(
            "This improves the prediction of each heading from those before (BIC falls by {decreases}), but hardly the \
             full replay. "
        )
    }

    /// Statement on the random moment: its size, deg of rudder, and its share of the squared heading error; empty
    /// without one.
    fn moment(&self) -> String {
        let Some(moment) = self.disturbance else { return String::new() };
        let (rudder, share) = (short(moment.rudder_deg), 100.0 * moment.heading_error_share);
        format!("a random yaw moment equal to {rudder}° of rudder (rms) explains {share:.0} %")
    }

    /// Enumeration of the located shapes, dependence and form, with the first alternative of the clearest.
    fn shapes(&self) -> String {
        let shape = |located: &LocatedMomentEntry| format!("{} ({})", located.depends_on, located.form);
        let shapes = listed(&self.located.iter().map(shape).collect::<Vec<_>>());
        let alternative = self.located.first().and_then(|clearest| clearest.alternatives.first());
        alternative.map_or_else(|| shapes.clone(), |alternative| format!("{shapes}, or {alternative}"))
    }
}

/// Heading error of the full replay, deg.
fn whole(errors: &ModelReplayErrors) -> Option<f64> {
    Some(errors.heading_rmse_deg)
}

/// Sentence on the evidence for a named effect, from its log evidence ratio.
pub fn evidence(named: &EffectNaming, log_ratio: f64, asked: bool, trials: &[Trial]) -> String {
    let (id, form, record) = named.term;
    let effect = names::effect_form_name(id, form);
    let place = record.map_or(String::new(), |number| format!(" in {}", trials[number].title()));
    let odds = match log_ratio / std::f64::consts::LN_10 {
        power if power >= 3.0 => format!("10^{power:.0} times more probable"),
        power if power < 0.0 => format!("{} times less probable", short(10f64.powf(-power))),
        power => format!("{} times more probable", short(10f64.powf(power))),
    };
    let forms = match named.forms.is_empty() {
        true => String::new(),
        false => format!(
            " The records do not determine its form: {} fits as well.",
            listed(&named.forms.iter().map(|(_, form, _)| String::from(*form)).collect::<Vec<_>>())
        ),
    };
    let why = if asked { " It is included on request." } else { "" };
    if named.aliases.is_empty() {
        return format!(
            "The records are {odds} with {effect}{place} than without it. Its probability is {:.3}.{forms}{why}",
            named.probability
        );
    }
    let aliases = named.aliases.iter().map(|(id, form, _)| names::effect_form_name(id, form));
    format!(
        "One of {}{place} is present (probability {:.3}); the records cannot separate them.{forms}{why}",
        listed(&std::iter::once(effect).chain(aliases).collect::<Vec<_>>()),
        named.probability
    )
}

/// Sentence on waves: their standard deviation (rad) and frequency (rad/s).
pub fn wave_evidence(sd: f64, frequency: f64) -> String {
    format!("Waves move the heading by {}° (standard deviation) at {} rad/s.", short(to_deg(sd)), short(frequency))
}

/// Sentence on the peak of the residual of the record `name`.
pub fn residual_peak_sentence(peak: &ResidualPeak, name: &str) -> String {
    let ([from, to], share) = peak.span_and_share;
    let ([low, high], largest) = peak.heading_range_and_rms;
    let line = peak.spectral_line.filter(|line| line.mean_square_share > 0.2).map_or(String::new(), |line| {
        format!(
            "; {:.0} % of its square has a period of {:.0} s",
            100.0 * line.mean_square_share,
            line.frequency.recip()
        )
    });
    format!(
        "{name}: residual {}° rms; {:.0} % of its square between {from:.0} and {to:.0} s; largest ({}°) at headings \
         from {:.0}° to {:.0}°; {}° with the rudder to port, {}° with it to starboard{line}",
        short(to_deg(peak.rms)),
        100.0 * share,
        short(to_deg(largest)),
        to_deg(low),
        to_deg(high),
        short(to_deg(peak.side_rms[0])),
        short(to_deg(peak.side_rms[1])),
    )
}

/// Clause on a band with less than its nominal coverage.
pub fn band_sentence(name: &str, coverage: &ConfidenceBandCoverage) -> String {
    let [low, high] = coverage.share_ci99.map(|end| 100.0 * end);
    let (inside, total, share) = (coverage.headings_inside, coverage.heading_count, 100.0 * coverage.share());
    format!("; the 95 % band holds {inside} of {total} headings of {name}, {share:.0} % [{low:.0}, {high:.0}]")
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;

    use super::*;

    fn effect(id: &str, delta_bic: f64) -> EffectEntry {
        EffectEntry {
            id: id.into(),
            form: "r³".into(),
            equation: String::new(),
            only: None,
            required: false,
            aliases: Vec::new(),
            alias_forms: Vec::new(),
            parameters: BTreeMap::new(),
            probability: 1.0,
            probability_by_prior_odds: Vec::new(),
            delta_bic,
            p_value: 0.0,
            evidence: String::new(),
        }
    }

    /// Errors of the whole replay and of windows of 60 s, before and after.
    fn record(whole: [f64; 2], window: [Option<f64>; 2]) -> RecordReplayErrors {
        let errors = |when: usize| ModelReplayErrors {
            heading_rmse_deg: whole[when],
            yaw_rate_rmse_deg_s: None,
            overshoot_error_deg: None,
            horizon_rmse_deg: BTreeMap::from([(WINDOW.to_owned(), window[when])]),
            band_coverage_95: None,
            band_width_95_deg: None,
            heading_rmse_own_bias_deg: None,
            heading_rmse_own_moment_deg: None,
        };
        RecordReplayErrors { file: String::new(), before: errors(0), after: errors(1), horizons: Vec::new() }
    }

    fn headline(effects: &[EffectEntry], error: &ReplayErrorLists) -> String {
        Headline { verdict: TraceVerdict::Traced, effects, error, disturbance: None, located: &[], has_hulls: false }
            .text()
    }

    #[test]
    fn the_headline_names_effects_and_every_ratio() {
        let error = ReplayErrorLists {
            identification: vec![record([2.0, 0.5], [Some(1.0), Some(0.4)])],
            validation: vec![record([3.0, 1.5], [Some(1.0), Some(0.6)]), record([4.0, 2.0], [None, Some(0.1)])],
            ..ReplayErrorLists::default()
        };
        let effects = [effect("nonlinear_damping", -94.0), effect("speed_loss", -20.0)];
        assert_eq!(
            headline(&effects, &error),
            "The first-order response lacks nonlinear damping (r³) and speed loss (r³). With them the heading error is \
             0.500° instead of 2.00° (25 %; held-out records 50 %). In replays restarted every 60 s: 40 %; held-out \
             records 60 %."
        );
    }

    /// A gain in BIC without a smaller replay error is reported as a gain in one-step prediction.
    #[test]
    fn a_gain_that_no_replay_shows_is_one_of_prediction() {
        let error =
            ReplayErrorLists { identification: vec![record([2.0, 2.0], [None; 2])], ..ReplayErrorLists::default() };
        assert_eq!(
            headline(&[effect("nonlinear_damping", -94.2)], &error),
            "The first-order response lacks nonlinear damping (r³). This improves the prediction of each heading from \
             those before (BIC falls by 94), but hardly the full replay. With it the heading error is 2.00° instead of \
             2.00° (100 %)."
        );
    }
}
