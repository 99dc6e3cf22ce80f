//! One process of another program: started, asked, ended. A thread of its own writes and reads, so that whoever asks
//! can stop waiting whatever the process does.

use std::io::{self, BufRead, BufReader, Read, Write};
use std::process::{Child, ChildStdin, ChildStdout, Command, ExitStatus, Stdio};
use std::sync::mpsc::{Receiver, RecvTimeoutError, SyncSender, sync_channel};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError, Weak};
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant};

use super::process_error::ProcessError;

/// Most bytes of an answer.
const MOST_BYTES: usize = 4 << 20;

/// Time that processes get to end by themselves after their input has ended.
const PATIENCE: Duration = Duration::from_millis(500);

/// Time between two looks whether a process has ended.
const LOOK: Duration = Duration::from_millis(2);

/// Variables of libraries that would start threads of their own, beside those that ask.
const THREADS: [&str; 5] =
    ["OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "NUMEXPR_NUM_THREADS", "VECLIB_MAXIMUM_THREADS"];

/// All processes that were started; those that have ended are left out with the next start.
static STARTED: Mutex<Vec<Weak<Mutex<Child>>>> = Mutex::new(Vec::new());

/// What a mutex holds; a panic of another thread leaves nothing half done in any of these.
pub fn locked<T: ?Sized>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Kills every process that an outside estimator runs in, for a program that is about to end itself.
pub fn end_all() {
    for child in locked(&STARTED).drain(..).filter_map(|child| child.upgrade()) {
        kill(&mut locked(&child));
    }
}

/// Takes what a process says beside its answers, line by line.
pub type Listener = Box<dyn FnMut(&[u8]) + Send>;

/// A process that waits for a question.
pub struct Process {
    child: Arc<Mutex<Child>>,
    /// Without it the input of the process ends.
    questions: Option<SyncSender<Vec<u8>>>,
    answers: Receiver<Vec<u8>>,
    /// Questions it has answered.
    pub answered: u64,
    log: Option<JoinHandle<()>>,
}

impl Process {
    /// Starts a command, which says where it runs. Its standard error goes to `log`; without one it is dropped.
    pub fn start(mut command: Command, log: Option<Listener>) -> io::Result<Self> {
        let unset = THREADS.into_iter().filter(|name| std::env::var_os(name).is_none());
        command.envs(unset.map(|name| (name, "1"))).env("PYTHONUNBUFFERED", "1");
        command.stdin(Stdio::piped()).stdout(Stdio::piped());
        command.stderr(if log.is_some() { Stdio::piped() } else { Stdio::null() });
        apart(&mut command);
        let mut child = command.spawn()?;
        let (input, output) = (child.stdin.take(), child.stdout.take());
        let (Some(input), Some(output)) = (input, output) else { return Err(io::ErrorKind::BrokenPipe.into()) };
        let errors = child.stderr.take();
        let child = Arc::new(Mutex::new(child));
        let mut started = locked(&STARTED);
        started.retain(|child| child.strong_count() > 0);
        started.push(Arc::downgrade(&child));
        drop(started);
        let (questions, asked) = sync_channel(1);
        let (answer, answers) = sync_channel(1);
        let mut this = Self { child, questions: Some(questions), answers, answered: 0, log: None };
        thread::Builder::new().name("outside".to_owned()).spawn(move || converse(input, output, &asked, &answer))?;
        if let Some((errors, log)) = errors.zip(log) {
            this.log = Some(thread::Builder::new().name("outside-log".to_owned()).spawn(move || keep(errors, log))?);
        }
        Ok(this)
    }

    /// Asks a question and waits for the line of the answer, without its end.
    pub fn ask(&mut self, timeout: Duration, question: Vec<u8>) -> Result<Vec<u8>, ProcessError> {
        if self.questions.as_ref().is_none_or(|questions| questions.send(question).is_err()) {
            return Err(ProcessError::Ended(self.status()));
        }
        let mut answer = match self.answers.recv_timeout(timeout) {
            Ok(answer) => answer,
            Err(RecvTimeoutError::Timeout) => return Err(ProcessError::Silent(timeout)),
            Err(RecvTimeoutError::Disconnected) => return Err(ProcessError::Ended(self.status())),
        };
        if answer.len() > MOST_BYTES {
            return Err(ProcessError::TooLong(MOST_BYTES));
        }
        if answer.pop_if(|last| *last == b'\n').is_none() {
            return Err(ProcessError::Ended(self.status()));
        }
        self.answered += 1;
        Ok(answer)
    }

    /// How the process has ended, when it does soon.
    fn status(&self) -> Option<ExitStatus> {
        self.ends_by(Instant::now() + PATIENCE)
    }

    fn ends_by(&self, end: Instant) -> Option<ExitStatus> {
        loop {
            match locked(&self.child).try_wait() {
                Ok(Some(status)) => return Some(status),
                Ok(None) if Instant::now() < end => {}
                _ => return None,
            }
            thread::sleep(LOOK);
        }
    }

    /// Ends it at once, with all that it has started.
    pub fn kill(&mut self) {
        let mut child = locked(&self.child);
        kill(&mut child);
        let _ = child.wait();
    }

    /// Ends processes: their input ends, and who is still there a little later is killed.
    pub fn end(mut processes: Vec<Self>) {
        processes.iter_mut().for_each(|process| process.questions = None);
        let end = Instant::now() + PATIENCE;
        for process in &mut processes {
            if process.ends_by(end).is_none() {
                process.kill();
            }
            // Its last words; what it has started itself may hold the pipe for longer.
            while process.log.as_ref().is_some_and(|log| !log.is_finished()) && Instant::now() < end {
                thread::sleep(LOOK);
            }
        }
    }
}

impl Drop for Process {
    fn drop(&mut self) {
        // One that was ended in order is gone already.
        if self.ends_by(Instant::now()).is_none() {
            self.kill();
        }
    }
}

/// Kills a process with its group: a script that waits for a program must not leave it behind.
fn kill(child: &mut Child) {
    #[cfg(unix)]
    if let Ok(group) = i32::try_from(child.id()) {
        // It fails where all of the group have ended, which is what is wanted; so does the next.
        let _ = nix::sys::signal::killpg(nix::unistd::Pid::from_raw(group), nix::sys::signal::Signal::SIGKILL);
    }
    let _ = child.kill();
}

/// Ctrl-C is a request to this program, which ends the others when it does: a trial under way must not fail by it.
#[cfg(unix)]
fn apart(command: &mut Command) {
    std::os::unix::process::CommandExt::process_group(command, 0);
}

/// The same.
#[cfg(windows)]
fn apart(command: &mut Command) {
    const CREATE_NEW_PROCESS_GROUP: u32 = 0x200;
    std::os::windows::process::CommandExt::creation_flags(command, CREATE_NEW_PROCESS_GROUP);
}

#[cfg(not(any(unix, windows)))]
fn apart(_: &mut Command) {}

/// Writes questions and reads answers until nobody asks any more, or listens; an answer without the end of its line is
/// the last one.
fn converse(mut input: ChildStdin, output: ChildStdout, asked: &Receiver<Vec<u8>>, answers: &SyncSender<Vec<u8>>) {
    let mut output = BufReader::new(output);
    for question in asked {
        // A process that does not read may have said why before: its output tells.
        let _ = input.write_all(&question);
        let mut answer = Vec::new();
        let read = output.by_ref().take(MOST_BYTES as u64 + 1).read_until(b'\n', &mut answer);
        if read.is_err() || answers.send(answer).is_err() {
            return;
        }
    }
}

/// Hands on what a process says beside its answers.
fn keep(errors: impl Read, mut log: Listener) {
    let mut errors = BufReader::new(errors);
    let mut line = Vec::new();
    loop {
        line.clear();
        // In pieces of a bounded size, whole lines where they are short.
        match errors.by_ref().take(MOST_BYTES as u64).read_until(b'\n', &mut line) {
            Ok(0) | Err(_) => return,
            Ok(_) => log(&line),
        }
    }
}
