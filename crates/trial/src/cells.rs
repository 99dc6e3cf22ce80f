//! Cells of a line of a table: separators, recognition of the separator of a file, numbers and missing values.

use std::ops::Range;

use serde::Deserialize;

/// Separator of the cells of a line.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Separator {
    /// Tab; two in a row enclose an empty cell.
    Tab,
    /// Semicolon.
    Semicolon,
    /// Comma.
    Comma,
    /// Any run of blanks and tabs; no empty cells.
    Blank,
}

impl Separator {
    /// All separators, the least likely to occur by chance first.
    pub const ALL: [Separator; 4] = [Separator::Tab, Separator::Semicolon, Separator::Comma, Separator::Blank];

    fn is(self, character: char) -> bool {
        self.mark().map_or(character.is_whitespace(), |mark| character == char::from(mark))
    }

    /// Byte between two cells; `None` for blanks, which may be several.
    fn mark(self) -> Option<u8> {
        match self {
            Separator::Tab => Some(b'\t'),
            Separator::Semicolon => Some(b';'),
            Separator::Comma => Some(b','),
            Separator::Blank => None,
        }
    }

    /// Replaces `cells` by the byte ranges of the cells of `line`, without the blanks and quotes around them.
    ///
    /// A cell in double quotes may contain the separator; a doubled quote inside stays doubled (see `unquoted`).
    pub fn split(self, line: &str, cells: &mut Vec<Range<usize>>) {
        cells.clear();
        let mut take = |cell: &str| {
            let begin = cell.as_ptr() as usize - line.as_ptr() as usize;
            cells.push(begin..begin + cell.len());
        };
        match self.mark() {
            _ if line.contains('"') => self.split_quoted(line, take),
            None => line.split_whitespace().for_each(take),
            Some(mark) => {
                let mut tail = line;
                while let Some(end) = tail.bytes().position(|byte| byte == mark) {
                    take(tail[..end].trim());
                    tail = &tail[end + 1..];
                }
                take(tail.trim());
            }
        }
    }

    fn split_quoted<'a>(self, line: &'a str, mut take: impl FnMut(&'a str)) {
        let mut tail = line;
        loop {
            let is_blank = |c: char| c.is_whitespace() && (self == Separator::Blank || !self.is(c));
            let cell = tail.trim_start_matches(is_blank);
            if self == Separator::Blank && cell.is_empty() {
                return;
            }
            let inside = cell.strip_prefix('"').and_then(|inner| Some(&inner[..closing_quote(inner)?]));
            let from = inside.map_or(0, |inside| inside.len() + 2);
            let end = cell[from..].find(|c| self.is(c)).map(|at| from + at);
            take(inside.unwrap_or(cell[..end.unwrap_or(cell.len())].trim_end()));
            let Some(end) = end else { return };
            tail = cell[end..].split_at(cell[end..].chars().next().map_or(1, char::len_utf8)).1;
        }
    }
}

/// Length of the text before the quote that ends a quoted cell; doubled quotes do not end it. `None` for a quote that
/// is never closed.
fn closing_quote(text: &str) -> Option<usize> {
    let mut at = text.find('"')?;
    while text[at + 1..].starts_with('"') {
        at += 2 + text[at + 2..].find('"')?;
    }
    Some(at)
}

/// Text of a quoted cell, with each doubled quotation mark written once.
pub fn unquoted(cell: &str) -> String {
    cell.replace("\"\"", "\"")
}

/// Separator that splits a line into the cells with the highest `score`.
///
/// On a tie, the first in [`Separator::ALL`] that gives more than one cell. [`Separator::Blank`] for a line of one cell
/// with a score of 0.
pub fn detect_separator(line: &str, score: impl Fn(&[&str]) -> usize) -> Separator {
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

/// Content of a cell.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum CellContent {
    /// Finite number.
    Number(f64),
    /// Finite number written with a decimal comma.
    CommaNumber(f64),
    /// Empty cell or one of the usual marks of a missing value.
    Missing,
    /// Other text.
    Text,
}

impl CellContent {
    /// Number in either notation; `None` for a missing value and for text.
    pub fn number(self) -> Option<f64> {
        match self {
            Self::Number(value) | Self::CommaNumber(value) => Some(value),
            Self::Missing | Self::Text => None,
        }
    }
}

/// Content of a cell. A decimal comma is accepted. Among comma-separated cells a number with a comma was in quotes;
/// with three digits after the comma it is text, because the comma may separate thousands.
///
/// Missing are the empty cell, `NaN`, `NA`, `N/A`, `null`, `none` and `-`, in any case. `inf` is text: no instrument
/// displays it. Exponents may be written with `D` (Fortran).
pub fn parse_cell(text: &str, separator: Separator) -> CellContent {
    match text.parse::<f64>() {
        Ok(value) if value.is_finite() => return CellContent::Number(value),
        Ok(value) if value.is_nan() => return CellContent::Missing,
        Ok(_) => return CellContent::Text,
        Err(_) => {}
    }
    const MISSING_MARKS: [&str; 6] = ["", "na", "n/a", "null", "none", "-"];
    if MISSING_MARKS.iter().any(|word| text.eq_ignore_ascii_case(word)) {
        return CellContent::Missing;
    }
    // Only digits, signs, one mark and an exponent: a word like "nand" must not become a number by replacing letters.
    if text.len() > 40 || !text.bytes().all(|byte| byte.is_ascii_digit() || b"+-.,eEdD".contains(&byte)) {
        return CellContent::Text;
    }
    let has_comma = text.contains(',');
    // With commas as separators this cell stood in quotes.
    let may_be_thousands = || separator == Separator::Comma && text.len() - text.find(',').unwrap_or(0) == 4;
    if has_comma && (text.contains('.') || may_be_thousands()) {
        return CellContent::Text;
    }
    match text.replace(',', ".").replace(['d', 'D'], "e").parse::<f64>() {
        Ok(value) if value.is_finite() && has_comma => CellContent::CommaNumber(value),
        Ok(value) if value.is_finite() => CellContent::Number(value),
        _ => CellContent::Text,
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
        let lines = ["a, b ,,c", "\t1\t 2 ;\t", " ", "", ";;", " x\t", "1 , 2", "\u{b}1\u{c},2 3", "1\u{a0}2;\u{a0}3"];
        for (line, separator) in lines.iter().flat_map(|line| Separator::ALL.map(|separator| (line, separator))) {
            let mut quoted = Vec::new();
            separator.split_quoted(line, |cell| quoted.push(cell));
            assert_eq!(cells(line, separator), quoted, "{line:?} {separator:?}");
        }
    }

    #[test]
    fn the_separator_with_the_most_known_names_wins() {
        let score = |cells: &[&str]| cells.iter().filter(|cell| cell.starts_with("k_")).count();
        assert_eq!(detect_separator("k_a [x, y];k_b", score), Separator::Semicolon);
        assert_eq!(detect_separator("k_a,k_b,other name", score), Separator::Comma);
        assert_eq!(detect_separator("k_a k_b", score), Separator::Blank);
        assert_eq!(detect_separator("k_a\tk_b", score), Separator::Tab);
        assert_eq!(detect_separator("nothing,known", score), Separator::Comma);
    }

    #[test]
    fn numbers_missing_values_and_text_are_told_apart() {
        assert_eq!(parse_cell("-1.5e2", Separator::Comma), CellContent::Number(-150.0));
        assert_eq!(parse_cell(".000000000", Separator::Blank), CellContent::Number(0.0));
        assert_eq!(parse_cell("1.5D+02", Separator::Blank), CellContent::Number(150.0));
        assert_eq!(parse_cell("1,5", Separator::Semicolon), CellContent::CommaNumber(1.5));
        // The cell is in quotes, otherwise there would be two; three digits after the comma may be thousands.
        assert_eq!(parse_cell("1,5", Separator::Comma), CellContent::CommaNumber(1.5));
        assert_eq!(parse_cell("1,500", Separator::Comma), CellContent::Text);
        assert_eq!(parse_cell("1.234,5", Separator::Semicolon), CellContent::Text);
        for missing in ["", "NaN", "nan", "NA", "n/a", "-", "NULL"] {
            assert_eq!(parse_cell(missing, Separator::Comma), CellContent::Missing, "{missing}");
        }
        for text in ["inf", "-Infinity", "1e999", "abc", "12:30:05", "****", "d", "ed", "1 2"] {
            assert_eq!(parse_cell(text, Separator::Blank), CellContent::Text, "{text}");
        }
    }
}
