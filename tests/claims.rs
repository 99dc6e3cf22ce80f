//! Sentences with numbers, held against the stored results they are about: `claims.toml` says which number is which
//! figure. A number is right when the stored one, rounded to as many digits, is it. A word such as "smallest" or "at
//! the bound" is a test on the ends of intervals. Every number of a finding stands in a sentence that is held, be it of
//! a scenario or of what is published beside them.
//!
//! `KEMPF_CLAIMS=write cargo test -p kempf-tests --test all claims` writes the stored numbers into the pages and into
//! `claims.toml`, copies the tables, and then tests: what fails after that is a word.

mod stored;
mod wording;

use std::collections::BTreeMap;
use std::sync::Once;

use serde::Deserialize;
use stored::{Number, in_markdown, read, root};
use wording::{Edit, edited, edits, in_the_form_of, is_rounded, numbers, places, sentences};

/// All claims.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Claims {
    /// Pages in which every number has to stand in a claim, beside the findings of the scenarios.
    held: Vec<String>,
    claim: Vec<Claim>,
    copy: Vec<TableCopy>,
}

/// A stored table that stands in a page, below a comment `<!-- Table: PATH -->`.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct TableCopy {
    page: String,
    table: String,
    /// Cells of the rows that are copied.
    rows: BTreeMap<String, String>,
    /// Columns, each with its heading in the page.
    columns: Vec<[String; 2]>,
}

/// One sentence, or a part of one.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Claim {
    /// Files it stands in, from the root of the repository.
    pages: Vec<String>,
    /// The words, with every number in braces, `{89.8} %`.
    says: String,
    /// The table of the numbers, or a report in whose words they stand.
    table: String,
    /// The figure of every number, in their order.
    #[serde(default)]
    numbers: Vec<Number>,
    /// Figures that lie where a word puts them: "at the bound" is an interval that reaches to one.
    #[serde(default)]
    within: Vec<Within>,
    /// Figures that stand in an order: "the smallest error" has an interval that ends below the other one.
    #[serde(default)]
    order: Vec<Order>,
}

/// A figure between two ends.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Within {
    figure: Number,
    least: Option<f64>,
    most: Option<f64>,
}

/// Two figures, the smaller one first.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Order {
    smaller: Number,
    larger: Number,
}

impl Claim {
    /// What is wrong with it.
    fn faults(&self) -> Vec<String> {
        let plain = self.says.replace(['{', '}'], "");
        let mut faults = Vec::new();
        for page in &self.pages {
            match read(page) {
                Ok(text) if !places(&text, &plain).is_empty() => {}
                Ok(_) => faults.push(format!("{page} does not say: {plain}")),
                Err(error) => faults.push(error),
            }
        }
        let written = numbers(&self.says);
        if written.len() != self.numbers.len() {
            faults.push(format!("{} numbers and {} figures in: {plain}", written.len(), self.numbers.len()));
        }
        for (written, number) in written.iter().zip(&self.numbers) {
            match number.stored(&self.table) {
                Ok(stored) if is_rounded(written, stored) => {}
                Ok(stored) => faults.push(format!("{written} is {stored} in {}: {plain}", self.table)),
                Err(error) => faults.push(format!("{error}: {plain}")),
            }
        }
        for Within { figure, least, most } in &self.within {
            match figure.stored(&self.table) {
                Ok(stored) if least.is_none_or(|end| end <= stored) && most.is_none_or(|end| stored <= end) => {}
                Ok(stored) => faults.push(format!("{} is {stored} in {}: {plain}", figure.column, self.table)),
                Err(error) => faults.push(format!("{error}: {plain}")),
            }
        }
        for Order { smaller, larger } in &self.order {
            match (smaller.stored(&self.table), larger.stored(&self.table)) {
                (Ok(one), Ok(other)) if one < other => {}
                (Ok(one), Ok(other)) => faults.push(format!("{one} is not below {other} in {}: {plain}", self.table)),
                (Err(error), _) | (_, Err(error)) => faults.push(format!("{error}: {plain}")),
            }
        }
        if self.numbers.is_empty() && self.within.is_empty() && self.order.is_empty() {
            faults.push(format!("nothing is held against the tables: {plain}"));
        }
        faults
    }
}

impl TableCopy {
    /// The page with the table as it is stored now.
    fn renewed(&self) -> Result<String, String> {
        let Self { page, table, rows, columns } = self;
        let text = read(page)?;
        let mark = format!("<!-- Table: {table} -->\n\n");
        let (before, rest) = text.split_once(&mark).ok_or_else(|| format!("{page} has no {}", mark.trim()))?;
        let length: usize = rest.split_inclusive('\n').take_while(|line| line.starts_with('|')).map(str::len).sum();
        Ok(format!("{before}{mark}{}{}", in_markdown(table, rows, columns)?, &rest[length..]))
    }
}

const CLAIMS: &str = "tests/claims.toml";
/// What is published beside the studies.
const PLAN: &str = "results/publish.toml";

fn claims() -> Claims {
    let read = || toml::from_str(&read(CLAIMS).expect("it is there")).expect("it is right");
    // Tests run beside each other, and one of them writes.
    static WRITTEN: Once = Once::new();
    WRITTEN.call_once(|| {
        if std::env::var("KEMPF_CLAIMS").is_ok_and(|what| what == "write") {
            write(&read()).unwrap_or_else(|fault| panic!("{fault}"));
        }
    });
    read()
}

/// Writes the stored numbers into all pages and into the claims. What cannot be written stays, and fails later.
fn write(claims: &Claims) -> Result<(), String> {
    let mut wanted: BTreeMap<&str, Vec<Edit>> = BTreeMap::new();
    let list = read(CLAIMS)?;
    for claim in &claims.claim {
        let stored: Result<Vec<f64>, String> = claim.numbers.iter().map(|number| number.stored(&claim.table)).collect();
        let (Ok(stored), old) = (stored, numbers(&claim.says)) else { continue };
        let new: Vec<String> = old.iter().zip(stored).map(|(old, stored)| in_the_form_of(old, stored)).collect();
        for page in &claim.pages {
            wanted.entry(page).or_default().extend(edits(&read(page)?, &claim.says, &new));
        }
        let mut says = claim.says.split_inclusive('{').map(str::to_owned).collect::<Vec<String>>();
        for (part, new) in says.iter_mut().skip(1).zip(&new) {
            let end = part.find('}').expect("a brace is closed");
            part.replace_range(..end, new);
        }
        let line = format!("says = {:?}", claim.says);
        let at = list.find(&line).ok_or_else(|| format!("{CLAIMS} has this in another form: {line}"))?;
        wanted.entry(CLAIMS).or_default().push((at, at + line.len() - 1, format!("says = {:?}", says.concat())));
    }
    for (page, edits) in wanted {
        let text = edited(&read(page)?, edits).map_err(|fault| format!("{page}: {fault}"))?;
        std::fs::write(root().join(page), text).map_err(|error| format!("{page}: {error}"))?;
    }
    for copy in &claims.copy {
        std::fs::write(root().join(&copy.page), copy.renewed()?).map_err(|error| error.to_string())?;
    }
    Ok(())
}

/// The numbers of a text that stand in no claim of its page.
fn unheld(page: &str, text: &str, claims: &Claims) -> Vec<String> {
    let own = claims.claim.iter().filter(|claim| claim.pages.iter().any(|own| own == page));
    let spans: Vec<(usize, usize)> = own
        .flat_map(|claim| places(text, &claim.says.replace(['{', '}'], "")))
        .map(|place| (place[0], place[place.len() - 1]))
        .collect();
    let is_free = |place: usize| !spans.iter().any(|(from, to)| (*from..*to).contains(&place));
    let free = text.char_indices().filter(|(place, letter)| is_free(*place) || letter.is_whitespace());
    let free = sentences(&free.map(|(_, letter)| letter).collect::<String>());
    let has_digit = |line: &&str| line.chars().any(|letter| letter.is_ascii_digit());
    free.lines().filter(has_digit).map(|line| format!("{page}: in no claim: {}", line.trim())).collect()
}

/// Sentences say what the tables say.
#[test]
fn claims_follow_from_the_stored_results() {
    let claims = claims();
    let mut faults: Vec<String> = claims.claim.iter().flat_map(Claim::faults).collect();
    for copy in &claims.copy {
        match (copy.renewed(), read(&copy.page)) {
            (Ok(renewed), Ok(page)) if renewed == page => {}
            (Ok(_), Ok(_)) => faults.push(format!("{} has another table than {}", copy.page, copy.table)),
            (Err(error), _) | (_, Err(error)) => faults.push(error),
        }
    }
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

/// No number of a result stands where nothing holds it.
#[test]
fn numbers_of_findings_are_held() {
    let claims = claims();
    let mut faults: Vec<String> = Vec::new();
    let folders = ["scenarios", "scenarios/measured"].map(|folder| {
        let entries = std::fs::read_dir(root().join(folder)).expect("the folder is there").flatten();
        entries.map(move |entry| format!("{folder}/{}", entry.file_name().display()))
    });
    for page in folders.into_iter().flatten() {
        let Some(scenario) = read(&page).ok().and_then(|text| text.parse::<toml::Table>().ok()) else { continue };
        let finding = scenario.get("finding").and_then(|finding| finding.as_str()).unwrap_or_default();
        faults.extend(unheld(&page, finding, &claims));
    }
    let plan: toml::Table = read(PLAN).expect("it is there").parse().expect("it is TOML");
    for (list, key) in [("program", "finding"), ("question", "answer")] {
        let texts = plan[list].as_array().expect("a list").iter().filter_map(|entry| entry.get(key)?.as_str());
        texts.for_each(|text| faults.extend(unheld(PLAN, text, &claims)));
    }
    for page in &claims.held {
        faults.extend(unheld(page, &read(page).expect("it is there"), &claims));
    }
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}
