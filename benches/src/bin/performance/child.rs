//! Commands of `study` in a process of their own.

use std::path::{Path, PathBuf};

use kempf_benches::process::{self, Cost, Outcome, STYLE, quiet};
use study::options::{Common, RunRequest};

/// First argument of a child.
pub const CHILD: &str = "--as-study";

/// Runs `study SCENARIO --out OUT --threads N --quiet`.
pub fn study(scenario: &Path, out: &Path, threads: usize) -> Outcome<Cost> {
    process::again([
        CHILD.as_ref(),
        "run".as_ref(),
        scenario.as_os_str(),
        out.as_os_str(),
        threads.to_string().as_ref(),
    ])
}

/// Runs `study check` on scenarios.
pub fn check(scenarios: &[PathBuf]) -> Outcome<Cost> {
    process::again([CHILD.as_ref(), "check".as_ref()].into_iter().chain(scenarios.iter().map(|path| path.as_os_str())))
}

/// What a child does.
pub fn answer(arguments: &[&str]) -> Outcome<()> {
    let text = |failure: scenario::failure::Failure| failure.to_string();
    match arguments {
        ["run", scenario, out, threads] => {
            let threads: u16 = threads.parse()?;
            rayon::ThreadPoolBuilder::new().num_threads(usize::from(threads)).build_global()?;
            let common = Common { threads: Some(threads), ..quiet(out) };
            study::commands::run::run(
                Path::new(scenario),
                &RunRequest { shard: None, restart: false, style: STYLE.clone() },
                &common,
            )
            .map_err(text)?;
        }
        ["check", scenarios @ ..] => {
            let scenarios: Vec<PathBuf> = scenarios.iter().map(PathBuf::from).collect();
            study::commands::check::run(&scenarios, false, &quiet("")).map_err(text)?;
        }
        _ => return Err("this is not a command".into()),
    }
    process::tell();
    Ok(())
}
