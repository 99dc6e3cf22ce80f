//! Page of a fit: records, estimates, measured characteristics, and figures.

use askama::Template;
use document::fit::{FitDocument, ResidualKind, VerdictEntry, VerdictReason, ZigZagEntry};
use document::method::MethodEntry;
use document::names;
use report::markdown::{escaped_sentence, escaped_text};
use report::number::{MISSING, fixed, optional, with_uncertainty};
use report::{Page, PlacedFigures, Table};
use trial::Quantity;

use super::bench_figures::capital;
use super::{circle, first_page, fit_figures, indices, method_table, predict_form, scale_tables};
use crate::documents::fit_curves::FitCurves;
use crate::documents::prior;
use crate::scales::scale_name;
use crate::work::scale_comparison::PREFERRED_METHODS;

/// Stem of the first figure of the page: the replays of every estimate on the first record.
const FIRST: &str = "replays";

/// Template of `report.md`.
#[derive(Template)]
#[template(path = "fit.md", escape = "none")]
struct FitPage<'a> {
    title: String,
    /// Ship, date and draughts of the trials.
    particulars: Option<Table>,
    verdict: Option<String>,
    /// Paragraphs below the verdict.
    lines: Vec<String>,
    /// Measured IMO criteria.
    criteria: Option<Table>,
    /// Sentence on every turning circle.
    circles: Vec<String>,
    /// The form of MSC/Circ.1053: its parts with declared entries, and its tests; `None` if the records measure none of
    /// these.
    form: Option<(Vec<(&'a str, Table)>, Table)>,
    /// Remarks of the form.
    form_remarks: &'a [String],
    /// Mark before the headings of the form.
    mark: &'static str,
    answers: Table,
    /// K and T of every record alone, if there are several.
    records: Option<Table>,
    warnings: Vec<String>,
    /// Lines on the records, each with its indentation.
    notes: Vec<(&'static str, String)>,
    scales: Vec<(String, Option<Table>)>,
    remarks: Vec<String>,
    figures: PlacedFigures<&'static str>,
}

/// Content of `report.md` with its figures.
pub fn page(document: &FitDocument, curves: &FitCurves) -> Page {
    let (mut first, mut folded) = (Vec::new(), Vec::new());
    for figure in fit_figures::figures(document, curves) {
        // The replays on the first record are the most informative figure; the others are folded.
        if figure.stem == FIRST { first.push(figure) } else { folded.push(figure) }
    }
    let mut figures = PlacedFigures::default();
    figures.put("first", first);
    figures.put("folded", folded);
    figures.put("circle", circle::circle_figure(document, curves));
    let verdict_lines = fit_verdict(document).unwrap_or_default() + "\n" + &fit_headline(document, curves);
    let mut lines = verdict_lines.lines().map(str::to_owned);
    let notes = notes(document, curves);
    let note = |line: &str| (if line.starts_with("  ") { "  " } else { "" }, line.trim().to_owned());
    let has_form = !document.form.is_empty();
    let names = curves.records.iter().map(|record| names::record_name(&record.name));
    let named = names.zip(document.trials.iter().map(|trial| &trial.trial_particulars));
    let page = FitPage {
        title: title(document, curves),
        particulars: first_page::particulars_table(named),
        verdict: document.verdict.as_ref().and_then(|_| lines.next()),
        lines: lines.filter(|line| !line.is_empty()).collect(),
        criteria: has_form.then(|| predict_form::form_criterion_table(&document.form)),
        circles: circle::circle_sentences(document, curves),
        form: has_form.then(|| predict_form::form_tables(&document.form)),
        form_remarks: &document.form_remarks,
        mark: "###",
        answers: answer_table(document, curves),
        records: document.single_records.as_ref().map(indices::single_record_table),
        warnings: document.verdict_warnings().map(ToString::to_string).collect(),
        notes: notes.lines().filter(|line| !line.trim().is_empty()).map(note).collect(),
        scales: scales(document),
        remarks: document.other_warnings().map(ToString::to_string).collect(),
        figures,
    };
    Page::new(page.render(), page.figures)
}

/// Name of the record, or number of the records, with the scale of the ship if it is known.
fn title(document: &FitDocument, curves: &FitCurves) -> String {
    let records = match (&document.trials[..], curves.records.first()) {
        ([_], Some(record)) => names::record_name(&record.name),
        (several, _) => format!("{} records", several.len()),
    };
    let ship = document.particulars().map_or_else(String::new, |ship| format!(" ({})", scale_name(ship)));
    format!("{records}{ship}")
}

/// Text below the table on the screen: characteristics of the records, prime indices, comparison of scales.
pub fn text_below_table(document: &FitDocument, curves: &FitCurves) -> String {
    let mut below_table = notes(document, curves);
    for (scale_sentence, table) in scales(document) {
        below_table += &format!("\n{scale_sentence}\n{}", table.map_or_else(String::new, |table| table.to_text()));
    }
    below_table
}

/// Table of the estimates of all methods.
pub fn answer_table(document: &FitDocument, curves: &FitCurves) -> Table {
    let validated = curves.records.iter().filter(|record| record.validation);
    method_table::table(
        &document.methods,
        &validated.map(|record| names::record_name(&record.name)).collect::<Vec<_>>(),
    )
}

/// Verdict: recommended K, T and δ_r with the reason; or the reason why there is no recommendation. `None` if the
/// document has no verdict.
pub fn fit_verdict(document: &FitDocument) -> Option<String> {
    let verdict = document.verdict.as_ref()?;
    let entry = document.methods.iter().find(|entry| entry.method == verdict.method)?;
    let estimates = entry.parameters.as_ref()?;
    let [k, t, bias] = [estimates.k_per_s, estimates.t_s, estimates.delta_r_deg]
        .map(|quantity| method_table::estimate_and_interval(&quantity)[0].clone());
    if let Some(because) = &verdict.because {
        let trial = match &document.trials[..] {
            [only] if only.zigzag.is_some() => "this zig-zag",
            [_] => "this record",
            _ => "these records",
        };
        let advice = match &document.single_records {
            Some(all) if all.is_consistent == Some(false) => {
                format!(
                    "{} Use K and T of each record, or fit the records together with `study trace`.",
                    indices::range_sentence(all)
                )
            }
            _ if !document.methods.iter().any(|entry| identify::verdict::REFERENCE_METHODS.contains(&entry.id())) => {
                String::from("Leave out --method to ask the usual methods, too.")
            }
            _ => String::from(
                "Check rudder, heading and clock first (see the warnings); then record a zig-zag in calm weather.",
            ),
        };
        return Some(format!("No K and T can be taken from {trial}, because {because}.\n{advice}"));
    }
    let because = match verdict.reason {
        VerdictReason::NearestReplay => "its replay is closest to the recorded headings",
        VerdictReason::RandomMoment => {
            "random yaw moments (gusts, waves) act on the ship, and this method allows for them"
        }
        VerdictReason::RudderNoise => "the recorded rudder is noisy, and this method allows for it",
        VerdictReason::HeadingJumps => "the recorded heading jumps, and this method estimates the jumps",
    };
    let mut text = format!("Take K = {k} 1/s, T = {t} s, δ_r = {bias}° from {}, because {because}.", verdict.method);
    let amplitude = indices::amplitude_sentence(document.amplitude.as_ref());
    text += &if amplitude.is_empty() { String::new() } else { format!("\n{amplitude}") };
    text += &residual(document, verdict);
    text +=
        &document.single_records.as_ref().map_or_else(String::new, |all| format!("\n{}", indices::range_sentence(all)));
    text += &contradiction(document, verdict);
    if !verdict.far_off_methods.is_empty() {
        text += &format!("\nReplay error more than ten times larger: {}.", verdict.far_off_methods.join(", "));
    }
    Some(text)
}

/// Nature of the residual of output error: noise, a missing effect or random moments, and a late rudder as its cause.
fn residual(document: &FitDocument, verdict: &VerdictEntry) -> String {
    let [residual, with_terms] = [verdict.residual_deg, verdict.with_ship_terms_deg].map(|deg| optional(deg, 2));
    let mut sentences = match verdict.residual {
        None => String::new(),
        Some(ResidualKind::Noise) => String::from("\nThe output-error residual is noise of the heading sensor."),
        Some(ResidualKind::LacksEffect) if document.has_faulty_readings() => format!(
            "\nThe output-error residual falls from {residual}° to {with_terms}° with more hull terms, but check the readings before \
             the ship: see the warnings."
        ),
        Some(ResidualKind::LacksEffect) if !verdict.improves_with_ship_terms() => format!(
            "\nThe output-error residual, {residual}°, is more than noise although a calm is declared: the model may lack an \
             effect; run `study trace`."
        ),
        Some(ResidualKind::LacksEffect) => format!(
            "\nThe output-error residual falls from {residual}° to {with_terms}° with more hull terms: the model may lack an \
             effect; run `study trace`, which also gives K and T for small motions."
        ),
        Some(ResidualKind::Random) => {
            format!("\nThe output-error residual, {residual}°, looks random: more hull terms leave {with_terms}°.")
        }
    };
    if let Some(delay) = verdict.rudder_delay_s {
        sentences += &match fixed(delay.abs(), 1) {
            late if delay < 0.0 => format!(
                "\nMost of this residual disappears if the rudder was recorded about {late} s late: check the clocks, \
                 or write `late-s = {late}` \
                 under [rudder] in the sidecar."
            ),
            later => format!(
                "\nMost of this residual disappears if the rudder acts about {later} s later than it was recorded. Possible causes: a dead \
                 time, sway coupling of the ship, a slow compass, or the order in place of the angle."
            ),
        };
    }
    sentences
}

/// Sentence on output error or maximum likelihood if its estimate contradicts the verdict, with the reason; else empty.
fn contradiction(document: &FitDocument, verdict: &VerdictEntry) -> String {
    let other = verdict.contradicted_by.as_ref();
    let Some(other) = document.methods.iter().find(|entry| Some(&entry.method) == other) else { return String::new() };
    let name = &other.method;
    let has_moment = other.noise.is_some_and(|noise| !noise.moment.is_none());
    let why = match verdict.reason {
        VerdictReason::NearestReplay if has_moment => "it explains part of the manoeuvre as random gusts",
        VerdictReason::NearestReplay => "its answer differs; compare both replays",
        VerdictReason::RandomMoment => "it attributes the random yaw moments to the rudder",
        VerdictReason::RudderNoise => "it does not allow for noise of the rudder",
        VerdictReason::HeadingJumps => "it takes jumps of the heading for turns of the ship",
    };
    format!("\nNot used: {name}, because {why}.")
}

/// Name, number of rows and duration of the record, or number of records and rows; the common scale, and the check
/// against earlier trials.
pub fn fit_headline(document: &FitDocument, curves: &FitCurves) -> String {
    let rows: usize = document.trials.iter().map(|trial| trial.samples).sum();
    let head = match (&document.trials[..], curves.records.first()) {
        ([only], Some(record)) => {
            format!("{}: {rows} rows, {:.1} s", names::record_name(&record.name), only.duration_s)
        }
        (several, _) => format!("{} records together: {rows} rows", several.len()),
    };
    let prior = document.earlier_trials.as_ref().map(prior::earlier_trials_sentence);
    let sentences = document.scaling.iter().cloned().chain(prior);
    sentences.fold(head, |head, sentence| format!("{head}\n{sentence}"))
}

/// Files of renamed records, reasons of failed methods, and zig-zag characteristics of the records.
fn notes(document: &FitDocument, curves: &FitCurves) -> String {
    let renamed = curves.records.iter().filter(|record| record.is_renamed);
    let renamed = renamed.map(|run| format!("{} is {}\n", names::record_name(&run.name), run.file)).collect::<String>();
    let failed = |entry: &MethodEntry| Some(format!("{} failed: {}\n", entry.method, entry.reason.as_ref()?));
    let failed = document.methods.iter().filter_map(failed).collect::<String>();
    let mut notes: String =
        [renamed, failed].into_iter().filter(|lines| !lines.is_empty()).map(|lines| format!("\n{lines}")).collect();
    for (entry, record) in document.trials.iter().zip(&curves.records) {
        let head =
            if document.trials.len() > 1 { format!("{}: ", names::record_name(&record.name)) } else { String::new() };
        match (&entry.zigzag, &entry.no_zigzag) {
            (Some(zigzag), _) => notes += &format!("\n{head}{}", characteristics(zigzag)),
            (None, _) if entry.circle.is_some() => {
                let circle =
                    entry.circle.iter().map(|turn| circle::circle_sentence(&names::record_name(&record.name), turn));
                notes += &circle.map(|sentence| format!("\n{sentence}\n")).collect::<String>();
            }
            (None, Some(why)) => notes += &format!("\n{head}no zig-zag characteristics: {why}\n"),
            (None, None) => {}
        }
    }
    notes
}

/// Prime indices of every method and the terms that scale: sentences with their tables.
fn scales(document: &FitDocument) -> Vec<(String, Option<Table>)> {
    let mut parts = Vec::new();
    let prime = |entry: &MethodEntry| entry.prime.map(|prime| (entry.method.clone(), prime.K, prime.T));
    let rows: Vec<(String, Quantity, Quantity)> = document.methods.iter().filter_map(prime).collect();
    if let Some(ship) = document.particulars().filter(|_| !rows.is_empty()) {
        let sentence = format!("prime indices K′ = K L/V, T′ = T V/L with {}", scale_name(ship));
        parts.push((sentence, Some(scale_tables::prime_table(&rows))));
    }
    let Some(scales) = &document.scales else { return parts };
    let speaker = PREFERRED_METHODS.iter().find_map(|id| scales.comparisons.iter().find(|model| model.model == *id));
    if let Some(model) = speaker.or(scales.comparisons.first()) {
        let sentence =
            format!("each scale fitted alone ({}): {}", model.model, scale_tables::scaling_terms_sentence(model));
        parts.push((sentence, Some(scale_tables::table(scales, model))));
        let sentence = "K and T of a first-order response also differ between manoeuvres where it lacks an effect; \
            `study trace` separates the \
                     two";
        parts.push((sentence.to_owned(), None));
    }
    parts
}

/// Maximum number of overshoots on the screen.
const MAX_LISTED_OVERSHOOTS: usize = 12;

/// Zig-zag characteristics and the IMO criteria measured by the record, as lines of text.
fn characteristics(entry: &ZigZagEntry) -> String {
    let overshoots = entry.overshoots_deg.iter().zip(&entry.overshoots_sd_deg).take(MAX_LISTED_OVERSHOOTS);
    let angle_text = |(&angle, &sd): (&Option<f64>, &Option<f64>)| {
        angle.map_or_else(|| MISSING.to_owned(), |angle| with_uncertainty(angle, sd))
    };
    let overshoots: Vec<String> = overshoots.map(angle_text).collect();
    let overshoots = match entry.overshoots_deg.len().saturating_sub(MAX_LISTED_OVERSHOOTS) {
        0 if overshoots.is_empty() => "none".to_owned(),
        0 => format!("{} deg", overshoots.join(", ")),
        more => format!("{} deg, and {more} more in fit.json", overshoots.join(", ")),
    };
    let mut text = format!("zig-zag: initial turning time {}", seconds(entry.initial_turning_time_s, 2));
    text += &format!(", period {}\n  overshoots {overshoots}\n", seconds(entry.period_s, 1));
    if entry.imo.is_empty() && !entry.overshoots_deg.is_empty() {
        text += "  IMO: not compared, length and speed of the ship are unknown; give --length-m and --speed-kn\n";
    }
    if !entry.imo.is_empty() && entry.imo.iter().all(|criterion| criterion.measured.is_none()) {
        text += "  IMO: not compared, because the criteria are for 10/10 and 20/20 zig-zags from a straight course\n";
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
