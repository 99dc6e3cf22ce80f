//! Logs with a fault: read with a warning, or rejected with advice.

use super::File;
use super::Outcome::{Read, Refused};
use super::sentences::{clocked, hdt, rsa, sentence};
use super::tables::{angles, clean, table};
use super::voyage::{TENTHS, every, seconds, time_of_day, voyage};

const HEADER: &str = "t_s,heading_deg,rudder_deg";

/// Table without faults with changed lines: `change` receives row and cells and returns one, several or no lines.
fn with_lines(change: impl Fn(usize, [&str; 3]) -> String) -> String {
    let clean = clean();
    let rows = clean.lines().skip(1).enumerate().map(|(row, line)| {
        let cells: Vec<&str> = line.split(',').collect();
        change(row, [cells[0], cells[1], cells[2]])
    });
    let lines: Vec<String> = rows.filter(|line| !line.is_empty()).collect();
    format!("{HEADER}\n{}\n", lines.join("\n"))
}

fn joined(cells: [&str; 3]) -> String {
    cells.join(",")
}

/// All logs with a fault.
pub(super) fn all() -> Vec<File> {
    let mut files = of_instruments();
    files.extend(of_clocks());
    files.extend(of_columns());
    files.extend(of_wires());
    files
}

fn of_instruments() -> Vec<File> {
    let frozen_row = voyage().execute(2) / TENTHS - 20;
    let frozen = 30;
    vec![
        File::new(
            "sentinels.csv",
            "-999 where the compass had no reading, and once where the rudder had none",
            with_lines(|row, [t, psi, delta]| match row {
                50 | 51 | 120 | 300 => format!("{t},-999,{delta}"),
                200 => format!("{t},{psi},-999"),
                _ => joined([t, psi, delta]),
            }),
            Read(&["`heading_deg` holds -999 4 times", "`rudder_deg` holds -999 once"]),
        ),
        File::new(
            "spike.csv",
            "one rudder angle of -327 degrees",
            with_lines(|row, [t, psi, delta]| format!("{t},{psi},{}", if row == 150 { "-327" } else { delta })),
            Read(&["1 row with an impossible rudder angle (-327°)"]),
        ),
        File::new(
            "frozen.csv",
            "a heading that stands still for half a minute in a turn",
            with_lines(|row, [t, psi, delta]| {
                let held = angles(frozen_row * TENTHS)[0].clone();
                let psi = if (frozen_row..frozen_row + frozen).contains(&row) { &held } else { psi };
                format!("{t},{psi},{delta}")
            }),
            Read(&["the heading is frozen"]),
        ),
        File::new(
            "stale.csv",
            "ten rows a second, with a rudder that is new once a second",
            table(HEADER, every(1), |tenth| {
                let [heading, _] = angles(tenth);
                let [_, rudder] = angles(tenth / TENTHS * TENTHS);
                format!("{},{heading},{rudder}", seconds(tenth))
            }),
            Read(&["the rudder has a new value in every 10th row only"]),
        )
        .not_kept(),
        File::new(
            "flipped.csv",
            "the rudder with the opposite sign",
            with_lines(|_, [t, psi, delta]| format!("{t},{psi},{}", -delta.parse::<f64>().expect("a number"))),
            Refused(&["the rudder sign looks flipped", "flip = true"]),
        ),
    ]
}

fn of_clocks() -> Vec<File> {
    // A row with the rudder at rest, because its motion in a gap is unknown.
    let rest = voyage().execute(1) / TENTHS + 10;
    let other = voyage().execute(3) / TENTHS + 10;
    let midnight = |tenth: usize| {
        let second = (86_400 - 200 + tenth / TENTHS) % 86_400;
        format!("{:02}:{:02}:{:02}", second / 3600, second / 60 % 60, second % 60)
    };
    vec![
        File::new(
            "gaps.csv",
            "seconds that are missing: 14 and 12 in a row",
            with_lines(|row, cells| {
                let lost = (rest..rest + 14).contains(&row) || (other..other + 12).contains(&row);
                if lost { String::new() } else { joined(cells) }
            }),
            Read(&["2 gaps longer than ten sampling periods"]),
        ),
        File::new(
            "midnight.csv",
            "times of day without a date, over midnight",
            table("Time,Heading [deg],Rudder [deg]", every(TENTHS), |tenth| {
                let [heading, rudder] = angles(tenth);
                format!("{},{heading},{rudder}", midnight(tenth))
            }),
            Read(&["columns recognised by their names"]),
        ),
        File::new(
            "doubled.csv",
            "a part of the rows written twice",
            with_lines(|row, cells| {
                let line = joined(cells);
                if (100..200).contains(&row) { format!("{line}\n{line}") } else { line }
            }),
            Read(&["100 rows left out as exact copies"]),
        ),
        File::new(
            "astray.csv",
            "a row with a time that is not its own, ahead, and another one behind",
            with_lines(|row, [t, psi, delta]| match row {
                90 => format!("9000,{psi},{delta}"),
                250 => format!("2,{psi},{delta}"),
                _ => joined([t, psi, delta]),
            }),
            Read(&["2 rows left out, because the time does not fit"]),
        ),
        File::new(
            "restarted.csv",
            "a clock that starts anew in the middle",
            with_lines(|row, [t, psi, delta]| match row {
                200.. => format!("{},{psi},{delta}", row - 200),
                _ => joined([t, psi, delta]),
            }),
            Refused(&["time runs backwards", "sort or cut the file"]),
        ),
        File::new(
            "restarted.nmea",
            "sentences whose clock starts anew in the middle",
            every(2 * TENTHS)
                .map(|tenth| {
                    let shown = if tenth < 200 * TENTHS { tenth } else { tenth - 150 * TENTHS };
                    let [heading, rudder] = [hdt(tenth), rsa(tenth)];
                    format!("{}\n{heading}\n{rudder}\n", super::sentences::rmc(shown))
                })
                .collect::<String>(),
            Refused(&["the clock of the log goes back", "cut the log there"]),
        ),
    ]
}

fn of_columns() -> Vec<File> {
    let course = |tenth: usize| {
        let [heading, rudder] = angles(tenth);
        format!("2026-11-20 {},{heading},{rudder}", time_of_day(tenth, false))
    };
    vec![
        File::new(
            "no-heading.csv",
            "a column of the heading without a value",
            with_lines(|_, [t, _, delta]| format!("{t},,{delta}")),
            Refused(&["`heading_deg` has no value", "check that the sensor was recorded"]),
        ),
        File::new(
            "degrees-as-radians.csv",
            "degrees under names that say radians",
            clean().replacen("heading_deg,rudder_deg", "heading_rad,rudder_rad", 1),
            Refused(&["looks like degrees under a name that says radians", "name the column rudder_deg"]),
        ),
        File::new(
            "radians-as-degrees.csv",
            "a rudder in radians under a name that says degrees",
            with_lines(|_, [t, psi, delta]| {
                format!("{t},{psi},{:.4}", delta.parse::<f64>().expect("a number").to_radians())
            }),
            Refused(&["looks like radians under a name that says degrees", "name the column rudder_rad"]),
        ),
        File::new(
            "course.csv",
            "a course over ground and no heading",
            table("Timestamp,COG [deg],Rudder [deg]", every(TENTHS), course),
            Refused(&["course over ground, which is no heading", "use a record with the compass"]),
        ),
        File::new(
            "milliseconds.csv",
            "a count of milliseconds under a name without a unit",
            table("Time,heading_deg,rudder_deg", every(TENTHS), |tenth| {
                let [heading, rudder] = angles(tenth);
                format!("{},{heading},{rudder}", 100 * tenth)
            }),
            Refused(&["`Time` has no unit", "name it t_s, t_ms or t_min"]),
        ),
    ]
}

fn of_wires() -> Vec<File> {
    let damaged: String = clocked(2 * TENTHS, |tenth| format!("{}\r\n{}", hdt(tenth), rsa(tenth)))
        .lines()
        .enumerate()
        .map(|(line, text)| match line % 40 {
            // Changed tens of the heading, as after a bit error in transmission.
            16 | 28 => format!("{}\r\n", text.replacen(['1', '3', '5', '7', '9'], "8", 1)),
            _ => format!("{text}\r\n"),
        })
        .collect();
    let course = clocked(2 * TENTHS, |tenth| {
        let course = sentence(&format!("GPVTG,{:.1},T,,M,12.0,N,22.2,K,A", voyage().heading(tenth)));
        format!("{course}\r\n{}", rsa(tenth))
    });
    // Every frame contains a heading of 57.3 degrees: eight bytes of PGN 127250 in base64.
    let frame = |row: usize| format!("{:.1},0x9f1120a,1,0,0,8,/xAn/3//f/0=\n", 0.1 * row as f64);
    let frames = (0..20).map(frame).collect::<String>();
    vec![
        File::new(
            "python-can.csv",
            "frames of a CAN bus as python-can writes them, in base64",
            format!("timestamp,arbitration_id,extended,remote,error,dlc,data\n{frames}"),
            Refused(&["CAN frames", "base64", "python-can", "`can_logconvert LOG.csv LOG.log`", "canboat"]),
        ),
        File::new(
            "checksums.nmea",
            "sentences with wrong checksums",
            damaged,
            Read(&["had a wrong checksum and are left out"]),
        ),
        File::new(
            "course.nmea",
            "sentences with a course over ground and no heading",
            course,
            Refused(&["there is no heading", "--with-columns FILE"]),
        ),
    ]
}
