//! A trace: the analysis of the crate [`trace`](mod@::trace), and what is said about it beside it.

use ::trace::{Settings, TraceError};
use scenario::failure::Failure;
use trial::{Channel, Trial};

use super::{alone, planned, steady};
use crate::options::{TraceRequest, Withheld};
use crate::progress;
use crate::records::{file_of, names, warn_of_no_track};
use crate::scales::{self, Together};
use crate::views::trace_report::TraceReport;
use crate::views::trace_scales;
use campaign::known::{self, Shown};

/// Analyses the records together; `others` are held out.
///
/// Fails when the records cannot be brought to one scale, when the base cannot be fitted, and when what is asked for
/// cannot be in the model.
pub fn trace(
    records: &[Trial],
    others: &[Trial],
    settings: &Settings,
    quiet: bool,
    warnings: &mut Vec<String>,
) -> Result<TraceReport, Failure> {
    let sailed_by = records.iter().chain(others).map(Trial::particulars).collect();
    let together = scales::together(records, others)?;
    let busy = progress::busy("tracing", quiet);
    let analysis = ::trace::trace(&together.trials, &together.others, settings);
    busy.finish_and_clear();
    let analysis = analysis.map_err(|error| {
        let first = file_of(&records[0]).0;
        let why = match error {
            TraceError::Base(_) | TraceError::Replay { .. } => {
                "; the record cannot be traced because no base model fits it"
            }
            TraceError::Asked { .. } => "; leave it out of the request",
            TraceError::Settings(_) => "",
        };
        Failure::input(format!("{first}: {error}{why}"))
    })?;
    let scales = trace_scales::compared(&analysis, &together);
    let scaled = together.sentence();
    let Together { trials, others, .. } = together;
    let planned = planned::trials(&analysis, &trials);
    let shown = Shown::of(&trials).with_motion();
    warn_of_no_track(&shown, warnings);
    let known = known::of_analysis(&analysis, &shown);
    Ok(TraceReport {
        names: names(trials.iter().chain(&others).map(Trial::name)),
        ship: scales::particulars(&trials),
        sailed_by,
        amplitudes: alone::of_analysis(&analysis, &trials),
        steady: steady::of_ship(&known),
        known,
        scaled,
        scales,
        prospects: analysis.prospects(&planned),
        missing: analysis.missing_moments(),
        trials,
        others,
        analysis,
    })
}

/// How the records of a request are analysed.
pub fn settings(request: &TraceRequest) -> Settings {
    Settings { own_bias: request.own_bias, rule: request.rule, wanted: request.wanted(), ..Settings::default() }
}

/// The records of a request without the channels that are withheld.
pub fn without(request: &TraceRequest, trials: Vec<Trial>) -> Vec<Trial> {
    let withheld: Vec<Channel> = request.without.iter().flat_map(|what| channels(*what)).copied().collect();
    trials.into_iter().map(|trial| trial.without(&withheld)).collect()
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
