//! A table in LaTeX: rules of `booktabs`, numbers in columns of `siunitx` below each other by their decimal point, and
//! never wider than the text. What is too wide is set as several blocks of columns, each with the names of the rows;
//! what is too long runs over pages. Any LaTeX with the packages named in its first line compiles it.

use super::content::{Column, Table};
use super::latex_text::{escape, is_symbol, script, worded};
use super::width::{Alignment, columns as characters};

/// Rows of all blocks that one page holds; more run over pages.
const PAGE: usize = 42;

/// Width of the text that blocks are made for, points: that of an article on A4.
const TEXT: f64 = 345.0;

/// A block on one page may be this much wider and is scaled down, to 7.5 points of type at most.
const SCALED: f64 = 1.2;

/// Mean width of a character, points: of 9 points of type on one page, of 8 over several.
const CHARACTER: [f64; 2] = [4.7, 4.3];

/// A heading is broken into lines of about so many characters.
const HEADING: usize = 9;

/// The names of the rows take at most this share of the width, where numbers follow.
const NAMES: f64 = 0.55;

/// Words are broken into lines of no fewer characters.
const WORDS: usize = 14;

/// Space between two columns, points.
const GAP: f64 = 8.0;

impl Table {
    /// As LaTeX that compiles with the packages named in its first line: caption and label where the table has a title
    /// and a label, numbers in `S` columns of siunitx (`0.1003 ± 0.0007` as `0.1003(7)`), every other character escaped
    /// or translated to mathematics; at most as wide as the text, and on one page up to 42 rows.
    pub fn to_latex(&self) -> String {
        if self.columns.is_empty() {
            return String::from("% A table without columns.\n");
        }
        let set = |room: f64, character: f64| {
            let mut set: Vec<Set> =
                self.columns.iter().enumerate().map(|(i, column)| Set::new(self, i, column)).collect();
            break_words(self, &mut set, room, character);
            let blocks = blocks(self, &set, room, character);
            (set, blocks)
        };
        let (short, short_blocks) = set(SCALED * TEXT, CHARACTER[0]);
        let lines = |row: usize| short.iter().map(|column| column.lines(row)).max().unwrap_or(1);
        let rows: usize = (0..self.rows.len()).map(lines).sum();
        if short_blocks.len() * (rows + 3) <= PAGE {
            return on_one_page(self, &short, &short_blocks);
        }
        let (long, long_blocks) = set(TEXT, CHARACTER[1]);
        over_pages(self, &long, &long_blocks)
    }
}

/// A column as it is set.
struct Set {
    /// The specification in the head of the tabular.
    format: String,
    /// Lines of the heading, the last one next to the cells.
    heading: Vec<String>,
    cells: Vec<String>,
    /// Characters of its widest line.
    widest: usize,
    /// Characters of its cells.
    characters: Vec<usize>,
}

impl Set {
    fn new(table: &Table, place: usize, column: &Column) -> Self {
        let cells: Vec<Option<&str>> = table.rows.iter().map(|row| row.get(place).and_then(Option::as_deref)).collect();
        let numbers: Vec<Option<Number>> = cells.iter().map(|cell| cell.and_then(Number::parse)).collect();
        let (known, parsed) = (cells.iter().flatten().count(), numbers.iter().flatten().count());
        let is_number = column.alignment != Alignment::Left && parsed > 0 && 2 * parsed >= known;
        let format = match (is_number, column.alignment) {
            (true, _) => format!("S[table-format={}]", widest(numbers.iter().flatten())),
            (false, Alignment::Left) => "l".to_owned(),
            (false, _) => "r".to_owned(),
        };
        let lengths: Vec<usize> = cells.iter().map(|cell| cell.map_or(2, characters)).collect();
        let body = lengths.iter().copied().max().unwrap_or(0);
        let heading = wrapped(&column.head(), body.max(HEADING));
        Self {
            widest: heading.iter().map(|line| characters(line)).fold(body, usize::max),
            heading: heading.iter().map(|line| format!("{{{}}}", worded(line))).collect(),
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
            characters: lengths,
        }
    }

    /// Lines of a cell.
    fn lines(&self, row: usize) -> usize {
        self.characters[row].div_ceil(self.widest.max(1))
    }

    fn width(&self, character: f64) -> f64 {
        self.widest as f64 * character + GAP
    }
}

/// A heading in lines no longer than the cells below, as far as its words allow.
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

/// A number as siunitx reads it, and its parts.
struct Number {
    source: String,
    is_negative: bool,
    /// Digits before and behind the decimal point, of the uncertainty and of the power of ten.
    digits: [usize; 4],
    has_small_power: bool,
}

impl Number {
    /// Reads `−1.25`, `0.1003 ± 0.0007`, `1.3×10⁻⁵` and `(1.23 ± 0.04)×10⁻⁵`.
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
        // In units of the last decimal.
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

/// Digits before and behind the point of a plain decimal number.
fn decimal(text: &str) -> Option<[usize; 2]> {
    let (before, behind) = text.split_once('.').unwrap_or((text, ""));
    let is_whole = |part: &str| part.bytes().all(|byte| byte.is_ascii_digit());
    let has_digits = !before.is_empty() && behind.is_empty() != text.contains('.');
    (has_digits && is_whole(before) && is_whole(behind)).then_some([before.len(), behind.len()])
}

/// The `table-format` that has room for all numbers of a column.
fn widest<'a>(numbers: impl Iterator<Item = &'a Number> + Clone) -> String {
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

/// Breaks the words of the leading columns into lines, the widest first, where they take too much of the width.
fn break_words(table: &Table, set: &mut [Set], room: f64, character: f64) {
    let names = table.columns.iter().take_while(|column| column.alignment == Alignment::Left).count();
    let limit = if names == set.len() { room } else { NAMES * room };
    for _ in 0..names {
        let excess = set[..names].iter().map(|column| column.width(character)).sum::<f64>() - limit;
        let Some(widest) = set[..names].iter_mut().max_by_key(|column| column.widest).filter(|_| excess > 0.0) else {
            return;
        };
        widest.widest = widest.widest.saturating_sub((excess / character).ceil() as usize).max(WORDS);
        let width = widest.widest as f64 * character;
        widest.format = format!(">{{\\raggedright\\arraybackslash}}p{{{width:.0}pt}}");
    }
}

/// Columns in blocks that are no wider than `room`, each with the leading columns of words. A block begins with a
/// heading that begins with a symbol, where it can, and never with words, which belong to the number before. Columns
/// without a cell are left out.
fn blocks(table: &Table, set: &[Set], room: f64, character: f64) -> Vec<Vec<usize>> {
    let is_words = |place: usize| table.columns[place].alignment == Alignment::Left;
    let is_empty = |place: usize| table.cells_of(place).all(|cell| cell.is_none()) && !table.rows.is_empty();
    let begins = |place: usize| table.columns[place].heading.split(' ').next().is_some_and(is_symbol);
    let width = |places: &[usize]| places.iter().map(|&place| set[place].width(character)).sum::<f64>();
    let names: Vec<usize> = (0..set.len()).take_while(|&place| is_words(place)).collect();
    let mut rest: Vec<usize> = (names.len()..set.len()).filter(|&place| !is_empty(place)).collect();
    let mut blocks = Vec::new();
    while blocks.is_empty() || !rest.is_empty() {
        let fits = |count: &usize| width(&names) + width(&rest[..*count]) <= room;
        let most = (1..=rest.len()).take_while(fits).last().unwrap_or(rest.len().min(1));
        let is_end = |count: usize, good: &dyn Fn(usize) -> bool| count == rest.len() || good(rest[count]);
        let last = |good: &dyn Fn(usize) -> bool| (1..=most).rev().find(|&count| is_end(count, good));
        let count = last(&begins).or_else(|| last(&|place| !is_words(place))).unwrap_or(most);
        blocks.push(names.iter().copied().chain(rest.drain(..count)).collect());
    }
    blocks
}

fn specification(set: &[Set], block: &[usize]) -> String {
    let formats: Vec<&str> = block.iter().map(|&place| set[place].format.as_str()).collect();
    format!("@{{}}{}@{{}}", formats.join(" "))
}

/// Rules and heading; lines of a heading end above the cells.
fn head(set: &[Set], block: &[usize]) -> String {
    let lines = block.iter().map(|&place| set[place].heading.len()).max().unwrap_or(0);
    let mut out = String::from("    \\toprule\n");
    for line in 0..lines {
        let cell = |place: &usize| {
            let heading = &set[*place].heading;
            (line + heading.len()).checked_sub(lines).map_or("", |own| heading[own].as_str())
        };
        out += &format!("    {} \\\\\n", block.iter().map(cell).collect::<Vec<_>>().join(" & "));
    }
    out + "    \\midrule\n"
}

fn body(table: &Table, set: &[Set], block: &[usize]) -> String {
    let mut out = String::new();
    for row in 0..table.rows.len() {
        let cells: Vec<&str> = block.iter().map(|&place| set[place].cells[row].as_str()).collect();
        let cells = cells.join(" & ");
        // A bracket or a star behind the end of the row before would belong to that.
        let guard = if cells.starts_with(['[', '*', '(']) { "{}" } else { "" };
        out += &format!("    {guard}{cells} \\\\\n");
    }
    out
}

fn caption(table: &Table, end: &str) -> String {
    let mut out =
        table.title.as_ref().map_or_else(String::new, |title| format!("  \\caption{{{}}}{end}\n", worded(title)));
    if let (Some(label), Some(_)) = (&table.label, &table.title) {
        out.insert_str(out.len() - 1 - end.len(), &format!("\\label{{tab:{label}}}"));
    }
    out
}

fn on_one_page(table: &Table, set: &[Set], blocks: &[Vec<usize>]) -> String {
    let mut out = String::from("% Needs \\usepackage{booktabs,siunitx,adjustbox}.\n\\begin{table}\n  \\centering\n");
    out += &caption(table, "");
    out += "  \\par\\smallskip\\small\n  \\setlength{\\tabcolsep}{4pt}\n";
    for (number, block) in blocks.iter().enumerate() {
        if number > 0 {
            out += "  \\par\\medskip\n";
        }
        out += &format!(
            "  \\begin{{adjustbox}}{{max width=\\linewidth}}\n  \\begin{{tabular}}{{{}}}\n{}{}    \\bottomrule\n  \
             \\end{{tabular}}\n  \\end{{adjustbox}}\n",
            specification(set, block),
            head(set, block),
            body(table, set, block)
        );
    }
    out + "\\end{table}\n"
}

fn over_pages(table: &Table, set: &[Set], blocks: &[Vec<usize>]) -> String {
    let mut out = String::from("% Needs \\usepackage{booktabs,siunitx,longtable}.\n");
    for (number, block) in blocks.iter().enumerate() {
        let caption = match number {
            0 => caption(table, "\\\\"),
            _ => String::new(),
        };
        out += &format!(
            "{{\\footnotesize\\setlength{{\\tabcolsep}}{{4pt}}\n\\begin{{longtable}}{{{}}}\n{caption}{}    \\endhead\n{}    \
             \\bottomrule\n\\end{{longtable}}}}\n",
            specification(set, block),
            head(set, block),
            body(table, set, block)
        );
    }
    out
}
