//! `study trace`: close the loop on measured records. The analysis is that of the crate [`trace`]; here its words,
//! tables, figures and files are made.

use ::trace::{Settings, TraceError};
use trial::{Channel, Trial};

use crate::commands::{alone, planned, steady};
use crate::options::{Common, TraceRequest, Withheld};
use crate::records::{default_folder, names, read_all, read_others, warn_of_no_track, warn_of_repetition};
use crate::scales::{self, Together};
use crate::views::page_files::write_page;
use crate::views::trace_file::TraceFile;
use crate::views::trace_report::TraceReport;
use crate::views::{missing_moment, trace_figures, trace_page, trace_scales, trace_tables};
use crate::{progress, screen};
use campaign::folder::ResultFolder;
use campaign::known::{self, Shown};
use scenario::failure::{Failure, OnPath};

/// What other programs read.
const TRACE: &str = "trace.json";

/// Analyses the records, prints what was found, writes `trace.json`, `report.md`, `report.html` and figures.
///
/// Fails when a record cannot be read, and when the base cannot be fitted.
pub fn run(request: &TraceRequest, common: &Common) -> Result<(), Failure> {
    let theme = request.style.theme()?;
    let mut warnings = Vec::new();
    let withheld: Vec<Channel> = request.without.iter().flat_map(|what| channels(*what)).copied().collect();
    let without = |trials: Vec<Trial>| trials.into_iter().map(|trial| trial.without(&withheld)).collect::<Vec<Trial>>();
    let trials = without(read_all(&request.trials, &request.reading, &mut warnings)?);
    let others = without(read_others(&request.validate, &request.reading, &mut warnings)?);
    warn_of_repetition(&trials, &others, &mut warnings);
    let sailed_by = trials.iter().chain(&others).map(Trial::particulars).collect();
    let together = scales::together(&trials, &others)?;
    let Together { trials, others, .. } = &together;
    let settings =
        Settings { own_bias: request.own_bias, rule: request.rule, wanted: request.wanted(), ..Settings::default() };
    let busy = progress::busy("tracing", common.quiet);
    let analysis = ::trace::trace(trials, others, &settings);
    busy.finish_and_clear();
    let analysis = analysis.map_err(|error| {
        let first = request.trials[0].display();
        let why = match error {
            TraceError::Base(_) | TraceError::Replay { .. } => {
                "; the record cannot be traced because no base model fits it"
            }
            TraceError::Asked { .. } => "; leave it out of the request",
            TraceError::Settings(_) => "",
        };
        Failure::input(format!("{first}: {error}{why}"))
    })?;
    let folder = ResultFolder::hold(&common.out.clone().unwrap_or_else(|| default_folder(trials, "trace")))?;
    let planned = planned::trials(&analysis, trials);
    let shown = Shown::of(trials).with_motion();
    warn_of_no_track(&shown, &mut warnings);
    let known = known::of_analysis(&analysis, &shown);
    let report = TraceReport {
        names: names(trials.iter().chain(others).map(Trial::name)),
        ship: scales::particulars(trials),
        sailed_by,
        amplitudes: alone::of_analysis(&analysis, trials),
        steady: steady::of_ship(&known),
        known,
        scaled: together.sentence(),
        scales: trace_scales::compared(&analysis, &together),
        prospects: analysis.prospects(&planned),
        missing: analysis.missing_moments(),
        trials,
        others,
        analysis: &analysis,
    };
    let path = folder.path().join(TRACE);
    let json = serde_json::to_string_pretty(&TraceFile::of(&report)).on("describe", &path)?;
    folder.keep(TRACE, json + "\n")?;
    for shown in missing_moment::shown(&report) {
        folder.write(&format!("{}.csv", shown.stem), missing_moment::table(shown.missing))?;
    }
    let drawn = trace_figures::draw(&report, &theme, &folder)?;
    write_page(&folder, &trace_page::page(&report, &drawn))?;
    let notes = format!("\nresults: {}", path.display());
    let words = format!("{}\n", trace_page::words(&report));
    screen::tell(common, [&words, ""], &trace_tables::errors(&report), &notes)?;
    for warning in warnings {
        screen::warn(&format!("warning: {warning}"));
    }
    Ok(())
}

fn channels(what: Withheld) -> &'static [Channel] {
    match what {
        Withheld::Wind => {
            &[Channel::WindRelativeSpeed, Channel::WindRelativeFrom, Channel::WindTrueSpeed, Channel::WindTrueFrom]
        }
        Withheld::Speed => &[Channel::Speed, Channel::Surge],
        Withheld::Propeller => &[Channel::PropellerRate],
        Withheld::Sway => &[Channel::Sway],
    }
}
