//! Models of earlier trials (`--prior`): read, and compared with the records.

use std::collections::BTreeMap;
use std::path::PathBuf;

use campaign::earlier_trials::earlier_hulls;
use campaign::failure::Failure;
use campaign::identified_ship::RecordFacts;
use document::earlier_trials::{EarlierTrials, Likeness, PriorCheckEntry, PriorModelEntry};
use document::identified_hull::matrix_rows;
use document::{IdentifiedShip, Warning, WarningCode};
use identify::hull::{self, EarlierHull, PriorCheck, differs_in_froude_number};
use predict::drawable_hull;
use report::number::fixed;
use ship::vessel::prior::HullParticulars;
use trial::{Trial, file};

use super::stored_ships::{StoredShips, model_text, read_stored_ships};
use crate::documents::prior;
use crate::records::file_and_hash;

/// Model fitted to earlier trials, whose hulls are priors of a new fit.
#[derive(Debug, Clone)]
pub struct EarlierModel {
    file: String,
    /// Records used in the model: their files by SHA-256.
    pub records: BTreeMap<String, String>,
    hulls: Vec<EarlierHull>,
}

impl EarlierModel {
    /// Models of some files. Fails if a file cannot be read, or as [`from_document`](Self::from_document) does.
    pub fn from_files(paths: &[PathBuf]) -> Result<Vec<Self>, Failure> {
        let read = |path: &PathBuf| {
            let shown = file::display_path(path).display().to_string();
            Self::from_document(&shown, &model_text(path)?)
        };
        paths.iter().map(read).collect()
    }

    /// Model in the text of a `fit.json` or `trace.json`; `shown` is its name in messages.
    ///
    /// Fails if the text is no such document, or if it holds no hull.
    pub fn from_document(shown: &str, text: &str) -> Result<Self, Failure> {
        let StoredShips { ships, records, .. } = read_stored_ships(shown, text)?;
        let ship = ships.into_values().find(|ship| !ship.hulls.is_empty());
        let ship = ship.ok_or_else(|| {
            let problem = "it holds no hull to use as a prior; fit records that begin on a steady approach, with length and \
                        approach speed of the ship and a speed column";
            Failure::in_file(shown, problem)
        })?;
        let hulls = earlier_hulls(&ship).map_err(|error| Failure::in_file(shown, error))?;
        Ok(Self { file: shown.to_owned(), records, hulls })
    }

    /// Document entry of the model, compared with the ship of the records.
    fn entry(&self, ship: &HullParticulars) -> PriorModelEntry {
        let earlier_ship = self.hulls[0].particulars;
        let likeness = Likeness::from_particulars(&earlier_ship, ship);
        PriorModelEntry {
            file: self.file.clone(),
            records: self.records.clone(),
            likeness,
            factor: likeness.factor(),
            differing: ship.differing_keys(&earlier_ship).into_iter().map(str::to_owned).collect(),
            length_m: earlier_ship.length,
            speed_m_s: earlier_ship.speed,
        }
    }
}

/// Hulls of all models.
pub fn hulls_of_models(models: &[EarlierModel]) -> Vec<EarlierHull> {
    models.iter().flat_map(|model| model.hulls.iter().cloned()).collect()
}

/// Fails if a record is in two models, or in one model and among those `seen`, given as files by SHA-256.
fn counted_once<'a>(models: &'a [EarlierModel], mut seen: BTreeMap<&'a str, &'a str>) -> Result<(), Failure> {
    for EarlierModel { file: model, records, .. } in models {
        if let Some((file, other)) = records.iter().find_map(|(hash, file)| Some((file, seen.get(hash.as_str())?))) {
            let problem =
                format!("{file} is in this model and in {other}, but a record counts only once; leave one of them out");
            return Err(Failure::in_file(model, problem));
        }
        seen.extend(records.keys().map(|sha256| (sha256.as_str(), model.as_str())));
    }
    Ok(())
}

/// Checks that models can be priors of records; returns a warning for each whose ship sails at another Froude number.
///
/// Fails if a record counts twice, or if models are given and no hull can be fitted to the records.
pub fn check_usable_as_priors(models: &[EarlierModel], trials: &[Trial]) -> Result<Vec<Warning>, Failure> {
    counted_once(models, trials.iter().map(file_and_hash).map(|(file, sha256)| (sha256, file)).collect())?;
    if let Some(error) = hull::fit_refusal(trials).filter(|_| !models.is_empty()) {
        let problem = "--prior cannot be used";
        let cure = "give length and approach speed (--length-m, --speed-m-s, or [ship] in a sidecar) and a record from its \
                    steady approach on, or leave --prior out";
        return Err(Failure::in_file(file_and_hash(&trials[0]).0, format!("{problem}: {error}; {cure}")));
    }
    Ok(trials.iter().find_map(Trial::hull).map(|ship| other_speeds(models, &ship)).unwrap_or_default())
}

/// Warnings for models whose ship sails at another Froude number.
fn other_speeds(models: &[EarlierModel], ship: &HullParticulars) -> Vec<Warning> {
    let of_model = |model: &EarlierModel| {
        let earlier_ship = model.hulls[0].particulars;
        differs_in_froude_number(&earlier_ship, ship).then(|| {
            let [of_model, of_records] = [earlier_ship, *ship].map(|ship| fixed(ship.froude_number(), 3));
            WarningCode::EarlierTrials.warning(format!(
                "--prior {}: its ship sailed at a Froude number of {of_model}, that of the records at {of_records}; \
                 coefficients change with \
                 the Froude number, so prefer trials at a similar one",
                model.file
            ))
        })
    };
    models.iter().filter_map(of_model).collect()
}

/// Identified ship before her hulls are updated with models of earlier trials.
pub struct LaterShip<'a> {
    /// Name of her model in messages.
    pub file: &'a str,
    /// The identified ship.
    pub ship: &'a IdentifiedShip,
    /// Records used in her model: their files by SHA-256.
    pub records: &'a BTreeMap<String, String>,
}

/// Ship updated with earlier trials.
pub struct UpdatedShip {
    /// The identified ship.
    pub ship: IdentifiedShip,
    /// Entry of the models used as priors.
    pub earlier_trials: EarlierTrials,
    /// Warnings of a conflict, or of another Froude number.
    pub warnings: Vec<Warning>,
}

/// Ship whose hulls are updated with the models.
///
/// Fails if she has no hull, if a record would count twice, if the models have no hull of the same form, or if no ship
/// can be drawn from an updated hull.
pub fn update_ship(models: &[EarlierModel], later: LaterShip) -> Result<UpdatedShip, Failure> {
    let LaterShip { file: shown, ship, records } = later;
    counted_once(models, records.keys().map(|sha256| (sha256.as_str(), shown)).collect())?;
    let before_trials = earlier_hulls(ship).map_err(|error| Failure::in_file(shown, error))?;
    let (mut ship, earlier, mut checks) = (ship.clone(), hulls_of_models(models), Vec::new());
    for (stored, hull_before) in ship.hulls.iter_mut().zip(&before_trials) {
        let Some((after, check)) = hull::merge_with_earlier(hull_before, &earlier) else { continue };
        let values = stored.coefficients.iter_mut().zip(after.coefficients.iter());
        values.for_each(|(coefficient, value)| coefficient.value = *value);
        stored.covariance = matrix_rows(&after.covariance);
        drawable_hull::check(stored).map_err(|error| Failure::in_file(shown, error))?;
        checks.extend(check.map(|check| (hull_before.form.as_str(), check)));
    }
    if checks.is_empty() {
        let problem = "it has no hull that --prior could change; fit its records again with length and speed of the \
            ship, or leave --prior out";
        return Err(Failure::in_file(shown, problem));
    }
    checks.sort_by(|a, b| b.1.p_value.total_cmp(&a.1.p_value));
    let earlier = earlier_trials(models, &before_trials[0].particulars, &checks, |_| true);
    let mut warnings = other_speeds(models, &before_trials[0].particulars);
    warnings.extend(prior::contradiction_warning(&earlier));
    Ok(UpdatedShip { ship, earlier_trials: earlier, warnings })
}

/// Document entry of the models used for a ship, and of their checks, which begin with the closest hull; `takes_part`
/// is `true` for a form of hull that is used.
fn earlier_trials(
    models: &[EarlierModel],
    ship: &HullParticulars,
    checks: &[(&str, PriorCheck)],
    takes_part: impl Fn(&str) -> bool,
) -> EarlierTrials {
    let hull = |&(form, ref check): &(&str, PriorCheck)| PriorCheckEntry {
        form: form.to_owned(),
        chi_square: check.chi_square,
        degrees_of_freedom: check.degrees_of_freedom,
        p_value: check.p_value,
        shifts: check.shifts.iter().map(|(key, shift)| ((*key).to_owned(), *shift)).collect(),
        takes_part: takes_part(form),
    };
    EarlierTrials {
        models: models.iter().map(|model| model.entry(ship)).collect(),
        hulls: checks.iter().map(hull).collect(),
        conflict: checks.first().is_none_or(|(_, check)| check.is_conflict()),
    }
}

/// Document entry of the models used with the records; `None` without models.
pub fn earlier_trials_entry(models: &[EarlierModel], trials: &[Trial], facts: &RecordFacts) -> Option<EarlierTrials> {
    let ship = trials.iter().find_map(Trial::hull).filter(|_| !models.is_empty())?;
    let is_member = |form: &str| facts.hulls.iter().any(|hull| hull.form == form);
    Some(earlier_trials(models, &ship, &facts.prior_checks, is_member))
}
