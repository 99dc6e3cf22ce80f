//! Position of a key in a scenario file, so that an error can point at its line.

use std::ops::Range;

use toml::de::{DeArray, DeTable, DeValue};

use crate::scenario::problem::{FaultMark, KeyPath};

/// Byte range of the name or value at a path; otherwise of the nearest existing key above it; otherwise of the first
/// line with content.
///
/// A table or list is located by its name, since its range may be pages long.
pub fn key_span(text: &str, path: &KeyPath, mark: FaultMark) -> Range<usize> {
    let nowhere = first_line(text);
    let Ok(document) = DeTable::parse(text) else { return nowhere };
    let mut place = nowhere;
    let mut table = Some(document.get_ref());
    let mut array: Option<&DeArray> = None;
    let last = path.names().len().wrapping_sub(1);
    for (depth, part) in path.names().iter().enumerate() {
        let value = match (table, array) {
            (Some(table), _) => {
                table.iter().find(|(key, _)| key.get_ref() == part).map(|(key, value)| (key.span(), value))
            }
            (None, Some(array)) => {
                part.parse().ok().and_then(|index: usize| array.get(index)).map(|value| (value.span(), value))
            }
            (None, None) => None,
        };
        let Some((key_span, value)) = value else { break };
        (table, array) = match value.get_ref() {
            DeValue::Table(inner) => (Some(inner), None),
            DeValue::Array(inner) => (None, Some(inner)),
            _ => (None, None),
        };
        let by_name = table.is_some() || array.is_some() || (depth == last && mark == FaultMark::Name);
        place = match (mark, value.get_ref()) {
            _ if by_name => key_span,
            (FaultMark::Within(at), DeValue::String(content)) if depth == last => {
                within(text, value.span(), content, at)
            }
            _ => value.span(),
        };
    }
    place
}

/// Range of the character after `at` characters of a quoted text; the whole text if it contains escapes.
fn within(text: &str, quoted: Range<usize>, content: &str, at: usize) -> Range<usize> {
    let Some(start) = text[quoted.clone()].find(content) else { return quoted };
    let from = quoted.start + start + content.chars().take(at).map(char::len_utf8).sum::<usize>();
    from..from + text[from..].chars().next().map_or(0, char::len_utf8)
}

/// Range of the first line that is neither empty nor a comment.
fn first_line(text: &str) -> Range<usize> {
    let mut start = 0;
    for line in text.split_inclusive('\n') {
        let content = line.trim_end();
        if !content.is_empty() && !content.starts_with('#') {
            return start..start + content.len();
        }
        start += line.len();
    }
    0..0
}

#[cfg(test)]
mod tests {
    use super::*;

    const TEXT: &str = "# note\nseed = 1\n[sensor]\nheading-noise-deg = -0.1\n[[identifier]]\nsrivc = {}\n[[identifier]]\nlabel = \"x\"\n\
         [[sweep]]\npoints = [{ set = { \"a.b\" = 3 } }]\n";

    fn at(path: &str, mark: FaultMark) -> &str {
        &TEXT[key_span(TEXT, &KeyPath::from_dotted(path), mark)]
    }

    #[test]
    fn finds_names_and_values_in_tables_and_lists() {
        assert_eq!(at("sensor.heading-noise-deg", FaultMark::Value), "-0.1");
        assert_eq!(at("sensor.heading-noise-deg", FaultMark::Name), "heading-noise-deg");
        assert_eq!(at("identifier.1.label", FaultMark::Value), "\"x\"");
        let swept = KeyPath::from_dotted("sweep.0.points.0.set").child("a.b");
        assert_eq!(&TEXT[key_span(TEXT, &swept, FaultMark::Value)], "3");
        assert_eq!(&TEXT[key_span(TEXT, &swept, FaultMark::Name)], "\"a.b\"");
    }

    #[test]
    fn finds_a_letter_of_a_text() {
        let marked = |text: &str, at: usize| {
            let span = key_span(text, &KeyPath::from_dotted("effect.0.formula"), FaultMark::Within(at));
            (span.start, text[span].to_owned())
        };
        assert_eq!(marked("[[effect]]\nformula = \"é = c * x\"\n", 8), (31, String::from("x")));
        assert_eq!(marked("effect = [{ formula = 'c *' }]\n", 3), (26, String::from("'")));
        assert_eq!(marked("[[effect]]\nformula = \"c\\u002a\"\n", 1).1, "\"c\\u002a\"");
    }

    #[test]
    fn falls_back_to_the_nearest_key_above() {
        assert_eq!(at("sensor.no-such-key", FaultMark::Value), "sensor");
        assert_eq!(at("nothing.here", FaultMark::Value), "seed = 1");
        assert_eq!(key_span("", &KeyPath::default(), FaultMark::Name), 0..0);
    }
}
