//! What is said of a trace: the words on the screen, and `report.md`. Both are made from the document.

use askama::Template;
use campaign::statistics::distinct;
use document::identified_ship::ValidityRange;
use document::names;
use document::trace::{Outcome, ParameterEntry, PriorEntry, TraceDocument};
use predict::steady::SteadyCurve;
use report::markdown::text;
use report::number::{MISSING, fixed, significant};
use report::{Page, PageFigure, PlacedFigures, Table, TableHead};
use ship::ShortNumber;
use ship::angle::to_deg;
use ship::vessel::prime::meaning;
use trial::ZigZag;

use super::overshoots::ReplayedOvershoot;
use super::record_figures::{stability, steady_turns};
use super::trace_figures as figures;
use super::trace_hero;
use super::trace_tables as tables;
use super::{first_page, held_out, horizon, indices, overshoots, prior_odds, staircase};
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
    before += &format!("\n{}", indices::of_trace(document).to_text());
    let mut behind = String::new();
    if let Some(all) = &document.single_records {
        behind += &format!("\n{}", indices::of_records(all));
    }
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

/// `report.md`.
#[derive(Template)]
#[template(path = "trace.md", escape = "none")]
struct TracePage<'a> {
    document: &'a TraceDocument,
    title: String,
    /// Ship, day and draughts of the fitted trials.
    particulars: Option<Table>,
    /// The physics of the effects of the staircase, a sentence each.
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
    /// Prior probabilities of an effect and of a moment of time, and the probability from which an effect is named.
    odds: [String; 3],
    figures: PlacedFigures<&'static str>,
}

/// `report.md` with its figures; `turns` are the steady turns of the model. The finding, the figure that shows it and
/// what it is worth on other records come first; what they rest on is folded.
pub fn page(document: &TraceDocument, curves: &TraceCurves, turns: Option<&(Vec<SteadyCurve>, ValidityRange)>) -> Page {
    let (prior, overshoots) = (&document.trace.prior, overshoots::all(document, curves));
    let fitted = document.records.iter().filter(|record| !record.held_out);
    let named = fitted.map(|record| (names::record(&record.name), &record.trial_particulars));
    let page = TracePage {
        document,
        title: title(document, curves),
        particulars: first_page::particulars(named),
        physics: physics(document),
        glance: glance(document, &overshoots),
        limits: limits(document),
        noise: noise(document),
        located: located(document, "`").collect(),
        errors: all_errors(document),
        formulas: formulas(document, "`").collect(),
        aliases: aliases(document),
        model: model(document),
        odds: [prior.probability, prior.probability_of_time, prior.named_from].map(|share| significant(share, 2)),
        prior,
        figures: placed(document, curves, &overshoots, turns),
    };
    Page::new(page.render(), page.figures)
}

/// The figures by the places of the template.
fn placed(
    document: &TraceDocument,
    curves: &TraceCurves,
    overshoots: &[ReplayedOvershoot],
    turns: Option<&(Vec<SteadyCurve>, ValidityRange)>,
) -> PlacedFigures<&'static str> {
    let mut placed = PlacedFigures::default();
    let mut records = figures::records(document, curves).into_iter();
    let hero = trace_hero::figure(document, curves);
    match staircase::figure(document, curves) {
        Some(stairs) => placed.put("first", [stairs]),
        None if hero.is_none() => placed.put("first", records.next()),
        None => {}
    }
    placed.put("overshoots", overshoots::figure(document, overshoots));
    placed.put("held out", hero);
    placed.put("held out", held_out::residuals(document, curves));
    placed.put("held out", horizon::figure(document));
    placed.put("records", held_out::errors(document).into_iter().chain(records));
    placed.put("evidence", [figures::evidence(document)]);
    placed.put("prior odds", prior_odds::figure(document));
    placed.put("innovations", figures::innovations(document, curves));
    placed.put("moments", figures::moments(document, curves));
    placed.put("further", turns.map(|(curves, seen)| {
        let caption = "Steady yaw rate against rudder of the model, an unstable branch dashed; thin: ships that the records \
                       cannot tell from it; grey: the range of the records.";
        PageFigure::new("steady", stability(curves), caption, steady_turns(curves, *seen))
    }));
    placed.put("further", figures::further(document, curves));
    placed
}

/// Names of the fitted records, and what the first of them is where its name does not say it.
fn title(document: &TraceDocument, curves: &TraceCurves) -> String {
    let name = document.title();
    let zigzag = curves.records.first().and_then(|record| ZigZag::of(&record.trial).ok());
    let manoeuvre = zigzag.and_then(|zigzag| Some((zigzag.pair?, zigzag.side)));
    let manoeuvre =
        manoeuvre.filter(|(pair, _)| !name.contains(&pair.to_string())).map_or_else(String::new, |(pair, side)| {
            let side = side.map_or_else(String::new, |side| format!(", first to {side}"));
            format!(": a {pair} zig-zag{side}")
        });
    let ship = document.particulars().map_or_else(String::new, |ship| format!(" ({})", scale_name(ship)));
    format!("{name}{manoeuvre}{ship}")
}

/// The physics of the effects of the staircase, a sentence each.
fn physics(document: &TraceDocument) -> Vec<String> {
    let ids = document.staircase.iter().filter_map(|step| step.id.as_deref());
    let sentence = |id| Some(format!("**{}**: {}.", names::effect(id), names::physics(id)?));
    distinct(ids).into_iter().filter_map(sentence).collect()
}

/// Errors of the heading and of the overshoots without and with the effects, on fitted records and on others.
fn glance(document: &TraceDocument, all: &[ReplayedOvershoot]) -> Table {
    let head =
        TableHead::default().texts(["records"]).numbers(["heading error by K and T", "with effects"]).unit("deg");
    let mut table = Table::new(head.numbers(["overshoot error by K and T", "with effects"]).unit("deg"));
    let error = &document.trace.error;
    let rows = [("fitted", &error.identification, false), ("not fitted", &error.validation, true)];
    for (used, errors, held_out) in rows.into_iter().filter(|(_, errors, _)| !errors.is_empty()) {
        let headings = figures::rms(errors.iter());
        let overshoots = overshoots::errors(all, held_out).map(|error| error.median_deg);
        let numbers = headings.map(Some).into_iter().chain(overshoots);
        let numbers = numbers.map(|number| number.map_or_else(|| MISSING.to_owned(), |number| significant(number, 2)));
        table.push(std::iter::once(format!("{} {used}", errors.len())).chain(numbers));
    }
    table
}

/// What the model is not for, a sentence each.
fn limits(document: &TraceDocument) -> Vec<String> {
    let rudder = fixed(to_deg(document.ship.seen.rudder_rad), 0);
    let largest = document
        .trace
        .error
        .validation
        .iter()
        .max_by(|one, other| one.after.heading_rmse_deg.total_cmp(&other.after.heading_rmse_deg));
    let worst = largest.and_then(|errors| {
        let name = document.records.iter().find(|record| record.file == errors.file).map(|record| &record.name)?;
        let degrees = significant(errors.after.heading_rmse_deg, 2);
        Some(format!(" The record that it foretells worst is {}: {degrees}° of heading.", text(&names::record(name))))
    });
    let speed = document.particulars().map_or_else(
        || String::from("Another approach speed than that of the records."),
        |ship| format!("Another approach speed than {} m/s.", ShortNumber(ship.speed)),
    );
    vec![
        format!("Rudder beyond {rudder}°, the largest of the fitted records.{}", worst.unwrap_or_default()),
        speed,
        String::from("Weather of another kind than that of the records, and shallow water."),
    ]
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
