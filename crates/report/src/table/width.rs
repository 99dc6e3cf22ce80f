//! Width of a text in a terminal, and padding by it. Combining accents have no column, wide East Asian characters two;
//! Greek and mathematical symbols have one.

use serde::{Deserialize, Serialize};

use crate::number::MISSING;

/// Alignment of the cells of a column.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Alignment {
    /// Text, at the left.
    #[default]
    Left,
    /// Whole numbers, at the right.
    Right,
    /// Numbers with decimals: the decimal points of a column are below each other.
    Decimal,
}

/// Width of a text in a terminal, in columns.
pub(super) fn columns(text: &str) -> usize {
    text.chars().map(of_char).sum()
}

fn of_char(c: char) -> usize {
    match u32::from(c) {
        0x00..=0x1f | 0x7f..=0x9f | 0x300..=0x36f | 0x200b..=0x200f | 0x20d0..=0x20ff | 0xfe00..=0xfe0f => 0,
        0x1100..=0x115f | 0x2e80..=0xa4cf | 0xac00..=0xd7a3 | 0xf900..=0xfaff | 0xfe30..=0xfe6f | 0xff00..=0xff60 => 2,
        0x1f300..=0x1faff | 0x20000..=0x3fffd => 2,
        _ => 1,
    }
}

/// `text` with spaces before and after.
fn pad(text: &str, before: usize, after: usize) -> String {
    format!("{}{text}{}", " ".repeat(before), " ".repeat(after))
}

/// Width before the first decimal point, as in `12.5 ± 0.1`, in columns; without a point, that of the first word.
fn before_point(text: &str) -> usize {
    match text.split_once('.') {
        Some((before, _)) => columns(before),
        // In `12 ± 3` the point would follow the 2.
        None => text.split_once(' ').map_or_else(|| columns(text), |(before, _)| columns(before)),
    }
}

/// Heading and cells of one column padded to the same width; the heading comes first.
pub(super) fn align(heading: &str, cells: &[&str], alignment: Alignment) -> Vec<String> {
    let numbers = || cells.iter().filter(|cell| alignment == Alignment::Decimal && **cell != MISSING);
    let point = numbers().map(|cell| before_point(cell)).max().unwrap_or(0);
    let lead = |cell: &str| point.saturating_sub(before_point(cell));
    let body = match alignment {
        Alignment::Decimal => numbers().map(|cell| lead(cell) + columns(cell)).max().unwrap_or(0),
        _ => 0,
    };
    let widest = cells.iter().copied().chain([heading]).map(columns).fold(body, usize::max);
    let place = |text: &str, is_heading: bool| {
        let free = widest.saturating_sub(columns(text));
        let before = match alignment {
            Alignment::Left => 0,
            Alignment::Decimal if !is_heading && text != MISSING => widest - body + lead(text),
            Alignment::Right | Alignment::Decimal => free,
        };
        pad(text, before, free - before)
    };
    std::iter::once(place(heading, true)).chain(cells.iter().map(|cell| place(cell, false))).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn greek_takes_one_column_and_accents_none() {
        assert_eq!(columns("ψ rms [°]"), 9);
        assert_eq!(columns("K\u{302}"), 1);
        assert_eq!(columns("鄱"), 2);
    }

    #[test]
    fn decimal_points_stand_below_each_other() {
        let lines = align("K", &["0.10", "−12.5", "7", "3.1 ± 0.2", "–"], Alignment::Decimal);
        assert_eq!(lines, ["          K", "  0.10     ", "−12.5      ", "  7        ", "  3.1 ± 0.2", "          –"]);
    }

    #[test]
    fn words_left_and_counts_right() {
        assert_eq!(align("method", &["a"], Alignment::Left), ["method", "a     "]);
        assert_eq!(align("n", &["12", "3"], Alignment::Right), [" n", "12", " 3"]);
        assert_eq!(align("", &[], Alignment::Decimal), [""]);
    }
}
