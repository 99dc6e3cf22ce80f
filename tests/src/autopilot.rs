//! Full-scale records of ships under autopilot, which are not part of the project: their files have neither time nor
//! units.

use std::fmt::Write as _;

/// A record as its authors wrote it, and how a table is made of it.
#[derive(Debug, Clone, Copy)]
pub struct Record {
    /// Name of the ship.
    pub name: &'static str,
    /// Its file.
    pub file: &'static str,
    /// Heading and rudder, deg, from the numbers of a row and the heading of the row before.
    row: fn(&[f64], f64) -> Option<[f64; 2]>,
}

/// HAKUSAN: the yaw rate, taken to be in 0.001 deg/s, adds up to the heading; the rudder is taken to be in 0.01 deg.
/// America Maru: heading and rudder are taken to be in deg. Both rudders are taken to be positive to port.
pub const ALL: [Record; 2] = [
    Record {
        name: "HAKUSAN",
        file: "hakusan.txt",
        row: |numbers, heading| Some([heading + 1e-3 * numbers.first()?, -1e-2 * numbers.get(3)?]),
    },
    Record {
        name: "America Maru",
        file: "amerikamaru.csv",
        row: |numbers, _| Some([*numbers.get(1)?, -*numbers.first()?]),
    },
];

impl Record {
    /// A table of time, heading and rudder, one row a second, from the text of the file.
    pub fn table(&self, text: &str) -> String {
        let mut table = String::from("t_s,heading_deg,rudder_deg\n");
        let mut heading = 0.0;
        let rows = text.lines().skip(1).filter_map(|line| {
            let cells = line.split([',', ' ']).filter(|cell| !cell.is_empty());
            let numbers: Vec<f64> = cells.filter_map(|cell| cell.parse().ok()).collect();
            let [next, rudder] = (self.row)(&numbers, heading)?;
            heading = next;
            Some([next, rudder])
        });
        for (time, [heading, rudder]) in rows.enumerate() {
            let _ = writeln!(table, "{time},{heading:.4},{rudder:.4}");
        }
        table
    }
}
