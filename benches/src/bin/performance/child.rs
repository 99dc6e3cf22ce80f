//! Commands of `study` in a process of their own, so that their peak memory can be read and nothing is warm.

use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::Instant;

use study::cli::{Common, Format, RunRequest, Style};

use crate::Outcome;

/// First argument of a child.
pub const CHILD: &str = "--as-study";

/// What a command took.
#[derive(Debug, Clone, Copy)]
pub struct Cost {
    /// Wall time of the process, s.
    pub wall: f64,
    /// Peak resident memory, MB (10⁶ bytes); `None` where the system does not say.
    pub memory: Option<f64>,
}

/// Runs `study SCENARIO --out OUT --threads N --quiet`.
pub fn study(scenario: &Path, out: &Path, threads: usize) -> Outcome<Cost> {
    command(&["run".as_ref(), scenario, out, threads.to_string().as_ref()])
}

/// Runs `study check` on scenarios.
pub fn check(scenarios: &[PathBuf]) -> Outcome<Cost> {
    let arguments: Vec<&Path> =
        std::iter::once("check".as_ref()).chain(scenarios.iter().map(PathBuf::as_path)).collect();
    command(&arguments)
}

fn command(arguments: &[&Path]) -> Outcome<Cost> {
    let program = std::env::current_exe()?;
    let start = Instant::now();
    let output = Command::new(program).arg(CHILD).args(arguments).output()?;
    let wall = start.elapsed().as_secs_f64();
    if !output.status.success() {
        return Err(format!("a study failed: {}", String::from_utf8_lossy(&output.stderr)).into());
    }
    let text = String::from_utf8_lossy(&output.stdout);
    let memory = text.lines().last().and_then(|line| line.strip_prefix(MEMORY)?.parse().ok());
    Ok(Cost { wall, memory })
}

/// What stands before the memory in the last line of a child.
const MEMORY: &str = "peak memory, MB: ";

/// What a child does.
pub fn answer(arguments: &[&str]) -> Outcome<()> {
    let text = |failure: study::failure::Failure| failure.to_string();
    match arguments {
        ["run", scenario, out, threads] => {
            let threads: u16 = threads.parse()?;
            rayon::ThreadPoolBuilder::new().num_threads(usize::from(threads)).build_global()?;
            let common = Common {
                out: Some(PathBuf::from(out)),
                threads: Some(threads),
                seed: None,
                quiet: true,
                format: Format::Text,
            };
            let style = Style { paper: None, dpi: 600.0 };
            study::run::run(Path::new(scenario), &RunRequest { shard: None, restart: false, style }, &common)
                .map_err(text)?;
        }
        ["check", scenarios @ ..] => {
            let scenarios: Vec<PathBuf> = scenarios.iter().map(PathBuf::from).collect();
            study::check::run(&scenarios).map_err(text)?;
        }
        _ => return Err("this is not a command".into()),
    }
    if let Some(peak) = peak_memory() {
        println!("{MEMORY}{peak}");
    }
    Ok(())
}

/// Peak resident memory of this process, MB, as Linux tells it.
fn peak_memory() -> Option<f64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"))?;
    let kibibytes: f64 = line.trim().strip_suffix("kB")?.trim().parse().ok()?;
    Some(kibibytes * 1024e-6)
}
