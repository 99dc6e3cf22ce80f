//! Runs the commands of README.md and of the book, page by page, in a folder with the scenarios and examples of the
//! repository. Afterwards git may see no file except those that the page tells a reader to write. The info string of a
//! block decides its treatment:
//!
//! | block | here |
//! |---|---|
//! | `sh` | every line is run |
//! | `sh,needs=PROGRAM` | every line is run if the machine has this program |
//! | `sh,skip=WHY` | listed with the reason, not run |
//! | `LANGUAGE,file=NAME` | written to a file of this name |
//! | `text,shown` | must be in the output of the block before it; a line `…` matches any lines |
//! | another language of [`LANGUAGES`] | ignored |

#![cfg(unix)]

use std::cell::OnceCell;
use std::fs;
use std::path::PathBuf;
use std::process::{Command, Stdio};

use rayon::prelude::*;

use crate::desk::{copy, of_repository};

/// Languages of blocks. Any other language is an error, because its commands would never run.
const LANGUAGES: [&str; 10] = ["sh", "toml", "csv", "text", "json", "rust", "python", "octave", "latex", "bibtex"];

/// Calls of the program from a clone of the repository, the longest first.
const CALLS: [&str; 2] = ["cargo run --release -p study --", "cargo run -p study --"];

/// Fenced code block of a page.
#[derive(Debug, PartialEq)]
struct Block {
    language: String,
    /// Info string after the language and a comma.
    mark: String,
    /// Number of its first line in the page.
    line: usize,
    text: String,
}

/// All blocks of a page.
fn blocks(page: &str) -> Vec<Block> {
    let mut blocks: Vec<Block> = Vec::new();
    let mut open: Option<Block> = None;
    for (number, line) in page.lines().enumerate() {
        let fence = line.trim_start().strip_prefix("```");
        open = match (open, fence) {
            (None, Some(info)) => {
                let (language, mark) = info.split_once(',').unwrap_or((info, ""));
                let (language, mark) = (language.to_owned(), mark.to_owned());
                Some(Block { language, mark, line: number + 2, text: String::new() })
            }
            (Some(block), Some("")) => {
                blocks.push(block);
                None
            }
            (Some(mut block), _) => {
                block.text.push_str(line);
                block.text.push('\n');
                Some(block)
            }
            (None, None) => None,
        };
    }
    assert!(open.is_none(), "a block has no end: {open:?}");
    blocks
}

/// Commands of a block, each with the number of its first line; a line that ends with `\` continues in the next line.
fn commands(block: &Block) -> Vec<(usize, String)> {
    let mut commands: Vec<(usize, String)> = Vec::new();
    let mut goes_on = false;
    for (number, line) in block.text.lines().enumerate() {
        let (part, more) = line.strip_suffix('\\').map_or((line, false), |part| (part, true));
        match commands.last_mut() {
            Some((_, command)) if goes_on => command.push_str(part),
            _ => commands.push((block.line + number, part.to_owned())),
        }
        goes_on = more;
    }
    let called = |command: String| CALLS.iter().fold(command, |command, call| command.replace(call, "study"));
    commands.into_iter().map(|(line, command)| (line, called(command))).collect()
}

/// `true` if the parts of `text` between lines `…` occur in `printed`, in their order.
fn is_shown(text: &str, printed: &str) -> bool {
    let mut rest = printed;
    text.split("…\n").all(|part| {
        let place = rest.find(part);
        rest = place.map_or("", |place| &rest[place + part.len()..]);
        place.is_some()
    })
}

/// Temporary folder in which the commands of a page run.
struct Scratch {
    folder: tempfile::TempDir,
    path: std::ffi::OsString,
}

impl Scratch {
    fn new() -> Self {
        let folder = tempfile::tempdir().expect("a temporary folder");
        for name in ["scenarios", "examples"].iter().filter(|name| of_repository(name).is_dir()) {
            copy(&of_repository(name), &folder.path().join(name));
        }
        fs::copy(of_repository(".gitignore"), folder.path().join(".gitignore")).expect("a copy");
        let programs = folder.path().join(".programs");
        fs::create_dir(&programs).expect("a folder");
        std::os::unix::fs::symlink(env!("CARGO_BIN_EXE_study"), programs.join("study")).expect("a link");
        let others = std::env::var_os("PATH").unwrap_or_default();
        let path = std::env::join_paths([programs].into_iter().chain(std::env::split_paths(&others)));
        let scratch = Self { path: path.expect("a search path"), folder };
        let begin = "git init -q && echo .programs >> .git/info/exclude && git add -A";
        scratch.run(&format!("if command -v git; then {begin}; fi")).expect("a repository");
        scratch
    }

    /// Files that git reports as changed or new, without those `written` by the page; empty without git.
    fn left(&self, written: &[&str]) -> Result<String, String> {
        let look = "git diff --name-only && git ls-files --others --exclude-standard";
        let seen = self.run(&format!("if command -v git > /dev/null; then {look}; fi"))?;
        let is_of_page = |line: &&str| written.contains(line);
        Ok(seen.lines().filter(|line| !is_of_page(line)).collect::<Vec<_>>().join(", "))
    }

    fn shell(&self, command: &str) -> Command {
        let mut shell = Command::new("bash");
        shell.args(["-uo", "pipefail", "-c", command]).env("PATH", &self.path);
        shell.current_dir(self.folder.path()).stdin(Stdio::null());
        shell
    }

    fn has(&self, program: &str) -> bool {
        self.shell(&format!("command -v {program}")).output().is_ok_and(|output| output.status.success())
    }

    /// Standard output of a command. Fails with the command, its exit status and all its output.
    fn run(&self, command: &str) -> Result<String, String> {
        let output = self.shell(command).output().map_err(|error| format!("{command}: {error}"))?;
        let [out, err] = [&output.stdout, &output.stderr].map(|bytes| String::from_utf8_lossy(bytes).into_owned());
        match output.status.success() {
            true => Ok(out),
            false => Err(format!("{command}\n{}\n{out}{err}", output.status)),
        }
    }
}

/// Runs the blocks of a page; returns those that were not run, each with the reason. Fails at the first fault.
fn work_through(page: &str) -> Result<Vec<String>, String> {
    // Most pages have no command and need no folder.
    let made = OnceCell::new();
    let scratch = || made.get_or_init(Scratch::new);
    let (mut left_out, mut written) = (Vec::new(), Vec::new());
    // Output of the last block of commands; `None` if it was not run.
    let mut printed = None;
    let blocks = blocks(page);
    for block in &blocks {
        let Block { language, mark, line, text } = block;
        if !LANGUAGES.contains(&language.as_str()) {
            return Err(format!("{line}: a block of {language:?}; expected one of {}", LANGUAGES.join(", ")));
        }
        let (key, value) = mark.split_once('=').unwrap_or((mark, ""));
        match (language.as_str(), key) {
            ("sh", "skip") if !value.is_empty() => {
                left_out.push(format!("{line}: {value}"));
                printed = None;
            }
            ("sh", "needs") if !scratch().has(value) => {
                left_out.push(format!("{line}: there is no {value}"));
                printed = None;
            }
            ("sh", "" | "needs") => {
                let of_each = commands(block)
                    .into_iter()
                    .map(|(line, command)| scratch().run(&command).map_err(|error| format!("{line}: {error}")));
                printed = Some(of_each.collect::<Result<String, String>>()?);
            }
            ("text", "shown") => match &printed {
                Some(printed) if !is_shown(text, printed) => {
                    return Err(format!("{line}: the page shows\n{text}\nand what was printed is\n{printed}"));
                }
                _ => {}
            },
            (_, "" | "no_run") => {}
            (_, "file") if !page.contains(&format!("`{value}`")) => {
                return Err(format!("{line}: a reader is not told that this is {value:?}"));
            }
            (_, "file") => {
                let path = scratch().folder.path().join(value);
                fs::create_dir_all(path.parent().expect("it is in the folder")).expect("a folder");
                fs::write(path, text).expect("a file");
                written.push(value);
            }
            _ => return Err(format!("{line}: nobody knows the mark {mark:?}")),
        }
    }
    match made.get().map(|scratch| scratch.left(&written)).transpose()?.unwrap_or_default() {
        left if left.is_empty() => Ok(left_out),
        left => Err(format!("git sees what was left: {left}; give it a name in .gitignore")),
    }
}

/// README.md and all pages of the book, the examples and the crates.
fn pages() -> Vec<PathBuf> {
    let mut pages = vec![of_repository("README.md")];
    let mut folders: Vec<PathBuf> = ["docs/src", "examples", "crates"].map(of_repository).to_vec();
    while let Some(folder) = folders.pop() {
        for path in fs::read_dir(folder).into_iter().flatten().flatten().map(|entry| entry.path()) {
            match path.is_dir() {
                true => folders.push(path),
                false => pages.extend(path.extension().is_some_and(|end| end == "md").then_some(path)),
            }
        }
    }
    pages.sort();
    pages
}

#[test]
fn what_the_pages_tell_to_type_can_be_typed() {
    let root = of_repository("");
    let work = |page: PathBuf| {
        let name = page.strip_prefix(&root).unwrap_or(&page).display().to_string();
        let text = fs::read_to_string(&page).unwrap_or_else(|error| panic!("{name}: {error}"));
        (name, work_through(&text))
    };
    let mut faults = Vec::new();
    for (name, worked) in pages().into_par_iter().map(work).collect::<Vec<_>>() {
        match worked {
            Ok(left_out) => left_out.iter().for_each(|why| println!("not run: {name}:{why}")),
            Err(fault) => faults.push(format!("{name}:{fault}")),
        }
    }
    assert!(faults.is_empty(), "{}", faults.join("\n\n"));
}

#[test]
fn a_page_that_is_wrong_is_found() {
    let good = "This is `a.toml`:\n```toml,file=a.toml\nx = 1\n```\n```sh\nprintf 'one\\ntwo\\n' | \\\n  cat\ncat a.toml\n```\n\
                ```text,shown\none\n…\nx = 1\n```\n```sh,skip=it takes long\nfalse\n```\n```sh,needs=no-such-program\nfalse\n```\n\
                ```text,shown\nnothing\n```\n";
    assert_eq!(work_through(good), Ok(vec!["16: it takes long".into(), "19: there is no no-such-program".into()]));
    for (page, said) in [
        (
            "x\n```sh\ntrue\ncargo run -p study -- lists\n```\n",
            "4: study lists\nexit status: 2\nerror: there is no command",
        ),
        ("```sh\necho one | grep two | cat\n```\n", "2: echo one"),
        ("```sh\necho one\n```\n```text,shown\ntwo\n```\n", "5: the page shows\ntwo\n"),
        ("```bash\ntrue\n```\n", "2: a block of \"bash\""),
        ("```csv,file=a.csv\nx\n```\n", "2: a reader is not told that this is \"a.csv\""),
        ("```sh,skip\ntrue\n```\n", "2: nobody knows the mark \"skip\""),
        ("```sh\ntouch new.txt scenarios/new.csv\n```\n", "git sees what was left: new.txt, scenarios/new.csv"),
        ("```sh\nrm scenarios/yukun.toml\n```\n", "git sees what was left: scenarios/yukun.toml"),
    ] {
        let fault = work_through(page).expect_err("it is wrong");
        assert!(fault.starts_with(said), "{fault}");
    }
}
