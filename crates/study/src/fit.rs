//! `study fit`: identify measured records with every method, replay the answers on them and on others.

use std::fs;
use std::path::Path;

use identify::replay::replay;
use identify::{Estimate, IdentifierSettings, Identifier, registry};
use report::Theme;
use report::figures::{self, Fit, RecordFit, Replays};
use report::Origin as Who;
use ship::angle::to_deg;
use trial::{Origin, Reading, Trial, ZigZag, imo};

use crate::cli::{Common, FitRequest};
use crate::failure::{Failure, OnPath};
use crate::json::{self, CriterionEntry, FitFile, MethodEntry, TrialEntry, Validation, ZigZagEntry};
use crate::present;
use crate::run::{folder_of, slug, write_figure};
use crate::showcase::{curve, replay_curves, zigzag_figure};

/// Rows a figure can show; a longer record is drawn thinned.
const DRAWN_ROWS: usize = 4000;

/// Identifies the records, prints the table, writes figures and `fit.json`.
pub fn run(request: &FitRequest, common: &Common) -> Result<(), Failure> {
    let methods = methods(&request.methods)?;
    let columns = request.columns.as_deref();
    let trials = request.trials.iter().map(|path| read(path, columns)).collect::<Result<Vec<Trial>, _>>()?;
    let others = request.validate.iter().map(|path| read(path, columns)).collect::<Result<Vec<Trial>, _>>()?;

    let answers: Vec<(MethodEntry, Option<Estimate>)> = methods
        .iter()
        .map(|method| {
            let (mut entry, estimate) = json::entry(method.id(), method.identify(&trials), &trials);
            entry.validation = others.iter().map(|other| validate(other, estimate.as_ref())).collect();
            (entry, estimate)
        })
        .collect();
    let entries: Vec<MethodEntry> = answers.iter().map(|(entry, _)| entry.clone()).collect();
    // A record that no method can use is wrong input, not a result.
    if entries.iter().all(|entry| entry.parameters.is_none()) {
        let reason = entries[0].reason.as_deref().unwrap_or("no method gave an answer");
        return Err(Failure::input(format!("{}: no method can identify this record: {reason}", request.trials[0].display())));
    }

    let zigzag = ZigZag::of(&trials[0]);
    let folder = folder_of(common, &slug(trials[0].name()), "fit");
    fs::create_dir_all(&folder).on("create", &folder)?;
    let file = FitFile {
        schema: "fit/1".into(),
        trials: trials.iter().map(trial_entry).collect(),
        methods: entries,
        zigzag: zigzag.as_ref().ok().map(|zigzag| zigzag_entry(zigzag, &trials[0])),
    };
    let path = folder.join("fit.json");
    let text = serde_json::to_string_pretty(&file).on("describe", &path)?;
    fs::write(&path, text + "\n").on("write", &path)?;
    draw(&trials, &others, &answers, zigzag.as_ref().ok(), &folder)?;

    if !common.quiet {
        let samples: usize = trials.iter().map(Trial::len).sum();
        println!("{} records, {samples} rows\n", trials.len());
        println!("{}", present::render(&present::methods(&file.methods), common.format));
        match (&zigzag, &file.zigzag) {
            (_, Some(entry)) => println!("{}", characteristics(entry)),
            (Err(error), _) => println!("no zig-zag characteristics: {error}"),
            (Ok(_), None) => {}
        }
        println!("results: {}", path.display());
    }
    for entry in &file.methods {
        for warning in &entry.warnings {
            eprintln!("{}: {warning}", entry.method);
        }
    }
    Ok(())
}

fn methods(names: &[String]) -> Result<Vec<Box<dyn Identifier>>, Failure> {
    let all: Vec<Box<dyn Identifier>> = registry::defaults()
        .iter()
        .map(IdentifierSettings::build)
        .collect::<Result<_, _>>()
        .map_err(|error| Failure::work(format!("default settings: {error}")))?;
    let known: Vec<&str> = all.iter().map(|method| method.id()).collect();
    if let Some(unknown) = names.iter().find(|name| !known.contains(&name.as_str())) {
        return Err(Failure::input(format!("--method {unknown}: no such method; expected one of {}", known.join(", "))));
    }
    Ok(all.into_iter().filter(|method| names.is_empty() || names.iter().any(|name| name == method.id())).collect())
}

fn read(path: &Path, columns: Option<&Path>) -> Result<Trial, Failure> {
    let reading = match columns {
        Some(columns) => trial::read_with(path, Some(columns)),
        None => trial::read(path),
    };
    let Reading { trial, warnings } = reading.map_err(Failure::input)?;
    for warning in warnings {
        eprintln!("{}: {warning}", path.display());
    }
    Ok(trial)
}

fn validate(other: &Trial, estimate: Option<&Estimate>) -> Validation {
    Validation {
        file: file_of(other).0.to_owned(),
        heading_rmse_deg: estimate.and_then(|estimate| replay(other, &estimate.response)).map(|replay| replay.heading_rmse_deg),
    }
}

/// File and hash of a measured record.
fn file_of(trial: &Trial) -> (&str, &str) {
    match trial.origin() {
        Origin::Measured { file, sha256 } => (file, sha256),
        Origin::Simulated { scenario, .. } => (scenario, ""),
    }
}

fn trial_entry(trial: &Trial) -> TrialEntry {
    let (file, sha256) = file_of(trial);
    TrialEntry { file: file.into(), sha256: sha256.into(), samples: trial.len(), duration_s: trial.duration() }
}

fn zigzag_entry(zigzag: &ZigZag, trial: &Trial) -> ZigZagEntry {
    let criteria = trial.particulars().map(|particulars| imo::criteria(zigzag, particulars)).unwrap_or_default();
    ZigZagEntry {
        initial_turning_time_s: zigzag.initial_turning_time.map(|time| time.value),
        overshoots_deg: zigzag.overshoots.iter().map(|overshoot| to_deg(overshoot.angle.value)).collect(),
        overshoots_sd_deg: zigzag.overshoots.iter().map(|overshoot| overshoot.angle.sd.map(to_deg)).collect(),
        period_s: zigzag.period.map(|period| period.value),
        imo: criteria
            .iter()
            .map(|criterion| CriterionEntry {
                criterion: criterion.name.into(),
                measured: criterion.measured.map(|measured| measured.value),
                limit: criterion.limit,
                unit: criterion.unit.symbol().into(),
                verdict: match criterion.verdict {
                    imo::Verdict::Pass => "pass",
                    imo::Verdict::Fail => "fail",
                    imo::Verdict::NotMeasured => "not measured",
                }
                .into(),
            })
            .collect(),
    }
}

/// Characteristics in words, and the IMO table where the ship is known.
fn characteristics(entry: &ZigZagEntry) -> String {
    use report::number::{fixed, optional, with_uncertainty};
    let overshoots: Vec<String> = entry
        .overshoots_deg
        .iter()
        .zip(&entry.overshoots_sd_deg)
        .map(|(&angle, &sd)| with_uncertainty(angle, sd))
        .collect();
    let mut text = format!(
        "zig-zag: initial turning time {} s, overshoots {} deg, period {} s\n",
        optional(entry.initial_turning_time_s, 2),
        overshoots.join(", "),
        optional(entry.period_s, 1),
    );
    for criterion in &entry.imo {
        text += &format!(
            "  {}: {} {} (limit {}): {}\n",
            criterion.criterion,
            optional(criterion.measured, 2),
            criterion.unit,
            fixed(criterion.limit, 1),
            criterion.verdict
        );
    }
    text
}

fn draw(
    trials: &[Trial],
    others: &[Trial],
    answers: &[(MethodEntry, Option<Estimate>)],
    zigzag: Option<&ZigZag>,
    folder: &Path,
) -> Result<(), Failure> {
    let theme = Theme::screen();
    if let Some(zigzag) = zigzag {
        let data = figures::ZigzagTrial { title: Some(trials[0].name().into()), ..zigzag_figure(&trials[0], zigzag) };
        write_figure(&figures::zigzag_trial(&data, &theme), folder, "trial")?;
    }
    for (number, trial) in trials.iter().chain(others).enumerate() {
        let suffix = if number == 0 { String::new() } else { format!("-{}", slug(trial.name())) };
        let title = match number < trials.len() {
            true => trial.name().to_owned(),
            false => format!("{} (validation)", trial.name()),
        };
        let keep = trial.len().div_ceil(DRAWN_ROWS);
        let thin = |time: &[f64], angle: &[f64]| {
            let every = |values: &[f64]| values.iter().copied().step_by(keep).collect::<Vec<f64>>();
            curve(&every(time), &every(angle))
        };
        let replays = Replays {
            title: Some(title.clone()),
            record: thin(trial.time(), trial.heading()),
            truth: None,
            replays: replay_curves(trial, answers, |label| Who::Method(label.to_owned())),
        };
        write_figure(&figures::replays(&replays, &theme), folder, &format!("replays{suffix}"))?;
        let best = answers.iter().filter(|(entry, _)| entry.method == "output-error").chain(answers);
        let fits = best
            .filter_map(|(entry, estimate)| {
                let replay = replay(trial, &estimate.as_ref()?.response)?;
                Some(Fit {
                    origin: Who::Method(entry.method.clone()),
                    heading: thin(&replay.time, &replay.heading),
                    residual: thin(&replay.residual_time, &replay.residual),
                    rms_deg: Some(replay.heading_rmse_deg),
                })
            })
            .take(1)
            .collect();
        let record = RecordFit {
            title: Some(title),
            heading: thin(trial.time(), trial.heading()),
            rudder: thin(trial.time(), trial.rudder()),
            fits,
        };
        write_figure(&figures::record_fit(&record, &theme), folder, &format!("fit{suffix}"))?;
    }
    Ok(())
}
