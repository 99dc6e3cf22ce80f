//! What a scenario says about itself: question, findings, and which figures stand for it. None of it decides a row.

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
    /// Titles of the cells whose errors are shown one by one.
    pub detail: Vec<String>,
}

impl Words {
    /// The words in the text of a scenario; a text that is none has no words.
    pub fn of(scenario: &str) -> Self {
        let document: Table = scenario.parse().unwrap_or_default();
        let text = |key: &str| document.get(key).and_then(Value::as_str).unwrap_or_default().to_owned();
        let output = |key: &str| document.get("output").and_then(|output| output.get(key));
        let titles = output("detail").and_then(Value::as_array).into_iter().flatten();
        Self {
            question: text("question"),
            analysis: text("analysis"),
            finding: text("finding"),
            figure: output("figure").and_then(Value::as_str).map(str::to_owned),
            detail: titles.filter_map(Value::as_str).map(str::to_owned).collect(),
        }
    }
}
