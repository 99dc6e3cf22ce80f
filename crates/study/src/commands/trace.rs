//! `study trace`: effects that a first-order model lacks on measured records. The crate [`mod@trace`] does the
//! analysis; its document and curves are written first, and all other output is made from them.

use campaign::failure::Failure;
use campaign::folder::ResultFolder;
use document::trace::TraceDocument;
use document::{Warning, Warnings};
use report::Theme;

use crate::documents::curves::TraceCurves;
use crate::documents::{TRACE_FILE, draws, folder_for_records};
use crate::interrupt;
use crate::options::{CommonOptions, TraceRequest};
use crate::records::{default_folder, read_for_replay, read_records, repetition_warnings};
use crate::screen::{self, CommandOutput};
use crate::views::page_files::write_page;
use crate::views::trace_page;
use crate::work::earlier_trials::EarlierModel;
use crate::work::steady;
use crate::work::trace::{STOPPED_MESSAGE, settings, trace, withhold_channels};

/// Analyses the records, prints the results, writes `trace.json`, the curves, `report.md`, `report.html` and figures.
///
/// Fails if a record cannot be read, or if the base cannot be fitted.
pub fn run(request: &TraceRequest, common: &CommonOptions) -> Result<(), Failure> {
    let (theme, settings) = (request.style.theme()?, settings(request)?);
    let priors = EarlierModel::from_files(&request.priors)?;
    let mut warnings = Warnings::default();
    let trials = withhold_channels(request, read_records(&request.trials, &request.reading, &mut warnings)?);
    let validation = withhold_channels(request, read_for_replay(&request.validate, &request.reading, &mut warnings)?);
    warnings.extend(repetition_warnings(&trials, &validation));
    let place = common.out.clone().unwrap_or_else(|| default_folder(&trials, "trace"));
    let place = folder_for_records(TRACE_FILE, &place, &trials)?;
    let traced = trace([&trials, &validation], &settings, &priors, common.quiet, &mut warnings)?;
    let folder = ResultFolder::make(&place)?;
    let text = traced.write(&folder)?;
    if request.draws.draws_file {
        let answer = std::iter::once(("trace", &traced.document.ship));
        draws::write_estimates(&folder, answer, request.draws.draws, common.seed.unwrap_or_default())?;
    }
    write_results(&folder, &traced.document, &traced.curves()?, &text, theme.as_ref(), common, &warnings.ranked())?;
    if interrupt::is_stop_requested() { Err(Failure::interrupted(STOPPED_MESSAGE)) } else { Ok(()) }
}

/// Writes the figures and the page of a trace into a folder and prints its results; `text` is that of `trace.json`.
///
/// Fails if a file cannot be written.
pub fn write_results(
    folder: &ResultFolder,
    document: &TraceDocument,
    curves: &TraceCurves,
    text: &str,
    theme: Option<&Theme>,
    common: &CommonOptions,
    warnings: &[Warning],
) -> Result<(), Failure> {
    write_page(folder, trace_page::page(document, curves, steady::steady_turns(&document.ship).as_ref()), theme)?;
    let notes = format!("\nresults: {}", folder.path().join(TRACE_FILE).display());
    let [before, behind] = trace_page::texts_around_table(document);
    let table = trace_page::all_replay_errors_table(document);
    let output = CommandOutput { texts_around_table: [&before, &behind], table: &table, notes: &notes, document: text };
    screen::print_output(common, &output, warnings)
}
