//! Document of a prediction and its curves: the content of the files, from which pages, figures and the Python objects
//! are made.

use document::Warning;
use document::identified_ship::ValidityRange;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::correction::{Correction, FULL_LOAD};
use crate::drawn_parameters::DrawnParameters;
use crate::form::ImoFormEntry;
use crate::imo::PredictedCriterion;
use crate::prediction::{BandedCurve, ManoeuvreCurves, Prediction};
use crate::replay::RecordReplay;

/// Value of `schema`.
pub const SCHEMA: &str = "predict/2";

/// Document of a prediction, `predict.json`. The curves, marked `skip`, are in a separate file: PredictCurves.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct PredictDocument {
    /// Version of the schema: `predict/2`.
    #[schemars(extend("const" = "predict/2"))]
    pub schema: String,
    /// Models of the mixture.
    pub models: Vec<ModelWeight>,
    /// Number of drawn ships.
    pub draws: usize,
    /// `true` if the weather of the records was left out.
    pub calm: bool,
    /// Length of the ship, m.
    pub length_m: Option<f64>,
    /// Approach speed of the ship, m/s.
    pub speed_m_s: Option<f64>,
    /// Predicted manoeuvres.
    pub manoeuvres: Vec<Prediction>,
    /// Records with their replays.
    pub replays: Vec<RecordReplay>,
    /// Criteria of IMO; empty if length or speed is unknown.
    pub imo: Vec<PredictedCriterion>,
    /// Records corrected to full load, or to the loading of `load`.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub corrected: Vec<Correction>,
    /// Form of MSC/Circ.1053, if requested.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub form: Option<Vec<ImoFormEntry>>,
    /// Remarks on the form.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub form_remarks: Option<Vec<String>>,
    /// Models in the condition of the records, used for the replays; empty if there are none.
    #[serde(default)]
    pub ballast: Vec<String>,
    /// Notes on the earlier trials that the hulls of every model were combined with.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub earlier_trials: Vec<String>,
    /// `true` if a hull takes the place of the yaw response.
    #[serde(default)]
    pub hull: bool,
    /// Loading to which the hulls are converted; `None` for the loading of the records.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub load: Option<OtherLoading>,
    /// Range of the records of the ship.
    #[serde(default)]
    #[serde(rename = "seen")]
    pub validity_range: ValidityRange,
    /// Parameters of the drawn ships, if requested.
    #[serde(skip)]
    pub drawn: Vec<DrawnParameters>,
    /// Warnings of models, records and manoeuvres, the worst first.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub warnings: Vec<Warning>,
}

/// Loading to which hulls are converted by the formulas of particulars.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct OtherLoading {
    /// File that describes the loading.
    pub file: String,
    /// Mean draught of every model at its trials, at their scale.
    pub draughts_at_trials_m: Vec<f64>,
    /// Mean draught at this loading, at the same scale.
    pub draught_m: f64,
    /// Factor that widens the standard deviations.
    pub factor: f64,
}

impl OtherLoading {
    /// Name of the loading in messages and pages; full load for `None`.
    pub fn name(load: Option<&Self>) -> String {
        load.map_or_else(|| FULL_LOAD.into(), |load| format!("the loading of {}", load.file))
    }
}

/// Model of the mixture of a prediction.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct ModelWeight {
    /// File of the model.
    pub file: String,
    /// Share of the draws.
    pub weight: f64,
}

/// Names of files for a page, separated by commas, without their folders, which exist on one machine only; with the
/// last folder if several files have the same name.
pub fn file_names<'a>(files: impl IntoIterator<Item = &'a String, IntoIter: Clone>) -> String {
    fn end(file: &str, parts: usize) -> &str {
        let start = file.rmatch_indices(['/', '\\']).nth(parts - 1).map_or(0, |(place, _)| place + 1);
        &file[start..]
    }
    let files = files.into_iter();
    let name = |file: &'a String| {
        let alike = files.clone().filter(|other| end(other, 1) == end(file, 1)).count();
        end(file, alike.min(2))
    };
    files.clone().map(name).collect::<Vec<_>>().join(", ")
}

/// Curves of a prediction, in a file next to the document; angles in rad.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct PredictCurves {
    /// Curves of every manoeuvre, in the order of the document.
    pub manoeuvres: Vec<ManoeuvreCurves>,
    /// Curves of every replayed record: rudder against time, heading with bands, and measured headings.
    pub replays: Vec<([Vec<f64>; 2], BandedCurve, Vec<f64>)>,
}

impl PredictDocument {
    /// Curves, which [`with_curves`](Self::with_curves) restores.
    pub fn curves(&self) -> PredictCurves {
        let replay_curves =
            |r: &RecordReplay| (r.rudder_times_and_angles.clone(), r.heading_band.clone(), r.measured_heading.clone());
        PredictCurves {
            manoeuvres: self.manoeuvres.iter().map(|prediction| prediction.curves.clone()).collect(),
            replays: self.replays.iter().map(replay_curves).collect(),
        }
    }

    /// Document read from its file, with the curves of the separate file.
    pub fn with_curves(mut self, curves: PredictCurves) -> Self {
        self.manoeuvres.iter_mut().zip(curves.manoeuvres).for_each(|(prediction, curves)| prediction.curves = curves);
        for (replay, curves) in self.replays.iter_mut().zip(curves.replays) {
            (replay.rudder_times_and_angles, replay.heading_band, replay.measured_heading) = curves;
        }
        self
    }

    /// Names of the files of the models, and the file of the loading to which they are converted.
    pub fn model_files(&self) -> String {
        let files = file_names(self.models.iter().map(|model| &model.file));
        if self.load.is_some() { format!("{files} at {}", OtherLoading::name(self.load.as_ref())) } else { files }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing;
    use crate::{form, imo};

    #[test]
    fn files_are_named_without_their_folders() {
        let of = |files: &[&str]| file_names(&files.iter().map(|file| String::from(*file)).collect::<Vec<_>>());
        assert_eq!(of(&["scratch/a/fit.json"]), "fit.json");
        assert_eq!(of(&["scratch/a/fit.json", "b/fit.json", "b\\trace.json"]), "a/fit.json, b/fit.json, trace.json");
    }

    #[test]
    fn what_is_written_is_read_again() {
        let mixture = testing::mixture(testing::identified_ship());
        let manoeuvres: Vec<Prediction> =
            form::form_manoeuvres().iter().map(|kind| mixture.predict(kind, 20, true).expect("sails")).collect();
        let particulars = mixture.particulars();
        let form = form::fill_form(&manoeuvres, particulars, "fit.json", &[], None);
        let document = PredictDocument {
            schema: SCHEMA.into(),
            models: vec![ModelWeight { file: "fit.json".into(), weight: 1.0 }],
            draws: 20,
            imo: imo::predicted_criteria(&manoeuvres, particulars.expect("made up")),
            manoeuvres,
            form: Some(form.entries),
            form_remarks: Some(form.remarks),
            ..PredictDocument::default()
        };
        let text = serde_json::to_string(&document).expect("plain data");
        let curves = serde_json::to_string(&document.curves()).expect("plain data");
        let again: PredictDocument = serde_json::from_str(&text).expect("the same");
        let again = again.with_curves(serde_json::from_str(&curves).expect("the same"));
        assert_eq!(serde_json::to_string(&again.curves()).expect("plain data"), curves);
        assert_eq!(serde_json::to_string(&again).expect("plain data"), text);
        assert_eq!(again.manoeuvres[0].kind, document.manoeuvres[0].kind);
        assert!(again.imo.len() > 5 && again.form == document.form && again.model_files() == "fit.json");
    }
}
