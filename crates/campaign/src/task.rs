//! One trial of a design, and one part of a study.

use std::fmt;
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::str::FromStr;

use serde::{Deserialize, Serialize};

/// One trial of a design.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Task {
    /// Index of the cell.
    pub cell: usize,
    /// Index of the replicate in the cell.
    pub replicate: u64,
}

/// Part `number` of `of` parts of a study.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(into = "String", try_from = "String")]
pub struct Shard {
    /// From 1.
    pub number: u64,
    /// How many there are.
    pub of: u64,
}

impl Shard {
    /// The whole study.
    pub const WHOLE: Self = Self { number: 1, of: 1 };

    /// The part of `count` things that belongs to this shard: consecutive ones, as even as can be.
    pub(crate) fn part(self, count: u64) -> Range<u64> {
        let end = |number: u64| (u128::from(count) * u128::from(number) / u128::from(self.of)) as u64;
        end(self.number - 1)..end(self.number)
    }
}

impl FromStr for Shard {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let parts = text.split_once('/').and_then(|(number, of)| Some((number.parse().ok()?, of.parse().ok()?)));
        match parts {
            Some((number, of)) if number >= 1 && number <= of => Ok(Self { number, of }),
            _ => Err("expected I/N with I from 1 to N, for instance 3/16".to_owned()),
        }
    }
}

impl From<Shard> for String {
    fn from(shard: Shard) -> Self {
        shard.to_string()
    }
}

impl TryFrom<String> for Shard {
    type Error = String;

    fn try_from(text: String) -> Result<Self, String> {
        text.parse()
    }
}

impl fmt::Display for Shard {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}/{}", self.number, self.of)
    }
}

/// Where a study, or a shard of it, is stored unless another folder is named: shards sort as their numbers.
pub fn default_folder(name: &str, shard: Shard) -> PathBuf {
    let whole = Path::new("results").join(name);
    match shard {
        Shard::WHOLE => whole,
        Shard { number, of } => {
            whole.join("shards").join(format!("{number:0width$}-of-{of}", width = of.to_string().len()))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A shell that names the folders of shards with a star names them in their order.
    #[test]
    fn folders_of_shards_sort_as_their_numbers() {
        for of in [9, 10, 10_000, 99_999] {
            let names: Vec<_> = (1..=of).map(|number| default_folder("s", Shard { number, of })).collect();
            assert!(names.windows(2).all(|pair| pair[0] < pair[1]), "{of}");
        }
    }

    #[test]
    fn shards_are_written_as_fractions() {
        assert_eq!("3/16".parse(), Ok(Shard { number: 3, of: 16 }));
        for wrong in ["0/3", "4/3", "3", "a/b", "1/0", "-1/2", "1/2/3"] {
            assert!(wrong.parse::<Shard>().is_err(), "{wrong}");
        }
    }
}
