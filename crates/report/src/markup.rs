//! Italic type inside a text: two marks around it, which measuring passes over and drawing turns into type.

/// Opens italic type inside a text (a character of the private-use area; [`crate::svg`] turns it into markup).
const ITALIC_ON: char = '\u{e000}';
/// Ends italic type.
const ITALIC_OFF: char = '\u{e001}';

/// `true` if a character is one of the two marks around italic type.
pub(crate) fn is_markup(c: char) -> bool {
    c == ITALIC_ON || c == ITALIC_OFF
}

/// A quantity symbol, set in italic as ISO 80000-1 wants it: for titles and labels of figures, not for tables.
pub fn symbol(text: &str) -> String {
    format!("{ITALIC_ON}{text}{ITALIC_OFF}")
}

/// Splits a text into runs of upright and italic type.
pub(crate) fn runs(text: &str) -> Vec<(bool, &str)> {
    let mut italic = false;
    let mut runs = Vec::new();
    for piece in text.split_inclusive(is_markup) {
        let visible = piece.trim_end_matches(is_markup);
        if !visible.is_empty() {
            runs.push((italic, visible));
        }
        italic = piece.ends_with(ITALIC_ON);
    }
    runs
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn italics_are_split() {
        assert_eq!(runs(&format!("rate {} [°/s]", symbol("r"))), [(false, "rate "), (true, "r"), (false, " [°/s]")]);
        assert_eq!(runs("\u{e001}a\u{e000}"), [(false, "a")]);
    }
}
