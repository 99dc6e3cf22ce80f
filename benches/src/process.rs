//! The same program again in a process of its own, so that its peak memory can be read and nothing in it is warm.

use std::ffi::OsStr;
use std::path::Path;
use std::process::{Command, ExitCode};
use std::time::Instant;

use study::options::{Common, FigureChoice, Format, StudyStyle, Style};

/// What goes wrong is told to the user and ends the program.
pub type Outcome<T> = Result<T, Box<dyn std::error::Error>>;

/// Ends a program with what it came to; what went wrong is told on standard error.
pub fn end(done: Outcome<()>) -> ExitCode {
    match done {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("{error}");
            ExitCode::FAILURE
        }
    }
}

/// Figures as `study` draws them unless asked otherwise.
pub const STYLE: StudyStyle =
    StudyStyle { style: Style { paper: None, dpi: 600.0, style: None }, figures: FigureChoice::Named };

/// The options `--out OUT --quiet`.
pub fn quiet(out: &str) -> Common {
    Common { out: Some(Path::new(out).to_owned()), threads: None, seed: None, quiet: true, format: Format::Text }
}

/// What a process took.
#[derive(Debug, Clone, Copy)]
pub struct Cost {
    /// Wall time from its start to its end, s.
    pub wall: f64,
    /// Peak resident memory, MB (10⁶ bytes); `None` where the system does not say.
    pub memory: Option<f64>,
}

/// What stands before the memory in the last line of a process.
const MEMORY: &str = "peak memory, MB: ";

/// Runs this program with other arguments, which have to make it end with [`tell`]. Fails with what it said on standard
/// error.
pub fn again<A: AsRef<OsStr>>(arguments: impl IntoIterator<Item = A>) -> Outcome<Cost> {
    let program = std::env::current_exe()?;
    let start = Instant::now();
    let output = Command::new(program).args(arguments).output()?;
    let wall = start.elapsed().as_secs_f64();
    if !output.status.success() {
        return Err(format!("a process failed: {}", String::from_utf8_lossy(&output.stderr)).into());
    }
    let text = String::from_utf8_lossy(&output.stdout);
    let memory = text.lines().last().and_then(|line| line.strip_prefix(MEMORY)?.parse().ok());
    Ok(Cost { wall, memory })
}

/// Tells the process that waits for this one how much memory it took.
pub fn tell() {
    if let Some(peak) = peak_memory() {
        println!("{MEMORY}{peak}");
    }
}

/// Peak resident memory of this process, MB, as Linux tells it.
fn peak_memory() -> Option<f64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"))?;
    let kibibytes: f64 = line.trim().strip_suffix("kB")?.trim().parse().ok()?;
    Some(kibibytes * 1024e-6)
}

#[cfg(test)]
mod tests {
    #[test]
    fn linux_tells_the_peak_memory() {
        if cfg!(target_os = "linux") {
            let peak = super::peak_memory().expect("a line of /proc/self/status");
            assert!((1.0..1e5).contains(&peak), "{peak} MB");
        }
    }
}
