//! Runner of a target on many damaged files, in several threads; it reports the inputs that cause faults.

use std::any::Any;
use std::fmt::Write as _;
use std::panic::{self, AssertUnwindSafe, PanicHookInfo};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError};
use std::thread;
use std::time::{Duration, Instant};

use rand::{SeedableRng, rngs::ChaCha8Rng};

use super::{Target, mutate};

/// Maximum time of a case.
const LONGEST: Duration = Duration::from_secs(5);

/// Maximum peak memory of the process, MiB.
const MOST_MEMORY: u64 = 512;

/// Stack size of a thread, bytes: equal to the main thread of a program.
const STACK: usize = 8 << 20;

/// Seed of all damage.
const SEED: u64 = 0x6b65_6d70_6600_0000;

/// Result of the runs of a target.
#[derive(Debug, Default)]
pub struct Outcome {
    /// Number of cases.
    pub cases: usize,
    /// Number of accepted cases; all other cases were rejected.
    pub accepted: usize,
    /// Duration of the slowest case.
    pub longest: Duration,
    /// Faults, one line each, with the path of the saved input; the first fault of each kind.
    pub faults: Vec<String>,
}

/// Result of `cases` damaged files of a target.
pub fn run(target: &Target, cases: usize) -> Outcome {
    let corpus = target.corpus();
    let words = target.words();
    assert!(!corpus.is_empty(), "no files for {} to begin with", target.name);
    let case = |index: usize| {
        // The undamaged files come first.
        corpus.get(index).cloned().unwrap_or_else(|| {
            let mut generator = ChaCha8Rng::seed_from_u64(SEED ^ index as u64);
            mutate::damaged(&corpus, &words, &mut generator)
        })
    };
    all(target, cases, case)
}

/// Result of every regression file of a target.
pub fn run_regressions(target: &Target) -> Outcome {
    let files = target.regressions();
    all(target, files.len(), |index| super::read(&files[index]))
}

fn all(target: &Target, cases: usize, case: impl Fn(usize) -> Vec<u8> + Sync) -> Outcome {
    panic::set_hook(Box::new(listen));
    let next = AtomicUsize::new(0);
    let outcome = Mutex::new(Outcome { cases, ..Outcome::default() });
    let threads = thread::available_parallelism().map_or(2, usize::from);
    let running: Vec<Mutex<Option<(Instant, usize)>>> = (0..threads).map(|_| Mutex::new(None)).collect();
    let at_work = AtomicUsize::new(threads);
    thread::scope(|scope| {
        for slot in &running {
            let (next, outcome, case, at_work) = (&next, &outcome, &case, &at_work);
            let work = move || {
                loop {
                    let index = next.fetch_add(1, Ordering::Relaxed);
                    if index >= cases {
                        break;
                    }
                    let data = case(index);
                    *slot.lock().expect("no case holds it") = Some((Instant::now(), index));
                    let found = attempt(target, &data);
                    let (start, _) = slot.lock().expect("no case holds it").take().expect("it was just set");
                    outcome.lock().expect("nothing panics here").add(target, &data, start.elapsed(), found);
                }
                at_work.fetch_sub(1, Ordering::Relaxed);
            };
            thread::Builder::new().stack_size(STACK).spawn_scoped(scope, work).expect("a thread can be made");
        }
        // A case that never ends cannot be stopped, only reported.
        while at_work.load(Ordering::Relaxed) > 0 {
            thread::sleep(Duration::from_millis(20));
            for slot in &running {
                let stuck = slot.lock().expect("no case holds it").filter(|(start, _)| start.elapsed() > 4 * LONGEST);
                if let Some((_, index)) = stuck {
                    eprintln!("{}: a case does not end: {}", target.name, save(target, &case(index)).display());
                    std::process::exit(1);
                }
            }
        }
    });
    drop(panic::take_hook());
    let mut outcome = outcome.into_inner().expect("nothing panicked");
    if let Some(mebibytes) = peak_memory().filter(|&mebibytes| mebibytes > MOST_MEMORY) {
        outcome.faults.push(format!("{}: {mebibytes} MiB of memory, expected at most {MOST_MEMORY}", target.name));
    }
    outcome
}

impl Outcome {
    fn add(&mut self, target: &Target, data: &[u8], time: Duration, found: Result<bool, String>) {
        self.longest = self.longest.max(time);
        self.accepted += usize::from(found == Ok(true));
        let slow = (time > LONGEST).then(|| format!("a case of {:.1} s", time.as_secs_f64()));
        for fault in found.err().into_iter().chain(slow) {
            if !self.faults.iter().any(|old| kind(old).contains(kind(&fault))) {
                let saved = save(target, data);
                self.faults.push(format!("{}: {fault}\n  saved as {}", target.name, saved.display()));
            }
        }
    }
}

/// Kind of a fault: its place without the message, so that each kind is reported once.
fn kind(fault: &str) -> &str {
    fault.split_once(" | ").map_or(fault, |(place, _)| place)
}

/// Result of one file: `true` if it was accepted; fails with `place | message` of a panic.
fn attempt(target: &Target, data: &[u8]) -> Result<bool, String> {
    let caught = panic::catch_unwind(AssertUnwindSafe(|| (target.run)(data)));
    let payload = match caught {
        Ok(accepted) => return Ok(accepted),
        Err(payload) => payload,
    };
    let message = said(payload.as_ref());
    let place = PLACES.lock().expect("nothing panics here").iter().rev().find(|(_, found)| *found == message).cloned();
    Err(format!("{} | {message}", place.map_or_else(|| "a panic".to_owned(), |(place, _)| place)))
}

/// Message of a panic.
fn said(payload: &(dyn Any + Send)) -> String {
    let owned = payload.downcast_ref::<String>().cloned();
    owned.or_else(|| payload.downcast_ref::<&str>().map(|&text| text.to_owned())).unwrap_or_default()
}

/// Places and messages of recent panics of all threads, because a reader may decode in a separate thread.
static PLACES: Mutex<Vec<(String, String)>> = Mutex::new(Vec::new());

/// Panic hook: it suppresses the output and stores the place of the panic.
fn listen(info: &PanicHookInfo<'_>) {
    let place =
        info.location().map_or_else(|| "a panic".to_owned(), |place| format!("{}:{}", place.file(), place.line()));
    let message = said(info.payload());
    let mut places = PLACES.lock().unwrap_or_else(PoisonError::into_inner);
    places.retain(|(_, found)| *found != message);
    places.push((place, message));
}

fn save(target: &Target, data: &[u8]) -> PathBuf {
    let folder = std::env::temp_dir().join("kempf-fuzz");
    let name = data
        .iter()
        .fold(0xcbf2_9ce4_8422_2325_u64, |hash, &byte| (hash ^ u64::from(byte)).wrapping_mul(0x100_0000_01b3));
    let path = folder.join(format!("{}-{name:016x}", target.name));
    let written = std::fs::create_dir_all(&folder).and_then(|()| std::fs::write(&path, data));
    written.map_or_else(|error| PathBuf::from(format!("nothing ({error})")), |()| path)
}

/// Maximum memory of this process so far, MiB; `None` if the system does not report it.
pub fn peak_memory() -> Option<u64> {
    let status = std::fs::read_to_string(Path::new("/proc/self/status")).ok()?;
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"))?;
    Some(line.trim().strip_suffix("kB")?.trim().parse::<u64>().ok()? / 1024)
}

/// Table of the results of a run.
pub fn table(outcomes: &[(&str, Outcome)]) -> String {
    let mut text = String::new();
    for (name, outcome) in outcomes {
        let Outcome { cases, accepted, longest, faults } = outcome;
        writeln!(
            text,
            "{name:10} {cases:8} cases, {accepted:8} accepted, longest {:6.3} s, {} faults",
            longest.as_secs_f64(),
            faults.len()
        )
        .expect("writing to a string does not fail");
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fuzz::TARGETS;

    fn breaks_on_an_empty_file(data: &[u8]) -> bool {
        assert!(!data.is_empty(), "nothing in {} bytes", data.len());
        data.len() > 1
    }

    /// Fault of a panic: one fault for any number of repetitions, with its place and a stored input.
    #[test]
    fn a_panic_is_named_with_its_input() {
        let target = Target { run: breaks_on_an_empty_file, ..TARGETS[0] };
        let outcome = all(&target, 30, |index| vec![b'x'; index % 3]);
        assert_eq!((outcome.cases, outcome.accepted, outcome.faults.len()), (30, 10, 1));
        let fault = &outcome.faults[0];
        assert!(fault.contains("runner.rs:") && fault.contains("nothing in 0 bytes"), "{fault}");
        let (_, saved) = fault.split_once("saved as ").expect("the input was saved");
        assert_eq!(std::fs::read(saved).expect("it is there"), b"");
    }

    /// Damage is identical in every run.
    #[test]
    fn damage_is_the_same_in_every_run() {
        let target = &TARGETS[0];
        let corpus = target.corpus();
        let words = target.words();
        assert!(words.contains(&"\u{feff}".into()) && words.contains(&b"\"".to_vec()), "escapes are read");
        let damaged = |seed| mutate::damaged(&corpus, &words, &mut ChaCha8Rng::seed_from_u64(seed));
        assert!((0..50).all(|seed| damaged(seed) == damaged(seed)));
        assert!((0..50).any(|seed| damaged(seed) != damaged(seed + 1)));
    }
}
