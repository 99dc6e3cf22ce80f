//! The JSON schema of a sidecar, by which an editor completes and checks its keys: the types that read it, with the
//! meanings that `study list sidecar` shows.

use schemars::generate::SchemaSettings;
use schemars::{JsonSchema, Schema};
use serde_json::Value;

use crate::sidecar_keys::KEYS;

/// The schema of `T`, with what the keys mean, in the draft that editors of TOML understand.
pub(crate) fn of<T: JsonSchema>() -> Schema {
    // Tables stand where they are used, so that a key is found by its table.
    let settings = SchemaSettings::draft07().with(|settings| settings.inline_subschemas = true);
    let mut schema = settings.into_generator().into_root_schema_for::<T>();
    schema.insert("title".into(), "Sidecar of a record".into());
    for key in KEYS {
        let Some((table, name)) = key.key.split_once(' ') else { continue };
        let table = table.trim_matches(['[', ']']);
        let place = match key.key.starts_with("[[") {
            true => format!("/properties/{table}/items/properties/{name}"),
            false => format!("/properties/{table}/properties/{name}"),
        };
        if let Some(Value::Object(one)) = schema.pointer_mut(&place) {
            one.insert("description".into(), format!("{} ({})", key.meaning, key.value).into());
        }
    }
    schema
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_key_that_is_listed_is_in_the_schema_with_its_meaning() {
        let schema = crate::sidecar::schema().to_value();
        let described = schema.to_string().matches("\"description\"").count();
        // The last one listed is the remark.
        assert!(described >= KEYS.len() - 1, "{described} of {}: {schema:#}", KEYS.len());
        assert!(schema["properties"]["part"]["properties"]["from-s"]["description"].is_string());
        assert!(schema["properties"]["column"]["items"]["properties"]["flip"]["description"].is_string());
    }
}
