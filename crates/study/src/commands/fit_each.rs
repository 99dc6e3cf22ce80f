//! `study fit --each`: every log alone, one row or one line of JSON each on standard output, without a folder.

use campaign::failure::Failure;
use rayon::prelude::*;

use crate::documents::error::ErrorEntry;
use crate::documents::fit_each::LogFitEntry;
use crate::options::{CommonOptions, FitRequest, Format};
use crate::records::record_files;
use crate::views::fit_each_table;
use crate::work::fit::labelled_methods;
use crate::work::fit_each::LogFit;
use crate::{progress, screen};

/// Number of logs that are fitted before their lines of JSON are written.
const CHUNK_LOGS: usize = 64;

/// Identifies every log alone and prints a row for it, in the order in which they were named.
///
/// Fails if no log can be read; a single log that cannot be read is a row.
pub fn run(request: &FitRequest, common: &CommonOptions) -> Result<(), Failure> {
    let methods = labelled_methods(&request.methods, common.seed)?;
    let files = record_files(&request.trials)?;
    let bar = progress::bar("logs", files.len() as u64, common.quiet);
    let fit_of = |file| {
        let fit = LogFit::fit_file(file, &methods, &request.reading);
        bar.inc(1);
        fit
    };
    let mut fits: Vec<LogFit> = Vec::with_capacity(files.len());
    for part in files.chunks(CHUNK_LOGS) {
        let done: Vec<LogFit> = part.par_iter().map(|file| fit_of(file)).collect();
        if common.format == Format::Json {
            bar.suspend(|| done.iter().try_for_each(|fit| screen::print_unescaped(&line(fit)?)))?;
        }
        fits.extend(done);
    }
    bar.finish_and_clear();
    if common.format != Format::Json && !common.is_silent() {
        screen::print_lines(common.format.render(&fit_each_table::table(&fits)).trim_end())?;
    }
    match fits.iter().find_map(|fit| fit.error.as_ref()).filter(|_| !fits.iter().any(|fit| fit.is_read)) {
        Some(first) => Err(Failure::input(format!("none of {} logs could be read; {}", fits.len(), first.message))),
        None => Ok(()),
    }
}

/// One log as a line of JSON. Fails if it cannot be written as JSON.
fn line(LogFit { file, verdict, warnings, error, .. }: &LogFit) -> Result<String, Failure> {
    let error = error.as_ref().map(ErrorEntry::from_failure);
    let (file, verdict) = (file.display().to_string(), verdict.as_ref());
    let entry = LogFitEntry { schema: "fit-each/1", file, verdict, warnings, error };
    serde_json::to_string(&entry).map_err(Failure::execution)
}
