//! The sentences of a trace.

use document::names;
use document::trace::{BeforeAfter, DisturbanceEntry, EffectEntry, ErrorEntry, ErrorsEntry, LocatedEntry, Verdict};
use ship::angle::to_deg;
use trial::{Origin, Trial};

use crate::comparison::BandCoverage;
use crate::naming::EffectNaming;
use crate::signature::Signature;

/// Why the replay of the base is kept.
pub const NO_NEARER: &str = "the structures replay the records no nearer than the base: a random moment describes them, which no replay foresees";

/// Why no effect is named, whatever its probability.
pub const UNFOUNDED: &str = "the structures replay the records no nearer than the base, and no noise describes what \
                             they leave: no effect is named";

/// Name of the file of a trial, or of the trial.
pub fn file_of(trial: &Trial) -> String {
    match trial.origin() {
        Origin::Measured { file, .. } => file.clone(),
        Origin::Simulated { scenario, .. } => scenario.clone(),
    }
}

/// A number with three significant digits.
fn short(value: f64) -> String {
    let digits = match value.abs() {
        size if size >= 100.0 => 0,
        size if size >= 10.0 => 1,
        size if size >= 1.0 => 2,
        _ => 3,
    };
    format!("{value:.digits$}")
}

/// Words joined by commas and "and".
fn listed(words: &[String]) -> String {
    match words {
        [] => String::new(),
        [one] => one.clone(),
        [first @ .., last] => format!("{} and {last}", first.join(", ")),
    }
}

/// Length of the windows whose errors are said, s.
const WINDOW: &str = "60";

/// Share of the heading error from which it is said to stay what it was.
const STAYS: f64 = 0.95;

/// Errors of the headings of some records, before and after, degrees. `None` where no record has both.
fn errors_of(all: &[BeforeAfter], of: impl Fn(&ErrorsEntry) -> Option<f64>) -> Option<[f64; 2]> {
    let pairs: Vec<[f64; 2]> = all.iter().filter_map(|one| Some([of(&one.before)?, of(&one.after)?])).collect();
    let mean = |when: usize| (pairs.iter().map(|pair| pair[when].powi(2)).sum::<f64>() / pairs.len() as f64).sqrt();
    (!pairs.is_empty()).then(|| [mean(0), mean(1)])
}

/// "× 0.27": an error after over that before. Empty where there is none.
fn times(errors: Option<[f64; 2]>) -> Option<String> {
    errors.map(|[before, after]| after / before).filter(|ratio| ratio.is_finite()).map(|ratio| format!("× {ratio:.2}"))
}

/// What is said in one sentence.
pub struct Headline<'a> {
    /// Verdict.
    pub verdict: Verdict,
    /// What is named.
    pub effects: &'a [EffectEntry],
    /// Errors before and after.
    pub error: &'a ErrorEntry,
    /// The random moment.
    pub disturbance: Option<DisturbanceEntry>,
    /// Moments that are no effects of the list.
    pub located: &'a [LocatedEntry],
}

impl Headline<'_> {
    /// The result in one sentence: what is missing, and the error of the heading with it over that without, on fitted
    /// and on other records, over whole replays and over windows.
    pub fn sentence(&self) -> String {
        let named = |one: &EffectEntry| match one.aliases.is_empty() {
            true => names::effect_form(&one.id, &one.form),
            false => {
                let group = std::iter::once(&one.id).chain(&one.aliases);
                format!("one of {}", listed(&group.map(|id| names::effect(id)).collect::<Vec<_>>()))
            }
        };
        let names = listed(&self.effects.iter().map(named).collect::<Vec<_>>());
        let [from, to, judged, in_windows] = self.errors();
        let errors = format!("heading error {from}° → {to}{judged}{in_windows}");
        match (self.verdict, self.effects.is_empty()) {
            (Verdict::Clean, _) => format!(
                "The noise of the instruments alone explains the records: nothing is seen to be missing; the heading error \
                 of the first-order response is {from}°{judged}."
            ),
            (Verdict::Disturbed, _) => format!(
                "No effect is named, but something turns the ship: {} of the heading error of {from}°{judged}. Weather \
                 does this, and so does an effect of a shape that was not looked for.",
                self.moment()
            ),
            (Verdict::Located, true) => format!("What is missing depends on {}: {errors}.", self.shapes()),
            (_, true) => format!(
                "No effect of the list explains what is missing: {errors}; what is left is neither chance nor of a shape \
                 that was looked for."
            ),
            (verdict, false) => {
                let (more, left) = match (verdict, self.disturbance) {
                    (Verdict::Unexplained, _) => (" and more", String::from("; what is left is not noise")),
                    (Verdict::Located, _) => ("", format!("; what is left depends on {}", self.shapes())),
                    (_, Some(_)) => ("", format!("; what is left is chance: {} of it", self.moment())),
                    (_, None) => ("", String::new()),
                };
                format!("The first-order response lacks {names}{more}{}{left}.", self.seen(&errors))
            }
        }
    }

    /// Errors of the fitted records before and after, of others, and in windows.
    fn errors(&self) -> [String; 4] {
        let whole = |errors: &ErrorsEntry| Some(errors.heading_rmse_deg);
        let window = |errors: &ErrorsEntry| errors.horizon_rmse_deg.get(WINDOW).copied().flatten();
        let fitted = errors_of(&self.error.identification, whole).unwrap_or([f64::NAN; 2]);
        let (others, how) = match self.error.validation.is_empty() {
            true => (&self.error.leave_one_out, "left out in turn"),
            false => (&self.error.validation, "held out"),
        };
        let of_others = |ratio: Option<String>| ratio.map_or_else(String::new, |ratio| format!(", {how} {ratio}"));
        let judged = of_others(times(errors_of(others, whole)));
        let [from, to] = fitted.map(short);
        let ratio = times(Some(fitted)).map_or_else(String::new, |ratio| format!(" ({ratio})"));
        let in_windows = times(errors_of(&self.error.identification, window)).map_or_else(String::new, |own| {
            format!("; in windows of {WINDOW} s {own}{}", of_others(times(errors_of(others, window))))
        });
        [from, format!("{to}°{ratio}"), judged, in_windows]
    }

    /// The errors with named effects; where a whole replay gains nothing, what shows instead.
    fn seen(&self, errors: &str) -> String {
        let fitted = errors_of(&self.error.identification, |errors| Some(errors.heading_rmse_deg));
        match fitted.is_some_and(|[before, after]| after > STAYS * before) {
            true => format!("{}; the whole replay changes little: {errors}", one_step(self.effects)),
            false => format!(": {errors}"),
        }
    }

    /// The random moment and what it carries.
    fn moment(&self) -> String {
        let own = self.disturbance.unwrap_or(DisturbanceEntry { rudder_deg: f64::NAN, heading_error_share: f64::NAN });
        let share = 100.0 * own.heading_error_share;
        format!("a random moment like {}° of rudder (rms) carries {share:.0} %", short(own.rudder_deg))
    }

    /// What the shapes are, with their evidence.
    fn shapes(&self) -> String {
        let shape = |own: &LocatedEntry| format!("{} ({})", own.depends_on, own.form);
        let nats = self.located.first().map_or(0.0, |clearest| clearest.nats);
        let words = listed(&self.located.iter().map(shape).collect::<Vec<_>>());
        let other = self.located.first().and_then(|clearest| clearest.alternatives.first());
        let other = other.map_or_else(String::new, |other| format!(", or {other}"));
        format!("{words}, {nats:.0} nats better than any random moment{other}")
    }
}

/// Where effects show that bring a whole replay no nearer.
fn one_step(effects: &[EffectEntry]) -> String {
    let falls: Vec<String> = effects.iter().map(|one| format!("{:.0}", -one.delta_bic)).collect();
    format!(", seen from one heading to the next, where BIC falls by {}", listed(&falls))
}

/// What speaks for an effect.
pub fn evidence(named: &EffectNaming, gain: f64, asked: bool, trials: &[Trial]) -> String {
    let (id, form, only) = named.term;
    let effect = names::effect_form(id, form);
    let place = only.map_or(String::new(), |number| format!(" in {}", trials[number].title()));
    let odds = match gain / std::f64::consts::LN_10 {
        power if power >= 3.0 => format!("10^{power:.0} times more probable"),
        power if power < 0.0 => format!("{} times less probable", short(10f64.powf(-power))),
        power => format!("{} times more probable", short(10f64.powf(power))),
    };
    let forms = match named.forms.is_empty() {
        true => String::new(),
        false => format!(
            " The records do not tell its form; as near is {}.",
            listed(&named.forms.iter().map(|(_, form, _)| String::from(*form)).collect::<Vec<_>>())
        ),
    };
    let why = if asked { " It is in the model on request." } else { "" };
    if named.aliases.is_empty() {
        return format!(
            "With {effect}{place} the records are {odds}; its probability is {:.3}.{forms}{why}",
            named.probability
        );
    }
    let others: Vec<String> = named.aliases.iter().map(|(id, form, _)| names::effect_form(id, form)).collect();
    format!(
        "One of {effect} and {}{place} is there with a probability of {:.3}; the records do not tell which.{forms}{why}",
        listed(&others),
        named.probability
    )
}

/// What speaks for waves.
pub fn waves(sd: f64, frequency: f64) -> String {
    format!("The heading carries a narrow band of {}° at {} rad/s.", short(to_deg(sd)), short(frequency))
}

/// Where a rest is.
pub fn signature(own: &Signature, name: &str) -> String {
    let ([from, to], share) = own.span;
    let ([low, high], largest) = own.heading;
    let line = own.line.filter(|line| line.share > 0.2).map_or(String::new(), |line| {
        format!("; {:.0} % of it has a period of {:.0} s", 100.0 * line.share, line.frequency.recip())
    });
    format!(
        "{name}: residual {}° rms; {:.0} % of it between {from:.0} and {to:.0} s; largest ({}°) at headings from {:.0}° to {:.0}°; \
         {}° with the rudder to port, {}° with it to starboard{line}",
        short(to_deg(own.all)),
        100.0 * share,
        short(to_deg(largest)),
        to_deg(low),
        to_deg(high),
        short(to_deg(own.side[0])),
        short(to_deg(own.side[1])),
    )
}

/// A band that holds less than it is made for.
pub fn band(name: &str, own: &BandCoverage) -> String {
    let [low, high] = own.interval.map(|end| 100.0 * end);
    let (inside, of, share) = (own.inside, own.of, 100.0 * own.share());
    format!("; the 95 % band holds {inside} of {of} headings of {name}, {share:.0} % [{low:.0}, {high:.0}]")
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
            asked: false,
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
    fn record(whole: [f64; 2], window: [Option<f64>; 2]) -> BeforeAfter {
        let own = |when: usize| ErrorsEntry {
            heading_rmse_deg: whole[when],
            yaw_rate_rmse_deg_s: None,
            overshoot_error_deg: None,
            horizon_rmse_deg: BTreeMap::from([(WINDOW.to_owned(), window[when])]),
            band_coverage_95: None,
            band_width_95_deg: None,
            with_own_bias_deg: None,
            with_own_moment_deg: None,
        };
        BeforeAfter { file: String::new(), before: own(0), after: own(1), horizons: Vec::new() }
    }

    fn sentence(effects: &[EffectEntry], error: &ErrorEntry) -> String {
        Headline { verdict: Verdict::Traced, effects, error, disturbance: None, located: &[] }.sentence()
    }

    #[test]
    fn the_headline_names_effects_and_every_ratio() {
        let error = ErrorEntry {
            identification: vec![record([2.0, 0.5], [Some(1.0), Some(0.4)])],
            validation: vec![record([3.0, 1.5], [Some(1.0), Some(0.6)]), record([4.0, 2.0], [None, Some(0.1)])],
            ..ErrorEntry::default()
        };
        let effects = [effect("nonlinear_damping", -94.0), effect("speed_loss", -20.0)];
        assert_eq!(
            sentence(&effects, &error),
            "The first-order response lacks nonlinear damping (r³) and speed loss (r³): heading error 2.00° → 0.500° \
             (× 0.25), held out × 0.50; in windows of 60 s × 0.40, held out × 0.60."
        );
    }

    /// A replay that is no nearer does not stand beside a gain in BIC without a word on what each of them is of.
    #[test]
    fn a_gain_that_no_replay_shows_is_said_to_be_of_one_step() {
        let error = ErrorEntry { identification: vec![record([2.0, 2.0], [None; 2])], ..ErrorEntry::default() };
        assert_eq!(
            sentence(&[effect("nonlinear_damping", -94.2)], &error),
            "The first-order response lacks nonlinear damping (r³), seen from one heading to the next, where BIC falls \
             by 94; the whole replay changes little: heading error 2.00° → 2.00° (× 1.00)."
        );
    }
}
