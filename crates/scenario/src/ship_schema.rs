//! The schema of the ship of a scenario, whose keys are those of a registry.

use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};

/// The ship: one key, the id of a ship of the registry or one with numbers of its own.
pub(crate) fn of<First: JsonSchema, Second: JsonSchema>(generator: &mut SchemaGenerator) -> Schema {
    let mut schema = json_schema!({
        "type": "object",
        "minProperties": 1,
        "maxProperties": 1,
        "additionalProperties": false,
        "properties": {
            "first-order": generator.subschema_for::<First>(),
            "second-order": generator.subschema_for::<Second>(),
        }
    });
    for (id, what) in
        [("first-order", "A ship of your own by K and T"), ("second-order", "A ship of your own by K, T1, T2, T3")]
    {
        let one = &mut schema.ensure_object()["properties"][id];
        *one = json_schema!({ "description": what, "allOf": [one.take()] }).to_value();
    }
    for ship in ::ship::ships::all() {
        let one = json_schema!({ "type": "object", "description": ship.name, "maxProperties": 0 });
        schema.ensure_object()["properties"][ship.id.to_string()] = one.to_value();
    }
    schema
}
