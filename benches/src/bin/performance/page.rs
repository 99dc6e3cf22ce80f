//! The report as Markdown, and everything in it as CSV.

use std::fmt::Write as _;
use std::path::Path;

use kempf_benches::measure::Measured;
use kempf_benches::process::Outcome;
use kempf_benches::verdict::{self, Line, Verdict, measured_time, plus_minus, table, time};
use kempf_benches::work::{Cores, Reach};
use kempf_benches::works::{CHECK_S, SHARE};
use report::html::{self, Images};
use report::number::{MISSING, fixed, significant};
use report::{Column, Table};

use crate::Measurements;
use crate::growth::Growth;
use crate::machine::Machine;
use crate::trials::{Study, Trials};

/// Peak memory that a study may take.
const MEMORY_MB: f64 = 150.0;
/// Peak memory counts as flat when it grows by less than this between the studies of [`FLAT_FROM`] trials and more.
const FLAT: f64 = 1.1;
const FLAT_FROM: u64 = 10_000;

/// Something that was to be reached, and whether it was.
struct Goal {
    what: String,
    found: String,
    limit: String,
    verdict: Verdict,
}

/// Writes `report.md`, `report.html`, `performance.csv`, `growth.csv`, `trials.csv` and `machine.toml`.
pub fn write(
    folder: &Path,
    machine: &Machine,
    measured: &[Measurements],
    samples: &[Growth],
    trials: &Trials,
) -> Outcome<()> {
    let put = |name: &str, text: String| {
        std::fs::write(folder.join(name), text).map_err(|error| format!("failed to write {name}: {error}"))
    };
    put("machine.toml", toml::to_string(machine)?)?;
    put("performance.csv", rows(measured).to_csv())?;
    put("growth.csv", growth_rows(samples.iter().chain(&trials.growth).chain([&trials.of_samples])).to_csv())?;
    put("trials.csv", trial_rows(&trials.studies, trials.methods).to_csv())?;
    let text = report(machine, measured, samples, trials)?;
    print!("{text}");
    // The figures are in the folder by now.
    put("report.html", html::page(&text, &|stem| Images::written(folder, stem))?)?;
    put("report.md", text)?;
    Ok(())
}

fn report(machine: &Machine, measured: &[Measurements], samples: &[Growth], trials: &Trials) -> Outcome<String> {
    let mut page = String::from("# What the work costs\n\n");
    if machine.quick || !machine.release {
        page += "**Made to see that the program works: sizes are small or the build is not optimised. These are no results.**\n\n";
    }
    writeln!(page, "Made by `{}` on\n", machine.command)?;
    writeln!(page, "* {}, {} threads, {}", machine.processor, machine.cores, machine.target)?;
    writeln!(page, "* {}, {}", machine.rustc, machine.rival)?;
    let revision = machine.git_revision.as_deref().unwrap_or("unknown");
    let changed = if machine.changed_since == Some(true) { ", with changes" } else { "" };
    writeln!(page, "* version {} at revision {revision}{changed}\n", machine.version)?;
    page += "Times are medians of samples that were taken in turn, work and what stands beside it after each other in every round; \
             ± is half of a 95 % interval between order statistics. A ratio is the median of the ratios of all rounds, so that \
             what slows the whole machine for a while cancels.\n\n";

    let goals = goals(measured, trials);
    page += "## What was to be reached\n\n";
    let missed = goals.iter().filter(|goal| !goal.verdict.is_met()).count();
    writeln!(page, "{} of {} limits are met.\n", goals.len() - missed, goals.len())?;
    page += &goal_table(&goals).to_markdown();

    for one in measured {
        writeln!(page, "\n## {}\n\n{}\n", heading(one.group.name), one.group.about)?;
        page += &table(&one.lines).to_markdown();
        if one.group.name == "identify" {
            page += "\n![time of one identification by method](identification.png)\n";
        }
    }

    writeln!(page, "\n## Growth with the samples of a record\n")?;
    page += "Records of a 10/10 zig-zag, half a second between samples, longer and longer. The exponent p of t ∝ n^p is fitted by least \
             squares of log t on log n to the sizes of the upper two decades.\n\n";
    page += &exponents(samples).to_markdown();
    page += "\n![time over samples](growth-samples.png)\n";
    for growth in samples {
        if let Some((size, expected)) = growth.cut {
            writeln!(
                page,
                "\n{} is cut before {size} samples, which would take about {}.",
                growth.name,
                time(expected)
            )?;
        }
        let listed = |sizes: &[usize]| sizes.iter().map(ToString::to_string).collect::<Vec<_>>().join(", ");
        if !growth.refused.is_empty() {
            writeln!(page, "\n{} gives no answer from {} samples.", growth.name, listed(&growth.refused))?;
        }
        if !growth.wrong.is_empty() {
            writeln!(
                page,
                "\n{} is off by more than half in K or T from {} samples; what it takes there says little.",
                growth.name,
                listed(&growth.wrong)
            )?;
        }
    }

    writeln!(page, "\n## Studies\n")?;
    writeln!(
        page,
        "`benches/throughput.toml`: 271 samples, {} methods. A study of {} trials by threads, rows stored; the share is the rate \
         over threads times the rate of one thread.\n",
        trials.methods, trials.scaling_trials
    )?;
    page += &scaling_table(trials).to_markdown();
    writeln!(page, "\nOn {} threads, one study after the other:\n", machine.cores)?;
    page += &trial_rows(&trials.studies, trials.methods).to_markdown();
    page += "\n";
    page += &exponents(&trials.growth).to_markdown();
    page += "\n![time over trials](growth-trials.png)\n";

    writeln!(page, "\n## What a study will cost\n")?;
    if let Some(line) = trials.of_samples.line() {
        let signed = |seconds: f64| if seconds < 0.0 { format!("−{}", time(-seconds)) } else { time(seconds) };
        writeln!(
            page,
            "One trial with all methods and what is computed beside them takes a·samples + b on one thread, a = {} and b = {} (fitted to \
             {} to {} samples a second apart, at most {} % off); in a study of {} trials on one thread, with storing, a trial of \
             271 samples took {}.\n",
            signed(line.per_sample),
            signed(line.fixed),
            fixed(line.range[0], 0),
            fixed(line.range[1], 0),
            significant(100.0 * line.worst, 2),
            trials.scaling_trials,
            trials.scaling.first().map_or(MISSING.to_owned(), |one| time(1.0 / one.rate.value)),
        )?;
    }
    if let Some(last) = trials.studies.last() {
        let rows = (last.trials * trials.methods) as f64;
        writeln!(
            page,
            "The largest study stored {} bytes per row (a row is one trial and one method); joining its parts, reading rows back, tables \
             and figures took {} per row more than the trials.",
            significant(last.bytes as f64 / rows, 3),
            time((last.whole - last.work).max(0.0) / rows),
        )?;
    }
    Ok(page)
}

fn heading(group: &str) -> String {
    match group {
        "simulate" => "Simulation".to_owned(),
        "identify" => "Identification".to_owned(),
        "trace" => "Tracing".to_owned(),
        "study" => "Trials, scenarios and figures".to_owned(),
        other => other.to_owned(),
    }
}

fn goals(measured: &[Measurements], trials: &Trials) -> Vec<Goal> {
    // A few hundred trials in memory say less about threads than whole studies do.
    let lines = measured.iter().flat_map(|one| &one.lines);
    let lines = lines.filter(|line| !matches!(line.row.reach, Some(Reach::Scaling(_))));
    let mut goals: Vec<Goal> = lines.filter_map(goal).collect();
    if let Some(all) = trials.scaling.last().filter(|all| all.threads > 1) {
        for (what, share) in [("trials", &all.share), ("whole command", &all.whole_share)] {
            goals.push(Goal {
                what: format!("{} trials, {} threads, {what}", trials.scaling_trials, all.threads),
                found: format!("{} of the threads", plus_minus(share)),
                limit: format!("≥ {SHARE}"),
                verdict: Verdict::at_least(share, SHARE),
            });
        }
    }
    let peaks: Vec<(u64, f64)> =
        trials.studies.iter().filter_map(|study| Some((study.trials, study.memory?))).collect();
    if let Some(most) = peaks.iter().map(|peak| peak.1).max_by(f64::total_cmp) {
        goals.push(Goal {
            what: "peak memory of a study".to_owned(),
            found: format!("{} MB", fixed(most, 0)),
            limit: format!("< {MEMORY_MB} MB"),
            verdict: exactly(most, MEMORY_MB),
        });
    }
    let flat: Vec<f64> = peaks.iter().filter(|peak| peak.0 >= FLAT_FROM).map(|peak| peak.1).collect();
    if let [first, .., last] = flat[..] {
        goals.push(Goal {
            what: format!("peak memory of {} trials over that of {FLAT_FROM}", peaks.last().map_or(0, |peak| peak.0)),
            found: significant(last / first, 3),
            limit: format!("≤ {FLAT}"),
            verdict: exactly(last / first, FLAT),
        });
    }
    goals.push(Goal {
        what: format!("study check on {} scenarios, with the start of the program", trials.scenarios),
        found: measured_time(&trials.check),
        limit: format!("< {}", time(CHECK_S)),
        verdict: Verdict::at_most(&trials.check, CHECK_S),
    });
    goals
}

fn exactly(value: f64, limit: f64) -> Verdict {
    if value <= limit { Verdict::Met } else { Verdict::Missed }
}

fn goal(line: &Line) -> Option<Goal> {
    let found = match (line.row.reach?, &line.ratio, &line.row.beside) {
        (Reach::Time(_), ..) => match line.time.least {
            Some(least) => format!("{}, least {}", measured_time(&line.time), time(least)),
            None => measured_time(&line.time),
        },
        (_, Some(ratio), Some(beside)) => format!("{} of {}", plus_minus(ratio), beside.name),
        _ => return None,
    };
    Some(Goal { what: line.row.work.name.clone(), found, limit: line.limit(), verdict: line.verdict()? })
}

fn goal_table(goals: &[Goal]) -> Table {
    let mut table = Table::new(["work", "found", "to reach", "verdict"].map(Column::left));
    for goal in goals {
        table.push([goal.what.as_str(), &goal.found, &goal.limit, goal.verdict.as_str()]);
    }
    table
}

fn exponents(growths: &[Growth]) -> Table {
    let mut table = Table::new([
        Column::left("work"),
        Column::right("smallest"),
        Column::left("its time"),
        Column::right("largest"),
        Column::left("its time"),
        Column::left("exponent p"),
        Column::left("fitted from"),
    ]);
    for growth in growths {
        let (Some(first), Some(last)) = (growth.points.first(), growth.points.last()) else { continue };
        let exponent = growth.exponent();
        table.push([
            growth.name.clone(),
            fixed(first.0, 0),
            measured_time(&first.1),
            fixed(last.0, 0),
            measured_time(&last.1),
            exponent.map_or(MISSING.to_owned(), |found| {
                let error = found.standard_error.max(1e-4);
                report::number::with_uncertainty(found.value, Some(error))
            }),
            exponent.map_or(MISSING.to_owned(), |found| format!("{} up", fixed(found.range[0], 0))),
        ]);
    }
    table
}

fn scaling_table(trials: &Trials) -> Table {
    let mut table = Table::new([
        Column::right("threads"),
        Column::left("trials per second"),
        Column::left("share, trials"),
        Column::left("share, whole command"),
    ]);
    for scaling in &trials.scaling {
        table.push([
            scaling.threads.to_string(),
            plus_minus(&scaling.rate),
            plus_minus(&scaling.share),
            plus_minus(&scaling.whole_share),
        ]);
    }
    table
}

fn trial_rows(studies: &[Study], methods: u64) -> Table {
    let mut table = Table::new([
        Column::right("trials"),
        Column::right("threads"),
        Column::decimal("trials and storing").unit("s"),
        Column::decimal("whole command").unit("s"),
        Column::decimal("peak memory").unit("MB"),
        Column::decimal("bytes per row"),
    ]);
    for study in studies {
        table.push([
            study.trials.to_string(),
            study.threads.to_string(),
            fixed(study.work, 3),
            fixed(study.whole, 3),
            study.memory.map_or(MISSING.to_owned(), |memory| fixed(memory, 1)),
            fixed(study.bytes as f64 / (study.trials * methods) as f64, 1),
        ]);
    }
    table
}

fn growth_rows<'a>(growths: impl Iterator<Item = &'a Growth>) -> Table {
    let mut table = Table::new(["work", "size", "time_s", "lower_s", "upper_s", "samples"].map(Column::left));
    for growth in growths {
        for (size, time) in &growth.points {
            let [lower, upper] = time.interval;
            table.push([
                growth.name.clone(),
                fixed(*size, 0),
                number(time.value),
                number(lower),
                number(upper),
                time.samples.to_string(),
            ]);
        }
    }
    table
}

fn rows(measured: &[Measurements]) -> Table {
    const HEADS: [&str; 16] = [
        "group",
        "work",
        "threads",
        "units",
        "time_s",
        "lower_s",
        "upper_s",
        "least_s",
        "samples",
        "beside",
        "beside_s",
        "ratio",
        "ratio_lower",
        "ratio_upper",
        "reach",
        "verdict",
    ];
    let mut table = Table::new(HEADS.map(Column::left));
    for (group, line) in measured.iter().flat_map(|one| one.lines.iter().map(|line| (one.group.name, line))) {
        let work = &line.row.work;
        let of = |measured: Option<&Measured>, value: fn(&Measured) -> f64| {
            measured.map_or(MISSING.to_owned(), |measured| number(value(measured)))
        };
        let threads = match work.cores {
            Cores::One => 1.0,
            Cores::All => verdict::cores(),
        };
        table.push([
            group.to_owned(),
            work.name.clone(),
            fixed(threads, 0),
            fixed(work.units, 0),
            number(line.time.value),
            number(line.time.interval[0]),
            number(line.time.interval[1]),
            line.time.least.map_or(MISSING.to_owned(), number),
            line.time.samples.to_string(),
            line.row.beside.as_ref().map_or(MISSING.to_owned(), |beside| beside.name.clone()),
            of(line.beside.as_ref(), |beside| beside.value),
            of(line.ratio.as_ref(), |ratio| ratio.value),
            of(line.ratio.as_ref(), |ratio| ratio.interval[0]),
            of(line.ratio.as_ref(), |ratio| ratio.interval[1]),
            line.limit(),
            line.verdict().map_or(MISSING, Verdict::as_str).to_owned(),
        ]);
    }
    table
}

/// For machines: seven digits, in a form that every reader understands.
fn number(value: f64) -> String {
    format!("{value:.6e}")
}
