//! `study predict`: what an identified ship will do. The prediction is that of the crate [`predict`]; here models are
//! read, and its words, tables, figures and files are made.

use std::path::{Path, PathBuf};

use predict::correction::{self, Correction, Doubt};
use predict::form::{self, Record};
use predict::known::is_same_length;
use predict::replay::Replayed;
use predict::turn::{self, Current};
use predict::{KnownShip, Mixture, PredictError, Prediction, imo, kind};
use report::number::fixed;
use serde_json::Value;
use ship::Particulars;
use ship::angle::KNOT;
use trial::file::{self, Kind};
use trial::{Sidecar, Trial};

use crate::options::{Common, PredictRequest, ReadingOptions};
use crate::records::{file_of, read_others};
use crate::views::page_files::write_page;
use crate::views::predict_file::{self, PredictFile};
use crate::views::predict_report::Predicted;
use crate::views::{predict_figures, predict_form, predict_page, predict_tables};
use crate::{progress, screen};
use campaign::folder::ResultFolder;
use scenario::failure::{Failure, OnPath};
use scenario::name;

/// What other programs read.
const PREDICT: &str = "predict.json";

/// The form of MSC/Circ.1053.
const FORM: &str = "trial-form.md";

/// Methods of fit.json in the order in which they are asked; those that are not named come last.
const METHODS: [&str; 3] = ["maximum-likelihood", "output-error", "srivc"];

/// What is known of a ship; the covariances of the longest mixtures have a hundredth of this.
const MODEL: Kind = Kind { name: "a model", largest: 1 << 26 };

/// A file with what is known of the ship.
struct Model {
    file: String,
    known: KnownShip,
    /// How it was identified.
    method: String,
}

/// The ships of several models at a scale.
fn mixture_of(models: &[Model], particulars: Option<Particulars>) -> Result<Mixture, PredictError> {
    let of =
        |model: &Model| -> Result<(KnownShip, f64), PredictError> { Ok((at_scale(&model.known, particulars)?, 1.0)) };
    Mixture::new(models.iter().map(of).collect::<Result<_, _>>()?)
}

/// Predicts, prints what was found, writes `predict.json`, `report.md`, `report.html`, tables and figures.
///
/// Fails when a model or a record cannot be read, and when hardly any drawn ship comes to the end of a manoeuvre.
pub fn run(request: &PredictRequest, common: &Common) -> Result<(), Failure> {
    let theme = request.style.theme()?;
    if !request.ballast.is_empty() && request.replays.is_empty() {
        return Err(Failure::input(
            "--ballast is the model of a ship as she was tried, and no trial is given; name the record that is to be \
             corrected to full load with --replay",
        ));
    }
    let mut warnings = Vec::new();
    let models: Vec<Model> =
        request.models.iter().map(|path| read(path, request, &mut warnings)).collect::<Result<_, _>>()?;
    let ballast: Vec<Model> =
        request.ballast.iter().map(|path| read(path, request, &mut warnings)).collect::<Result<_, _>>()?;
    let given = match &request.current_from {
        Some(path) => Some(current_from(path, request, &mut warnings)?),
        None => None,
    };
    let records: Vec<(Trial, Option<Current>)> = read_others(&request.replays, &request.reading, &mut warnings)?
        .into_iter()
        .map(|record| at_own_scale(record, &mut warnings))
        .map(|record| turn::without_current(record, given))
        .collect();
    let declared = match (&request.reading.columns, request.form && records.is_empty()) {
        (Some(path), true) if path.is_file() => Some(Sidecar::load(path).map_err(Failure::input)?),
        _ => None,
    };
    let first = models[0].file.clone();
    let refused = |error: PredictError| Failure::input(format!("{first}: {error}"));
    let mixture = mixture_of(&models, asked_scale(&request.reading)).map_err(refused)?;
    let kinds = manoeuvres(request);
    let draws = request.draws as usize;
    let busy = progress::busy("predicting", common.quiet);
    let mut manoeuvres: Vec<Prediction> = Vec::with_capacity(kinds.len());
    let mut lost = None;
    for kind in &kinds {
        match mixture.predict(kind, draws, true) {
            Ok(prediction) => manoeuvres.push(prediction),
            // One manoeuvre that the model cannot make says nothing of the others.
            Err(error @ PredictError::Lost { .. }) => {
                warnings.push(format!("{first}: {error}; it is left out"));
                lost = Some(error);
            }
            Err(error) => return Err(refused(error)),
        }
    }
    if let Some(error) = lost.filter(|_| manoeuvres.is_empty() && records.is_empty()) {
        return Err(refused(error));
    }
    let (mut replays, mut corrections) = (Vec::with_capacity(records.len()), Vec::with_capacity(records.len()));
    for (record, current) in records {
        let (replayed, correction) = held_against((&record, current), [&models, &ballast], request, &mut warnings)?;
        replays.push((record, replayed));
        corrections.push(correction);
    }
    busy.finish_and_clear();
    let particulars = mixture.particulars();
    let form = request.form.then(|| {
        let records: Vec<Record> = (replays.iter().zip(&corrections))
            .map(|((trial, replayed), correction)| Record {
                trial,
                correction: correction.as_ref(),
                current: replayed.current,
            })
            .collect();
        let path = request.reading.columns.as_ref().map(|path| path.display().to_string());
        let words = path.as_deref().zip(declared.as_ref().map(Sidecar::conditions));
        form::fill(&manoeuvres, particulars, &records, words)
    });
    let weight = 1.0 / models.len() as f64;
    let predicted = Predicted {
        criteria: particulars.map(|particulars| imo::criteria(&manoeuvres, particulars)).unwrap_or_default(),
        models: models.iter().map(|model| (model.file.clone(), weight)).collect(),
        ballast: ballast.iter().map(|model| model.file.clone()).collect(),
        corrections,
        form,
        draws,
        calm: request.calm,
        manoeuvres,
        replays,
        particulars,
        hull: mixture.first().hull.is_some(),
        seen: mixture.first().seen,
    };
    let folder = ResultFolder::hold(&common.out.clone().unwrap_or_else(|| default_folder(&request.models[0])))?;
    let path = folder.path().join(PREDICT);
    let json = serde_json::to_string_pretty(&PredictFile::of(&predicted)).on("describe", &path)?;
    folder.keep(PREDICT, json + "\n")?;
    let drawn = predict_figures::draw(&predicted, &theme, &folder)?;
    for (stem, table) in predict_file::curves(&predicted) {
        folder.write(&format!("{stem}.csv"), table)?;
    }
    write_page(&folder, &predict_page::page(&predicted, &drawn))?;
    let mut notes = format!("\nresults: {}", path.display());
    if let Some(form) = &predicted.form {
        folder.write(FORM, predict_form::page(form, &predicted))?;
        notes += &format!("\nform:    {}", folder.path().join(FORM).display());
    }
    let words = [predict_page::words(&predicted), predict_page::rest(&predicted)];
    screen::tell(common, words.each_ref().map(String::as_str), &predict_tables::figures(&predicted), &notes)?;
    for warning in warnings {
        screen::warn(&format!("warning: {warning}"));
    }
    Ok(())
}

/// The manoeuvres that were asked for; those of the IMO criteria where nothing is; those of the form beside them.
fn manoeuvres(request: &PredictRequest) -> Vec<kind::Kind> {
    let mut kinds = match (request.manoeuvres.as_slice(), request.replays.is_empty() && !request.form) {
        ([], true) => kind::Kind::of_imo(),
        (asked, _) => asked.to_vec(),
    };
    for kind in form::manoeuvres() {
        if request.form && !kinds.contains(&kind) {
            kinds.push(kind);
        }
    }
    kinds
}

/// Whether a record is of a ship of this length, m, as far as is known.
fn is_of(record: &Trial, length: f64) -> bool {
    record.particulars().is_none_or(|own| is_same_length(own.length, length))
}

/// A record at the scale that its sidecar declares, where another one is asked for: a model is replayed as a model.
fn at_own_scale(record: Trial, warnings: &mut Vec<String>) -> Trial {
    let Some(own) = record.conditions().particulars.filter(|own| !is_of(&record, own.length)) else { return record };
    warnings.push(format!(
        "{}: its sidecar says {} m at {} m/s; it is replayed at that scale, and manoeuvres are predicted at the other",
        file_of(&record).0,
        fixed(own.length, 2),
        fixed(own.speed, 2)
    ));
    record.with_particulars(own)
}

/// A record beside its replay, and corrected to full load where there is a model of its condition; `models` are those
/// at full load and those in the condition of the record.
fn held_against(
    (record, current): (&Trial, Option<Current>),
    [full, ballast]: [&[Model]; 2],
    request: &PredictRequest,
    warnings: &mut Vec<String>,
) -> Result<(Replayed, Option<Correction>), Failure> {
    // A speed that is not given is that of Froude, not that of a record which loses speed from its first rows on.
    let asked = asked_scale(&request.reading);
    let scale = asked.filter(|asked| is_of(record, asked.length)).or_else(|| record.particulars());
    let scaled = |models: &[Model]| {
        mixture_of(models, scale).map_err(|error| Failure::input(format!("{}: {error}", models[0].file)))
    };
    let file = file_of(record).0;
    let draws = request.draws as usize;
    let own = scaled(if ballast.is_empty() { full } else { ballast })?;
    let replayed = own.replay(record, draws, current).map_err(|error| Failure::input(format!("{file}: {error}")))?;
    let Some(replayed) = replayed else {
        let what = "too few headings at its beginning to say how the ship began";
        return Err(Failure::input(format!("{file}: {what}; choose a part with --from in `study find`")));
    };
    if ballast.is_empty() {
        return Ok((replayed, None));
    }
    let mut correction = match correction::correct(&scaled(full)?, &own, record, draws) {
        Ok(correction) => correction,
        Err(error @ PredictError::Lost { .. }) => {
            warnings.push(format!("{file}: {error}; it is not corrected to full load"));
            return Ok((replayed, None));
        }
        Err(error) => return Err(Failure::input(format!("{file}: {error}"))),
    };
    if correction.figures.is_empty() {
        warnings.push(format!(
            "{file}: it shows no figure of a zig-zag or a turn from its first execute on; it is not corrected to full load"
        ));
        return Ok((replayed, None));
    }
    let mut of_models = correction::differences(&full[0].known, &ballast[0].known);
    if full[0].method != ballast[0].method {
        let [full, trial] = [full, ballast].map(|models| models[0].method.clone());
        of_models.push(Doubt::Method { full, trial });
    }
    correction.doubts.splice(0..0, of_models);
    Ok((replayed, Some(correction)))
}

/// Length and speed that were asked for.
fn asked_scale(options: &ReadingOptions) -> Option<Particulars> {
    let length = options.length_m?;
    let speed = options.speed_m_s.or(options.speed_kn.map(|speed| speed * KNOT));
    Some(Particulars { length, speed: speed.unwrap_or(f64::NAN) })
}

/// A ship at the scale that was asked for; one whose scale is not known takes it as its own.
fn at_scale(known: &KnownShip, asked: Option<Particulars>) -> Result<KnownShip, PredictError> {
    let Some(Particulars { length, speed }) = asked else { return Ok(known.clone()) };
    let speed = Some(speed).filter(|speed| speed.is_finite());
    match (known.length_m, speed) {
        (None, Some(_)) => Ok(KnownShip { length_m: Some(length), speed_m_s: speed, ..known.clone() }),
        // The speed of a trial is read off its beginning and never quite that of another.
        (Some(own), _) if is_same_length(own, length) => Ok(known.clone()),
        _ => known.scaled_to(length, speed),
    }
}

/// Where the results go unless a folder is named: after the folder of the model, which has the name of its record.
fn default_folder(model: &Path) -> PathBuf {
    let named = |path: &Path| path.file_name().map(|name| name.to_string_lossy().into_owned());
    let own =
        model.parent().and_then(named).or_else(|| model.file_stem().map(|stem| stem.to_string_lossy().into_owned()));
    let own = own.filter(|name| !name.is_empty()).unwrap_or_else(|| String::from("model"));
    PathBuf::from(format!("{own}-predict"))
}

fn read(path: &Path, request: &PredictRequest, warnings: &mut Vec<String>) -> Result<Model, Failure> {
    let shown = path.display().to_string();
    name::of_file(path)?;
    let text = file::read_text(path, MODEL).map_err(|error| {
        Failure::input(format!("{shown}: {error}; expected the fit.json or trace.json of this program"))
    })?;
    let value: Value = serde_json::from_str(&text).map_err(|error| {
        Failure::input(format!(
            "{shown}: this is no JSON ({error}); expected the fit.json or trace.json of this program"
        ))
    })?;
    let old = |what: &str| {
        Failure::input(format!(
            "{shown}: {what}; it was written by an older program, make it again with `study {what}`"
        ))
    };
    let (known, method) = match value["schema"].as_str() {
        Some(schema) if schema.starts_with("fit/") => {
            let ships = value.get("ships").and_then(Value::as_object).ok_or_else(|| old("fit"))?;
            let id = method(&shown, ships, request.method.as_deref())?;
            if request.method.is_none() {
                warnings.push(format!("{shown}: the answer of {id} is used; --method names another"));
            }
            (ships[&id].clone(), id)
        }
        Some(schema) if schema.starts_with("trace/") => {
            (value.get("ship").cloned().ok_or_else(|| old("trace"))?, String::from("trace"))
        }
        found => {
            let found = found.map_or_else(|| String::from("no `schema`"), |schema| format!("schema = \"{schema}\""));
            return Err(Failure::input(format!(
                "{shown}: {found}; expected the fit.json or trace.json of this program"
            )));
        }
    };
    let known: KnownShip = serde_json::from_value(known)
        .map_err(|error| Failure::input(format!("{shown}: what is known of the ship cannot be read: {error}")))?;
    if known.leans_on_sway() {
        warnings.push(format!(
            "{shown}: a term of the model takes the measured sway, and here that of an equation fitted to it; intervals of \
             such models held less often than others, so trace again with --without-effect sway_coupling_measured"
        ));
    }
    let known = if request.calm { known.in_calm() } else { Ok(known) };
    Ok(Model { known: known.map_err(|error| Failure::input(format!("{shown}: {error}")))?, file: shown, method })
}

/// The current that a record shows.
fn current_from(path: &Path, request: &PredictRequest, warnings: &mut Vec<String>) -> Result<Current, Failure> {
    let records = read_others(std::slice::from_ref(&path.to_owned()), &request.reading, warnings)?;
    records.first().and_then(turn::current_of).ok_or_else(|| {
        Failure::input(format!(
            "--current-from {}: this record shows no current; give positions north_m and east_m of a circle in which the \
             rudder is held for 720° or more",
            path.display()
        ))
    })
}

/// The method whose answer is used.
fn method(file: &str, ships: &serde_json::Map<String, Value>, asked: Option<&str>) -> Result<String, Failure> {
    let known: Vec<&str> = ships.keys().map(String::as_str).collect();
    if known.is_empty() {
        let what = "no method has a covariance for this record, so there are no intervals to predict";
        return Err(Failure::input(format!("{file}: {what}; use a longer record or several")));
    }
    match asked {
        Some(asked) if known.contains(&asked) => Ok(asked.to_owned()),
        Some(asked) => Err(Failure::input(format!(
            "{file}: --method {asked}: this file has no such answer with a covariance; use one of {}",
            known.join(", ")
        ))),
        None => Ok(METHODS.into_iter().find(|id| known.contains(id)).unwrap_or(known[0]).to_owned()),
    }
}
