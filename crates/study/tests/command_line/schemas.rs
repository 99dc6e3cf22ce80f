//! Tests of the JSON schemas: the published schemas are those of the program, and the documents that the program writes
//! in these tests are valid.

use std::path::Path;
use std::sync::LazyLock;

use clap::ValueEnum;
use serde_json::Value;
use study::commands::schema::schema;
use study::options::SchemaSubject;

use crate::desk::{Desk, of_repository};

/// Every schema by its name.
fn all() -> Vec<(String, SchemaSubject)> {
    let named = |what: &SchemaSubject| what.to_possible_value().map(|value| (value.get_name().to_owned(), *what));
    SchemaSubject::value_variants().iter().filter_map(named).collect()
}

/// First fault of a document by the schema `name`; empty if the document is valid.
fn faults(name: &str, document: &Value) -> Vec<String> {
    static SCHEMAS: LazyLock<Vec<(String, Value)>> =
        LazyLock::new(|| all().into_iter().map(|(name, what)| (name, schema(what).as_value().clone())).collect());
    let (_, root) = SCHEMAS.iter().find(|(known, _)| known == name).expect("a schema of that name");
    check(root, root, document).err().into_iter().collect()
}

/// Validates a value by a part of the schema `root`, with the keywords of draft 7 that schemas of this program use;
/// panics at any other keyword. Fails with the keyword that refuses the value.
fn check(root: &Value, part: &Value, value: &Value) -> Result<(), String> {
    let wrong = |keyword: &str, limit: &Value| Err(format!("{keyword} {limit} refuses {value}"));
    let Some(part) = part.as_object() else { return if *part == true { Ok(()) } else { wrong("schema", part) } };
    let within = |place: &dyn std::fmt::Display, result: Result<(), String>| result.map_err(|e| format!("{place}/{e}"));
    for (keyword, limit) in part {
        let parts = || limit.as_array().into_iter().flatten();
        let matching = || parts().filter(|part| check(root, part, value).is_ok()).count();
        let count = limit.as_u64().unwrap_or_default() as usize;
        let items = || value.as_array().map(Vec::len);
        let keys = || value.as_object().map(serde_json::Map::len);
        let is_met = match keyword.as_str() {
            "$schema" | "title" | "description" | "default" | "definitions" | "format" => true,
            "$ref" => {
                let target = limit.as_str().and_then(|path| root.pointer(path.strip_prefix('#')?));
                check(root, target.expect("a definition of the schema"), value)?;
                true
            }
            "allOf" => {
                parts().try_for_each(|part| check(root, part, value))?;
                true
            }
            "anyOf" => matching() > 0,
            "oneOf" => matching() == 1,
            "type" => match limit.as_array() {
                Some(types) => types.iter().any(|one| is_of_type(value, one)),
                None => is_of_type(value, limit),
            },
            "const" => value == limit,
            "enum" => parts().any(|one| one == value),
            "minimum" => value.as_f64().is_none_or(|number| Some(number) >= limit.as_f64()),
            "maximum" => value.as_f64().is_none_or(|number| Some(number) <= limit.as_f64()),
            "minItems" => items().is_none_or(|items| items >= count),
            "maxItems" => items().is_none_or(|items| items <= count),
            "minProperties" => keys().is_none_or(|keys| keys >= count),
            "maxProperties" => keys().is_none_or(|keys| keys <= count),
            "required" => {
                value.as_object().is_none_or(|map| parts().all(|key| map.contains_key(key.as_str().unwrap_or(""))))
            }
            "items" => {
                let mut items = value.as_array().into_iter().flatten().enumerate();
                // A single schema for all items, or a list with a schema for each.
                let of = |place: usize| limit.as_array().map_or(Some(limit), |limits| limits.get(place));
                items.try_for_each(|(place, item)| {
                    of(place).map_or(Ok(()), |own| within(&place, check(root, own, item)))
                })?;
                true
            }
            "properties" | "additionalProperties" => {
                let known = part.get("properties");
                for (key, own) in value.as_object().into_iter().flatten() {
                    match (known.and_then(|known| known.get(key)), keyword.as_str()) {
                        (Some(part), "properties") => within(key, check(root, part, own))?,
                        (None, "additionalProperties") => within(key, check(root, limit, own))?,
                        _ => {}
                    }
                }
                true
            }
            other => panic!("the schema has the keyword `{other}`, which this test does not know"),
        };
        if !is_met {
            return wrong(keyword, limit);
        }
    }
    Ok(())
}

fn is_of_type(value: &Value, kind: &Value) -> bool {
    match kind.as_str().expect("the name of a type") {
        "null" => value.is_null(),
        "boolean" => value.is_boolean(),
        "string" => value.is_string(),
        "array" => value.is_array(),
        "object" => value.is_object(),
        "number" => value.is_number(),
        "integer" => value.as_f64().is_some_and(|number| number.fract() == 0.0),
        other => panic!("there is no type `{other}`"),
    }
}

/// Asserts that a document is valid by the schema `name`; `file` is its path in messages.
pub fn hold(name: &str, file: &Path, document: &Value) {
    let faults = faults(name, document);
    assert!(faults.is_empty(), "{} and the schema of {name}: {}", file.display(), faults.join("; "));
}

/// TOML text as JSON; `None` if it is no TOML. Numbers that are not finite, which JSON lacks, become the largest
/// number.
fn of_toml(text: &str) -> Option<Value> {
    fn value(toml: toml::Value) -> Value {
        match toml {
            toml::Value::Float(number) if !number.is_finite() => Value::from(f64::MAX),
            toml::Value::Array(items) => items.into_iter().map(value).collect(),
            toml::Value::Table(table) => table.into_iter().map(|(name, one)| (name, value(one))).collect(),
            other => serde_json::to_value(other).expect("plain data"),
        }
    }
    Some(value(toml::Value::Table(text.parse().ok()?)))
}

/// Asserts that all documents below a folder are valid. A file that is no JSON or TOML, because a test has damaged it,
/// is skipped.
pub fn hold_below(folder: &Path) {
    for entry in std::fs::read_dir(folder).into_iter().flatten().flatten() {
        let path = entry.path();
        let name = entry.file_name().to_string_lossy().into_owned();
        match name.as_str() {
            "fit.json" | "trace.json" | "predict.json" | "bench.json" => {
                let text = std::fs::read_to_string(&path).unwrap_or_default();
                let Ok(document) = serde_json::from_str(&text) else { continue };
                hold(name.trim_end_matches(".json"), &path, &document);
            }
            "cells.json" | "showcase.json" => {
                let text = std::fs::read_to_string(&path).unwrap_or_default();
                serde_json::from_str(&text).iter().for_each(|own| hold(name.trim_end_matches(".json"), &path, own));
            }
            // The curves of a prediction have no schema.
            "curves.json" if folder.join("fit.json").is_file() => {
                let text = std::fs::read_to_string(&path).unwrap_or_default();
                serde_json::from_str(&text).iter().for_each(|own| hold("fit-curves", &path, own));
            }
            "manifest.toml" => {
                let text = std::fs::read_to_string(&path).unwrap_or_default();
                let Some(manifest) = of_toml(&text) else { continue };
                hold("manifest", &path, &manifest);
                let scenario = manifest["scenario"].as_str().and_then(of_toml);
                scenario.iter().for_each(|scenario| hold("scenario", &path, scenario));
            }
            "trials.toml" => {
                let trials = std::fs::read_to_string(&path).ok().as_deref().and_then(of_toml);
                trials.iter().for_each(|trials| hold("trials", &path, trials));
            }
            truth if truth.ends_with(".truth.json") => {
                let text = std::fs::read_to_string(&path).unwrap_or_default();
                serde_json::from_str(&text).iter().for_each(|truth| hold("truth", &path, truth));
            }
            _ if path.is_dir() => hold_below(&path),
            _ => {}
        }
    }
}

#[test]
fn the_published_schemas_are_those_of_the_program() {
    let desk = Desk::new();
    for (name, _) in all() {
        let page = std::fs::read_to_string(of_repository(&format!("docs/schemas/{name}.json"))).unwrap_or_default();
        let run = desk.run(&["schema", &name]);
        assert!(run.is_done().out == page, "run `study schema {name} > docs/schemas/{name}.json` again");
    }
}

/// All scenarios and sidecars of the repository are valid, and those written by a person name their schema in the first
/// line.
#[test]
fn files_of_the_repository_hold_to_their_schemas() {
    let mut seen = [0, 0];
    let mut folders = vec![of_repository("scenarios")];
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(&folder).expect("a folder").flatten() {
            let path = entry.path();
            if path.is_dir() {
                folders.push(path);
                continue;
            }
            let name = entry.file_name().to_string_lossy().into_owned();
            let which = match () {
                () if name.ends_with(".trial.toml") => "sidecar",
                () if name.ends_with(".toml") => "scenario",
                () => continue,
            };
            let text = std::fs::read_to_string(&path).expect("a file");
            let named = text.lines().next().and_then(|line| line.strip_prefix("#:schema ")).unwrap_or_default();
            let place = path.parent().expect("a folder").join(named).canonicalize();
            let published = of_repository(&format!("docs/schemas/{which}.json")).canonicalize();
            // Sidecars of simulated records and scenarios of the benchmark do not name their schema.
            let is_written = path.with_extension("").with_extension("truth.json").is_file()
                || path.parent().is_some_and(|folder| folder.ends_with("bench"));
            if !is_written {
                assert_eq!(place.ok(), published.ok(), "{}: its first line names the schema", path.display());
            }
            hold(which, &path, &of_toml(&text).expect("TOML"));
            seen[usize::from(which == "sidecar")] += 1;
        }
    }
    assert!(seen[0] >= 20 && seen[1] > 10, "{seen:?}");
}

#[test]
fn the_sample_of_a_style_and_the_published_benchmark_hold_to_theirs() {
    let style = of_repository("docs/src/reference/style.toml");
    hold("style", &style, &of_toml(&std::fs::read_to_string(&style).expect("a file")).expect("TOML"));
    assert!(!faults("style", &serde_json::json!({ "colour": 1 })).is_empty(), "a key that there is not");
    let bench = of_repository("results/published/bench/bench.json");
    let document = serde_json::from_str(&std::fs::read_to_string(&bench).expect("a file")).expect("JSON");
    hold("bench", &bench, &document);
}

/// The schema of a scenario refuses a wrong key, a wrong type of value and an unknown name.
#[test]
fn a_schema_refuses_what_the_program_refuses() {
    let good = std::fs::read_to_string(of_repository("scenarios/yukun.toml")).expect("a file");
    let faults = |text: &str| faults("scenario", &of_toml(text).expect("TOML"));
    assert!(faults(&good).is_empty(), "{:?}", faults(&good));
    for (from, to) in [
        ("replicates =", "replicate ="),
        ("sampling-s = ", "sampling-s = \"1\" # "),
        ("heading-noise-deg", "heading-nois-deg"),
        ("method.output-error", "method.output-eror"),
        ("[ship.", "[ship.not-"),
    ] {
        let wrong = good.replacen(from, to, 1);
        assert_ne!(wrong, good, "{from}");
        assert!(!faults(&wrong).is_empty(), "{from} as {to} is not seen");
    }
}
