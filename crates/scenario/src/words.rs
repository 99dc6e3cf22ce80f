//! What a scenario says about itself: question, findings, and which figures stand for it. None of it decides a row.

use serde::{Deserialize, Serialize};
use toml::{Table, Value};

/// The words of a scenario.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Words {
    /// The question.
    pub question: String,
    /// What was seen.
    pub analysis: String,
    /// The answer in one sentence.
    pub finding: String,
    /// Stem of the figure that stands for the study.
    pub figure: Option<String>,
    /// What that figure shows, in a sentence: its title.
    pub title: Option<String>,
    /// Labels of the methods that figure is about; the others are grey. Empty: all of them.
    pub methods: Vec<String>,
    /// Stems of the figures that are made beside it; `None` for all there are.
    pub figures: Option<Vec<String>>,
    /// Values of axes that have a name.
    pub marks: Vec<AxisMark>,
    /// Titles of the cells whose errors are shown one by one.
    pub detail: Vec<String>,
}

/// A value of an axis with a name, such as the limit of a rule.
#[derive(Debug, Clone, PartialEq, Deserialize, Serialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct AxisMark {
    /// Name of the axis.
    pub axis: String,
    /// The value.
    pub at: f64,
    /// Its name.
    pub label: String,
}

impl Words {
    /// The words in the text of a scenario; a text that is none has no words.
    pub fn of(scenario: &str) -> Self {
        let document: Table = scenario.parse().unwrap_or_default();
        let text = |key: &str| document.get(key).and_then(Value::as_str).unwrap_or_default().to_owned();
        let output = |key: &str| document.get("output").and_then(|output| output.get(key));
        let list = |key: &str| {
            let names = output(key).and_then(Value::as_array)?.iter();
            Some(names.filter_map(Value::as_str).map(str::to_owned).collect::<Vec<String>>())
        };
        let marks = output("marks").and_then(Value::as_array).into_iter().flatten();
        Self {
            question: text("question"),
            analysis: text("analysis"),
            finding: text("finding"),
            figure: output("figure").and_then(Value::as_str).map(str::to_owned),
            title: output("title").and_then(Value::as_str).map(str::to_owned),
            methods: list("methods").unwrap_or_default(),
            figures: list("figures"),
            marks: marks.filter_map(|mark| mark.clone().try_into().ok()).collect(),
            detail: list("detail").unwrap_or_default(),
        }
    }
}
