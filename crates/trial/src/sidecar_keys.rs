//! Keys of a sidecar, each declared by its field; the brackets at the end of the field's comment contain the kind of
//! its value. The JSON schema and the list of keys are made from these comments.

use std::borrow::Cow;
use std::collections::BTreeMap;
use std::sync::LazyLock;

use schemars::generate::SchemaSettings;
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::de::Error as _;
use serde::{Deserialize, Deserializer};
use serde_json::{Map, Value, json};
use ship::vessel::prior::{HullParticulars, PARTICULARS, Particular};
use toml::Spanned;

use crate::cells::Separator;
use crate::conditions::{DeclaredConditions, DeclaredWeather};
use crate::encoding::Encoding;
use crate::trial_particulars::TrialParticulars;

// Tables of the file. Comments on fields are the descriptions in `study list sidecar` and in the JSON schema.

#[derive(Deserialize, Default, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub(crate) struct SidecarKeys {
    /// Declares a calm, as in a towing tank: a trace searches for no effect of weather. Key above every table. (none)
    pub weather: Option<DeclaredWeather>,
    #[serde(default)]
    pub table: TableKeys,
    #[serde(default)]
    pub part: PartKeys,
    #[serde(default)]
    #[schemars(with = "Vec<ColumnKeys>")]
    pub column: Vec<Spanned<ColumnKeys>>,
    #[serde(default)]
    pub rudder: RudderKeys,
    pub ship: Option<ShipKeys>,
    #[serde(default)]
    pub noise: NoiseKeys,
    #[serde(default)]
    pub check: CheckKeys,
    #[serde(default)]
    #[schemars(description = "The table as it is written.")]
    pub trial: TrialParticulars,
    #[serde(default)]
    #[schemars(description = "The table as it is written.")]
    pub form: DeclaredConditions,
}

#[derive(Debug, Clone, Default, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub(crate) struct TableKeys {
    /// Number of lines before the header, or before the rows if there is none; they are not even decoded. (number)
    #[serde(default)]
    pub skip_lines: usize,
    /// Separator of cells; recognised if absent. (comma, semicolon, tab or blank)
    pub separator: Option<Separator>,
    /// Character encoding; if absent, utf-8, and windows-1252 for lines that are not utf-8. (utf-8 or windows-1252)
    #[serde(default)]
    pub encoding: Encoding,
    /// `true` if a line with names comes before the rows; true if absent. (true or false)
    pub header: Option<bool>,
    #[schemars(
        description = "Row i (from 0, empty lines not counted) is at i times this, and a column of time is not \
        used. Rows that are missing shift all that follow: for tables without time only. (s)"
    )]
    pub time_step_s: Option<f64>,
}

#[derive(Debug, Clone, Default, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub(crate) struct PartKeys {
    /// Start of the used part, on the clock of the record. (s)
    pub from_s: Option<f64>,
    /// End of the used part. (s)
    pub until_s: Option<f64>,
    /// Thinning: the first row of the part and every n-th after it. (number)
    pub every: Option<usize>,
}

#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub(crate) struct ColumnKeys {
    /// Index of the column, counted from 1; either the index or the name is given. (number)
    pub index: Option<usize>,
    /// Name of the column in the header. (text)
    pub name: Option<String>,
    /// Quantity of the column: a name of `study list columns`; its own name if absent. (name such as heading_rad)
    #[schemars(with = "Option<String>")]
    pub is: Option<Spanned<String>>,
    /// Reversal of the sign. (true)
    #[serde(default)]
    pub flip: bool,
    /// Value of a unit of the numbers, in the unit of `is`: 0.1 for tenths of a degree. (number)
    pub scale: Option<f64>,
    /// Number at zero, subtracted before scaling: counts of a converter. (number)
    pub zero: Option<f64>,
    #[schemars(
        with = "Option<String>",
        description = "A column computed from others, as they stand in the file, in place of index and name: \
        `(port - starboard) / 2`; needs `is`. (text)"
    )]
    pub formula: Option<Spanned<String>>,
    /// Omission of the column. (true)
    #[serde(default)]
    pub ignore: bool,
}

#[derive(Debug, Clone, Default, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub(crate) struct RudderKeys {
    /// Delay of the logged rudder, on the clock of the record; negative if early. (s)
    pub late_s: Option<f64>,
    /// Rate at which the rudder follows the column, which is the order; 2 to 7 are usual. (deg/s)
    pub order_rate_deg_s: Option<f64>,
}

/// Particulars of the ship, by the keys of [`PARTICULARS`], and the speed in knots.
#[derive(Debug, Clone, Default)]
pub(crate) struct ShipKeys {
    pub hull: HullParticulars,
    pub speed_kn: Option<f64>,
}

const SPEED_KN: &str = "speed-kn";

static SHIP_KEYS: LazyLock<Vec<&str>> =
    LazyLock::new(|| PARTICULARS.iter().map(|particular| particular.key).chain([SPEED_KN]).collect());

/// Key of [ship]; any other key is refused.
#[derive(PartialEq, Eq, PartialOrd, Ord)]
struct ShipKey(String);

impl<'de> Deserialize<'de> for ShipKey {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let key = String::deserialize(deserializer)?;
        match SHIP_KEYS.contains(&key.as_str()) {
            true => Ok(Self(key)),
            false => Err(D::Error::unknown_field(&key, &SHIP_KEYS)),
        }
    }
}

impl<'de> Deserialize<'de> for ShipKeys {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let mut keys = Self::default();
        for (ShipKey(key), value) in BTreeMap::<ShipKey, f64>::deserialize(deserializer)? {
            match Particular::find(&key) {
                Some(particular) => particular.set(&mut keys.hull, value),
                None => keys.speed_kn = Some(value),
            }
        }
        Ok(keys)
    }
}

impl JsonSchema for ShipKeys {
    fn schema_name() -> Cow<'static, str> {
        "ShipKeys".into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        let description = |Particular { key, meaning, unit, .. }: &Particular| match *key {
            "length-m" => (*key, format!("{meaning}; needs a speed beside it. ({unit})")),
            _ => (*key, format!("{meaning}. ({unit})")),
        };
        let knots = (SPEED_KN, String::from("The approach speed in knots. (kn)"));
        let number = |(key, text): (&str, String)| {
            (key.to_owned(), json!({ "description": text, "type": ["number", "null"], "format": "double" }))
        };
        let properties: Map<String, Value> = PARTICULARS.iter().map(description).chain([knots]).map(number).collect();
        json_schema!({ "type": "object", "properties": properties, "additionalProperties": false })
    }
}

#[derive(Deserialize, Default, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub(crate) struct NoiseKeys {
    /// Standard deviation of the heading, if known. (deg)
    pub heading_deg: Option<f64>,
    /// Standard deviation of the yaw rate, if known. (deg/s)
    pub yaw_rate_deg_s: Option<f64>,
    /// Standard deviation of the rudder, if known. (deg)
    pub rudder_deg: Option<f64>,
}

#[derive(Debug, Clone, Default, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub(crate) struct CheckKeys {
    /// If false, readings are not cleaned, and an implausible record is a warning in place of an error. (true or false)
    pub plausibility: Option<bool>,
}

/// JSON schema (draft 7) of a sidecar, for completion and checks in editors.
pub fn sidecar_schema() -> Schema {
    // Inlined tables let `keys` walk from a table to its keys.
    let settings = SchemaSettings::draft07().with(|settings| settings.inline_subschemas = true);
    let mut schema = settings.into_generator().into_root_schema_for::<SidecarKeys>();
    schema.insert("title".into(), "Sidecar of a record".into());
    schema
}

/// Key of a sidecar.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct SidecarKey {
    /// Table and key; the key alone if it is above the tables.
    pub key: String,
    /// Kind of the value.
    pub value_kind: String,
    /// Meaning of the key, and its default.
    pub meaning: String,
}

/// All keys of a sidecar in the order of declaration, and last the mark of a remark, `#`.
pub fn sidecar_keys() -> Vec<SidecarKey> {
    let schema = sidecar_schema();
    let properties = |schema: &serde_json::Value| schema["properties"].as_object().cloned().unwrap_or_default();
    let mut keys = Vec::new();
    for (name, entry) in properties(schema.as_value()) {
        let (table, entries) = match (entry.get("items"), entry.get("properties")) {
            (Some(items), _) => (format!("[[{name}]] "), properties(items)),
            (None, Some(_)) => (format!("[{name}] "), properties(&entry)),
            (None, None) => (String::new(), Map::from_iter([(name, entry)])),
        };
        for (key, entry) in entries {
            let description = entry["description"].as_str().unwrap_or_default();
            let (meaning, value_kind) = description.rsplit_once(" (").unwrap_or((description, ")"));
            let value_kind = value_kind.trim_end_matches(')').to_owned();
            keys.push(SidecarKey { key: format!("{table}{key}"), value_kind, meaning: meaning.to_owned() });
        }
    }
    let [key, value_kind, meaning] = ["#", "text", "A remark, to the end of the line."].map(str::to_owned);
    keys.push(SidecarKey { key, value_kind, meaning });
    keys
}
