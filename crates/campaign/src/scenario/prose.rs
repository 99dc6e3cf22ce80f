//! Prose and presentation of a scenario: question, analysis, finding, plots. They do not affect rows.
#![expect(non_snake_case, reason = "K and T are the symbols of the field")]

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use toml::{Table, Value};

use crate::scenario::name;
use crate::scenario::problem::{KeyFault, KeyPath, text_fault};

/// Prose and presentation of a scenario.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Prose {
    /// Question.
    pub question: String,
    /// Analysis, in paragraphs.
    pub analysis: String,
    /// Result in one sentence.
    pub finding: String,
    /// Selection of plots, and the key plot.
    pub output: Presentation,
}

/// Selection of plots.
#[derive(Debug, Clone, Default, PartialEq, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Presentation {
    /// Plots of the first replicate of every cell: trial, fit, derivatives, replays, intervals.
    pub showcase: bool,
    /// Stem of the plot that represents the study on an overview.
    pub figure: Option<String>,
    /// Title of that plot: its result, in a sentence.
    pub title: Option<String>,
    /// Subject of that plot.
    pub highlight: Highlight,
    /// Stems of the further plots; all available plots if omitted.
    pub figures: Option<Vec<String>>,
    /// Values of an axis with a name of their own.
    pub marks: Vec<MarkedValue>,
    /// Cells, by the labels of their points joined by commas, whose errors are shown individually.
    pub detail: Vec<String>,
}

impl Presentation {
    /// Keys of the table.
    const KEYS: [&str; 7] = ["showcase", "figure", "title", "highlight", "figures", "marks", "detail"];

    /// Removes the keys of other versions, which determine no row, from `output` in the scenario of a manifest; returns
    /// their names.
    pub(crate) fn remove_unknown(document: &mut Table) -> Vec<String> {
        let Some(Value::Table(output)) = document.get_mut("output") else { return Vec::new() };
        let is_unknown = |key: &&String| !Self::KEYS.contains(&key.as_str());
        let unknown: Vec<String> = output.keys().filter(is_unknown).cloned().collect();
        unknown.iter().for_each(|key| drop(output.remove(key)));
        unknown
    }
}

/// Subject of a plot: everything else in it is pale.
#[derive(Debug, Clone, Default, PartialEq, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Highlight {
    /// Labels of methods; all if omitted. Of several traces the first one is plotted.
    pub series: Vec<String>,
    /// Labels of methods that are not in the scenario, whose answers are scored.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub scored: Vec<String>,
    /// Names of rows; all if omitted. Their values are written next to them.
    pub rows: Vec<String>,
    /// `true` if the written values are in multiples of the Cramér–Rao bound.
    #[serde(rename = "over-bound", skip_serializing_if = "std::ops::Not::not")]
    pub over_bound: bool,
}

impl Highlight {
    /// Labels of all highlighted methods, those of the scenario first.
    pub fn method_labels(&self) -> Vec<String> {
        [&self.series[..], &self.scored].concat()
    }
}

/// Named value of an axis, such as the limit of a rule.
#[derive(Debug, Clone, PartialEq, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct MarkedValue {
    /// Name of the axis.
    pub axis: String,
    /// Position on the axis, in its unit.
    #[serde(rename = "at")]
    pub value: f64,
    /// Name of the value.
    pub label: String,
}

/// Published values of other authors, shown next to the results and never used.
#[derive(Debug, Clone, Copy, Default, PartialEq, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Published {
    /// Published K.
    #[serde(rename = "K-per-s")]
    pub K_per_s: Option<f64>,
    /// Published T.
    #[serde(rename = "T-s")]
    pub T_s: Option<f64>,
}

impl Prose {
    /// Reads question, analysis, finding and output settings from the text of a scenario; all are empty if it is not
    /// valid TOML.
    pub fn from_scenario_text(scenario: &str) -> Self {
        let mut document: Table = scenario.parse().unwrap_or_default();
        Presentation::remove_unknown(&mut document);
        let text = |key: &str| document.get(key).and_then(Value::as_str).unwrap_or_default().to_owned();
        let output = document.get("output").cloned().and_then(|output| output.try_into().ok()).unwrap_or_default();
        Self { question: text("question"), analysis: text("analysis"), finding: text("finding"), output }
    }

    /// Checks that texts are printable and that plot names are valid file names.
    pub(crate) fn check(&self) -> Result<(), KeyFault> {
        let Self { question, analysis, finding, output } = self;
        let prose = [("question", question), ("analysis", analysis), ("finding", finding)].into_iter();
        for (key, text) in prose.chain(output.title.iter().map(|title| ("output.title", title))) {
            name::check_prose(text).map_err(|unfit| text_fault(KeyPath::from_dotted(key), text, unfit))?;
        }
        let figure = output.figure.iter().map(|stem| (KeyPath::from_dotted("output.figure"), stem));
        let figures = output.figures.iter().flatten().enumerate();
        let figures = figures.map(|(index, stem)| (KeyPath::from_dotted("output.figures").child(index), stem));
        for (key, stem) in figure.chain(figures) {
            name::check_file_name(stem).map_err(|unfit| text_fault(key, stem, unfit))?;
        }
        Ok(())
    }
}

impl Published {
    /// Checks that both values are finite.
    pub(crate) fn check(&self) -> Result<(), KeyFault> {
        for (name, value) in [("K-per-s", self.K_per_s), ("T-s", self.T_s)] {
            if let Some(value) = value.filter(|value| !value.is_finite()) {
                let key = KeyPath::from_dotted("published").child(name);
                return Err(KeyFault::new(
                    key,
                    value,
                    "expected a finite number",
                    "give the number, or leave the key out",
                ));
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A manifest of another version belongs to the same study; unknown keys of its prose are omitted.
    #[test]
    fn keys_of_other_versions_are_left_out() {
        let schema = schemars::schema_for!(Presentation);
        let keys = schema.as_value()["properties"].as_object().expect("a table");
        assert!(keys.keys().eq(Presentation::KEYS), "{keys:?}");
        let prose =
            Prose::from_scenario_text("question = \"Which?\"\n[output]\nfigure = \"errors\"\nmethods = [\"srivc\"]\n");
        assert_eq!((prose.question.as_str(), prose.output.figure.as_deref()), ("Which?", Some("errors")));
    }
}
