//! What is published beside the studies, and by what it was made: `publish.toml` in the folder of results, and a stamp
//! in the folder of every program.

use std::path::{Path, PathBuf};

use campaign::disk;
use campaign::manifest::ProgramRevision;
use scenario::failure::{Failure, OnPath};
use serde::{Deserialize, Serialize};

/// What is made, in the folder of results.
pub const PLAN: &str = "publish.toml";

/// Folder of what is published, in the folder of results.
pub const PUBLISHED: &str = "published";

/// What a program was when it made its folder, inside of it.
pub const STAMP: &str = "program.toml";

/// Largest file of a plan or a stamp, bytes.
const LARGEST: u64 = 1 << 20;

/// What `study publish` makes.
#[derive(Debug, Clone, Default, PartialEq, Deserialize)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub struct PublicationPlan {
    /// Folder of the scenarios, from where the folder of results lies. Each of them is a study.
    pub scenarios: PathBuf,
    /// What is made by other means than a scenario.
    #[serde(default, rename = "program")]
    pub programs: Vec<PublishedProgram>,
    /// What has to hold of all that is published.
    #[serde(default, rename = "check")]
    pub checks: Vec<PublicationCheck>,
}

/// Results that are made by other means than a scenario.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub struct PublishedProgram {
    /// Name of its folder.
    pub name: String,
    /// What it asks.
    pub question: String,
    /// What came out.
    #[serde(default)]
    pub finding: String,
    /// File of the page in its folder.
    pub page: String,
    /// File of the figure that stands for it.
    pub figure: Option<String>,
    /// Whether it needs the folder of measured records.
    #[serde(default)]
    pub needs_records: bool,
    /// What is run, one after another, where the folder of results lies. `{folder}` is the folder to be filled,
    /// `{records}` that of the measured records. The command `study` is this program.
    pub commands: Vec<Vec<String>>,
}

/// A command that has to succeed when all is published.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub struct PublicationCheck {
    /// What it is called.
    pub name: String,
    /// What is run, where the folder of results lies.
    pub command: Vec<String>,
}

/// By what the results of a program were made.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub struct ProgramStamp {
    /// The commands.
    pub commands: Vec<Vec<String>>,
    /// Time they took, s.
    pub wall_time_s: f64,
    /// The version of the project.
    pub program: ProgramRevision,
}

impl PublicationPlan {
    /// The plan of a folder of results; `None` where there is none.
    ///
    /// Fails when it cannot be read or is none.
    pub fn read(results: &Path) -> Result<Option<Self>, Failure> {
        read(&results.join(PLAN))
    }
}

/// Reads a file of this module; `None` where there is none.
fn read<T: for<'a> Deserialize<'a>>(path: &Path) -> Result<Option<T>, Failure> {
    let Some(bytes) = disk::read(path, LARGEST).on("read", path)? else { return Ok(None) };
    let text = String::from_utf8(bytes).on("read", path)?;
    toml::from_str(&text).map(Some).map_err(|error| Failure::about(path, error.to_string().trim_end()))
}

impl ProgramStamp {
    /// The stamp of a folder; `None` where there is none.
    ///
    /// Fails when it cannot be read or is none.
    pub fn read(folder: &Path) -> Result<Option<Self>, Failure> {
        read(&folder.join(STAMP))
    }
}

/// Whether a file of a folder is published, by its name: rows and what is drawn from them again are not.
pub fn is_published(name: &str) -> bool {
    const ENDS: [&str; 6] = [".svg", ".html", ".log", ".parquet", ".lock", ".tmp"];
    const NAMES: [&str; 6] = ["cells.json", "showcase.json", "summary.md", "rows.csv", "unfinished", "shards"];
    !ENDS.iter().any(|end| name.ends_with(end)) && !NAMES.contains(&name)
}

/// All published files below a folder, as paths from there, sorted.
///
/// Fails when a folder cannot be listed.
pub fn published_files(folder: &Path) -> Result<Vec<PathBuf>, Failure> {
    let mut files = Vec::new();
    let mut folders = vec![PathBuf::new()];
    while let Some(inside) = folders.pop() {
        let path = folder.join(&inside);
        for name in disk::names(&path).on("list", &path)?.into_iter().filter(|name| is_published(name)) {
            let (file, below) = (inside.join(&name), path.join(&name).is_dir());
            if below { folders.push(file) } else { files.push(file) }
        }
    }
    files.sort();
    Ok(files)
}
