//! Damaged files: every reader gives a reading that makes sense or one message, in bounded time and memory, and never
//! panics. `KEMPF_FUZZ_CASES` sets the number of cases; `-- --nocapture` shows what was run.

use kempf_tests::fuzz::{TARGETS, Target, runner};

/// Cases of a plain `cargo test`, of all targets together: a minute on two cores.
const CASES: usize = 20_000;

fn hold(outcomes: Vec<(&str, runner::Outcome)>) {
    print!("{}", runner::table(&outcomes));
    println!("{} MiB at most", runner::peak_memory().map_or_else(|| "unknown".to_owned(), |peak| peak.to_string()));
    let faults: Vec<String> = outcomes.into_iter().flat_map(|(_, outcome)| outcome.faults).collect();
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

/// Every regression file first, then damaged files; in one test, because memory is that of the process.
#[test]
fn damaged_files_are_read_or_refused() {
    let cases: usize = match std::env::var("KEMPF_FUZZ_CASES") {
        Ok(number) => number.parse().expect("KEMPF_FUZZ_CASES is the number of cases"),
        Err(_) => CASES,
    };
    let shares: usize = TARGETS.iter().map(|target| target.share).sum();
    hold(TARGETS.iter().map(|target| (target.name, runner::run_regressions(target))).collect());
    let run = |target: &Target| (target.name, runner::run(target, cases * target.share / shares));
    hold(TARGETS.iter().map(run).collect());
}
