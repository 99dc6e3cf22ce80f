//! Estimates of outside estimators: names of exported records, and the table of their estimates, which is read back.

use std::collections::HashMap;
use std::path::Path;

use csv::{ReaderBuilder, StringRecord, Trim};
use identify::{OutsideErrors, OutsideFit};
use indexmap::IndexMap;
use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};
use ship::angle::from_deg;
use trial::file::{self, FileKind};

use crate::design::Design;
use crate::failure::Failure;
use crate::observer::Observer;
use crate::scenario::name::{quoted_beginning, slug};
use crate::scenario::outside_estimates::{CellAndReplicate, OutsideEstimates};
use crate::scenario::{Scenario, hex_digits};
use crate::shard::TrialId;

/// File next to exported records: their scenario and seed.
pub const TRIALS_FILE: &str = "trials.toml";

/// Contents of `trials.toml`. A scenario can be read from it as from a manifest.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub struct TrialsDocument {
    /// Name of the scenario.
    pub name: String,
    /// Seed of the run.
    pub seed: u64,
    /// SHA-256 of everything that determines the trials.
    pub design_sha256: String,
    /// The scenario file as it was read.
    pub scenario: String,
}

impl TrialsDocument {
    /// Description of the trials of a scenario.
    pub fn from_scenario(scenario: &Scenario) -> Self {
        let Scenario { name, seed, design_sha256, text, .. } = scenario;
        Self { name: name.clone(), seed: *seed, design_sha256: design_sha256.clone(), scenario: text.clone() }
    }
}

/// Name of the first record of a trial: scenario, cell and replicate; an index that cannot vary is omitted.
pub fn record_name(scenario: &Scenario, task: TrialId) -> String {
    let mut name = scenario.name.clone();
    if scenario.cells.len() > 1 {
        name += &format!("-{:0width$}", task.cell, width = (scenario.cells.len() - 1).to_string().len());
        let title = slug(&scenario.cells[task.cell].title());
        if !title.is_empty() {
            name += &format!("-{title}");
        }
    }
    if scenario.replicates > 1 {
        name += &format!("-{:0width$}", task.replicate, width = (scenario.replicates - 1).to_string().len());
    }
    name
}

/// Name of record `number` of a trial, from 0; further records carry their number.
pub fn numbered_record_name(record: &str, number: usize) -> String {
    if number == 0 { record.to_owned() } else { format!("{record}-also-{number}") }
}

/// Name and maximum size of a table of outside estimates, which suffices for one line per trial of a large study.
const TABLE: FileKind = FileKind { name: "a table of answers", max_bytes: 1 << 30 };

/// Names of the known columns: those that are read, and those copied from the list of trials.
const COLUMNS: &str =
    "method record cell replicate K_per_s T_s delta_r_deg K_sd_per_s T_sd_s delta_r_sd_deg failed label also";

/// Maximum number of columns that a message names.
const MAX_NAMED_COLUMNS: usize = 20;

/// Maximum number of faulty lines that a message names.
const MAX_NAMED_LINES: usize = 10;

/// Outside estimates from a table, by method, in the order of their first lines; the key `None` holds the lines without
/// a method.
///
/// A trial is identified by `record` (for measured records: those fitted together) or by `cell` and `replicate`. The
/// estimates are `K_per_s` and `T_s`; optional are `delta_r_deg`, the standard deviations `K_sd_per_s`, `T_sd_s` and
/// `delta_r_sd_deg`, and `failed`, the reason for a missing estimate. Warns of trials without a line and of unused
/// columns.
///
/// Fails if a column is missing, and for lines that match no trial, repeat one or contain no number; one message lists
/// these lines.
pub fn read(
    path: &Path,
    scenario: &Scenario,
    observer: &dyn Observer,
) -> Result<IndexMap<Option<String>, OutsideEstimates>, Failure> {
    let refuse = |problem: String| Failure::in_file(path, problem);
    let text = file::read_text(path, TABLE).map_err(|error| refuse(error.to_string()))?;
    let text = text.trim_start_matches('\u{feff}');
    let head = text.lines().next().unwrap_or_default();
    let separator = [b';', b'\t'].into_iter().find(|candidate| head.as_bytes().contains(candidate)).unwrap_or(b',');
    let mut table =
        ReaderBuilder::new().delimiter(separator).trim(Trim::All).flexible(true).from_reader(text.as_bytes());
    let columns =
        AnswerColumns::from_header(table.headers().map_err(|error| refuse(error.to_string()))?).map_err(refuse)?;
    if !columns.ignored.is_empty() {
        observer.warn(&format!("{}: columns that are not used: {}", path.display(), columns.ignored.join(", ")));
    }
    let records = Records::from_scenario(scenario);
    let mut lines: HashMap<(Option<String>, CellAndReplicate), u64> = HashMap::new();
    let mut answers: IndexMap<Option<String>, HashMap<CellAndReplicate, _>> = IndexMap::new();
    let mut faults = Vec::new();
    for row in table.records() {
        let row = row.map_err(|error| refuse(error.to_string()))?;
        let line = row.position().map_or(0, |position| position.line());
        let read = columns.places(&row, &records).and_then(|places| Ok((places, columns.answer(&row)?)));
        let method = columns.text(&row, "method").map(str::to_owned);
        let mut keep = |(places, answer): (Vec<CellAndReplicate>, Result<OutsideFit, String>)| {
            let by_trial = answers.entry(method.clone()).or_default();
            places.into_iter().fold(None, |before, place| {
                by_trial.insert(place, answer.clone());
                before.or(lines.insert((method.clone(), place), line))
            })
        };
        match read.map(&mut keep) {
            Ok(None) => {}
            Ok(Some(first)) => faults.push(format!("line {line}: its trial is already answered in line {first}")),
            Err(fault) => faults.push(format!("line {line}: {fault}")),
        }
    }
    if !faults.is_empty() {
        let more = faults.len().saturating_sub(MAX_NAMED_LINES);
        faults.truncate(MAX_NAMED_LINES);
        let more = if more > 0 { format!("\n  and {more} more") } else { String::new() };
        return Err(refuse(format!(
            "these lines do not answer trials of {}:\n  {}{more}\nexpected at most one line per trial, named as in the \
             trials.csv that `study simulate` writes beside the records",
            scenario.name,
            faults.join("\n  ")
        )));
    }
    if answers.is_empty() {
        answers.insert(None, HashMap::new());
    }
    answers.iter().for_each(|(method, given)| missing(path, scenario, method.as_deref(), given.len() as u64, observer));
    let sha256 = hex_digits(&Sha256::digest(text.as_bytes()));
    Ok(answers
        .into_iter()
        .map(|(method, by_trial)| (method, OutsideEstimates::new(by_trial, sha256.clone())))
        .collect())
}

/// Warns of trials without a line of a method, except under a stopping rule, which leaves their number open.
fn missing(path: &Path, scenario: &Scenario, method: Option<&str>, answered: u64, observer: &dyn Observer) {
    let trials = scenario.max_trials();
    let left = trials - answered;
    if left > 0 && scenario.stop.is_none() {
        let prefix = method.map_or_else(String::new, |method| format!("{method}: "));
        let problem = format!("{prefix}{left} of {trials} trials have no answer and count as failed");
        observer.warn(&format!("{}: {problem}", path.display()));
    }
}

/// Look-up from record names to trials.
struct Records<'a> {
    scenario: &'a Scenario,
    /// Cell index by record name without the replicate; most studies have far fewer cells than trials.
    cells: HashMap<String, u64>,
    /// Trials by the names of the records fitted together, in a study of measured records.
    fits: HashMap<String, Vec<CellAndReplicate>>,
}

impl<'a> Records<'a> {
    fn from_scenario(scenario: &'a Scenario) -> Self {
        let name = |cell: usize| record_name(scenario, TrialId { cell, replicate: 0 });
        let several = scenario.replicates > 1;
        let of_cell = |cell: usize| if several { stem(&name(cell)).0.to_owned() } else { name(cell) };
        let mut fits: HashMap<String, Vec<CellAndReplicate>> = HashMap::new();
        for (cell, facts) in Design::from_scenario(scenario).cells.into_iter().enumerate() {
            for (replicate, record) in facts.records.into_iter().enumerate() {
                fits.entry(record.fitted).or_default().push((cell as u64, replicate as u64));
            }
        }
        let cells = (0..scenario.cells.len()).map(|cell| (of_cell(cell), cell as u64)).collect();
        Self { scenario, cells, fits }
    }

    /// Trials of one line: the trial of a simulated record, by its file name, or all trials that share the fit
    /// of measured records, by their names as in `records.csv`. `None` for an unknown record.
    fn find(&self, record: &str) -> Option<Vec<CellAndReplicate>> {
        match self.fits.is_empty() {
            true => self.simulated(record).map(|trial| vec![trial]),
            false => self.fits.get(record.strip_suffix(".csv").unwrap_or(record)).cloned(),
        }
    }

    /// Trial of a simulated record, from its file name.
    fn simulated(&self, record: &str) -> Option<CellAndReplicate> {
        let file = record.rsplit(['/', '\\']).next().unwrap_or(record);
        let name = file.strip_suffix(".csv").unwrap_or(file);
        let (cell, replicate) = match self.scenario.replicates {
            0 | 1 => (name, 0),
            _ => stem(name).1.parse().ok().map(|number| (stem(name).0, number))?,
        };
        let task = TrialId { cell: *self.cells.get(cell)? as usize, replicate };
        let is_match = replicate < self.scenario.replicates && record_name(self.scenario, task) == name;
        is_match.then_some((task.cell as u64, replicate))
    }
}

/// Parts of a name before and after its last hyphen.
fn stem(name: &str) -> (&str, &str) {
    name.rsplit_once('-').unwrap_or((name, ""))
}

/// Column indices of a table of outside estimates.
struct AnswerColumns {
    places: HashMap<String, usize>,
    ignored: Vec<String>,
}

impl AnswerColumns {
    fn from_header(head: &StringRecord) -> Result<Self, String> {
        let mut places = HashMap::new();
        for (place, name) in head.iter().enumerate() {
            // Of several columns with one name the first is used.
            places.entry(name.to_owned()).or_insert(place);
        }
        let has = |names: &[&str]| names.iter().all(|name| places.contains_key(*name));
        if !has(&["K_per_s", "T_s"]) || !has(&["record"]) && !has(&["cell", "replicate"]) {
            let names: Vec<String> = head.iter().take(MAX_NAMED_COLUMNS).map(quoted_beginning).collect();
            return Err(format!(
                "the columns are {}; expected `record`, or `cell` and `replicate`, beside `K_per_s` and `T_s`",
                names.join(", ")
            ));
        }
        let is_known = |column: &&str| COLUMNS.split(' ').any(|name| name == *column);
        let ignored = head.iter().filter(|key| !is_known(key)).take(MAX_NAMED_COLUMNS).map(quoted_beginning).collect();
        Ok(Self { places, ignored })
    }

    /// Text of a row in a column; `None` if it is empty.
    fn text<'a>(&self, row: &'a StringRecord, name: &str) -> Option<&'a str> {
        row.get(*self.places.get(name)?).filter(|text| !text.is_empty())
    }

    fn number(&self, row: &StringRecord, name: &str) -> Result<Option<f64>, String> {
        let Some(text) = self.text(row, name) else { return Ok(None) };
        let number =
            text.parse::<f64>().map_err(|_| format!("{name} is {}; expected a number", quoted_beginning(text)))?;
        Ok(Some(number).filter(|number| number.is_finite()))
    }

    fn places(&self, row: &StringRecord, records: &Records) -> Result<Vec<CellAndReplicate>, String> {
        if let Some(record) = self.text(row, "record") {
            return records
                .find(record)
                .ok_or_else(|| format!("{} is not a record of this scenario", quoted_beginning(record)));
        }
        let whole = |name: &str| {
            let text = self.text(row, name).unwrap_or_default();
            text.parse::<u64>()
                .map_err(|_| format!("{name} is {}; expected a whole number from 0", quoted_beginning(text)))
        };
        let (cell, replicate) = (whole("cell")?, whole("replicate")?);
        let count = records.scenario.cells.len();
        let trials = usize::try_from(cell).ok().filter(|&cell| cell < count);
        let trials = trials.map_or(0, |cell| records.scenario.max_cell_trials(cell));
        match replicate < trials {
            true => Ok(vec![(cell, replicate)]),
            false if cell < count as u64 => Err(format!(
                "there is no trial {replicate} of cell {cell}; this cell has {trials} trials, counted from 0"
            )),
            false => Err(format!("there is no cell {cell}; the scenario has {count} cells, counted from 0")),
        }
    }

    fn answer(&self, row: &StringRecord) -> Result<Result<OutsideFit, String>, String> {
        let number = |name: &str| self.number(row, name);
        let (k, t, bias) = (number("K_per_s")?, number("T_s")?, number("delta_r_deg")?);
        let sd = [number("K_sd_per_s")?, number("T_sd_s")?, number("delta_r_sd_deg")?.map(from_deg)];
        let errors = if sd == [None; 3] { OutsideErrors::Unknown } else { OutsideErrors::Deviations(sd) };
        let missing = |name: &str| format!("{name} is missing or not a finite number");
        Ok(match (self.text(row, "failed"), k, t) {
            (Some(reason), _, _) => Err(reason.to_owned()),
            (None, Some(k), Some(t)) => {
                Ok(OutsideFit { K: k, T: t, rudder_bias: from_deg(bias.unwrap_or(0.0)), errors })
            }
            (None, None, _) => Err(missing("K_per_s")),
            (None, Some(_), None) => Err(missing("T_s")),
        })
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Mutex;

    use crate::scenario::MethodName;

    use super::*;
    use crate::testing::zig_zag;

    const TWO_CELLS: &str = "[[sweep]]\nkey = \"sensor.heading-noise-deg\"\nvalues = [0.1, 0.2]\n";

    #[derive(Default)]
    struct KeptWarnings(Mutex<String>);

    impl Observer for KeptWarnings {
        fn warn(&self, line: &str) {
            *self.0.lock().expect("nobody panics") += line;
        }
    }

    fn read_from(text: &str, scenario: &Scenario) -> (Result<OutsideEstimates, String>, String) {
        let desk = tempfile::tempdir().expect("a folder");
        let path = desk.path().join("answers.csv");
        std::fs::write(&path, text).expect("written");
        let warnings = KeptWarnings::default();
        let read = read(&path, scenario, &warnings).map_err(|failure| failure.message);
        let read = read.map(|mut answers| answers.shift_remove(&None).expect("answers of nobody in particular"));
        (read, warnings.0.into_inner().expect("nobody panics"))
    }

    #[test]
    fn every_record_is_known_by_its_name() {
        for (cells, replicates) in [("", 1), ("", 12), (TWO_CELLS, 1), (TWO_CELLS, 1000)] {
            let scenario = zig_zag(replicates, cells);
            let records = Records::from_scenario(&scenario);
            for task in (0..scenario.cells.len())
                .flat_map(|cell| [0, replicates - 1].map(|replicate| TrialId { cell, replicate }))
            {
                let name = record_name(&scenario, task);
                for written in [name.clone(), format!("{name}.csv"), format!("a/b/{name}.csv"), format!("c:\\{name}")] {
                    assert_eq!(records.find(&written), Some(vec![(task.cell as u64, task.replicate)]), "{written}");
                }
                assert_eq!(records.find(&numbered_record_name(&name, 1)), None);
                assert_eq!(records.find(&format!("{name}9")), None);
            }
        }
    }

    #[test]
    fn a_table_is_read_as_it_comes() {
        let scenario = zig_zag(3, TWO_CELLS);
        let by_record = "\u{feff}label;record ;K_per_s;T_s;delta_r_deg;K_sd_per_s;T_sd_s;failed;seconds\n\
                         0.1;it-0-0-1-2.csv;0.1;16;1.5;0.01;1;;3\n;it-1-0-2-0.csv;NaN;16;;;;;3\n;it-1-0-2-1;;;;;;no luck;3\n";
        let (read, warnings) = read_from(by_record, &scenario);
        let answers = read.expect("a table of answers");
        let good = answers.estimate((0, 2)).expect("an answer");
        assert!(
            (good.response.rudder_bias - from_deg(1.5)).abs() < 1e-15
                && (good.K().sd.expect("given") - 0.01).abs() < 1e-12
        );
        let failure = |place| answers.estimate(place).expect_err("none").to_string();
        assert_eq!(failure((1, 0)), "outside: K_per_s is missing or not a finite number");
        assert_eq!((failure((1, 1)), failure((0, 0))), ("outside: no luck".into(), "outside: no answer".into()));
        assert!(
            warnings.contains("\"seconds\"") && !warnings.contains("label") && warnings.contains("3 of 6 trials"),
            "{warnings}"
        );
        let (read, warnings) = read_from("cell,replicate,K_per_s,T_s\n1,2,0.1,16\n", &scenario);
        assert_eq!(read.expect("a table").estimate((1, 2)).expect("an answer").K().value, 0.1);
        assert!(warnings.contains("5 of 6 trials"));
        let named = scenario.with_outside_estimates("mine", answers).unwrap_or_else(|failure| panic!("{failure}"));
        let last = MethodName { label: "mine".into(), id: "external".into() };
        assert_eq!(named.method_names().pop(), Some(last));
    }

    #[test]
    fn what_is_no_answer_is_refused_with_its_line() {
        let scenario = zig_zag(3, TWO_CELLS);
        let refused = |text: &str, parts: &[&str]| {
            let error = read_from(text, &scenario).0.expect_err("refused");
            parts.iter().for_each(|part| assert!(error.contains(part), "{part}: {error}"));
        };
        refused("", &["expected `record`"]);
        refused("record,K_per_s\n", &["\"record\", \"K_per_s\"", "`T_s`"]);
        refused("cell,K_per_s,T_s\n", &["`cell` and `replicate`"]);
        refused(
            "cell,replicate,K_per_s,T_s\n0,0,1,1\n0,3,1,1\n2,0,1,1\n0,0,1,1\n-1,0,1,1\n0,1,a lot,1\n",
            &[
                "line 3: there is no trial 3 of cell 0",
                "line 4: there is no cell 2",
                "line 5: its trial is already answered in line 2",
                "line 6: cell is \"-1\"",
                "line 7: K_per_s is \"a lot\"; expected a number",
            ],
        );
        refused("record,K_per_s,T_s\nother.csv,1,1\n", &["line 2: \"other.csv\" is not a record of this scenario"]);
        let many: String = (0..100).map(|line| format!("x{line},1,1\n")).collect();
        refused(&format!("record,K_per_s,T_s\n{many}"), &["line 11: ", "and 90 more"]);
    }
}
