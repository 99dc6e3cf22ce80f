//! `study schema`: the JSON schema of a file that people or programs write or read.

use campaign::benchmark::BenchDocument;
use campaign::design::Design;
use campaign::failure::{Failure, OnPath};
use campaign::manifest::Manifest;
use campaign::outside_estimates::Trials;
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
use crate::options::{CommonOptions, Described};
use crate::screen;

/// Arguments of `study schema`.
#[derive(Debug, Clone, Args)]
pub struct SchemaRequest {
    /// Which file
    pub what: Described,
}

/// Prints the schema.
pub fn run(&SchemaRequest { what }: &SchemaRequest, _: &CommonOptions) -> Result<(), Failure> {
    let text = documents::text(&schema(what)).on("describe", Path::new("a schema"))?;
    screen::print_unescaped(&text)
}

/// JSON schema of a file, in draft 7, which editors of TOML understand as well.
pub fn schema(what: Described) -> Schema {
    match what {
        Described::Scenario => campaign::scenario::schema::schema(),
        Described::Sidecar => trial::sidecar::schema(),
        Described::Fit => of::<FitDocument>(),
        Described::Trace => of::<TraceDocument>(),
        Described::Predict => of::<PredictDocument>(),
        Described::Manifest => of::<Manifest>(),
        Described::Bench => of::<BenchDocument>(),
        Described::FitCurves => of::<FitCurves>(),
        Described::Cells => of::<Design>(),
        Described::Showcase => of::<Vec<Showcase>>(),
        Described::Style => read::<Style>(),
        Described::Trials => of::<Trials>(),
        Described::Truth => of::<TruthDocument>(),
        Described::Study => answer::<StudyAnswer>(),
        Described::Shard => answer::<ShardAnswer>(),
        Described::Find => answer::<FindAnswer>(),
        Described::Inspect => answer::<InspectAnswer>(),
        Described::Check => answer::<CheckAnswer>(),
        Described::List => answer::<ListAnswer>(),
        Described::Simulate => answer::<SimulateAnswer>(),
        Described::SidecarAnswer => answer::<SidecarAnswer>(),
        Described::FitEach => of::<LogFitEntry>(),
        Described::Error => of::<ErrorDocument>(),
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
