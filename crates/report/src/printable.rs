//! Printable characters. All others (control characters, marks that reverse the direction of writing, unassigned and
//! private characters) are written as escapes, so that no text from outside can act on a terminal or corrupt a file.

use std::borrow::Cow;

/// `true` if a character is visible, sets an accent or is a blank. Line breaks and tabs are not.
pub fn is_printable(c: char) -> bool {
    match c {
        ' '..='~' => true,
        '\u{2028}' | '\u{2029}' => false,
        _ if c.is_whitespace() => !c.is_control(),
        // Characters that Rust escapes in debug output are invisible; after a letter it leaves accents unchanged.
        _ => c.escape_debug().len() == 1 || ['a', c].iter().collect::<String>().escape_debug().count() == 2,
    }
}

/// Text with escapes such as `\u{1b}` for characters that are not printable.
pub fn escaped(text: &str) -> Cow<'_, str> {
    if text.chars().all(is_printable) {
        return Cow::Borrowed(text);
    }
    let mut shown = String::with_capacity(text.len() + 8);
    for c in text.chars() {
        if is_printable(c) { shown.push(c) } else { shown.extend(c.escape_default()) }
    }
    Cow::Owned(shown)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn letters_of_all_scripts_are_shown_and_nothing_acts() {
        for text in ["K̂ ± 0.1 °, δ_r ψ̇ T₂ 10⁻³", "船 10°\u{3000}\u{a0}", "'\"\\", "\u{1f6a2}"] {
            assert_eq!(escaped(text), text);
        }
        assert_eq!(escaped("\u{1b}[31mred\u{7}\n\t\0"), "\\u{1b}[31mred\\u{7}\\n\\t\\u{0}");
        assert_eq!(escaped("a\u{202e}b\u{2066}\u{feff}\u{200b}"), "a\\u{202e}b\\u{2066}\\u{feff}\\u{200b}");
        assert_eq!(escaped("\u{fffe}\u{e000}\u{85}\u{2028}"), "\\u{fffe}\\u{e000}\\u{85}\\u{2028}");
    }
}
