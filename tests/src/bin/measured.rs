//! Traces the measured records and writes what came out.
//! The records are not part of the project; the page goes into `results/published/measured`.
//!
//! Run with the folder of the results as only argument; the records are looked for as [`kempf_tests::measured`] says.

use std::fmt::Write as _;
use std::fs;
use std::path::Path;
use std::process::ExitCode;

use document::trace::RecordNoiseEntry;
use document::trace::TraceDocument;
use kempf_tests::autopilot;
use kempf_tests::measured::analysis::{
    MeasuredAnalysis, ReplayError, SetSummary, WHOLE, WINDOWS_20_S, WINDOWS_60_S, named,
};
use kempf_tests::measured::sets::{MeasuredSet, Outcome, SETS};
use kempf_tests::measured::tracing::{MeasuredTrace, trace_files};
use kempf_tests::measured::{charts, folder, into_results};
use kempf_tests::stability;
use report::number::{fixed, significant};
use report::{Table, TableHead, Theme};
use study::options::PageFigures;
use trace::Document;

/// Cases whose whole report is kept: record, and whether the wind is withheld.
const KEPT: [(&str, bool); 2] = [("zigzag_20_10_s", false), ("zigzag_20", false)];

fn main() -> ExitCode {
    into_results("results/published/measured", run)
}

fn run(results: &Path) -> Outcome<()> {
    let scratch = tempfile::tempdir()?;
    let (mut page, mut parts) = (String::from(INTRODUCTION), String::new());
    let (mut analyses, mut summaries) = (Vec::new(), Vec::new());
    for set in &SETS {
        let _ = writeln!(parts, "## {}\n", set.name);
        if !set.is_there() {
            eprintln!("skipped: no measured records {}", set.folder);
            parts += "Not traced: the records are not there.\n\n";
            continue;
        }
        let own = analysed(set, scratch.path(), results)?;
        let mut table = errors_table();
        own.iter().for_each(|one| table.push(line(one)));
        let with_prior: Vec<&MeasuredAnalysis> = own.iter().filter(|one| one.label.contains(PRIOR)).collect();
        if !with_prior.is_empty() {
            table.push(geometric_means(&with_prior));
        }
        let _ = writeln!(parts, "{}", table.to_markdown());
        let alone: Vec<(&str, &Document)> =
            own.iter().filter(|one| one.is_single).map(|one| (one.label.as_str(), &one.document.trace)).collect();
        if alone.len() > 1 {
            let _ = writeln!(parts, "{STABILITY}\n\n{}", stability::table(&alone).to_markdown());
        }
        summaries.extend(SetSummary::of(set, &own));
        let is_shown = |one: &MeasuredAnalysis| ![WITHHELD, PRIOR].iter().any(|part| one.label.contains(part));
        analyses.extend(own.into_iter().filter(is_shown));
    }
    let table = sets_table(&summaries);
    fs::create_dir_all(results)?;
    fs::write(results.join("sets.csv"), table.to_csv())?;
    let tanker: Vec<&MeasuredSet> =
        SETS.iter().filter(|set| set.name.starts_with("KVLCC2") && set.is_there()).collect();
    let figures = [charts::before_after(&analyses), charts::amplitude(&tanker, scratch.path())?];
    let _ = writeln!(page, "{}\n{SETS_TOGETHER}\n", table.to_markdown());
    for (number, figure) in (1..).zip(&figures) {
        fs::write(results.join(format!("{}.png", figure.stem)), figure.plot.draw(&Theme::screen()).png()?)?;
        let _ = writeln!(page, "![Figure {number}]({}.png)\n\n*Figure {number}. {}*\n", figure.stem, figure.caption);
    }
    page += &parts;
    let _ = writeln!(page, "{CLOSED_LOOP}\n\n{}", closed_loop(scratch.path())?.to_markdown());
    page += KEPT_REPORTS;
    for (record, without_wind) in KEPT {
        let set = SETS.iter().find(|set| set.records.contains(&record)).ok_or("a kept record belongs to a set")?;
        let wind = if without_wind { "-without-wind" } else { "" };
        let _ = writeln!(page, "- [{}: {record}{wind}]({}-{record}{wind}/report.md)", set.name, set.folder);
    }
    fs::write(results.join("README.md"), page)?;
    Ok(())
}

/// What the label of an analysis without the wind ends with.
const WITHHELD: &str = ", wind withheld";

/// Every analysis of a set: records alone, with and without wind, then records together.
fn analysed(set: &'static MeasuredSet, scratch: &Path, results: &Path) -> Outcome<Vec<MeasuredAnalysis>> {
    let withheld: &[bool] = if set.wind { &[false, true] } else { &[false] };
    let mut analyses = Vec::new();
    for &record in set.records {
        for &without_wind in withheld {
            let name = if without_wind { format!("{record}-without-wind") } else { record.to_owned() };
            let out = scratch.join(&name);
            let is_kept = KEPT.contains(&(record, without_wind));
            let figures = if is_kept { PageFigures::All } else { PageFigures::None };
            let held_out = set.beside(record);
            let run =
                MeasuredTrace { set, records: &[record], held_out: &held_out, without_wind, priors: &[], figures };
            let document = run.run(&out)?;
            if is_kept {
                keep(&out, &results.join(format!("{}-{name}", set.folder)))?;
            }
            let label = if without_wind { format!("{record}{WITHHELD}") } else { record.to_owned() };
            analyses.push(MeasuredAnalysis { set, label, is_single: !without_wind, document });
        }
    }
    for (number, pool) in set.pools.iter().enumerate() {
        let out = scratch.join(format!("{}-pool-{number}", set.folder));
        let others = set.others(pool);
        let mut add = |held_out: &[&str], more: &str| -> Outcome<()> {
            let figures = PageFigures::None;
            let run = MeasuredTrace { set, records: pool, held_out, without_wind: false, priors: &[], figures };
            let label = format!("together: {}{more}", pool.join(", "));
            analyses.push(MeasuredAnalysis { set, label, is_single: false, document: run.run(&out)? });
            Ok(())
        };
        add(&others, if others.is_empty() { ", each left out in turn" } else { "" })?;
        if !set.circles.is_empty() {
            add(set.circles, "; turning circles held out")?;
        }
    }
    analyses.extend(with_prior(set, scratch)?);
    Ok(analyses)
}

/// What the label of an analysis with a prior holds.
const PRIOR: &str = ", prior from ";

/// The records alone, with a prior from trials of the same hull elsewhere.
fn with_prior(set: &'static MeasuredSet, scratch: &Path) -> Outcome<Vec<MeasuredAnalysis>> {
    let Some((folder, records)) = set.prior else { return Ok(Vec::new()) };
    let source = SETS.iter().find(|set| set.folder == folder).ok_or("a prior is of a set")?;
    let out = scratch.join(format!("{folder}-prior"));
    let alone = MeasuredTrace {
        set: source,
        records,
        held_out: &[],
        without_wind: false,
        priors: &[],
        figures: PageFigures::None,
    };
    alone.run(&out)?;
    let priors = [out.join("trace.json")];
    let of = |&record: &&'static str| {
        let held_out = set.beside(record);
        let run = MeasuredTrace { set, records: &[record], held_out: &held_out, priors: &priors, ..alone };
        let document = run.run(&scratch.join(format!("{record}-with-prior")))?;
        let label = format!("{record}{PRIOR}{folder}: {}", records.join(", "));
        Ok(MeasuredAnalysis { set, label, is_single: false, document })
    };
    set.records.iter().map(of).collect()
}

/// A line for every set.
fn sets_table(summaries: &[SetSummary]) -> Table {
    let head = TableHead::default().texts(["set"]).counts(["records"]).numbers(["heading before", "after"]).unit("deg");
    let head = head.numbers(["held out ratio", "held out ratio, windows of 60 s"]).texts(["named"]);
    let mut table = Table::new(head);
    for own in summaries {
        table.push([
            own.name.to_owned(),
            own.records.to_string(),
            significant(own.errors[0], 3),
            significant(own.errors[1], 3),
            significant(own.held_out[0], 2),
            significant(own.held_out[1], 2),
            own.words(),
        ]);
    }
    table
}

const SETS_TOGETHER: &str =
    "Every record of a set traced alone; medians over the records. *held out ratio*: error on all other records
of the set, after over before. *named*: effects that are named in at least a third of the records, and in how many.";

const INTRODUCTION: &str = "# Measured records, traced

What a first-order response lacks on measured records, found from one record and judged on others that were not fitted. The records
are not part of the project; where they come from says [the book](../../../docs/src/howto/public-trials.md). Made by

```text
cargo run --release -p kempf-tests --bin measured -- results/published/measured
```

A line is one analysis: `study trace` of one record, or of some together, with all others of its set held out; where all are fitted
together, each is left out in turn, and where there is one zig-zag, a turning circle is held out. *heading*: error of the recorded
rudder replayed over the whole record, before (the best first-order base) and after (the average of structures and hulls). *windows*: the same
restarted every 20 and 60 s. On held-out records only initial states are fitted, and measured speed and sway are known; errors of several records are root mean squares
over them, as the ratio after over before. *prior*: the hull is fitted about what `study trace` of the records named left, with
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
    let head = TableHead::default().texts(["fitted record", "found"]).numbers(["heading before", "after"]).unit("deg");
    let ratios = ["ratio", "held out: heading ratio", "held out: windows of 20 s", "held out: windows of 60 s"];
    let head = head.numbers(ratios).numbers(["held out: inside the band"]).unit("%");
    Table::new(head.numbers(["held out: width of the band"]).unit("deg"))
}

/// One line of the table.
fn line(own: &MeasuredAnalysis) -> Vec<String> {
    let ratio = |of: ReplayError| {
        let [before, after] = own.held_out(of);
        significant(after / before, 2)
    };
    let [before, after] = own.fitted(WHOLE);
    vec![
        own.label.clone(),
        own.named(),
        significant(before, 3),
        significant(after, 3),
        significant(after / before, 2),
        ratio(WHOLE),
        ratio(WINDOWS_20_S),
        ratio(WINDOWS_60_S),
        fixed(100.0 * own.mean_held_out(|errors| errors.band_coverage_95), 0),
        significant(own.mean_held_out(|errors| errors.band_width_95_deg), 2),
    ]
}

/// Geometric means of the ratios on held-out records.
fn geometric_means(of: &[&MeasuredAnalysis]) -> Vec<String> {
    let ratio = |error: ReplayError| {
        let logarithm = |one: &&MeasuredAnalysis| {
            let [before, after] = one.held_out(error);
            (after / before).ln()
        };
        significant((of.iter().map(logarithm).sum::<f64>() / of.len() as f64).exp(), 2)
    };
    let mut row = vec![format!("geometric mean of the {} with a prior", of.len())];
    row.extend([""; 4].map(String::from));
    row.extend([WHOLE, WINDOWS_20_S, WINDOWS_60_S].map(ratio));
    row.extend([""; 2].map(String::from));
    row
}

/// What a trace says of records without a zig-zag: a line each, or why there is none.
fn closed_loop(scratch: &Path) -> Outcome<Table> {
    let head = TableHead::default().texts(["record", "found", "verdict"]).numbers(["heading before", "after"]);
    let mut table = Table::new(head.unit("deg").texts(["noise"]));
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
        let row = match trace_files([vec![path], Vec::new(), Vec::new()], Vec::new(), None, PageFigures::None, &out) {
            Err(error) => {
                // Without the name of a file that is gone when this is read.
                let error = error.to_string();
                let reason = error.split_once(".csv: ").map_or(error.as_str(), |(_, reason)| reason);
                let refused = format!("refused: {reason}");
                [record.name.to_owned(), refused, String::new(), String::new(), String::new(), String::new()]
            }
            Ok(TraceDocument { trace: document, .. }) => {
                let error = &document.error.identification[0];
                [
                    record.name.to_owned(),
                    named(&document),
                    document.verdict.to_string(),
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
