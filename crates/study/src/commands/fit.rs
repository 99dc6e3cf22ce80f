//! `study fit`: identify measured records with every method, replay the estimates on these and on other records. The
//! document and the curves are written first; all other output is made from them.

use campaign::failure::Failure;
use campaign::folder::ResultFolder;
use document::fit::FitDocument;
use document::{Warning, Warnings};
use report::Theme;

use super::fit_each;
use crate::documents::fit_curves::FitCurves;
use crate::documents::{self, FIT_FILE, draws, folder_for_records};
use crate::options::{CommonOptions, FitRequest};
use crate::records::{default_folder, read_for_replay, read_records, repetition_warnings};
use crate::screen::{self, CommandOutput};
use crate::views::page_files::{MARKDOWN_REPORT_FILE, write_page};
use crate::views::{curve_tables, fit_page};
use crate::work::earlier_trials::EarlierModel;
use crate::work::fit::{fit, labelled_methods};

/// Identifies the records, prints the table, writes `fit.json`, the curves, figures, `report.md` and `report.html`.
///
/// Fails if a record cannot be read, or if no method identifies the records.
pub fn run(request: &FitRequest, common: &CommonOptions) -> Result<(), Failure> {
    if request.each {
        return fit_each::run(request, common);
    }
    let methods = labelled_methods(&request.methods, common.seed)?;
    let priors = EarlierModel::from_files(&request.priors)?;
    let mut warnings = Warnings::default();
    let trials = read_records(&request.trials, &request.reading, &mut warnings)?;
    let validation = read_for_replay(&request.validate, &request.reading, &mut warnings)?;
    warnings.extend(repetition_warnings(&trials, &validation));
    let theme = request.style.theme()?;
    let place = common.out.clone().unwrap_or_else(|| default_folder(&trials, "fit"));
    let place = folder_for_records(FIT_FILE, &place, &trials)?;
    let fit = fit([&trials, &validation], &methods, &priors, common.quiet, warnings)?.with_predicted_circle();
    let folder = ResultFolder::make(&place)?;
    let curves = fit.curves();
    let text = documents::write_with_curves(&folder, FIT_FILE, &fit.document, &curves)?;
    if request.draws.draws_file {
        let answers = fit.document.ships.iter().map(|(method, ship)| (method.as_str(), ship));
        draws::write_estimates(&folder, answers, request.draws.draws, common.seed.unwrap_or_default())?;
    }
    write_results(&folder, &fit.document, &curves, &text, theme.as_ref(), common)
}

/// Writes the figures and the page of a fit into a folder and prints its table; `text` is that of `fit.json`.
///
/// Fails if a file cannot be written.
pub fn write_results(
    folder: &ResultFolder,
    document: &FitDocument,
    curves: &FitCurves,
    text: &str,
    theme: Option<&Theme>,
    common: &CommonOptions,
) -> Result<(), Failure> {
    curve_tables::write_replays(curves, folder)?;
    write_page(folder, fit_page::page(document, curves), theme)?;
    let notes = format!(
        "{}\nresults: {}",
        fit_page::text_below_table(document, curves),
        folder.path().join(FIT_FILE).display()
    );
    let verdict = fit_page::fit_verdict(document).map_or_else(String::new, |sentences| format!("{sentences}\n\n"));
    let head = format!("{verdict}{}\n", fit_page::fit_headline(document, curves));
    let table = fit_page::answer_table(document, curves);
    let output = CommandOutput { texts_around_table: [&head, ""], table: &table, notes: &notes, document: text };
    screen::print_output(common, &output, &shortened(document.verdict_warnings()))
}

/// Maximum number of warnings on the screen.
const MAX_SCREEN_WARNINGS: usize = 3;

/// The first warnings, and the number of further ones.
fn shortened<'a>(warnings: impl Iterator<Item = &'a Warning>) -> Vec<String> {
    let mut lines: Vec<String> = warnings.map(Warning::to_string).collect();
    let more = lines.len().saturating_sub(MAX_SCREEN_WARNINGS);
    lines.truncate(MAX_SCREEN_WARNINGS);
    lines.extend((more > 0).then(|| format!("{more} more in {MARKDOWN_REPORT_FILE}")));
    lines
}
