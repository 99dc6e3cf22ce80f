//! Prediction: ships drawn from models, steered through manoeuvres and compared with records.

use std::collections::BTreeMap;
use std::path::Path;

use campaign::failure::Failure;
use campaign::scenario::TRACE_ID;
use document::earlier_trials::Likeness;
use document::{IdentifiedShip, Warning, WarningCode, WarningSource, Warnings};
use identify::plausibility::unusual_froude_number;
use predict::correction::{self, Correction};
use predict::document::{ModelWeight, OtherLoading, SCHEMA};
use predict::form::{self, FormRecord};
use predict::replay::RecordReplay;
use predict::turn::{self, Current};
use predict::{PredictDocument, PredictError, Prediction, ShipMixture, imo, standard};
use report::number::fixed;
use ship::Particulars;
use trial::{Manoeuvre, Trial, file};

use super::earlier_trials::{EarlierModel, LaterShip, update_ship};
use super::loading::{LoadingCondition, with_convertible_hull};
use super::stored_ships::{StoredShips, model_text, read_stored_ships};
use super::target_scale::{self, SidecarConditions, TargetScale, is_same_scale, scale_mismatch, ship_at_scale};
use crate::documents::prior;
use crate::options::PredictRequest;
use crate::progress::ProgressSteps;
use crate::records::{file_and_hash, late_rudder_message, warning_source_of};

/// Methods of fit.json in order of preference; others come last.
const METHODS: [&str; 3] = ["maximum-likelihood", "output-error", "srivc"];

/// Identified ship with its file and method.
#[derive(Clone)]
pub struct StoredModel {
    file: String,
    ship: IdentifiedShip,
    /// Method of identification.
    method: String,
    /// Records used in the model: their files by SHA-256.
    records: BTreeMap<String, String>,
}

/// Files of some models.
fn files(models: &[StoredModel]) -> Vec<String> {
    models.iter().map(|model| model.file.clone()).collect()
}

/// Mixture of the ships of several models at a scale, with equal weights. Fails if their scales differ or if they
/// cannot be mixed.
fn mixture_of(models: &[StoredModel], scale: Option<TargetScale>) -> Result<ShipMixture, Failure> {
    let mut ships: Vec<(IdentifiedShip, f64)> = Vec::with_capacity(models.len());
    for model in models {
        let ship = ship_at_scale(&model.ship, scale).map_err(|error| Failure::in_file(&model.file, error))?;
        let [first, next] = [ships.first().map_or(&ship, |(first, _)| first), &ship].map(IdentifiedShip::particulars);
        if !first.zip(next).map_or(first == next, |(first, next)| is_same_scale(first, next)) {
            return Err(scale_mismatch([(&models[0].file, first), (&model.file, next)]));
        }
        ships.push((ship, 1.0));
    }
    ShipMixture::new(ships).map_err(|error| Failure::in_file(&files(models).join(", "), error))
}

impl StoredModel {
    /// Identified ship in a file, by the method and weather of the request.
    ///
    /// Fails if it cannot be read, or as [`from_document`](Self::from_document) does.
    pub fn from_file(path: &Path, request: &PredictRequest, warnings: &mut Warnings) -> Result<Self, Failure> {
        let shown = file::display_path(path).display().to_string();
        Self::from_document(&shown, &model_text(path)?, request.method.as_deref(), request.calm, warnings)
    }

    /// Identified ship in the text of a `fit.json` or `trace.json`; of several methods that of `asked`, else that of
    /// the verdict, else the first in order of preference. `calm` removes the weather of the records. `shown` is the
    /// name in messages.
    ///
    /// Fails if the text is no such document, or if it holds no estimate of that method with a covariance.
    pub fn from_document(
        shown: &str,
        text: &str,
        asked: Option<&str>,
        calm: bool,
        warnings: &mut Warnings,
    ) -> Result<Self, Failure> {
        let StoredShips { mut ships, verdict, rejection_reason, records } = read_stored_ships(shown, text)?;
        // A trace has only one estimate.
        let asked = asked.filter(|_| !ships.contains_key(TRACE_ID));
        let method = method(shown, &ships, asked.or(verdict.as_deref()))?;
        let used = match (asked, ships[&method].hulls.is_empty()) {
            (None, true) if ships.len() > 1 => {
                Some(format!("the answer of {method} is used; choose another with --method"))
            }
            (Some(_), false) => Some(format!(
                "--method {method} changes little: the ship is steered with her fitted hulls, which are the same for \
                 every method, and not with the K and T of {method}"
            )),
            _ => None,
        };
        warnings
            .extend(used.map(|text| Warning::new(WarningCode::Answer, WarningSource::File(shown.to_owned()), text)));
        if let Some(because) = rejection_reason {
            let text = format!("no K and T can be taken from its records, so do not trust its predictions: {because}");
            warnings.push(WarningCode::NotIdentified, WarningSource::File(shown.to_owned()), text);
        }
        let ship = ships.remove(&method).expect("it was found there");
        if let Some(late) = ship.logged_rudder_delay() {
            let text = format!("{}; she is steered without it", late_rudder_message(late));
            warnings.push(WarningCode::LateRudder, WarningSource::File(shown.to_owned()), text);
        }
        let ship = if calm { ship.in_calm() } else { Ok(ship) };
        let ship = ship.map_err(|error| Failure::in_file(shown, error))?;
        Ok(Self { ship, file: shown.to_owned(), method, records })
    }

    /// Model updated with earlier trials that it does not contain, and a sentence on them.
    fn after(&self, earlier: &[EarlierModel], warnings: &mut Warnings) -> Result<(Self, String), Failure> {
        let later = LaterShip { file: &self.file, ship: &self.ship, records: &self.records };
        let after = update_ship(earlier, later)?;
        warnings.extend(after.warnings);
        let mut records = self.records.clone();
        records.extend(earlier.iter().flat_map(|model| model.records.clone()));
        let sentence = format!("{}: {}", self.file, prior::earlier_trials_sentence(&after.earlier_trials));
        Ok((Self { ship: after.ship, records, ..self.clone() }, sentence))
    }

    /// Model with its ship replaced by `make`, which gets the name of the file.
    fn with(
        &self,
        make: impl FnOnce(&str, &IdentifiedShip) -> Result<IdentifiedShip, Failure>,
    ) -> Result<Self, Failure> {
        Ok(Self { ship: make(&self.file, &self.ship)?, ..self.clone() })
    }
}

/// Input of a prediction.
pub struct PredictInput<'a> {
    /// Models of the ship; several models have equal weights.
    pub models: &'a [StoredModel],
    /// Models of earlier trials, whose records are not in `models`.
    pub earlier_models: &'a [EarlierModel],
    /// Models of the same ship in the loading of the records; empty if no correction is needed.
    pub ballast_models: &'a [StoredModel],
    /// Records that are compared with their prediction.
    pub records: Vec<Trial>,
    /// Current removed from the tracks of the turns of the records; `None` for the current estimated from each track.
    pub current: Option<Current>,
    /// Conditions declared by a sidecar; `None` without one, or if there are records.
    pub declared_conditions: SidecarConditions<'a>,
}

/// Requested manoeuvres, or those of the IMO criteria if neither a manoeuvre, a replay nor the form is requested; those
/// of the form, if requested, in addition.
fn manoeuvres(request: &PredictRequest) -> Vec<Manoeuvre> {
    let mut kinds = match (request.manoeuvres.as_slice(), request.replays.is_empty() && !request.form) {
        ([], true) => standard::imo_manoeuvres(),
        (asked, _) => asked.to_vec(),
    };
    let mut of_form = form::form_manoeuvres();
    of_form.retain(|kind| request.form && !kinds.contains(kind));
    kinds.extend(of_form);
    kinds
}

/// Ships of a mixture, to be steered through manoeuvres.
struct SteeredShips<'a> {
    mixture: &'a ShipMixture,
    /// Number of drawn ships.
    draws: usize,
    /// Name of the model in messages.
    file: &'a str,
}

impl SteeredShips<'_> {
    /// Predictions of the manoeuvres that the ships complete, and the last error among the incomplete ones.
    fn predictions(
        &self,
        kinds: &[Manoeuvre],
        steps: &ProgressSteps,
        warnings: &mut Warnings,
    ) -> Result<(Vec<Prediction>, Option<PredictError>), Failure> {
        let (mut predictions, mut lost) = (Vec::new(), None);
        let warning =
            |text: String| Warning::new(WarningCode::Unpredicted, WarningSource::File(self.file.to_owned()), text);
        for kind in kinds {
            let prediction = self.mixture.predict(kind, self.draws, true);
            steps.advance();
            match prediction {
                Ok(prediction) => {
                    warnings.extend(prediction.undetermined.iter().map(|(name, interval)| {
                        let [low, high] = interval.ci90.map(|end| fixed(end, interval.decimals()));
                        warning(format!(
                            "{kind}: {name} is left out, because its 90 % interval is {low} to {high}: the records do \
                             not determine it; fit \
                             records with positions (north_m, east_m) or sway_m_s"
                        ))
                    }));
                    predictions.push(prediction);
                }
                // One manoeuvre that the model does not complete does not affect the others.
                Err(error @ PredictError::TooFewCompleted { .. }) => {
                    warnings.extend([warning(format!("{error}; it is left out"))]);
                    lost = Some(error);
                }
                Err(error) => return Err(Failure::in_file(self.file, error)),
            }
        }
        Ok((predictions, lost))
    }
}

/// Predictions of the manoeuvres and replays of the records.
///
/// Fails if a model cannot be brought to the requested scale or loading, if a record does not determine the initial
/// state of the ship, or if there is neither a record nor a manoeuvre that half of the drawn ships complete.
pub fn predict(
    request: &PredictRequest,
    input: PredictInput,
    quiet: bool,
    warnings: &mut Warnings,
) -> Result<PredictDocument, Failure> {
    let PredictInput { models, earlier_models, ballast_models: ballast, records, current, declared_conditions } = input;
    let (updated, sentences) = after_earlier(models, earlier_models, warnings)?;
    let models = if earlier_models.is_empty() { models } else { &updated };
    let taken = request.load.as_ref().map(|load| at_loading(load, models, ballast, warnings)).transpose()?;
    let (models, ballast) = taken.as_ref().map_or((models, ballast), |(full, ballast, _)| (full, ballast));
    warnings.extend(records.iter().filter(|_| ballast.is_empty()).filter_map(|trial| validates_nothing(models, trial)));
    let (draws, scale) =
        (request.draws as usize, TargetScale::from_request(&request.scale, &records, declared_conditions)?);
    let mut in_still_water = |record| turn::without_current(target_scale::at_declared_scale(record, warnings), current);
    let records: Vec<(Trial, Option<Current>)> = records.into_iter().map(&mut in_still_water).collect();
    let mixture = mixture_of(models, scale)?;
    let particulars = mixture.particulars();
    warnings.extend(particulars.and_then(unusual_froude_number));
    let (file, kinds) = (files(models).join(", "), manoeuvres(request));
    let steps = ProgressSteps::new("manoeuvres and records", (kinds.len() + records.len()) as u64, 0, 1, quiet);
    let (predictions, lost) =
        SteeredShips { mixture: &mixture, draws, file: &file }.predictions(&kinds, &steps, warnings)?;
    if let Some(error) = lost.filter(|_| predictions.is_empty() && records.is_empty()) {
        return Err(Failure::in_file(&file, error));
    }
    let loading = OtherLoading::name(taken.as_ref().map(|(.., load)| load));
    let replays_of = ReplayedModels { full: models, ballast, loading: &loading, scale, draws };
    let replayed = records.iter().map(|(record, current)| replays_of.beside(record, *current, warnings));
    let replayed: Result<Vec<_>, Failure> = replayed.inspect(|_| steps.advance()).collect();
    let (replays, corrections): (Vec<_>, Vec<_>) = replayed?.into_iter().unzip();
    steps.finish();
    let mut document = PredictDocument {
        warnings: warnings.ranked(),
        schema: SCHEMA.into(),
        models: files(models).into_iter().map(|file| ModelWeight { file, weight: 1.0 / models.len() as f64 }).collect(),
        draws,
        drawn: (0..draws as u64).filter(|_| request.draws_file).map(|number| mixture.draw_parameters(number)).collect(),
        calm: request.calm,
        length_m: particulars.map(|ship| ship.length),
        speed_m_s: particulars.map(|ship| ship.speed),
        imo: particulars.map(|ship| imo::predicted_criteria(&predictions, ship)).unwrap_or_default(),
        manoeuvres: predictions,
        replays,
        corrected: corrections.iter().flatten().cloned().collect(),
        ballast: files(ballast),
        earlier_trials: sentences,
        hull: !mixture.first_ship().hulls.is_empty(),
        load: taken.as_ref().map(|(.., load)| load.clone()),
        validity_range: mixture.first_ship().validity_range,
        ..PredictDocument::default()
    };
    if request.form {
        fill_form(&mut document, particulars, &records, &corrections, declared_conditions);
    }
    Ok(document)
}

/// Models updated with earlier trials, and a sentence on each; empty without earlier trials.
fn after_earlier(
    models: &[StoredModel],
    earlier: &[EarlierModel],
    warnings: &mut Warnings,
) -> Result<(Vec<StoredModel>, Vec<String>), Failure> {
    let updated = models.iter().filter(|_| !earlier.is_empty()).map(|model| model.after(earlier, warnings));
    Ok(updated.collect::<Result<Vec<_>, _>>()?.into_iter().unzip())
}

/// Warning if a record is in one of the models and so gives no validation.
fn validates_nothing(models: &[StoredModel], record: &Trial) -> Option<Warning> {
    let (_, sha256) = file_and_hash(record);
    let model = models.iter().find(|model| model.records.contains_key(sha256))?;
    let text = format!("{} is fitted to it; the error on it validates nothing", model.file);
    Some(Warning::new(WarningCode::Repetition, warning_source_of(record), text))
}

/// Fills in the form of MSC/Circ.1053 of a document that is otherwise complete.
fn fill_form(
    document: &mut PredictDocument,
    particulars: Option<Particulars>,
    records: &[(Trial, Option<Current>)],
    corrections: &[Option<Correction>],
    declared: SidecarConditions,
) {
    let held = records.iter().zip(corrections).map(|((trial, current), correction)| FormRecord {
        trial,
        correction: correction.as_ref(),
        current: *current,
    });
    let held: Vec<FormRecord> = held.collect();
    let filled = form::fill_form(&document.manoeuvres, particulars, &document.model_files(), &held, declared);
    (document.form, document.form_remarks) = (Some(filled.entries), Some(filled.remarks));
}

/// Models at another loading, the `ballast` models with only the hull that can be converted, and the document entry of
/// the loading.
fn at_loading(
    path: &Path,
    models: &[StoredModel],
    ballast: &[StoredModel],
    warnings: &mut Warnings,
) -> Result<(Vec<StoredModel>, Vec<StoredModel>, OtherLoading), Failure> {
    let loading = LoadingCondition::from_file(path)?;
    let mut draughts = Vec::new();
    let mut taken = |file: &str, ship_at_trials: &IdentifiedShip| {
        let (ship, draught) = loading.convert_ship(file, ship_at_trials, warnings)?;
        draughts.push(draught);
        Ok(ship)
    };
    let models = models.iter().map(|model| model.with(&mut taken)).collect::<Result<_, _>>()?;
    let ballast = ballast.iter().map(|model| model.with(with_convertible_hull)).collect::<Result<_, _>>()?;
    let (draught_m, factor) = (loading.draught(), Likeness::OtherHull.factor());
    Ok((models, ballast, OtherLoading { file: loading.file, draughts_at_trials_m: draughts, draught_m, factor }))
}

/// Models for the comparison with records.
struct ReplayedModels<'a> {
    /// Models at the loading of the prediction.
    full: &'a [StoredModel],
    /// Models in the condition of the records; empty if they need no correction.
    ballast: &'a [StoredModel],
    /// Name of the loading.
    loading: &'a str,
    scale: Option<TargetScale>,
    draws: usize,
}

impl ReplayedModels<'_> {
    /// Comparison of a record with its replay, corrected to the loading if there is a model of the record's condition.
    fn beside(
        &self,
        record: &Trial,
        current: Option<Current>,
        warnings: &mut Warnings,
    ) -> Result<(RecordReplay, Option<Correction>), Failure> {
        let Self { full, ballast, loading, scale, draws } = *self;
        let scaled = |models: &[StoredModel]| mixture_of(models, TargetScale::for_replay_of(scale, record));
        let file = file_and_hash(record).0;
        let replayed_with = scaled(if ballast.is_empty() { full } else { ballast })?;
        let replayed = replayed_with.replay(record, draws, current).map_err(|error| Failure::in_file(file, error))?;
        let Some(replayed) = replayed else {
            let problem = "too few headings at its beginning to determine the initial state";
            return Err(Failure::in_file(file, format!("{problem}; choose a part under [part] of a sidecar")));
        };
        if ballast.is_empty() {
            return Ok((replayed, None));
        }
        let mut correction =
            match correction::correct_to_loading(&scaled(full)?, &replayed_with, record, loading, draws) {
                Ok(correction) => correction,
                Err(error @ PredictError::TooFewCompleted { .. }) => {
                    let text = format!("{error}; it is not corrected to {loading}");
                    warnings.push(WarningCode::Correction, warning_source_of(record), text);
                    return Ok((replayed, None));
                }
                Err(error) => return Err(Failure::in_file(file, error)),
            };
        if correction.figures.is_empty() {
            let text = format!(
                "it has no zig-zag or turn that begins with the first execute, so it is not corrected to {loading}"
            );
            warnings.push(WarningCode::Correction, warning_source_of(record), text);
            return Ok((replayed, None));
        }
        let mut of_models = correction::difference_warnings(&full[0].ship, &ballast[0].ship, loading);
        if full[0].method != ballast[0].method {
            of_models.push(correction::difference_warning("methods", &full[0].method, &ballast[0].method, loading));
        }
        correction.warnings.splice(0..0, of_models);
        [correction.target_models, correction.trial_models] = [full, ballast].map(files);
        Ok((replayed, Some(correction)))
    }
}

/// Method whose estimate is used: that of `asked`, else the first of [`METHODS`] that has one, else any other.
///
/// Fails if no method, or not that of `asked`, has an estimate with a covariance.
fn method(file: &str, ships: &BTreeMap<String, IdentifiedShip>, asked: Option<&str>) -> Result<String, Failure> {
    let methods: Vec<&str> = ships.keys().map(String::as_str).collect();
    if methods.is_empty() {
        let problem = "no method has a covariance for this record, so no intervals can be predicted";
        return Err(Failure::in_file(
            file,
            format!("{problem}; fit again with --method output-error, or with a longer record or several"),
        ));
    }
    match asked {
        Some(asked) if methods.contains(&asked) => Ok(asked.to_owned()),
        Some(asked) => Err(Failure::in_file(
            file,
            format!("--method {asked}: no such answer with a covariance; use one of {}", methods.join(", ")),
        )),
        None => Ok(METHODS.into_iter().find(|id| methods.contains(id)).unwrap_or(methods[0]).to_owned()),
    }
}
