//! The JSON schema of a scenario, by which an editor completes and checks its keys. It comes from the types that read
//! the file; what it cannot say, such as which values go together, is said when a scenario is resolved.

use schemars::Schema;
use schemars::generate::SchemaSettings;
use serde_json::Value;

use crate::wire::ScenarioWire;

/// The schema, in the draft that editors of TOML understand.
pub fn schema() -> Schema {
    let mut schema = SchemaSettings::draft07().into_generator().into_root_schema_for::<ScenarioWire>();
    schema.insert("title".into(), "Scenario of a study".into());
    plain(schema)
}

/// A schema whose descriptions are for a reader without the documentation of the source: no links.
pub fn plain(mut schema: Schema) -> Schema {
    let mut rest: Vec<&mut Value> = schema.ensure_object().values_mut().collect();
    while let Some(value) = rest.pop() {
        match value {
            Value::Object(table) => {
                rest.extend(table.iter_mut().filter_map(|(name, value)| match (name.as_str(), value) {
                    ("description", Value::String(text)) => {
                        *text = without_links(text);
                        None
                    }
                    (_, value) => Some(value),
                }))
            }
            Value::Array(items) => rest.extend(items),
            _ => {}
        }
    }
    schema
}

/// A comment of the source as a sentence: of a link its words, and its lines joined.
fn without_links(comment: &str) -> String {
    let mut text = String::with_capacity(comment.len());
    let mut rest = comment;
    while let Some((before, link)) = rest.split_once('[') {
        text += before;
        let Some((words, after)) = link.split_once(']') else {
            text.push('[');
            rest = link;
            continue;
        };
        let target = after.strip_prefix('(').and_then(|after| after.split_once(')'));
        let is_link = target.is_some() || (words.starts_with('`') && words.ends_with('`'));
        if is_link {
            text += words.rsplit("::").next().unwrap_or(words).trim_matches('`');
        } else {
            text += &format!("[{words}]");
        }
        rest = target.map_or(after, |(_, after)| after);
    }
    text + rest
}

#[cfg(test)]
mod tests {
    use super::without_links;

    #[test]
    fn of_a_link_the_words_stay() {
        let comment = "At most [`MOST`](crate::limits::MOST) of [`crate::Thing`] in [0, 1] or [this](that).";
        assert_eq!(without_links(comment), "At most MOST of Thing in [0, 1] or this.");
    }
}
