//! Names and labels given by users: characters allowed in a plot, a table, a page or a file name. They are checked on
//! input, so that later code can rely on them.

use std::path::Path;

use report::markdown::is_line_break_or_tab;
use report::printable::is_printable;

use crate::failure::Failure;

/// Maximum length of a label, characters.
pub const MAX_LABEL_CHARS: usize = 80;

/// Maximum length of a name, bytes, and of the labels of a cell together, characters. File names contain them together
/// with a prefix and an extension, within the 255 bytes of a file system.
pub const MAX_NAME_BYTES: usize = 180;

/// Reason why a text cannot be used; its message says what is expected.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum InvalidText {
    /// Empty or blank text.
    #[error("expected a text that is not blank")]
    Blank,
    /// Text that is too long.
    #[error("expected at most {most} characters, this text has {length}")]
    Long {
        /// Maximum number of characters, or of bytes of a file name.
        most: usize,
        /// Number of characters, or of bytes of a file name.
        length: usize,
    },
    /// Character that cannot be printed.
    #[error("expected characters that can be printed, this text holds {}", .0.escape_unicode())]
    Unprintable(char),
    /// Character that is reserved in paths or on some file systems.
    #[error("expected the name of a file, which has no `{0}`")]
    PathCharacter(char),
    /// First or last character that would hide the file or name a folder.
    #[error("expected the name of a file, which does not begin with a dot or a blank and does not end with one")]
    Ends,
}

/// Checks a label: one printable line.
pub fn check_label(text: &str) -> Result<(), InvalidText> {
    if text.trim().is_empty() {
        return Err(InvalidText::Blank);
    }
    let length = text.chars().count();
    if length > MAX_LABEL_CHARS {
        return Err(InvalidText::Long { most: MAX_LABEL_CHARS, length });
    }
    text.chars().find(|&c| !is_printable(c)).map_or(Ok(()), |c| Err(InvalidText::Unprintable(c)))
}

/// Checks a file name: it contains no path on any system.
pub fn check_file_name(text: &str) -> Result<(), InvalidText> {
    const ENDS: [char; 2] = ['.', ' '];
    if text.is_empty() {
        return Err(InvalidText::Blank);
    }
    if text.len() > MAX_NAME_BYTES {
        return Err(InvalidText::Long { most: MAX_NAME_BYTES, length: text.len() });
    }
    for c in text.chars() {
        match c {
            '/' | '\\' | '<' | '>' | ':' | '"' | '|' | '?' | '*' => return Err(InvalidText::PathCharacter(c)),
            c if !is_printable(c) => return Err(InvalidText::Unprintable(c)),
            _ => {}
        }
    }
    if text.starts_with(ENDS) || text.ends_with(ENDS) { Err(InvalidText::Ends) } else { Ok(()) }
}

/// Checks prose: any number of printable lines.
pub fn check_prose(text: &str) -> Result<(), InvalidText> {
    text.chars()
        .find(|&c| !is_printable(c) && !is_line_break_or_tab(c))
        .map_or(Ok(()), |c| Err(InvalidText::Unprintable(c)))
}

/// Study name from a file name, without the extension.
pub fn study_name(path: &Path) -> Result<String, Failure> {
    let name = path.file_stem().map(|stem| stem.to_string_lossy().into_owned()).unwrap_or_default();
    match check_file_name(&name) {
        Ok(()) => Ok(name),
        Err(unfit) => Err(Failure::input(format!(
            "{}: its results cannot be called {}; {unfit}; rename the file",
            path.display(),
            quoted_beginning(&name)
        ))),
    }
}

/// Title as part of a file name: lower case, words joined by hyphens.
pub fn slug(title: &str) -> String {
    let mut slug = String::new();
    for letter in title.chars() {
        match letter {
            letter if letter.is_ascii_alphanumeric() => slug.push(letter.to_ascii_lowercase()),
            _ if slug.ends_with('-') || slug.is_empty() => {}
            _ => slug.push('-'),
        }
    }
    slug.trim_end_matches('-').to_owned()
}

/// Beginning of a text in quotes, for messages.
pub fn quoted_beginning(text: &str) -> String {
    const SHOWN: usize = 40;
    match text.char_indices().nth(SHOWN) {
        None => format!("{text:?}"),
        Some((end, _)) => format!("{:?}…", &text[..end]),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_name_leads_nowhere_else() {
        for name in ["yukun", "船 10°", "zigzag_31-Jul-2020_13_57_45", "a.b", "-x", &"x".repeat(MAX_NAME_BYTES)] {
            assert_eq!(check_file_name(name), Ok(()), "{name}");
        }
        for name in
            ["", ".", "..", ".hidden", "a.", " a", "a ", "../a", "/a", "a/b", "a\\b", "C:a", "a?", "a\n", "\u{1b}"]
        {
            assert!(check_file_name(name).is_err(), "{name:?}");
        }
        assert!(check_file_name(&"x".repeat(MAX_NAME_BYTES + 1)).is_err());
    }

    #[test]
    fn a_label_is_one_line_that_can_be_printed() {
        for text in ["10/20, rudder ±0.5°", "T₂ 2.5 s", "K\u{302}", "<b> | =1", &"é".repeat(MAX_LABEL_CHARS)] {
            assert_eq!(check_label(text), Ok(()), "{text}");
        }
        for text in ["", "  ", "a\nb", "\0", "\u{1b}[31m", "\u{fffe}", "\u{202e}abc", "\u{e000}", "\u{200b}"] {
            assert!(check_label(text).is_err(), "{text:?}");
        }
        assert_eq!(check_label(&"é".repeat(81)), Err(InvalidText::Long { most: 80, length: 81 }));
        assert_eq!(check_prose("one\r\n\ttwo"), Ok(()));
        assert_eq!(check_prose("one\u{1b}"), Err(InvalidText::Unprintable('\u{1b}')));
    }

    #[test]
    fn slugs_are_file_names() {
        assert_eq!(slug("10/20 (published reading)"), "10-20-published-reading");
        assert_eq!(slug(""), "");
    }
}
