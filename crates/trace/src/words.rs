//! The sentences of a trace.

use ship::angle::to_deg;
use trial::{Origin, Trial};

use crate::comparison::BandCoverage;
use crate::document::{BeforeAfter, EffectEntry, ErrorEntry, Verdict};
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

fn root_mean_square(all: &[BeforeAfter], of: impl Fn(&BeforeAfter) -> f64) -> f64 {
    (all.iter().map(|one| of(one).powi(2)).sum::<f64>() / all.len() as f64).sqrt()
}

/// The result in one sentence.
pub fn headline(verdict: Verdict, effects: &[EffectEntry], error: &ErrorEntry) -> String {
    let own = |one: &EffectEntry| match one.aliases.is_empty() {
        true => format!("{} ({})", one.id, one.form),
        false => format!("one of {}", listed(&[vec![one.id.clone()], one.aliases.clone()].concat())),
    };
    let names: Vec<String> = effects.iter().map(own).collect();
    let before = |one: &BeforeAfter| one.before.heading_rmse_deg;
    let after = |one: &BeforeAfter| one.after.heading_rmse_deg;
    let fitted = &error.identification;
    let [from, to] = [root_mean_square(fitted, before), root_mean_square(fitted, after)].map(short);
    let (held_out, how) = match error.validation.is_empty() {
        true => (&error.leave_one_out, "left out in turn"),
        false => (&error.validation, "held out"),
    };
    let judged = match held_out.is_empty() {
        true => String::new(),
        false => {
            let ratio = root_mean_square(held_out, after) / root_mean_square(held_out, before);
            format!(", {how} × {ratio:.2}")
        }
    };
    match (verdict, names.is_empty()) {
        (Verdict::Clean, _) => {
            format!("Nothing is missing: the heading error of the first-order response is {from}°{judged}.")
        }
        (Verdict::Traced, _) => {
            format!("The first-order response lacks {}: heading error {from}° → {to}°{judged}.", listed(&names))
        }
        (Verdict::Unexplained, true) => {
            format!("What is missing has no name: heading error {from}° → {to}°{judged}; structure is left.")
        }
        (Verdict::Unexplained, false) => format!(
            "The first-order response lacks {} and more: heading error {from}° → {to}°{judged}; structure is left.",
            listed(&names)
        ),
    }
}

/// What speaks for an effect.
pub fn evidence(named: &EffectNaming, gain: f64, asked: bool, trials: &[Trial]) -> String {
    let (id, form, only) = named.term;
    let place = only.map_or(String::new(), |number| format!(" in {}", trials[number].name()));
    let odds = match gain / std::f64::consts::LN_10 {
        power if power >= 3.0 => format!("10^{power:.0} times more probable"),
        power => format!("{} times more probable", short(10f64.powf(power))),
    };
    let forms = match named.forms.is_empty() {
        true => String::new(),
        false => format!(
            " The records do not tell its form: {} fits as well.",
            listed(&named.forms.iter().map(|(_, form, _)| String::from(*form)).collect::<Vec<_>>())
        ),
    };
    let why = if asked { " It is in the model on request." } else { "" };
    if named.aliases.is_empty() {
        return format!(
            "With {id} ({form}){place} the records are {odds}; its probability is {:.3}.{forms}{why}",
            named.probability
        );
    }
    let others: Vec<String> = named.aliases.iter().map(|(id, form, _)| format!("{id} ({form})")).collect();
    format!(
        "One of {id} ({form}) and {}{place} is there with a probability of {:.3}; the records do not tell which.{forms}{why}",
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
        "{name}: {}° rms is left; {:.0} % of it between {from:.0} and {to:.0} s; largest ({}°) at headings from {:.0}° to {:.0}°; \
         rudder to port {}°, to starboard {}°{line}",
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
