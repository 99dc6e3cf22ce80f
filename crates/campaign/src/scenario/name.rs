//! Names and labels as users give them: what may stand in a figure, a table, a page or the name of a file. They are
//! checked where they enter, so that nothing behind has to look again.

use std::path::Path;

use report::markdown::is_layout;
use report::printable::is_printable;

use crate::failure::Failure;

/// Most characters of a label.
pub const LONGEST_LABEL: usize = 80;

/// Most characters of the labels of a cell together, and most bytes of a name. Names of files are made from them; with
/// what comes before and behind they have to stay within the 255 bytes of a file system.
pub const LONGEST_NAME: usize = 180;

/// Why a text cannot be used, as what was expected in its place.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum Unfit {
    /// There is nothing to read in it.
    #[error("expected a text that is not blank")]
    Blank,
    /// Too long.
    #[error("expected at most {most} characters, this text has {found}")]
    Long {
        /// Most characters.
        most: usize,
        /// Characters found.
        found: usize,
    },
    /// Something that cannot be seen.
    #[error("expected characters that can be printed, this text holds {}", .0.escape_unicode())]
    Unprintable(char),
    /// A character that paths are made of, or that some file systems keep for themselves.
    #[error("expected the name of a file, which has no `{0}`")]
    OfPaths(char),
    /// It would be hidden, or mean a folder.
    #[error("expected the name of a file, which does not begin with a dot or a blank and does not end with one")]
    Ends,
}

/// Checks a label: one line that can be printed.
pub fn label(text: &str) -> Result<(), Unfit> {
    if text.trim().is_empty() {
        return Err(Unfit::Blank);
    }
    let found = text.chars().count();
    if found > LONGEST_LABEL {
        return Err(Unfit::Long { most: LONGEST_LABEL, found });
    }
    text.chars().find(|&c| !is_printable(c)).map_or(Ok(()), |c| Err(Unfit::Unprintable(c)))
}

/// Checks a name that files or folders are called by: it leads nowhere else, on any system.
pub fn file(text: &str) -> Result<(), Unfit> {
    const ENDS: [char; 2] = ['.', ' '];
    if text.is_empty() {
        return Err(Unfit::Blank);
    }
    if text.len() > LONGEST_NAME {
        return Err(Unfit::Long { most: LONGEST_NAME, found: text.len() });
    }
    for c in text.chars() {
        match c {
            '/' | '\\' | '<' | '>' | ':' | '"' | '|' | '?' | '*' => return Err(Unfit::OfPaths(c)),
            c if !is_printable(c) => return Err(Unfit::Unprintable(c)),
            _ => {}
        }
    }
    if text.starts_with(ENDS) || text.ends_with(ENDS) { Err(Unfit::Ends) } else { Ok(()) }
}

/// Checks prose: any number of lines that can be printed.
pub fn prose(text: &str) -> Result<(), Unfit> {
    text.chars().find(|&c| !is_printable(c) && !is_layout(c)).map_or(Ok(()), |c| Err(Unfit::Unprintable(c)))
}

/// The name that a file gives to what is made from it: its own, without the extension.
pub fn of_file(path: &Path) -> Result<String, Failure> {
    let name = path.file_stem().map(|stem| stem.to_string_lossy().into_owned()).unwrap_or_default();
    match file(&name) {
        Ok(()) => Ok(name),
        Err(unfit) => Err(Failure::input(format!(
            "{}: its results cannot be called {}; {unfit}; rename the file",
            path.display(),
            shown(&name)
        ))),
    }
}

/// A title as part of a file name: lower case, words joined by hyphens.
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

/// The beginning of a text for messages, in quotes.
pub fn shown(text: &str) -> String {
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
        for name in ["yukun", "船 10°", "zigzag_31-Jul-2020_13_57_45", "a.b", "-x", &"x".repeat(LONGEST_NAME)] {
            assert_eq!(file(name), Ok(()), "{name}");
        }
        for name in
            ["", ".", "..", ".hidden", "a.", " a", "a ", "../a", "/a", "a/b", "a\\b", "C:a", "a?", "a\n", "\u{1b}"]
        {
            assert!(file(name).is_err(), "{name:?}");
        }
        assert!(file(&"x".repeat(LONGEST_NAME + 1)).is_err());
    }

    #[test]
    fn a_label_is_one_line_that_can_be_printed() {
        for text in ["10/20, rudder ±0.5°", "T₂ 2.5 s", "K\u{302}", "<b> | =1", &"é".repeat(LONGEST_LABEL)] {
            assert_eq!(label(text), Ok(()), "{text}");
        }
        for text in ["", "  ", "a\nb", "\0", "\u{1b}[31m", "\u{fffe}", "\u{202e}abc", "\u{e000}", "\u{200b}"] {
            assert!(label(text).is_err(), "{text:?}");
        }
        assert_eq!(label(&"é".repeat(81)), Err(Unfit::Long { most: 80, found: 81 }));
        assert_eq!(prose("one\r\n\ttwo"), Ok(()));
        assert_eq!(prose("one\u{1b}"), Err(Unfit::Unprintable('\u{1b}')));
    }

    #[test]
    fn slugs_are_file_names() {
        assert_eq!(slug("10/20 (published reading)"), "10-20-published-reading");
        assert_eq!(slug(""), "");
    }
}
