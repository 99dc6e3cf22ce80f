//! Input accepted by the reader, and one message for each refused input.

use std::fmt::Write as _;
use std::io::Read;
use std::path::Path;

use approx::assert_abs_diff_eq;
use ship::Particulars;
use ship::angle::{from_deg, to_deg};

use super::*;
use crate::channel::Channel;
use crate::plausibility;
use crate::record::RecordOrigin;
use crate::sidecar::{Sidecar, SidecarProblem};

/// Time, heading and rudder (s, deg, deg) of a plausible 10/10 zig-zag, one row per second, headings wrapped to 0..360.
pub(super) fn rows() -> Vec<[f64; 3]> {
    let (mut psi, mut r, mut order, mut delta) = (350.0_f64, 0.0, 10.0_f64, 10.0_f64);
    (0..240)
        .map(|t| {
            let row = [f64::from(t), psi.rem_euclid(360.0), delta];
            for _ in 0..20 {
                delta += (order - delta).clamp(-0.25, 0.25);
                r += 0.05 * (0.1 * delta - r) / 16.0;
                psi += 0.05 * r;
            }
            if (psi - 350.0) * order > 0.0 && (psi - 350.0).abs() > 10.0 {
                order = -order;
            }
            row
        })
        .collect()
}

fn table(header: &str, separator: &str) -> String {
    let mut text = format!("{header}\n");
    for [t, psi, delta] in rows() {
        writeln!(text, "{t}{separator}{psi}{separator}{delta}").expect("a string takes all text");
    }
    text
}

pub(super) fn simple() -> String {
    table("t_s,heading_deg,rudder_deg", ",")
}

pub(super) fn parse_with(bytes: impl AsRef<[u8]>, sidecar: &str) -> Result<ReadRecord, ReadError> {
    let sidecar = Sidecar::parse(sidecar, Path::new("run.trial.toml")).expect("the sidecar is right");
    read_from_reader(Path::new("run.csv"), bytes.as_ref(), None, Some(&sidecar))
}

pub(super) fn parse(bytes: impl AsRef<[u8]>) -> Result<ReadRecord, ReadError> {
    read_from_reader(Path::new("run.csv"), bytes.as_ref(), None, None)
}

/// Problem of a table, after a check that its message names the file and contains `parts`.
fn problem(bytes: impl AsRef<[u8]>, parts: &[&str]) -> ReadProblem {
    complaint(parse(bytes), parts)
}

fn complaint(result: Result<ReadRecord, ReadError>, parts: &[&str]) -> ReadProblem {
    let error = result.expect_err("the table is wrong");
    let message = error.to_string();
    assert!(message.starts_with("run.csv: "), "{message}");
    for part in parts {
        assert!(message.contains(part), "`{part}` is not in: {message}");
    }
    let ReadError::Table { problem, .. } = error else { panic!("{message}") };
    problem
}

#[test]
fn every_separator_line_end_and_mark_gives_the_same_record() {
    let reference = parse(simple()).expect("the plainest table");
    assert_eq!(reference.warnings, []);
    assert_eq!(reference.trial.len(), 240);
    assert_eq!(reference.trial.name(), "run");
    let variants = [
        table("t_s;heading_deg;rudder_deg", ";"),
        table("t_s\theading_deg\trudder_deg", "\t"),
        table("  t_s   heading_deg rudder_deg", "   "),
        simple().replace('\n', "\r\n"),
        format!("\u{feff}{}", simple()),
        format!("# a remark, with commas\n\n{}# the end\n\n", simple()),
        simple().replacen("t_s,heading_deg,rudder_deg", "\"T_s\", Heading_deg ,\"rudder_deg\"", 1),
        table("# t_s heading_deg rudder_deg", " "),
        simple().trim_end().to_owned(),
    ];
    for text in variants {
        let reading = parse(&text).unwrap_or_else(|error| panic!("{error}\n{}", &text[..60]));
        assert_eq!(reading.warnings, [], "{}", &text[..60]);
        assert_eq!(reading.trial.time(), reference.trial.time());
        assert_eq!(reading.trial.heading(), reference.trial.heading());
        assert_eq!(reading.trial.rudder(), reference.trial.rudder());
    }
    let commas = parse(table("t_s;heading_deg;rudder_deg", ";").replace('.', ",")).expect("decimal commas");
    assert_eq!(commas.trial.heading(), reference.trial.heading());
    assert!(commas.warnings[0].text.contains("decimal comma"), "{:?}", commas.warnings);
}

#[test]
fn a_heading_that_wraps_is_continuous_and_the_hash_is_that_of_the_bytes() {
    let reading = parse(simple()).expect("a plain table");
    let steps = reading.trial.heading().windows(2).map(|pair| to_deg(pair[1] - pair[0]).abs());
    assert!(steps.fold(0.0, f64::max) < 1.5);
    let RecordOrigin::Measured { file, sha256 } = reading.trial.origin() else { panic!("it was read from a file") };
    assert_eq!(file, "run.csv");
    use sha2::{Digest, Sha256};
    let digest: String = Sha256::digest(simple()).iter().map(|byte| format!("{byte:02x}")).collect();
    assert_eq!(*sha256, digest);
}

#[test]
fn rows_with_missing_values_are_left_out_or_kept_and_counted() {
    let mut text = String::from("t_s,heading_deg,rudder_deg,remark,load_t,roll_deg\n");
    for (row, [t, psi, delta]) in rows().into_iter().enumerate() {
        let (time, heading, rudder) = (t.to_string(), psi.to_string(), delta.to_string());
        let (time, heading, rudder) = match row {
            20 => ("", heading.as_str(), rudder.as_str()),
            30 | 31 => (time.as_str(), heading.as_str(), "NaN"),
            40 => (time.as_str(), "", rudder.as_str()),
            _ => (time.as_str(), heading.as_str(), rudder.as_str()),
        };
        let load = if row == 50 { "heavy" } else { "12.5" };
        writeln!(text, "{time},{heading},{rudder},calm sea,{load},").expect("a string takes all text");
        if row == 60 {
            writeln!(text, "{time},{heading},{rudder},calm sea,{load},").expect("a string takes all text");
            writeln!(text, "60.5,{heading},{rudder}").expect("a string takes all text");
        }
    }
    let ReadRecord { trial, warnings } = parse(text).expect("missing values are no fault");
    assert_eq!(trial.len(), 240 - 1 + 1);
    assert_eq!(trial.heading().iter().filter(|psi| psi.is_nan()).count(), 1);
    assert!(trial.heading()[39].is_nan());
    assert_eq!(trial.unknown_columns().len(), 1, "{:?}", trial.unknown_columns().first());
    assert_eq!(trial.unknown_columns()[0].0, "load_t");
    assert_eq!(trial.unknown_columns()[0].1[0], 12.5);
    assert_eq!(trial.channel(Channel::Roll), None);
    let has = |part: &str| warnings.iter().any(|warning| warning.text.contains(part));
    assert!(has("1 row without time"), "{warnings:?}");
    assert!(has("2 rows without rudder angle, which is interpolated between its readings"), "{warnings:?}");
    assert!(has("1 heading missing; the longest gap, 2.0 s, begins at 39.0 s"), "{warnings:?}");
    assert!(has("1 row left out as exact copies"), "{warnings:?}");
    assert!(has("1 row with fewer cells"), "{warnings:?}");
    assert!(has("`remark` holds text in 241 rows"), "{warnings:?}");
    assert!(has("`load_t` holds text in 1 row,"), "{warnings:?}");
    assert!(has("`roll_deg` has no value"), "{warnings:?}");
}

#[test]
fn the_order_and_the_yaw_rate_stand_in_with_a_warning() {
    let ReadRecord { trial, warnings } =
        parse(table("t_s,heading_deg,rudder_order_deg", ",")).expect("the order stands for the rudder");
    assert_eq!(trial.rudder()[0], from_deg(10.0));
    assert_eq!(trial.channel(Channel::RudderOrder), Some(trial.rudder()));
    assert!(warnings[0].text.contains("the rudder order is used instead"), "{warnings:?}");

    let mut text = String::from("t_s yaw_rate_deg_s rudder_deg\n");
    let rows = rows();
    for pair in rows.windows(2) {
        let rate = (pair[1][1] - pair[0][1] + 180.0).rem_euclid(360.0) - 180.0;
        writeln!(text, "{} {rate} {}", pair[0][0], pair[0][2]).expect("a string takes all text");
    }
    let ReadRecord { trial, warnings } = parse(&text).expect("the yaw rate stands for the heading");
    assert!(trial.is_heading_integrated());
    assert!(warnings[0].text.contains("integral of the yaw rate"), "{warnings:?}");
    let text = text.replacen("yaw_rate_deg_s rudder_deg", "yaw_rate_deg_s rudder_deg heading_deg", 1);
    let text = text.lines().enumerate().map(|(i, l)| if i == 0 { format!("{l}\n") } else { format!("{l} nan\n") });
    let ReadRecord { trial, warnings } =
        parse(text.collect::<String>()).expect("an empty heading column is as good as none");
    assert!(trial.is_heading_integrated());
    assert!(warnings.iter().any(|warning| warning.text.contains("`heading_deg` has no value")), "{warnings:?}");
}

#[test]
fn files_that_are_no_tables_are_named() {
    assert!(matches!(problem("", &["is empty"]), ReadProblem::Empty));
    assert!(matches!(problem("# only\n# remarks\n", &["after line 2"]), ReadProblem::NoRows { .. }));
    assert!(matches!(problem("t_s,heading_deg,rudder_deg\n", &["after line 1"]), ReadProblem::NoRows { .. }));
    assert!(matches!(problem(b"\x89PNG\r\n\x1a\n\0\0", &["line 1", "0x89"]), ReadProblem::NotUtf8 { .. }));
    assert!(matches!(problem(b"\x07\x03\x04\0\0", &["line 1", "zero byte"]), ReadProblem::Binary { line: 1 }));
    assert!(matches!(problem(b"\xff\xfet\0_\0s\0", &["UTF-16"]), ReadProblem::Utf16));
    let page_1252 = [simple().as_bytes(), b"# \x9320\xb0\n"].concat();
    assert!(matches!(
        problem(page_1252, &["line 242", "0x93", "windows-1252"]),
        ReadProblem::NotUtf8 { line: 242, byte: 0x93 }
    ));
    let degrees = simple().replacen("heading_deg,rudder_deg", "Steuerkurs [\u{b0}],Ruderlage [\u{b0}]", 1);
    let latin: Vec<u8> = degrees.chars().map(|letter| letter as u8).collect();
    assert_eq!(parse(latin).expect("an old Windows program wrote it").trial.len(), 240);
    let headless = simple().lines().skip(1).collect::<Vec<_>>().join("\n");
    assert!(matches!(problem(headless, &["line 1", "0,350,10", "header = false"]), ReadProblem::NoHeader { .. }));
    assert!(matches!(problem("hello\nworld\n", &["line 1", "rudder_deg", "`hello`"]), ReadProblem::NoColumn { .. }));
}

#[test]
fn missing_and_doubled_columns_are_named_with_what_was_found() {
    let refusal =
        problem(table("t_s,heading_deg,helm", ","), &["line 1", "rudder angle", "rudder_deg or rudder_rad", "`helm`"]);
    assert!(matches!(refusal, ReadProblem::NoColumn { line: 1, .. }));
    problem(table("t_s,compass,rudder_deg", ","), &["heading_deg", "yaw_rate_deg_s", "`compass`", "sidecar"]);
    problem(table("t_s,course,rudder_deg", ","), &["`course` is the course over ground", "no heading", "sidecar"]);
    problem(table("clock,heading_deg,rudder_deg", ","), &["no column holds the time", "t_s", "`clock`", "time-step-s"]);
    let doubled = "t_s,heading_deg,heading_rad,rudder_deg\n0,1,2,3\n";
    assert!(matches!(problem(doubled, &["`heading_deg`", "`heading_rad`", "ignore"]), ReadProblem::Duplicate { .. }));
}

#[test]
fn wrong_cells_and_times_are_named_with_their_line() {
    let broken = |line: usize, row: &str| {
        let mut lines: Vec<String> = simple().lines().map(str::to_owned).collect();
        lines[line - 1] = row.to_owned();
        lines.join("\n")
    };
    let refusal = problem(broken(12, "10,35o.2,10"), &["line 12", "`heading_deg`", "`35o.2`", "expected a number"]);
    assert!(matches!(refusal, ReadProblem::NotANumber { line: 12, .. }));
    problem(broken(12, "10,inf,10"), &["line 12", "`inf`"]);
    problem(broken(3, "1e999,1,1"), &["line 3", "`t_s`", "`1e999`"]);
    assert!(matches!(
        problem(broken(12, "10,1,2,3"), &["line 12 has 4 cells, expected 3"]),
        ReadProblem::WrongCellCount { .. }
    ));
    problem(table("t_s heading_deg rudder_deg", " ").replacen("\n3 ", "\n", 1), &["line 5 has 2 cells, expected 3"]);
    let single = parse(broken(12, "3.5,1,10")).expect("a single row can be left out");
    assert!(single.warnings[0].text.contains("1 row left out, because the time does not fit"), "{:?}", single.warnings);
    let ahead = parse(broken(12, "3000,1,10")).expect("a single row can be left out");
    assert!(ahead.warnings[0].text.contains("the first is at 3000 s"), "{:?}", ahead.warnings);
    assert_eq!((single.trial.len(), ahead.trial.len()), (239, 239));
    let again = broken(12, "3.5,1,10").replacen("\n11,", "\n4.5,", 1);
    let refusal = problem(again, &["line 12", "3.5 s after 9 s", "time-step-s"]);
    assert!(matches!(refusal, ReadProblem::TimeBackwards { line: 12, .. }));
    let refusal = problem(broken(12, "9,1,10"), &["line 12", "time 9 s occurs twice"]);
    assert!(matches!(refusal, ReadProblem::TimeRepeats { line: 12, .. }));
}

#[test]
fn records_with_too_little_in_them_are_refused() {
    let few: String = simple().lines().take(7).map(|line| format!("{line}\n")).collect();
    let refusal = problem(few, &["6 of 6 rows", "at least 8"]);
    assert!(matches!(refusal, ReadProblem::TooShort { usable: 6, needed: 8, rows: 6 }));
    let all_missing = |place: usize| {
        let text = simple();
        let lines = text.lines().skip(1).map(|line| {
            let mut cells: Vec<&str> = line.split(',').collect();
            cells[place] = "nan";
            cells.join(",") + "\n"
        });
        format!("t_s,heading_deg,rudder_deg\n{}", lines.collect::<String>())
    };
    for (place, name) in [(0, "`t_s`"), (1, "`heading_deg`"), (2, "`rudder_deg`")] {
        assert!(matches!(problem(all_missing(place), &[name, "no value"]), ReadProblem::AllMissing { .. }));
    }
    let flipped =
        simple().lines().map(|line| line.rsplit_once(',').map_or("", |cells| cells.0).to_owned()).collect::<Vec<_>>();
    let rows = rows();
    let flipped: String = flipped
        .iter()
        .enumerate()
        .map(|(i, line)| if i == 0 { format!("{line},rudder_deg\n") } else { format!("{line},{}\n", -rows[i - 1][2]) })
        .collect();
    let refusal = problem(&flipped, &["rudder sign looks flipped", "flip = true"]);
    assert!(matches!(refusal, ReadProblem::Implausible(plausibility::Implausibility::RudderFlipped { .. })));
    // The remedy in the message is effective.
    let corrected = parse_with(&flipped, "[[column]]\nname = \"rudder_deg\"\nflip = true\n").expect("flipped back");
    assert_eq!(corrected.warnings, []);
    let unchecked = parse_with(&flipped, "[check]\nplausibility = false\n").expect("the check is off");
    assert!(unchecked.warnings[0].text.contains("looks flipped"), "{:?}", unchecked.warnings);
}

/// A table of a hundred million rows that exists only while it is read.
struct Endless {
    row: u64,
    line: Vec<u8>,
    consumed: usize,
    total: u64,
}

impl Read for Endless {
    fn read(&mut self, buffer: &mut [u8]) -> std::io::Result<usize> {
        if self.consumed == self.line.len() {
            if self.row == 100_000_000 {
                return Ok(0);
            }
            self.line.clear();
            use std::io::Write as _;
            if self.row == 0 {
                writeln!(self.line, "t_s,heading_deg,rudder_deg")?;
            }
            writeln!(self.line, "{:09},12.5,10.0", self.row)?;
            self.row += 1;
            self.consumed = 0;
        }
        let length = buffer.len().min(self.line.len() - self.consumed);
        buffer[..length].copy_from_slice(&self.line[self.consumed..self.consumed + length]);
        self.consumed += length;
        self.total += length as u64;
        Ok(length)
    }
}

#[test]
fn a_hundred_million_rows_are_refused_before_they_are_read() {
    let size = 27 + 100_000_000 * 20;
    let mut endless = Endless { row: 0, line: Vec::new(), consumed: 0, total: 0 };
    let result = read_from_reader(Path::new("run.csv"), &mut endless, Some(size), None);
    let refusal = complaint(result, &["more than 16666666 rows", "about 100000000", "every = 7", "from-s"]);
    assert!(matches!(
        refusal,
        ReadProblem::TooManyRows { limit: 16_666_666, columns: 3, estimate: Some(99_000_000..=110_000_000), every: 7 }
    ));
    assert!(endless.total < size / 4, "{} of {size} bytes were read", endless.total);
    let wide = (0..100_000).map(|column| format!("c{column}")).collect::<Vec<_>>().join(",");
    let row = "1,".repeat(100_000);
    let mut text = format!("t_s,heading_deg,rudder_deg,{wide}\n");
    for time in 0..503 {
        writeln!(text, "{time},2,3,{}", &row[..row.len() - 1]).expect("a string takes all text");
    }
    assert!(matches!(problem(text, &["more than 499 rows"]), ReadProblem::TooManyRows { limit: 499, .. }));
}

#[test]
fn a_sidecar_that_does_not_fit_its_table_is_named_with_its_line() {
    let fault = |sidecar: &str, line: usize, part: &str| {
        let error = parse_with(simple(), sidecar).expect_err(sidecar);
        let message = error.to_string();
        assert!(message.starts_with(&format!("run.trial.toml: line {line}: ")) && message.contains(part), "{message}");
        let ReadError::Sidecar(error) = error else { panic!("{message}") };
        error.problem
    };
    let refusal = fault("[[column]]\nname = \"helm\"\nis = \"rudder_deg\"\n", 1, "`t_s`, `heading_deg`, `rudder_deg`");
    assert!(matches!(refusal, SidecarProblem::NameNotFound { .. }));
    let refusal = fault("\n[[column]]\nindex = 4\nis = \"roll_deg\"\n", 2, "no column 4; run.csv has 3 columns");
    assert!(matches!(refusal, SidecarProblem::IndexBeyond { .. }));
    let twice = "[[column]]\nindex = 1\nis = \"t_s\"\n[[column]]\nname = \"t_s\"\nis = \"t_min\"\n";
    assert!(matches!(fault(twice, 4, "described twice"), SidecarProblem::DescribedTwice { .. }));
    let headless = "[table]\nheader = false\nskip-lines = 1\n[[column]]\nindex = 3\nflip = true\n";
    assert!(matches!(fault(headless, 4, "`column_3`"), SidecarProblem::UnknownColumnName { .. }));
    let outside = parse_with(simple(), "[part]\nfrom-s = 1000\n");
    assert!(matches!(complaint(outside, &["between 0 s and 239 s"]), ReadProblem::EmptyPart { .. }));
    let beyond = parse_with(simple(), "[table]\nskip-lines = 1000\n");
    assert!(matches!(complaint(beyond, &["after line 241"]), ReadProblem::NoRows { .. }));
}

#[test]
fn a_table_without_header_is_described_by_index() {
    let text: String = simple().lines().skip(1).map(|line| format!("{line},7\n")).collect();
    let sidecar = "[table]\nheader = false\ntime-step-s = 0.5\n[[column]]\nindex = 1\nis = \"t_s\"\n[[column]]\nindex = 2\n\
                   is = \"heading_deg\"\n[[column]]\nindex = 3\nis = \"rudder_deg\"\n[ship]\nlength-m = 105\nspeed-kn = 16.7\n\
                   [noise]\nheading-deg = 0.1\n";
    let trial = parse_with(text, sidecar).expect("every column is described").trial;
    assert_eq!(trial.time()[..3], [0.0, 0.5, 1.0]);
    assert_eq!(trial.unknown_columns(), [("column_4".to_owned(), vec![7.0; 240])]);
    assert_eq!(trial.particulars().map(|particulars| particulars.length), Some(105.0));
    assert_eq!(trial.noise().heading_sd, Some(from_deg(0.1)));
}

#[test]
fn a_sidecar_scales_columns_and_works_out_others() {
    let text: String = rows()
        .iter()
        .map(|[t, psi, delta]| format!("{t},{psi},{},{},{}\n", 512.0 + 10.0 * delta, delta + 0.5, 0.5 - delta))
        .collect();
    let text = format!("t_s,heading_deg,Counts,port,starboard\n{text}");
    let counts = "[[column]]\nname = \"Counts\"\nis = \"rudder_deg\"\nzero = 512\nscale = 0.1\n";
    let formula = "[[column]]\nformula = \"(port - starboard) / 2\"\nis = \"rudder_deg\"\n";
    let sound = parse(simple()).expect("sound").trial;
    for sidecar in [counts, formula] {
        let trial = parse_with(&text, sidecar).expect(sidecar).trial;
        let far = trial.rudder().iter().zip(sound.rudder()).map(|(delta, sound)| (delta - sound).abs());
        assert!(far.fold(0.0, f64::max) < 1e-9, "{sidecar}");
    }
    let unknown = parse_with(&text, &formula.replace("port", "helm")).expect_err("no such column").to_string();
    assert!(unknown.contains("no column is called `helm`"), "{unknown}");
    for (sidecar, part) in [
        ("formula = \"(port - \"\nis = \"rudder_deg\"", "the formula ends here"),
        ("formula = \"port\"", "needs `is`"),
        ("name = \"port\"\nscale = 0\nis = \"rudder_deg\"", "a scale other than 0"),
    ] {
        let message = Sidecar::parse(&format!("[[column]]\n{sidecar}\n"), Path::new("run.trial.toml"));
        let message = message.expect_err(sidecar).to_string();
        assert!(message.contains(part), "{message}");
    }
}

#[test]
fn speed_comes_from_surge_and_sway_where_it_was_not_recorded() {
    let text: String = simple()
        .lines()
        .enumerate()
        .map(|(row, line)| format!("{line},{}\n", if row == 0 { "surge_kn,sway_m_s" } else { "3.0,2.0" }))
        .collect();
    let trial = parse(text).expect("complete").trial;
    let speed = trial.channel(Channel::Speed).expect("surge and sway are there");
    assert_abs_diff_eq!(speed[5], (3.0 * ship::angle::KNOT).hypot(2.0), epsilon = 1e-15);
}

/// A minute of latitude about 45°, as in a log of sentences.
#[test]
fn latitude_and_longitude_are_metres_from_the_first() {
    let degrees = |row: usize| format!("{},10.0", if row < 2 { 45.0 - 0.5 / 60.0 } else { 45.0 + 0.5 / 60.0 });
    let lines = simple();
    let lines = lines.lines().enumerate();
    let text: String = lines
        .map(|(row, line)| format!("{line},{}\n", if row == 0 { "Latitude,Longitude".into() } else { degrees(row) }))
        .collect();
    let trial = parse(text).expect("complete").trial;
    assert_abs_diff_eq!(trial.channel(Channel::North).expect("a position")[1], 111_131.779 / 60.0, epsilon = 0.001);
    assert_eq!(trial.channel(Channel::East).expect("a position")[1], 0.0);
}

/// The delay of a rudder is shorter than the log.
#[test]
fn a_rudder_later_than_the_log_is_long_is_an_error_of_the_sidecar() {
    let read = |late: f64| parse_with(simple(), &format!("[rudder]\nlate-s = {late}"));
    let text = &read(2.5).expect("a late rudder").warnings[0].text;
    assert!(text.contains("taken 2.5 s earlier"), "{text}");
    for late in [1e4, -1e4] {
        let message = read(late).expect_err("no time in common").to_string();
        assert!(
            message.starts_with("run.trial.toml: `late-s` is ") && message.contains("less than the length of the log"),
            "{message}"
        );
    }
}

/// The declared weather of a sidecar is kept in the record and in its copies.
#[test]
fn a_declared_calm_stays_with_the_record() {
    let sidecar = "weather = \"none\"\n[ship]\nlength-m = 7.0\nspeed-m-s = 1.18\n";
    assert!(!parse(simple()).expect("complete").trial.is_calm());
    let trial = parse_with(simple(), sidecar).expect("complete").trial;
    assert!(trial.is_calm() && trial.scaled_to(Particulars { length: 320.0, speed: 8.0 }).expect("a scale").is_calm());
    let first = trial.time()[0];
    assert!(trial.without_channels(&[Channel::YawRate]).without_current([0.1; 2]).without_headings(&[first]).is_calm());
    let sidecar = Sidecar::parse(sidecar, Path::new("run.trial.toml")).expect("the sidecar is right");
    let log =
        InstrumentLog::from_reader(Path::new("run.csv"), simple().as_bytes(), None, Some(&sidecar)).expect("complete");
    let part = log.into_interval(first, first + 50.0).expect("a part");
    assert!(part.into_trial(None).expect("a record").trial.is_calm());
}
