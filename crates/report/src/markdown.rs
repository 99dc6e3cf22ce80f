//! Escaping of text for a Markdown page (the GitHub flavour): literal text, and prose that is Markdown itself. Neither
//! may contain HTML.

use crate::printable::{escaped, is_printable};

/// Text escaped for a line or a table cell, so that all its characters are shown literally.
pub fn escaped_text(text: &str) -> String {
    let text = escaped(text);
    let mut out = String::with_capacity(text.len() + 8);
    let mut before = None;
    for (at, c) in text.char_indices() {
        let after = &text[at + c.len_utf8()..];
        let is_mark = match c {
            '\\' | '|' | '*' | '_' | '`' | '~' => true,
            '<' => opens_tag(after),
            '&' => after.starts_with(|c: char| c.is_ascii_alphanumeric() || c == '#'),
            // A bracket after a bracket makes a link; alone it may be that of an interval.
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

/// Sentence of the program, escaped as by [`escaped_text`] except for commands in backticks, which stay code. A command
/// has only letters, digits, blanks and hyphens; if a part in backticks is no command or a backtick has no partner, all
/// backticks are escaped.
pub fn escaped_sentence(sentence: &str) -> String {
    let is_command = |part: &str| part.chars().all(|c| c.is_ascii_alphanumeric() || matches!(c, ' ' | '-'));
    let parts: Vec<&str> = sentence.split('`').collect();
    if parts.len().is_multiple_of(2) || !parts.iter().skip(1).step_by(2).all(|part| is_command(part)) {
        return escaped_text(sentence);
    }
    parts
        .iter()
        .enumerate()
        .map(|(n, part)| if n % 2 == 1 { format!("`{part}`") } else { escaped_text(part) })
        .collect()
}

/// Prose that is Markdown: its marks are kept, its HTML is shown and not interpreted.
pub fn html_escaped_prose(text: &str) -> String {
    const LINKS: [&str; 3] = ["http://", "https://", "mailto:"];
    let mut out = String::with_capacity(text.len() + 8);
    let mut is_escaped = false;
    for (at, c) in text.char_indices() {
        let after = &text[at + c.len_utf8()..];
        if c == '<' && !is_escaped && opens_tag(after) && !LINKS.iter().any(|link| after.starts_with(link)) {
            out.push('\\');
        }
        if is_printable(c) || is_line_break_or_tab(c) {
            out.push(c)
        } else {
            out.extend(c.escape_default())
        }
        is_escaped = c == '\\' && !is_escaped;
    }
    out
}

/// `true` if an invisible character is allowed in prose: a line break or a tab.
pub fn is_line_break_or_tab(c: char) -> bool {
    matches!(c, '\n' | '\r' | '\t')
}

/// `true` if `<` before this text begins a tag, a comment or a link.
fn opens_tag(text: &str) -> bool {
    text.starts_with(|c: char| c.is_ascii_alphabetic() || matches!(c, '/' | '!' | '?'))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn commands_of_a_sentence_stay_code() {
        assert_eq!(escaped_sentence("run `study trace`, a_b"), "run `study trace`, a\\_b");
        assert_eq!(escaped_sentence("`<b>` and `c"), escaped_text("`<b>` and `c"));
        assert_eq!(escaped_sentence("of `a|b`"), escaped_text("of `a|b`"));
    }

    #[test]
    fn a_text_is_read_as_it_is() {
        assert_eq!(escaped_text("a|b *c* d_e `f` ~~g~~ \\"), "a\\|b \\*c\\* d\\_e \\`f\\` \\~\\~g\\~\\~ \\\\");
        assert_eq!(escaped_text("<img src=x> </b> <!-- &lt; &#60;"), "\\<img src=x> \\</b> \\<!-- \\&lt; \\&#60;");
        assert_eq!(escaped_text("[a](http://b) ![c][d]"), "[a]\\(http://b) ![c]\\[d]");
        assert_eq!(escaped_text("[−0.1, 0.2] < 3 ns & more"), "[−0.1, 0.2] < 3 ns & more");
        assert_eq!(escaped_text("\u{1b}[31m\n"), "\\\\u{1b}[31m\\\\n");
    }

    #[test]
    fn prose_keeps_its_markdown_and_loses_its_html() {
        let markdown = "*Less* than `3` ([here](x.md), <https://a.b>): K < 0, a <- b, 1 \\<b> 2\n\n- T\n";
        assert_eq!(html_escaped_prose(markdown), markdown);
        assert_eq!(html_escaped_prose("<script>x</script>\n<!-- <B"), "\\<script>x\\</script>\n\\<!-- \\<B");
        assert_eq!(html_escaped_prose("\\\\<b>"), "\\\\\\<b>", "the backslash before it is itself escaped");
        assert_eq!(html_escaped_prose("<httpsx> <https:x>\u{1b}"), "\\<httpsx> \\<https:x>\\u{1b}");
    }
}
