//! `study trace`: close the loop on measured records. The analysis is that of the crate [`mod@trace`]; here its words,
//! tables, figures and files are made.

use crate::options::{Common, TraceRequest};
use crate::records::{default_folder, read_all, read_others, warn_of_repetition};
use crate::screen::{self, Told};
use crate::views::page_files::write_page;
use crate::views::trace_file::TraceFile;
use crate::views::{document, missing_moment, trace_figures, trace_page, trace_tables};
use crate::work::trace::{settings, trace, without};
use campaign::folder::ResultFolder;
use scenario::failure::{Failure, OnPath};

/// What other programs read.
const TRACE: &str = "trace.json";

/// Analyses the records, prints what was found, writes `trace.json`, `report.md`, `report.html` and figures.
///
/// Fails when a record cannot be read, and when the base cannot be fitted.
pub fn run(request: &TraceRequest, common: &Common) -> Result<(), Failure> {
    let theme = request.style.theme()?;
    let mut warnings = Vec::new();
    let trials = without(request, read_all(&request.trials, &request.reading, &mut warnings)?);
    let others = without(request, read_others(&request.validate, &request.reading, &mut warnings)?);
    warn_of_repetition(&trials, &others, &mut warnings);
    let report = trace(&trials, &others, &settings(request), common.quiet, &mut warnings)?;
    let folder = ResultFolder::hold(&common.out.clone().unwrap_or_else(|| default_folder(&report.trials, "trace")))?;
    let path = folder.path().join(TRACE);
    let document = document::text(&TraceFile::of(&report)).on("describe", &path)?;
    folder.keep(TRACE, document.as_str())?;
    for shown in missing_moment::shown(&report) {
        folder.write(&format!("{}.csv", shown.stem), missing_moment::table(shown.missing))?;
    }
    let drawn = trace_figures::draw(&report, &theme, &folder)?;
    write_page(&folder, &trace_page::page(&report, &drawn))?;
    let notes = format!("\nresults: {}", path.display());
    let words = format!("{}\n", trace_page::words(&report));
    let table = trace_tables::errors(&report);
    screen::tell(common, &Told { words: [&words, ""], table: &table, notes: &notes, document: &document }, &warnings)
}
