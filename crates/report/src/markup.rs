//! Italic type inside a text: two marks around it, ignored in measuring and converted to type in drawing.

/// Start mark of italic type inside a text (a character of the private-use area; [`crate::backend`] turns it into
/// markup).
const ITALIC_ON: char = '\u{e000}';
/// End mark of italic type.
const ITALIC_OFF: char = '\u{e001}';

/// `true` if a character is one of the two marks around italic type.
pub(crate) fn is_markup(c: char) -> bool {
    c == ITALIC_ON || c == ITALIC_OFF
}

/// Quantity symbol, set in italic as ISO 80000-1 requires: for titles and labels of figures, not for tables.
pub fn symbol(text: &str) -> String {
    format!("{ITALIC_ON}{text}{ITALIC_OFF}")
}

/// Runs of upright and italic type of a text without the marks, each with `true` if it is italic.
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
