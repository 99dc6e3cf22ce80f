//! Manoeuvres predicted from every estimate of a scenario: `[predict]`.

use serde::{Deserialize, Serialize};
use trial::Manoeuvre;
use trial::manoeuvre::ManoeuvreParseError;

use crate::scenario::problem::{KeyFault, KeyPath};

/// Manoeuvres predicted from every estimate and compared with those of the true ship.
#[derive(Debug, Clone, Deserialize, Serialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub(crate) struct PredictWire {
    /// Manoeuvres, as in `study predict --manoeuvre`.
    pub manoeuvres: Vec<String>,
    /// Number of ships drawn for every prediction.
    #[serde(default = "draws")]
    pub draws: u64,
}

fn draws() -> u64 {
    200
}

/// Allowed numbers of draws: sufficient for an interval, with an acceptable duration.
const DRAWS: std::ops::RangeInclusive<u64> = 50..=10_000;

/// Predictions made from every estimate of a study.
#[derive(Debug, Clone, PartialEq)]
pub struct PredictionSettings {
    /// Manoeuvres that are predicted; empty for measured records, whose validation records are predicted.
    pub manoeuvres: Vec<Manoeuvre>,
    /// Number of ships drawn for every prediction.
    pub draws: usize,
}

/// Settings of the predictions of validation records.
#[derive(Debug, Clone, Deserialize, Serialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub(crate) struct RecordPredictWire {
    /// Number of ships drawn for every prediction.
    #[serde(default = "draws")]
    pub draws: u64,
}

impl RecordPredictWire {
    /// Predictions of the validation records, which give the manoeuvres. Fails for a number of draws outside [`DRAWS`].
    pub(crate) fn resolve(&self) -> Result<PredictionSettings, KeyFault> {
        Ok(PredictionSettings { manoeuvres: Vec::new(), draws: checked(self.draws)? })
    }
}

/// The number of draws; fails outside [`DRAWS`].
fn checked(draws: u64) -> Result<usize, KeyFault> {
    let key = KeyPath::from_dotted("predict.draws");
    let fault = || KeyFault::new(key, draws, "expected 50 to 10000", "200 draws are enough for a 90 % interval");
    if DRAWS.contains(&draws) { Ok(draws as usize) } else { Err(fault()) }
}

impl PredictWire {
    /// Checks every value; fails with the first invalid one.
    pub(crate) fn resolve(&self) -> Result<PredictionSettings, KeyFault> {
        let key = KeyPath::from_dotted("predict");
        let draws = checked(self.draws)?;
        if self.manoeuvres.is_empty() {
            let expected = "expected at least one, such as \"zig-zag:20/20\"";
            return Err(KeyFault::new(key.child("manoeuvres"), "empty", expected, "name one, or leave [predict] out"));
        }
        let mut kinds: Vec<Manoeuvre> = Vec::with_capacity(self.manoeuvres.len());
        for text in &self.manoeuvres {
            let refused = |expected: &str| {
                let problem = format!("`predict.manoeuvres` holds {text:?}");
                KeyFault::value(key.child("manoeuvres"), problem, expected, "correct or remove this entry")
            };
            let kind: Manoeuvre = text.parse().map_err(|error: ManoeuvreParseError| refused(&error.to_string()))?;
            if matches!(kind, Manoeuvre::Spiral { .. }) {
                return Err(refused("expected a manoeuvre that is steered; a spiral is a curve"));
            }
            if kinds.contains(&kind) {
                return Err(refused("expected every manoeuvre once"));
            }
            kinds.push(kind);
        }
        Ok(PredictionSettings { manoeuvres: kinds, draws })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn manoeuvres_are_read_and_nonsense_is_refused() {
        let wire = |manoeuvres: &[&str], draws: u64| PredictWire {
            manoeuvres: manoeuvres.iter().map(|&text| text.to_owned()).collect(),
            draws,
        };
        let resolved = wire(&["zig-zag:10/10", "turning-circle:35"], 200).resolve().expect("known");
        assert_eq!((resolved.manoeuvres.len(), resolved.draws), (2, 200));
        for (wrong, draws) in [
            (&["zig-zag"][..], 200),
            (&[], 200),
            (&["spiral:15"], 200),
            (&["pull-out:20", "pull-out:20"], 200),
            (&["williamson"], 1),
        ] {
            assert!(wire(wrong, draws).resolve().is_err(), "{wrong:?}");
        }
    }
}
