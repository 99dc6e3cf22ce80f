//! Identified ships in a `fit.json` or `trace.json`.

use std::collections::BTreeMap;
use std::path::Path;

use campaign::failure::Failure;
use campaign::scenario::{TRACE_ID, name};
use document::IdentifiedShip;
use document::fit::SCHEMA as FIT_SCHEMA;
use document::trace::SCHEMA as TRACE_SCHEMA;
use serde_json::Value;
use trial::file;

/// Kind of file of a stored model, with its maximum size: a hundred times the covariances of the largest mixtures.
const MODEL: file::FileKind = file::FileKind { name: "a model", max_bytes: 1 << 26 };

/// Part of a message: the documents that were expected.
const EXPECTED: &str = "expected the fit.json or trace.json of this program";

/// Identified ships in a stored fit or trace.
pub struct StoredShips {
    /// Ships of every method of a fit with a covariance; for a trace its only ship, under [`TRACE_ID`].
    pub ships: BTreeMap<String, IdentifiedShip>,
    /// Method that the verdict of a fit recommends; `None` for a trace, and if the method has no covariance.
    pub verdict: Option<String>,
    /// Reason why no K and T are accepted from the records of a fit; `None` for any other verdict, and for a trace.
    pub rejection_reason: Option<String>,
    /// Records used in the document, including those of its priors: their files by SHA-256.
    pub records: BTreeMap<String, String>,
}

/// Text of a model. Fails if it cannot be read.
pub fn model_text(path: &Path) -> Result<String, Failure> {
    name::study_name(path)?;
    let shown = file::display_path(path).display().to_string();
    file::read_text(path, MODEL).map_err(|error| Failure::in_file(&shown, format!("{error}; {EXPECTED}")))
}

/// Content of the text of a `fit.json` or `trace.json`; `shown` is its name in messages. Fails if it is no such
/// document, or if it has another version.
pub fn read_stored_ships(shown: &str, text: &str) -> Result<StoredShips, Failure> {
    let refuse = |problem: String| Failure::in_file(shown, problem);
    let unread = |error| refuse(format!("what is known of the ship cannot be read: {error}"));
    let value: Value =
        serde_json::from_str(text).map_err(|error| refuse(format!("this is no JSON ({error}); {EXPECTED}")))?;
    let (command, key, records) = match value["schema"].as_str() {
        Some(FIT_SCHEMA) => ("fit", "ships", "trials"),
        Some(TRACE_SCHEMA) => (TRACE_ID, "ship", "records"),
        other => {
            let expected = format!("expected \"{FIT_SCHEMA}\" or \"{TRACE_SCHEMA}\"");
            let command = other.and_then(|schema| schema.split('/').next());
            let cure = match command.filter(|command| ["fit", TRACE_ID].contains(command)) {
                Some(command) => format!("make it again with `study {command}`"),
                None => EXPECTED.to_owned(),
            };
            return Err(refuse(format!("schema = {}, {expected}; {cure}", value["schema"])));
        }
    };
    let stored = value.get(key).cloned().ok_or_else(|| {
        refuse(format!("it has no `{key}`, as an older program wrote it; make it again with `study {command}`"))
    })?;
    let ships: BTreeMap<String, IdentifiedShip> = match command {
        TRACE_ID => [(TRACE_ID.to_owned(), serde_json::from_value(stored).map_err(unread)?)].into(),
        _ => serde_json::from_value(stored).map_err(unread)?,
    };
    let verdict = value["verdict"]["method"].as_str().filter(|id| ships.contains_key(*id)).map(str::to_owned);
    let because = value["verdict"]["because"].as_str().unwrap_or("its verdict does not say why");
    let rejection_reason = (value["verdict"]["believe"] == "no").then(|| because.to_owned());
    Ok(StoredShips { ships, verdict, rejection_reason, records: records_of(&value, records) })
}

/// Records in a document under `key`, and those of its priors: their files by SHA-256.
fn records_of(document: &Value, key: &str) -> BTreeMap<String, String> {
    let list = |value: &Value| value.as_array().cloned().unwrap_or_default();
    let text = |value: &Value| value.as_str().filter(|text| !text.is_empty()).map(str::to_owned);
    let fitted = list(&document[key]).into_iter().filter(|record| record["held_out"] != true);
    let records = fitted.filter_map(|record| Some((text(&record["sha256"])?, text(&record["file"])?)));
    let of_prior = |model: Value| model["records"].as_object().cloned().unwrap_or_default();
    let priors = list(&document["earlier_trials"]["models"]).into_iter().flat_map(of_prior);
    records.chain(priors.filter_map(|(sha256, file)| Some((sha256, text(&file)?)))).collect()
}
