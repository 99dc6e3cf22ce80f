//! `study fit`: identify measured records with every method, replay the answers on them and on others.

use report::Table;
use report::number::{MISSING, fixed, optional, with_uncertainty};
use trial::Trial;

use crate::documents::fit::ZigZagEntry;
use crate::options::{Common, FitRequest};
use crate::records::{default_folder, file_of, names, read_all, read_others, warn_of_repetition};
use crate::scales::Together;
use crate::screen::{self, Told};
use crate::views::document;
use crate::views::fit_figures::{self, Drawn, Whole};
use crate::views::fit_page::{self, FitPage};
use crate::views::page_files::write_page;
use crate::views::{fit_scales, method_table};
use crate::work::fit::{Fit, fit, methods};
use campaign::answer::MethodEntry;
use campaign::folder::ResultFolder;
use scenario::failure::{Failure, OnPath};

/// What other programs read.
const FIT: &str = "fit.json";

/// Identifies the records, prints the table, writes figures, `fit.json`, `report.md` and `report.html`.
///
/// Fails when a record cannot be read, and when no method can identify the records.
pub fn run(request: &FitRequest, common: &Common) -> Result<(), Failure> {
    let methods = methods(&request.methods, &request.external, common.seed)?;
    let mut warnings = Vec::new();
    let read = read_all(&request.trials, &request.reading, &mut warnings)?;
    let read_to_validate = read_others(&request.validate, &request.reading, &mut warnings)?;
    warn_of_repetition(&read, &read_to_validate, &mut warnings);
    let theme = request.style.theme()?;
    let Fit { together, ship, zigzags, answers, amplitudes, file } =
        fit(&read, &read_to_validate, &methods, common.quiet, &mut warnings)?;
    let (trials, others) = (&together.trials[..], &together.others[..]);
    let folder = ResultFolder::hold(&common.out.clone().unwrap_or_else(|| default_folder(trials, "fit")))?;
    let path = folder.path().join(FIT);
    let document = document::text(&file).on("describe", &path)?;
    folder.keep(FIT, document.as_str())?;
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
        amplitudes,
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
    let told = Told { words: [&format!("{headline}\n"), ""], table: &table, notes: &notes, document: &document };
    screen::tell(common, &told, &warnings)
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
