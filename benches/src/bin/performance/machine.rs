//! What it was measured on, without saying whose machine it is.

use std::process::Command;

use serde::Serialize;

/// Written to `machine.toml`.
#[derive(Debug, Clone, Serialize)]
#[serde(rename_all = "kebab-case")]
pub struct Machine {
    /// The command that does it again.
    pub command: String,
    /// Whether small sizes were measured, which are no results.
    pub quick: bool,
    /// Version of the project.
    pub version: String,
    /// Git revision of the source, where git can tell.
    pub git_revision: Option<String>,
    /// Whether files differed from that revision.
    pub changed_since: Option<bool>,
    /// Model of the processor.
    pub processor: String,
    /// Threads the system offers.
    pub cores: usize,
    /// Operating system and processor family.
    pub target: String,
    /// Version of the compiler.
    pub rustc: String,
    /// Whether the program was built with optimisation for release.
    pub release: bool,
    /// Version of the rival.
    pub rival: String,
}

const LOCK: &str = include_str!("../../../../Cargo.lock");

/// The command of the report.
pub const COMMAND: &str = "cargo run --release -p kempf-benches --bin performance -- results/performance";

impl Machine {
    /// This one.
    pub fn new(quick: bool) -> Self {
        let here = env!("CARGO_MANIFEST_DIR");
        Self {
            command: if quick { COMMAND.replace("-- ", "-- --quick ") } else { COMMAND.to_owned() },
            quick,
            version: env!("CARGO_PKG_VERSION").to_owned(),
            git_revision: said("git", &["-C", here, "rev-parse", "HEAD"]),
            changed_since: said("git", &["-C", here, "status", "--porcelain", "--untracked-files=no"])
                .map(|changes| !changes.is_empty()),
            processor: processor().unwrap_or_else(|| "unknown".to_owned()),
            cores: std::thread::available_parallelism().map_or(1, usize::from),
            target: format!("{}-{}", std::env::consts::ARCH, std::env::consts::OS),
            rustc: said("rustc", &["--version"]).unwrap_or_else(|| "unknown".to_owned()),
            release: !cfg!(debug_assertions),
            rival: rival().unwrap_or_else(|| "unknown".to_owned()),
        }
    }
}

fn said(program: &str, arguments: &[&str]) -> Option<String> {
    let output = Command::new(program).args(arguments).output().ok().filter(|output| output.status.success())?;
    Some(String::from_utf8_lossy(&output.stdout).trim().to_owned())
}

/// The model Linux or macOS names.
fn processor() -> Option<String> {
    let linux = std::fs::read_to_string("/proc/cpuinfo").ok().and_then(|text| {
        let line = text.lines().find(|line| line.starts_with("model name"))?;
        Some(line.split_once(':')?.1.trim().to_owned())
    });
    linux.or_else(|| said("sysctl", &["-n", "machdep.cpu.brand_string"]))
}

fn rival() -> Option<String> {
    let lines: Vec<&str> = LOCK.lines().collect();
    let at = lines.iter().position(|line| *line == "name = \"dsmc\"")?;
    let version = lines.get(at + 1)?.strip_prefix("version = ")?;
    Some(format!("dsmc {}", version.trim_matches('"')))
}
