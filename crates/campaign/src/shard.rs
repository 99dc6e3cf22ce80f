//! Trials and shards of a study.

use std::fmt;
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::str::FromStr;

/// Place of a trial in a design: its cell and its replicate.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct TrialId {
    /// Index of the cell.
    pub cell: usize,
    /// Index of the replicate in the cell.
    pub replicate: u64,
}

/// Shard of a study: one of `count` ranges of its blocks, or under a stopping rule of its cells, of almost equal size.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Shard {
    /// Number of the shard, from 1.
    pub number: u64,
    /// Number of shards of the study.
    pub count: u64,
}

impl Shard {
    /// Whole study.
    pub const WHOLE: Self = Self { number: 1, count: 1 };

    /// Range of `items` items in this shard: consecutive, with sizes that differ by at most one.
    pub(crate) fn item_range(self, items: u64) -> Range<u64> {
        let end = |number: u64| (u128::from(items) * u128::from(number) / u128::from(self.count)) as u64;
        end(self.number - 1)..end(self.number)
    }
}

impl FromStr for Shard {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let parts = text.split_once('/').and_then(|(number, count)| Some((number.parse().ok()?, count.parse().ok()?)));
        match parts {
            Some((number, count)) if number >= 1 && number <= count => Ok(Self { number, count }),
            _ => Err("expected I/N with I from 1 to N, for instance 3/16".to_owned()),
        }
    }
}

impl fmt::Display for Shard {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}/{}", self.number, self.count)
    }
}

/// Default result folder of a study, `results/NAME`.
pub fn default_result_folder(name: &str) -> PathBuf {
    Path::new("results").join(name)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shards_are_written_as_fractions() {
        assert_eq!("3/16".parse(), Ok(Shard { number: 3, count: 16 }));
        for wrong in ["0/3", "4/3", "3", "a/b", "1/0", "-1/2", "1/2/3"] {
            assert!(wrong.parse::<Shard>().is_err(), "{wrong}");
        }
    }
}
