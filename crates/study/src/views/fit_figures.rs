//! Figures of `study fit`: the first record with its characteristic points, and every record with the replays of all
//! methods and with the best fit.

use identify::Estimate;
use rayon::prelude::*;
use report::figures::{self, Fit, RecordFit, Replay, Replays};
use report::{Figure, Origin, Theme};
use trial::{Channel, Trial, ZigZag};

use super::picture::{first_failure, write_figure};
use campaign::answer::MethodEntry;
use campaign::curves::{curve, replay_curves, zigzag_figure};
use campaign::folder::ResultFolder;
use scenario::failure::Failure;

/// The method whose fit is drawn on its own where it has one.
const BEST: &str = "output-error";

/// A record to draw.
pub struct Drawn<'a> {
    /// The record.
    pub trial: &'a Trial,
    /// Its name; no two records have the same.
    pub name: &'a str,
    /// Whether it was kept for validation.
    pub validation: bool,
}

/// Draws everything into `folder`: `trial` (of a zig-zag that was fitted), `raw` (where readings are left out or
/// doubtful), `replays` and `fit` of the first record, and the same with `-NAME` of the others.
pub fn draw(
    records: &[Drawn],
    answers: &[(MethodEntry, Option<Estimate>)],
    theme: &Theme,
    folder: &ResultFolder,
) -> Result<(), Failure> {
    first_failure(records.par_iter().enumerate().map(|(number, record)| {
        let suffix = if number == 0 { String::new() } else { format!("-{}", record.name) };
        if let Some(zigzag) = ZigZag::of(record.trial).ok().filter(|_| !record.validation) {
            let data =
                figures::ZigzagTrial { title: Some(record.name.to_owned()), ..zigzag_figure(record.trial, &zigzag) };
            write_figure(&figures::zigzag_trial(&data, theme), folder, &format!("trial{suffix}"))?;
        }
        if !record.trial.marks().is_empty() {
            write_figure(&raw(record, theme), folder, &format!("raw{suffix}"))?;
        }
        let replays = replays(record, answers);
        write_figure(&figures::replays(&replays, theme), folder, &format!("replays{suffix}"))?;
        write_figure(&best_fit(record, &replays, theme), folder, &format!("fit{suffix}"))
    }))
}

fn title(record: &Drawn) -> Option<String> {
    Some(if record.validation { format!("{} (validation)", record.name) } else { record.name.to_owned() })
}

/// The record with marks at the readings that are left out or doubtful.
fn raw(record: &Drawn, theme: &Theme) -> Figure {
    let trial = record.trial;
    let marked = |channel: Channel| {
        let marks = trial.marks().iter().filter(|mark| mark.channel == channel);
        let (time, values): (Vec<f64>, Vec<f64>) = marks.map(|mark| (mark.time, mark.value)).unzip();
        curve(&time, &values)
    };
    let data = figures::RawRecord {
        title: title(record),
        heading: curve(trial.time(), trial.heading()),
        rudder: curve(trial.time(), trial.rudder()),
        marked_headings: marked(Channel::Heading),
        marked_rudder: marked(Channel::Rudder),
    };
    figures::raw_record(&data, theme)
}

fn replays(record: &Drawn, answers: &[(MethodEntry, Option<Estimate>)]) -> Replays {
    let trial = record.trial;
    let replays = replay_curves(trial, answers, |method| Origin::Method(method.to_owned()));
    Replays { title: title(record), record: curve(trial.time(), trial.heading()), truth: None, replays }
}

fn best_fit(record: &Drawn, replays: &Replays, theme: &Theme) -> Figure {
    let is_best = |replay: &&Replay| replay.origin == Origin::Method(BEST.to_owned());
    let best = replays.replays.iter().find(is_best).or_else(|| replays.replays.first());
    let fits = best.map(|replay| Fit {
        origin: replay.origin.clone(),
        heading: replay.heading.clone(),
        residual: replay.residual.clone(),
        rms_deg: replay.rms_deg,
        band: None,
    });
    let trial = record.trial;
    let data = RecordFit {
        title: title(record),
        heading: curve(trial.time(), trial.heading()),
        rudder: curve(trial.time(), trial.rudder()),
        fits: fits.into_iter().collect(),
    };
    figures::record_fit(&data, theme)
}
