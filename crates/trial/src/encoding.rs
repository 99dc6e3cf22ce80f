//! Character encoding of a file.

use serde::Deserialize;

/// Character encoding of a table.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Deserialize, schemars::JsonSchema)]
pub enum Encoding {
    /// UTF-8, which includes ASCII; other lines are read as Windows code page 1252 if that gives letters.
    #[default]
    #[serde(rename = "utf-8")]
    Utf8,
    /// Windows code page 1252, the western European default of old Windows programs.
    #[serde(rename = "windows-1252")]
    Windows1252,
}

/// Characters of the bytes 0x80 to 0x9F in code page 1252; all other bytes are Latin-1. The five bytes undefined in
/// the page give the control character of the same number (Unicode, Inc., CP1252 table; WHATWG encoding standard).
const WINDOWS_1252: [char; 32] = [
    '€', '\u{81}', '‚', 'ƒ', '„', '…', '†', '‡', 'ˆ', '‰', 'Š', '‹', 'Œ', '\u{8d}', 'Ž', '\u{8f}', '\u{90}', '‘', '’',
    '“', '”', '•', '–', '—', '˜', '™', 'š', '›', 'œ', '\u{9d}', 'ž', 'Ÿ',
];

/// Character of a byte in Windows code page 1252.
pub(crate) fn windows_1252(byte: u8) -> char {
    match byte {
        0x80..=0x9f => WINDOWS_1252[usize::from(byte - 0x80)],
        _ => char::from(byte),
    }
}
