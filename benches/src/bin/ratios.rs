//! `ratios FOLDER` writes the results of `cargo bench -p kempf-benches` as one table, `performance.csv` and
//! `report.md`: every time of criterion (mean, 95 % interval) with the time of its reference, both measured in one run,
//! and whether the ratio is within its limit.

use std::error::Error;
use std::path::{Path, PathBuf};

use kempf_benches::work::Reach;
use kempf_benches::works;
use report::number::significant;
use report::{Table, TableHead};
use serde_json::Value;

/// Columns of the table; times are in seconds per unit of work.
const COLUMNS: [&str; 11] = [
    "group",
    "work",
    "time_s",
    "lower_s",
    "upper_s",
    "beside",
    "ratio",
    "ratio_lower",
    "ratio_upper",
    "reach",
    "verdict",
];

fn main() -> Result<(), Box<dyn Error>> {
    let folder = std::env::args_os().nth(1).map(PathBuf::from).ok_or("expected the folder for the table")?;
    let program = std::env::current_exe()?;
    // …/target/release/ratios
    let target = program.ancestors().nth(2).unwrap_or(Path::new("target"));
    let criterion = std::env::var_os("CRITERION_HOME").map_or_else(|| target.join("criterion"), PathBuf::from);
    let cores = rayon::current_num_threads() as f64;
    let mut table = Table::new(TableHead::default().texts(COLUMNS));
    for group in works::all() {
        let time = |work: &str, units: f64| {
            let path = criterion.join(group.name).join(work).join("new/estimates.json");
            let mean: Value = serde_json::from_str(&std::fs::read_to_string(path).ok()?).ok()?;
            let interval = &mean["mean"]["confidence_interval"];
            let [value, lower, upper] =
                [&mean["mean"]["point_estimate"], &interval["lower_bound"], &interval["upper_bound"]];
            Some([value.as_f64()?, lower.as_f64()?, upper.as_f64()?].map(|time| 1e-9 * time / units))
        };
        for row in &group.rows {
            let Some([value, lower, upper]) = time(&row.work.name, row.work.units) else { continue };
            let units = |name: &str| group.rows.iter().find(|row| row.work.name == name).map(|row| row.work.units);
            let beside = row.beside.as_deref().and_then(|name| time(name, units(name)?));
            // The interval of a ratio is the worst case of both intervals.
            let ratio = beside.map(|[other, least, most]| match row.reach {
                Some(Reach::Scaling(_)) => [other / value, least / upper, most / lower].map(|times| times / cores),
                _ => [value / other, lower / most, upper / least],
            });
            let verdict = |is_kept: bool| if is_kept { "met" } else { "missed" }.to_owned();
            let (reach, verdict) = match (row.reach, ratio) {
                (Some(Reach::Ratio(limit)), Some([ratio, ..])) => (format!("≤ {limit}"), verdict(ratio <= limit)),
                (Some(Reach::Scaling(limit)), Some([share, ..])) => (format!("≥ {limit}"), verdict(share >= limit)),
                _ => Default::default(),
            };
            let times = [value, lower, upper].map(|time| format!("{time:.3e}"));
            let ratios = ratio.map(|ratios| ratios.map(|ratio| significant(ratio, 3))).unwrap_or_default();
            let name = [group.name.to_owned(), row.work.name.clone()];
            let beside = [row.beside.clone().unwrap_or_default()];
            table.push(name.into_iter().chain(times).chain(beside).chain(ratios).chain([reach, verdict]));
        }
    }
    std::fs::create_dir_all(&folder)?;
    std::fs::write(folder.join("performance.csv"), table.to_csv())?;
    std::fs::write(folder.join("report.md"), format!("# What the work costs\n\n{}", table.to_markdown()))?;
    println!("{}", table.to_text());
    Ok(())
}
