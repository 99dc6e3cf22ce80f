//! Text on its way into a Markdown page (the GitHub flavour): words that are to be read as they are, and prose that is
//! Markdown itself. Neither brings HTML of its own.

use crate::printable::{escaped, is_printable};

/// A text as it is, in a line or a cell: nothing in it is a mark.
pub fn text(text: &str) -> String {
    let text = escaped(text);
    let mut out = String::with_capacity(text.len() + 8);
    let mut before = None;
    for (at, c) in text.char_indices() {
        let after = &text[at + c.len_utf8()..];
        let is_mark = match c {
            '\\' | '|' | '*' | '_' | '`' | '~' => true,
            '<' => opens_tag(after),
            '&' => after.starts_with(|c: char| c.is_ascii_alphanumeric() || c == '#'),
            // What makes a link of brackets; alone they may be those of an interval.
            '(' | '[' => before == Some(']'),
            _ => false,
        };
        if is_mark {
            out.push('\\');
        }
        out.push(c);
        before = Some(c);
    }
    out
}

/// Prose that is Markdown: its marks stay, its HTML is shown and not obeyed.
pub fn prose(text: &str) -> String {
    const LINKS: [&str; 3] = ["http://", "https://", "mailto:"];
    let mut out = String::with_capacity(text.len() + 8);
    let mut is_escaped = false;
    for (at, c) in text.char_indices() {
        let after = &text[at + c.len_utf8()..];
        if c == '<' && !is_escaped && opens_tag(after) && !LINKS.iter().any(|link| after.starts_with(link)) {
            out.push('\\');
        }
        if is_printable(c) || is_layout(c) {
            out.push(c)
        } else {
            out.extend(c.escape_default())
        }
        is_escaped = c == '\\' && !is_escaped;
    }
    out
}

/// `true` if a character that cannot be seen belongs into prose: a line break or a tab.
pub fn is_layout(c: char) -> bool {
    matches!(c, '\n' | '\r' | '\t')
}

/// `true` if `<` before this begins a tag, a comment or a link.
fn opens_tag(text: &str) -> bool {
    text.starts_with(|c: char| c.is_ascii_alphabetic() || matches!(c, '/' | '!' | '?'))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_text_is_read_as_it_is() {
        assert_eq!(text("a|b *c* d_e `f` ~~g~~ \\"), "a\\|b \\*c\\* d\\_e \\`f\\` \\~\\~g\\~\\~ \\\\");
        assert_eq!(text("<img src=x> </b> <!-- &lt; &#60;"), "\\<img src=x> \\</b> \\<!-- \\&lt; \\&#60;");
        assert_eq!(text("[a](http://b) ![c][d]"), "[a]\\(http://b) ![c]\\[d]");
        assert_eq!(text("[−0.1, 0.2] < 3 ns & more"), "[−0.1, 0.2] < 3 ns & more");
        assert_eq!(text("\u{1b}[31m\n"), "\\\\u{1b}[31m\\\\n");
    }

    #[test]
    fn prose_keeps_its_markdown_and_loses_its_html() {
        let markdown = "*Less* than `3` ([here](x.md), <https://a.b>): K < 0, a <- b, 1 \\<b> 2\n\n- T\n";
        assert_eq!(prose(markdown), markdown);
        assert_eq!(prose("<script>x</script>\n<!-- <B"), "\\<script>x\\</script>\n\\<!-- \\<B");
        assert_eq!(prose("\\\\<b>"), "\\\\\\<b>", "the backslash before it is itself escaped");
        assert_eq!(prose("<httpsx> <https:x>\u{1b}"), "\\<httpsx> \\<https:x>\\u{1b}");
    }
}
