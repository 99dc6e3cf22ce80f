//! What every answer of a scenario has to predict: `[predict]`.

use serde::{Deserialize, Serialize};
use trial::Manoeuvre;
use trial::manoeuvre::NoManoeuvre;

use crate::scenario::problem::{KeyFault, KeyPath};

/// Manoeuvres that are predicted from every answer and held against the same ship making them.
#[derive(Debug, Clone, Deserialize, Serialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub(crate) struct PredictWire {
    /// Manoeuvres, as `study predict --manoeuvre` takes them.
    pub manoeuvres: Vec<String>,
    /// Ships drawn for every prediction.
    #[serde(default = "draws")]
    pub draws: u64,
}

fn draws() -> u64 {
    200
}

/// Numbers of draws that say something and end.
const DRAWS: std::ops::RangeInclusive<u64> = 50..=10_000;

/// Manoeuvres that are predicted, and how.
#[derive(Debug, Clone, PartialEq)]
pub struct Predictions {
    /// The manoeuvres.
    pub kinds: Vec<Manoeuvre>,
    /// Ships drawn for every prediction.
    pub draws: usize,
}

/// Predictions of the records that judge.
#[derive(Debug, Clone, Deserialize, Serialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub(crate) struct RecordPredictWire {
    /// Ships drawn for every prediction.
    #[serde(default = "draws")]
    pub draws: u64,
}

impl RecordPredictWire {
    /// Checks the number of draws.
    pub(crate) fn resolve(&self) -> Result<Predictions, KeyFault> {
        Ok(Predictions { kinds: Vec::new(), draws: checked(self.draws)? })
    }
}

/// A number of draws that says something and ends.
fn checked(draws: u64) -> Result<usize, KeyFault> {
    let key = KeyPath::dotted("predict.draws");
    let fault = || KeyFault::of(key, draws, "expected 50 to 10000", "200 tell an interval of 90 %");
    if DRAWS.contains(&draws) { Ok(draws as usize) } else { Err(fault()) }
}

impl PredictWire {
    /// Checks every value; fails with the first one that makes no sense.
    pub(crate) fn resolve(&self) -> Result<Predictions, KeyFault> {
        let key = KeyPath::dotted("predict");
        let draws = checked(self.draws)?;
        if self.manoeuvres.is_empty() {
            let expected = "expected at least one, such as \"zig-zag:20/20\"";
            return Err(KeyFault::of(key.child("manoeuvres"), "empty", expected, "name one, or leave [predict] out"));
        }
        let mut kinds: Vec<Manoeuvre> = Vec::with_capacity(self.manoeuvres.len());
        for text in &self.manoeuvres {
            let refused = |expected: &str| {
                let found = format!("`predict.manoeuvres` holds {text:?}");
                KeyFault::value(key.child("manoeuvres"), found, expected, "mend or leave out this entry")
            };
            let kind: Manoeuvre = text.parse().map_err(|error: NoManoeuvre| refused(&error.to_string()))?;
            if matches!(kind, Manoeuvre::Spiral { .. }) {
                return Err(refused("expected a manoeuvre that is steered; a spiral is a curve"));
            }
            if kinds.contains(&kind) {
                return Err(refused("expected every manoeuvre once"));
            }
            kinds.push(kind);
        }
        Ok(Predictions { kinds, draws })
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
        assert_eq!((resolved.kinds.len(), resolved.draws), (2, 200));
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
