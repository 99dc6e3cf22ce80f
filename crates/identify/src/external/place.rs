//! Where the program of a command and its files are.

use std::io;
use std::path::{Path, PathBuf};
use std::process::Command;

/// What scripts end in: an argument that ends so names a file, and an interpreter without it answers nothing.
const SCRIPTS: [&str; 13] = ["py", "r", "jl", "m", "sh", "js", "rb", "pl", "lua", "php", "jar", "ps1", "bat"];

/// Most characters of a command in a message.
const LONGEST: usize = 120;

/// A command as a person writes it, shortened.
pub fn shown(command: &[String]) -> String {
    let word = |word: &String| match word.contains(|c: char| c.is_whitespace() || c == '"') {
        true => format!("{word:?}"),
        false => word.clone(),
    };
    let whole = command.iter().map(word).collect::<Vec<_>>().join(" ");
    match whole.char_indices().nth(LONGEST) {
        Some((end, _)) => format!("{}…", &whole[..end]),
        None => whole,
    }
}

/// The command in its folder, ready to be started. A program with a path is looked for from the folder, one without
/// where the system has its programs.
pub fn command(words: &[String], folder: &Path) -> io::Result<Command> {
    let (program, arguments) = words.split_first().ok_or(io::ErrorKind::NotFound)?;
    let mut command = match is_path(program) {
        // Whether a relative one is from the folder differs between systems.
        true => Command::new(std::path::absolute(folder.join(program))?),
        false => Command::new(program),
    };
    command.args(arguments).current_dir(if folder.as_os_str().is_empty() { Path::new(".") } else { folder });
    Ok(command)
}

fn is_path(program: &str) -> bool {
    Path::new(program).components().count() > 1 || program.ends_with(std::path::is_separator)
}

/// Looks for the program, and for scripts among its arguments.
///
/// Fails with a sentence that names what is not there.
pub fn find(words: &[String], folder: &Path) -> Result<(), String> {
    let Some((program, arguments)) = words.split_first() else { return Err("the command is empty".to_owned()) };
    let place = std::path::absolute(folder).unwrap_or_else(|_| folder.to_owned());
    if is_path(program) {
        let path = place.join(program);
        if ![path.clone(), executable(&path)].iter().any(|path| path.is_file()) {
            return Err(format!("there is no program {}", path.display()));
        }
    } else if !on_path(program) {
        return Err(format!(
            "there is no program `{program}` on the PATH; install it, or write ./{program} for one in {}",
            place.display()
        ));
    }
    let before = std::iter::once(program).chain(arguments);
    for (argument, _) in arguments.iter().zip(before).filter(|(_, before)| *before != "-m") {
        let is_script = Path::new(argument)
            .extension()
            .and_then(|extension| extension.to_str())
            .is_some_and(|own| SCRIPTS.iter().any(|known| own.eq_ignore_ascii_case(known)));
        if is_script && !argument.starts_with('-') && !place.join(argument).is_file() {
            return Err(format!("there is no file {argument} in {}", place.display()));
        }
    }
    Ok(())
}

fn on_path(program: &str) -> bool {
    let folders = std::env::var_os("PATH").unwrap_or_default();
    std::env::split_paths(&folders).any(|folder| {
        let path = folder.join(program);
        is_executable(&path) || is_executable(&executable(&path))
    })
}

/// The name with what programs end in on this system.
fn executable(path: &Path) -> PathBuf {
    let mut name = path.as_os_str().to_owned();
    name.push(std::env::consts::EXE_SUFFIX);
    name.into()
}

#[cfg(unix)]
fn is_executable(path: &Path) -> bool {
    use std::os::unix::fs::PermissionsExt;
    path.metadata().is_ok_and(|about| about.is_file() && about.permissions().mode() & 0o111 != 0)
}

#[cfg(not(unix))]
fn is_executable(path: &Path) -> bool {
    path.is_file()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn find_in(folder: &Path, words: &[&str]) -> Result<(), String> {
        find(&words.iter().map(|&word| word.to_owned()).collect::<Vec<_>>(), folder)
    }

    /// The folder of this crate stands for that of a scenario.
    #[test]
    fn what_a_command_lacks_is_named() {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR"));
        let refused = |words: &[&str], part: &str| {
            let problem = find_in(folder, words).expect_err("something is missing");
            assert!(problem.contains(part), "{problem}");
        };
        refused(&["no-such-program-here"], "`no-such-program-here` on the PATH");
        refused(&["./no-such-program"], "no-such-program");
        refused(&["cargo", "mine.py"], "no file mine.py in ");
        refused(&["cargo", "sub/mine.R"], "no file sub/mine.R in ");
        assert_eq!(find_in(folder, &["cargo", "-m", "package.py"]), Ok(()));
        assert_eq!(find_in(folder, &["cargo", "src/lib.rs", "--x=a.py", "1.5"]), Ok(()));
    }

    #[test]
    fn a_command_is_shown_on_one_line() {
        let words = ["python3", "-c", "import x\nx.y()"].map(str::to_owned);
        assert_eq!(shown(&words), "python3 -c \"import x\\nx.y()\"");
        assert_eq!(shown(&["x".repeat(1000)]).chars().count(), LONGEST + 1);
    }
}
