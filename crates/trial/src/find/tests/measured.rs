//! Measured trials: the parts that the search finds against those bounded by hand.

use std::path::PathBuf;

use ship::angle::from_deg;

use crate::find::{Kind, Log, Manoeuvre, manoeuvres};

/// The columns of a measured record that a search looks at.
struct Table {
    time: Vec<f64>,
    rudder: Vec<f64>,
    heading: Vec<f64>,
    speed: Vec<f64>,
    propeller: Vec<f64>,
}

/// `None` (and one line) where the data are not there.
fn measured(file: &str) -> Option<Table> {
    let folder = std::env::var_os("TRIAL_DATA")
        .map_or_else(|| PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../../shared/data"), PathBuf::from);
    let path = folder.join(file);
    if !path.exists() {
        println!("skipped: no measured record {file}");
        return None;
    }
    let mut table = csv::Reader::from_path(path).expect("a readable file");
    let names = table.headers().expect("a header").clone();
    let column = |name: &str| names.iter().position(|found| found.starts_with(name)).expect("a known column");
    let wanted = ["t_s", "rudder_deg", "heading_deg", "speed_m_s", "propeller_rp"].map(column);
    let mut columns: [Vec<f64>; 5] = Default::default();
    for row in table.records() {
        let row = row.expect("a row");
        for (column, &index) in columns.iter_mut().zip(&wanted) {
            column.push(row[index].parse().expect("a number"));
        }
    }
    let [time, mut rudder, mut heading, speed, propeller] = columns;
    heading.iter_mut().chain(&mut rudder).for_each(|angle| *angle = from_deg(*angle));
    Some(Table { time, rudder, heading, speed, propeller })
}

impl Table {
    fn manoeuvres(&self) -> Vec<Manoeuvre> {
        let log = Log {
            time: &self.time,
            rudder: &self.rudder,
            heading: &self.heading,
            speed: Some(&self.speed),
            propeller: Some(&self.propeller),
        };
        manoeuvres(&log)
    }
}

#[test]
fn show() {
    let folder = "/work/shared/data";
    for set in ["esso_osaka", "kvlcc2_hsva", "kvlcc2_marin"] {
        let mut files: Vec<_> = std::fs::read_dir(format!("{folder}/{set}"))
            .unwrap()
            .map(|x| x.unwrap().file_name().into_string().unwrap())
            .collect();
        files.sort();
        for file in files {
            let table = measured(&format!("{set}/{file}")).unwrap();
            println!("{set}/{file} {:.2}..{:.2}", table.time[0], table.time.last().unwrap());
            for m in table.manoeuvres() {
                println!(
                    "    {:<30} {:.2} .. {:.2} start {:.2} executes {} {:?} {:?}",
                    m.kind.name(),
                    m.from,
                    m.until,
                    m.start,
                    m.executes,
                    m.quality.remarks(),
                    m.kind
                );
            }
        }
    }
    let _ = Kind::Straight;
}
