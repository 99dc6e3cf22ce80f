//! The document of a prediction: what `predict.json` holds, what pages and tables are made from, what Python gets.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::correction::Correction;
use crate::form::FormEntry;
use crate::imo::PredictedCriterion;
use crate::known::ValidityRange;
use crate::prediction::Prediction;
use crate::replay::RecordReplay;

/// `predict.json`. Curves, and what stands as `skip` here, are beside the document and not in it.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct PredictDocument {
    /// `predict/1`.
    #[schemars(extend("const" = "predict/1"))]
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
    /// The records that were corrected to full load.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub corrected: Vec<Correction>,
    /// The form of MSC/Circ.1053, where it was asked for.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub form: Option<Vec<FormEntry>>,
    /// What is to be said beside it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub form_remarks: Option<Vec<String>>,
    /// Models in the condition of the records, which the replays are of; empty where there are none.
    #[serde(skip)]
    pub ballast: Vec<String>,
    /// Whether a hull takes the place of the yaw response.
    #[serde(skip)]
    pub hull: bool,
    /// Where the ship was seen.
    #[serde(skip)]
    pub seen: ValidityRange,
}

/// A model that takes part in a prediction.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct ModelWeight {
    /// Its file.
    pub file: String,
    /// Its share of the draws.
    pub weight: f64,
}

impl PredictDocument {
    /// The files of the models, one after the other.
    pub fn model_files(&self) -> String {
        self.models.iter().map(|model| model.file.as_str()).collect::<Vec<_>>().join(", ")
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::made_up;
    use crate::mixture::ShipMixture;
    use crate::{form, imo};

    #[test]
    fn what_is_written_is_read_again() {
        let mixture = ShipMixture::new(vec![(made_up::known(), 1.0)]).expect("made up");
        let manoeuvres: Vec<Prediction> =
            form::manoeuvres().iter().map(|kind| mixture.predict(kind, 20, true).expect("sails")).collect();
        let particulars = mixture.particulars();
        let form = form::fill(&manoeuvres, particulars, "fit.json", &[], None);
        let document = PredictDocument {
            schema: "predict/1".into(),
            models: vec![ModelWeight { file: "fit.json".into(), weight: 1.0 }],
            draws: 20,
            imo: imo::criteria(&manoeuvres, particulars.expect("made up")),
            manoeuvres,
            form: Some(form.entries),
            form_remarks: Some(form.remarks),
            ..PredictDocument::default()
        };
        let text = serde_json::to_string(&document).expect("plain data");
        let again: PredictDocument = serde_json::from_str(&text).expect("the same");
        assert_eq!(serde_json::to_string(&again).expect("plain data"), text);
        assert_eq!(again.manoeuvres[0].kind, document.manoeuvres[0].kind);
        assert!(again.imo.len() > 5 && again.form == document.form && again.model_files() == "fit.json");
    }
}
