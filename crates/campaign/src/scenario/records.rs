//! Studies of measured records: `[records]` replaces ship, manoeuvre and instruments. Methods are fitted to some
//! records of a ship and validated on others outside the fit (hold-out validation, Ljung 1999).

use std::collections::{BTreeMap, HashSet};
use std::fmt::Display;
use std::path::{Path, PathBuf};
use std::sync::OnceLock;

use ::trace::without_spikes;
use report::number::counted;
use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};
use toml::Table;
use trial::file;
use trial::reader::RECORD_FILE;
use trial::sidecar::SIDECAR_FILE;
use trial::{RecordOrigin, Sidecar, Trial};

use crate::disk;
use crate::scenario::identity;
use crate::scenario::method::IdentifierWire;
use crate::scenario::predictions::RecordPredictWire;
use crate::scenario::problem::{KeyFault, KeyPath, choice_index};
use crate::scenario::prose::Presentation;
use crate::scenario::sweep::AxisWire;

/// Environment variable for the folder of records that are not next to the scenario.
pub const DATA_FOLDER_VARIABLE: &str = "KEMPF_DATA";

/// Maximum number of records of a cell.
const MAX_RECORDS: usize = 1000;

/// Scenario of measured records.
#[derive(Debug, Clone, Deserialize, Serialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
#[schemars(rename = "RecordStudyWire")]
pub struct RecordScenarioWire {
    /// Question of the study, in one sentence.
    pub question: String,
    /// Interpretation of the results, in paragraphs.
    #[serde(default)]
    pub analysis: String,
    /// Result in one sentence.
    #[serde(default)]
    pub finding: String,
    /// Seed of the methods and predictions that use random numbers.
    #[serde(default)]
    pub seed: u64,
    /// Records and their split.
    pub records: RecordsWire,
    /// Prediction of every validation record.
    pub(crate) predict: Option<RecordPredictWire>,
    /// Methods, all on the same records.
    pub(crate) identifier: Vec<IdentifierWire>,
    /// Axes of the design, such as one of several ships.
    #[serde(default)]
    pub(crate) sweep: Vec<AxisWire>,
    /// Selection of plots.
    #[serde(default)]
    pub output: Presentation,
}

/// Measured records of one ship.
#[derive(Debug, Clone, Deserialize, Serialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct RecordsWire {
    /// Files, with `*` for any text in a name; from the folder of the scenario, or else from that of KEMPF_DATA. Or
    /// a table of files and their SHA-256: absent files are omitted, with a warning.
    pub files: FilesWire,
    /// Sidecar that describes the columns of all of them, or a list with one for each entry of `files`; a folder means
    /// the NAME.trial.toml of each record in it. If omitted, each record has its own sidecar next to it, if any.
    pub sidecar: Option<SidecarWire>,
    /// Split into fitted records and validation records.
    #[serde(default)]
    pub judge: JudgeWire,
}

/// Files of records.
#[derive(Debug, Clone, Deserialize, Serialize, schemars::JsonSchema)]
#[serde(untagged, expecting = "a list of files, or a table with the SHA-256 of each")]
pub enum FilesWire {
    /// Files that must all be present.
    Patterns(Vec<String>),
    /// Files and their SHA-256, hexadecimal.
    Checksummed(BTreeMap<String, String>),
}

/// Description of the columns of records.
#[derive(Debug, Clone, Deserialize, Serialize, schemars::JsonSchema)]
#[serde(untagged, expecting = "a sidecar or a folder of them, or a list with one for each entry of `files`")]
pub enum SidecarWire {
    /// Sidecar of all records.
    All(String),
    /// Sidecars of the records of each entry of the files.
    Each(Vec<String>),
}

/// Split into fitted records and validation records.
#[derive(Debug, Clone, Deserialize, Serialize, schemars::JsonSchema)]
#[serde(untagged, expecting = "\"others\", \"left-out\", \"none\", or a table with `fit` and `judge`")]
pub enum JudgeWire {
    /// Split by a rule.
    Rule(HoldOutRule),
    /// Split by lists of names of records.
    Lists {
        /// Fitted records: together, or each alone.
        fit: Vec<String>,
        /// Validation records; if each is fitted alone, all but the fitted one.
        judge: Vec<String>,
        /// `true` if each record is fitted alone.
        #[serde(default)]
        each: bool,
    },
}

/// Rule of the split.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, Serialize, schemars::JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum HoldOutRule {
    /// Each record is fitted alone and validated on all others.
    Others,
    /// All records but one are fitted together and validated on that one, in turn.
    LeftOut,
    /// Each record is fitted alone, without validation.
    None,
}

impl Default for JudgeWire {
    fn default() -> Self {
        Self::Rule(HoldOutRule::Others)
    }
}

/// Split of records in one trial: indices of the fitted records and of the validation record.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct RecordSplit {
    /// Indices of the records fitted together.
    pub fitted_indices: Vec<usize>,
    /// Index of the validation record; `None` without validation.
    pub validation_index: Option<usize>,
}

/// Records of a cell, with the splits of the trials.
pub struct RecordSet {
    /// Records, in the order of the listed files; those that match one pattern are sorted by name.
    pub trials: Vec<Trial>,
    /// Splits of the trials; equal fits are adjacent.
    pub splits: Vec<RecordSplit>,
    /// Absent files among those listed with a SHA-256, with the reason.
    pub absent_files: Vec<(String, String)>,
    /// Warnings of the reader, one line each.
    pub warnings: Vec<String>,
    /// SHA-256 of all files and their sidecars, hexadecimal.
    sha256: String,
    /// Cache of [`without_spikes`](Self::without_spikes).
    without_spikes: OnceLock<Vec<Trial>>,
}

impl RecordSet {
    /// Name of a record.
    pub fn name(&self, place: usize) -> &str {
        self.trials[place].name()
    }

    /// Records without heading spikes, which are excluded from all errors.
    pub(crate) fn without_spikes(&self) -> &[Trial] {
        self.without_spikes.get_or_init(|| without_spikes(&self.trials).0.into_owned())
    }

    /// Records of a `[records]` table.
    ///
    /// Fails if a file without a SHA-256 is missing, if a present file is not a record, if a name repeats, and if no
    /// split is possible although all records are present.
    pub(crate) fn read(wire: &RecordsWire, folder: &Path) -> Result<Self, KeyFault> {
        let key = KeyPath::from_dotted("records");
        let ListedFiles { paths, absent } = files(wire, folder, &key)?;
        let mut digest = Sha256::new();
        let (mut trials, mut warnings) = (Vec::new(), Vec::new());
        for (path, sidecar) in &paths {
            let refuse = |problem: &dyn Display| {
                let advice = "`study fit` says what is wrong with it";
                let problem = format!("{}: {problem}", path.display());
                KeyFault::value(key.child("files"), problem, "expected a record that can be read", advice)
            };
            let read = trial::read_with_sidecar(path, sidecar.as_deref()).map_err(|error| refuse(&error))?;
            if let RecordOrigin::Measured { sha256, .. } = read.trial.origin() {
                digest.update(sha256);
            }
            if let Some(sidecar) = sidecar {
                let text = file::read_text(sidecar, SIDECAR_FILE).map_err(|error| refuse(&error))?;
                digest.update(Sha256::digest(text));
            }
            warnings.extend(read.warnings.iter().map(|warning| format!("{}: {}", path.display(), warning.text)));
            trials.push(read.trial);
        }
        let names: Vec<&str> = trials.iter().map(Trial::name).collect();
        let mut seen = HashSet::new();
        let twice = names.iter().find(|name| !seen.insert(**name));
        if twice.is_some() || names.len() > MAX_RECORDS {
            let problem =
                twice.map_or_else(|| format!("{} records", names.len()), |name| format!("{name} is listed twice"));
            let expected = format!("expected at most {MAX_RECORDS} records, each with a name of its own");
            return Err(KeyFault::value(key.child("files"), problem, expected, "remove or rename a record"));
        }
        let stem = |file: &str| Path::new(file).file_stem().unwrap_or_default().to_string_lossy().into_owned();
        let absent_names: Vec<String> = absent.iter().map(|(file, _)| stem(file)).collect();
        let splits = splits(&wire.judge, &names, &absent_names, &key.child("judge"))?;
        let (sha256, without_spikes) = (identity::hex_digits(&digest.finalize()), OnceLock::new());
        Ok(Self { trials, splits, absent_files: absent, warnings, sha256, without_spikes })
    }
}

/// Files of records, present and absent.
#[derive(Default)]
struct ListedFiles {
    /// Present files, each with its sidecar, if any.
    paths: Vec<(PathBuf, Option<PathBuf>)>,
    /// Absent files, with the reason.
    absent: Vec<(String, String)>,
}

/// Files of a `[records]` table.
fn files(wire: &RecordsWire, folder: &Path, records: &KeyPath) -> Result<ListedFiles, KeyFault> {
    let key = &records.child("files");
    let entries: Vec<(KeyPath, &String, Option<&String>)> = match &wire.files {
        FilesWire::Patterns(list) => {
            (0..).zip(list).map(|(at, file): (usize, _)| (key.child(at), file, None)).collect()
        }
        FilesWire::Checksummed(table) => table.iter().map(|(file, hash)| (key.child(file), file, Some(hash))).collect(),
    };
    let sidecars: Vec<Option<PathBuf>> = match &wire.sidecar {
        None => vec![None; entries.len()],
        Some(SidecarWire::All(path)) => vec![Some(folder.join(path)); entries.len()],
        Some(SidecarWire::Each(paths)) if paths.len() == entries.len() => {
            paths.iter().map(|path| Some(folder.join(path))).collect()
        }
        Some(SidecarWire::Each(paths)) => {
            let problem = counted(paths.len() as u64, "sidecar");
            let expected = format!("expected one for each entry of `files`, which has {}", entries.len());
            return Err(KeyFault::value(
                records.child("sidecar"),
                problem,
                expected,
                "give one path for all, or as many",
            ));
        }
    };
    let mut files = ListedFiles::default();
    for ((place, file, sha256), sidecar) in entries.into_iter().zip(sidecars) {
        let paths = match sha256 {
            Some(sha256) if sha256.len() != 64 || !sha256.bytes().all(|digit| digit.is_ascii_hexdigit()) => {
                let problem = format!("the SHA-256 of {file} is {sha256:?}");
                return Err(KeyFault::value(place, problem, "expected 64 hexadecimal digits", "see sha256sum"));
            }
            Some(sha256) => match verified_path(folder, file, &sha256.to_ascii_lowercase()) {
                Ok(path) => vec![path],
                Err(reason) => {
                    files.absent.push((file.clone(), reason));
                    continue;
                }
            },
            None => matching(folder, file),
        };
        if paths.is_empty() {
            let advice = format!("give files beside the scenario, or name their folder in {DATA_FOLDER_VARIABLE}");
            let problem = format!("`records.files` holds {file:?}, and there is no such file");
            return Err(KeyFault::value(place, problem, "expected records", advice));
        }
        files.paths.extend(paths.into_iter().map(|path| {
            let sidecar = Sidecar::path_for(&path, sidecar.as_deref());
            (path, sidecar)
        }));
    }
    Ok(files)
}

/// Path of a file with this SHA-256. Fails with the reason, without the path.
fn verified_path(folder: &Path, file: &str, sha256: &str) -> Result<PathBuf, String> {
    let path = matching(folder, file).into_iter().next().ok_or("there is no such file")?;
    let bytes = disk::read(&path, RECORD_FILE.max_bytes).map_err(|error| format!("it cannot be read: {error}"))?;
    let hash = identity::hex_digits(&Sha256::digest(bytes.unwrap_or_default()));
    if hash == sha256 {
        return Ok(path);
    }
    Err(format!("it is another file: its SHA-256 begins with {}, expected {}", &hash[..12], &sha256[..12]))
}

/// Splits of a cell, without those that require an absent record.
fn splits(judge: &JudgeWire, names: &[&str], absent: &[String], key: &KeyPath) -> Result<Vec<RecordSplit>, KeyFault> {
    let all = 0..names.len();
    let without = |excluded: usize| all.clone().filter(|place| *place != excluded).collect::<Vec<usize>>();
    let split = |fitted: Vec<usize>, judge| RecordSplit { fitted_indices: fitted, validation_index: judge };
    let splits: Vec<RecordSplit> = match judge {
        JudgeWire::Rule(HoldOutRule::None) => all.map(|record| split(vec![record], None)).collect(),
        JudgeWire::Rule(HoldOutRule::Others) => {
            let pairs = |fitted: usize| without(fitted).into_iter().map(move |judge| split(vec![fitted], Some(judge)));
            all.clone().flat_map(pairs).collect()
        }
        JudgeWire::Rule(HoldOutRule::LeftOut) if names.len() > 1 => {
            all.clone().map(|judge| split(without(judge), Some(judge))).collect()
        }
        JudgeWire::Rule(HoldOutRule::LeftOut) => Vec::new(),
        JudgeWire::Lists { fit, judge, each } => {
            let places = |list: &[String], part: &str| -> Result<Vec<usize>, KeyFault> {
                let place = |name: &String| {
                    let messages = ["no record is called", "expected the name of a file, without its ending"];
                    let key = key.child(part);
                    choice_index(name, names, key, messages)
                };
                list.iter().filter(|name| !absent.contains(name)).map(place).collect()
            };
            let is_whole = *each || !fit.iter().any(|name| absent.contains(name));
            let (fit, judge) = (places(fit, "fit")?, places(judge, "judge")?);
            let fit = if is_whole { fit } else { Vec::new() };
            if let Some(both) = fit.iter().find(|record| !each && judge.contains(record)) {
                let problem = format!("{} is in both lists", names[*both]);
                return Err(KeyFault::value(
                    key.clone(),
                    problem,
                    "expected each record once",
                    "remove it from `fit` or from `judge`",
                ));
            }
            let fits = match each {
                true => fit.into_iter().map(|record| vec![record]).collect(),
                false => vec![fit],
            };
            let judged = |fit: Vec<usize>| {
                let judges = judge.iter().filter(|record| !fit.is_empty() && !fit.contains(record)).copied();
                judges.map(|record| split(fit.clone(), Some(record))).collect::<Vec<_>>()
            };
            fits.into_iter().flat_map(judged).collect()
        }
    };
    if splits.is_empty() && absent.is_empty() {
        let advice = "give more records, or `judge = \"none\"` to fit each alone";
        let problem = format!("{}, which leaves none to judge another", counted(names.len() as u64, "record"));
        return Err(KeyFault::value(
            key.clone(),
            problem,
            "expected at least one record to fit and one to judge",
            advice,
        ));
    }
    Ok(splits)
}

/// Files that match a pattern, sorted: next to the scenario, otherwise in the folder of [`DATA_FOLDER_VARIABLE`].
fn matching(folder: &Path, pattern: &str) -> Vec<PathBuf> {
    let data = std::env::var_os(DATA_FOLDER_VARIABLE).map(PathBuf::from);
    let below = |folder: &Path| -> Vec<PathBuf> {
        let path = folder.join(pattern);
        let name = path.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
        if !name.contains('*') {
            return Some(path).filter(|path| path.is_file()).into_iter().collect();
        }
        let entries = path.parent().and_then(|parent| parent.read_dir().ok()).into_iter().flatten().flatten();
        let is_one = |entry: &std::fs::DirEntry| fits(&entry.file_name().to_string_lossy(), &name);
        let mut files: Vec<PathBuf> = entries.filter(is_one).map(|entry| entry.path()).collect();
        files.retain(|path| path.is_file());
        files.sort();
        files
    };
    let files = below(folder);
    if files.is_empty() { data.map_or(files, |data| below(&data)) } else { files }
}

/// `true` if a name matches a pattern with `*` for any text.
fn fits(name: &str, pattern: &str) -> bool {
    let mut parts = pattern.split('*');
    let Some(mut tail) = parts.next().and_then(|first| name.strip_prefix(first)) else { return false };
    let parts: Vec<&str> = parts.collect();
    let Some((last, middle)) = parts.split_last() else { return tail.is_empty() };
    for part in middle {
        let Some(place) = tail.find(part) else { return false };
        tail = &tail[place + part.len()..];
    }
    tail.ends_with(last)
}

/// SHA-256 of a design and of the records of its cells.
pub(crate) fn design_sha256<'a>(design: &Table, sets: impl Iterator<Item = &'a RecordSet>) -> String {
    let mut digest = Sha256::new_with_prefix(design.to_string());
    sets.for_each(|set| digest.update(&set.sha256));
    identity::hex_digits(&digest.finalize())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn stars_stand_for_anything() {
        for (name, pattern, holds) in [
            ("zigzag_10.csv", "zigzag_*.csv", true),
            ("zigzag_10.csv", "*", true),
            ("zigzag_10.csv", "*10*", true),
            ("zigzag_10.csv", "zigzag_*.txt", false),
            ("a.csv", "a.csv", true),
            ("a.csv.bak", "a.csv", false),
            ("ab", "ab*b", false),
        ] {
            assert_eq!(fits(name, pattern), holds, "{name} {pattern}");
        }
    }

    #[test]
    fn records_are_shared_out_by_rules_and_lists() {
        let names = ["a", "b", "c"];
        let key = KeyPath::from_dotted("records.judge");
        let of = |judge: &JudgeWire| -> Vec<(Vec<usize>, Option<usize>)> {
            let all = splits(judge, &names, &[], &key).unwrap_or_else(|fault| panic!("{}", fault.problem));
            all.into_iter().map(|split| (split.fitted_indices, split.validation_index)).collect()
        };
        let pairs = [(0, 1), (0, 2), (1, 0), (1, 2), (2, 0), (2, 1)].map(|(fit, judge)| (vec![fit], Some(judge)));
        assert_eq!(of(&JudgeWire::default()), pairs);
        let left_out = [(vec![1, 2], Some(0)), (vec![0, 2], Some(1)), (vec![0, 1], Some(2))];
        assert_eq!(of(&JudgeWire::Rule(HoldOutRule::LeftOut)), left_out);
        assert_eq!(of(&JudgeWire::Rule(HoldOutRule::None)), [0, 1, 2].map(|record| (vec![record], None)));
        let lists = |fit: &[&str], judge: &[&str]| JudgeWire::Lists {
            fit: fit.iter().map(|name| (*name).to_owned()).collect(),
            judge: judge.iter().map(|name| (*name).to_owned()).collect(),
            each: false,
        };
        let JudgeWire::Lists { fit, judge, .. } = lists(&["c", "a"], &["a", "b"]) else { panic!() };
        let pairs = [(2, 0), (2, 1), (0, 1)].map(|(fit, judge)| (vec![fit], Some(judge)));
        assert_eq!(of(&JudgeWire::Lists { fit, judge, each: true }), pairs);
        assert_eq!(of(&lists(&["c", "a"], &["b"])), [(vec![2, 0], Some(1))]);
        for (wrong, part) in [
            (lists(&["a"], &["a"]), "is in both lists"),
            (lists(&["a"], &["d"]), "no record is called"),
            (lists(&[], &["a"]), "which leaves none to judge another"),
        ] {
            let fault = splits(&wrong, &names, &[], &key).expect_err("wrong");
            assert!(fault.problem.contains(part), "{}", fault.problem);
        }
        assert!(splits(&JudgeWire::default(), &["a"], &[], &key).is_err());
    }
}
