//! Figures of stored tables: a cell, or what is made of several rows.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use estimation::statistics::wilson_interval;
use report::number::significant;
use serde::Deserialize;

use super::wording::parsed;

pub fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

pub fn read(path: &str) -> Result<String, String> {
    std::fs::read_to_string(root().join(path)).map_err(|error| format!("{path}: {error}"))
}

/// A number of a table, or of a report in Markdown, where `column` is the words before it.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Number {
    pub column: String,
    /// Cells of the rows that count: one value, or one of several.
    #[serde(default)]
    rows: BTreeMap<String, OneOrMore>,
    /// Columns whose values make groups of the rows: each group counts once, by its mean.
    #[serde(default)]
    by: Vec<String>,
    /// What is made of several rows.
    #[serde(default)]
    take: Take,
    /// The column that says how much a row counts: each the same if there is none.
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
    Sum,
    Count,
    Least,
    Most,
    /// Ends of Wilson's 95 % interval of the mean, where rows are shares in per cent and the weight counts trials.
    Low,
    High,
}

impl Number {
    /// The stored value in the unit of the sentence.
    pub fn stored(&self, table: &str) -> Result<f64, String> {
        let value = if table.ends_with(".md") { after(&self.column, table) } else { self.taken(table) };
        value.map(|value| self.factor * value)
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
        let by: Vec<usize> = self.by.iter().map(|name| place(name)).collect::<Result<_, String>>()?;
        // Groups with their sums: every row is its own where nothing else is asked for.
        let mut groups: BTreeMap<Vec<String>, (f64, f64)> = BTreeMap::new();
        for (index, row) in rows.iter().enumerate() {
            let is_wanted = wanted.iter().all(|(place, value)| value.holds(&row[*place]));
            let Some((value, weight)) = row[column].parse::<f64>().ok().zip(counts(row)).filter(|_| is_wanted) else {
                continue;
            };
            let own = if by.is_empty() { vec![index.to_string()] } else { vec![] };
            let group = own.into_iter().chain(by.iter().map(|place| row[*place].to_owned())).collect();
            let sums: &mut (f64, f64) = groups.entry(group).or_default();
            *sums = (sums.0 + weight * value, sums.1 + weight);
        }
        // A group without weight has no mean; those that were asked for count alike.
        let mean = |(sum, weight): (f64, f64)| (sum / weight, if by.is_empty() { weight } else { 1.0 });
        let (values, weights): (Vec<f64>, Vec<f64>) =
            groups.into_values().filter(|(_, weight)| *weight > 0.0).map(mean).unzip();
        let sum: f64 = values.iter().zip(&weights).map(|(value, weight)| value * weight).sum();
        let of: f64 = weights.iter().sum();
        let interval = || wilson_interval(sum / of / 100.0, of, 1.959_964).map(|end| 100.0 * end);
        match (self.take, values.len()) {
            (_, 0) => Err(format!("{table}: no row for {:?}", self.column)),
            (Take::Only, 1) => Ok(values[0]),
            (Take::Only, count) => Err(format!("{table}: {count} rows for {:?}, say what to take", self.column)),
            (Take::Mean, _) => Ok(sum / of),
            (Take::Sum, _) => Ok(sum),
            (Take::Count, count) => Ok(count as f64),
            (Take::Least, _) => Ok(values.iter().copied().fold(f64::INFINITY, f64::min)),
            (Take::Most, _) => Ok(values.iter().copied().fold(f64::NEG_INFINITY, f64::max)),
            (Take::Low, _) => Ok(interval()[0]),
            (Take::High, _) => Ok(interval()[1]),
        }
    }
}

/// The one number that a report has behind some words.
fn after(words: &str, report: &str) -> Result<f64, String> {
    let text = read(report)?;
    let number = |rest: &str| parsed(rest.trim_start().split(|c: char| !"−.0123456789".contains(c)).next()?);
    let mut numbers: Vec<f64> = text.split(words).skip(1).filter_map(number).collect();
    numbers.dedup();
    match numbers[..] {
        [number] => Ok(number),
        _ => Err(format!("{report}: {} numbers behind {words:?}", numbers.len())),
    }
}

/// Some rows and columns of a stored table in Markdown, numbers with three digits.
pub fn in_markdown(table: &str, kept: &BTreeMap<String, String>, columns: &[[String; 2]]) -> Result<String, String> {
    let text = read(table)?;
    let rows = csv::Reader::from_reader(text.as_bytes())
        .into_deserialize()
        .collect::<Result<Vec<BTreeMap<String, String>>, _>>();
    let mut rows = rows.map_err(|error| format!("{table}: {error}"))?;
    rows.retain(|row| kept.iter().all(|(name, value)| row.get(name) == Some(value)));
    let cells = |name: &String| -> Option<Vec<&str>> { rows.iter().map(|row| Some(row.get(name)?.as_str())).collect() };
    let mut lines = vec![String::new(); 2 + rows.len()];
    for [name, heading] in columns {
        let cells = cells(name).ok_or_else(|| format!("{table}: no column {name:?}"))?;
        let is_number = cells.iter().all(|cell| parsed(cell).is_some());
        let shown = |cell: &&str| match parsed(cell).filter(|_| cell.contains('.')) {
            Some(value) => significant(value, 3),
            // Counts of names, `one=2+other=1`.
            None if cell.contains('=') => format!("{})", cell.replace('=', " (").replace('+', "), ")),
            None => cell.replace('|', "\\|"),
        };
        let head = [heading.clone(), if is_number { "---:" } else { "---" }.to_owned()].into_iter();
        let column = lines.iter_mut().zip(head.chain(cells.iter().map(shown)));
        column.for_each(|(line, cell)| *line += &format!("| {cell} "));
    }
    Ok(lines.into_iter().map(|line| line.replace("| --- ", "|---").replace("| ---: ", "|---:") + "|\n").collect())
}
