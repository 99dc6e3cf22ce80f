//! `ratios [FOLDER]` makes tables of ratios from what `cargo bench -p kempf-benches` has stored: it prints them, and
//! writes them into a folder as `report.md` and, for machines, as `performance.csv`.

use std::error::Error;
use std::fs;
use std::path::{Path, PathBuf};

use kempf_benches::ratios::{lines, table};
use kempf_benches::works;

/// Head of the report.
const HEAD: &str = "# What the work costs\n\n\
    Made by `cargo bench -p kempf-benches && cargo run --release -p kempf-benches --bin ratios -- results/performance`.\n\n\
    Times are those of criterion; ± is half of a 95 % interval, and that of a ratio is the worst case of both intervals.\n";

/// Columns of `performance.csv`.
const COLUMNS: [&str; 14] = [
    "group",
    "work",
    "threads",
    "units",
    "time_s",
    "lower_s",
    "upper_s",
    "beside",
    "beside_s",
    "ratio",
    "ratio_lower",
    "ratio_upper",
    "reach",
    "verdict",
];

fn main() -> Result<(), Box<dyn Error>> {
    let criterion = std::env::var_os("CRITERION_HOME").map_or_else(in_target, PathBuf::from);
    let mut report = HEAD.to_owned();
    let mut rows = csv::Writer::from_writer(Vec::new());
    rows.write_record(COLUMNS)?;
    // The group of outside estimators is only named here, so its program need not be there.
    for group in works::all().into_iter().chain([works::outside("echo")]) {
        let lines = lines(&group, &criterion);
        if lines.is_empty() {
            eprintln!("nothing of `{}` was measured; run `cargo bench -p kempf-benches -- {}`", group.name, group.name);
            continue;
        }
        report += &format!("\n## {}\n\n{}\n\n{}", group.title, group.about, table(&lines).to_markdown());
        lines.iter().try_for_each(|line| rows.write_record(line.record(group.name)))?;
    }
    print!("{report}");
    if let Some(folder) = std::env::args_os().nth(1).map(PathBuf::from) {
        fs::create_dir_all(&folder)?;
        fs::write(folder.join("report.md"), report)?;
        fs::write(folder.join("performance.csv"), rows.into_inner()?)?;
    }
    Ok(())
}

/// Where criterion keeps its estimates: `criterion` in the target folder that this program is in.
fn in_target() -> PathBuf {
    let program = std::env::current_exe().ok();
    // …/target/release/ratios
    let target = program.as_deref().and_then(|path| path.ancestors().nth(2));
    target.unwrap_or_else(|| Path::new("target")).join("criterion")
}
