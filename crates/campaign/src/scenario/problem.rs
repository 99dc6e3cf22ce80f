//! What is wrong with a scenario, as data: the key, what was found, what was expected and what to do. Where the key
//! stands in the file is found in `locate`; the words of a parser never reach the user.

use std::fmt;

use simulate::SpecificationError;

use crate::scenario::name::{Unfit, shown};

/// Path of a key from the root of a scenario; entries of a list are counted from 0, as a sweep addresses them.
#[derive(Debug, Clone, PartialEq, Eq, Hash, Default)]
pub struct KeyPath(Vec<String>);

impl KeyPath {
    /// A path written with dots ("sensor.heading-noise-deg").
    pub fn dotted(path: &str) -> Self {
        Self(path.split('.').filter(|part| !part.is_empty()).map(str::to_owned).collect())
    }

    /// The path of a key below this one; `part` is one name, even when it holds dots.
    pub fn child(&self, part: impl ToString) -> Self {
        Self(self.0.iter().cloned().chain([part.to_string()]).collect())
    }

    /// The names from the root on.
    pub fn parts(&self) -> &[String] {
        &self.0
    }

    /// The last name; empty at the root.
    pub fn last(&self) -> &str {
        self.0.last().map_or("", String::as_str)
    }

    /// The path of the table this key stands in.
    pub fn above(&self) -> Self {
        Self(self.0[..self.0.len().saturating_sub(1)].to_vec())
    }

    /// Whether one of the two paths leads to the other.
    pub fn is_related(&self, other: &Self) -> bool {
        self.0.starts_with(&other.0) || other.0.starts_with(&self.0)
    }
}

impl fmt::Display for KeyPath {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0.join("."))
    }
}

/// What is underlined.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum AtFault {
    /// The name of the key.
    Name,
    /// Its value.
    Value,
    /// The text that is its value, after so many characters.
    Within(usize),
}

/// Something wrong with a scenario.
#[derive(Debug, Clone, PartialEq)]
pub struct KeyFault {
    /// The key at fault.
    pub key: KeyPath,
    /// Whether its name or its value is at fault.
    pub mark: AtFault,
    /// The key and the value found, in one sentence.
    pub found: String,
    /// What was expected, to stand below the place.
    pub expected: String,
    /// What to do.
    pub advice: String,
}

impl KeyFault {
    /// A value at fault.
    pub fn value(
        key: KeyPath,
        found: impl Into<String>,
        expected: impl Into<String>,
        advice: impl Into<String>,
    ) -> Self {
        Self { key, mark: AtFault::Value, found: found.into(), expected: expected.into(), advice: advice.into() }
    }

    /// The text that is the value of a key, at fault after `at` characters.
    pub fn within(
        at: usize,
        key: KeyPath,
        found: impl Into<String>,
        expected: impl Into<String>,
        advice: impl Into<String>,
    ) -> Self {
        Self { mark: AtFault::Within(at), ..Self::value(key, found, expected, advice) }
    }

    /// The value of a key, which is at fault.
    pub fn of(key: KeyPath, value: impl fmt::Display, expected: impl Into<String>, advice: impl Into<String>) -> Self {
        let found = format!("`{key}` is {value}");
        Self::value(key, found, expected, advice)
    }

    /// A key at fault.
    pub fn name(
        key: KeyPath,
        found: impl Into<String>,
        expected: impl Into<String>,
        advice: impl Into<String>,
    ) -> Self {
        Self { mark: AtFault::Name, ..Self::value(key, found, expected, advice) }
    }
}

impl From<SpecificationError> for KeyFault {
    fn from(error: SpecificationError) -> Self {
        let [found, expected, advice] = error.words();
        let mark = if error.is_of_name() { AtFault::Name } else { AtFault::Value };
        let key = match error.key {
            "vessel.dead_time" => "effect",
            // No scenario sets these; only a manoeuvre can make them matter.
            "longest_wait" | "weather_grid" | "solver.step" => "manoeuvre",
            key => key,
        };
        Self { key: KeyPath::dotted(key), mark, found, expected, advice }
    }
}

/// The problem of a text that cannot be used.
pub fn of_text(key: KeyPath, text: &str, unfit: Unfit) -> KeyFault {
    KeyFault::of(key, shown(text), unfit.to_string(), "change the text")
}

/// The place of a name among those that are known; else what was `found` at its key, and what was `expected`.
pub fn place_among<S: AsRef<str>>(
    name: &str,
    known: &[S],
    key: KeyPath,
    [found, expected]: [&str; 2],
) -> Result<usize, KeyFault> {
    let place = known.iter().position(|own| own.as_ref() == name);
    place.ok_or_else(|| KeyFault::value(key, format!("{found} {name:?}"), expected, suggestion(name, known)))
}

/// The names in backquotes, joined by commas.
pub fn listed<S: AsRef<str>>(names: &[S]) -> String {
    names.iter().map(|name| format!("`{}`", name.as_ref())).collect::<Vec<_>>().join(", ")
}

/// "did you mean …" for a name that is nearly one of `known`, and else all that are known.
pub fn suggestion<S: AsRef<str>>(name: &str, known: &[S]) -> String {
    match nearest(name, known) {
        Some(meant) if known.len() == 1 => format!("did you mean `{meant}`?"),
        Some(meant) => format!("did you mean `{meant}`? Known here: {}", listed(known)),
        None => format!("use one of {}", listed(known)),
    }
}

/// The known name that is nearest to a misspelt one, if it is near: two letters of every five may differ, or one is the
/// beginning of the other (a forgotten unit).
fn nearest<'a, S: AsRef<str>>(name: &str, known: &'a [S]) -> Option<&'a str> {
    known
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
        let set = KeyPath::dotted("sweep.0.points.1.set").child("recording.sampling-s");
        assert_eq!(set.parts().len(), 6);
        assert_eq!(set.last(), "recording.sampling-s");
        assert!(KeyPath::dotted("a.b.c").is_related(&KeyPath::dotted("a.b")));
        assert!(!KeyPath::dotted("a.bc").is_related(&KeyPath::dotted("a.b")));
    }
}
