//! `ratios [FOLDER]` makes tables of ratios from what `cargo bench -p kempf-benches` has stored: it prints them, and
//! writes them into a folder as `report.md` and, for machines, as `performance.csv`.

use std::error::Error;
use std::fs;
use std::path::{Path, PathBuf};

use kempf_benches::work::{Cores, Reach, TimedWork, WorkGroup};
use kempf_benches::works;
use report::figures::{Division, NamedRows, Plot, Reference95, RowItem, RowKind, RowsColumn, Ruler};
use report::number::{self, MISSING, significant};
use report::{CurveOrigin, Table, TableHead, Theme};
use serde::Deserialize;

/// Head of the report.
const HEAD: &str = "# What the work costs\n\n\
    Made by `cargo bench -p kempf-benches && cargo run --release -p kempf-benches --bin ratios -- results/published/performance`.\n\n\
    Times are those of criterion; ± is half of a 95 % interval, and that of a ratio is the worst case of both intervals.\n";

fn main() -> Result<(), Box<dyn Error>> {
    let criterion = std::env::var_os("CRITERION_HOME").map_or_else(in_target, PathBuf::from);
    let mut figure = None;
    let mut numbers = Table::new(TableHead::default().texts(NUMBERS));
    let mut report = format!("{HEAD}\nProcessor: {}, {} threads.\n", processor(), cores());
    // The group of outside estimators is only named here, so its program need not be there.
    for group in works::all().into_iter().chain([works::outside("echo")]) {
        let rows = compared(&group, &criterion);
        if rows.is_empty() {
            eprintln!("nothing of `{}` was measured; run `cargo bench -p kempf-benches -- {}`", group.name, group.name);
            continue;
        }
        report += &format!("\n## {}\n\n{}\n\n{}", group.title, group.about, table(&rows).to_markdown());
        rows.iter().for_each(|row| numbers.push(row.numbers(group.name)));
        if let Some(own) = (group.name == FIGURE.0).then(|| identification(&rows)) {
            report += &format!("\n![Figure 1]({}.png)\n\n*Figure 1. {CAPTION}*\n", FIGURE.1);
            figure = Some(Plot::from(own));
        }
    }
    print!("{report}");
    if let Some(folder) = std::env::args_os().nth(1).map(PathBuf::from) {
        fs::create_dir_all(&folder)?;
        fs::write(folder.join("report.md"), report)?;
        fs::write(folder.join("performance.csv"), numbers.to_csv())?;
        if let Some(figure) = figure {
            fs::write(folder.join(format!("{}.png", FIGURE.1)), figure.draw(&Theme::screen()).png()?)?;
        }
    }
    Ok(())
}

/// The group that has a figure, and the stem of that.
const FIGURE: (&str, &str) = ("identify", "identification");

const CAPTION: &str = "Time of one identification on one core over that of SRIVC of dsmc from the same heading, with 95 % intervals. \
    Left of the line a method is faster.";

/// Times of our methods over that of the rival, the shortest first.
fn identification(rows: &[ComparedWork]) -> NamedRows {
    // Methods with their usual settings, beside the rival.
    let is_method = |row: &&ComparedWork| !row.row.work.name.contains(", ") && !row.row.work.name.starts_with("dsmc");
    let mut rows: Vec<(&ComparedWork, CriterionTime)> =
        rows.iter().filter(is_method).filter_map(|row| Some((row, row.ratio()?))).collect();
    rows.sort_by(|(_, one), (_, other)| one.value.total_cmp(&other.value));
    let mark = |(row, ratio): &(&ComparedWork, CriterionTime)| {
        let look = CurveOrigin::Method(row.row.work.name.clone()).look();
        vec![RowItem::new("", RowKind::Mark(look, ratio.value, Some(ratio.interval)))]
    };
    let name = |(row, _): &(&ComparedWork, CriterionTime)| {
        let time = in_unit(row.time.value, |size| significant(row.time.value / size, 2));
        format!("{}, {time}", row.row.work.name)
    };
    let faster = rows.iter().filter(|(_, ratio)| ratio.interval[1] < 1.0).count();
    let column = RowsColumn {
        x: Ruler::new("time over that of SRIVC of dsmc", Division::Factors),
        rows: rows.iter().map(mark).collect(),
        reference: Some(Reference95::line(1.0)),
        ..RowsColumn::default()
    };
    NamedRows {
        title: Some(format!("{faster} of {} methods fit faster than the rival, SRIVC of the library dsmc", rows.len())),
        names: rows.iter().map(name).collect(),
        columns: vec![column],
        note: Some(String::from(
            "Left of the line a method is faster. Times on one core; bars: 95 % intervals; none seen: within the mark.",
        )),
        ..NamedRows::default()
    }
}

/// The model of the processor, as Linux tells it.
fn processor() -> String {
    let told = fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let model = told.lines().find_map(|line| line.strip_prefix("model name")?.split_once(": "));
    model.map_or_else(|| String::from(std::env::consts::ARCH), |(_, model)| model.to_owned())
}

/// Where criterion keeps its estimates: `criterion` in the target folder that this program is in.
fn in_target() -> PathBuf {
    let program = std::env::current_exe().ok();
    // …/target/release/ratios
    let target = program.as_deref().and_then(|path| path.ancestors().nth(2));
    target.unwrap_or_else(|| Path::new("target")).join("criterion")
}

/// A quantity with a 95 % interval.
#[derive(Debug, Clone, Copy, PartialEq)]
struct CriterionTime {
    value: f64,
    interval: [f64; 2],
}

impl CriterionTime {
    fn times(self, factor: f64) -> Self {
        Self { value: self.value * factor, interval: self.interval.map(|end| end * factor) }
    }

    /// This over another quantity that was measured apart from it; the interval is that of the worst case.
    fn over(self, other: &Self) -> Self {
        let interval = [self.interval[0] / other.interval[1], self.interval[1] / other.interval[0]];
        Self { value: self.value / other.value, interval }
    }

    /// Whether a limit is kept, in words; the interval may leave that open.
    fn verdict(&self, is_kept: impl Fn(f64) -> bool) -> &'static str {
        let is_open = is_kept(self.interval[0]) != is_kept(self.interval[1]);
        match (is_kept(self.value), is_open) {
            (true, false) => "met",
            (true, true) => "met, within noise",
            (false, true) => "missed, within noise",
            (false, false) => "missed",
        }
    }

    /// The value and half of its interval; alone where there is no interval.
    fn words(&self) -> String {
        match 0.5 * (self.interval[1] - self.interval[0]) {
            half if half > 0.0 => number::with_uncertainty(self.value, Some(half)),
            _ => significant(self.value, 3),
        }
    }
}

/// Threads that work on all cores takes.
fn cores() -> f64 {
    rayon::current_num_threads() as f64
}

/// What criterion has stored, ns per go.
#[derive(Deserialize)]
struct CriterionEstimates {
    mean: CriterionEstimate,
    /// Of time over goes; none where all samples have as many goes.
    slope: Option<CriterionEstimate>,
}

#[derive(Deserialize)]
struct CriterionEstimate {
    confidence_interval: CriterionInterval,
    point_estimate: f64,
}

#[derive(Deserialize)]
struct CriterionInterval {
    lower_bound: f64,
    upper_bound: f64,
}

/// What criterion found, s per go. `None` where nothing was measured.
fn estimate(path: &Path) -> Option<CriterionTime> {
    let CriterionEstimates { mean, slope } = serde_json::from_str(&fs::read_to_string(path).ok()?).ok()?;
    let CriterionEstimate { confidence_interval, point_estimate } = slope.unwrap_or(mean);
    let interval = [confidence_interval.lower_bound, confidence_interval.upper_bound];
    Some(CriterionTime { value: point_estimate, interval }.times(1e-9))
}

/// Work that was timed, beside other work of its group where it is held against some.
struct ComparedWork<'a> {
    row: &'a TimedWork,
    time: CriterionTime,
    beside: Option<CriterionTime>,
}

/// What was measured of a group.
fn compared<'a>(group: &'a WorkGroup, criterion: &Path) -> Vec<ComparedWork<'a>> {
    let time = |row: &TimedWork| {
        let found = estimate(&criterion.join(group.name).join(&row.work.name).join("new/estimates.json"))?;
        Some(found.times(1.0 / row.work.units))
    };
    let rows: Vec<(&TimedWork, CriterionTime)> = group.rows.iter().filter_map(|row| Some((row, time(row)?))).collect();
    let of = |(row, time): &(&'a TimedWork, CriterionTime)| {
        let is_beside = |other: &TimedWork| row.beside.as_ref() == Some(&other.work.name);
        let beside = rows.iter().find(|(other, _)| is_beside(other)).map(|(_, time)| *time);
        ComparedWork { row, time: *time, beside }
    };
    rows.iter().map(of).collect()
}

/// The table of a group.
fn table(rows: &[ComparedWork]) -> Table {
    let head = TableHead::default().texts(["work", "time", "beside it", "its time"]).numbers(["ratio"]);
    let mut table = Table::new(head.texts(["reach", "verdict"]));
    rows.iter().for_each(|row| table.push(row.cells()));
    table
}

/// Columns of the table for machines: times in seconds per unit of work, with the ends of their intervals.
const NUMBERS: [&str; 11] = [
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

impl ComparedWork<'_> {
    /// What is held against a ratio to be reached: time over time beside, or the share of all cores that is used.
    fn ratio(&self) -> Option<CriterionTime> {
        let beside = self.beside?;
        Some(match self.row.reach {
            Some(Reach::Scaling(_)) => beside.over(&self.time).times(1.0 / cores()),
            _ => self.time.over(&beside),
        })
    }

    /// What is to be reached, and whether it is.
    fn reached(&self) -> (String, &'static str) {
        let of_ratio = |is_kept: &dyn Fn(f64) -> bool| self.ratio().map_or("", |ratio| ratio.verdict(is_kept));
        match self.row.reach {
            None => (MISSING.to_owned(), ""),
            Some(Reach::Ratio(limit)) => (format!("≤ {}", significant(limit, 2)), of_ratio(&|ratio| ratio <= limit)),
            Some(Reach::Time(limit)) => {
                let words = in_unit(limit, |size| significant(limit / size, 3));
                (format!("< {words}"), self.time.verdict(|time| time <= limit))
            }
            Some(Reach::Scaling(limit)) => {
                (format!("≥ {} of the cores", significant(limit, 2)), of_ratio(&|share| share >= limit))
            }
        }
    }

    /// The line for a person.
    fn cells(&self) -> [String; 7] {
        let Self { row, time, beside } = self;
        let unit = if row.work.units > 1.0 { " per unit" } else { "" };
        let threads = if row.work.cores == Cores::All { format!(" ({} threads)", cores()) } else { String::new() };
        let missing = || MISSING.to_owned();
        let (reach, verdict) = self.reached();
        [
            format!("{}{threads}", row.work.name),
            measured_time(time) + unit,
            row.beside.clone().unwrap_or_else(missing),
            beside.as_ref().map_or_else(missing, measured_time),
            self.ratio().as_ref().map_or_else(missing, CriterionTime::words),
            reach,
            verdict.to_owned(),
        ]
    }

    /// The line for a machine.
    fn numbers(&self, group: &str) -> [String; 11] {
        let of = |time: CriterionTime| [time.value, time.interval[0], time.interval[1]].map(|own| format!("{own:.6e}"));
        let ([time, lower, upper], (reach, verdict)) = (of(self.time), self.reached());
        let [ratio, ratio_lower, ratio_upper] = self.ratio().map(of).unwrap_or_default();
        let (work, beside) = (self.row.work.name.clone(), self.row.beside.clone().unwrap_or_default());
        let verdict = verdict.to_owned();
        [group.to_owned(), work, time, lower, upper, beside, ratio, ratio_lower, ratio_upper, reach, verdict]
    }
}

const UNITS: [(f64, &str); 4] = [(1e-9, "ns"), (1e-6, "µs"), (1e-3, "ms"), (1.0, "s")];

/// A time (s) in the unit that suits it, whose size in s is given to `show`.
fn in_unit(seconds: f64, show: impl Fn(f64) -> String) -> String {
    let (size, name) = UNITS.into_iter().rev().find(|(size, _)| seconds >= *size).unwrap_or(UNITS[0]);
    format!("{} {name}", show(size))
}

fn measured_time(time: &CriterionTime) -> String {
    in_unit(time.value, |size| time.times(1.0 / size).words())
}

#[cfg(test)]
mod tests {
    use super::*;
    use kempf_benches::work::Work;

    const FOUND: &str = r#"{
        "mean": {"confidence_interval": {"confidence_level": 0.95, "lower_bound": 190.0, "upper_bound": 210.0},
                 "point_estimate": 200.0, "standard_error": 5.0},
        "median": {}, "median_abs_dev": {}, "slope": null, "std_dev": {} }"#;

    fn timed(value: f64, half: f64) -> CriterionTime {
        CriterionTime { value, interval: [value - half, value + half] }
    }

    #[test]
    fn what_criterion_stored_is_read() {
        let mut group = WorkGroup::new("group", "Group", "");
        let rival = group.alone(Work::new("rival", || ()), None);
        group.beside(Work::new("own", || ()), &rival, Some(Reach::Ratio(2.0)));
        let folder = tempfile::tempdir().expect("a folder");
        let store = |work: &str, text: &str| {
            let new = folder.path().join("group").join(work).join("new");
            fs::create_dir_all(&new).expect("a folder");
            fs::write(new.join("estimates.json"), text).expect("a file");
        };
        let csv = || table(&compared(&group, folder.path())).to_csv();
        assert!(compared(&group, folder.path()).is_empty());
        store("own", FOUND);
        // Where the rival was not measured there is no ratio.
        assert!(csv().contains("200 ± 10 ns") && !csv().contains("met"), "{}", csv());
        store("rival", &FOUND.replace("00.0", "50.0"));
        assert!(csv().contains("0.8") && csv().contains("met"), "{}", csv());
        let numbers = compared(&group, folder.path())[1].numbers("group");
        assert_eq!(
            numbers[..6],
            ["group", "own", "2.000000e-7", "1.900000e-7", "2.100000e-7", "rival"].map(String::from)
        );
        assert_eq!((numbers[6].as_str(), numbers[10].as_str()), ("8.000000e-1", "met"));
    }

    #[test]
    fn verdicts_say_when_the_noise_decides() {
        let verdict = |value: f64| timed(value, 0.1).verdict(|value| value <= 1.5);
        let words = [1.0, 1.45, 1.55, 2.0].map(verdict);
        assert_eq!(words, ["met", "met, within noise", "missed, within noise", "missed"]);
        // One core is as fast as `share` of all of them makes it.
        let scaling = |share: f64| {
            let row = TimedWork { work: Work::new("", || ()), beside: None, reach: Some(Reach::Scaling(0.92)) };
            let beside = Some(timed(share * cores(), 0.001));
            ComparedWork { row: &row, time: timed(1.0, 0.001), beside }.cells()[6].clone()
        };
        assert_eq!([scaling(0.95), scaling(0.5)], ["met", "missed"]);
    }

    #[test]
    fn times_have_the_unit_that_suits_them() {
        assert_eq!(measured_time(&timed(2.134e-4, 0.4e-5)), "213 ± 4 µs");
        assert_eq!(measured_time(&timed(0.05, 0.0)), "50.0 ms");
    }
}
