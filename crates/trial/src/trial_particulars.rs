//! Ship, date and draughts of a trial, for the first page of a report.

use serde::de::Error as _;
use serde::{Deserialize, Deserializer};
use toml::Value;

use crate::clock::parse_date;

/// Ship, date and draughts of a trial, as declared in a sidecar under `[trial]`; `None` if undeclared. In brackets, the
/// kind of value of the sidecar key.
#[derive(Debug, Clone, Default, PartialEq, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct TrialParticulars {
    /// Name of the ship, for the first page of a report. (text)
    pub ship_name: Option<String>,
    /// Day of the trial; from the stamps of the record if absent. (date such as 2026-11-20)
    #[serde(default, deserialize_with = "date")]
    pub date: Option<String>,
    /// Draught at the fore perpendicular. (m)
    #[serde(rename = "draught-fore-m")]
    pub draught_fore: Option<f64>,
    /// Draught at the aft perpendicular; with the draught fore it gives draught-m and trim-m if these are absent. (m)
    #[serde(rename = "draught-aft-m")]
    pub draught_aft: Option<f64>,
}

impl TrialParticulars {
    /// The same particulars, with missing entries from `other`.
    pub fn with_missing_from(self, other: &Self) -> Self {
        let text = |given: Option<String>, other: &Option<String>| given.or_else(|| other.clone());
        Self {
            ship_name: text(self.ship_name, &other.ship_name),
            date: text(self.date, &other.date),
            draught_fore: self.draught_fore.or(other.draught_fore),
            draught_aft: self.draught_aft.or(other.draught_aft),
        }
    }

    /// Draughts fore and aft, m; `None` unless both are declared.
    pub fn draughts(&self) -> Option<[f64; 2]> {
        Some([self.draught_fore?, self.draught_aft?])
    }

    /// Mean of the draughts fore and aft, m; `None` unless both are declared.
    pub fn mean_draught(&self) -> Option<f64> {
        self.draughts().map(|[fore, aft]| 0.5 * (fore + aft))
    }

    /// `true` if a mean draught (m) is between the draughts fore and aft, or if either is undeclared.
    pub fn admits_draught(&self, draught: f64) -> bool {
        self.draughts().is_none_or(|[fore, aft]| (fore.min(aft)..=fore.max(aft)).contains(&draught))
    }

    /// Trim, m, positive by the stern; `None` unless both draughts are declared. It is rounded to a tenth of a
    /// millimetre, as a difference of two written numbers.
    pub(crate) fn trim(&self) -> Option<f64> {
        self.draughts().map(|[fore, aft]| (1e4 * (aft - fore)).round() / 1e4)
    }
}

/// Date of TOML, or a text with a date.
fn date<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Option<String>, D::Error> {
    let text = match Value::deserialize(deserializer)? {
        Value::String(text) => text,
        value => value.to_string(),
    };
    parse_date(&text)
        .map(Some)
        .ok_or_else(|| D::Error::custom(format!("`{text}` is no day, expected a date such as 2026-11-20")))
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;
    use crate::sidecar::Sidecar;

    /// Draughts fore and aft give the mean draught and the trim of the form; a date may be one of TOML or a text.
    #[test]
    fn draughts_and_day_are_those_of_the_sidecar() {
        let of = |text: &str| Sidecar::parse(text, Path::new("run.trial.toml")).map(|sidecar| sidecar.conditions);
        let trial = "[trial]\nship-name = \" Kempf \"\ndate = 2026-11-20\ndraught-fore-m = 7.9\ndraught-aft-m = 8.2\n";
        let conditions = of(trial).expect("all keys are known");
        assert_eq!(conditions.trial.ship_name.as_deref(), Some("Kempf"));
        assert_eq!(conditions.trial.date.as_deref(), Some("2026-11-20"));
        assert_eq!((conditions.draught, conditions.trim), (Some(8.05), Some(0.3)));
        assert_eq!(conditions.hull.draught, Some(8.05));
        let declared = of(&format!("{trial}[form]\ndraught-m = 8\ntrim-m = 0.2\n")).expect("between both");
        assert_eq!((declared.draught, declared.trim), (Some(8.0), Some(0.2)));
        let text = of("[trial]\ndate = \"2026-11-20\"\n").expect("a text");
        assert_eq!(text.trial.date, conditions.trial.date);
        for (text, message) in [
            ("[trial]\ndate = \"20.11.2026\"\n", "line 2: `20.11.2026` is no day"),
            ("[trial]\ndraught-fore-m = 0\n", "line 2: `draught-fore-m` is 0"),
            (&format!("[form]\ndraught-m = 9\n{trial}"), "line 2: `draught-m` is 9, expected a mean draught between"),
            ("[trial]\nname = \"Kempf\"\n", "unknown field `name`"),
        ] {
            let error = of(text).expect_err(text).to_string();
            assert!(error.contains(message), "{error}");
        }
    }

    /// Given particulars override those of a record.
    #[test]
    fn options_complete_what_a_record_says() {
        let of = |ship_name: Option<&str>, date: Option<&str>| TrialParticulars {
            ship_name: ship_name.map(str::to_owned),
            date: date.map(str::to_owned),
            ..TrialParticulars::default()
        };
        let given = of(Some("Kempf"), None).with_missing_from(&of(Some("Yukun"), Some("2026-11-20")));
        assert_eq!(given, of(Some("Kempf"), Some("2026-11-20")));
    }
}
