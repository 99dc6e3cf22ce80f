//! Sentences with numbers, held against the stored summaries they are about: `claims.toml` says which number is which
//! figure. A number is right when the stored one, rounded to as many digits, is it. A word such as "smallest" or "at
//! the bound" is a test on the ends of intervals.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use serde::Deserialize;

/// All claims.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Claims {
    claim: Vec<Claim>,
}

/// One sentence, or a part of one.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Claim {
    /// Files it stands in, from the root of the repository.
    pages: Vec<String>,
    /// The words, with every number in braces, `{89.8} %`.
    says: String,
    /// The table of the numbers.
    table: String,
    /// The figure of every number, in their order.
    #[serde(default)]
    numbers: Vec<Number>,
    /// Figures that lie where a word puts them: "at the bound" is an interval that reaches to one.
    #[serde(default)]
    within: Vec<Within>,
    /// Figures that stand in an order: "the smallest error" has an interval that ends below the other one.
    #[serde(default)]
    order: Vec<Order>,
}

/// A figure between two ends.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Within {
    figure: Number,
    least: Option<f64>,
    most: Option<f64>,
}

/// Two figures, the smaller one first.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Order {
    smaller: Number,
    larger: Number,
}

/// A number of a table.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Number {
    column: String,
    /// Cells of the rows that count: one value, or one of several.
    #[serde(default)]
    rows: BTreeMap<String, OneOrMore>,
    /// What is made of several rows.
    #[serde(default)]
    take: Take,
    /// The column that says how much a row counts in a mean: each the same where there is none.
    weight: Option<String>,
    /// What the stored figure is multiplied with: −1 for what is "too low".
    #[serde(default = "one")]
    factor: f64,
}

fn one() -> f64 {
    1.0
}

#[derive(Deserialize)]
#[serde(untagged)]
enum OneOrMore {
    One(String),
    More(Vec<String>),
}

impl OneOrMore {
    fn holds(&self, value: &str) -> bool {
        match self {
            Self::One(own) => own == value,
            Self::More(own) => own.iter().any(|own| own == value),
        }
    }
}

#[derive(Deserialize, Default, Clone, Copy, PartialEq)]
#[serde(rename_all = "kebab-case")]
enum Take {
    /// There has to be one row.
    #[default]
    Only,
    Mean,
    Least,
    Most,
}

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

fn read(path: &str) -> Result<String, String> {
    std::fs::read_to_string(root().join(path)).map_err(|error| format!("{path}: {error}"))
}

/// One blank between words, whatever the lines are.
fn in_one_line(text: &str) -> String {
    text.split_whitespace().collect::<Vec<&str>>().join(" ")
}

/// The numbers in the braces of a sentence.
fn numbers(says: &str) -> Vec<String> {
    says.split('{').skip(1).filter_map(|part| part.split_once('}')).map(|(number, _)| number.to_owned()).collect()
}

impl Number {
    /// The stored value in the unit of the sentence.
    fn stored(&self, table: &str) -> Result<f64, String> {
        self.taken(table).map(|value| self.factor * value)
    }

    fn taken(&self, table: &str) -> Result<f64, String> {
        let text = read(table)?;
        let mut reader = csv::Reader::from_reader(text.as_bytes());
        let said = |error: csv::Error| format!("{table}: {error}");
        let header = reader.headers().map_err(said)?.clone();
        let place = |name: &str| {
            header.iter().position(|own| own == name).ok_or_else(|| format!("{table}: no column {name:?}"))
        };
        let column = place(&self.column)?;
        let wanted: Vec<(usize, &OneOrMore)> =
            self.rows.iter().map(|(name, value)| Ok((place(name)?, value))).collect::<Result<_, String>>()?;
        let rows: Vec<csv::StringRecord> = reader.records().collect::<Result<_, _>>().map_err(said)?;
        let weight = self.weight.as_deref().map(place).transpose()?;
        let counts = |row: &csv::StringRecord| weight.map_or(Some(1.0), |weight| row[weight].parse::<f64>().ok());
        let (values, weights): (Vec<f64>, Vec<f64>) = rows
            .iter()
            .filter(|row| wanted.iter().all(|(place, value)| value.holds(&row[*place])))
            .filter_map(|row| Some((row[column].parse::<f64>().ok()?, counts(row)?)))
            .unzip();
        match (self.take, values.len()) {
            (_, 0) => Err(format!("{table}: no row for {:?}", self.column)),
            (Take::Only, 1) => Ok(values[0]),
            (Take::Only, count) => Err(format!("{table}: {count} rows for {:?}, say what to take", self.column)),
            (Take::Mean, _) => {
                let sum: f64 = values.iter().zip(&weights).map(|(value, weight)| value * weight).sum();
                Ok(sum / weights.iter().sum::<f64>())
            }
            (Take::Least, _) => Ok(values.iter().copied().fold(f64::INFINITY, f64::min)),
            (Take::Most, _) => Ok(values.iter().copied().fold(f64::NEG_INFINITY, f64::max)),
        }
    }
}

/// Whether a number that is written is the stored one, rounded.
fn is_rounded(written: &str, stored: f64) -> bool {
    let plain = written.replace('−', "-");
    let digits = plain.split_once('.').map_or(0, |(_, digits)| digits.len());
    let Ok(value) = plain.parse::<f64>() else { return false };
    // Half of the last digit, and a hair for what stands exactly between two.
    (value - stored).abs() <= 0.5 * 10f64.powi(-(digits as i32)) * (1.0 + 1e-6)
}

impl Claim {
    /// What is wrong with it.
    fn faults(&self) -> Vec<String> {
        let plain = in_one_line(&self.says.replace(['{', '}'], ""));
        let mut faults = Vec::new();
        for page in &self.pages {
            match read(page) {
                Ok(text) if in_one_line(&text).contains(&plain) => {}
                Ok(_) => faults.push(format!("{page} does not say: {plain}")),
                Err(error) => faults.push(error),
            }
        }
        let written = numbers(&self.says);
        if written.len() != self.numbers.len() {
            faults.push(format!("{} numbers and {} figures in: {plain}", written.len(), self.numbers.len()));
        }
        for (written, number) in written.iter().zip(&self.numbers) {
            match number.stored(&self.table) {
                Ok(stored) if is_rounded(written, stored) => {}
                Ok(stored) => faults.push(format!("{written} is {stored} in {}: {plain}", self.table)),
                Err(error) => faults.push(format!("{error}: {plain}")),
            }
        }
        for Within { figure, least, most } in &self.within {
            match figure.stored(&self.table) {
                Ok(stored) if least.is_none_or(|end| end <= stored) && most.is_none_or(|end| stored <= end) => {}
                Ok(stored) => faults.push(format!("{} is {stored} in {}: {plain}", figure.column, self.table)),
                Err(error) => faults.push(format!("{error}: {plain}")),
            }
        }
        for Order { smaller, larger } in &self.order {
            match (smaller.stored(&self.table), larger.stored(&self.table)) {
                (Ok(one), Ok(other)) if one < other => {}
                (Ok(one), Ok(other)) => faults.push(format!("{one} is not below {other} in {}: {plain}", self.table)),
                (Err(error), _) | (_, Err(error)) => faults.push(format!("{error}: {plain}")),
            }
        }
        if self.numbers.is_empty() && self.within.is_empty() && self.order.is_empty() {
            faults.push(format!("nothing is held against the tables: {plain}"));
        }
        faults
    }
}

/// Sentences say what the tables say.
#[test]
fn claims_follow_from_the_stored_results() {
    let claims: Claims = toml::from_str(&read("tests/claims.toml").expect("it is there")).expect("it is right");
    let faults: Vec<String> = claims.claim.iter().flat_map(Claim::faults).collect();
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

#[test]
fn a_number_is_right_to_its_last_digit() {
    assert!(is_rounded("89.8", 89.84) && !is_rounded("89.8", 89.86) && is_rounded("−14", -13.6));
    assert!(is_rounded("57", 56.7) && !is_rounded("57", 57.6) && !is_rounded("x", 0.0));
    assert_eq!(numbers("K in {94.5} % and T in {94.9} %"), ["94.5", "94.9"]);
}
