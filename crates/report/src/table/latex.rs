//! Table in LaTeX: rules of `booktabs`, numbers in columns of `siunitx` aligned by their decimal points. On one page it
//! is scaled down to the width of the text; a longer table runs over pages, a wide one best in landscape. Any LaTeX
//! with the packages named in its first line compiles it.

use super::content::Table;
use super::head::TableColumn;
use super::latex_text::{escape, heading_text, script};
use super::width::{Alignment, columns as characters};

/// Maximum number of rows on one page; longer tables run over pages.
const PAGE: usize = 42;

/// Length up to which a heading is not broken even if the cells below are shorter, characters.
const HEADING: usize = 9;

/// Maximum length of a text in one line, characters; columns with longer texts have lines of fixed width.
const WORDS: usize = 40;

impl Table {
    /// LaTeX that compiles with the packages named in its first line: caption and label if the table has a title and a
    /// label, numbers in `S` columns of siunitx (`0.1003 ± 0.0007` as `0.1003(7)`), every other character escaped or
    /// translated to mathematics; on one page, at most as wide as the text, up to 42 rows.
    pub fn to_latex(&self) -> String {
        if self.columns.is_empty() {
            return String::from("% A table without columns.\n");
        }
        let is_empty = |place: &usize| !self.rows.is_empty() && self.column_cells(*place).all(|cell| cell.is_none());
        let shown = (0..self.columns.len()).filter(|place| !is_empty(place));
        let set: Vec<LatexColumn> = shown.map(|place| LatexColumn::new(self, place, &self.columns[place])).collect();
        let formats: Vec<&str> = set.iter().map(|column| column.format.as_str()).collect();
        let (format, head, body) = (formats.join(" "), head(&set), body(&set, self.rows.len()));
        if self.rows.len() > PAGE {
            return format!(
                "% Needs \\usepackage{{booktabs,siunitx,longtable}}.\n{{\\footnotesize\\setlength{{\\tabcolsep}}{{4pt}}\n\
                 \\begin{{longtable}}{{@{{}}{format}@{{}}}}\n{}{head}    \\endhead\n{body}    \\bottomrule\n\
                 \\end{{longtable}}}}\n",
                caption(self, "\\\\")
            );
        }
        format!(
            "% Needs \\usepackage{{booktabs,siunitx,adjustbox}}.\n\\begin{{table}}\n  \\centering\n{}  \
             \\par\\smallskip\\small\n  \\setlength{{\\tabcolsep}}{{4pt}}\n  \\begin{{adjustbox}}{{max width=\\linewidth}}\n  \
             \\begin{{tabular}}{{@{{}}{format}@{{}}}}\n{head}{body}    \\bottomrule\n  \\end{{tabular}}\n  \
             \\end{{adjustbox}}\n\\end{{table}}\n",
            caption(self, "")
        )
    }
}

/// Column of a LaTeX table.
struct LatexColumn {
    /// Specification in the head of the tabular.
    format: String,
    /// Lines of the heading, the last one next to the cells.
    heading: Vec<String>,
    cells: Vec<String>,
}

impl LatexColumn {
    fn new(table: &Table, place: usize, column: &TableColumn) -> Self {
        let cells: Vec<Option<&str>> = table.rows.iter().map(|row| row.get(place).and_then(Option::as_deref)).collect();
        let numbers: Vec<Option<LatexNumber>> = cells.iter().map(|cell| cell.and_then(LatexNumber::parse)).collect();
        let (filled, parsed) = (cells.iter().flatten().count(), numbers.iter().flatten().count());
        let is_number = column.alignment != Alignment::Left && parsed > 0 && 2 * parsed >= filled;
        let widest = cells.iter().flatten().map(|cell| characters(cell)).max().unwrap_or(0);
        let format = match (is_number, column.alignment) {
            (true, _) => format!("S[table-format={}]", table_format(numbers.iter().flatten())),
            (false, Alignment::Left) if widest > WORDS => String::from(">{\\raggedright\\arraybackslash}p{170pt}"),
            (false, Alignment::Left) => "l".to_owned(),
            (false, _) => "r".to_owned(),
        };
        let heading = wrapped(&column.head(), widest.max(HEADING));
        Self {
            heading: heading.iter().map(|line| format!("{{{}}}", heading_text(line))).collect(),
            cells: cells
                .iter()
                .zip(&numbers)
                .map(|(cell, number)| match (number, is_number) {
                    (Some(number), true) => number.source.clone(),
                    (_, true) => format!("{{{}}}", cell.map_or_else(|| "--".into(), escape)),
                    _ => cell.map_or_else(|| "--".into(), escape),
                })
                .collect(),
            format,
        }
    }
}

/// Heading in lines no longer than `body` characters or its longest word, broken at blanks only.
fn wrapped(heading: &str, body: usize) -> Vec<String> {
    let longest = heading.split(' ').map(characters).max().unwrap_or(0).max(body);
    let mut lines: Vec<String> = Vec::new();
    for word in heading.split(' ') {
        match lines.last_mut() {
            Some(line) if characters(line) + 1 + characters(word) <= longest => {
                line.push(' ');
                line.push_str(word);
            }
            _ => lines.push(word.to_owned()),
        }
    }
    lines
}

/// Number as siunitx reads it, and its parts.
struct LatexNumber {
    /// Source for siunitx, such as `0.1003(7)e-5`.
    source: String,
    is_negative: bool,
    /// Digits before and after the decimal point, of the uncertainty and of the power of ten.
    digits: [usize; 4],
    /// `true` if the power of ten is negative.
    has_small_power: bool,
}

impl LatexNumber {
    /// Number read from `−1.25`, `0.1003 ± 0.0007`, `1.3×10⁻⁵` or `(1.23 ± 0.04)×10⁻⁵`; `None` for any other text.
    fn parse(cell: &str) -> Option<Self> {
        let (mantissa, power) = match cell.split_once("×10") {
            Some((mantissa, power)) => {
                (mantissa, power.chars().map(|c| Some(script(c)?.1)).collect::<Option<String>>()?)
            }
            None => (cell, String::new()),
        };
        let mantissa = mantissa.strip_prefix('(').and_then(|inner| inner.strip_suffix(')')).unwrap_or(mantissa);
        let (value, doubt) = mantissa.split_once(" ± ").map_or((mantissa, None), |(value, doubt)| (value, Some(doubt)));
        let (is_negative, value) = match value.strip_prefix(['−', '-']) {
            Some(value) => (true, value),
            None => (false, value),
        };
        let [before, behind] = decimal(value)?;
        // In units of the last decimal, as siunitx expects an uncertainty in brackets.
        let doubt = match doubt {
            Some(doubt) if decimal(doubt)?[1] == behind => doubt.replace('.', "").trim_start_matches('0').to_owned(),
            Some(_) => return None,
            None => String::new(),
        };
        let sign = if is_negative { "-" } else { "" };
        let in_brackets = if doubt.is_empty() { String::new() } else { format!("({doubt})") };
        let times = if power.is_empty() { String::new() } else { format!("e{power}") };
        let has_small_power = power.starts_with('-');
        let digits = [before, behind, doubt.len(), power.len() - usize::from(has_small_power)];
        Some(Self { source: format!("{sign}{value}{in_brackets}{times}"), is_negative, digits, has_small_power })
    }
}

/// Numbers of digits before and after the point of a plain decimal number; `None` for any other text.
fn decimal(text: &str) -> Option<[usize; 2]> {
    let (before, behind) = text.split_once('.').unwrap_or((text, ""));
    let is_whole = |part: &str| part.bytes().all(|byte| byte.is_ascii_digit());
    let has_digits = !before.is_empty() && behind.is_empty() != text.contains('.');
    (has_digits && is_whole(before) && is_whole(behind)).then_some([before.len(), behind.len()])
}

/// The `table-format` that has room for all numbers of a column.
fn table_format<'a>(numbers: impl Iterator<Item = &'a LatexNumber> + Clone) -> String {
    let most = |part: usize| numbers.clone().map(|number| number.digits[part]).max().unwrap_or(0);
    let mut format = String::from(if numbers.clone().any(|number| number.is_negative) { "-" } else { "" });
    format += &most(0).to_string();
    if most(1) > 0 {
        format += &format!(".{}", most(1));
    }
    if most(2) > 0 {
        format += &format!("({})", most(2));
    }
    if most(3) > 0 {
        format += if numbers.clone().any(|number| number.has_small_power) { "e-" } else { "e" };
        format += &most(3).to_string();
    }
    format
}

/// Rules and headings; the last line of every heading is next to the cells.
fn head(set: &[LatexColumn]) -> String {
    let lines = set.iter().map(|column| column.heading.len()).max().unwrap_or(0);
    let mut out = String::from("    \\toprule\n");
    for line in 0..lines {
        let heading_line = |column: &LatexColumn| (line + column.heading.len()).checked_sub(lines);
        let cell = |column: &LatexColumn| heading_line(column).map_or_else(String::new, |k| column.heading[k].clone());
        out += &format!("    {} \\\\\n", set.iter().map(cell).collect::<Vec<_>>().join(" & "));
    }
    out + "    \\midrule\n"
}

fn body(set: &[LatexColumn], rows: usize) -> String {
    let mut out = String::new();
    for row in 0..rows {
        let cells = set.iter().map(|column| column.cells[row].as_str()).collect::<Vec<_>>().join(" & ");
        // A bracket or a star after the end of the row before would belong to that row end.
        let guard = if cells.starts_with(['[', '*', '(']) { "{}" } else { "" };
        out += &format!("    {guard}{cells} \\\\\n");
    }
    out
}

fn caption(table: &Table, end: &str) -> String {
    let mut out =
        table.title.as_ref().map_or_else(String::new, |title| format!("  \\caption{{{}}}{end}\n", heading_text(title)));
    if let (Some(label), Some(_)) = (&table.label, &table.title) {
        out.insert_str(out.len() - 1 - end.len(), &format!("\\label{{tab:{label}}}"));
    }
    out
}
