//! What a manifest says of the program, known when it is built: the revision of its source, whether that had been
//! changed since, and the versions of the crates that decide the numbers.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

/// Crates whose version is part of a result's identity.
const NUMERIC: [&str; 5] = ["nalgebra", "rand", "rand_distr", "realfft", "statrs"];

fn main() {
    let package = Path::new(env!("CARGO_MANIFEST_DIR"));
    println!("cargo::rerun-if-changed=build.rs");
    let lock = package.ancestors().map(|folder| folder.join("Cargo.lock")).find(|lock| lock.is_file());
    let locked = lock.as_deref().and_then(|lock| fs::read_to_string(lock).ok()).unwrap_or_default();
    let versions: Vec<String> = NUMERIC.iter().flat_map(|name| versions(&locked, name)).collect();
    println!("cargo::rustc-env=KEMPF_NUMERIC_CRATES={}", versions.join(","));
    if let Some(lock) = lock {
        println!("cargo::rerun-if-changed={}", lock.display());
    }
    let root = package.join("../..");
    let Some(git) = repository(&root) else { return };
    println!("cargo::rerun-if-changed={}", git.join("HEAD").display());
    // What this program is made from.
    println!("cargo::rerun-if-changed={}", root.join("crates").display());
    if let Some(revision) = revision(&git) {
        println!("cargo::rustc-env=KEMPF_GIT_REVISION={revision}");
    }
    if is_changed(&root) {
        println!("cargo::rustc-env=KEMPF_GIT_DIRTY=1");
    }
}

/// "name version" of a crate, once for every version in the lock file.
fn versions(locked: &str, name: &str) -> Vec<String> {
    let wanted = format!("name = \"{name}\"");
    let lines: Vec<&str> = locked.lines().collect();
    let of = lines.windows(2).filter(|pair| pair[0] == wanted).filter_map(|pair| pair[1].strip_prefix("version = "));
    of.map(|version| format!("{name} {}", version.trim_matches('"'))).collect()
}

/// Whether the source of the program differs from its revision. Without git nobody can tell.
fn is_changed(root: &Path) -> bool {
    let status = ["status", "--porcelain", "--untracked-files=no", "--", "crates", "Cargo.toml", "Cargo.lock"];
    let output = Command::new("git").arg("-C").arg(root).args(status).output();
    output.is_ok_and(|output| output.status.success() && !output.stdout.is_empty())
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
