//! What is said of a trace: the words on the screen, and `report.md`. Both are made from the document.

use campaign::statistics::distinct;
use document::identified_ship::ValidityRange;
use document::names;
use document::trace::{Outcome, ParameterEntry, TraceDocument};
use predict::steady::SteadyCurve;
use report::markdown::text;
use report::number::{fixed, significant};
use report::{Page, PageFigure, Table, TableHead};
use ship::ShortNumber;
use ship::vessel::prime::meaning;

use super::record_figures::{stability, steady_turns};
use super::trace_figures as figures;
use super::trace_hero;
use super::trace_tables as tables;
use super::{horizon, prior_odds, staircase};
use crate::documents::curves::TraceCurves;
use crate::documents::prior;
use crate::scales::scale_name;

/// Readings that are listed.
const LISTED: usize = 8;

/// The words on the screen before and behind the table of errors.
pub fn words(document: &TraceDocument) -> [String; 2] {
    let trace = &document.trace;
    let mut before = format!("{}\n", trace.headline);
    before += &document.scales.as_ref().map_or_else(String::new, |scales| format!("{scales}\n"));
    if !trace.effects.is_empty() {
        before += &format!("\n{}", tables::effects(document).to_text());
    }
    let mut behind = String::new();
    for typed in formulas(document, "") {
        behind += &format!("\n{typed}");
    }
    behind += &format!("\nnoise: {}", noise(document));
    if let Some(signature) = &trace.unexplained.signature {
        behind += &format!("\nleft: {signature}");
    }
    located(document, "").for_each(|words| behind += &format!("\n{words}"));
    behind += &odd(document);
    behind +=
        &document.earlier_trials.as_ref().map_or_else(String::new, |earlier| format!("\n{}", prior::sentence(earlier)));
    behind += &prior_odds::sentence(document).map_or_else(String::new, |sentence| format!("\n{sentence}"));
    for warning in bounds(&trace.model.parameters).into_iter().chain(outliers(document)) {
        behind += &format!("\nwarning: {warning}");
    }
    behind += &format!("\nnext trial: {}", document.next_trial);
    [before, behind]
}

/// Errors on all records.
pub fn all_errors(document: &TraceDocument) -> Table {
    let (fitted, judged) = document.errors();
    tables::errors(&[fitted, judged].concat())
}

/// A sentence for every effect that was typed, with `mark` around its text.
fn formulas(document: &TraceDocument, mark: &str) -> impl Iterator<Item = String> {
    let typed = document.trace.candidates.iter().filter_map(|own| Some((own, own.sides.as_ref()?)));
    typed.map(move |(own, sides)| {
        let text = own.forms.first().map_or_else(String::new, |form| format!(" = {}", form.form));
        format!("{mark}{}{text}{mark} {sides}", own.id)
    })
}

/// Departures of a hull, in standard deviations, that are said.
const ODD: f64 = 2.0;

/// What is odd about the ship: the farthest departure of the hull of her dimensions, else of any.
fn odd(document: &TraceDocument) -> String {
    let hulls = &document.ship.hulls;
    let Some(hull) = hulls.iter().find(|hull| hull.form == "mmg").or(hulls.first()) else { return String::new() };
    let farthest =
        hull.coefficients.iter().max_by(|one, other| one.departure().abs().total_cmp(&other.departure().abs()));
    let told = farthest.filter(|own| own.departure().abs() >= ODD).map(|own| {
        let means = meaning(&own.key).map_or_else(String::new, |means| format!(" ({means})"));
        format!("{} is {} sd from its prior{means}", own.symbol, fixed(own.departure(), 1))
    });
    let what = told.unwrap_or_else(|| format!("no coefficient is more than {ODD} sd from its prior"));
    let forms: Vec<&str> = hulls.iter().map(|hull| hull.form.as_str()).collect();
    format!("\nhulls fitted: {}; of {}, {what}", forms.join(", "), hull.form)
}

/// The noise in one sentence.
fn noise(document: &TraceDocument) -> String {
    let all = &document.trace.noise;
    let sizes = || all.iter().map(|own| own.heading_sd_deg);
    let [least, most] = [sizes().fold(f64::INFINITY, f64::min), sizes().fold(0.0, f64::max)].map(|x| significant(x, 2));
    let white = if least == most { least } else { format!("{least} to {most}") };
    let largest = all.iter().max_by(|one, other| one.heading_sd_deg.total_cmp(&other.heading_sd_deg));
    let beside = largest.map(tables::coloured).unwrap_or_default();
    let beside = beside.iter().map(|what| format!(", {what}")).collect::<String>();
    let holds = match all.iter().all(|own| own.describes_what_is_left) {
        true => "this describes what is left",
        false => "this does not describe all that is left",
    };
    format!("heading {white}° (white){beside}; {holds}")
}

/// A sentence for every record with readings that were left out.
fn outliers(document: &TraceDocument) -> Vec<String> {
    let spoilt = document.trace.noise.iter().filter(|own| !own.outliers_s.is_empty());
    let of = |(file, times): (&String, &Vec<f64>)| {
        let mut shown: Vec<String> = times.iter().take(LISTED).map(|t| ShortNumber(*t).to_string()).collect();
        shown.extend((times.len() > LISTED).then(|| String::from("…")));
        let (count, shown) = (times.len(), shown.join(", "));
        format!("{file}: headings far from those around are left out ({count}), at t = {shown} s")
    };
    spoilt.map(|own| of((&own.file, &own.outliers_s))).collect()
}

/// A sentence for every parameter at an end of its range.
fn bounds(parameters: &[ParameterEntry]) -> Vec<String> {
    let of = |own: &ParameterEntry| {
        let only = own.only.as_ref().map_or_else(String::new, |name| format!(" of {}", names::record(name)));
        format!("{}{only} is at its bound: the search ends there", tables::value(own))
    };
    parameters.iter().filter(|own| own.at_bound).map(of).collect()
}

const JUDGED: &str = "Nothing but the initial state is fitted to a record here. *Held out*: the record took no part in the \
                      analysis. *Left out*: base and model are fitted to the other records. In the table of every \
                      record, *own bias* is the heading error where a rudder bias of that record is fitted too, and \
                      *own moment* where this is a slow yaw moment, straight between five instants: what is gone \
                      there can be of its weather or trim.";

const ERRORS: &str = "*Heading*: the recorded rudder replayed over the whole record. *Every 20 s*: the replay begins anew so \
                      often. *After/before* is the ratio of the errors of the whole replay. ΔBIC, below, weighs every \
                      heading given those before it: it may fall where a whole replay gains nothing.";

const EVIDENCE: &str = "The probability of an effect is the weight of all structures that have it. ΔBIC is −2 log of \
                        the ratio of the evidence with the effect to that without: negative where the effect helps. \
                        An effect is named where its probability, or that of the group it cannot be told from, is \
                        high enough, its size is none by chance, and no moment of another shape explains the records \
                        better in its place.";

const HULLS: &str = "Hulls of three degrees of freedom, fitted about what the dimensions of the ship say (`mmg`) or what \
                     hulls have (`quadratic`, `cubic`): their coefficients without dimension that are one standard \
                     deviation or more from what was expected. Predictions are made with these hulls, and they take part \
                     in the replays where the structures leave more than noise.";

const CANDIDATES: &str = "Visibility is the expected square of the size of an effect over its error beside all other \
                          candidates: what is small here cannot be seen in these records.";

/// `report.md` with its figures; `turns` are the steady turns of the model. The finding, the figure that shows it and
/// what it is worth on other records come first; what they rest on is folded.
pub fn page(document: &TraceDocument, curves: &TraceCurves, turns: Option<&(Vec<SteadyCurve>, ValidityRange)>) -> Page {
    let mut page = Page::titled(format!("Trace of {}", document.title()));
    page.say(format!("**{}**", document.trace.headline));
    page.say(document.scales.as_ref().map_or_else(String::new, |scales| format!("{scales}.")));
    let [of_fitted, of_held_out] = figures::records(document, curves);
    let mut records = of_fitted.into_iter().chain(of_held_out);
    let first = trace_hero::figure(document, curves).or_else(|| records.next());
    page.figures(first);
    if let Some(figure) = staircase::figure(document, curves) {
        page.part("What each effect carries");
        page.list(physics(document));
        page.figures([figure]);
    }
    if let Some(figure) = figures::held_out(document) {
        page.part("Records that were not fitted");
        page.figures([figure]);
        page.say(JUDGED);
        page.figures(horizon::figure(document));
    }
    if let Some(figure) = figures::overshoots(document, curves) {
        page.part("Overshoots");
        page.figures([figure]);
    }
    what_is_left(&mut page, document);
    page.part("Next trial");
    page.say(&document.next_trial);
    page.folded_part("Every record");
    page.table(all_errors(document));
    page.say(ERRORS);
    page.figures(records);
    evidence(&mut page, document, curves);
    model_and_noise(&mut page, document);
    let moments = figures::moments(document, curves);
    if !moments.is_empty() {
        page.folded_part("The yaw moment that the base lacks");
        page.figures(moments);
    }
    page.folded_part("Further figures");
    page.figures(turns.map(|(curves, seen)| {
        let caption = "Steady yaw rate against rudder of the model, an unstable branch dashed; thin: ships that the records \
                       cannot tell from it; grey: the range of the records.";
        PageFigure::new("steady", stability(curves), caption, steady_turns(curves, *seen))
    }));
    page.figures(figures::further(document, curves));
    settings(&mut page, document);
    page
}

/// The physics of the effects of the staircase, a sentence each.
fn physics(document: &TraceDocument) -> impl Iterator<Item = String> {
    let ids = document.staircase.iter().filter_map(|step| step.id.as_deref());
    distinct(ids).into_iter().filter_map(|id| Some(format!("**{}**: {}.", names::effect(id), names::physics(id)?)))
}

/// What speaks for and against every effect, and whether what is left is noise.
fn evidence(page: &mut Page, document: &TraceDocument, curves: &TraceCurves) {
    let trace = &document.trace;
    let table = |page: &mut Page, title: &str, table: Table, words: &str| {
        page.subpart(title);
        page.table(table);
        page.say(words);
    };
    page.folded_part("Evidence");
    page.figures([figures::evidence(document)]);
    page.say(EVIDENCE);
    page.figures(prior_odds::figure(document));
    page.say(prior_odds::sentence(document).unwrap_or_default());
    page.figures(figures::innovations(document, curves));
    if !trace.effects.is_empty() {
        table(page, "Effects", tables::effects(document), "");
    }
    for effect in &trace.effects {
        let name = names::effect_form(&effect.id, &effect.form);
        page.say(format!("**{name}**: `{}`. {}", effect.equation, effect.evidence));
    }
    table(page, "Structures", tables::structures(document), "");
    table(page, "Candidates", tables::candidates(document), CANDIDATES);
    formulas(document, "`").for_each(|typed| page.say(format!("{typed}.")));
    table(page, "Aliases and blind spots", aliases(document), "");
}

/// The parameters, the noise and the hulls.
fn model_and_noise(page: &mut Page, document: &TraceDocument) {
    page.folded_part("Model");
    page.table(tables::parameters(document));
    page.say(model(document));
    page.subpart("Noise");
    page.table(tables::noise(document));
    if !document.ship.hulls.is_empty() {
        page.subpart("The hull behind the response");
        page.table(tables::hulls(document));
        page.say(document.earlier_trials.as_ref().map_or_else(String::new, |earlier| text(&prior::sentence(earlier))));
        page.say(HULLS);
    }
}

/// How the structures were weighed.
fn settings(page: &mut Page, document: &TraceDocument) {
    let prior = &document.trace.prior;
    page.folded_part("Settings");
    page.say(format!(
        "{} candidates; prior probability of an effect {}, of a moment of time in one record {}; named from a probability of \
         {}; rule: {}.",
        prior.candidates,
        significant(prior.probability, 2),
        significant(prior.probability_of_time, 2),
        significant(prior.named_from, 2),
        prior.rule,
    ));
}

/// The noise, and what no effect explains.
fn what_is_left(page: &mut Page, document: &TraceDocument) {
    page.part("What is left");
    page.say(format!("Noise: {}.", noise(document)));
    let unexplained = &document.trace.unexplained;
    page.say(unexplained.signature.as_ref().map_or_else(String::new, |signature| format!("{signature}.")));
    located(document, "`").for_each(|words| page.say(words));
}

/// A sentence or two for every moment that is no effect of the list, with `mark` around what can be typed.
fn located(document: &TraceDocument, mark: &str) -> impl Iterator<Item = String> {
    document.trace.located.iter().map(move |own| {
        let only = own.only.as_ref().map_or_else(String::new, |name| format!(" in {}", names::record(name)));
        let or = if own.alternatives.is_empty() { "" } else { "; as near is " };
        let typed = match &own.formula {
            Some(line) => format!("To have it fitted and judged: {mark}--effect \"{line}\"{mark}."),
            None => String::from("No formula says this moment, so it cannot be typed as an effect."),
        };
        format!(
            "Not part of the model: depends on {}{only}: {}, worth {}° of rudder (rms), {} nats better than any random \
             moment{or}{}. {typed}",
            own.depends_on,
            own.form,
            significant(own.rudder_deg, 2),
            fixed(own.nats, 0),
            own.alternatives.join(" or "),
        )
    })
}

/// What is said under the table of parameters.
fn model(document: &TraceDocument) -> String {
    let model = &document.trace.model;
    let equations: Vec<String> = model.equations.iter().map(|equation| format!("`{equation}`")).collect();
    let averaged =
        "K, T and δ_r are averaged over the structures; the other parameters are those of the most probable one.";
    let prime = model.indices.prime.as_ref().and(document.particulars()).map_or_else(String::new, |ship| {
        format!(" Prime values are without dimension, with {}: K′ = K L/V, T′ = T V/L.", scale_name(ship))
    });
    format!("{}. {averaged}{prime}", equations.join(", "))
}

/// What these records cannot tell: effects from each other, and effects at all.
fn aliases(document: &TraceDocument) -> Table {
    let mut table = Table::new(TableHead::default().texts(["effect", "these records cannot tell it from"]));
    for effect in document.trace.effects.iter().filter(|effect| !effect.alias_forms.is_empty()) {
        table.push([
            tables::term(&effect.id, &effect.form, effect.only.as_ref()),
            tables::terms(&effect.alias_forms, ", "),
        ]);
    }
    for one in document.trace.candidates.iter().filter(|one| one.outcome == Outcome::NotObservable) {
        let why = one.reason.as_ref().map_or_else(String::new, |reason| format!(": {reason}"));
        table.push([names::effect(&one.id), format!("nothing (not observable{why})")]);
    }
    table
}

#[cfg(test)]
mod tests {
    use super::*;
    use trial::Quantity;

    #[test]
    fn a_parameter_at_its_bound_is_a_warning() {
        let own = |symbol: &str, value, at_bound| ParameterEntry {
            key: String::new(),
            symbol: symbol.into(),
            quantity: Quantity::bare(value),
            unit: "1/s".into(),
            prime: None,
            only: None,
            at_bound,
        };
        let all = [own("1/T", 10.0, true), own("K/T", 0.01, false)];
        assert_eq!(bounds(&all), ["1/T = 10.000 1/s is at its bound: the search ends there"]);
    }
}
