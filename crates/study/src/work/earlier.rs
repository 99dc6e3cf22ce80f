//! Models of earlier trials that `--prior` names: read, and held against the records.

use std::collections::BTreeMap;
use std::path::PathBuf;

use campaign::earlier::hulls_of;
use campaign::known::RecordFacts;
use identify::hull::{self, EarlierHull, Likeness, is_other_froude_number};
use report::number::fixed;
use scenario::failure::Failure;
use ship::vessel::prior::HullParticulars;
use trial::{Trial, file};

use super::predict::{StoredAnswer, ships_of, text_of};
use crate::documents::prior::{EarlierTrials, PriorCheckEntry, PriorModelEntry};
use crate::records::file_of;

/// A model of earlier trials: its hulls.
#[derive(Debug, Clone)]
pub struct EarlierModel {
    file: String,
    /// The records that are in it: their files by their SHA-256.
    records: BTreeMap<String, String>,
    hulls: Vec<EarlierHull>,
}

impl EarlierModel {
    /// The models of some files. Fails when one cannot be read, and as [`of_document`](Self::of_document) does.
    pub fn of_files(paths: &[PathBuf]) -> Result<Vec<Self>, Failure> {
        let of = |path: &PathBuf| {
            let shown = file::called(path).display().to_string();
            Self::of_document(&shown, &text_of(path)?)
        };
        paths.iter().map(of).collect()
    }

    /// The model in the text of a `fit.json` or `trace.json`; `shown` is what messages call it.
    ///
    /// Fails when the text is no such document, and when it holds no hull.
    pub fn of_document(shown: &str, text: &str) -> Result<Self, Failure> {
        let StoredAnswer { ships, records, .. } = ships_of(shown, text)?;
        let known = ships.into_values().find(|ship| !ship.hulls.is_empty());
        let known = known.ok_or_else(|| {
            let what = "it holds no hull, which a prior is made from; fit records of a known length and approach speed, with a \
                        speed column, that begin on a steady approach";
            Failure::about(shown, what)
        })?;
        let hulls = hulls_of(&known).map_err(|error| Failure::about(shown, error))?;
        Ok(Self { file: shown.to_owned(), records, hulls })
    }

    /// Its ship beside that of the records.
    fn entry(&self, ship: &HullParticulars) -> PriorModelEntry {
        let own = self.hulls[0].particulars;
        let likeness = Likeness::of(&own, ship);
        PriorModelEntry {
            file: self.file.clone(),
            records: self.records.clone(),
            likeness: likeness.as_str().to_owned(),
            factor: likeness.factor(),
            differing: ship.differing(&own).into_iter().map(str::to_owned).collect(),
            length_m: own.length,
            speed_m_s: own.speed,
        }
    }
}

/// The hulls of all models.
pub fn hulls(models: &[EarlierModel]) -> Vec<EarlierHull> {
    models.iter().flat_map(|model| model.hulls.iter().cloned()).collect()
}

/// Fails where a record is in two of the models, or in one and among the records, and where models are given and no
/// hull can be fitted to the records; warns where the ships
/// sail at other Froude numbers.
pub fn check(models: &[EarlierModel], trials: &[Trial], warnings: &mut Vec<String>) -> Result<(), Failure> {
    let mut seen: BTreeMap<&str, &str> = trials.iter().map(file_of).map(|(file, sha256)| (sha256, file)).collect();
    for EarlierModel { file: model, records, .. } in models {
        if let Some((file, other)) = records.iter().find_map(|(own, file)| Some((file, seen.get(own.as_str())?))) {
            let what = format!("{file} is in it and in {other}, and a record counts only once; leave one of them out");
            return Err(Failure::about(model, what));
        }
        seen.extend(records.keys().map(|own| (own.as_str(), model.as_str())));
    }
    if let Some(error) = hull::refusal(trials).filter(|_| !models.is_empty()) {
        let what = "--prior cannot be used";
        let cure = "give length and approach speed (--length-m, --speed-m-s, or [ship] in a sidecar) and a record from its \
                    steady approach on, or leave --prior out";
        return Err(Failure::about(file_of(&trials[0]).0, format!("{what}: {error}; {cure}")));
    }
    let Some(ship) = trials.iter().find_map(Trial::hull) else { return Ok(()) };
    for model in models {
        let own = model.hulls[0].particulars;
        if is_other_froude_number(&own, &ship) {
            let [one, other] = [own, ship].map(|ship| fixed(ship.froude_number(), 3));
            warnings.push(format!(
                "--prior {}: its ship sailed at a Froude number of {one}, that of the records at {other}; coefficients change with \
                 it, so prefer trials of about the same",
                model.file
            ));
        }
    }
    Ok(())
}

/// What is said of the models beside the records; `None` without any. The warning of a conflict is among `warnings`.
pub fn entry(
    models: &[EarlierModel],
    trials: &[Trial],
    facts: &RecordFacts,
    warnings: &mut Vec<String>,
) -> Option<EarlierTrials> {
    let ship = trials.iter().find_map(Trial::hull).filter(|_| !models.is_empty())?;
    let checks = facts.checks();
    let is_member = |form: &str| facts.hulls().iter().any(|own| own.form == form);
    let entry = EarlierTrials {
        models: models.iter().map(|model| model.entry(&ship)).collect(),
        hulls: checks.iter().map(|(form, check)| PriorCheckEntry::of(form, check, is_member(form))).collect(),
        conflict: checks.first().is_none_or(|(_, check)| check.is_conflict()),
    };
    warnings.extend(entry.warning());
    Some(entry)
}
