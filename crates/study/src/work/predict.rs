//! A prediction: the ships that models stand for, steered through manoeuvres and held against records.

use std::collections::BTreeMap;
use std::path::Path;

use document::IdentifiedShip;
use identify::hull::Likeness;
use identify::suspicion::unusual_froude_number;
use predict::correction::{self, Correction};
use predict::document::{ModelWeight, OtherLoading};
use predict::form::{self, FormRecord};
use predict::replay::RecordReplay;
use predict::turn::{self, Current};
use predict::{PredictDocument, PredictError, Prediction, ShipMixture, imo, standard};
use report::number::fixed;
use scenario::TRACE;
use scenario::failure::Failure;
use ship::Particulars;
use trial::{Manoeuvre, Trial, file};

use super::earlier::{EarlierModel, with_earlier};
use super::loading::{DescribedLoading, only_hull};
use super::stored_answer::{StoredAnswer, ships_of, text_of};
use super::target_scale::{self, Declared, TargetScale, at_scale, is_alike, of_two_scales};
use crate::options::PredictRequest;
use crate::progress::ProgressSteps;
use crate::records::{file_of, rudder_logged_late};

/// Methods of fit.json in the order in which they are asked; those that are not named come last.
const METHODS: [&str; 3] = ["maximum-likelihood", "output-error", "srivc"];

/// What is known of a ship, and from where.
#[derive(Clone)]
pub struct StoredModel {
    file: String,
    known: IdentifiedShip,
    /// How it was identified.
    method: String,
    /// The records that are in it: their files by their SHA-256.
    records: BTreeMap<String, String>,
}

/// The files of some models.
fn files(models: &[StoredModel]) -> Vec<String> {
    models.iter().map(|model| model.file.clone()).collect()
}

/// The ships of several models at a scale, which have to be alike.
fn mixture_of(models: &[StoredModel], scale: Option<TargetScale>) -> Result<ShipMixture, Failure> {
    let mut ships: Vec<(IdentifiedShip, f64)> = Vec::with_capacity(models.len());
    for model in models {
        let ship = at_scale(&model.known, scale).map_err(|error| Failure::about(&model.file, error))?;
        let [first, own] = [ships.first().map_or(&ship, |(first, _)| first), &ship].map(IdentifiedShip::particulars);
        if !first.zip(own).map_or(first == own, |(first, own)| is_alike(first, own)) {
            return Err(of_two_scales([(&models[0].file, first), (&model.file, own)]));
        }
        ships.push((ship, 1.0));
    }
    ShipMixture::new(ships).map_err(|error| Failure::about(&files(models).join(", "), error))
}

impl StoredModel {
    /// What is known of the ship in a file, as a request asks for it.
    ///
    /// Fails when it cannot be read, and as [`of_document`](Self::of_document) does.
    pub fn of_file(path: &Path, request: &PredictRequest, warnings: &mut Vec<String>) -> Result<Self, Failure> {
        let shown = file::called(path).display().to_string();
        Self::of_document(&shown, &text_of(path)?, request.method.as_deref(), request.calm, warnings)
    }

    /// What is known of the ship in the text of a `fit.json` or `trace.json`; of several methods the named one, or the
    /// one whose intervals hold most. `calm` leaves the weather of the records out. `shown` is what messages call it.
    ///
    /// Fails when the text is no such document, and when it holds no answer with a covariance.
    pub fn of_document(
        shown: &str,
        text: &str,
        asked: Option<&str>,
        calm: bool,
        warnings: &mut Vec<String>,
    ) -> Result<Self, Failure> {
        let StoredAnswer { mut ships, verdict, records } = ships_of(shown, text)?;
        // A trace has one answer.
        let asked = asked.filter(|_| !ships.contains_key(TRACE));
        let method = method(shown, &ships, asked.or(verdict.as_deref()))?;
        if asked.is_none() && ships.len() > 1 {
            warnings.push(format!("{shown}: the answer of {method} is used; --method names another"));
        }
        let known = ships.remove(&method).expect("it was found there");
        if let Some(late) = known.rudder_logged_late() {
            warnings.push(format!("{shown}: {}; she is steered without it", rudder_logged_late(late)));
        }
        let known = if calm { known.in_calm() } else { Ok(known) };
        let known = known.map_err(|error| Failure::about(shown, error))?;
        Ok(Self { known, file: shown.to_owned(), method, records })
    }

    /// The same after earlier trials that it has not seen, and what is said of them.
    fn after(&self, earlier: &[EarlierModel], warnings: &mut Vec<String>) -> Result<(Self, String), Failure> {
        let (known, said) = with_earlier(earlier, (&self.file, &self.known, &self.records), warnings)?;
        let mut records = self.records.clone();
        records.extend(earlier.iter().flat_map(|own| own.records.clone()));
        Ok((Self { known, records, ..self.clone() }, format!("{}: {}", self.file, said.sentence())))
    }

    /// The same with what another function makes of the ship, which is given the name of the file.
    fn with(
        &self,
        make: impl FnOnce(&str, &IdentifiedShip) -> Result<IdentifiedShip, Failure>,
    ) -> Result<Self, Failure> {
        Ok(Self { known: make(&self.file, &self.known)?, ..self.clone() })
    }
}

/// What a prediction is made from.
pub struct PredictInput<'a> {
    /// The ship; several models are a mixture, all alike.
    pub models: &'a [StoredModel],
    /// Earlier trials of the ship, which the models have not seen.
    pub earlier: &'a [EarlierModel],
    /// The same ship as she was loaded in the records; empty where they need no correction.
    pub ballast: &'a [StoredModel],
    /// Records that are held against their prediction.
    pub records: Vec<Trial>,
    /// What is taken out of the tracks of their turns; `None` for what each shows itself.
    pub current: Option<Current>,
    /// What a sidecar says where there are no records.
    pub declared: Declared<'a>,
}

/// The manoeuvres that were asked for; those of the IMO criteria where nothing is; those of the form beside them.
fn manoeuvres(request: &PredictRequest) -> Vec<Manoeuvre> {
    let mut kinds = match (request.manoeuvres.as_slice(), request.replays.is_empty() && !request.form) {
        ([], true) => standard::of_imo(),
        (asked, _) => asked.to_vec(),
    };
    let mut of_form = form::manoeuvres();
    of_form.retain(|kind| request.form && !kinds.contains(kind));
    kinds.extend(of_form);
    kinds
}

/// The manoeuvres that drawn ships come to the end of, and why the last of the others is lost; `file` is what messages
/// call the model.
fn predictions(
    (kinds, draws): (&[Manoeuvre], usize),
    mixture: &ShipMixture,
    file: &str,
    steps: &ProgressSteps,
    warnings: &mut Vec<String>,
) -> Result<(Vec<Prediction>, Option<PredictError>), Failure> {
    let (mut predictions, mut lost) = (Vec::new(), None);
    for kind in kinds {
        let prediction = mixture.predict(kind, draws, true);
        steps.advance();
        match prediction {
            Ok(prediction) => {
                warnings.extend(prediction.undetermined.iter().map(|(name, interval)| {
                    let [low, high] = interval.ci90.map(|end| fixed(end, interval.decimals()));
                    format!(
                        "{file}: {kind}: {name} is left out: nine tenths of the drawn ships lie from {low} to {high}, so \
                         the records do not tell it; fit records with positions (north_m, east_m) or sway_m_s"
                    )
                }));
                predictions.push(prediction);
            }
            // One manoeuvre that the model cannot make says nothing of the others.
            Err(error @ PredictError::Lost { .. }) => {
                warnings.push(format!("{file}: {error}; it is left out"));
                lost = Some(error);
            }
            Err(error) => return Err(Failure::about(file, error)),
        }
    }
    Ok((predictions, lost))
}

/// Predicts the manoeuvres and replays the records.
///
/// Fails when a model cannot be brought to the scale or loading that is asked for, when a record does not say how the
/// ship began, and when hardly any drawn ship comes to the end of every manoeuvre.
pub fn predict(
    request: &PredictRequest,
    input: PredictInput,
    quiet: bool,
    warnings: &mut Vec<String>,
) -> Result<PredictDocument, Failure> {
    let PredictInput { models, earlier, ballast, records, current, declared } = input;
    let (told, said) = after_earlier(models, earlier, warnings)?;
    let models = if earlier.is_empty() { models } else { &told };
    let taken = request.load.as_ref().map(|load| at_loading(load, models, ballast, warnings)).transpose()?;
    let (models, ballast) = taken.as_ref().map_or((models, ballast), |(full, ballast, _)| (full, ballast));
    warnings.extend(records.iter().filter(|_| ballast.is_empty()).filter_map(|own| validates_nothing(models, own)));
    let draws = request.draws as usize;
    let scale = TargetScale::of(&request.scale, &records, declared)?;
    let mut in_still_water = |record| turn::without_current(target_scale::at_own_scale(record, warnings), current);
    let records: Vec<(Trial, Option<Current>)> = records.into_iter().map(&mut in_still_water).collect();
    let mixture = mixture_of(models, scale)?;
    let particulars = mixture.particulars();
    warnings.extend(particulars.and_then(unusual_froude_number));
    let file = files(models).join(", ");
    let kinds = manoeuvres(request);
    let steps = ProgressSteps::new("manoeuvres and records", (kinds.len() + records.len()) as u64, 0, 1, quiet);
    let (predictions, lost) = predictions((&kinds, draws), &mixture, &file, &steps, warnings)?;
    if let Some(error) = lost.filter(|_| predictions.is_empty() && records.is_empty()) {
        return Err(Failure::about(&file, error));
    }
    let loading = OtherLoading::name(taken.as_ref().map(|(.., load)| load));
    let (mut replays, mut corrections) = (Vec::with_capacity(records.len()), Vec::with_capacity(records.len()));
    for (record, current) in &records {
        let (replayed, correction) =
            held_against((record, *current), ([models, ballast], &loading), (scale, draws), warnings)?;
        replays.push(replayed);
        corrections.push(correction);
        steps.advance();
    }
    steps.finish();
    let weight = 1.0 / models.len() as f64;
    let mut document = PredictDocument {
        schema: String::from("predict/1"),
        models: files(models).into_iter().map(|file| ModelWeight { file, weight }).collect(),
        draws,
        calm: request.calm,
        length_m: particulars.map(|own| own.length),
        speed_m_s: particulars.map(|own| own.speed),
        imo: particulars.map(|own| imo::criteria(&predictions, own)).unwrap_or_default(),
        manoeuvres: predictions,
        replays,
        corrected: corrections.iter().flatten().cloned().collect(),
        ballast: files(ballast),
        earlier_trials: said,
        hull: !mixture.first().hulls.is_empty(),
        load: taken.as_ref().map(|(.., load)| load.clone()),
        seen: mixture.first().seen,
        ..PredictDocument::default()
    };
    if request.form {
        fill_form(&mut document, particulars, &records, &corrections, declared);
    }
    Ok(document)
}

/// Models with earlier trials that they have not seen, and what is said of each; nothing where there are none of these.
fn after_earlier(
    models: &[StoredModel],
    earlier: &[EarlierModel],
    warnings: &mut Vec<String>,
) -> Result<(Vec<StoredModel>, Vec<String>), Failure> {
    let told = models.iter().filter(|_| !earlier.is_empty()).map(|model| model.after(earlier, warnings));
    Ok(told.collect::<Result<Vec<_>, _>>()?.into_iter().unzip())
}

/// The warning that a record is in one of the models.
fn validates_nothing(models: &[StoredModel], record: &Trial) -> Option<String> {
    let (file, sha256) = file_of(record);
    let model = models.iter().find(|model| model.records.contains_key(sha256))?;
    Some(format!("{file}: {} is fitted to it; the error on it validates nothing", model.file))
}

/// Puts the form of MSC/Circ.1053 into a document that holds all else.
fn fill_form(
    document: &mut PredictDocument,
    particulars: Option<Particulars>,
    records: &[(Trial, Option<Current>)],
    corrections: &[Option<Correction>],
    declared: Declared,
) {
    let held = records.iter().zip(corrections).map(|((trial, current), correction)| FormRecord {
        trial,
        correction: correction.as_ref(),
        current: *current,
    });
    let held: Vec<FormRecord> = held.collect();
    let filled = form::fill(&document.manoeuvres, particulars, &document.model_files(), &held, declared);
    (document.form, document.form_remarks) = (Some(filled.entries), Some(filled.remarks));
}

/// Some models at another loading, those of the ship at her trials with the same hulls, and what is said of it.
fn at_loading(
    path: &Path,
    models: &[StoredModel],
    ballast: &[StoredModel],
    warnings: &mut Vec<String>,
) -> Result<(Vec<StoredModel>, Vec<StoredModel>, OtherLoading), Failure> {
    let loading = DescribedLoading::of_file(path)?;
    let mut draughts = Vec::new();
    let mut taken = |file: &str, known: &IdentifiedShip| {
        let (ship, draught) = loading.of_ship(file, known, warnings)?;
        draughts.push(draught);
        Ok(ship)
    };
    let models = models.iter().map(|model| model.with(&mut taken)).collect::<Result<_, _>>()?;
    let ballast = ballast.iter().map(|model| model.with(only_hull)).collect::<Result<_, _>>()?;
    let (draught_m, factor) = (loading.draught(), Likeness::OtherHull.factor());
    Ok((models, ballast, OtherLoading { file: loading.file, draughts_at_trials_m: draughts, draught_m, factor }))
}

/// A record beside its replay, and corrected to `loading` where there is a model of its condition; models are those at
/// that loading and those in the condition of the record.
fn held_against(
    (record, current): (&Trial, Option<Current>),
    ([full, ballast], loading): ([&[StoredModel]; 2], &str),
    (scale, draws): (Option<TargetScale>, usize),
    warnings: &mut Vec<String>,
) -> Result<(RecordReplay, Option<Correction>), Failure> {
    let scaled = |models: &[StoredModel]| mixture_of(models, TargetScale::of_record(scale, record));
    let file = file_of(record).0;
    let own = scaled(if ballast.is_empty() { full } else { ballast })?;
    let replayed = own.replay(record, draws, current).map_err(|error| Failure::about(file, error))?;
    let Some(replayed) = replayed else {
        let what = "too few headings at its beginning to say how the ship began";
        return Err(Failure::about(file, format!("{what}; choose a part under [part] of a sidecar")));
    };
    if ballast.is_empty() {
        return Ok((replayed, None));
    }
    let mut correction = match correction::correct(&scaled(full)?, &own, record, loading, draws) {
        Ok(correction) => correction,
        Err(error @ PredictError::Lost { .. }) => {
            warnings.push(format!("{file}: {error}; it is not corrected to {loading}"));
            return Ok((replayed, None));
        }
        Err(error) => return Err(Failure::about(file, error)),
    };
    if correction.figures.is_empty() {
        warnings.push(format!(
            "{file}: it shows no figure of a zig-zag or a turn from its first execute on; it is not corrected to \
             {loading}"
        ));
        return Ok((replayed, None));
    }
    let mut of_models = correction::differences(&full[0].known, &ballast[0].known, loading);
    if full[0].method != ballast[0].method {
        of_models.push(correction::different("methods", &full[0].method, &ballast[0].method, loading));
    }
    correction.warnings.splice(0..0, of_models);
    [correction.full, correction.ballast] = [full, ballast].map(files);
    Ok((replayed, Some(correction)))
}

/// The method whose answer is used.
fn method(file: &str, ships: &BTreeMap<String, IdentifiedShip>, asked: Option<&str>) -> Result<String, Failure> {
    let known: Vec<&str> = ships.keys().map(String::as_str).collect();
    if known.is_empty() {
        let what = "no method has a covariance for this record, so there are no intervals to predict";
        return Err(Failure::about(
            file,
            format!("{what}; fit again with --method output-error, or with a longer record or several"),
        ));
    }
    match asked {
        Some(asked) if known.contains(&asked) => Ok(asked.to_owned()),
        Some(asked) => Err(Failure::about(
            file,
            format!("--method {asked}: it has no such answer with a covariance; use one of {}", known.join(", ")),
        )),
        None => Ok(METHODS.into_iter().find(|id| known.contains(id)).unwrap_or(known[0]).to_owned()),
    }
}
