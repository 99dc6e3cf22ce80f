//! Where in a scenario file a key stands, so that a semantic error can point at its line.

use std::ops::Range;

use toml::de::{DeArray, DeTable, DeValue};

/// Byte range of the value at a dotted path ("sensor.heading-noise-deg", "identifier.2.label"), or of the nearest key above it that
/// exists; the whole first line when there is none.
pub fn span(text: &str, path: &str) -> Range<usize> {
    let nowhere = 0..text.find('\n').unwrap_or(text.len());
    let Ok(document) = DeTable::parse(text) else { return nowhere };
    let mut place = nowhere;
    let mut table = Some(document.get_ref());
    let mut array: Option<&DeArray> = None;
    for part in path.split('.') {
        let value = match (table, array) {
            (Some(table), _) => table.iter().find(|(key, _)| key.get_ref() == part).map(|(key, value)| (key.span(), value)),
            (None, Some(array)) => part.parse().ok().and_then(|index: usize| array.get(index)).map(|value| (value.span(), value)),
            (None, None) => None,
        };
        let Some((key_span, value)) = value else { break };
        (table, array) = match value.get_ref() {
            DeValue::Table(inner) => (Some(inner), None),
            DeValue::Array(inner) => (None, Some(inner)),
            _ => (None, None),
        };
        // A scalar is underlined itself; a table by its key, since its own span may be pages long.
        place = if table.is_some() || array.is_some() { key_span } else { value.span() };
    }
    place
}

#[cfg(test)]
mod tests {
    use super::span;

    const TEXT: &str = "seed = 1\n[sensor]\nheading-noise-deg = -0.1\n[[identifier]]\nsrivc = {}\n[[identifier]]\nlabel = \"x\"\n";

    #[test]
    fn finds_values_in_tables_and_arrays() {
        assert_eq!(&TEXT[span(TEXT, "sensor.heading-noise-deg")], "-0.1");
        assert_eq!(&TEXT[span(TEXT, "identifier.1.label")], "\"x\"");
    }

    #[test]
    fn falls_back_to_the_nearest_key_above() {
        assert_eq!(&TEXT[span(TEXT, "sensor.no-such-key")], "sensor");
        assert_eq!(&TEXT[span(TEXT, "nothing.here")], "seed = 1");
    }
}
