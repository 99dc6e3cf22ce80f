//! Logs whose channels are not readings of an instrument, or in a unit other than that of their name: corrected, warned
//! about or rejected.

use super::File;
use super::Outcome::{Doubted, Read, Refused};
use super::tables::table;
use super::voyage::{EPOCH, LENGTH, TENTHS, every, seconds, voyage};

const HEADER: &str = "t_s,heading_deg,rudder_deg";

/// Table by the contract, one row a second, with changes of heading and rudder, deg, by row.
fn changed(header: &str, change: impl Fn(usize, [f64; 2]) -> [String; 2]) -> String {
    table(header, every(TENTHS), |tenth| {
        let [heading, rudder] = change(tenth / TENTHS, [voyage().heading(tenth), voyage().rudder(tenth)]);
        format!("{},{heading},{rudder}", seconds(tenth))
    })
}

/// Table by the contract with changes of the rudder only.
fn with_rudder(change: impl Fn(usize, f64) -> String) -> String {
    changed(HEADER, |row, [heading, rudder]| [format!("{heading:.2}"), change(row, rudder)])
}

/// Noise of a row, within ±0.25.
fn noise(row: usize) -> f64 {
    0.5 * (((row * row) as f64 * 0.618_034).fract() - 0.5)
}

/// All logs with a faulty channel.
pub(super) fn all() -> Vec<File> {
    let mut files = of_readings();
    files.extend(of_headings());
    files.extend(of_units());
    files.into_iter().map(File::not_kept).collect()
}

fn of_readings() -> Vec<File> {
    let first = voyage().execute(1) / TENTHS + 12;
    let written = |row: usize, rudder: f64| {
        let before = row.checked_sub(1).map(|row| voyage().rudder(row * TENTHS));
        if before == Some(rudder) { String::new() } else { format!("{rudder:.1}") }
    };
    vec![
        File::new(
            "clipped.csv",
            "a rudder that ends at 8 degrees",
            with_rudder(|row, rudder| format!("{:.1}", (rudder + noise(row)).clamp(-8.0, 8.0))),
            Doubted(&["stands at exactly 8° and -8°", "clipped at the end of its scale", "(column `rudder_deg`)"]),
        ),
        File::new(
            "stuck.csv",
            "a rudder that stands still beside noise",
            with_rudder(|row, rudder| match (first..first + 40).contains(&row) {
                true => String::from("-10.1"),
                false => format!("{:.1}", rudder + noise(row)),
            }),
            Doubted(&["is frozen at -10.1°"]),
        ),
        File::new(
            "noisy.csv",
            "a rudder with the same noise that is neither",
            with_rudder(|row, rudder| format!("{:.1}", rudder + noise(row))),
            Read(&[]),
        ),
        File::new(
            "coarse.csv",
            "a rudder in steps of 5 degrees",
            with_rudder(|_, rudder| format!("{}", (rudder / 5.0).round() * 5.0)),
            Doubted(&["comes in steps of 5°"]),
        ),
        File::new(
            "noisy-order.csv",
            "an order with the noise of a converter in place of the angle",
            with_rudder(|row, rudder| {
                let next = voyage().rudder(((row + 1) * TENTHS).min(LENGTH));
                let order = if next == rudder { rudder } else { 10.0 * (next - rudder).signum() };
                format!("{:.2}", order + 0.2 * noise(row))
            }),
            Doubted(&["looks like the order"]),
        ),
        File::new(
            "on-change.csv",
            "a rudder that is written on change",
            with_rudder(written),
            Read(&["is written on change"]),
        ),
        File::new(
            "circle.csv",
            "a rudder from 0 to 360 degrees",
            with_rudder(|_, rudder| format!("{:.2}", rudder.rem_euclid(360.0))),
            Read(&["the rudder is written from 0 to 360°"]),
        ),
        File::new(
            "side.csv",
            "a rudder whose side stands in another column",
            changed("t_s,heading_deg,rudder_deg,Side", |_, [heading, rudder]| {
                let side = if rudder < 0.0 { "PORT" } else { "STBD" };
                [format!("{heading:.2}"), format!("{:.2},{side}", rudder.abs())]
            }),
            Read(&["taken from the side in `Side`"]),
        ),
        File::new(
            "unsigned.csv",
            "a rudder that has lost its sign",
            with_rudder(|_, rudder| format!("{:.2}", rudder.abs())),
            Doubted(&["the rudder is never negative"]),
        ),
    ]
}

fn of_headings() -> Vec<File> {
    let swept = table(HEADER, every(2), |tenth| {
        let (from, to) = (tenth / TENTHS * TENTHS, (tenth / TENTHS * TENTHS + TENTHS).min(LENGTH));
        let [one, other] = [from, to].map(|at| voyage().heading(at));
        let share = (tenth - from) as f64 / TENTHS as f64;
        format!("{},{:.2},{:.2}", seconds(tenth), one + share * (other - one), voyage().rudder(tenth))
    });
    let derivative = table("t_s,heading_deg,rudder_deg,yaw_rate_deg_s", every(TENTHS), |tenth| {
        let at = |tenth: usize| voyage().heading(tenth.min(LENGTH));
        let turn = at(tenth + TENTHS) - at(tenth.saturating_sub(TENTHS));
        let rate = 0.5 * ((turn + 180.0).rem_euclid(360.0) - 180.0);
        format!("{},{:.3},{:.2},{rate:.4}", seconds(tenth), at(tenth), voyage().rudder(tenth))
    });
    vec![
        File::new(
            "swept.csv",
            "a heading interpolated through north",
            swept,
            Doubted(&["sweeps through the compass at north"]),
        ),
        File::new(
            "derivative.csv",
            "the derivative of the heading as a yaw rate",
            derivative,
            Read(&["the yaw rate is the derivative of the heading"]),
        ),
    ]
}

fn of_units() -> Vec<File> {
    let rate = table("t_s,yaw_rate_deg_s,rudder_deg", every(TENTHS), |tenth| {
        format!("{},{:.2},{:.2}", seconds(tenth), 60.0 * voyage().rate(tenth), voyage().rudder(tenth))
    });
    let stamped = |header: &str, factor: u64| {
        table(header, every(TENTHS), |tenth| {
            format!(
                "{},{:.2},{:.2}",
                (10 * EPOCH + tenth as u64) * factor,
                voyage().heading(tenth),
                voyage().rudder(tenth)
            )
        })
    };
    vec![
        File::new(
            "counts.csv",
            "counts of a converter for the rudder",
            with_rudder(|_, rudder| format!("{:.0}", 512.0 + 9.0 * rudder)),
            Refused(&["whole numbers from 422 to 602", "counts of a converter about 512", "zero = 512 scale = 0.1"]),
        ),
        File::new(
            "rudder-tenths.csv",
            "tenths of a degree of rudder",
            with_rudder(|_, rudder| format!("{:.0}", 10.0 * rudder)),
            Refused(&["look like tenths of a degree", "scale = 0.1"]),
        ),
        File::new(
            "heading-tenths.csv",
            "tenths of a degree of heading",
            changed("t_s,Heading,rudder_deg", |_, [heading, rudder]| {
                [format!("{:.0}", (10.0 * heading).round() % 3600.0), format!("{rudder:.2}")]
            }),
            Refused(&["the heading `Heading` has whole numbers", "look like tenths of a degree", "scale = 0.1"]),
        ),
        File::new("minutes.csv", "deg/min under deg/s", rate, Refused(&["deg/min under a name that says deg/s"])),
        File::new(
            "microseconds.csv",
            "microseconds since 1970",
            stamped("time (us),heading_deg,rudder_deg", 100_000),
            Read(&[]),
        ),
        File::new(
            "epoch-as-seconds.csv",
            "milliseconds since 1970 under a name that says seconds",
            stamped(HEADER, 100),
            Refused(&["begins at 17951", "name it t_ms"]),
        ),
    ]
}
