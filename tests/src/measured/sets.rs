//! The sets of measured records: which records each has, and what they are read with.

use std::fs;
use std::path::{Path, PathBuf};

use document::Warnings;
use study::options::ReadingOptions;
use study::records::read_others;
use trial::Trial;

use super::folder;
use crate::wrapped::without_jumps;

/// Records of one ship, of which each is fitted in turn and the others are held out.
pub struct MeasuredSet {
    /// Its ship and basin.
    pub name: &'static str,
    /// Its folder in that of all records.
    pub folder: &'static str,
    /// Its zig-zags.
    pub records: &'static [&'static str],
    /// Records that are fitted together, the others being held out; without others, each is left out in turn.
    pub pools: &'static [&'static [&'static str]],
    /// Turning circles: held out from the pools once more, by themselves. A rudder that stays where it is tells too
    /// little to be fitted.
    pub circles: &'static [&'static str],
    /// Whether the records have wind columns.
    pub wind: bool,
    /// The column of directions that was interpolated across north.
    pub wrapped: Option<&'static str>,
    /// Folder and records of earlier trials of the same hull: every record alone is traced once more with what they
    /// left as a prior.
    pub prior: Option<(&'static str, &'static [&'static str])>,
}

impl MeasuredSet {
    /// The zig-zags that are not among some of them.
    pub fn others(&self, records: &[&str]) -> Vec<&'static str> {
        self.records.iter().copied().filter(|other| !records.contains(other)).collect()
    }

    /// What is held out from a record alone: the other zig-zags, or the circles where there are none.
    pub fn beside(&self, record: &str) -> Vec<&'static str> {
        let others = self.others(&[record]);
        if others.is_empty() { self.circles.to_vec() } else { others }
    }

    /// Whether its records are there.
    pub fn is_there(&self) -> bool {
        folder().join(self.folder).is_dir()
    }

    /// What says the columns and the ship of its records: a sidecar of the whole set, else the folder of those of each
    /// record.
    pub fn sidecars(&self) -> PathBuf {
        let all = Path::new(env!("CARGO_MANIFEST_DIR")).join("../scenarios/measured");
        let of_set = all.join(format!("{}.trial.toml", self.folder));
        if of_set.exists() { of_set } else { all }
    }

    /// The file of a record; a copy in `scratch` where directions have to be left out of it.
    ///
    /// Fails where the record cannot be read or copied.
    pub fn file(&self, record: &str, scratch: &Path) -> std::io::Result<PathBuf> {
        let path = folder().join(self.folder).join(format!("{record}.csv"));
        let Some(column) = self.wrapped else { return Ok(path) };
        fs::create_dir_all(scratch)?;
        let copy = scratch.join(format!("{record}.csv"));
        fs::write(&copy, without_jumps(&fs::read_to_string(&path)?, column))?;
        Ok(copy)
    }

    /// A record, as commands read it.
    ///
    /// Fails with what the reader says of it.
    pub fn read(&self, record: &str, scratch: &Path) -> Outcome<Trial> {
        let options = reading(Some(self.sidecars()));
        let read = read_others(&[self.file(record, scratch)?], &options, &mut Warnings::default());
        read.map_err(|failure| failure.to_string())?.pop().ok_or_else(|| format!("{record}: no record").into())
    }
}

const ESSO_OSAKA: [&str; 5] =
    ["zigzag_13_57_45", "zigzag_13_04_24", "zigzag_13_14_21", "zigzag_13_42_53", "zigzag_14_10_05"];

/// Every set.
pub const SETS: [MeasuredSet; 4] = [
    MeasuredSet {
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
        wrapped: None,
        prior: Some(("kvlcc2_marin", &["zigzag_20", "zigzag_-20"])),
    },
    MeasuredSet {
        name: "KVLCC2, MARIN, full-scale values",
        folder: "kvlcc2_marin",
        records: &["zigzag_20", "zigzag_-20", "zigzag_10"],
        pools: &[&["zigzag_20", "zigzag_-20"]],
        circles: &["turning_35"],
        wind: false,
        wrapped: None,
        prior: None,
    },
    MeasuredSet {
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
        wrapped: None,
        prior: None,
    },
    MeasuredSet {
        name: "Boat of 3.6 m, Fuzhou",
        folder: "usv_fuzhou",
        records: &["zigzag_30_inter_xy"],
        pools: &[],
        circles: &["turnningdata_xy"],
        wind: false,
        wrapped: Some("zcourse"),
        prior: None,
    },
];

/// What a program that works on measured records gives.
pub type Outcome<T> = Result<T, Box<dyn std::error::Error>>;

/// How records are read: whole, as their sidecars say.
pub fn reading(columns: Option<PathBuf>) -> ReadingOptions {
    ReadingOptions { columns, ..ReadingOptions::default() }
}
