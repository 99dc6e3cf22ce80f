//! `shards [SHARDS TRIALS]...` measures the bookkeeping of a study in many shards, without computing its trials: it
//! writes finished shards full of made-up rows, joins them as `study merge` does, and prints what that took. Each pair
//! of arguments is a number of shards and of trials in each. The folders are made beside other temporary files
//! (`TMPDIR`) and removed.

use std::fs;
use std::io::{Read, Seek, SeekFrom};
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::time::{Duration, Instant};

use campaign::collect::in_memory;
use campaign::design::Design;
use campaign::folder::ResultFolder;
use campaign::manifest::Manifest;
use campaign::plan::Plan;
use campaign::rows::{Layout, Row, Writer};
use campaign::task::Shard;
use campaign::timings::Timing;
use campaign::timings::Timings;
use campaign::{files, store};
use kempf_benches::process::{self, Cost, Outcome, STYLE, quiet};
use kempf_benches::works;
use rayon::prelude::*;
use report::number::{MISSING, fixed, significant};
use report::{Column, Table};
use scenario::Scenario;
use scenario::failure::Failure;
use study::commands::{merge, report as republish};

/// What is measured when nothing is asked for: the same trials in more and more shards, then more trials.
const SIZES: [(u64, u64); 5] = [(10, 10_000), (100, 1000), (1000, 100), (10_000, 10), (10_000, 100)];

const MERGE: &str = "--merge";
const REPORT: &str = "--report";

/// Trials that are made at a time.
const BATCH: u64 = 2048;

/// Rows of a row group.
const GROUP: u64 = 65_536;

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let done = match arguments.first().map(String::as_str) {
        Some(MERGE) => joined(&arguments[1..]),
        Some(REPORT) => published(&arguments[1..]),
        _ => match sizes(&arguments) {
            Some(sizes) => run(&sizes),
            None => {
                eprintln!("usage: shards [SHARDS TRIALS]..., for instance shards 10000 100");
                return ExitCode::from(2);
            }
        },
    };
    process::end(done)
}

fn sizes(arguments: &[String]) -> Option<Vec<(u64, u64)>> {
    if arguments.is_empty() {
        return Some(SIZES.to_vec());
    }
    let numbers: Vec<u64> = arguments.iter().map(|text| text.parse().ok()).collect::<Option<_>>()?;
    let is_whole = numbers.len().is_multiple_of(2) && numbers.iter().all(|number| *number > 0);
    is_whole.then(|| numbers.chunks(2).map(|pair| (pair[0], pair[1])).collect())
}

fn run(sizes: &[(u64, u64)]) -> Outcome<()> {
    let mut table = Table::new([
        Column::right("shards"),
        Column::right("trials"),
        Column::right("rows"),
        Column::right("files"),
        Column::decimal("written").unit("s"),
        Column::decimal("joined").unit("s"),
        Column::decimal("per row").unit("µs"),
        Column::decimal("tables, figures").unit("s"),
        Column::decimal("per row").unit("µs"),
        Column::decimal("peak memory").unit("MB"),
        Column::decimal("bytes per row"),
        Column::decimal("metadata per row group").unit("kB"),
        Column::decimal("command line").unit("kB"),
    ]);
    for &(shards, trials) in sizes {
        eprintln!("{shards} shards of {trials} trials …");
        table.push(measure(shards, trials)?);
    }
    print!("{}", table.to_markdown());
    Ok(())
}

fn measure(shards: u64, trials: u64) -> Outcome<Vec<String>> {
    let folder = tempfile::tempdir()?;
    let scenario = throughput(shards * trials)?;
    let start = Instant::now();
    let folders = write(&scenario, shards, folder.path())?;
    let written = start.elapsed();
    let out = folder.path().join("whole");
    let command: usize = folders.iter().map(|folder| folder.as_os_str().len() + 1).sum();
    let merge =
        process::again([MERGE.as_ref(), out.as_os_str()].into_iter().chain(folders.iter().map(|f| f.as_os_str())))?;
    let report = process::again([REPORT.as_ref(), out.as_os_str()])?;
    let rows = (scenario.replicates * scenario.labels().count() as u64) as f64;
    let file = fs::metadata(out.join(files::ROWS))?.len() as f64;
    let Cost { wall, memory } = merge;
    let join = (wall - report.wall).max(0.0);
    Ok(vec![
        shards.to_string(),
        scenario.replicates.to_string(),
        fixed(rows, 0),
        (shards * 6).to_string(),
        fixed(written.as_secs_f64(), 1),
        fixed(join, 2),
        significant(join * 1e6 / rows, 3),
        fixed(report.wall, 2),
        significant(report.wall * 1e6 / rows, 3),
        memory.map_or(MISSING.to_owned(), |memory| fixed(memory, 0)),
        significant(file / rows, 3),
        significant(footer(&out.join(files::ROWS))? as f64 * 1e-3 / (rows / GROUP as f64).ceil(), 3),
        significant(command as f64 * 1e-3, 3),
    ])
}

/// The scenario of the throughput with another number of trials.
fn throughput(trials: u64) -> Outcome<Scenario> {
    let path = works::throughput();
    let mut scenario: toml::Table = fs::read_to_string(&path)?.parse()?;
    scenario.insert("replicates".to_owned(), toml::Value::Integer(i64::try_from(trials)?));
    text_of(Scenario::parse(&path, "throughput", toml::to_string(&scenario)?, None))
}

fn text_of<T>(result: Result<T, Failure>) -> Outcome<T> {
    result.map_err(|failure| failure.to_string().into())
}

/// Length of the metadata at the end of a Parquet file, bytes.
fn footer(path: &Path) -> Outcome<u32> {
    let mut file = fs::File::open(path)?;
    file.seek(SeekFrom::End(-8))?;
    let mut length = [0; 4];
    file.read_exact(&mut length)?;
    Ok(u32::from_le_bytes(length))
}

/// Writes all shards and returns their folders.
fn write(scenario: &Scenario, shards: u64, folder: &Path) -> Outcome<Vec<PathBuf>> {
    // The trial that all rows are made from.
    let few = throughput(1)?;
    let (design, rows) = in_memory(&few);
    let manifest = Manifest::new(scenario, Shard::WHOLE);
    let digits = shards.to_string().len();
    let one = |number: u64| {
        let shard = Shard { number, of: shards };
        let path = folder.join(format!("{number:0digits$}-of-{shards}"));
        made_up(scenario, &Manifest { shard, ..manifest.clone() }, &design, &rows, &path).map(|()| path)
    };
    text_of((1..=shards).into_par_iter().map(one).collect())
}

/// A finished shard.
fn made_up(
    scenario: &Scenario,
    manifest: &Manifest,
    design: &Design,
    rows: &[Row],
    folder: &Path,
) -> Result<(), Failure> {
    let folder = ResultFolder::hold(folder)?;
    let mut design = design.clone();
    design.cells.iter_mut().for_each(|cell| cell.trials = 0..0);
    let layout = Layout::of(&design);
    let mut writer = Writer::create(&folder, files::ROWS, &layout)?;
    let mut timings = Timings::new(design.methods.len());
    let mut plan = Plan::new(scenario, manifest.shard);
    loop {
        let tasks = plan.next(BATCH);
        if tasks.is_empty() {
            break;
        }
        for task in tasks {
            let trials = &mut design.cells[task.cell].trials;
            let start = if trials.is_empty() { task.replicate } else { trials.start };
            *trials = start..task.replicate + 1;
            let row =
                |row: &Row| Row { cell: task.cell as u64, replicate: task.replicate, ..varied(row, task.replicate) };
            writer.push(rows.iter().map(row))?;
            let time = Duration::from_micros(100);
            let methods = vec![time; design.methods.len()];
            timings.add(&Timing { cell: task.cell as u64, simulation: time, methods });
        }
    }
    let (file, sha256) = writer.finish()?;
    file.put()?;
    store::finish(&folder, manifest, sha256, design, Vec::new(), &timings).map(drop)
}

/// The same row with other last digits, so that columns cannot be packed better than those of real trials.
fn varied(row: &Row, replicate: u64) -> Row {
    // SplitMix64 (Steele, Lea and Flood 2014): neighbours share nothing.
    let mut bits = replicate.wrapping_add(row.method as u64).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    bits = (bits ^ (bits >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    bits = (bits ^ (bits >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    let factor = 1.0 + 1e-2 * ((bits >> 11) as f64 / (1_u64 << 53) as f64 - 0.5);
    let scaled = |value: Option<f64>| value.map(|value| value * factor);
    let ends = |ends: Option<[f64; 2]>| ends.map(|ends| ends.map(|end| end * factor));
    Row {
        k_per_s: scaled(row.k_per_s),
        k_ci95_per_s: ends(row.k_ci95_per_s),
        t_s: scaled(row.t_s),
        t_ci95_s: ends(row.t_ci95_s),
        rudder_bias_deg: scaled(row.rudder_bias_deg),
        rudder_bias_ci95_deg: ends(row.rudder_bias_ci95_deg),
        heading_rmse_deg: scaled(row.heading_rmse_deg),
        ..row.clone()
    }
}

/// `study merge DIR... --out OUT --quiet`.
fn joined(arguments: &[String]) -> Outcome<()> {
    let (out, folders) = arguments.split_first().ok_or("this is not a command")?;
    let folders: Vec<PathBuf> = folders.iter().map(PathBuf::from).collect();
    text_of(merge::run(&folders, &STYLE, &quiet(out)))?;
    process::tell();
    Ok(())
}

/// `study report OUT --quiet`.
fn published(arguments: &[String]) -> Outcome<()> {
    let [out] = arguments else { return Err("this is not a command".into()) };
    text_of(republish::run(Path::new(out), false, &STYLE, &quiet(out)))?;
    process::tell();
    Ok(())
}
