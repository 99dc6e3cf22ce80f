//! What is said of a trace: the words on the screen, and `report.md`. Both are made from the document.

use std::fmt::Write as _;

use ::trace::document::{Outcome, ParameterEntry};
use report::markdown::prose;
use report::number::{fixed, significant};
use report::{Column, Table};
use ship::Shown;

use super::trace_figures::{Drawn, Part};
use super::trace_tables as tables;
use crate::documents::trace::TraceDocument;
use crate::scales::scale_name;

/// Readings that are listed.
const LISTED: usize = 8;

/// The words on the screen before and behind the table of errors.
pub fn words(document: &TraceDocument) -> [String; 2] {
    let trace = &document.trace;
    let mut before = format!("{}\n", trace.headline);
    if let Some(scales) = &document.scales {
        let _ = writeln!(before, "{scales}");
    }
    if !trace.effects.is_empty() {
        let _ = write!(before, "\n{}", tables::effects(document).to_text());
    }
    let mut behind = format!("\nnoise: {}", noise(document));
    if let Some(signature) = &trace.unexplained.signature {
        let _ = write!(behind, "\nleft: {signature}");
    }
    for warning in bounds(&trace.model.parameters).into_iter().chain(outliers(document)) {
        let _ = write!(behind, "\nwarning: {warning}");
    }
    let _ = write!(behind, "\nnext trial: {}", trace.next_trial);
    [before, behind]
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
        let mut shown: Vec<String> = times.iter().take(LISTED).map(|t| Shown(*t).to_string()).collect();
        shown.extend((times.len() > LISTED).then(|| String::from("…")));
        format!("{file}: {} headings stand alone and are left out, at t = {} s", times.len(), shown.join(", "))
    };
    spoilt.map(|own| of((&own.file, &own.outliers_s))).collect()
}

/// A sentence for every parameter at an end of its range.
fn bounds(parameters: &[ParameterEntry]) -> Vec<String> {
    let of = |own: &ParameterEntry| {
        let only = own.only.as_ref().map_or_else(String::new, |name| format!(" of {name}"));
        format!("{}{only} is at its bound: the search ends there", tables::value(own))
    };
    parameters.iter().filter(|own| own.at_bound).map(of).collect()
}

/// A page that grows.
struct Page(String);

impl Page {
    fn say(&mut self, text: impl AsRef<str>) {
        self.0 += text.as_ref();
        self.0 += "\n\n";
    }

    fn table(&mut self, title: &str, table: &Table, words: &str) {
        self.say(format!("## {title}\n\n{}", table.to_markdown()));
        if !words.is_empty() {
            self.say(words);
        }
    }

    /// The figures of a part, under a title where it has one.
    fn figures(&mut self, part: Part, title: &str, drawn: &[Drawn]) {
        let own = || drawn.iter().filter(|one| one.part == part);
        if !title.is_empty() && own().next().is_some() {
            self.say(format!("## {title}"));
        }
        for Drawn { stem, caption, .. } in own() {
            self.say(format!("![{caption}]({stem}.png)\n\n{caption}"));
        }
    }
}

const JUDGED: &str = "Nothing but the initial state is fitted to a record here. *Held out*: no number above depends \
                      on the record. *Left out*: base and model are fitted to the other records. *Every 20 s*: the \
                      replay begins anew so often.";

const EVIDENCE: &str = "The probability of an effect is the weight of all structures that have it. ΔBIC is −2 log of \
                        the ratio of the evidence with the effect to that without: negative where the effect helps. \
                        An effect is named where its probability, or that of the group it cannot be told from, is \
                        high enough.";

const CANDIDATES: &str = "Visibility is the expected square of the size of an effect over its error beside all other \
                          candidates: what is small here cannot be seen in these records.";

/// `report.md`. `drawn` are the figures.
pub fn page(document: &TraceDocument, drawn: &[Drawn]) -> String {
    let trace = &document.trace;
    let mut page = Page(String::new());
    page.say(format!("# Trace of {}\n\n**{}**", document.title(), trace.headline));
    if let Some(scales) = &document.scales {
        page.say(format!("{scales}."));
    }
    page.figures(Part::Record, "", drawn);
    let (fitted, judged) = document.errors();
    if !judged.is_empty() {
        page.table("Records that were not fitted", &tables::errors(&judged), JUDGED);
        page.figures(Part::HeldOut, "", drawn);
    }
    page.figures(Part::Evidence, "Evidence", drawn);
    page.table("Structures", &tables::structures(document), EVIDENCE);
    page.say(format!(
        "{} candidates; prior probability of an effect {}, of a moment of time in one record {}; rule: {}.",
        trace.prior.candidates,
        significant(trace.prior.probability, 2),
        significant(trace.prior.probability_of_time, 2),
        trace.prior.rule,
    ));
    if !trace.effects.is_empty() {
        page.table("Effects", &tables::effects(document), "");
    }
    for effect in &trace.effects {
        page.say(format!("**{} ({})**: `{}`. {}", effect.id, effect.form, effect.equation, effect.evidence));
    }
    page.table("Fitted records", &tables::errors(&fitted), "");
    page.table("Candidates", &tables::candidates(document), CANDIDATES);
    page.table("Noise", &tables::noise(document), "");
    page.table("Model", &tables::parameters(document), &model(document));
    if let Some(signature) = &trace.unexplained.signature {
        page.say(format!("## What is left\n\n{signature}."));
    }
    if let Some(own) = &trace.unexplained.empirical {
        let values: Vec<String> = own.parameters.iter().map(tables::value).collect();
        page.say(format!(
            "Not part of the model: a moment of this shape would lower the heading error to {}° (ΔBIC {}): {}; {}.",
            significant(own.heading_rmse_deg, 2),
            fixed(own.delta_bic, 0),
            own.terms.join(" or "),
            values.join(", ")
        ));
    }
    page.table("Aliases and blind spots", &aliases(document), "");
    page.say(format!("## Next trial\n\n{}", trace.next_trial));
    page.figures(Part::Moment, "The yaw moment that the base lacks", drawn);
    page.figures(Part::Further, "Further figures", drawn);
    prose(&(page.0.trim_end().to_owned() + "\n"))
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
    let mut table = Table::new([Column::left("effect"), Column::left("these records cannot tell it from")]);
    for effect in document.trace.effects.iter().filter(|effect| !effect.alias_forms.is_empty()) {
        table.push([tables::term(&effect.id, &effect.form, effect.only.as_ref()), effect.alias_forms.join(", ")]);
    }
    for one in document.trace.candidates.iter().filter(|one| one.outcome == Outcome::NotObservable) {
        let why = one.reason.as_ref().map_or_else(String::new, |reason| format!(": {reason}"));
        table.push([one.id.clone(), format!("nothing (not observable{why})")]);
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
