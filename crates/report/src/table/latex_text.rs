//! Text as LaTeX that any engine sets without further packages: characters of this program (Greek, signs, accents, sub-
//! and superscripts) become mathematics, letters with accents are kept, and any other character is named by its number.

use crate::printable::escaped;

/// Translation of characters: the kind (sign of mathematics, sign of text, or accent of mathematics), the code point
/// and the LaTeX code.
const SIGNS: &str = include_str!("latex_signs.tsv");

/// Letters that every LaTeX accepts directly.
const LETTERS: &str =
    "ÀÁÂÃÄÅÆÇÈÉÊËÌÍÎÏÑÒÓÔÕÖØÙÚÛÜÝàáâãäåæçèéêëìíîïñòóôõöøùúûüýÿĆćČčĎďĚěŁłŃńŇňŐőŒœŘřŚśŞşŠšŤťŮůŰűŸŹźŻżŽž";

/// Superscripts, and the plain characters in the same order.
const SUPER: (&str, &str) = ("⁰¹²³⁴⁵⁶⁷⁸⁹⁺⁻ⁿᵏᵖᵀᵗʰ", "0123456789+-nkpTth");
/// Subscripts, and the plain characters in the same order.
const SUB: (&str, &str) = ("₀₁₂₃₄₅₆₇₈₉₊₋ᵢⱼₖₘₙₒₚₐₑₛ", "0123456789+-ijkmnopaes");

/// Symbols that are set as mathematics if they are separate words of a heading or a caption.
const SYMBOLS: [&str; 3] = ["K", "T", "K/T"];

/// Literal text: LaTeX code that shows these characters.
pub(super) fn escape(text: &str) -> String {
    let text = escaped(text);
    let mut out = String::with_capacity(text.len() + 8);
    let mut chars = text.chars().peekable();
    while let Some(c) = chars.next() {
        if let Some((kind, plain)) = script(c) {
            // A run of scripts of one kind becomes one group: 10⁻³ is $10^{-3}$.
            let mut run = String::from(plain);
            while let Some((_, plain)) = chars.peek().copied().and_then(script).filter(|next| next.0 == kind) {
                run.push(plain);
                chars.next();
            }
            out.push_str(&format!("${kind}{{{run}}}$"));
        } else if let Some(accent) = chars.peek().and_then(|next| table_entry("accent", *next)) {
            chars.next();
            let letter = c.is_ascii_alphanumeric().then(|| c.to_string());
            match letter.or_else(|| table_entry("math", c).map(str::to_owned)) {
                Some(letter) => out.push_str(&format!("$\\{accent}{{{letter}}}$")),
                // An accent on a character that is not a letter is written alone.
                None => out.push_str(&alone(c)),
            }
        } else {
            out.push_str(&alone(c));
        }
    }
    out
}

/// Heading or caption: as [`escape`], with words that are symbols set as mathematics.
pub(super) fn heading_text(text: &str) -> String {
    let word = |word: &str| match SYMBOLS.contains(&word) {
        true => format!("${word}$"),
        false => escape(word),
    };
    text.split(' ').map(word).collect::<Vec<_>>().join(" ")
}

/// `^` or `_` with the plain character of a super- or subscript; `None` for any other character.
pub(super) fn script(c: char) -> Option<(char, char)> {
    let find = |(set, plain): (&str, &str)| set.chars().zip(plain.chars()).find(|(script, _)| *script == c);
    find(SUPER).map(|(_, plain)| ('^', plain)).or_else(|| find(SUB).map(|(_, plain)| ('_', plain)))
}

fn alone(c: char) -> String {
    match (table_entry("text", c), table_entry("math", c)) {
        (Some(plain), _) => plain.to_owned(),
        (_, Some(sign)) => format!("${sign}$"),
        _ if c.is_ascii() || LETTERS.contains(c) => c.to_string(),
        _ => format!("[U+{:04X}]", u32::from(c)),
    }
}

fn table_entry(kind: &str, c: char) -> Option<&'static str> {
    let code = format!("{kind}\tU+{:04X}\t", u32::from(c));
    SIGNS.lines().find_map(|line| line.strip_prefix(code.as_str()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_the_program_writes_is_mathematics() {
        assert_eq!(escape("σ² 10⁻³ \\ x_1"), "$\\sigma$$^{2}$ 10$^{-3}$ \\textbackslash{} x\\_1");
        assert_eq!(escape("r₁₂ √T′ ψ̇ K̂"), "r$_{12}$ $\\surd$T$'$ $\\dot{\\psi}$ $\\hat{K}$");
        assert_eq!(heading_text("K/T median of Kempf"), "$K/T$ median of Kempf");
    }

    #[test]
    fn what_is_unknown_is_named() {
        assert_eq!(escape("船 \u{302}ü\u{30a}"), "[U+8239] ü[U+030A]");
    }
}
