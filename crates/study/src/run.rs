//! `study SCENARIO.toml`: run, store, publish what is stored.

use std::path::Path;
use std::time::Instant;

use rayon::prelude::*;

use crate::cli::Common;
use crate::engine;
use crate::failure::{Failure, result_folder};
use crate::manifest::Manifest;
use crate::publish;
use crate::scenario::Scenario;
use crate::showcase;
use crate::store::{Design, Stored};

/// Runs a scenario, stores what it gives and publishes it, as `study report` would.
pub fn run(path: &Path, common: &Common) -> Result<(), Failure> {
    let scenario = Scenario::read(path, common.seed)?;
    let folder = common.out.clone().unwrap_or_else(|| Path::new("results").join(&scenario.name));
    result_folder(&folder)?;
    let start = Instant::now();
    let rows = engine::run(&scenario, common.quiet);
    let design = Design {
        question: scenario.question.clone(),
        analysis: scenario.analysis.clone(),
        axes: scenario.axes.iter().map(|axis| axis.name.clone()).collect(),
        methods: scenario.method_names(),
        cells: engine::facts(&scenario),
    };
    let shown = if scenario.showcase { scenario.cells.len() } else { 0 };
    let showcases = (0..shown).into_par_iter().filter_map(|cell| showcase::of_cell(&scenario, cell)).collect();
    let manifest = Manifest::new(&scenario, start.elapsed());
    Stored { manifest, rows, design, showcases }.write(&folder)?;
    publish::report(&folder, common)
}
