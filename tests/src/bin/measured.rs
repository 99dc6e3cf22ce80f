//! Traces the measured records and writes what came out. Longer than most: every table of the page is made here.
//! The records are not part of the project; the page goes into `results/published/measured`.
//!
//! Run with the folder of the results as only argument; the records are looked for as [`kempf_tests::measured`] says.

use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use kempf_tests::autopilot;
use kempf_tests::measured::folder;
use kempf_tests::stability;
use kempf_tests::wrapped::without_jumps;
use report::number::{fixed, significant};
use report::{Table, TableColumn};
use study::options::{
    Common, FigureOptions, Format, PageFigureOptions, PageFigures, ReadingOptions, ShipOptions, TraceRequest, Withheld,
};
use trace::document::{BeforeAfter, EffectEntry, ErrorsEntry, RecordNoiseEntry};
use trace::{Document, Rule};

/// Records of one ship, of which each is fitted in turn and the others are held out.
struct Set {
    name: &'static str,
    folder: &'static str,
    records: &'static [&'static str],
    /// Records that are fitted together, the others being held out; without others, each is left out in turn.
    pools: &'static [&'static [&'static str]],
    /// Turning circles: held out from the pools once more, by themselves. A rudder that stays where it is tells too
    /// little to be fitted.
    circles: &'static [&'static str],
    /// Whether the records have wind columns.
    wind: bool,
    /// The column of directions that was interpolated across north.
    wrapped: Option<&'static str>,
    /// Folder and records of earlier trials of the same hull: every record alone is traced once more with what they
    /// left as a prior.
    prior: Option<(&'static str, &'static [&'static str])>,
}

impl Set {
    /// The zig-zags that are not among some of them.
    fn others(&self, records: &[&str]) -> Vec<&'static str> {
        self.records.iter().copied().filter(|other| !records.contains(other)).collect()
    }

    /// What is held out from a record alone: the other zig-zags, or the circles where there are none.
    fn beside(&self, record: &str) -> Vec<&'static str> {
        let others = self.others(&[record]);
        if others.is_empty() { self.circles.to_vec() } else { others }
    }
}

const ESSO_OSAKA: [&str; 5] =
    ["zigzag_13_57_45", "zigzag_13_04_24", "zigzag_13_14_21", "zigzag_13_42_53", "zigzag_14_10_05"];

const SETS: [Set; 4] = [
    Set {
        name: "KVLCC2, 7 m model, HSVA",
        folder: "kvlcc2_hsva",
        records: &[
            "zigzag_20_10_s",
            "zigzag_10_10_s",
            "zigzag_35_05",
            "zigzag_30_05",
            "zigzag_20_05",
            "zigzag_15_05",
            "zigzag_10_05",
            "zigzag_05_01",
        ],
        pools: &[&["zigzag_20_10_s", "zigzag_10_10_s", "zigzag_15_05"]],
        circles: &[],
        wind: false,
        wrapped: None,
        prior: Some(("kvlcc2_marin", &["zigzag_20", "zigzag_-20"])),
    },
    Set {
        name: "KVLCC2, MARIN, full-scale values",
        folder: "kvlcc2_marin",
        records: &["zigzag_20", "zigzag_-20", "zigzag_10"],
        pools: &[&["zigzag_20", "zigzag_-20"]],
        circles: &["turning_35"],
        wind: false,
        wrapped: None,
        prior: None,
    },
    Set {
        name: "Esso Osaka, 3 m model outdoors",
        folder: "esso_osaka",
        records: &ESSO_OSAKA,
        pools: &[&["zigzag_13_57_45", "zigzag_13_04_24", "zigzag_13_14_21"], &ESSO_OSAKA],
        circles: &[
            "turning_oct14_14_29_49",
            "turning_oct14_15_06_53",
            "turning_sep14_13_51_45",
            "turning_sep14_14_50_41",
        ],
        wind: true,
        wrapped: None,
        prior: None,
    },
    Set {
        name: "Boat of 3.6 m, Fuzhou",
        folder: "usv_fuzhou",
        records: &["zigzag_30_inter_xy"],
        pools: &[],
        circles: &["turnningdata_xy"],
        wind: false,
        wrapped: Some("zcourse"),
        prior: None,
    },
];

/// Cases whose whole report is kept: record, and whether the wind is withheld.
const KEPT: [(&str, bool); 3] = [("zigzag_20_10_s", false), ("zigzag_20", false), ("zigzag_13_57_45", false)];

fn main() -> ExitCode {
    let Some(results) = std::env::args_os().nth(1).map(PathBuf::from) else {
        eprintln!("give the folder of the results, for instance results/published/measured");
        return ExitCode::from(2);
    };
    if !folder().is_dir() {
        eprintln!(
            "there are no measured records in {}; set TRIAL_DATA to the folder that holds them",
            folder().display()
        );
        return ExitCode::from(2);
    }
    match run(&results) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("{error}");
            ExitCode::FAILURE
        }
    }
}

type Outcome<T> = Result<T, Box<dyn std::error::Error>>;

fn run(results: &Path) -> Outcome<()> {
    let scratch = tempfile::tempdir()?;
    let mut page = String::from(INTRODUCTION);
    for set in &SETS {
        let _ = writeln!(page, "## {}\n", set.name);
        if !folder().join(set.folder).is_dir() {
            eprintln!("skipped: no measured records {}", set.folder);
            page += "Not traced: the records are not there.\n\n";
            continue;
        }
        let mut table = errors_table();
        let alone = each_alone(set, scratch.path(), results, &mut table)?;
        pooled(set, scratch.path(), &mut table)?;
        with_prior(set, scratch.path(), &mut table)?;
        let _ = writeln!(page, "{}", table.to_markdown());
        if alone.len() > 1 {
            let _ = writeln!(page, "{STABILITY}\n\n{}", stability::table(&alone).to_markdown());
        }
    }
    let _ = writeln!(page, "{CLOSED_LOOP}\n\n{}", closed_loop(scratch.path())?.to_markdown());
    page += KEPT_REPORTS;
    for (record, without_wind) in KEPT {
        let set = SETS.iter().find(|set| set.records.contains(&record)).ok_or("a kept record belongs to a set")?;
        let wind = if without_wind { "-without-wind" } else { "" };
        let _ = writeln!(page, "- [{}: {record}{wind}]({}-{record}{wind}/report.md)", set.name, set.folder);
    }
    fs::create_dir_all(results)?;
    fs::write(results.join("README.md"), page)?;
    Ok(())
}

/// A line for every record traced alone; the documents of those with all that was recorded.
fn each_alone(set: &Set, scratch: &Path, results: &Path, table: &mut Table) -> Outcome<Vec<(&'static str, Document)>> {
    let withheld: &[bool] = if set.wind { &[false, true] } else { &[false] };
    let mut alone = Vec::new();
    for &record in set.records {
        for &without_wind in withheld {
            let name = if without_wind { format!("{record}-without-wind") } else { record.to_owned() };
            let out = scratch.join(&name);
            let document = trace_some(set, (&[record], &set.beside(record)), &[], without_wind, &out)?;
            let label = if without_wind { format!("{record}, wind withheld") } else { record.to_owned() };
            table.push(line(label, &document));
            if KEPT.contains(&(record, without_wind)) {
                keep(&out, &results.join(format!("{}-{name}", set.folder)))?;
            }
            if !without_wind {
                alone.push((record, document));
            }
        }
    }
    Ok(alone)
}

/// Lines for the records that are traced together.
fn pooled(set: &Set, scratch: &Path, table: &mut Table) -> Outcome<()> {
    for (number, pool) in set.pools.iter().enumerate() {
        let out = scratch.join(format!("{}-pool-{number}", set.folder));
        let others = set.others(pool);
        let document = trace_some(set, (pool, &others), &[], false, &out)?;
        let left = if others.is_empty() { ", each left out in turn" } else { "" };
        let together = format!("together: {}", pool.join(", "));
        table.push(line(format!("{together}{left}"), &document));
        if !set.circles.is_empty() {
            let document = trace_some(set, (pool, set.circles), &[], false, &out)?;
            table.push(line(format!("{together}; turning circles held out"), &document));
        }
    }
    Ok(())
}

/// Lines for the records traced alone with a prior from trials of the same hull elsewhere, and the geometric mean of
/// their ratios.
fn with_prior(set: &Set, scratch: &Path, table: &mut Table) -> Outcome<()> {
    let Some((folder, records)) = set.prior else { return Ok(()) };
    let source = SETS.iter().find(|set| set.folder == folder).ok_or("a prior is of a set")?;
    let out = scratch.join(format!("{folder}-prior"));
    trace_some(source, (records, &[]), &[], false, &out)?;
    let prior = [out.join("trace.json")];
    let mut logarithms = vec![[0.0; 3]; 0];
    for &record in set.records {
        let out = scratch.join(format!("{record}-with-prior"));
        let document = trace_some(set, (&[record], &set.beside(record)), &prior, false, &out)?;
        logarithms.push(ratios(&document).map(f64::ln));
        table.push(line(format!("{record}, prior from {folder}: {}", records.join(", ")), &document));
    }
    let mean = |place: usize| {
        let sum: f64 = logarithms.iter().map(|all| all[place]).sum();
        significant((sum / logarithms.len() as f64).exp(), 2)
    };
    let [whole, short, long] = [0, 1, 2].map(mean);
    let label = format!("geometric mean of the {} with a prior", logarithms.len());
    table.push([&label, "", "", "", "", &whole, &short, &long, "", ""].map(str::to_owned));
    Ok(())
}

const INTRODUCTION: &str = "# Measured records, traced

What a first-order response lacks on measured records, found from one record and judged on others that were not fitted. The records
are not part of the project; where they come from says [the book](../../../docs/src/howto/public-trials.md). Made by

```text
cargo run --release -p kempf-tests --bin measured -- results/published/measured
```

A line is one analysis: `study trace` of one record, or of some together, with all others of its set held out; where all are fitted
together, each is left out in turn, and where there is one zig-zag, a turning circle is held out. *heading*: error of the recorded
rudder replayed over the whole record, before (the best first-order base) and after (the average of the structures). *windows*: the
same restarted every 20 and 60 s. On held-out records only initial states are fitted; errors of several records are root mean squares
over them, as the ratio after over before. *Prior*: the hull is fitted about what `study trace` of the records named left, with
`--prior`. *band*: share of the measured headings of the held-out records inside the 95 % band, and
mean width of the band. Effects are named with their probability, the most probable first; *or* stands before those that the records
cannot tell from it.

";

const STABILITY: &str = "### The same effect in several records

Every effect that is named in a record of this hull traced alone: in how many of them, and its coefficients with their standard
deviations; without dimension where length and speed are known.";

const CLOSED_LOOP: &str = "## Full scale, under autopilot

No zig-zags: what a trace makes of a ship that an autopilot keeps on its course in a seaway. Neither file says its units. Assumed are
0.001 deg/s for the yaw rate of HAKUSAN, whose sum is the heading, and 0.01 deg for its rudder; degrees and one row a second for
America Maru; rudders positive to port.";

const KEPT_REPORTS: &str = "## Reports\n\nWhole, with figures:\n\n";

fn errors_table() -> Table {
    Table::new([
        TableColumn::left("fitted record"),
        TableColumn::left("found"),
        TableColumn::decimal("heading before").unit("deg"),
        TableColumn::decimal("after").unit("deg"),
        TableColumn::decimal("ratio"),
        TableColumn::decimal("held out: heading ratio"),
        TableColumn::decimal("held out: windows of 20 s"),
        TableColumn::decimal("held out: windows of 60 s"),
        TableColumn::decimal("held out: inside the band").unit("%"),
        TableColumn::decimal("held out: width of the band").unit("deg"),
    ])
}

/// Runs `study trace` on some records of a set, others held out, with models of earlier trials as priors, and reads
/// `trace.json`.
fn trace_some(
    set: &Set,
    (records, held_out): (&[&str], &[&str]),
    priors: &[PathBuf],
    without_wind: bool,
    out: &Path,
) -> Outcome<Document> {
    let prior = if priors.is_empty() { "" } else { ", with a prior" };
    eprintln!("{}: {}{}{prior}", set.folder, records.join(", "), if without_wind { ", wind withheld" } else { "" });
    let path = |name: &&str| file(set, name, out);
    let sidecars = Path::new(env!("CARGO_MANIFEST_DIR")).join("../scenarios/measured");
    // A sidecar of the whole set, else of each record.
    let of_set = sidecars.join(format!("{}.trial.toml", set.folder));
    let sidecars = if of_set.exists() { of_set } else { sidecars };
    let withheld = if without_wind { vec![Withheld::Wind] } else { Vec::new() };
    let [records, held_out] = [records, held_out].map(|names| names.iter().map(path).collect::<Outcome<Vec<_>>>());
    trace_files([records?, held_out?, priors.to_vec()], withheld, Some(sidecars), out)
}

/// The file of a record; a copy beside the results where directions have to be left out of it.
fn file(set: &Set, record: &str, out: &Path) -> Outcome<PathBuf> {
    let path = folder().join(set.folder).join(format!("{record}.csv"));
    let Some(column) = set.wrapped else { return Ok(path) };
    let copies = out.with_extension("records");
    fs::create_dir_all(&copies)?;
    let copy = copies.join(format!("{record}.csv"));
    fs::write(&copy, without_jumps(&fs::read_to_string(&path)?, column))?;
    Ok(copy)
}

/// Runs `study trace` on some files, others held out, with models as priors, and reads `trace.json`.
fn trace_files(
    [trials, validate, priors]: [Vec<PathBuf>; 3],
    without: Vec<Withheld>,
    columns: Option<PathBuf>,
    out: &Path,
) -> Outcome<Document> {
    let request = TraceRequest {
        trials,
        validate,
        reading: ReadingOptions {
            columns,
            with_columns: Vec::new(),
            trial: None,
            from: None,
            until: None,
            ship: ShipOptions::default(),
        },
        without,
        with: Vec::new(),
        only: Vec::new(),
        without_effect: Vec::new(),
        effect: Vec::new(),
        effects: None,
        without_hull: false,
        priors,
        rule: Rule::default(),
        style: PageFigureOptions {
            style: FigureOptions { paper: None, dpi: 600.0, style: None },
            figures: PageFigures::None,
        },
    };
    let common = Common { out: Some(out.to_owned()), threads: None, seed: None, quiet: true, format: Format::Text };
    study::commands::trace::run(&request, &common).map_err(|failure| failure.to_string())?;
    Ok(serde_json::from_str(&fs::read_to_string(out.join("trace.json"))?)?)
}

/// What is named, in words.
fn named(document: &Document) -> String {
    let word = |effect: &EffectEntry| {
        let aliases: String = effect.aliases.iter().map(|alias| format!(" or {alias}")).collect();
        format!("{} ({}){aliases} {}", effect.id, effect.form, fixed(effect.probability, 2))
    };
    match document.effects.as_slice() {
        [] => "nothing".to_owned(),
        effects => effects.iter().map(word).collect::<Vec<_>>().join(", "),
    }
}

/// Root mean square of a number of the errors of some records; not a number where one has none.
fn pooled_error(records: &[&BeforeAfter], of: impl Fn(&BeforeAfter) -> Option<f64>) -> f64 {
    let square: f64 = records.iter().map(|record| of(record).unwrap_or(f64::NAN).powi(2)).sum();
    (square / records.len() as f64).sqrt()
}

/// Errors of the held-out records, after over before: whole replays, windows of 20 and of 60 s.
fn ratios(document: &Document) -> [f64; 3] {
    let held_out: Vec<&BeforeAfter> = document.error.validation.iter().chain(&document.error.leave_one_out).collect();
    let ratio = |of: &dyn Fn(&ErrorsEntry) -> Option<f64>| {
        let [before, after] =
            [pooled_error(&held_out, |record| of(&record.before)), pooled_error(&held_out, |record| of(&record.after))];
        after / before
    };
    let window = |length: &'static str| move |errors: &ErrorsEntry| errors.horizon_rmse_deg.get(length).copied()?;
    [ratio(&heading), ratio(&window("20")), ratio(&window("60"))]
}

fn heading(errors: &ErrorsEntry) -> Option<f64> {
    Some(errors.heading_rmse_deg)
}

/// One line of the table.
fn line(label: String, document: &Document) -> Vec<String> {
    let error = &document.error;
    let fitted: Vec<&BeforeAfter> = error.identification.iter().collect();
    let held_out: Vec<&BeforeAfter> = error.validation.iter().chain(&error.leave_one_out).collect();
    let mean = |of: fn(&ErrorsEntry) -> Option<f64>| {
        held_out.iter().map(|record| of(&record.after).unwrap_or(f64::NAN)).sum::<f64>() / held_out.len() as f64
    };
    let before = pooled_error(&fitted, |record| heading(&record.before));
    let after = pooled_error(&fitted, |record| heading(&record.after));
    let [whole, short, long] = ratios(document).map(|ratio| significant(ratio, 2));
    vec![
        label,
        named(document),
        significant(before, 3),
        significant(after, 3),
        significant(after / before, 2),
        whole,
        short,
        long,
        fixed(100.0 * mean(|errors| errors.band_coverage_95), 0),
        significant(mean(|errors| errors.band_width_95_deg), 2),
    ]
}

/// What a trace says of records without a zig-zag: a line each, or why there is none.
fn closed_loop(scratch: &Path) -> Outcome<Table> {
    let mut table = Table::new([
        TableColumn::left("record"),
        TableColumn::left("found"),
        TableColumn::left("verdict"),
        TableColumn::decimal("heading before").unit("deg"),
        TableColumn::decimal("after").unit("deg"),
        TableColumn::left("noise"),
    ]);
    for record in autopilot::ALL {
        let source = folder().join("full_scale_closed_loop").join(record.file);
        let Ok(text) = fs::read_to_string(&source) else {
            table.push([record.name, "not traced: the record is not there", "", "", "", ""].map(String::from));
            continue;
        };
        let path = scratch.join(Path::new(record.file).with_extension("table.csv"));
        fs::write(&path, record.table(&text))?;
        eprintln!("{}", record.name);
        let out = scratch.join(record.name);
        let row = match trace_files([vec![path], Vec::new(), Vec::new()], Vec::new(), None, &out) {
            Err(error) => {
                // Without the name of a file that is gone when this is read.
                let error = error.to_string();
                let reason = error.split_once(".csv: ").map_or(error.as_str(), |(_, reason)| reason);
                let refused = format!("refused: {reason}");
                [record.name.to_owned(), refused, String::new(), String::new(), String::new(), String::new()]
            }
            Ok(document) => {
                let error = &document.error.identification[0];
                [
                    record.name.to_owned(),
                    named(&document),
                    document.verdict.as_str().to_owned(),
                    significant(error.before.heading_rmse_deg, 3),
                    significant(error.after.heading_rmse_deg, 3),
                    document.noise.iter().map(noise).collect::<Vec<_>>().join("; "),
                ]
            }
        };
        table.push(row);
    }
    Ok(table)
}

/// The noise of a record in words.
fn noise(noise: &RecordNoiseEntry) -> String {
    let mut parts = vec![format!("heading {} deg", significant(noise.heading_sd_deg, 2))];
    if let (Some(kind), Some(sd)) = (&noise.heading_wander, noise.heading_wander_sd_deg) {
        let time = noise.heading_correlation_s.map_or_else(String::new, |time| format!(", {} s", significant(time, 2)));
        parts.push(format!("lasting error ({kind}) {} deg{time}", significant(sd, 2)));
    }
    if let Some(sd) = noise.moment_sd_rudder_deg {
        let time = noise.moment_correlation_s.map_or_else(String::new, |time| format!(", {} s", significant(time, 2)));
        parts.push(format!("moment ({}) {} deg{time}", noise.moment, significant(sd, 2)));
    }
    if let (Some(sd), Some(frequency)) = (noise.waves_sd_deg, noise.waves_frequency_rad_s) {
        parts.push(format!("waves {} deg at {} rad/s", significant(sd, 2), significant(frequency, 2)));
    }
    parts.join(", ")
}

/// Keeps report and PNG figures of one case.
fn keep(from: &Path, to: &Path) -> Outcome<()> {
    fs::create_dir_all(to)?;
    for entry in fs::read_dir(from)? {
        let path = entry?.path();
        let name = path.file_name().and_then(|name| name.to_str()).ok_or("a file has a name")?;
        match path.extension().and_then(|kind| kind.to_str()) {
            Some("md") => fs::write(to.join(name), of_the_fitted(&fs::read_to_string(&path)?))?,
            Some("png") if !is_left_out(name) => drop(fs::copy(&path, to.join(name))?),
            _ => {}
        }
    }
    Ok(())
}

/// Whether a figure is made by the command and not kept: those of held-out records, and phase planes.
fn is_left_out(name: &str) -> bool {
    name.starts_with("record-") || name.starts_with("phase")
}

/// A page without the figures that are left out, each a line with its caption below.
fn of_the_fitted(page: &str) -> String {
    let mut kept: Vec<&str> = Vec::new();
    let mut was_left_out = false;
    for block in page.split("\n\n") {
        let is_caption = was_left_out && block.starts_with('*');
        let figure = block.strip_prefix("![").and_then(|rest| rest.rsplit_once("]("));
        was_left_out = figure.is_some_and(|(_, name)| is_left_out(name));
        if !was_left_out && !is_caption {
            kept.push(block);
        }
    }
    kept.join("\n\n")
}
