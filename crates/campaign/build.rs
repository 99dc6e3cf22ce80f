//! Tells the program from which revision of its source it is built, so that it need not ask when it runs.

use std::fs;
use std::path::{Path, PathBuf};

fn main() {
    let Some(git) = repository(&Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")) else {
        println!("cargo::rerun-if-changed=build.rs");
        return;
    };
    println!("cargo::rerun-if-changed={}", git.join("HEAD").display());
    if let Some(revision) = revision(&git) {
        println!("cargo::rustc-env=KEMPF_GIT_REVISION={revision}");
    }
}

/// The folder `.git` of a checkout, or what the file of that name in a linked one names.
fn repository(source: &Path) -> Option<PathBuf> {
    let git = source.join(".git");
    match fs::read_to_string(&git) {
        Ok(link) => Some(source.join(link.strip_prefix("gitdir: ")?.trim())),
        Err(_) => git.is_dir().then_some(git),
    }
}

/// The revision that is checked out, from the files of git themselves.
fn revision(git: &Path) -> Option<String> {
    let head = fs::read_to_string(git.join("HEAD")).ok()?;
    let found = match head.trim().strip_prefix("ref: ") {
        None => head.trim().to_owned(),
        Some(branch) => {
            let common = fs::read_to_string(git.join("commondir")).ok();
            let shared = common.map_or_else(|| git.to_owned(), |path| git.join(path.trim()));
            println!("cargo::rerun-if-changed={}", shared.join(branch).display());
            let packed = || {
                let list = fs::read_to_string(shared.join("packed-refs")).ok()?;
                let line = list.lines().find(|line| line.split_once(' ').is_some_and(|(_, name)| name == branch))?;
                line.split_once(' ').map(|(revision, _)| revision.to_owned())
            };
            fs::read_to_string(shared.join(branch)).ok().or_else(packed)?.trim().to_owned()
        }
    };
    (found.len() >= 40 && found.bytes().all(|byte| byte.is_ascii_hexdigit())).then_some(found)
}
