//! Measured records traced by the command of the program.

use std::fs;
use std::path::{Path, PathBuf};

use document::trace::TraceDocument;
use study::options::{Common, FigureOptions, Format, PageFigureOptions, PageFigures, TraceRequest, Withheld};
use trace::Rule;

use super::sets::{MeasuredSet, Outcome, reading};

/// A trace of some records of a set.
#[derive(Clone, Copy)]
pub struct MeasuredTrace<'a> {
    /// The set.
    pub set: &'a MeasuredSet,
    /// Records that are fitted together.
    pub records: &'a [&'a str],
    /// Records that are held out.
    pub held_out: &'a [&'a str],
    /// Whether the wind is withheld.
    pub without_wind: bool,
    /// Models of earlier trials.
    pub priors: &'a [PathBuf],
    /// Whether its figures are drawn.
    pub figures: PageFigures,
}

impl MeasuredTrace<'_> {
    /// Runs `study trace` and reads `trace.json`.
    ///
    /// Fails where a record cannot be read or traced.
    pub fn run(&self, out: &Path) -> Outcome<TraceDocument> {
        let Self { set, records, held_out, without_wind, priors, figures } = *self;
        let wind = if without_wind { ", wind withheld" } else { "" };
        let prior = if priors.is_empty() { "" } else { ", with a prior" };
        eprintln!("{}: {}{wind}{prior}", set.folder, records.join(", "));
        let copies = out.with_extension("records");
        let files = |names: &[&str]| names.iter().map(|name| set.file(name, &copies)).collect::<Result<Vec<_>, _>>();
        let without = if without_wind { vec![Withheld::Wind] } else { Vec::new() };
        trace_files([files(records)?, files(held_out)?, priors.to_vec()], without, Some(set.sidecars()), figures, out)
    }
}

/// Runs `study trace` on some files, others held out, with models as priors, and reads `trace.json`.
///
/// Fails where a file cannot be read or traced.
pub fn trace_files(
    [trials, validate, priors]: [Vec<PathBuf>; 3],
    without: Vec<Withheld>,
    columns: Option<PathBuf>,
    figures: PageFigures,
    out: &Path,
) -> Outcome<TraceDocument> {
    let request = TraceRequest {
        trials,
        validate,
        reading: reading(columns),
        without,
        with: Vec::new(),
        only: Vec::new(),
        without_effect: Vec::new(),
        effect: Vec::new(),
        effects: None,
        without_hull: false,
        priors,
        rule: Rule::default(),
        style: PageFigureOptions { style: FigureOptions { paper: None, dpi: 600.0, style: None }, figures },
    };
    let common = Common { out: Some(out.to_owned()), threads: None, seed: None, quiet: true, format: Format::Text };
    study::commands::trace::run(&request, &common).map_err(|failure| failure.to_string())?;
    Ok(serde_json::from_str(&fs::read_to_string(out.join("trace.json"))?)?)
}
