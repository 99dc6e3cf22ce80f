//! Text of a trace from its document: the lines on the screen, and `report.md`.

use askama::Template;
use campaign::statistics::distinct;
use document::identified_ship::ValidityRange;
use document::names;
use document::trace::{CandidateOutcome, ParameterEntry, PriorEntry, TraceDocument};
use predict::steady::SteadyCurve;
use report::markdown::escaped_text;
use report::number::{MISSING, fixed, significant};
use report::{Page, PageFigure, PlacedFigures, Table, TableHead};
use ship::ShortNumber;
use ship::angle::to_deg;
use ship::vessel::prime::departure_cause;
use trial::ZigZag;

use super::overshoots::ReplayedOvershoot;
use super::record_figures::{stability, steady_turns};
use super::trace_figures as figures;
use super::trace_key_figure;
use super::trace_tables::{self as tables, unnamed_remark};
use super::{first_page, held_out, horizon, indices, overshoots, prior_odds, staircase};
use crate::documents::curves::TraceCurves;
use crate::documents::prior;
use crate::scales::scale_name;

/// Maximum number of times listed in a warning.
const MAX_LISTED_TIMES: usize = 8;

/// Text on the screen before and after the table of errors.
pub fn texts_around_table(document: &TraceDocument) -> [String; 2] {
    let trace = &document.trace;
    let mut before = format!("{}\n", trace.headline);
    before += &document.scales.as_ref().map_or_else(String::new, |scales| format!("{scales}\n"));
    if !trace.effects.is_empty() {
        before += &format!("\n{}", tables::effect_table(document).to_text());
    }
    before += &format!("\n{}", indices::trace_table(document).to_text());
    let mut behind = String::new();
    if let Some(all) = &document.single_records {
        behind += &format!("\n{}", indices::range_sentence(all));
    }
    for typed in formulas(document, "") {
        behind += &format!("\n{typed}");
    }
    behind += &format!("\nnoise: {}", noise(document));
    if let Some(signature) = &trace.unexplained.signature {
        behind += &format!("\nleft: {signature}");
    }
    located(document, "").for_each(|sentence| behind += &format!("\n{sentence}"));
    behind += &odd(document);
    behind += &document
        .earlier_trials
        .as_ref()
        .map_or_else(String::new, |earlier| format!("\n{}", prior::earlier_trials_sentence(earlier)));
    for warning in bounds(&trace.model.parameters).into_iter().chain(outliers(document)) {
        behind += &format!("\nwarning: {warning}");
    }
    behind += &format!("\nnext trial: {}", document.next_trial);
    [before, behind]
}

/// Table of errors on all records.
pub fn all_replay_errors_table(document: &TraceDocument) -> Table {
    let (fitted, judged) = document.errors();
    tables::replay_error_table(&[fitted, judged].concat())
}

/// Sentence on every effect given as a formula, with `mark` around its text.
fn formulas(document: &TraceDocument, mark: &str) -> impl Iterator<Item = String> {
    let typed = document.trace.candidates.iter().filter_map(|candidate| Some((candidate, candidate.sides.as_ref()?)));
    typed.map(move |(candidate, sides)| {
        let text = candidate.forms.first().map_or_else(String::new, |form| format!(" = {}", form.form));
        format!("{mark}{}{text}{mark} {sides}", candidate.id)
    })
}

/// Minimum departure of a hull coefficient that is reported, in standard deviations.
const MIN_DEPARTURE: f64 = 2.0;

/// Sentence on the fitted hulls, and on the coefficient with the maximum departure from its prior in the hull of the
/// form mmg, else in the first; empty without hulls.
fn odd(document: &TraceDocument) -> String {
    let hulls = &document.ship.hulls;
    let Some(hull) = hulls.iter().find(|hull| hull.form == "mmg").or(hulls.first()) else { return String::new() };
    let farthest = hull
        .coefficients
        .iter()
        .max_by(|a, b| a.departure_from_prior().abs().total_cmp(&b.departure_from_prior().abs()));
    let departure = farthest.filter(|entry| entry.departure_from_prior().abs() >= MIN_DEPARTURE).map(|entry| {
        let means = departure_cause(&entry.key).map_or_else(String::new, |means| format!(" ({means})"));
        format!(
            "{} is {} standard deviations off its prior{means}",
            entry.symbol,
            fixed(entry.departure_from_prior(), 1)
        )
    });
    let departure = departure
        .unwrap_or_else(|| format!("no coefficient is more than {MIN_DEPARTURE} standard deviations off its prior"));
    let forms: Vec<&str> = hulls.iter().map(|hull| hull.form.as_str()).collect();
    format!("\nhulls fitted: {}; in {}, {departure}", forms.join(", "), hull.form)
}

/// Sizes of the white heading noise and of the largest correlated noise, and whether they explain the remaining error.
fn noise(document: &TraceDocument) -> String {
    let all = &document.trace.noise;
    let sizes = || all.iter().map(|noise_entry| noise_entry.heading_sd_deg);
    let [least, most] = [sizes().fold(f64::INFINITY, f64::min), sizes().fold(0.0, f64::max)].map(|x| significant(x, 2));
    let white = if least == most { least } else { format!("{least} to {most}") };
    let largest = all.iter().max_by(|a, b| a.heading_sd_deg.total_cmp(&b.heading_sd_deg));
    let beside = largest.map(tables::coloured_noise_phrases).unwrap_or_default();
    let beside = beside.iter().map(|noise_term| format!(", {noise_term}")).collect::<String>();
    let holds = match all.iter().all(|noise_entry| noise_entry.is_adequate) {
        true => "this explains the remaining error",
        false => "this does not explain all of the remaining error",
    };
    format!("heading {white}° (uncorrelated){beside}; {holds}")
}

/// Sentence on every record with excluded readings.
fn outliers(document: &TraceDocument) -> Vec<String> {
    let spoilt = document.trace.noise.iter().filter(|noise_entry| !noise_entry.outliers_s.is_empty());
    let sentence = |(file, times): (&String, &Vec<f64>)| {
        let mut shown: Vec<String> = times.iter().take(MAX_LISTED_TIMES).map(|t| ShortNumber(*t).to_string()).collect();
        shown.extend((times.len() > MAX_LISTED_TIMES).then(|| String::from("…")));
        let (count, shown) = (times.len(), shown.join(", "));
        format!("{file}: outlying headings are left out ({count}), at t = {shown} s")
    };
    spoilt.map(|noise_entry| sentence((&noise_entry.file, &noise_entry.outliers_s))).collect()
}

/// Sentence on every parameter at an end of its range.
fn bounds(parameters: &[ParameterEntry]) -> Vec<String> {
    let sentence = |parameter: &ParameterEntry| {
        let only = parameter.only.as_ref().map_or_else(String::new, |name| format!(" of {}", names::record_name(name)));
        format!(
            "{}{only} is at the end of its search range; the true value may lie beyond",
            tables::parameter_text(parameter)
        )
    };
    parameters.iter().filter(|parameter| parameter.at_bound).map(sentence).collect()
}

/// Template of `report.md`.
#[derive(Template)]
#[template(path = "trace.md", escape = "none")]
struct TracePage<'a> {
    document: &'a TraceDocument,
    title: String,
    /// Ship, date and draughts of the fitted trials.
    particulars: Option<Table>,
    /// Physics of the effects of the staircase, a sentence each.
    physics: Vec<String>,
    glance: Table,
    limits: Vec<String>,
    noise: String,
    located: Vec<String>,
    errors: Table,
    formulas: Vec<String>,
    aliases: Table,
    model: String,
    prior: &'a PriorEntry,
    /// Prior probabilities of an effect and of a moment of time, and the probability at which an effect is named.
    odds: [String; 3],
    figures: PlacedFigures<&'static str>,
}

/// Content of `report.md` with its figures; `turns` are the steady turns of the model. The finding, its figure and the
/// errors on held-out records come first; their basis is folded.
pub fn page(document: &TraceDocument, curves: &TraceCurves, turns: Option<&(Vec<SteadyCurve>, ValidityRange)>) -> Page {
    let (prior, overshoots) = (&document.trace.prior, overshoots::replayed_overshoots(document, curves));
    let fitted = document.records.iter().filter(|record| !record.held_out);
    let named = fitted.map(|record| (names::record_name(&record.name), &record.trial_particulars));
    let page = TracePage {
        document,
        title: title(document, curves),
        particulars: first_page::particulars_table(named),
        physics: physics(document),
        glance: glance(document, &overshoots),
        limits: limits(document, curves),
        noise: noise(document),
        located: located(document, "`").collect(),
        errors: all_replay_errors_table(document),
        formulas: formulas(document, "`").collect(),
        aliases: aliases(document),
        model: model(document),
        odds: [prior.probability, prior.time_moment_probability, prior.min_named_probability]
            .map(|share| significant(share, 2)),
        prior,
        figures: placed(document, curves, &overshoots, turns),
    };
    Page::new(page.render(), page.figures)
}

/// Figures of a trace under the names of their places in the template.
fn placed(
    document: &TraceDocument,
    curves: &TraceCurves,
    overshoots: &[ReplayedOvershoot],
    turns: Option<&(Vec<SteadyCurve>, ValidityRange)>,
) -> PlacedFigures<&'static str> {
    let mut placed = PlacedFigures::default();
    let mut records = figures::record_figures(document, curves).into_iter();
    let hero = trace_key_figure::trace_key_figure(document, curves);
    match staircase::staircase_figure(document, curves) {
        Some(stairs) => placed.put("first", [stairs]),
        None if hero.is_none() => placed.put("first", records.next()),
        None => {}
    }
    placed.put("overshoots", overshoots::overshoot_figure(document, overshoots));
    placed.put("held out", hero);
    placed.put("held out", held_out::residual_figure(document, curves));
    placed.put("held out", horizon::horizon_figure(document));
    placed.put("records", held_out::error_figure(document).into_iter().chain(records));
    placed.put("evidence", [figures::evidence(document)]);
    placed.put("prior odds", prior_odds::prior_odds_figure(document));
    placed.put("innovations", figures::innovation_figures(document, curves));
    placed.put("moments", figures::moment_figures(document, curves));
    placed.put("further", turns.map(|(curves, seen)| {
        let caption = "Steady yaw rate of the model against rudder, an unstable branch dashed; thin: ships that fit \
            the records as well; grey: the \
                       range of the records.";
        PageFigure::new("steady", stability(curves), caption, steady_turns(curves, *seen))
    }));
    placed.put("further", figures::residual_figures(document, curves));
    placed
}

/// Names of the fitted records, and the kind of the first if its name does not state it.
fn title(document: &TraceDocument, curves: &TraceCurves) -> String {
    let name = document.title();
    let zigzag = curves.records.first().and_then(|record| ZigZag::from_trial(&record.trial).ok());
    let manoeuvre = zigzag.and_then(|zigzag| Some((zigzag.nominal_angles?, zigzag.first_side)));
    let manoeuvre =
        manoeuvre.filter(|(pair, _)| !name.contains(&pair.to_string())).map_or_else(String::new, |(pair, side)| {
            let side = side.map_or_else(String::new, |side| format!(", first to {side}"));
            format!(": a {pair} zig-zag{side}")
        });
    let ship = document.particulars().map_or_else(String::new, |ship| format!(" ({})", scale_name(ship)));
    format!("{name}{manoeuvre}{ship}")
}

/// Physics of the effects of the staircase, a sentence each.
fn physics(document: &TraceDocument) -> Vec<String> {
    let ids = document.staircase.iter().filter_map(|step| step.id.as_deref());
    let sentence = |id| {
        Some(format!("**{}{}**: {}.", names::effect_name(id), unnamed_remark(document, id), names::effect_physics(id)?))
    };
    distinct(ids).into_iter().filter_map(sentence).collect()
}

/// Table of root mean square heading errors and median overshoot errors without and with the effects, on fitted and
/// held-out records.
fn glance(document: &TraceDocument, all: &[ReplayedOvershoot]) -> Table {
    let head =
        TableHead::default().texts(["records"]).numbers(["heading error by K and T", "with effects"]).unit("deg");
    let mut table = Table::new(head.numbers(["overshoot error by K and T", "with effects"]).unit("deg"));
    let error = &document.trace.error;
    let rows = [("fitted", &error.identification, false), ("not fitted", &error.validation, true)];
    for (used, errors, held_out) in rows.into_iter().filter(|(_, errors, _)| !errors.is_empty()) {
        let headings = figures::heading_rms_deg(errors.iter());
        let overshoots = overshoots::overshoot_errors_before_after(all, held_out).map(|error| error.median_deg);
        let numbers = headings.map(Some).into_iter().chain(overshoots);
        let numbers = numbers.map(|number| number.map_or_else(|| MISSING.to_owned(), |number| significant(number, 2)));
        table.push(std::iter::once(format!("{} {used}", errors.len())).chain(numbers));
    }
    table
}

/// Limits of validity of the model, a sentence each.
fn limits(document: &TraceDocument, curves: &TraceCurves) -> Vec<String> {
    let rudder = fixed(to_deg(document.ship.validity_range.rudder_rad), 0);
    let beyond = held_out::beyond_fitted_rudder(document, curves).unwrap_or_default();
    let speed = document.particulars().map_or_else(
        || String::from("Approach speeds other than that of the records."),
        |ship| format!("Approach speeds other than {} m/s.", significant(ship.speed, 3)),
    );
    vec![
        format!("Rudder angles above {rudder}°, the largest in the fitted records.{beyond}"),
        speed,
        String::from("Weather unlike that of the records, and shallow water."),
    ]
}

/// Sentences on every localised moment that is not on the list of effects, with `mark` around a formula.
fn located(document: &TraceDocument, mark: &str) -> impl Iterator<Item = String> {
    document.trace.located.iter().map(move |moment| {
        let only = moment.only.as_ref().map_or_else(String::new, |name| format!(" in {}", names::record_name(name)));
        let or = if moment.alternatives.is_empty() { "" } else { "; equally close: " };
        let typed = match &moment.formula {
            Some(line) => format!("To fit and test it: {mark}--effect \"{line}\"{mark}."),
            None => String::from("This moment has no formula, so it cannot be given as --effect."),
        };
        format!(
            "Not part of the model: a yaw moment that depends on {}{only} ({}), {}° of rudder (rms); it explains the headings better than \
             a random moment{or}{}. {typed}",
            moment.depends_on,
            moment.form,
            significant(moment.rudder_deg, 2),
            moment.alternatives.join(" or "),
        )
    })
}

/// Text below the table of parameters: equations, averages, prime values.
fn model(document: &TraceDocument) -> String {
    let model = &document.trace.model;
    let equations: Vec<String> = model.equations.iter().map(|equation| format!("`{equation}`")).collect();
    let averaged =
        "K, T and δ_r are averages over the models; the other parameters are those of the most probable model.";
    let prime = model.indices.prime.as_ref().and(document.particulars()).map_or_else(String::new, |ship| {
        format!(" Prime values are without dimension, with {}: K′ = K L/V, T′ = T V/L.", scale_name(ship))
    });
    format!("{}. {averaged}{prime}", equations.join(", "))
}

/// Table of effects that these records cannot separate or do not excite.
fn aliases(document: &TraceDocument) -> Table {
    let mut table = Table::new(TableHead::default().texts(["effect", "indistinguishable in these records from"]));
    for effect in document.trace.effects.iter().filter(|effect| !effect.alias_forms.is_empty()) {
        table.push([
            tables::effect_text(&effect.id, &effect.form, effect.only.as_ref()),
            tables::joined_effect_texts(&effect.alias_forms, ", "),
        ]);
    }
    for candidate in
        document.trace.candidates.iter().filter(|candidate| candidate.outcome == CandidateOutcome::NotObservable)
    {
        let why = candidate.reason.as_ref().map_or_else(String::new, |reason| format!(": {reason}"));
        table.push([names::effect_name(&candidate.id), format!("no effect at all (not observable{why})")]);
    }
    table
}

#[cfg(test)]
mod tests {
    use super::*;
    use trial::Quantity;

    #[test]
    fn a_parameter_at_its_bound_is_a_warning() {
        let parameter = |symbol: &str, value, at_bound| ParameterEntry {
            key: String::new(),
            symbol: symbol.into(),
            quantity: Quantity::without_uncertainty(value),
            unit: "1/s".into(),
            prime: None,
            only: None,
            at_bound,
        };
        let all = [parameter("1/T", 10.0, true), parameter("K/T", 0.01, false)];
        assert_eq!(bounds(&all), ["1/T = 10.000 1/s is at the end of its search range; the true value may lie beyond"]);
    }
}
