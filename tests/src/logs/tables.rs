//! Logs without faults as tables of export programs and spreadsheets.

use std::io::Write as _;

use flate2::Compression;
use flate2::write::GzEncoder;

use super::File;
use super::Outcome::Read;
use super::voyage::{EPOCH, TENTHS, every, seconds, time_of_day, time_of_half_day, voyage};

/// Table of a header and one line per row.
pub(super) fn table(header: &str, tenths: impl Iterator<Item = usize>, line: impl Fn(usize) -> String) -> String {
    let mut text = format!("{header}\n");
    for tenth in tenths {
        text += &line(tenth);
        text.push('\n');
    }
    text
}

/// Heading and rudder of a row, with two decimals.
pub(super) fn angles(tenth: usize) -> [String; 2] {
    let wrapped = format!("{:.2}", voyage().heading(tenth));
    let heading = if wrapped == "360.00" { String::from("0.00") } else { wrapped };
    [heading, format!("{:.2}", voyage().rudder(tenth))]
}

/// Table by the contract, one row a second.
pub(super) fn clean() -> String {
    table("t_s,heading_deg,rudder_deg", every(TENTHS), |tenth| {
        let [heading, rudder] = angles(tenth);
        format!("{},{heading},{rudder}", tenth / TENTHS)
    })
}

/// Bytes packed as by `gzip`.
pub fn packed(bytes: &[u8]) -> Vec<u8> {
    let mut encoder = GzEncoder::new(Vec::new(), Compression::default());
    encoder.write_all(bytes).and_then(|()| encoder.finish()).expect("memory takes all bytes")
}

fn with_comma(number: &str) -> String {
    number.replace('.', ",")
}

/// All tables without faults.
pub(super) fn all() -> Vec<File> {
    let mut files = of_contract();
    files.extend(of_programs());
    files.extend(of_two_rates());
    files
}

fn of_contract() -> Vec<File> {
    let windows = format!("\u{feff}{}", clean().replace('\n', "\r\n"));
    vec![
        File::new("clean.csv", "the names of the contract, one row a second", clean(), Read(&[])),
        File::new("tab.txt", "cells between tabs", clean().replace(',', "\t"), Read(&[])),
        File::new("windows.csv", "line ends of Windows and the mark of UTF-8", windows, Read(&[])),
        File::new("clean.csv.gz", "the same, packed", packed(clean().as_bytes()), Read(&[])).not_kept(),
        File::new(
            "clean-10-hz.csv",
            "ten rows a second",
            table("t_s,heading_deg,rudder_deg", every(1), |tenth| {
                let [heading, rudder] = angles(tenth);
                format!("{},{heading},{rudder}", seconds(tenth))
            }),
            Read(&[]),
        )
        .not_kept(),
        File::new(
            "quoted.csv",
            "cells in quotes, with a decimal comma",
            table("\"t_s\",\"heading_deg\",\"rudder_deg\"", every(TENTHS), |tenth| {
                let [heading, rudder] = angles(tenth);
                format!("\"{},0\",\"{}\",\"{}\"", tenth / TENTHS, with_comma(&heading), with_comma(&rudder))
            }),
            Read(&["decimal comma"]),
        ),
        File::new(
            "preamble.csv",
            "lines about ship and trial before the header",
            format!(
                "Trial report;;\nShip: MV Example\nDate: 20.11.2026\nManoeuvre: zig-zag 10/10, starboard\n\n{}",
                clean()
            ),
            Read(&["4 lines before the header skipped"]),
        ),
    ]
}

fn of_programs() -> Vec<File> {
    let row = |stamp: String, tenth: usize| {
        let [heading, rudder] = angles(tenth);
        format!("{stamp},{heading},{rudder}")
    };
    vec![
        File::new(
            "german.csv",
            "a German export: semicolons, decimal commas, a row of units",
            table("Datum Zeit;Steuerkurs;Ruderlage\ns;°;°", every(TENTHS), |tenth| {
                let [heading, rudder] = angles(tenth).map(|angle| with_comma(&angle));
                format!("20.11.2026 {};{heading};{rudder}", time_of_day(tenth, false))
            }),
            Read(&["columns recognised by their names: `Steuerkurs`, `Ruderlage`, `Datum Zeit`", "decimal comma"]),
        ),
        File::new(
            "iso.csv",
            "stamps of ISO 8601, headings of people, rate of turn and speed over ground",
            table("Timestamp,Heading,Rudder Angle,ROT deg/min,SOG", every(TENTHS), |tenth| {
                let stamp = format!("2026-11-20T{}Z", time_of_day(tenth, false));
                let [heading, rudder] = angles(tenth);
                format!("{stamp},{heading},{rudder},{:.1},12.0", 60.0 * voyage().rate(tenth))
            }),
            Read(&["`Rudder Angle` is the rudder angle in degrees", "`SOG` has no unit and is left out"]),
        ),
        File::new(
            "american.csv",
            "American dates with AM and PM",
            table("Time,Heading (deg),Rudder (deg)", every(TENTHS), |tenth| {
                row(format!("11/20/2026 {}", time_of_half_day(tenth, false)), tenth)
            }),
            Read(&["columns recognised by their names"]),
        ),
        File::new(
            "date-and-time.csv",
            "date and time in two columns",
            table("Date,Time,Heading [deg],Rudder [deg]", every(TENTHS), |tenth| {
                row(format!("2026-11-20,{}", time_of_day(tenth, false)), tenth)
            }),
            Read(&["columns recognised by their names"]),
        ),
        File::new(
            "epoch.csv",
            "milliseconds since 1970",
            table("timestamp,heading_deg,rudder_deg", every(TENTHS), |tenth| {
                row(format!("{}", 1000 * EPOCH + 100 * tenth as u64), tenth)
            }),
            Read(&["`timestamp` is read as milliseconds since 1970-01-01"]),
        ),
        File::new(
            "whole-seconds.csv",
            "ten rows with the stamp of one second",
            table("Timestamp,heading_deg,rudder_deg", every(1), |tenth| {
                row(format!("2026-11-20 {}", time_of_day(tenth, false)), tenth)
            }),
            Read(&["rows share their time stamps, usually 10 per stamp"]),
        )
        .not_kept(),
        File::new(
            "radians.csv",
            "angles in radians, and no unit in the header",
            table("t_s,heading,rudder", every(TENTHS), |tenth| {
                let [heading, rudder] = [voyage().heading(tenth), voyage().rudder(tenth)].map(f64::to_radians);
                format!("{},{heading:.4},{rudder:.4}", tenth / TENTHS)
            }),
            Read(&["`heading` is the heading in radians", "`rudder` is the rudder angle in radians"]),
        ),
    ]
}

/// Tables with heading and rudder read at different instants.
fn of_two_rates() -> Vec<File> {
    const LATE: usize = 5;
    let rudder_rows = || every(TENTHS).map(|tenth| tenth + LATE).filter(|tenth| *tenth <= super::voyage::LENGTH);
    let mut both: Vec<usize> = every(TENTHS).chain(rudder_rows().step_by(2)).collect();
    both.sort_unstable();
    vec![
        File::new(
            "two-rates.csv",
            "heading once a second and rudder every other second, in rows of their own",
            table("t_s,heading_deg,rudder_deg", both.into_iter(), |tenth| {
                let [heading, rudder] = angles(tenth);
                match tenth % TENTHS {
                    LATE => format!("{},,{rudder}", seconds(tenth)),
                    _ => format!("{},{heading},", seconds(tenth)),
                }
            }),
            Read(&["is interpolated between its readings"]),
        ),
        File::new(
            "two-files-heading.csv",
            "the heading; its rudder is in the next file",
            table("Timestamp,Heading [deg]", every(TENTHS), |tenth| {
                format!("2026-11-20T{},{}", time_of_day(tenth, false), angles(tenth)[0])
            }),
            Read(&["is interpolated between its readings"]),
        )
        .with("two-files-rudder.csv"),
        File::new(
            "two-files-rudder.csv",
            "the rudder of the file before, by another clock",
            table("Date;Time;Rudder [deg]", rudder_rows(), |tenth| {
                format!("20.11.2026;{};{}", time_of_day(tenth, true), angles(tenth)[1])
            }),
            super::Outcome::Refused(&["no column holds the heading", "rename the column"]),
        ),
    ]
}
