//! One line of a table into its cells: the separators, how the separator of a file is recognised, and what counts as a
//! number. It knows nothing of channels.

use std::ops::Range;

use serde::Deserialize;

/// What stands between two cells of a line.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Separator {
    /// A tab; two in a row enclose an empty cell.
    Tab,
    /// A semicolon.
    Semicolon,
    /// A comma.
    Comma,
    /// Any run of blanks and tabs; empty cells cannot be written.
    Blank,
}

impl Separator {
    /// All separators, the one hardest to meet by accident first.
    pub const ALL: [Separator; 4] = [Separator::Tab, Separator::Semicolon, Separator::Comma, Separator::Blank];

    fn is(self, character: char) -> bool {
        match self {
            Separator::Tab => character == '\t',
            Separator::Semicolon => character == ';',
            Separator::Comma => character == ',',
            Separator::Blank => character.is_whitespace(),
        }
    }

    /// Puts the byte ranges of the cells of `line` into `cells`, without blanks and quotes around them.
    ///
    /// A cell in double quotes may hold the separator; a doubled quote inside stays doubled (see `unquoted`).
    pub fn split(self, line: &str, cells: &mut Vec<Range<usize>>) {
        cells.clear();
        if !self.split_plain(line.as_bytes(), cells) {
            cells.clear();
            self.split_any(line, cells);
        }
    }

    /// Splits a line of ASCII characters without quotes; `false` for any other line, with `cells` half filled.
    fn split_plain(self, line: &[u8], cells: &mut Vec<Range<usize>>) -> bool {
        let mark = match self {
            Separator::Tab => b'\t',
            Separator::Semicolon => b';',
            Separator::Comma => b',',
            Separator::Blank => b' ',
        };
        let is_blank = |byte: u8| matches!(byte, b' ' | b'\t'..=b'\r');
        let is_end = |byte: u8| byte == mark || (self == Separator::Blank && is_blank(byte));
        let mut at = 0;
        loop {
            while at < line.len() && is_blank(line[at]) && (self == Separator::Blank || line[at] != mark) {
                at += 1;
            }
            if self == Separator::Blank && at == line.len() {
                return true;
            }
            let begin = at;
            while at < line.len() && !is_end(line[at]) {
                if line[at] == b'"' || !line[at].is_ascii() {
                    return false;
                }
                at += 1;
            }
            let mut end = at;
            while end > begin && is_blank(line[end - 1]) {
                end -= 1;
            }
            cells.push(begin..end);
            if at == line.len() {
                return true;
            }
            at += 1;
        }
    }

    fn split_any(self, line: &str, cells: &mut Vec<Range<usize>>) {
        let mut start = 0;
        loop {
            let rest = &line[start..];
            let blanks = rest.len()
                - rest
                    .trim_start_matches(|c: char| c.is_whitespace() && (self == Separator::Blank || !self.is(c)))
                    .len();
            let begin = start + blanks;
            if self == Separator::Blank && begin == line.len() {
                return;
            }
            let quoted = line[begin..].starts_with('"').then(|| closing_quote(&line[begin + 1..])).flatten();
            let search = quoted.map_or(begin, |length| begin + 1 + length + 1);
            let end = line[search..].find(|c| self.is(c)).map(|at| search + at);
            let stop = end.unwrap_or(line.len());
            match quoted {
                Some(length) => cells.push(begin + 1..begin + 1 + length),
                None => cells.push(begin..begin.max(begin + line[begin..stop].trim_end().len())),
            }
            let Some(end) = end else { return };
            start = end + line[end..].chars().next().map_or(1, char::len_utf8);
        }
    }
}

/// Length of the text before the quote that ends a quoted cell; doubled quotes do not end it.
fn closing_quote(text: &str) -> Option<usize> {
    let bytes = text.as_bytes();
    let mut at = 0;
    while at < bytes.len() {
        if bytes[at] == b'"' {
            if bytes.get(at + 1) != Some(&b'"') {
                return Some(at);
            }
            at += 1;
        }
        at += 1;
    }
    None
}

/// The text of a cell that stood in quotes, with doubled quotes made single.
pub fn unquoted(cell: &str) -> String {
    cell.replace("\"\"", "\"")
}

/// The separator whose cells make most sense: the highest `score`, and the earlier of [`Separator::ALL`] on a tie.
///
/// Where nothing scores, the first separator that occurs in the line at all.
pub fn recognise(line: &str, score: impl Fn(&[&str]) -> usize) -> Separator {
    let mut ranges = Vec::new();
    let mut best = (0, 0, Separator::Blank);
    for separator in Separator::ALL {
        separator.split(line, &mut ranges);
        let cells: Vec<&str> = ranges.iter().map(|range| &line[range.clone()]).collect();
        let several = usize::from(cells.len() > 1);
        let candidate = (score(&cells), several, separator);
        if (candidate.0, candidate.1) > (best.0, best.1) {
            best = candidate;
        }
    }
    best.2
}

/// What a cell holds.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Cell {
    /// A finite number.
    Number(f64),
    /// A finite number written with a decimal comma.
    CommaNumber(f64),
    /// Nothing, or one of the usual words for nothing.
    Missing,
    /// Anything else.
    Text,
}

impl Cell {
    /// The number, however it is written.
    pub fn number(self) -> Option<f64> {
        match self {
            Self::Number(value) | Self::CommaNumber(value) => Some(value),
            Self::Missing | Self::Text => None,
        }
    }
}

/// The value of digits with a point or without, correctly rounded; `None` for every other text and for so many digits
/// that it takes more than one division of two exact numbers (Clinger 1990).
pub(crate) fn plain_number(text: &[u8]) -> Option<f64> {
    const POWERS: [f64; 19] =
        [1e0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9, 1e10, 1e11, 1e12, 1e13, 1e14, 1e15, 1e16, 1e17, 1e18];
    let (negative, digits) = match text {
        [b'-', rest @ ..] => (true, rest),
        rest => (false, rest),
    };
    if digits.is_empty() || digits.len() > 18 {
        return None;
    }
    let (mut whole, mut decimals, mut point) = (0u64, 0, false);
    for &byte in digits {
        match byte {
            b'0'..=b'9' => {
                whole = 10 * whole + u64::from(byte - b'0');
                decimals += usize::from(point);
            }
            b'.' if !point => point = true,
            _ => return None,
        }
    }
    if whole > 1 << 53 || digits.len() == usize::from(point) {
        return None;
    }
    let value = whole as f64 / POWERS[decimals];
    Some(if negative { -value } else { value })
}

/// Reads a cell; a decimal comma is understood, between commas in quotes only.
///
/// Missing are the empty cell, `NaN`, `NA`, `N/A`, `null`, `none` and `-`, in any case. `inf` is text: no instrument
/// shows it. Exponents may be written with `D` (Fortran).
pub fn cell(text: &str, separator: Separator) -> Cell {
    if let Some(value) = plain_number(text.as_bytes()) {
        return Cell::Number(value);
    }
    match text.parse::<f64>() {
        Ok(value) if value.is_finite() => return Cell::Number(value),
        Ok(value) if value.is_nan() => return Cell::Missing,
        Ok(_) => return Cell::Text,
        Err(_) => {}
    }
    const NOTHING: [&str; 6] = ["", "na", "n/a", "null", "none", "-"];
    if NOTHING.iter().any(|word| text.eq_ignore_ascii_case(word)) {
        return Cell::Missing;
    }
    // Only digits, signs, one mark and an exponent: a word like "nand" must not become a number by replacing letters.
    if text.len() > 40 || !text.bytes().all(|byte| byte.is_ascii_digit() || b"+-.,eEdD".contains(&byte)) {
        return Cell::Text;
    }
    let has_comma = text.contains(',');
    // Where commas separate the cells, this one stood in quotes: three digits after it may as well be thousands.
    let may_be_thousands = || separator == Separator::Comma && text.len() - text.find(',').unwrap_or(0) == 4;
    if has_comma && (text.contains('.') || may_be_thousands()) {
        return Cell::Text;
    }
    match text.replace(',', ".").replace(['d', 'D'], "e").parse::<f64>() {
        Ok(value) if value.is_finite() && has_comma => Cell::CommaNumber(value),
        Ok(value) if value.is_finite() => Cell::Number(value),
        _ => Cell::Text,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cells(line: &str, separator: Separator) -> Vec<&str> {
        let mut ranges = Vec::new();
        separator.split(line, &mut ranges);
        ranges.into_iter().map(|range| &line[range]).collect()
    }

    #[test]
    fn lines_are_split_at_every_separator() {
        assert_eq!(cells("a, b ,,\"c, d\",", Separator::Comma), ["a", "b", "", "c, d", ""]);
        assert_eq!(cells("1;2,5; 3", Separator::Semicolon), ["1", "2,5", "3"]);
        assert_eq!(cells("1\t\t 3\t", Separator::Tab), ["1", "", "3", ""]);
        assert_eq!(cells("  1  2\t3 ", Separator::Blank), ["1", "2", "3"]);
        assert_eq!(cells("\"say \"\"hi\"\"\",2", Separator::Comma), ["say \"\"hi\"\"", "2"]);
        assert_eq!(cells("\"never closed,2", Separator::Comma), ["\"never closed", "2"]);
        assert_eq!(cells("", Separator::Comma), [""]);
        assert!(cells("   ", Separator::Blank).is_empty());
        let lines = ["a, b ,,c", "\t1\t 2 ;\t", " ", "", ";;", " x\t", "1 , 2", "\u{b}1\u{c},2 3"];
        for (line, separator) in lines.iter().flat_map(|line| Separator::ALL.map(|separator| (line, separator))) {
            let (mut plain, mut any) = (Vec::new(), Vec::new());
            assert!(separator.split_plain(line.as_bytes(), &mut plain));
            separator.split_any(line, &mut any);
            assert_eq!(plain, any, "{line:?} {separator:?}");
        }
    }

    #[test]
    fn the_separator_with_the_most_known_names_wins() {
        let known = |cells: &[&str]| cells.iter().filter(|cell| cell.starts_with("k_")).count();
        assert_eq!(recognise("k_a [x, y];k_b", known), Separator::Semicolon);
        assert_eq!(recognise("k_a,k_b,other name", known), Separator::Comma);
        assert_eq!(recognise("k_a k_b", known), Separator::Blank);
        assert_eq!(recognise("k_a\tk_b", known), Separator::Tab);
        assert_eq!(recognise("nothing,known", known), Separator::Comma);
    }

    #[test]
    fn plain_numbers_have_the_bits_of_any_other_reader() {
        let mut key = 1u64;
        for _ in 0..200_000 {
            key = key.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            let text = format!("{:.*}", (key % 9) as usize, (key >> 11) as f64 / (1u64 << (key % 60)) as f64);
            let signed = if key.is_multiple_of(2) { format!("-{text}") } else { text };
            let Some(value) = plain_number(signed.as_bytes()) else { continue };
            assert_eq!(value.to_bits(), signed.parse::<f64>().expect("a number").to_bits(), "{signed}");
        }
        for text in ["-0", "0", ".5", "5.", "007", "-0.0"] {
            assert_eq!(plain_number(text.as_bytes()).map(f64::to_bits), text.parse().ok().map(f64::to_bits), "{text}");
        }
        for text in ["", "-", ".", "+1", "1e5", "1.2.3", "1 2", "99999999999999999999", "--1"] {
            assert_eq!(plain_number(text.as_bytes()), None, "{text}");
        }
    }

    #[test]
    fn numbers_missing_values_and_text_are_told_apart() {
        assert_eq!(cell("-1.5e2", Separator::Comma), Cell::Number(-150.0));
        assert_eq!(cell(".000000000", Separator::Blank), Cell::Number(0.0));
        assert_eq!(cell("1.5D+02", Separator::Blank), Cell::Number(150.0));
        assert_eq!(cell("1,5", Separator::Semicolon), Cell::CommaNumber(1.5));
        // In quotes, or it would not be one cell; three digits after it may be thousands.
        assert_eq!(cell("1,5", Separator::Comma), Cell::CommaNumber(1.5));
        assert_eq!(cell("1,500", Separator::Comma), Cell::Text);
        assert_eq!(cell("1.234,5", Separator::Semicolon), Cell::Text);
        for missing in ["", "NaN", "nan", "NA", "n/a", "-", "NULL"] {
            assert_eq!(cell(missing, Separator::Comma), Cell::Missing, "{missing}");
        }
        for text in ["inf", "-Infinity", "1e999", "abc", "12:30:05", "****", "d", "ed", "1 2"] {
            assert_eq!(cell(text, Separator::Blank), Cell::Text, "{text}");
        }
    }
}
