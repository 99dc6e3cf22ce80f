//! Logs with two faults. The reading is correct, or rejected, or has a warning with the cause.

use super::tables::table;
use super::voyage::{TENTHS, every, seconds, voyage};

/// Rows of a log: time, s, heading and rudder, deg.
pub type Rows = Vec<[f64; 3]>;

/// Fault of a log.
pub struct Trouble {
    /// Name of the fault.
    pub name: &'static str,
    /// Function that adds the fault to the rows.
    pub put: fn(&mut Rows),
    /// Words of which a message contains one if the fault makes K or T wrong.
    pub told: &'static [&'static str],
}

/// Rows without faults, one a second.
pub fn rows() -> Rows {
    every(TENTHS).map(|tenth| [seconds(tenth), voyage().heading(tenth), voyage().rudder(tenth)]).collect()
}

/// Rows as a table by the contract.
pub fn written(rows: &Rows) -> String {
    table("t_s,heading_deg,rudder_deg", 0..rows.len(), |row| {
        let [t, psi, delta] = rows[row];
        format!("{t},{psi:.3},{delta:.4}")
    })
}

/// Replaces a column by its values `by` rows earlier.
fn delayed(rows: &mut Rows, column: usize, by: usize) {
    for row in (0..rows.len()).rev() {
        rows[row][column] = rows[row.saturating_sub(by)][column];
    }
}

/// All faults, faults of the instruments before faults of the logger.
pub const TROUBLES: [Trouble; 16] = [
    Trouble {
        name: "compass damped over 4 s",
        put: |rows| {
            let mut shown = rows[0][1];
            for row in rows {
                shown += 0.22 * ((row[1] - shown + 180.0).rem_euclid(360.0) - 180.0);
                row[1] = shown;
            }
        },
        told: &["slow compass"],
    },
    Trouble {
        name: "compass that jumps by 8 degrees",
        put: |rows| rows[210..].iter_mut().for_each(|row| row[1] += 8.0),
        told: &["the heading jumps"],
    },
    Trouble { name: "rudder 3 s late", put: |rows| delayed(rows, 2, 3), told: &["recorded about"] },
    Trouble { name: "heading 3 s late", put: |rows| delayed(rows, 1, 3), told: &["later than it was recorded"] },
    Trouble {
        name: "order in place of the angle",
        put: |rows| {
            let execute = |delta: f64| if delta == 0.0 { 0.0 } else { 10.0 * delta.signum() };
            let mut order = 0.0;
            for row in 1..rows.len() {
                let change = rows[row][2] - rows[row - 1][2];
                order = if change.abs() > 0.01 { execute(change) } else { order };
                rows[row - 1][2] = order;
            }
        },
        told: &["order in place of the angle"],
    },
    Trouble {
        name: "rudder in per cent of 35 degrees",
        put: |rows| rows.iter_mut().for_each(|row| row[2] /= 0.35),
        told: &["per cent"],
    },
    Trouble {
        name: "rudder in radians",
        put: |rows| rows.iter_mut().for_each(|row| row[2] = row[2].to_radians()),
        told: &["radians"],
    },
    Trouble { name: "rudder flipped", put: |rows| rows.iter_mut().for_each(|row| row[2] *= -1.0), told: &["sign"] },
    Trouble {
        name: "rudder of zero where a poll was lost",
        put: |rows| rows.iter_mut().step_by(5).for_each(|row| row[2] = 0.0),
        told: &["polls"],
    },
    Trouble {
        name: "heading of zero where a poll was lost",
        put: |rows| rows.iter_mut().step_by(7).for_each(|row| row[1] = 0.0),
        told: &["polls"],
    },
    Trouble {
        name: "spikes of the heading",
        put: |rows| rows.iter_mut().step_by(43).for_each(|row| row[1] += 30.0),
        told: &["far from both neighbours"],
    },
    Trouble {
        name: "whole degrees of the heading",
        put: |rows| rows.iter_mut().for_each(|row| row[1] = row[1].round()),
        told: &[],
    },
    Trouble {
        name: "minutes in place of seconds",
        put: |rows| rows.iter_mut().for_each(|row| row[0] /= 60.0),
        told: &["unit of the time"],
    },
    Trouble {
        name: "rows that are missing",
        put: |rows| drop(rows.drain(200..216)),
        told: &["longer than ten sampling periods"],
    },
    Trouble {
        name: "rows written twice",
        put: |rows| {
            let copies = rows[100..180].to_vec();
            copies.into_iter().enumerate().for_each(|(at, row)| rows.insert(100 + 2 * at, row));
        },
        told: &[],
    },
    Trouble {
        name: "a record from the second execute on",
        put: |rows| drop(rows.drain(..voyage().execute(1) / TENTHS)),
        told: &[],
    },
];
