//! The page of a fit: what was read, the answers, what was measured, and the figures.

use askama::Template;
use document::fit::{FitDocument, Reason, ResidualKind, VerdictEntry, ZigZagEntry};
use document::method::MethodEntry;
use document::names;
use report::markdown::text;
use report::number::{MISSING, fixed, optional, with_uncertainty};
use report::{Page, PlacedFigures, Table};
use trial::Quantity;

use super::bench_figures::capital;
use super::{circle, first_page, fit_figures, indices, method_table, predict_form, scale_tables};
use crate::documents::fit_curves::FitCurves;
use crate::documents::prior;
use crate::scales::scale_name;
use crate::work::every_scale::PREFERRED_METHODS;

/// Stem of the figure that begins the page: every answer replayed on the first record.
const FIRST: &str = "replays";

/// `report.md`.
#[derive(Template)]
#[template(path = "fit.md", escape = "none")]
struct FitPage<'a> {
    title: String,
    /// Ship, day and draughts of the trials.
    particulars: Option<Table>,
    verdict: Option<String>,
    /// Paragraphs below the verdict.
    lines: Vec<String>,
    /// What the records measure of the criteria of IMO.
    criteria: Option<Table>,
    /// A sentence for every turning circle.
    circles: Vec<String>,
    /// The form of MSC/Circ.1053: what is declared, the tests, and remarks.
    form: Option<(Vec<(&'a str, Table)>, Table)>,
    /// What the form says beside its entries, and the mark of its headlines.
    form_remarks: &'a [String],
    mark: &'static str,
    answers: Table,
    /// K and T of every record alone, where there are several.
    records: Option<Table>,
    warnings: Vec<String>,
    /// Lines on the records, each with what it is indented by.
    notes: Vec<(&'static str, String)>,
    scales: Vec<(String, Option<Table>)>,
    remarks: Vec<String>,
    figures: PlacedFigures<&'static str>,
}

/// `report.md` with its figures.
pub fn page(document: &FitDocument, curves: &FitCurves) -> Page {
    let (mut first, mut others) = (Vec::new(), Vec::new());
    for figure in fit_figures::figures(document, curves) {
        // The answers over the first record tell most; every other figure can wait.
        if figure.stem == FIRST { first.push(figure) } else { others.push(figure) }
    }
    let mut figures = PlacedFigures::default();
    figures.put("first", first);
    figures.put("others", others);
    figures.put("circle", circle::figure(document, curves));
    let words = verdict(document).unwrap_or_default() + "\n" + &headline(document, curves);
    let mut lines = words.lines().map(str::to_owned);
    let notes = notes(document, curves);
    let note = |line: &str| (if line.starts_with("  ") { "  " } else { "" }, line.trim().to_owned());
    let has_form = !document.form.is_empty();
    let names = curves.records.iter().map(|record| names::record(&record.name));
    let named = names.zip(document.trials.iter().map(|trial| &trial.trial_particulars));
    let page = FitPage {
        title: title(document, curves),
        particulars: first_page::particulars(named),
        verdict: document.verdict.as_ref().and_then(|_| lines.next()),
        lines: lines.filter(|line| !line.is_empty()).collect(),
        criteria: has_form.then(|| predict_form::criteria(&document.form)),
        circles: circle::sentences(document, curves),
        form: has_form.then(|| predict_form::tables(&document.form)),
        form_remarks: &document.form_remarks,
        mark: "###",
        answers: answers(document, curves),
        records: document.single_records.as_ref().map(indices::records),
        warnings: document.of_answer().map(ToString::to_string).collect(),
        notes: notes.lines().filter(|line| !line.trim().is_empty()).map(note).collect(),
        scales: scales(document),
        remarks: document.notes().map(ToString::to_string).collect(),
        figures,
    };
    Page::new(page.render(), page.figures)
}

/// The records, and the scale of the ship where it is known.
fn title(document: &FitDocument, curves: &FitCurves) -> String {
    let records = match (&document.trials[..], curves.records.first()) {
        ([_], Some(record)) => names::record(&record.name),
        (several, _) => format!("{} records", several.len()),
    };
    let ship = document.particulars().map_or_else(String::new, |ship| format!(" ({})", scale_name(ship)));
    format!("{records}{ship}")
}

/// What follows the table on the screen.
pub fn rest(document: &FitDocument, curves: &FitCurves) -> String {
    let mut rest = notes(document, curves);
    for (words, table) in scales(document) {
        rest += &format!("\n{words}\n{}", table.map_or_else(String::new, |table| table.to_text()));
    }
    rest
}

/// The answers of all methods.
pub fn answers(document: &FitDocument, curves: &FitCurves) -> Table {
    let validated = curves.records.iter().filter(|record| record.validation);
    method_table::table(&document.methods, &validated.map(|record| names::record(&record.name)).collect::<Vec<_>>())
}

/// Which answer to take, and whether to believe it.
pub fn verdict(document: &FitDocument) -> Option<String> {
    let verdict = document.verdict.as_ref()?;
    let entry = document.methods.iter().find(|entry| entry.method == verdict.method)?;
    let own = entry.parameters.as_ref()?;
    let [k, t, bias] =
        [own.k_per_s, own.t_s, own.delta_r_deg].map(|quantity| method_table::estimate(&quantity)[0].clone());
    if let Some(because) = &verdict.because {
        let trial = match &document.trials[..] {
            [only] if only.zigzag.is_some() => "this zig-zag",
            [_] => "this record",
            _ => "these records",
        };
        let advice = match &document.single_records {
            Some(all) if all.agree == Some(false) => {
                format!(
                    "{} Take those of each record, or have `study trace` fit them together.",
                    indices::of_records(all)
                )
            }
            _ => String::from(
                "Check rudder, heading and clock first, which the warnings may name; then give a zig-zag in calm weather.",
            ),
        };
        return Some(format!("No K and T can be taken from {trial}, because {because}.\n{advice}"));
    }
    let because = match verdict.reason {
        Reason::NearestReplay => "its replay is the nearest to the headings",
        Reason::RandomMoment => "a random moment acts on the ship that no term of a ship explains",
        Reason::RudderNoise => "the recorded rudder is noisy",
        Reason::HeadingJumps => "the heading jumps and stays off, which it estimates",
    };
    let mut words = format!("Take K = {k} 1/s, T = {t} s, δ_r = {bias}° from {}, because {because}.", verdict.method);
    let amplitude = indices::of_amplitude(document.amplitude.as_ref());
    words += &if amplitude.is_empty() { String::new() } else { format!("\n{amplitude}") };
    words += &residual(document, verdict);
    words +=
        &document.single_records.as_ref().map_or_else(String::new, |all| format!("\n{}", indices::of_records(all)));
    words += &contradiction(document, verdict);
    if !verdict.set_apart.is_empty() {
        words += &format!("\nMore than ten times as far from the headings are: {}.", verdict.set_apart.join(", "));
    }
    Some(words)
}

/// What the residual of output error is, and whether most of it goes with a late rudder.
fn residual(document: &FitDocument, verdict: &VerdictEntry) -> String {
    let [residual, rest] = [verdict.residual_deg, verdict.with_ship_terms_deg].map(|deg| optional(deg, 2));
    let mut words = match verdict.residual {
        None => String::new(),
        Some(ResidualKind::Noise) => String::from("\nThe residual of output error is noise of the heading."),
        Some(ResidualKind::LacksEffect) if document.has_faulty_readings() => format!(
            "\nThe residual of output error, {residual}°, falls to {rest}° with more terms of a hull, but the readings are suspected \
             before the ship: see the warnings."
        ),
        Some(ResidualKind::LacksEffect) if !verdict.falls_with_ship_terms() => format!(
            "\nThe residual of output error, {residual}°, is no noise, and the records declare a calm: the model may lack an effect, which \
             `study trace` looks for."
        ),
        Some(ResidualKind::LacksEffect) => format!(
            "\nThe residual of output error, {residual}°, falls to {rest}° with more terms of a hull: the model may lack an \
             effect, which `study trace` looks for; it has K and T of small motions, too."
        ),
        Some(ResidualKind::Random) => {
            format!("\nThe residual of output error, {residual}°, is random: more terms of a hull leave {rest}° of it.")
        }
    };
    if let Some(delay) = verdict.rudder_delay_s {
        words += &match fixed(delay.abs(), 1) {
            late if delay < 0.0 => format!(
                "\nMost of the residual goes with a rudder that was recorded about {late} s late: check the clocks, or write `late-s = {late}` \
                 under [rudder] in the sidecar."
            ),
            later => format!(
                "\nMost of the residual goes with a rudder that acts about {later} s later than it was recorded: a dead time or the second \
                 order of the ship, a slow compass, or the order in place of the angle."
            ),
        };
    }
    words
}

/// Why the other one of output error and maximum likelihood has another answer.
fn contradiction(document: &FitDocument, verdict: &VerdictEntry) -> String {
    let other = verdict.contradicted_by.as_ref();
    let Some(other) = document.methods.iter().find(|entry| Some(&entry.method) == other) else { return String::new() };
    let name = &other.method;
    let has_moment = other.noise.is_some_and(|noise| !noise.moment.is_none());
    let why = match verdict.reason {
        Reason::NearestReplay if has_moment => "a random moment explains part of the manoeuvre in it",
        Reason::NearestReplay => "look at both replays",
        Reason::RandomMoment => "it takes what the random moment does for the work of the rudder",
        Reason::RudderNoise => "it knows no noise of the rudder",
        Reason::HeadingJumps => "it takes jumps of the heading for turns of the ship",
    };
    format!("\n{name} contradicts this answer: {why}.")
}

/// What was read.
pub fn headline(document: &FitDocument, curves: &FitCurves) -> String {
    let rows: usize = document.trials.iter().map(|trial| trial.samples).sum();
    let head = match (&document.trials[..], curves.records.first()) {
        ([only], Some(record)) => format!("{}: {rows} rows, {:.1} s", names::record(&record.name), only.duration_s),
        (several, _) => format!("{} records together: {rows} rows", several.len()),
    };
    let prior = document.earlier_trials.as_ref().map(prior::sentence);
    let sentences = document.scaling.iter().cloned().chain(prior);
    sentences.fold(head, |head, sentence| format!("{head}\n{sentence}"))
}

/// Which record is meant where several have the same name, why methods failed, and the characteristics of the records.
fn notes(document: &FitDocument, curves: &FitCurves) -> String {
    let renamed = curves.records.iter().filter(|record| record.is_renamed);
    let renamed =
        renamed.map(|record| format!("{} is {}\n", names::record(&record.name), record.file)).collect::<String>();
    let failed = |entry: &MethodEntry| Some(format!("{} failed: {}\n", entry.method, entry.reason.as_ref()?));
    let failed = document.methods.iter().filter_map(failed).collect::<String>();
    let mut notes: String =
        [renamed, failed].into_iter().filter(|lines| !lines.is_empty()).map(|lines| format!("\n{lines}")).collect();
    for (entry, record) in document.trials.iter().zip(&curves.records) {
        let of = if document.trials.len() > 1 { format!("{}: ", names::record(&record.name)) } else { String::new() };
        match (&entry.zigzag, &entry.no_zigzag) {
            (Some(zigzag), _) => notes += &format!("\n{of}{}", characteristics(zigzag)),
            (None, _) if entry.circle.is_some() => {
                let circle = entry.circle.iter().map(|turn| circle::sentence(&names::record(&record.name), turn));
                notes += &circle.map(|words| format!("\n{words}\n")).collect::<String>();
            }
            (None, Some(why)) => notes += &format!("\n{of}no zig-zag characteristics: {why}\n"),
            (None, None) => {}
        }
    }
    notes
}

/// K' and T' of every method, and which terms scale: words, and the table under them.
fn scales(document: &FitDocument) -> Vec<(String, Option<Table>)> {
    let mut parts = Vec::new();
    let prime = |entry: &MethodEntry| entry.prime.map(|prime| (entry.method.clone(), prime.K, prime.T));
    let rows: Vec<(String, Quantity, Quantity)> = document.methods.iter().filter_map(prime).collect();
    if let Some(ship) = document.particulars().filter(|_| !rows.is_empty()) {
        let words = format!("prime indices K′ = K L/V, T′ = T V/L with {}", scale_name(ship));
        parts.push((words, Some(scale_tables::prime_table(&rows))));
    }
    let Some(scales) = &document.scales else { return parts };
    let speaker = PREFERRED_METHODS.iter().find_map(|id| scales.comparisons.iter().find(|one| one.model == *id));
    if let Some(model) = speaker.or(scales.comparisons.first()) {
        let words = format!("every scale alone, {}: {}", model.model, scale_tables::sentence(model));
        parts.push((words, Some(scale_tables::table(scales, model))));
        let words = "a first-order response that lacks something differs between manoeuvres, too; `study trace` tells the \
                     two apart";
        parts.push((words.to_owned(), None));
    }
    parts
}

/// Most overshoots that are written on the screen.
const MOST_LISTED: usize = 12;

/// Characteristics in words, and the IMO criteria this record measures; of very many overshoots the first.
fn characteristics(entry: &ZigZagEntry) -> String {
    let overshoots = entry.overshoots_deg.iter().zip(&entry.overshoots_sd_deg).take(MOST_LISTED);
    let words = |(&angle, &sd): (&Option<f64>, &Option<f64>)| {
        angle.map_or_else(|| MISSING.to_owned(), |angle| with_uncertainty(angle, sd))
    };
    let overshoots: Vec<String> = overshoots.map(words).collect();
    let overshoots = match entry.overshoots_deg.len().saturating_sub(MOST_LISTED) {
        0 if overshoots.is_empty() => "none".to_owned(),
        0 => format!("{} deg", overshoots.join(", ")),
        more => format!("{} deg, and {more} more in fit.json", overshoots.join(", ")),
    };
    let mut text = format!("zig-zag: initial turning time {}", seconds(entry.initial_turning_time_s, 2));
    text += &format!(", period {}\n  overshoots {overshoots}\n", seconds(entry.period_s, 1));
    if entry.imo.is_empty() && !entry.overshoots_deg.is_empty() {
        text += "  IMO: not compared, length and speed of the ship are not known; give --length-m and --speed-kn\n";
    }
    if !entry.imo.is_empty() && entry.imo.iter().all(|criterion| criterion.measured.is_none()) {
        text += "  IMO: this record measures none of the criteria, which are for zig-zags 10/10 and 20/20 from a straight course\n";
    }
    let measured: Vec<_> = entry.imo.iter().filter(|criterion| criterion.measured.is_some()).collect();
    if let Some(caution) = entry.imo_caution.as_ref().filter(|_| !measured.is_empty()) {
        text += &format!("  IMO: {caution}\n");
    }
    for criterion in measured {
        text += &format!(
            "  IMO {}: {} {}, limit {}: {}\n",
            criterion.criterion,
            optional(criterion.measured, 2),
            criterion.unit,
            fixed(criterion.limit, 1),
            criterion.verdict
        );
    }
    text
}

fn seconds(value: Option<f64>, decimals: usize) -> String {
    value.map_or_else(|| "not measured".to_owned(), |value| format!("{} s", fixed(value, decimals)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn very_many_overshoots_are_not_all_written_on_the_screen() {
        let entry = |count: usize| ZigZagEntry {
            initial_turning_time_s: None,
            overshoots_deg: vec![Some(8.25); count],
            overshoots_sd_deg: vec![None; count],
            period_s: None,
            imo: Vec::new(),
            imo_caution: None,
        };
        assert!(characteristics(&entry(0)).contains("overshoots none"));
        assert_eq!(characteristics(&entry(12)).matches("8.2").count(), 12);
        let many = characteristics(&entry(3000));
        assert!(many.contains("and 2988 more in fit.json") && many.len() < 400, "{many}");
    }
}
