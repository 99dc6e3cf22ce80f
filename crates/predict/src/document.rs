//! The document of a prediction and the curves beside it: what files hold, pages and figures are made from, and Python
//! gets.

use document::Warning;
use document::identified_ship::ValidityRange;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::correction::{Correction, FULL_LOAD};
use crate::drawn_parameters::DrawnParameters;
use crate::form::ImoFormEntry;
use crate::imo::PredictedCriterion;
use crate::prediction::{Bands, ManoeuvreCurves, Prediction};
use crate::replay::RecordReplay;

/// What `schema` says.
pub const SCHEMA: &str = "predict/2";

/// `predict.json`. Its curves, which stand as `skip` where they are of use, are in a file beside it: PredictCurves.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct PredictDocument {
    /// `predict/2`.
    #[schemars(extend("const" = "predict/2"))]
    pub schema: String,
    /// The models that are mixed.
    pub models: Vec<ModelWeight>,
    /// Ships that are drawn.
    pub draws: usize,
    /// Whether the weather of the records was left out.
    pub calm: bool,
    /// Length of the ship.
    pub length_m: Option<f64>,
    /// Approach speed of the ship.
    pub speed_m_s: Option<f64>,
    /// The manoeuvres.
    pub manoeuvres: Vec<Prediction>,
    /// Records with their replays.
    pub replays: Vec<RecordReplay>,
    /// Criteria of IMO, where length and speed are known.
    pub imo: Vec<PredictedCriterion>,
    /// The records that were corrected to full load, or to the loading of `load`.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub corrected: Vec<Correction>,
    /// The form of MSC/Circ.1053, where it was asked for.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub form: Option<Vec<ImoFormEntry>>,
    /// What is to be said beside it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub form_remarks: Option<Vec<String>>,
    /// Models in the condition of the records, which the replays are of; empty where there are none.
    #[serde(default)]
    pub ballast: Vec<String>,
    /// What is said of earlier trials that the hulls of every model were weighed together with.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub earlier_trials: Vec<String>,
    /// Whether a hull takes the place of the yaw response.
    #[serde(default)]
    pub hull: bool,
    /// The loading that the hulls are taken to; none where they are at that of their records.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub load: Option<OtherLoading>,
    /// Where the ship was seen.
    #[serde(default)]
    pub seen: ValidityRange,
    /// The drawn ships, where they were asked for.
    #[serde(skip)]
    pub drawn: Vec<DrawnParameters>,
    /// Warnings of models, records and manoeuvres, the worst first.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub warnings: Vec<Warning>,
}

/// A loading that hulls are taken to by the formulas of particulars.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct OtherLoading {
    /// The file that describes it.
    pub file: String,
    /// Mean draught of every model at its trials, at their scale.
    pub draughts_at_trials_m: Vec<f64>,
    /// Mean draught at this loading, at the same scale.
    pub draught_m: f64,
    /// What standard deviations are widened by.
    pub factor: f64,
}

impl OtherLoading {
    /// The loading in the words of messages and pages: full load where there is none.
    pub fn name(load: Option<&Self>) -> String {
        load.map_or_else(|| FULL_LOAD.into(), |load| format!("the loading of {}", load.file))
    }
}

/// A model that takes part in a prediction.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct ModelWeight {
    /// Its file.
    pub file: String,
    /// Its share of the draws.
    pub weight: f64,
}

/// The curves of a prediction, in a file beside the document; angles in rad.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct PredictCurves {
    /// Of every manoeuvre, in the order of the document.
    pub manoeuvres: Vec<ManoeuvreCurves>,
    /// Of every replayed record: rudder over time, heading with its band, and measured headings.
    pub replays: Vec<([Vec<f64>; 2], Bands, Vec<f64>)>,
}

impl PredictDocument {
    /// The curves, which [`with_curves`](Self::with_curves) puts back.
    pub fn curves(&self) -> PredictCurves {
        let of_replay = |own: &RecordReplay| (own.rudder.clone(), own.heading.clone(), own.measured.clone());
        PredictCurves {
            manoeuvres: self.manoeuvres.iter().map(|own| own.curves.clone()).collect(),
            replays: self.replays.iter().map(of_replay).collect(),
        }
    }

    /// The document that was read from its file, with the curves from theirs.
    pub fn with_curves(mut self, curves: PredictCurves) -> Self {
        self.manoeuvres.iter_mut().zip(curves.manoeuvres).for_each(|(own, curves)| own.curves = curves);
        for (own, curves) in self.replays.iter_mut().zip(curves.replays) {
            (own.rudder, own.heading, own.measured) = curves;
        }
        self
    }

    /// The files of the models, one after the other, and that of the loading that they are taken to.
    pub fn model_files(&self) -> String {
        let files = self.models.iter().map(|model| model.file.as_str()).collect::<Vec<_>>().join(", ");
        if self.load.is_some() { format!("{files} at {}", OtherLoading::name(self.load.as_ref())) } else { files }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing;
    use crate::{form, imo};

    #[test]
    fn what_is_written_is_read_again() {
        let mixture = testing::mixture(testing::known());
        let manoeuvres: Vec<Prediction> =
            form::manoeuvres().iter().map(|kind| mixture.predict(kind, 20, true).expect("sails")).collect();
        let particulars = mixture.particulars();
        let form = form::fill(&manoeuvres, particulars, "fit.json", &[], None);
        let document = PredictDocument {
            schema: SCHEMA.into(),
            models: vec![ModelWeight { file: "fit.json".into(), weight: 1.0 }],
            draws: 20,
            imo: imo::criteria(&manoeuvres, particulars.expect("made up")),
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
