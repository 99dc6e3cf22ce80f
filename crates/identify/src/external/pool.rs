//! The processes of one command in one folder, shared by all methods with that command: those of the cells of a sweep
//! are asked in turn and need no more processes than one cell.

use std::fs::File;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, AtomicU32, Ordering};
use std::sync::{Arc, Mutex, Weak};
use std::time::Duration;

use crate::identifier::{Opener, Outside};

use super::place;
use super::process::{Listener, Process, locked};
use super::process_error::ProcessError;

/// Most commands whose processes are kept while they wait: those that were asked last.
const MOST_COMMANDS: usize = 16;

/// Most bytes of a log.
const MOST_LOG: u64 = 1 << 20;

/// Said at the end of a log that is full.
const FULL: &[u8] = b"\n(what was said after this is not kept)\n";

/// All pools, the one that was asked last at the end.
static POOLS: Mutex<Vec<Weak<ProcessPool>>> = Mutex::new(Vec::new());

/// Silences in succession after which a command is given up.
const MOST_SILENCES: u32 = 3;

/// The processes of one command.
pub struct ProcessPool {
    command: Vec<String>,
    folder: PathBuf,
    /// How long an answer is waited for.
    pub timeout: Duration,
    /// Silences since the last answer; once it is given up, none end that.
    silences: AtomicU32,
    is_told: AtomicBool,
    idle: Mutex<Vec<Process>>,
    log: Mutex<Option<Arc<Mutex<StderrLog>>>>,
}

impl ProcessPool {
    /// The pool of a command in a folder, shared with whoever has it already and waits as long.
    pub fn of(command: Vec<String>, folder: &Path, timeout: Duration) -> Arc<Self> {
        let mut pools = locked(&POOLS);
        pools.retain(|pool| pool.strong_count() > 0);
        let known = pools.iter().filter_map(Weak::upgrade);
        let is_it = |pool: &Arc<Self>| pool.command == command && pool.folder == folder && pool.timeout == timeout;
        if let Some(own) = known.into_iter().find(is_it) {
            return own;
        }
        let own = Arc::new(Self {
            command,
            folder: folder.to_owned(),
            timeout,
            silences: AtomicU32::new(0),
            is_told: AtomicBool::new(false),
            idle: Mutex::default(),
            log: Mutex::default(),
        });
        pools.push(Arc::downgrade(&own));
        own
    }

    /// Takes note of a question that was answered, with sense or without.
    pub fn was_answered(&self) {
        let is_kept = |count: u32| (count < MOST_SILENCES).then_some(0);
        let _ = self.silences.fetch_update(Ordering::Relaxed, Ordering::Relaxed, is_kept);
    }

    /// Takes note of a question to which nothing came in time.
    pub fn was_silent(&self) {
        self.silences.fetch_add(1, Ordering::Relaxed);
    }

    fn is_given_up(&self) -> bool {
        self.silences.load(Ordering::Relaxed) >= MOST_SILENCES
    }

    /// A process to ask: one that waits, or a new one; none of a command that was given up, in the words of a silence.
    pub fn take(self: &Arc<Self>) -> Result<Process, ProcessError> {
        if self.is_given_up() {
            return Err(ProcessError::Silent(self.timeout));
        }
        self.was_asked();
        let idle = locked(&self.idle).pop();
        idle.map_or_else(|| self.start(), Ok)
    }

    /// A new process.
    pub fn start(&self) -> Result<Process, ProcessError> {
        let log = locked(&self.log).clone();
        let log = log.map(|log| -> Listener { Box::new(move |words| locked(&log).add(words)) });
        place::command(&self.command, &self.folder)
            .and_then(|command| Process::start(command, log))
            .map_err(ProcessError::NotStarted)
    }

    /// Takes back a process that waits.
    pub fn give_back(&self, process: Process) {
        locked(&self.idle).push(process);
    }

    /// Makes it the last that was asked; processes of the one that was not asked for so many others end.
    fn was_asked(self: &Arc<Self>) {
        let mut pools = locked(&POOLS);
        let own = Arc::downgrade(self);
        let place = pools.iter().rposition(|pool| Weak::ptr_eq(pool, &own));
        match place {
            Some(place) if place + 1 == pools.len() => return,
            Some(place) => drop(pools.remove(place)),
            None => {}
        }
        pools.push(own);
        let beyond = pools.len().checked_sub(MOST_COMMANDS + 1).and_then(|place| pools[place].upgrade());
        drop(pools);
        if let Some(beyond) = beyond {
            let idle = std::mem::take(&mut *locked(&beyond.idle));
            Process::end(idle);
        }
    }
}

impl Outside for ProcessPool {
    fn command(&self) -> &[String] {
        &self.command
    }

    fn find(&self) -> Result<(), String> {
        place::find(&self.command, &self.folder)
    }

    fn log_to(&self, open: Opener) {
        *locked(&self.log) = Some(Arc::new(Mutex::new(StderrLog { open, file: None, left: MOST_LOG })));
    }

    fn notice(&self) -> Option<String> {
        let is_new = self.is_given_up() && !self.is_told.swap(true, Ordering::Relaxed);
        is_new.then(|| {
            format!(
                "`{}` gave no answer within {} s to {MOST_SILENCES} trials in succession and is given up: further trials \
                 fail at once",
                place::shown(&self.command),
                self.timeout.as_secs_f64()
            )
        })
    }

    /// Whoever asks next begins anew.
    fn end(&self) {
        self.silences.store(0, Ordering::Relaxed);
        self.is_told.store(false, Ordering::Relaxed);
        let idle = std::mem::take(&mut *locked(&self.idle));
        Process::end(idle);
        *locked(&self.log) = None;
    }
}

impl Drop for ProcessPool {
    fn drop(&mut self) {
        Process::end(std::mem::take(&mut *locked(&self.idle)));
    }
}

/// What processes say beside their answers, up to a size. A log that cannot be written is not missed.
struct StderrLog {
    open: Opener,
    file: Option<File>,
    left: u64,
}

impl StderrLog {
    fn add(&mut self, words: &[u8]) {
        if self.left == 0 {
            return;
        }
        if self.file.is_none() {
            self.file = (self.open)().ok();
            // What an earlier run left counts.
            let size = self.file.as_ref().and_then(|file| file.metadata().ok()).map_or(MOST_LOG, |about| about.len());
            self.left = MOST_LOG.saturating_sub(size);
        }
        let Some(file) = self.file.as_mut().filter(|_| self.left > 0) else { return };
        let fitting = &words[..words.len().min(usize::try_from(self.left).unwrap_or(usize::MAX))];
        self.left -= fitting.len() as u64;
        let end = if self.left == 0 { FULL } else { b"" };
        let _ = file.write_all(&[fitting, end].concat());
    }
}
