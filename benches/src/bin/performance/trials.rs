//! Whole studies: threads, memory, bytes on the disk, and time over the number of trials.

use std::path::{Path, PathBuf};

use campaign::manifest::Manifest;
use kempf_benches::measure::Measured;
use kempf_benches::process::Outcome;
use kempf_benches::works;
use tempfile::TempDir;

use crate::growth::{self, Growth};
use crate::{child, say};

/// Trials of the study that threads are compared on.
const SCALING_TRIALS: u64 = 100_000;
const QUICK_SCALING_TRIALS: u64 = 400;

/// Times it is run with every number of threads.
const SCALING_ROUNDS: usize = 3;

/// Trials of the studies that time and memory are seen to grow over.
const TRIALS: [u64; 7] = [1000, 3000, 10_000, 30_000, 100_000, 300_000, 1_000_000];
const QUICK_TRIALS: [u64; 3] = [100, 200, 400];

/// Times `study check` is run.
const CHECKS: usize = 31;
const QUICK_CHECKS: usize = 3;

/// One run of a study.
#[derive(Debug, Clone, Copy)]
pub struct Study {
    /// Trials.
    pub trials: u64,
    /// Threads.
    pub threads: usize,
    /// Time to simulate, identify and store, s.
    pub work: f64,
    /// Time of the whole command, with tables and figures, s.
    pub whole: f64,
    /// Peak memory, MB.
    pub memory: Option<f64>,
    /// Bytes of the rows on the disk.
    pub bytes: u64,
}

/// The study with a number of threads, against one thread.
#[derive(Debug, Clone, Copy)]
pub struct Scaling {
    /// Threads.
    pub threads: usize,
    /// Trials a second, without tables and figures.
    pub rate: Measured,
    /// Share of the threads that is used: rate over threads times the rate of one.
    pub share: Measured,
    /// The same of the whole command.
    pub whole_share: Measured,
}

/// What was measured.
pub struct Trials {
    /// Trials that threads are compared on.
    pub scaling_trials: u64,
    /// One line per number of threads.
    pub scaling: Vec<Scaling>,
    /// Studies of growing size, on all cores.
    pub studies: Vec<Study>,
    /// Time of a study over its trials, and of the whole command.
    pub growth: [Growth; 2],
    /// Time of one trial over its samples.
    pub of_samples: Growth,
    /// Methods of the study: rows per trial.
    pub methods: u64,
    /// Time of `study check` on every scenario, s.
    pub check: Measured,
    /// How many there are.
    pub scenarios: usize,
}

/// Runs all of it.
pub fn measure(quick: bool) -> Outcome<Trials> {
    let folder = tempfile::tempdir()?;
    let cores = std::thread::available_parallelism()?.get();
    let scaling_trials = if quick { QUICK_SCALING_TRIALS } else { SCALING_TRIALS };
    let rounds = if quick { 1 } else { SCALING_ROUNDS };
    let mut threads: Vec<usize> =
        std::iter::successors(Some(1), |threads| Some(threads * 2)).take_while(|n| *n < cores).collect();
    threads.push(cores);
    let mut runs: Vec<Vec<Study>> = vec![Vec::new(); threads.len()];
    for round in 1..=rounds {
        for (runs, &threads) in runs.iter_mut().zip(&threads) {
            say(&format!("{scaling_trials} trials on {threads} threads, {round} of {rounds}"));
            runs.push(run(&folder, scaling_trials, threads)?);
        }
    }
    let trials: &[u64] = if quick { &QUICK_TRIALS } else { &TRIALS };
    let mut studies = Vec::new();
    for &trials in trials {
        say(&format!("{trials} trials on {cores} threads"));
        studies.push(run(&folder, trials, cores)?);
    }
    let scenarios = works::scenarios();
    let mut checks = Vec::new();
    for _ in 0..if quick { QUICK_CHECKS } else { CHECKS } {
        checks.push(child::check(&scenarios)?.wall);
    }
    let over =
        |time: fn(&Study) -> f64| studies.iter().map(|study| (study.trials as f64, exactly(time(study)))).collect();
    Ok(Trials {
        of_samples: growth::of_trials(quick)?,
        scaling_trials,
        scaling: threads.iter().zip(&runs).map(|(&threads, own)| scaling(threads, own, &runs[0])).collect(),
        growth: [
            Growth::new("trials", over(|study| study.work)),
            Growth::new("whole command", over(|study| study.whole)),
        ],
        studies,
        methods: scenario::Scenario::read(&works::throughput(), None)
            .map_err(|failure| failure.to_string())?
            .labels()
            .count() as u64,
        check: Measured::median(checks).ok_or("nothing was checked")?,
        scenarios: scenarios.len(),
    })
}

fn exactly(value: f64) -> Measured {
    Measured { value, interval: [value, value], least: Some(value), samples: 1 }
}

fn scaling(threads: usize, own: &[Study], one: &[Study]) -> Scaling {
    let pairs = |time: fn(&Study) -> f64| {
        let shares = own.iter().zip(one).map(|(own, one)| time(one) / (time(own) * threads as f64));
        Measured::median(shares).expect("at least one round")
    };
    let rates = own.iter().map(|study| study.trials as f64 / study.work);
    Scaling {
        threads,
        rate: Measured::median(rates).expect("at least one round"),
        share: pairs(|study| study.work),
        whole_share: pairs(|study| study.whole),
    }
}

fn run(folder: &TempDir, trials: u64, threads: usize) -> Outcome<Study> {
    let scenario = with_replicates(folder.path(), trials)?;
    let out = folder.path().join("study");
    let cost = child::study(&scenario, &out, threads)?;
    let manifest = Manifest::read(&out.join(campaign::files::MANIFEST)).map_err(|failure| failure.to_string())?;
    let manifest = manifest.ok_or("the study left no manifest")?;
    let bytes = std::fs::metadata(out.join(campaign::files::ROWS))?.len();
    std::fs::remove_dir_all(&out)?;
    Ok(Study { trials, threads, work: manifest.machine.wall_time_s, whole: cost.wall, memory: cost.memory, bytes })
}

/// The scenario of the throughput with another number of trials.
fn with_replicates(folder: &Path, trials: u64) -> Outcome<PathBuf> {
    let mut scenario: toml::Table = std::fs::read_to_string(works::throughput())?.parse()?;
    scenario.insert("replicates".to_owned(), toml::Value::Integer(trials as i64));
    let path = folder.join("throughput.toml");
    std::fs::write(&path, toml::to_string(&scenario)?)?;
    Ok(path)
}
