//! Criterion measures, and what it found is put into one table: every work beside its rival. Filters, `--test` and the
//! other options of criterion work as usual; the table holds what was measured by this run, so there is none with
//! `--test`.

use std::env;
use std::fs;
use std::path::{Path, PathBuf};
use std::time::SystemTime;

use criterion::Criterion;
use serde::Deserialize;

use crate::measure::Measured;
use crate::verdict::{Line, table};
use crate::work::{Group, Work};

/// Samples of work that takes long.
const FEW_SAMPLES: usize = 10;

/// Measures a group as the arguments of the program say, and prints its table.
pub fn run(group: &Group) {
    let start = SystemTime::now();
    let folder = folder();
    let mut criterion = Criterion::default().output_directory(&folder).configure_from_args();
    for work in group.works() {
        let mut benches = criterion.benchmark_group(group.name);
        if work.is_slow {
            benches.sample_size(FEW_SAMPLES);
        }
        benches.bench_function(&work.name, |bencher| bencher.iter_custom(|goes| work.time(goes)));
        benches.finish();
    }
    criterion.final_summary();
    let lines = lines(group, |work| estimate(&folder.join(group.name).join(&work.name), start));
    if !lines.is_empty() {
        println!("{}\n\n{}", group.about, table(&lines).to_text());
        println!("± is half of a 95 % interval; that of a ratio is the worst case of both intervals.\n");
    }
}

/// The rows whose work was measured.
fn lines(group: &Group, estimate: impl Fn(&Work) -> Option<Measured>) -> Vec<Line> {
    let line = |row: &crate::work::Row| {
        let beside = row.beside.as_ref().and_then(|beside| estimate(beside));
        Some(Line::apart(row, estimate(&row.work)?.times(1.0 / row.work.units), scaled(row, beside)))
    };
    group.rows.iter().filter_map(line).collect()
}

fn scaled(row: &crate::work::Row, beside: Option<Measured>) -> Option<Measured> {
    let units = row.beside.as_ref()?.units;
    Some(beside?.times(1.0 / units))
}

/// Where criterion keeps its estimates: `CRITERION_HOME`, or `criterion` in the target folder that this program is in.
fn folder() -> PathBuf {
    if let Some(home) = env::var_os("CRITERION_HOME") {
        return PathBuf::from(home);
    }
    let program = env::current_exe().ok();
    // …/target/release/deps/bench
    let target = program.as_deref().and_then(|path| path.ancestors().nth(3));
    target.unwrap_or_else(|| Path::new("target")).join("criterion")
}

#[derive(Deserialize)]
struct Estimates {
    mean: Estimate,
    slope: Option<Estimate>,
}

#[derive(Deserialize)]
struct Estimate {
    confidence_interval: Interval,
    point_estimate: f64,
}

#[derive(Deserialize)]
struct Interval {
    lower_bound: f64,
    upper_bound: f64,
}

/// What criterion found, s per go: the slope of time over goes, or the mean where all samples have as many goes. `None`
/// unless it was found after `start`.
fn estimate(folder: &Path, start: SystemTime) -> Option<Measured> {
    let path = folder.join("new/estimates.json");
    let written = fs::metadata(&path).and_then(|file| file.modified()).ok()?;
    if written < start {
        return None;
    }
    let Estimates { mean, slope } = serde_json::from_str(&fs::read_to_string(path).ok()?).ok()?;
    let typical = slope.unwrap_or(mean);
    let Interval { lower_bound, upper_bound } = typical.confidence_interval;
    let nanoseconds =
        Measured { value: typical.point_estimate, interval: [lower_bound, upper_bound], least: None, samples: 0 };
    Some(nanoseconds.times(1e-9))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::work::Reach;
    use std::time::Duration;

    const FOUND: &str = r#"{
        "mean": {"confidence_interval": {"confidence_level": 0.95, "lower_bound": 190.0, "upper_bound": 210.0},
                 "point_estimate": 200.0, "standard_error": 5.0},
        "median": {}, "median_abs_dev": {}, "slope": null, "std_dev": {} }"#;

    #[test]
    fn only_what_was_measured_now_is_in_the_table() {
        let folder = tempfile::tempdir().expect("a folder");
        let new = folder.path().join("new");
        fs::create_dir(&new).expect("a folder");
        fs::write(new.join("estimates.json"), FOUND).expect("a file");
        let hour = Duration::from_secs(3600);
        let found = estimate(folder.path(), SystemTime::now() - hour).expect("fresh");
        assert!((found.value - 2e-7).abs() < 1e-12 && (found.half_width() - 1e-8).abs() < 1e-12);
        assert_eq!(estimate(folder.path(), SystemTime::now() + hour), None);
    }

    #[test]
    fn a_filter_that_leaves_out_the_rival_leaves_out_the_ratio() {
        let mut group = Group::new("group", "");
        let rival = group.alone(Work::new("rival", || ()), None);
        group.beside(Work::new("own", || ()), &rival, Some(Reach::Ratio(2.0)));
        let measured = Measured { value: 1.0, interval: [0.9, 1.1], least: None, samples: 0 };
        let lines = lines(&group, |work| (work.name == "own").then_some(measured));
        assert_eq!(lines.len(), 1);
        assert!(lines[0].ratio.is_none() && lines[0].verdict().is_none());
    }
}
