//! `study fit`: identify measured records with every method, replay the answers on them and on others.

use std::path::Path;

use identify::replay::replay;
use identify::{Estimate, Identifier, IdentifierSettings, registry};
use indicatif::ParallelProgressIterator;
use rayon::prelude::*;
use report::Table;
use report::number::{MISSING, fixed, optional, with_uncertainty};
use ship::angle::to_deg;
use trial::{Trial, ZigZag, ZigZagError};

use crate::commands::alone;
use crate::options::{Common, FitRequest};
use crate::records::{default_folder, file_of, names, read_all, read_others, warn_of_no_track, warn_of_repetition};
use crate::scales::{self, Together};
use crate::views::fit_figures::{self, Drawn, Whole};
use crate::views::fit_file::{FitFile, TrialEntry, ZigZagEntry, trial_entry};
use crate::views::fit_page::{self, FitPage};
use crate::views::page_files::write_page;
use crate::views::{fit_scales, method_table};
use crate::{progress, screen};
use campaign::answer::{MethodEntry, Validation, entry};
use campaign::folder::ResultFolder;
use campaign::known::{self, Shown};
use scenario::failure::{Failure, OnPath};

/// What other programs read.
const FIT: &str = "fit.json";

/// Identifies the records, prints the table, writes figures, `fit.json`, `report.md` and `report.html`.
///
/// Fails when a record cannot be read, and when no method can identify the records.
pub fn run(request: &FitRequest, common: &Common) -> Result<(), Failure> {
    let methods = methods(&request.methods, common.seed)?;
    let mut warnings = Vec::new();
    let read = read_all(&request.trials, &request.reading, &mut warnings)?;
    let read_to_validate = read_others(&request.validate, &request.reading, &mut warnings)?;
    warn_of_repetition(&read, &read_to_validate, &mut warnings);
    let theme = request.style.theme()?;
    let together = scales::together(&read, &read_to_validate)?;
    let (trials, others) = (&together.trials[..], &together.others[..]);
    let ship = scales::particulars(trials);

    let answers: Vec<(MethodEntry, Option<Estimate>)> = methods
        .par_iter()
        .progress_with(progress::of("methods", methods.len() as u64, common.quiet))
        .map(|method| {
            let (mut entry, estimate) = entry(method.id(), method.identify(trials), trials);
            entry.prime = entry.parameters.zip(ship).map(|(own, ship)| own.prime(ship));
            entry.validation = others.iter().map(|other| validate(other, estimate.as_ref())).collect();
            (entry, estimate)
        })
        .collect();
    let entries: Vec<MethodEntry> = answers.iter().map(|(entry, _)| entry.clone()).collect();
    // A record that no method can use is wrong input, not a result.
    if entries.iter().all(|entry| entry.parameters.is_none()) {
        return Err(unusable(&request.trials[0], &entries, &warnings));
    }

    // Times and limits of a record are those of its own scale.
    let zigzags: Vec<Result<ZigZag, ZigZagError>> = read.iter().map(ZigZag::of).collect();
    let folder = ResultFolder::hold(&common.out.clone().unwrap_or_else(|| default_folder(trials, "fit")))?;
    let entries_of_trials: Vec<TrialEntry> =
        read.iter().zip(&zigzags).map(|(trial, zigzag)| trial_entry(trial, zigzag.as_ref().ok())).collect();
    let shown = Shown::of(trials).with_motion();
    warn_of_no_track(&shown, &mut warnings);
    let file = FitFile {
        schema: "fit/1".into(),
        zigzag: entries_of_trials[0].zigzag.clone(),
        trials: entries_of_trials,
        methods: entries,
        ships: answers
            .iter()
            .filter_map(|(entry, estimate)| {
                Some((entry.method.clone(), known::of_estimate(estimate.as_ref()?, &shown)?))
            })
            .collect(),
        scales: fit_scales::compared(&methods, &answers, &together),
    };
    let path = folder.path().join(FIT);
    let text = serde_json::to_string_pretty(&file).on("describe", &path)?;
    folder.keep(FIT, text + "\n")?;
    let names = names(trials.iter().chain(others).map(Trial::name));
    let records: Vec<Drawn> = trials
        .iter()
        .chain(others)
        .zip(&names)
        .enumerate()
        .map(|(number, (trial, name))| Drawn { trial, name, validation: number >= trials.len() })
        .collect();
    let whole = Whole {
        title: match trials {
            [only] => only.name().to_owned(),
            several => format!("{} records together", several.len()),
        },
        ship,
        amplitudes: alone::of_records(trials, &speakers(&methods, &file.methods)),
    };
    let drawn = fit_figures::draw(&records, &answers, &whole, &theme, &folder)?;

    let mut notes = renamed(&records) + &reasons(&file.methods);
    for ((zigzag, entry), name) in zigzags.iter().zip(&file.trials).zip(&names) {
        let of = if trials.len() > 1 { format!("{name}: ") } else { String::new() };
        match (zigzag, &entry.zigzag) {
            (_, Some(entry)) => notes += &format!("\n{of}{}", characteristics(entry)),
            (Err(error), None) => notes += &format!("\n{of}no zig-zag characteristics: {error}\n"),
            (Ok(_), None) => {}
        }
    }
    let scales = fit_scales::words(&file, ship, &|table| format!("\n{}\n", table.to_markdown()));
    let table = method_table::table(&file.methods, &names[trials.len()..]);
    for entry in &file.methods {
        warnings.extend(entry.warnings.iter().map(|warning| format!("{}: {warning}", entry.method)));
    }
    let headline = headline(&together);
    let page = FitPage {
        headline: &headline,
        methods: &table,
        notes: &notes,
        scales: &scales,
        warnings: &warnings,
        figures: &drawn,
    };
    write_page(&folder, &fit_page::page(&page))?;
    notes += &fit_scales::words(&file, ship, &Table::to_text);
    notes += &format!("\nresults: {}", path.display());
    screen::tell(common, [&format!("{headline}\n"), ""], &table, &notes)?;
    for warning in warnings {
        screen::warn(&format!("warning: {warning}"));
    }
    Ok(())
}

fn methods(names: &[String], seed: Option<u64>) -> Result<Vec<Box<dyn Identifier>>, Failure> {
    let all: Vec<Box<dyn Identifier>> = registry::defaults()
        .iter()
        .map(IdentifierSettings::build)
        .collect::<Result<_, _>>()
        .map_err(|error| Failure::work(format!("default settings: {error}")))?;
    let known: Vec<&str> = all.iter().map(|method| method.id()).collect();
    if let Some(unknown) = names.iter().find(|name| !known.contains(&name.as_str())) {
        return Err(Failure::input(format!("--method {unknown}: no such method; use one of {}", known.join(", "))));
    }
    Ok(all
        .into_iter()
        .filter(|method| names.is_empty() || names.iter().any(|name| name == method.id()))
        .map(|method| seed.and_then(|seed| method.with_seed(seed)).unwrap_or(method))
        .collect())
}

/// The methods that were used and gave an answer with an interval, those first whose intervals hold most.
fn speakers<'a>(methods: &'a [Box<dyn Identifier>], entries: &[MethodEntry]) -> Vec<&'a dyn Identifier> {
    let has_interval = |entry: &&MethodEntry| entry.parameters.is_some_and(|own| own.k_per_s.ci95.is_some());
    let answered: Vec<&str> = entries.iter().filter(has_interval).map(|entry| entry.method.as_str()).collect();
    let mut found: Vec<&dyn Identifier> =
        methods.iter().map(Box::as_ref).filter(|method| answered.contains(&method.id())).collect();
    let rank = |id: &str| fit_scales::SPEAKERS.iter().position(|speaker| *speaker == id);
    found.sort_by_key(|method| rank(method.id()).unwrap_or(fit_scales::SPEAKERS.len()));
    found.truncate(fit_scales::SPEAKERS.len());
    found
}

/// The message when no method gives an answer: every reason once.
fn unusable(path: &Path, entries: &[MethodEntry], warnings: &[String]) -> Failure {
    let mut reasons: Vec<(&str, Vec<&str>)> = Vec::new();
    for entry in entries {
        let reason = entry.reason.as_deref().unwrap_or("no answer");
        match reasons.iter_mut().find(|(known, _)| *known == reason) {
            Some((_, methods)) => methods.push(&entry.method),
            None => reasons.push((reason, vec![&entry.method])),
        }
    }
    let file = path.display();
    let mut message = match (entries, reasons.as_slice()) {
        ([only], _) => {
            let reason = only.reason.as_deref().unwrap_or("no answer");
            format!("{file}: {} cannot identify this record: {reason}", only.method)
        }
        (_, [(reason, _)]) => format!("{file}: no method can identify this record: {reason}"),
        _ => {
            let lines: Vec<String> =
                reasons.iter().map(|(reason, methods)| format!("\n  {}: {reason}", methods.join(", "))).collect();
            format!("{file}: no method can identify this record{}", lines.concat())
        }
    };
    for warning in warnings {
        message += &format!("\nnote: {warning}");
    }
    if entries.iter().any(|entry| entry.failure.as_deref() != Some("not-excited")) {
        message += "\nhelp: give a zig-zag, or a record in which the rudder is put to both sides for as long as the ship needs to answer";
    }
    Failure::input(message)
}

fn headline(together: &Together) -> String {
    let rows: usize = together.trials.iter().map(Trial::len).sum();
    let head = match &together.trials[..] {
        [only] => format!("{}: {rows} rows, {:.1} s", only.name(), only.duration()),
        several => format!("{} records together: {rows} rows", several.len()),
    };
    together.sentence().map_or_else(|| head.clone(), |sentence| format!("{head}\n{sentence}"))
}

/// Which record is meant, where several have the same name.
fn renamed(records: &[Drawn]) -> String {
    let lines: String = records
        .iter()
        .filter(|record| record.name != record.trial.name())
        .map(|record| format!("{} is {}\n", record.name, file_of(record.trial).0))
        .collect();
    if lines.is_empty() { lines } else { format!("\n{lines}") }
}

/// Why methods failed, one line each; the table has the reason in a word only.
fn reasons(entries: &[MethodEntry]) -> String {
    let lines: String = entries
        .iter()
        .filter_map(|entry| entry.reason.as_ref().map(|reason| format!("{} failed: {reason}\n", entry.method)))
        .collect();
    if lines.is_empty() { lines } else { format!("\n{lines}") }
}

fn validate(other: &Trial, estimate: Option<&Estimate>) -> Validation {
    Validation {
        file: file_of(other).0.to_owned(),
        heading_rmse_deg: estimate
            .and_then(|estimate| replay(other, &estimate.response))
            .map(|replay| to_deg(replay.rms())),
    }
}

/// Most overshoots that are written on the screen.
const MOST_LISTED: usize = 12;

/// Characteristics in words, and the IMO criteria this record measures; of very many overshoots the first.
fn characteristics(entry: &ZigZagEntry) -> String {
    let overshoots: Vec<String> = entry
        .overshoots_deg
        .iter()
        .zip(&entry.overshoots_sd_deg)
        .take(MOST_LISTED)
        .map(|(&angle, &sd)| angle.map_or_else(|| MISSING.to_owned(), |angle| with_uncertainty(angle, sd)))
        .collect();
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
    for criterion in entry.imo.iter().filter(|criterion| criterion.measured.is_some()) {
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
        };
        assert!(characteristics(&entry(0)).contains("overshoots none"));
        assert_eq!(characteristics(&entry(12)).matches("8.2").count(), 12);
        let many = characteristics(&entry(3000));
        assert!(many.contains("and 2988 more in fit.json") && many.len() < 400, "{many}");
    }
}
