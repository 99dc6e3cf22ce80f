//! What is said about an analysis: the words on the screen, and `report.md`.

use std::fmt::Write as _;

use ::trace::analysis::{Empirical, Fitted, Judged, Outcome, Randomness, RunnerUp, Traced, Verdict};
use ::trace::noise::Wander;
use report::number::{self, significant, uncertain};
use ship::Shown;
use ship::angle::to_deg;
use trial::Trial;

use super::scale_comparison::ScalesEntry;
use super::trace_report::TraceReport;
use super::trace_scales::prime;
use super::trace_tables::{candidates, errors, in_degrees, overshoots, parameters, prospects, structures};
use crate::scales::scale_name;

/// How what wanders is called.
pub fn kind(wander: Wander) -> &'static str {
    match wander {
        Wander::White => "white",
        Wander::OrnsteinUhlenbeck(_) => "gusts",
        Wander::Walk => "random walk",
        Wander::Compass(_) => "compass",
    }
}

/// What wanders beside the white noise, a moment as an angle of the rudder, in words; `None` where nothing does.
fn wander_in_words(noise: &Randomness) -> Option<String> {
    let size = significant(to_deg(noise.rudder), 2);
    let time = significant(noise.correlation.unwrap_or(f64::NAN), 2);
    Some(match noise.wander? {
        Wander::White => format!("a white yaw moment of {size}° of rudder in the mean of a second"),
        Wander::OrnsteinUhlenbeck(_) => {
            format!("gusts of {size}° of rudder with a correlation time of about {time} s")
        }
        Wander::Walk => format!("a yaw moment that wanders by {size}° of rudder in a second"),
        Wander::Compass(_) => {
            let size = significant(to_deg(noise.heading), 2);
            format!("an error of the compass of {size}° with a correlation time of about {time} s")
        }
    })
}

/// What a named noise hides, and how much more would have to be recorded until it is seen.
fn hidden(noise: &Randomness) -> Option<String> {
    let RunnerUp { id, form, times } = noise.runner_up?;
    let much = if times > MOST_TIMES { String::from("more than 20") } else { significant(times, 2) };
    Some(format!(
        "{id} ({form}) is nearest to being told from it: that would take {much} times as much of such records"
    ))
}

/// Beyond so many times as much record nobody will sail.
const MOST_TIMES: f64 = 20.0;

/// The words of one analysis.
pub fn words(report: &TraceReport) -> String {
    let analysis = &report.analysis;
    let rows: usize = report.trials.iter().map(Trial::len).sum();
    let mut text = match &report.trials[..] {
        [only] => format!("{}: {rows} rows, {:.1} s", only.name(), only.duration()),
        several => format!("{} records together: {rows} rows", several.len()),
    };
    if let Some(scaled) = &report.scaled {
        let _ = write!(text, "\n{scaled}");
    }
    let verdict = match analysis.verdict {
        Verdict::Clean if analysis.randomness.holds => "clean: nothing is missing, and the noise has a name",
        Verdict::Clean => "clean: nothing is missing",
        Verdict::Traced if analysis.effects.iter().all(|effect| effect.asked) => {
            "traced: what is left beside the effects that were asked for is noise"
        }
        Verdict::Traced => "traced: what is missing has a name, and what is left is noise",
        Verdict::Unexplained if analysis.effects.is_empty() => {
            "unexplained: structure is left, and no effect carries it"
        }
        Verdict::Unexplained => "unexplained: some of what is missing has a name, some has not",
    };
    let _ = write!(text, "\nverdict: {verdict}");
    if let Some((speed, gain)) = analysis.speed_scaling() {
        let (speed, gain) = (significant(speed, 3), number::fixed(-gain, 0));
        let _ =
            write!(text, "\n  base: K ~ U and T ~ 1/U with the measured speed, K and T at {speed} m/s; ΔBIC {gain}");
    }
    for effect in &analysis.effects {
        let _ = write!(text, "\n  {}", effect_line(effect));
    }
    if let Some(indices) = prime_in_words(report) {
        let _ = write!(text, "\n  prime: {indices}");
    }
    if let Some(model) = report.scales.iter().flat_map(|scales| &scales.comparisons).next() {
        let _ = write!(text, "\n  every scale alone: {}", ScalesEntry::sentence(model));
    }
    for refused in &analysis.refused {
        let _ = write!(text, "\n  {refused}");
    }
    if let Some(noise) = wander_in_words(&analysis.randomness).filter(|_| analysis.randomness.holds) {
        let _ = write!(text, "\n  noise: {noise}");
        if let Some(hidden) = hidden(&analysis.randomness) {
            let _ = write!(text, "; {hidden}");
        }
    }
    if let Some(signature) = signature(report) {
        let _ = write!(text, "\n  left: {signature}");
        if let Some(empirical) = &analysis.empirical {
            let _ = write!(text, "; {}", nameless(empirical));
        }
    }
    for warning in bounds(&analysis.parameters).into_iter().chain(outliers(report)) {
        let _ = write!(text, "\nwarning: {warning}");
    }
    let _ = write!(text, "\nnext trial: {}", next_trial(report));
    text
}

/// K', T' and the parameters of the effects without dimension, where length and speed of the ship are known.
fn prime_in_words(report: &TraceReport) -> Option<String> {
    let ship = report.ship?;
    let [k, t] = report.analysis.indices;
    let mut parts: Vec<String> = [("K′", k.scaled(ship.prime([-1, 0]))), ("T′", t.scaled(ship.prime([1, 0])))]
        .map(|(symbol, quantity)| format!("{symbol} = {}", uncertain(quantity.value, quantity.sd)))
        .into();
    let effects = report.analysis.effects.iter().flat_map(|effect| &effect.parameters);
    parts.extend(effects.filter_map(|fitted| prime(fitted, ship)).map(|(symbol, quantity, unit)| {
        let unit = if unit == "1" { String::new() } else { format!(" {unit}") };
        format!("{symbol} = {}{unit}", uncertain(quantity.value, quantity.sd))
    }));
    Some(format!("{} with {}", parts.join(", "), scale_name(ship)))
}

/// Readings that are listed.
const LISTED: usize = 8;

/// A sentence for every record with readings that were left out.
fn outliers(report: &TraceReport) -> Vec<String> {
    let spoilt = report.names.iter().zip(&report.analysis.outliers).filter(|(_, times)| !times.is_empty());
    spoilt
        .map(|(name, times)| {
            let mut shown: Vec<String> = times.iter().take(LISTED).map(|t| Shown(*t).to_string()).collect();
            shown.extend((times.len() > LISTED).then(|| String::from("…")));
            let count = times.len();
            format!("{name}: {count} headings stand alone and are left out, at t = {} s", shown.join(", "))
        })
        .collect()
}

/// A sentence for every parameter at an end of its range.
fn bounds(parameters: &[Fitted]) -> Vec<String> {
    let ends = parameters.iter().filter(|fitted| fitted.at_bound);
    ends.map(|fitted| {
        let (quantity, unit) = in_degrees(fitted);
        let unit = if unit == "1" { String::new() } else { format!(" {unit}") };
        let only = fitted.only.as_ref().map_or_else(String::new, |name| format!(" of {name}"));
        let follows = match fitted.parameter.key {
            "inverse_T" => ", and K and T follow from it",
            "K_over_T" => ", and K follows from it",
            _ => "",
        };
        let (symbol, number) = (fitted.parameter.symbol, significant(quantity.value, 3));
        format!("{symbol} = {number}{unit}{only} is at its bound: the search ends there{follows}")
    })
    .collect()
}

/// A parameter with its value.
fn value(fitted: &Fitted) -> String {
    let (quantity, unit) = in_degrees(fitted);
    let unit = if unit == "1" { String::new() } else { format!(" {unit}") };
    format!("{} = {}{unit}", fitted.parameter.symbol, uncertain(quantity.value, quantity.sd))
}

fn effect_line(effect: &Traced) -> String {
    let parameters: Vec<String> = effect.parameters.iter().map(value).collect();
    let alike = match effect.aliases.as_slice() {
        [] => String::new(),
        aliases => {
            let names: Vec<String> = aliases.iter().map(|(id, form)| format!("{id} ({form})")).collect();
            format!("; cannot be told from {}", names.join(", "))
        }
    };
    let only = effect.only.as_ref().map_or_else(String::new, |name| format!(" in {name}"));
    let asked = match effect.asked {
        true => format!(" [asked for, not found: ΔBIC {}]", number::fixed(-effect.evidence.gain, 1)),
        false => String::new(),
    };
    let probability = number::fixed(effect.probability, 3);
    format!("{} ({}){only}{asked}, probability {probability}: {}{alike}", effect.id, effect.form, parameters.join(", "))
}

/// The unexplained rest in one sentence.
pub fn signature(report: &TraceReport) -> Option<String> {
    let signature = report.analysis.unexplained.as_ref()?;
    let degrees = |x: f64| significant(to_deg(x), 2);
    let [from, to] = signature.span.0;
    let record =
        if report.trials.len() > 1 { format!("in {}, ", report.names[signature.record]) } else { String::new() };
    let strongest = signature.line.map_or_else(String::new, |line| {
        let period = significant(line.frequency.recip(), 3);
        format!("strongest at a period of {period} s ({:.0} %); ", 100.0 * line.share)
    });
    let [low, high] = signature.heading.0;
    let [port, starboard] = signature.side;
    let random = report.analysis.randomness.wander.map_or("", |kind| match kind {
        Wander::White => "; it looks like a white random yaw moment",
        Wander::OrnsteinUhlenbeck(_) => "; it looks like gusts",
        Wander::Walk => "; it looks like a yaw moment that wanders",
        Wander::Compass(_) => "; it looks like an error of the compass that lasts",
    });
    Some(format!(
        "{record}{}° rms; {:.0} % of it between {:.0} and {:.0} s; {strongest}largest at headings \
         from {:.0}° to {:.0}° ({}°); {}° with the rudder to port, {}° to starboard{random}",
        degrees(signature.all),
        100.0 * signature.span.1,
        from,
        to,
        to_deg(low),
        to_deg(high),
        degrees(signature.heading.1),
        degrees(port),
        degrees(starboard),
    ))
}

/// A term without a name in one sentence.
fn nameless(empirical: &Empirical) -> String {
    let values: Vec<String> = empirical.parameters.iter().map(value).collect();
    format!(
        "a term in {} with {} would lower the heading error to {}° (ΔBIC {}); it is a proposal and not part of the model",
        empirical.group.join(" or "),
        values.join(", "),
        significant(to_deg(empirical.error), 2),
        number::fixed(-empirical.evidence.gain, 0)
    )
}

/// The best next trial in one sentence.
pub fn next_trial(report: &TraceReport) -> String {
    let Some(best) = report.prospects.first() else {
        return String::from("none of the standard manoeuvres can be steered with the fitted model");
    };
    let mut gains = Vec::new();
    let pairs = |pairs: &[[String; 2]]| -> String {
        pairs.iter().map(|[one, other]| format!("{one} from {other}")).collect::<Vec<_>>().join(", ")
    };
    if !best.separated.is_empty() {
        gains.push(format!("would separate {}", pairs(&best.separated)));
    }
    if !best.revealed.is_empty() {
        gains.push(format!("would make visible {}", best.revealed.join(", ")));
    }
    let mut limits = Vec::new();
    if !best.still_alike.is_empty() {
        limits.push(format!("would not separate {}", pairs(&best.still_alike)));
    }
    if !best.still_hidden.is_empty() {
        limits.push(format!("would not show {}", best.still_hidden.join(", ")));
    }
    let sharper = best.sharpening.map(|change| 100.0 * (1.0 - change.exp())).filter(|percent| *percent >= 1.0);
    if let (true, Some(percent)) = (gains.is_empty(), sharper) {
        gains.push(format!("would make the standard deviations of the parameters {percent:.0} % smaller"));
    }
    let what = if gains.is_empty() { String::from("is no worse than any other") } else { gains.join(" and ") };
    let but = if limits.is_empty() { String::new() } else { format!("; it {}", limits.join(" and ")) };
    format!(
        "a {} {what}{but} (expected information of {} manoeuvres with the fitted model)",
        best.name,
        report.prospects.len()
    )
}

/// `report.md`. `figures` are the stems and captions of what was drawn.
pub fn page(report: &TraceReport, figures: &[(String, String)]) -> String {
    let analysis = &report.analysis;
    let mut text = format!("# Trace of {}\n\n", report.names[..report.trials.len()].join(", "));
    let _ = writeln!(text, "```text\n{}\n```\n", words(report));
    let _ = writeln!(text, "## Error before and after\n\n{}", errors(report).to_markdown());
    text += "Before is the best first-order base there is; after is the base with what was found. Heading and yaw rate are those of \
             the recorded rudder replayed over the whole record, *every 20 s* those of a heading that is restarted so often; \
             *overshoots* is the mean error of the overshoot angles. On held-out records nothing but the initial state is fitted.\n\n";
    let left_out = || analysis.left_out.iter().flatten();
    if left_out().next().is_some() {
        text += "*Left out*: base and model are fitted to the other records, and this one is replayed. The structure was found on all \
                 records and is kept; its parameters are fitted anew without the record.\n\n";
    }
    if analysis.validation.iter().chain(left_out()).any(|judged| judged.own_moment.is_some()) {
        text += "A moment that depends on time alone belongs to one record: *after* leaves it out on records that were not fitted, *after, own \
                 moment* estimates it there anew, beside the initial state.\n\n";
    }
    if let Some(table) = overshoots(report) {
        let _ = writeln!(text, "## Overshoots and period\n\n{}", table.to_markdown());
    }
    text += "## What was added\n\n";
    if analysis.effects.is_empty() {
        text += "Nothing.\n\n";
    }
    for effect in &analysis.effects {
        let _ = writeln!(text, "**{} ({})**: `{}`\n\n{}.\n", effect.id, effect.form, effect.equation, effect.sentence);
        if !effect.aliases.is_empty() {
            let names: Vec<String> = effect.aliases.iter().map(|(id, form)| format!("{id} ({form})")).collect();
            let _ = writeln!(text, "These records cannot tell it from {}.\n", names.join(", "));
        }
    }
    for remark in analysis.refused.iter().chain(&outliers(report)) {
        let _ = writeln!(text, "{remark}.\n");
    }
    let _ = writeln!(text, "## The model\n\n{}", parameters(report).to_markdown());
    if let Some(ship) = report.ship {
        let _ = writeln!(
            text,
            "Prime values are without dimension, with {}: times are divided by L/V, K′ = K L/V, T′ = T V/L.\n",
            scale_name(ship)
        );
    }
    if let Some(scales) = &report.scales {
        text += "## Which terms scale\n\n";
        for model in &scales.comparisons {
            let _ = writeln!(text, "{}.\n\n{}", ScalesEntry::sentence(model), scales.table(model).to_markdown());
        }
        text += "The structure is that of all records; its parameters are fitted to the records of every scale alone. A difference of \
                 more than three of its standard deviations does not scale; a term scales where it is smaller and a quarter of the \
                 value would have been seen. Scales are sailed with other manoeuvres, gear and noise, too: what does not scale may be \
                 an effect that the model lacks.\n\n";
    }
    let noise = &analysis.randomness;
    let _ = write!(text, "Heading noise: {}° (white)", significant(to_deg(noise.white), 2));
    if let Some(wander) = wander_in_words(noise) {
        let holds = if noise.holds { "describes what is left" } else { "does not describe all that is left" };
        let _ = write!(text, ", and {wander}; this noise {holds}");
        if let Some(hidden) = hidden(noise) {
            let _ = write!(text, "; {hidden}");
        }
    }
    if let Some(waves) = noise.waves {
        let (sd, frequency) = (significant(to_deg(waves.sd), 2), significant(waves.frequency, 3));
        let _ = write!(text, ", and waves of {sd}° at {frequency} rad/s");
    }
    text += ".\n\n";
    let _ = writeln!(text, "## Candidates\n\n{}", candidates(report).to_markdown());
    let weights = &analysis.weights;
    let _ = writeln!(
        text,
        "The probability of an effect is the share of its structures in the weights exp(−BIC/2) × prior of all {} structures that \
         were tried, each under the noise that suits it best, on the fitted records alone. A priori each of the {} places of the \
         menu (an effect, in all its forms together; a moment of time in one record) is taken with probability {}. These \
         structures cannot be told apart (at least a twentieth of the largest weight):\n\n{}",
        weights.structures.len(),
        weights.menu,
        significant(weights.prior, 2),
        structures(report).to_markdown()
    );
    text += "ΔBIC is negative where a candidate helps. `alone` is on top of the base under white noise; `in the end` is on top of \
             the final model against the best random explanation (for an added one: of its removal). The last column is the \
             largest ΔBIC that an effect as large as can be expected would have in these records; what stays above the threshold \
             is not observable.\n\n";
    if let Some(signature) = signature(report) {
        let _ = writeln!(text, "## What is left\n\n{signature}.\n");
        if let Some(empirical) = &analysis.empirical {
            let _ = writeln!(text, "Empirical, without a name in the field: {}.\n", nameless(empirical));
        }
    }
    let hidden: Vec<String> = analysis
        .candidates
        .iter()
        .filter(|one| one.outcome == Outcome::NotObservable)
        .map(|one| format!("{} ({})", one.id, one.form))
        .collect();
    if !hidden.is_empty() {
        let _ = writeln!(text, "## Blind spots\n\nNot observable in these records: {}.\n", hidden.join(", "));
    }
    let _ = writeln!(
        text,
        "## Next trial\n\nBest: {}.\n\n{}",
        next_trial(report),
        prospects(&report.prospects).to_markdown()
    );
    text += "Separated and revealed are counted over the aliases and blind spots above, for the records and the trial together; the \
             last column is the mean change of the standard deviations of the parameters.\n\n## Figures\n\n";
    for (stem, caption) in figures {
        let _ = writeln!(text, "![{caption}]({stem}.png)\n\n{caption}\n");
    }
    text
}

/// What the record of a judged pair is called in a figure.
pub fn title(judged: &Judged, name: &str, held_out: bool) -> String {
    let ratio = judged.after.errors.heading / judged.before.errors.heading;
    let held = if held_out { ", held out" } else { "" };
    format!("{name}{held}: heading error after / before {}", significant(ratio, 2))
}

#[cfg(test)]
mod tests {
    use ship::response::BASE;
    use trial::Quantity;

    use super::*;

    #[test]
    fn a_parameter_at_its_bound_is_a_warning() {
        let fitted = |place: usize, value, at_bound| Fitted {
            parameter: &BASE[place],
            quantity: Quantity::bare(value),
            only: None,
            at_bound,
        };
        let all = [fitted(0, 10.0, true), fitted(2, 0.01, false)];
        assert_eq!(bounds(&all), ["1/T = 10.0 1/s is at its bound: the search ends there, and K and T follow from it"]);
    }
}
