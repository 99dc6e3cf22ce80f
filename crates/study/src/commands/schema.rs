//! `study schema`: the JSON schema of a file that people or programs write or read.

use campaign::manifest::Manifest;
use clap::Args;
use predict::PredictDocument;
use scenario::failure::{Failure, OnPath};
use schemars::generate::SchemaSettings;
use schemars::{JsonSchema, Schema};
use std::path::Path;

use crate::documents;
use crate::documents::fit::FitDocument;
use crate::documents::trace::TraceDocument;
use crate::options::{Common, Described};
use crate::screen;

/// What `study schema` is asked to do.
#[derive(Debug, Clone, Args)]
pub struct SchemaRequest {
    /// Which file
    pub what: Described,
}

/// Prints the schema.
pub fn run(&SchemaRequest { what }: &SchemaRequest, common: &Common) -> Result<(), Failure> {
    let text = documents::text(&schema(what)).on("describe", Path::new("a schema"))?;
    if common.quiet { Ok(()) } else { screen::say_document(&text) }
}

/// The schema of a file, in draft 7, which editors of TOML understand as well.
pub fn schema(what: Described) -> Schema {
    match what {
        Described::Scenario => scenario::schema::schema(),
        Described::Sidecar => trial::sidecar::schema(),
        Described::Fit => of::<FitDocument>(),
        Described::Trace => of::<TraceDocument>(),
        Described::Predict => of::<PredictDocument>(),
        Described::Manifest => of::<Manifest>(),
    }
}

/// The schema of what the program writes.
fn of<T: JsonSchema>() -> Schema {
    SchemaSettings::draft07().for_serialize().into_generator().into_root_schema_for::<T>()
}
