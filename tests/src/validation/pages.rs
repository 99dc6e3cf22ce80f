//! Documents made from the checks: VALIDATION.md, one row per section, and docs/validation.csv, one row per check.

use std::path::Path;

use super::{BOUND, Check, DEFINITION, INDEPENDENT, Section, Tolerance, sections};

const PREFACE: &str = "\
Numbers of this workspace stand beside reference numbers; each is found by the simulation or identification that a user \
would run. Three kinds of reference are kept apart: published by others, given by theory, computed independently. Numbers \
published by others are listed one by one, the others as one row a section. [docs/validation.csv](docs/validation.csv) has \
every number with its reference, difference and tolerance. Tests hold every number to its tolerance, and both files to \
the program that writes them.";

const MADE: &str = "Made by `cargo run -p kempf-tests --bin validation`.";

const COLUMNS: &str = "\
*Difference* is ours less the reference. *Tolerance* is the largest difference allowed; each section says where it comes \
from. A reference number has the digits it was given with, ours has one more.";

const SUMMARY: &str = "\
*Largest share* is the largest difference over its tolerance: 1 would be at the limit. *At* is the number that has it.";

/// Kind of reference: heading, description of the numbers, and a test of a source for this kind.
type Part = (&'static str, &'static str, fn(&str) -> bool);

/// All kinds of reference; every number has one kind.
const PARTS: [Part; 3] = [
    ("published by others", "numbers that stand in print or in published code", is_published),
    ("by theory", "numbers of a closed form, a bound or a definition", is_theory),
    (
        "computed independently",
        "numbers of a Python program (numpy, scipy) made for this project's technical reference, which shares no code with \
         this workspace; they are not published",
        |source| source == INDEPENDENT,
    ),
];

fn is_theory(source: &str) -> bool {
    [BOUND, DEFINITION].contains(&source) || source.starts_with("re-derived")
}

fn is_published(source: &str) -> bool {
    source != INDEPENDENT && !is_theory(source)
}

/// Cells of a check: reference, our number, difference, tolerance; numbers with their unit if `unit` is not empty.
fn cells(check: &Check, unit: &str) -> [String; 4] {
    let Check { published, decimals, ours, .. } = *check;
    let with_unit = |text: String| format!("{text}{}{unit}", if unit.is_empty() { "" } else { " " });
    let tolerance = match check.tolerance {
        Tolerance::Absolute(most) => with_unit(shortest(most)),
        Tolerance::Relative(share) => format!("{} %", shortest(100.0 * share)),
        Tolerance::AtLeast => "at least".to_owned(),
    };
    let difference = match check.tolerance {
        Tolerance::AtLeast => "–".to_owned(),
        _ => signed(check.difference(), decimals + 1),
    };
    [with_unit(written(published, decimals)), with_unit(written(ours, decimals + 1)), difference, tolerance]
}

/// Number with fixed decimals, or in powers of ten if these would be too many; never "-0.00".
fn written(value: f64, decimals: usize) -> String {
    if value != 0.0 && value.abs() >= 1e5 {
        return format!("{value:.0e}");
    }
    let text = format!("{value:.decimals$}");
    if text.starts_with('-') && text[1..].chars().all(|c| c == '0' || c == '.') { text[1..].to_owned() } else { text }
}

/// Difference with its sign; no sign if it is zero to its last digit.
fn signed(value: f64, decimals: usize) -> String {
    let text = written(value, decimals);
    let is_zero = text.chars().all(|c| c == '0' || c == '.');
    if value > 0.0 && !is_zero { format!("+{text}") } else { text }
}

/// Tolerance in at most three digits.
fn shortest(value: f64) -> String {
    let digits = (2 - value.abs().log10().floor() as i32).clamp(0, 9) as usize;
    let text = format!("{value:.digits$}");
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_owned() } else { text }
}

/// Row of a check in VALIDATION.md.
fn row(check: &Check) -> String {
    let [published, ours, difference, tolerance] = cells(check, check.unit);
    let verdict = if check.holds() { "agrees" } else { "**differs**" };
    format!("| {} | {} | {published} | {ours} | {difference} | {tolerance} | {verdict} |", check.what, check.source)
}

/// Cells of a summary: number of checks, number that agree, maximum share of a tolerance, and the quantity with this
/// maximum.
fn summary(checks: &[&Check]) -> String {
    let agreeing = checks.iter().filter(|check| check.holds()).count();
    let shares = checks.iter().filter_map(|check| Some((check.share_of_tolerance()?, check.what.as_str())));
    let largest = shares.max_by(|(one, _), (other, _)| one.total_cmp(other));
    let (share, what) = largest.map_or(("–".to_owned(), ""), |(share, what)| (format!("{share:.2}"), what));
    format!("{} | {agreeing} | {share} | {what}", checks.len())
}

fn of_part(section: &Section, is_of: fn(&str) -> bool) -> Vec<&Check> {
    section.checks.iter().filter(|check| is_of(check.source)).collect()
}

/// Writes both files.
pub fn write() -> std::io::Result<()> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let sections = sections();
    std::fs::write(root.join("VALIDATION.md"), markdown(&sections))?;
    std::fs::write(root.join("docs/validation.csv"), table(&sections))
}

/// Text of VALIDATION.md.
pub fn markdown(sections: &[Section]) -> String {
    let mut lines = vec![format!("# Validation\n\n{PREFACE}\n\n{MADE}\n\n{SUMMARY}\n")];
    lines.push("| reference | what it is | numbers | agree | largest share | at |".to_owned());
    lines.push("|---|---|---:|---:|---:|---|".to_owned());
    for (name, what, is_of) in PARTS {
        let checks: Vec<&Check> = sections.iter().flat_map(|section| of_part(section, is_of)).collect();
        lines.push(format!("| {name} | {what} | {} |", summary(&checks)));
    }
    lines.push(format!("\n## Published by others\n\n{COLUMNS}"));
    for section in sections {
        let checks = of_part(section, is_published);
        if !checks.is_empty() {
            lines.push(format!("\n### {}\n", section.title));
            lines.push("| what | source | reference | ours | difference | tolerance | verdict |".to_owned());
            lines.push("|---|---|---:|---:|---:|---:|---|".to_owned());
            lines.extend(checks.into_iter().map(row));
        }
    }
    lines.push("\n## By theory and computed independently\n".to_owned());
    lines.push("| section | reference | numbers | agree | largest share | at |".to_owned());
    lines.push("|---|---|---:|---:|---:|---|".to_owned());
    for section in sections {
        for (name, _, is_of) in &PARTS[1..] {
            let checks = of_part(section, *is_of);
            if !checks.is_empty() {
                lines.push(format!("| {} | {name} | {} |", section.title, summary(&checks)));
            }
        }
    }
    lines.push("\n## How the numbers were made".to_owned());
    lines.extend(sections.iter().map(|section| format!("\n**{}.** {}", section.title, section.method)));
    lines.join("\n") + "\n"
}

/// Text of docs/validation.csv.
pub fn table(sections: &[Section]) -> String {
    let mut writer = csv::Writer::from_writer(Vec::new());
    let mut write = |cells: &[&str]| writer.write_record(cells).expect("memory takes every row");
    write(&[
        "part",
        "section",
        "id",
        "what",
        "source",
        "reference",
        "ours",
        "unit",
        "difference",
        "tolerance",
        "agrees",
    ]);
    for (part, _, is_of) in PARTS {
        for section in sections {
            for check in of_part(section, is_of) {
                let [published, ours, difference, tolerance] = cells(check, "");
                let agrees = if check.holds() { "yes" } else { "no" };
                let Check { id, what, source, unit, .. } = check;
                write(&[
                    part,
                    section.title,
                    id,
                    what,
                    source,
                    &published,
                    &ours,
                    unit,
                    &difference,
                    &tolerance,
                    agrees,
                ]);
            }
        }
    }
    String::from_utf8(writer.into_inner().expect("memory is flushed")).expect("cells are text")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn check(published: f64, ours: f64, tolerance: Tolerance) -> Check {
        Check::new("id", "what", (published, 2), ours, tolerance, "s")
    }

    #[test]
    fn a_row_shows_what_a_reader_needs() {
        assert!(row(&check(10.0, 10.0004, Tolerance::Relative(0.005))).contains("| 0.000 |"));
        let line = row(&check(10.0, 9.9996, Tolerance::Relative(0.005)));
        assert_eq!(line, "| what | independent computation | 10.00 s | 10.000 s | 0.000 | 0.5 % | agrees |");
        assert!(row(&check(10.0, 12.0, Tolerance::Absolute(0.025))).ends_with("| +2.000 | 0.025 s | **differs** |"));
    }

    #[test]
    fn a_section_is_summed_up_by_its_worst_number() {
        let checks = [check(10.0, 10.1, Tolerance::Absolute(0.2)), check(10.0, 10.3, Tolerance::Absolute(0.2))];
        assert_eq!(summary(&checks.each_ref()), "2 | 1 | 1.50 | what");
        assert_eq!(summary(&[&check(10.0, 10.1, Tolerance::AtLeast)]), "1 | 1 | – | ");
    }
}
