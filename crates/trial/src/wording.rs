//! Parts of messages: lists of names, shortened texts of a file, counts and times.

use ship::ShortNumber;

/// List of names in backquotes, at most thirty.
pub(crate) fn listed(names: &[String]) -> String {
    const SHOWN: usize = 30;
    let mut text = names.iter().take(SHOWN).map(|name| format!("`{}`", shortened(name))).collect::<Vec<_>>().join(", ");
    if names.len() > SHOWN {
        text.push_str(&format!(" and {} more", names.len() - SHOWN));
    }
    text
}

/// Text cut to forty characters, without control characters.
pub(crate) fn shortened(text: &str) -> String {
    const SHOWN: usize = 40;
    let mut short: String = text.chars().take(SHOWN).map(|c| if c.is_control() { ' ' } else { c }).collect();
    if text.chars().nth(SHOWN).is_some() {
        short.push('…');
    }
    short
}

/// Number with its noun: `1 sentence`, `12 sentences`.
pub(crate) fn counted(number: usize, noun: &str) -> String {
    format!("{number} {noun}{}", if number == 1 { "" } else { "s" })
}

/// Number rounded to a thousandth, such as a time in s, without the digits of rounding errors.
pub(crate) fn rounded_to_thousandth(time: f64) -> ShortNumber {
    ShortNumber((1e3 * time).round() / 1e3)
}

/// Text of a bound of a part of a record, such as ` from 12 s`; empty for an infinite bound.
pub(crate) fn interval_end(word: &str, time: f64) -> String {
    if time.is_finite() { format!(" {word} {} s", rounded_to_thousandth(time)) } else { String::new() }
}

#[cfg(test)]
mod tests {
    use super::rounded_to_thousandth;

    #[test]
    fn a_time_has_the_digits_that_were_read() {
        let shown =
            [0.1 + 0.2, 6.0 * 0.2, 12.3455, 7.0, 1.7e9 + 0.25].map(|time| rounded_to_thousandth(time).to_string());
        assert_eq!(shown, ["0.3", "1.2", "12.346", "7", "1700000000.25"]);
    }
}
