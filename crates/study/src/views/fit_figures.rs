//! Figures of `study fit`: the first record with its characteristic points, every record with the replays of all
//! methods and with the best fit, over time and in the phase plane, and K and T of all methods and of every record
//! alone.

use identify::Estimate;
use identify::replay::replay;
use rayon::prelude::*;
use report::figures::{self, Fit, Layer, Layers, Panels, Pen, PhasePlane, RecordFit, Replay, Replays, Ruler, Stack};
use report::palette::{BEFORE, Look, Marker, RUDDER, SOLID};
use report::{Figure, Origin, Theme};
use ship::Particulars;
use trial::{Channel, Trial, ZigZag};

use super::picture::write_figure;
use super::{curve_tables, index_figures};
use crate::work::alone::Amplitudes;
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

/// What is drawn of all records together.
pub struct Whole {
    /// Name of the records.
    pub title: String,
    /// Length and speed, where they are known.
    pub ship: Option<Particulars>,
    /// Every zig-zag alone, where there are several.
    pub amplitudes: Option<Amplitudes>,
}

/// Draws everything into `folder`: `trial` (of a zig-zag that was fitted), `raw` (where readings are left out or
/// doubtful), `replays`, `fit` and `phase` of the first record, and the same with `-NAME` of the others; `indices`, K
/// and T of all methods, and `amplitude`, those of every record alone. Beside them `replay.csv`, the curves of
/// `replays`. Returns stems and captions.
pub fn draw(
    records: &[Drawn],
    answers: &[(MethodEntry, Option<Estimate>)],
    whole: &Whole,
    theme: &Theme,
    folder: &ResultFolder,
) -> Result<Vec<(String, String)>, Failure> {
    let mut drawn = vec![told("indices", "", &whole.title)];
    let indices = index_figures::index_plane(whole.title.clone(), answers, whole.ship);
    write_figure(&figures::index_plane(&indices, theme), folder, "indices")?;
    if let Some(all) = &whole.amplitudes {
        let joint = answers.iter().find(|(entry, _)| entry.method == all.method);
        let joint = joint.and_then(|(_, estimate)| estimate.as_ref()).map(|estimate| [estimate.K(), estimate.T()]);
        let data = index_figures::amplitude(whole.title.clone(), all, joint, whole.ship);
        write_figure(&figures::amplitude(&data, theme), folder, "amplitude")?;
        drawn.push(told("amplitude", "", &whole.title));
    }
    let work = records.par_iter().enumerate().map(|(number, record)| {
        let suffix = if number == 0 { String::new() } else { format!("-{}", record.name) };
        let mut drawn = Vec::new();
        let mut put = |figure: &Figure, kind: &str| {
            drawn.push(told(kind, &suffix, record.name));
            write_figure(figure, folder, &format!("{kind}{suffix}"))
        };
        if let Some(zigzag) = ZigZag::of(record.trial).ok().filter(|_| !record.validation) {
            let data =
                figures::ZigzagTrial { title: Some(record.name.to_owned()), ..zigzag_figure(record.trial, &zigzag) };
            put(&figures::zigzag_trial(&data, theme), "trial")?;
        }
        if !record.trial.rejected().is_empty() {
            put(&raw(record, theme), "raw")?;
        }
        let replays = replays(record, answers);
        put(&figures::replays(&replays, theme), "replays")?;
        let rudder = curve(record.trial.time(), record.trial.rudder());
        folder.write(&format!("replay{suffix}.csv"), curve_tables::of_replays(&replays, Some(&rudder)))?;
        if let Some(phase) = phase(record, answers) {
            put(&figures::phase_plane(&phase, theme), "phase")?;
        }
        put(&best_fit(record, &replays, theme), "fit")?;
        Ok::<Vec<(String, String)>, Failure>(drawn)
    });
    // The first failure in order, whichever came first in time.
    for of_record in work.collect::<Vec<_>>() {
        drawn.extend(of_record?);
    }
    Ok(drawn)
}

/// Stem and caption of a kind of figure.
fn told(kind: &str, suffix: &str, name: &str) -> (String, String) {
    let what = match kind {
        "indices" => "K and T of every method with the intervals and regions it quotes.",
        "amplitude" => {
            "K and T of a first-order response fitted to every record alone, over the amplitude of its zig-zag."
        }
        "trial" => "heading and rudder, with the characteristics of the zig-zag.",
        "raw" => "the record as it was read, with marks at the readings that are left out or doubtful.",
        "replays" => "the recorded rudder replayed with the answer of every method, and what is left of the heading.",
        "phase" => "yaw rate against heading, of the record and of the replay of one method.",
        _ => "heading, residual and rudder with the replay of one method.",
    };
    (format!("{kind}{suffix}"), format!("{name}: {what}"))
}

fn title(record: &Drawn) -> Option<String> {
    Some(if record.validation { format!("{} (validation)", record.name) } else { record.name.to_owned() })
}

/// The record with marks at the readings that are left out or doubtful.
fn raw(record: &Drawn, theme: &Theme) -> Figure {
    let trial = record.trial;
    let look = Look { colour: BEFORE, marker: Marker::Diamond, dash: SOLID, hollow: true };
    let marked = |channel: Channel| {
        let marks = trial.rejected().iter().filter(|mark| mark.channel == channel);
        let (time, values): (Vec<f64>, Vec<f64>) = marks.map(|mark| (mark.time, mark.value)).unzip();
        let none = vec![None; time.len()];
        Layer::new("left out or doubtful", curve(&time, &values), figures::Drawn::Marks(look, none))
    };
    let heading = Layer::new("recorded heading", curve(trial.time(), trial.heading()), figures::Drawn::Record);
    let pen = figures::Drawn::Line(Pen::new(RUDDER));
    let rudder = Layer::new("recorded rudder", curve(trial.time(), trial.rudder()), pen);
    let upper = vec![heading, marked(Channel::Heading)];
    let lower = vec![rudder, marked(Channel::Rudder)];
    let rows = vec![
        Layers { y: Ruler::heading(), height: 0.3, layers: upper, ..Layers::default() },
        Layers { y: Ruler::rudder(), height: 0.16, zero: true, layers: lower, ..Layers::default() },
    ];
    let stack = Stack { x: Ruler::time(), panels: rows, ..Stack::default() };
    figures::panels(&Panels { title: title(record), stacks: vec![stack], ..Panels::default() }, theme)
}

fn replays(record: &Drawn, answers: &[(MethodEntry, Option<Estimate>)]) -> Replays {
    let trial = record.trial;
    let replays = replay_curves(trial, answers, |method| Origin::Method(method.to_owned()));
    Replays { title: title(record), record: curve(trial.time(), trial.heading()), truth: None, replays }
}

/// The record in the phase plane with the replay that is drawn on its own in `fit`.
fn phase(record: &Drawn, answers: &[(MethodEntry, Option<Estimate>)]) -> Option<PhasePlane> {
    let found = || answers.iter().filter_map(|(entry, estimate)| Some((&entry.method, estimate.as_ref()?)));
    let (method, estimate) = found().find(|(method, _)| *method == BEST).or_else(|| found().next())?;
    let replay = replay(record.trial, &estimate.response)?;
    let fit = index_figures::phase_of(Origin::Method(method.clone()), &replay);
    Some(index_figures::phase_plane(title(record)?, record.trial, vec![fit]))
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
