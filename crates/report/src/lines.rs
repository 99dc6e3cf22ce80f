//! Text broken into lines of a given width.

use crate::fonts::text_width;

/// Line spacing of legends and remarks, in font sizes.
pub(crate) const LEADING: f64 = 1.35;

/// Lines of [`wrap`], as equal in length as possible without breaking a word.
pub(crate) fn balanced(text: &str, size: f64, bold: bool, width: f64) -> Vec<String> {
    let widest = wrap(text, size, bold, width);
    let mut narrower = (5..20).map(|twentieths| wrap(text, size, bold, 0.05 * f64::from(twentieths) * width));
    let is_whole = |lines: &Vec<String>| lines.len() == widest.len() && lines.join(" ") == widest.join(" ");
    narrower.find(is_whole).unwrap_or(widest)
}

/// Words of a text; a unit in brackets is one word.
fn unbroken_parts(text: &str) -> Vec<String> {
    let mut parts: Vec<String> = Vec::new();
    // Only at plain spaces: a no-break space keeps a symbol and its value together.
    for word in text.split(' ').filter(|word| !word.is_empty()) {
        match parts.last_mut().filter(|last| last.starts_with('[') && !last.contains(']')) {
            Some(unit) => *unit = format!("{unit} {word}"),
            None => parts.push(word.to_owned()),
        }
    }
    parts
}

/// Lines of a text split at (breaking) spaces, at most `width` points each; a unit in brackets and a per cent sign stay
/// with the word before them. A longer word is broken, after a mark such as a dot if it has one.
pub(crate) fn wrap(text: &str, size: f64, bold: bool, width: f64) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    let mut parts = unbroken_parts(text).into_iter().peekable();
    while let Some(word) = parts.next() {
        let unit = parts.peek().filter(|next| next.starts_with(['[', '%']));
        let with_unit = unit.map(|unit| format!("{word} {unit}")).filter(|both| text_width(both, size, bold) <= width);
        if with_unit.is_some() {
            parts.next();
        }
        let word = with_unit.as_deref().unwrap_or(&word);
        let longer = lines.last().map(|line| format!("{line} {word}"));
        match longer.filter(|line| text_width(line, size, bold) <= width) {
            Some(line) => *lines.last_mut().expect("a longer line extends one that is there") = line,
            None => lines.extend(broken(word, size, bold, width)),
        }
    }
    lines
}

/// Word in several lines if it is too long for one. A word stays whole if not even a letter fits.
fn broken(word: &str, size: f64, bold: bool, width: f64) -> Vec<String> {
    let (mut lines, mut remaining) = (Vec::new(), word);
    while text_width(remaining, size, bold) > width {
        let ends = remaining.char_indices().map(|(start, letter)| start + letter.len_utf8());
        let fitting: Vec<usize> = ends.take_while(|end| text_width(&remaining[..*end], size, bold) <= width).collect();
        let after_mark = fitting.iter().rev().find(|end| remaining[..**end].ends_with(['.', '-', '_', '/']));
        let Some(end) = after_mark.or(fitting.last()) else { break };
        lines.push(remaining[..*end].to_owned());
        remaining = &remaining[*end..];
    }
    lines.push(remaining.to_owned());
    lines
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn text_wraps_at_spaces_and_long_words_are_broken() {
        assert_eq!(wrap("one two three", 10.0, false, 45.0), ["one two", "three"]);
        assert_eq!(wrap("sample time [s]", 10.0, false, 60.0), ["sample", "time [s]"]);
        assert_eq!(wrap("Bars: 95 % intervals", 10.0, false, 50.0), ["Bars:", "95 %", "intervals"]);
        assert_eq!(wrap("indivisible", 10.0, false, 1.0), ["indivisible"]);
        assert_eq!(wrap("a ship.first-order.T-s", 10.0, false, 60.0), ["a", "ship.first-", "order.T-s"]);
        assert_eq!(wrap("mmmmmm", 10.0, false, 30.0), ["mmm", "mmm"]);
        assert_eq!(wrap("moment [° rudder]", 10.0, false, 60.0), ["moment", "[° rudder]"]);
        assert_eq!(wrap("one two three four", 10.0, false, 75.0), ["one two three", "four"]);
        assert_eq!(balanced("one two three four", 10.0, false, 75.0), ["one two", "three four"]);
        assert_eq!(balanced("aa extraordinarily", 10.0, false, 88.0), ["aa", "extraordinarily"]);
        assert!(wrap("  ", 10.0, false, 5.0).is_empty() && balanced("", 10.0, false, 5.0).is_empty());
    }
}
