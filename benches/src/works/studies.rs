//! Studies: trials on one core and on all cores, resolution of scenarios, drawing of figures.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use campaign::collect::collect_in_memory;
use campaign::curves::zigzag_plot_data;
use campaign::scenario::Scenario;
use rayon::prelude::*;
use report::{Drawing, Theme};
use trial::ZigZag;

use crate::records::{ROWS, first_order_zig_zag, record};
use crate::work::{Reach, Work, WorkGroup};

/// Number of trials per repetition.
const TRIALS: u64 = 256;

/// Minimum share of the cores that a study uses.
const SHARE: f64 = 0.92;

/// Number of figures that are drawn in parallel.
const FIGURES: usize = 8;

/// Files of all scenarios of the project, in the order of their names.
fn scenarios() -> Vec<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../scenarios");
    let entries = std::fs::read_dir(folder).expect("the scenarios are in the project");
    let mut files: Vec<PathBuf> = entries.filter_map(|entry| Some(entry.ok()?.path())).collect();
    files.retain(|path| path.extension().is_some_and(|extension| extension == "toml"));
    files.sort();
    files
}

/// Trials of the scenario for the number of trials per second: 271 samples, seven methods.
fn trials() -> impl Fn() -> usize + Send + Sync + 'static {
    let throughput = Path::new(env!("CARGO_MANIFEST_DIR")).join("throughput.toml");
    let scenario = Scenario::read(&throughput, None).expect("a scenario of the project");
    let scenario = Scenario { replicates: TRIALS, ..scenario };
    move || collect_in_memory(&scenario).1.len()
}

fn drawing() -> Drawing {
    let trial = record(&first_order_zig_zag(ROWS));
    let zigzag = ZigZag::from_trial(&trial).expect("a zig-zag");
    report::figures::Plot::from(zigzag_plot_data(&trial, &zigzag)).draw("A zig-zag", &Theme::screen())
}

/// Benchmarks of trials, scenarios and figures.
pub fn studies() -> WorkGroup {
    let mut group = WorkGroup::new(
        "study",
        "Trials, scenarios and figures",
        "Trials are those of benches/throughput.toml: 271 samples, seven methods, rows kept in memory. The figure is a zig-zag of \
         1201 rows with its characteristic points, 1800 pixels across (twice the pixels of a screen page).",
    );
    let single = group.alone(Work::new("256 trials, one core", trials()).of_units(TRIALS as usize).slow(), None);
    let all = Work::new("256 trials, all cores", trials()).of_units(TRIALS as usize).slow().on_all_cores();
    group.beside(all, &single, Some(Reach::Scaling(SHARE)));
    let files = scenarios();
    let resolve = move || files.iter().filter(|file| Scenario::read(file, None).is_ok()).count();
    group.alone(Work::new("resolve every scenario", resolve), None);
    let figure = Arc::new(drawing());
    let drawn = Arc::clone(&figure);
    let single = group.alone(Work::new("one PNG at 2x", move || drawn.png().expect("a small figure")).slow(), None);
    let many = move || (0..FIGURES).into_par_iter().map(|_| figure.png().expect("a small figure").len()).sum::<usize>();
    let many = Work::new("eight PNGs at 2x, all cores, each", many).of_units(FIGURES).slow().on_all_cores();
    group.beside(many, &single, None);
    group
}
