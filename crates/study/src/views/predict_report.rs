//! What the page, the tables and the files of a prediction are made from.

use predict::correction::Correction;
use predict::form::Form;
use predict::replay::Replayed;
use predict::{Prediction, imo};
use ship::Particulars;
use trial::Trial;

/// A prediction with everything it was made from.
pub struct Predicted {
    /// Files of the models with their weights.
    pub models: Vec<(String, f64)>,
    /// Draws of every manoeuvre.
    pub draws: usize,
    /// Whether the weather of the records was left out.
    pub calm: bool,
    /// The manoeuvres.
    pub manoeuvres: Vec<Prediction>,
    /// Records with their replays.
    pub replays: Vec<(Trial, Replayed)>,
    /// Files of the models in the condition of the records, which the replays are of; empty where there are none.
    pub ballast: Vec<String>,
    /// The records corrected to full load, in their order.
    pub corrections: Vec<Option<Correction>>,
    /// The form of MSC/Circ.1053, where it was asked for.
    pub form: Option<Form>,
    /// Criteria of IMO, where length and speed are known.
    pub criteria: Vec<imo::Criterion>,
    /// Length and speed.
    pub particulars: Option<Particulars>,
    /// Whether a hull takes the place of the yaw response.
    pub hull: bool,
    /// Where the ship was seen.
    pub seen: predict::known::Seen,
}
