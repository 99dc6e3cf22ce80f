//! Faults of a scenario as data: the key, the problem, the expected value and the remedy. `locate` finds the position
//! of the key in the file; messages of parsers never reach the user.

use std::fmt;

use simulate::SpecificationError;

use crate::scenario::name::{InvalidText, quoted_beginning};

/// Path of a key from the root of a scenario; list entries count from 0.
#[derive(Debug, Clone, PartialEq, Eq, Hash, Default)]
pub struct KeyPath(Vec<String>);

impl KeyPath {
    /// Path from dotted text, such as "sensor.heading-noise-deg".
    pub fn from_dotted(path: &str) -> Self {
        Self(path.split('.').filter(|part| !part.is_empty()).map(str::to_owned).collect())
    }

    /// Path of a key below this one; `part` is one name, even if it contains dots.
    pub fn child(&self, part: impl ToString) -> Self {
        Self(self.0.iter().cloned().chain([part.to_string()]).collect())
    }

    /// Names from the root on.
    pub fn names(&self) -> &[String] {
        &self.0
    }

    /// Last name; empty at the root.
    pub fn last(&self) -> &str {
        self.0.last().map_or("", String::as_str)
    }

    /// Path of the table that contains the key.
    pub fn parent(&self) -> Self {
        Self(self.0[..self.0.len().saturating_sub(1)].to_vec())
    }

    /// `true` if one path is a prefix of the other.
    pub fn is_related(&self, other: &Self) -> bool {
        self.0.starts_with(&other.0) || other.0.starts_with(&self.0)
    }
}

impl fmt::Display for KeyPath {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0.join("."))
    }
}

/// Underlined part of a faulty key.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FaultMark {
    /// Name of the key.
    Name,
    /// Value of the key.
    Value,
    /// Character of a text value, by its index from 0.
    Within(usize),
}

/// Fault of a scenario at a key.
#[derive(Debug, Clone, PartialEq)]
pub struct KeyFault {
    /// Faulty key.
    pub key: KeyPath,
    /// Part of key or value that the message underlines.
    pub mark: FaultMark,
    /// Problem, with key and value, in one sentence.
    pub problem: String,
    /// Expected text, printed below the underlined part.
    pub expected: String,
    /// Advice on how to correct the fault.
    pub advice: String,
}

impl KeyFault {
    /// Fault that underlines the value of a key.
    pub fn value(
        key: KeyPath,
        problem: impl Into<String>,
        expected: impl Into<String>,
        advice: impl Into<String>,
    ) -> Self {
        Self { key, mark: FaultMark::Value, problem: problem.into(), expected: expected.into(), advice: advice.into() }
    }

    /// Fault that underlines one character of a text value, by its index `at` from 0.
    pub fn within_text(
        at: usize,
        key: KeyPath,
        problem: impl Into<String>,
        expected: impl Into<String>,
        advice: impl Into<String>,
    ) -> Self {
        Self { mark: FaultMark::Within(at), ..Self::value(key, problem, expected, advice) }
    }

    /// Fault of a value, with the problem "`key` is VALUE".
    pub fn new(key: KeyPath, value: impl fmt::Display, expected: impl Into<String>, advice: impl Into<String>) -> Self {
        let problem = format!("`{key}` is {value}");
        Self::value(key, problem, expected, advice)
    }

    /// Fault that underlines the name of a key.
    pub fn name(
        key: KeyPath,
        problem: impl Into<String>,
        expected: impl Into<String>,
        advice: impl Into<String>,
    ) -> Self {
        Self { mark: FaultMark::Name, ..Self::value(key, problem, expected, advice) }
    }
}

impl From<SpecificationError> for KeyFault {
    fn from(error: SpecificationError) -> Self {
        let [problem, expected, advice] = error.message_parts();
        let mark = if error.is_about_key() { FaultMark::Name } else { FaultMark::Value };
        let key = match error.key {
            "vessel.dead_time" => "effect",
            // No scenario sets these; they matter for some manoeuvres only.
            "longest_wait" | "weather_cell_width" | "solver.step" => "manoeuvre",
            key => key,
        };
        Self { key: KeyPath::from_dotted(key), mark, problem, expected, advice }
    }
}

/// Fault of an unusable text.
pub fn text_fault(key: KeyPath, text: &str, unfit: InvalidText) -> KeyFault {
    KeyFault::new(key, quoted_beginning(text), unfit.to_string(), "change the text")
}

/// Index of a name among `choices`; otherwise a fault with `problem`, `expected` and a suggestion.
pub fn choice_index<S: AsRef<str>>(
    name: &str,
    choices: &[S],
    key: KeyPath,
    [problem, expected]: [&str; 2],
) -> Result<usize, KeyFault> {
    let place = choices.iter().position(|choice| choice.as_ref() == name);
    place.ok_or_else(|| KeyFault::value(key, format!("{problem} {name:?}"), expected, suggestion(name, choices)))
}

/// Names in backquotes, joined by commas.
pub fn backquoted_list<S: AsRef<str>>(names: &[S]) -> String {
    names.iter().map(|name| format!("`{}`", name.as_ref())).collect::<Vec<_>>().join(", ")
}

/// Advice for an unknown name: "did you mean …" for a similar choice, and the list of all choices.
pub fn suggestion<S: AsRef<str>>(name: &str, choices: &[S]) -> String {
    match nearest(name, choices) {
        Some(meant) if choices.len() == 1 => format!("did you mean `{meant}`?"),
        Some(meant) => format!("did you mean `{meant}`? Known here: {}", backquoted_list(choices)),
        None => format!("use one of {}", backquoted_list(choices)),
    }
}

/// Choice nearest to a misspelt name by edit distance (Levenshtein 1966), if at most two of five characters differ or
/// one is a prefix of the other, as with a forgotten unit.
fn nearest<'a, S: AsRef<str>>(name: &str, choices: &'a [S]) -> Option<&'a str> {
    choices
        .iter()
        .map(AsRef::as_ref)
        .map(|candidate| {
            let forgotten = name.len() > 2 && (candidate.starts_with(name) || name.starts_with(candidate));
            (if forgotten { 1 } else { strsim::levenshtein(name, candidate) }, candidate)
        })
        .min_by_key(|&(distance, _)| distance)
        .filter(|&(distance, candidate)| 5 * distance <= 2 * candidate.chars().count())
        .map(|(_, candidate)| candidate)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn paths_keep_dots_in_names() {
        let set = KeyPath::from_dotted("sweep.0.points.1.set").child("recording.sampling-s");
        assert_eq!(set.names().len(), 6);
        assert_eq!(set.last(), "recording.sampling-s");
        assert!(KeyPath::from_dotted("a.b.c").is_related(&KeyPath::from_dotted("a.b")));
        assert!(!KeyPath::from_dotted("a.bc").is_related(&KeyPath::from_dotted("a.b")));
    }
}
