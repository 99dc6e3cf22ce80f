//! A scenario with nothing left out: what was written, and every default that was taken, each marked as one.

use simulate::settings::{Key, LeftOut, RecordingSettings, RudderSource, keys};
use toml::{Table, Value};

use crate::method::Method;
use crate::problem::{KeyPath, Problem};
use crate::wire::{FirstOrderWire, ScenarioWire, SecondOrderWire};
use crate::{effect, reader, resolve};

/// Parts of a scenario in the order in which a person reads them; what is not among them comes behind.
const ORDER: [&str; 12] = [
    "question",
    "analysis",
    "finding",
    "seed",
    "replicates",
    "ship",
    "effect",
    "manoeuvre",
    "steering-gear",
    "helmsman",
    "approach",
    "recording",
];

/// The text of a scenario with nothing left out, as TOML. Sweeps and draws stay as they are: it is the scenario they change.
///
/// Fails as the scenario would.
pub fn text(document: &Table, methods: &[Method]) -> Result<String, Problem> {
    let mut wire: ScenarioWire = reader::document(document)?;
    let ship = effect::added(resolve::ship(&wire.ship)?, &wire.effect)?;
    wire.steering_gear = wire.steering_gear.complete(&wire.steering_gear.build(&ship)?);
    for (entry, method) in wire.identifier.iter_mut().zip(methods) {
        entry.label.get_or_insert_with(|| method.label.clone());
    }
    if let Some(validation) = &mut wire.validation {
        let RecordingSettings { sampling_s, duration_s, .. } = wire.recording;
        validation.recording.get_or_insert(RecordingSettings {
            sampling_s,
            duration_s,
            after_execute: None,
            offset_s: None,
            rudder: RudderSource::Feedback,
            assumed_rudder_rate_deg_s: None,
        });
    }
    for (id, table) in &mut wire.ship {
        let key = KeyPath::dotted("ship").child(id);
        let complete = match id.as_str() {
            "first-order" => Table::try_from(reader::table::<FirstOrderWire>(table, &key)?),
            "second-order" => Table::try_from(reader::table::<SecondOrderWire>(table, &key)?),
            _ => continue,
        };
        *table = complete.expect("numbers can be written");
    }
    let complete = Table::try_from(&wire).expect("what was read can be written");
    let mut lines = Lines { keys: keys(), text: String::new() };
    lines.table(&[], &complete, Some(document));
    Ok(lines.text.trim_start().to_owned())
}

struct Lines {
    /// Settings of a trial, for those that have no value when they are left out.
    keys: Vec<Key>,
    text: String,
}

impl Lines {
    /// What stands below a path, beside what was `given` there.
    fn table(&mut self, path: &[&str], table: &Table, given: Option<&Table>) {
        let mut entries: Vec<(&String, &Value)> = table.iter().collect();
        if path.is_empty() {
            entries.sort_by_key(|(name, _)| ORDER.iter().position(|part| part == name).unwrap_or(ORDER.len()));
        }
        let (tables, values): (Vec<_>, Vec<_>) = entries.into_iter().partition(|(_, value)| is_of_tables(value));
        for (name, value) in values {
            let mark = if given.is_some_and(|given| given.contains_key(name)) { "" } else { "  # default" };
            self.text += &format!("{} = {value}{mark}\n", written(name));
        }
        self.left_out(path, table);
        for (name, value) in tables {
            let path = [path, &[name.as_str()]].concat();
            let heading = path.iter().map(|name| written(name)).collect::<Vec<_>>().join(".");
            let given = given.and_then(|given| given.get(name));
            match value {
                Value::Array(items) => {
                    for (index, item) in items.iter().enumerate() {
                        self.text += &format!("\n[[{heading}]]\n");
                        let given = given.and_then(|given| given.get(index)).and_then(Value::as_table);
                        self.table(&path, item.as_table().expect("a list of tables"), given);
                    }
                }
                _ => {
                    let below = value.as_table().expect("a table");
                    if given.is_some() || !below.is_empty() {
                        self.text += &format!("\n[{heading}]{}\n", if given.is_none() { "  # default" } else { "" });
                    }
                    self.table(&path, below, given.and_then(Value::as_table));
                }
            }
        }
    }

    /// Settings that have no value here, with what that means.
    fn left_out(&mut self, path: &[&str], table: &Table) {
        let path = path.strip_prefix(&["validation"]).unwrap_or(path).join(".");
        for Key { key, unit, default, meaning } in &self.keys {
            let name = key.strip_prefix(&path).and_then(|rest| rest.strip_prefix('.'));
            let Some(name) = name.filter(|name| !name.contains('.') && !table.contains_key(*name)) else { continue };
            if *default == LeftOut::Nothing && unit != "table" {
                self.text += &format!("# {name} is left out: {meaning}\n");
            }
        }
    }
}

fn is_of_tables(value: &Value) -> bool {
    match value {
        Value::Table(_) => true,
        Value::Array(items) => !items.is_empty() && items.iter().all(Value::is_table),
        _ => false,
    }
}

/// A name as TOML writes it.
fn written(name: &str) -> String {
    let bare = |letter: char| letter.is_ascii_alphanumeric() || letter == '-' || letter == '_';
    if !name.is_empty() && name.chars().all(bare) {
        name.to_owned()
    } else {
        Value::String(name.to_owned()).to_string()
    }
}
