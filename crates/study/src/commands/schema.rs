//! `study schema`: the JSON schema of a file that people or programs write or read.

use campaign::benchmark::BenchDocument;
use campaign::design::Design;
use campaign::failure::{Failure, OnPath};
use campaign::manifest::Manifest;
use campaign::outside_estimates::TrialsDocument;
use campaign::showcase::Showcase;
use clap::Args;
use document::fit::FitDocument;
use document::trace::TraceDocument;
use predict::PredictDocument;
use report::Style;
use schemars::generate::SchemaSettings;
use schemars::{JsonSchema, Schema};
use serde_json::Value;
use std::path::Path;

use crate::documents;
use crate::documents::answers::{
    CheckAnswer, CommandAnswer, ListAnswer, ShardAnswer, SidecarAnswer, SimulateAnswer, StudyAnswer, Versioned,
};
use crate::documents::error::ErrorDocument;
use crate::documents::find::FindAnswer;
use crate::documents::fit_curves::FitCurves;
use crate::documents::fit_each::LogFitEntry;
use crate::documents::inspect::InspectAnswer;
use crate::documents::truth::TruthDocument;
use crate::options::{CommonOptions, SchemaSubject};
use crate::screen;

/// Arguments of `study schema`.
#[derive(Debug, Clone, Args)]
pub struct SchemaRequest {
    /// Which file
    pub what: SchemaSubject,
}

/// Prints the schema.
pub fn run(&SchemaRequest { what }: &SchemaRequest, _: &CommonOptions) -> Result<(), Failure> {
    let text = documents::to_json(&schema(what)).on("describe", Path::new("a schema"))?;
    screen::print_unescaped(&text)
}

/// JSON schema of a file, in draft 7, which editors of TOML understand as well.
pub fn schema(what: SchemaSubject) -> Schema {
    match what {
        SchemaSubject::Scenario => campaign::scenario::schema::schema(),
        SchemaSubject::Sidecar => trial::sidecar::sidecar_schema(),
        SchemaSubject::Fit => of::<FitDocument>(),
        SchemaSubject::Trace => of::<TraceDocument>(),
        SchemaSubject::Predict => of::<PredictDocument>(),
        SchemaSubject::Manifest => of::<Manifest>(),
        SchemaSubject::Bench => of::<BenchDocument>(),
        SchemaSubject::FitCurves => of::<FitCurves>(),
        SchemaSubject::Cells => of::<Design>(),
        SchemaSubject::Showcase => of::<Vec<Showcase>>(),
        SchemaSubject::Style => read::<Style>(),
        SchemaSubject::Trials => of::<TrialsDocument>(),
        SchemaSubject::Truth => of::<TruthDocument>(),
        SchemaSubject::Study => answer::<StudyAnswer>(),
        SchemaSubject::Shard => answer::<ShardAnswer>(),
        SchemaSubject::Find => answer::<FindAnswer>(),
        SchemaSubject::Inspect => answer::<InspectAnswer>(),
        SchemaSubject::Check => answer::<CheckAnswer>(),
        SchemaSubject::List => answer::<ListAnswer>(),
        SchemaSubject::Simulate => answer::<SimulateAnswer>(),
        SchemaSubject::SidecarAnswer => answer::<SidecarAnswer>(),
        SchemaSubject::FitEach => of::<LogFitEntry>(),
        SchemaSubject::Error => of::<ErrorDocument>(),
    }
}

/// Schema of a type that the program reads.
fn read<T: JsonSchema>() -> Schema {
    SchemaSettings::draft07().for_deserialize().into_generator().into_root_schema_for::<T>()
}

/// Schema of a command's JSON output, with its version.
fn answer<A: CommandAnswer>() -> Schema {
    let mut schema = of::<Versioned<A>>();
    if let Some(version) = schema.pointer_mut("/properties/schema").and_then(Value::as_object_mut) {
        version.insert("const".into(), A::SCHEMA.into());
    }
    schema
}

/// Schema of a type that the program writes.
fn of<T: JsonSchema>() -> Schema {
    SchemaSettings::draft07().for_serialize().into_generator().into_root_schema_for::<T>()
}
