//! Traces the measured records, which are not part of the project, and writes what came out into `results/measured`.
//!
//! Run with the folder of the results as only argument; the records are looked for as [`kempf_tests::measured`] says.

use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use kempf_tests::measured::folder;
use report::number::{fixed, significant};
use report::{Column, Table};
use serde_json::Value;
use ship::angle::to_deg;
use study::options::{Common, Format, ReadingOptions, Style, TraceRequest, Withheld};
use trace::candidates::{self, Sizes};
use trace::fit::Problem;
use trace::noise::Colour;
use trace::record::Record;
use trace::search::Rule;
use trace::structure::Structure;
use trial::{Channel, Trial};

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
}

impl Set {
    /// The zig-zags that are not among some of them.
    fn others(&self, records: &[&str]) -> Vec<&'static str> {
        self.records.iter().copied().filter(|other| !records.contains(other)).collect()
    }
}

const ESSO_OSAKA: [&str; 5] =
    ["zigzag_13_57_45", "zigzag_13_04_24", "zigzag_13_14_21", "zigzag_13_42_53", "zigzag_14_10_05"];

const SETS: [Set; 3] = [
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
    },
    Set {
        name: "KVLCC2, MARIN, full-scale values",
        folder: "kvlcc2_marin",
        records: &["zigzag_20", "zigzag_-20", "zigzag_10"],
        pools: &[&["zigzag_20", "zigzag_-20"]],
        circles: &["turning_35"],
        wind: false,
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
    },
];

/// Cases whose whole report is kept: record, and whether the wind is withheld.
const KEPT: [(&str, bool); 3] = [("zigzag_20_10_s", false), ("zigzag_20", false), ("zigzag_13_57_45", false)];

fn main() -> ExitCode {
    let Some(results) = std::env::args_os().nth(1).map(PathBuf::from) else {
        eprintln!("give the folder of the results, for instance results/measured");
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
        let mut table = errors_table();
        let withheld: &[bool] = if set.wind { &[false, true] } else { &[false] };
        for &record in set.records {
            for &without_wind in withheld {
                let name = if without_wind { format!("{record}-without-wind") } else { record.to_owned() };
                let out = scratch.path().join(&name);
                let json = trace_some(set, &[record], &set.others(&[record]), without_wind, &out)?;
                let label = if without_wind { format!("{record}, wind withheld") } else { record.to_owned() };
                table.push(line(label, &json));
                if KEPT.contains(&(record, without_wind)) {
                    keep(&out, &results.join(format!("{}-{name}", set.folder)))?;
                }
            }
        }
        for (number, pool) in set.pools.iter().enumerate() {
            let out = scratch.path().join(format!("{}-pool-{number}", set.folder));
            let others = set.others(pool);
            let json = trace_some(set, pool, &others, false, &out)?;
            let left = if others.is_empty() { ", each left out in turn" } else { "" };
            let together = format!("together: {}", pool.join(", "));
            table.push(line(format!("{together}{left}"), &json));
            if !set.circles.is_empty() {
                let json = trace_some(set, pool, set.circles, false, &out)?;
                table.push(line(format!("{together}; turning circles held out"), &json));
            }
        }
        let _ = writeln!(page, "## {}\n\n{}", set.name, table.to_markdown());
        if set.wind {
            page += &wind(set)?;
        }
    }
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

const INTRODUCTION: &str = "# Measured records, traced

What a first-order response lacks on measured records, found from one record and judged on others that were not fitted. The records
are not part of the project; where they come from says [the book](../../docs/src/howto/public-trials.md). Made by

```text
cargo run --release -p kempf-tests --bin measured -- results/measured
```

A line is one analysis: `study trace` of one record, or of some together, with all others of its set held out; where all are fitted
together, each is left out in turn. Where K and T follow the measured speed from the start, which costs no parameter, *speed scaling*
stands first. *heading*: error of the recorded rudder replayed over the whole record, before (the best
first-order base) and after. *windows*: the same restarted every 20 and 60 s. On held-out records only initial states are fitted;
errors of several records are root mean squares over them, as the ratio after over before. *band*: share of the measured headings of
the held-out records inside the 95 % band of the final model. Terms are in the order of discovery; those marked * were believed
because they predict the held-out records, the others because of their likelihood against random moments.

";

const KEPT_REPORTS: &str = "## Reports\n\nWhole, with figures:\n\n";

fn errors_table() -> Table {
    Table::new([
        Column::left("fitted record"),
        Column::left("found"),
        Column::decimal("heading before").unit("deg"),
        Column::decimal("after").unit("deg"),
        Column::decimal("ratio"),
        Column::decimal("held out: heading ratio"),
        Column::decimal("held out: windows of 20 s"),
        Column::decimal("held out: windows of 60 s"),
        Column::decimal("held out: inside the band").unit("%"),
    ])
}

/// Runs `study trace` on some records of a set, others held out, and reads `trace.json`.
fn trace_some(set: &Set, records: &[&str], held_out: &[&str], without_wind: bool, out: &Path) -> Outcome<Value> {
    let path = |name: &str| folder().join(set.folder).join(format!("{name}.csv"));
    let sidecars = Path::new(env!("CARGO_MANIFEST_DIR")).join("../scenarios/measured");
    let request = TraceRequest {
        trials: records.iter().map(|record| path(record)).collect(),
        validate: held_out.iter().map(|record| path(record)).collect(),
        reading: ReadingOptions {
            columns: Some(sidecars),
            with_columns: Vec::new(),
            trial: None,
            from: None,
            until: None,
            length_m: None,
            speed_m_s: None,
            speed_kn: None,
        },
        own_bias: false,
        without: if without_wind { vec![Withheld::Wind] } else { Vec::new() },
        with: Vec::new(),
        only: Vec::new(),
        without_effect: Vec::new(),
        rule: Rule::default(),
        style: Style { paper: None, dpi: 600.0, style: None },
    };
    let common = Common { out: Some(out.to_owned()), threads: None, seed: None, quiet: true, format: Format::Text };
    eprintln!("{}: {}{}", set.folder, records.join(", "), if without_wind { ", wind withheld" } else { "" });
    study::commands::trace::run(&request, &common).map_err(|failure| failure.to_string())?;
    Ok(serde_json::from_str(&fs::read_to_string(out.join("trace.json"))?)?)
}

/// One line of the table, from `trace.json`.
fn line(label: String, json: &Value) -> Vec<String> {
    let number = |value: &Value| value.as_f64().unwrap_or(f64::NAN);
    let empty = Vec::new();
    let records = |kind: &str| json["error"][kind].as_array().unwrap_or(&empty);
    let fitted = records("identification");
    let held_out = [records("validation").as_slice(), records("leave_one_out")].concat();
    let pooled = |all: &[Value], when: &str, of: &dyn Fn(&Value) -> &Value| {
        let square = all.iter().map(|record| number(of(&record[when])).powi(2)).sum::<f64>();
        (square / all.len() as f64).sqrt()
    };
    let heading: &dyn Fn(&Value) -> &Value = &|errors| &errors["heading_rmse_deg"];
    let [before, after] = ["before", "after"].map(|when| pooled(fitted, when, heading));
    let ratio = |of| significant(pooled(&held_out, "after", of) / pooled(&held_out, "before", of), 2);
    let covered = held_out.iter().map(|record| number(&record["after"]["band_coverage_95"])).sum::<f64>();
    let scaling = (!json["speed_scaling"].is_null()).then(|| String::from("speed scaling"));
    let effects = json["effects"].as_array().unwrap_or(&empty).iter().map(|effect| {
        let predicted = effect["evidence"].as_str().is_some_and(|text| text.contains("does not stand"));
        let text = |key: &str| effect[key].as_str().unwrap_or_default().to_owned();
        format!("{} ({}){}", text("id"), text("form"), if predicted { "*" } else { "" })
    });
    let found: Vec<String> = scaling.into_iter().chain(effects).collect();
    vec![
        label,
        if found.is_empty() { "nothing".to_owned() } else { found.join(", ") },
        significant(before, 3),
        significant(after, 3),
        significant(after / before, 2),
        ratio(heading),
        ratio(&|errors| &errors["horizon_rmse_deg"]["20"]),
        ratio(&|errors| &errors["horizon_rmse_deg"]["60"]),
        fixed(100.0 * covered / held_out.len() as f64, 0),
    ]
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

/// The wind that a trace without wind columns finds, beside the wind that was measured.
fn wind(set: &Set) -> Outcome<String> {
    let mut table = Table::new([
        Column::left("record"),
        Column::decimal("measured: mean true wind").unit("m/s"),
        Column::decimal("from").unit("deg"),
        Column::decimal("traced: moment as rudder").unit("deg"),
        Column::decimal("from, modulo 180°").unit("deg"),
        Column::decimal("difference").unit("deg"),
        Column::decimal("c_w of the measured wind").unit("deg s²/m²"),
        Column::decimal("heading: base").unit("deg"),
        Column::decimal("traced wind").unit("deg"),
        Column::decimal("measured wind").unit("deg"),
    ]);
    let sidecars = Path::new(env!("CARGO_MANIFEST_DIR")).join("../scenarios/measured");
    for record in set.records {
        let path = folder().join(set.folder).join(format!("{record}.csv"));
        let sidecar = sidecars.join(format!("{record}.trial.toml"));
        let trial = trial::read_with(&path, Some(&sidecar))?.trial;
        let (speed, from) = mean_wind(&trial).ok_or("the record has wind columns")?;
        let [base, steady, measured] = wind_fits(&trial)?;
        let (c, s) = (steady.1[0], steady.1[1]);
        // w_c cos 2ψ + w_s sin 2ψ = w sin 2(ψ_w − ψ): w_c = w sin 2ψ_w, w_s = −w cos 2ψ_w.
        let direction = 0.5 * c.atan2(-s);
        let difference = (direction - from + 0.25 * std::f64::consts::TAU).rem_euclid(std::f64::consts::PI)
            - 0.25 * std::f64::consts::TAU;
        table.push([
            (*record).to_owned(),
            fixed(speed, 2),
            fixed(to_deg(from.rem_euclid(std::f64::consts::TAU)), 0),
            fixed(to_deg(c.hypot(s)), 1),
            fixed(to_deg(direction.rem_euclid(std::f64::consts::PI)), 0),
            fixed(to_deg(difference), 0),
            fixed(to_deg(measured.1[0]), 2),
            fixed(to_deg(base.0), 2),
            fixed(to_deg(steady.0), 2),
            fixed(to_deg(measured.0), 2),
        ]);
    }
    Ok(format!(
        "### Traced wind beside measured wind\n\nThe base with nothing but a wind moment added: once without the wind columns (steady \
         wind of unknown strength and direction, found from the heading alone), once with them (c_w U² sin γ). A zig-zag shows a small \
         part of the circle, so the direction of a steady wind is badly determined and takes up other slow errors; where it \
         is far from the measured one, it is no wind.\n\n{}\n",
        table.to_markdown()
    ))
}

/// Mean true wind: speed, and direction of the mean vector, rad.
fn mean_wind(trial: &Trial) -> Option<(f64, f64)> {
    let (speed, from) = (trial.channel(Channel::WindTrueSpeed)?, trial.channel(Channel::WindTrueFrom)?);
    let count = speed.len() as f64;
    let mean = |part: fn(f64) -> f64| speed.iter().zip(from).map(|(u, g)| u * part(*g)).sum::<f64>() / count;
    let (north, east) = (mean(f64::cos), mean(f64::sin));
    Some((north.hypot(east), east.atan2(north)))
}

/// Heading error (rad) and own parameters of the base, of the base with steady wind and of the base with the measured
/// wind.
fn wind_fits(trial: &Trial) -> Outcome<[(f64, Vec<f64>); 3]> {
    let method = identify::output_error::Settings::default().build()?;
    let first = identify::Identifier::identify(&method, std::slice::from_ref(trial))?.response;
    let replay = identify::replay::replay(trial, &first).ok_or("the base can be replayed")?;
    let initial = vec![replay.initial()];
    let problem = Problem::new(vec![Record::averaged(trial, first.T().abs())], first.inverse_T, first.K_over_T);
    let base = Structure::base(1, false);
    let theta = vec![first.inverse_T, first.K_over_T, first.rudder_bias];
    let plain = problem.fit(&base, &theta, &initial, &Colour::WHITE);
    let sizes = Sizes::of(&problem.records, first.inverse_T, &problem.replay(&base, &plain.theta, &plain.initial));
    let error = |fit: &trace::fit::Fit| (fit.rss / problem.observations() as f64).sqrt();
    let with = |form: &str| -> Outcome<(f64, Vec<f64>)> {
        let all = candidates::all(&problem.records, &sizes);
        let wind = all.into_iter().find(|candidate| candidate.term.effect.form() == form);
        let wind = wind.ok_or_else(|| format!("no candidate {form}"))?;
        let start = [plain.theta.as_slice(), &wind.starts[0]].concat();
        let fit = problem.fit(&base.with(wind.term), &start, &plain.initial, &Colour::WHITE);
        Ok((error(&fit), fit.theta[theta.len()..].to_vec()))
    };
    Ok([(error(&plain), Vec::new()), with("steady wind")?, with("measured wind")?])
}
