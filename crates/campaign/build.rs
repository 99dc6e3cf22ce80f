//! Build facts for manifests: the last revision of the source, whether it has uncommitted changes, and the versions of
//! the numerical crates.

use std::path::{Path, PathBuf};
use std::process::Command;
use std::{env, fs};

/// Numerical crates, whose versions are part of a result's identity.
const NUMERIC: [&str; 5] = ["nalgebra", "rand", "rand_distr", "realfft", "statrs"];

/// Paths of the source of the program.
const SOURCE: [&str; 3] = ["crates", "Cargo.toml", "Cargo.lock"];

fn main() {
    // Read at run time: a compiled script may have been moved with its folder.
    let package = PathBuf::from(env::var_os("CARGO_MANIFEST_DIR").expect("cargo sets it"));
    println!("cargo::rerun-if-changed=build.rs");
    let lock = package.ancestors().map(|folder| folder.join("Cargo.lock")).find(|lock| lock.is_file());
    let locked = lock.as_deref().and_then(|lock| fs::read_to_string(lock).ok()).unwrap_or_default();
    let versions: Vec<String> = NUMERIC.iter().flat_map(|name| versions(&locked, name)).collect();
    println!("cargo::rustc-env=KEMPF_NUMERIC_CRATES={}", versions.join(","));
    if let Some(lock) = lock {
        println!("cargo::rerun-if-changed={}", lock.display());
    }
    let root = package.join("../..");
    if !root.join(".git").exists() {
        return;
    }
    // The source, and the git log of this checkout.
    println!("cargo::rerun-if-changed={}", root.join("crates").display());
    if let Some(log) = git(&root, &["rev-parse", "--git-path", "logs/HEAD"]) {
        println!("cargo::rerun-if-changed={}", root.join(log).display());
    }
    // Revisions that change only pages, scenarios or results are the same program.
    if let Some(revision) = git(&root, &[&["log", "-1", "--format=%H", "--"][..], &SOURCE].concat()) {
        println!("cargo::rustc-env=KEMPF_GIT_REVISION={revision}");
    }
    if git(&root, &[&["status", "--porcelain", "--untracked-files=no", "--"][..], &SOURCE].concat()).is_some() {
        println!("cargo::rustc-env=KEMPF_GIT_DIRTY=1");
    }
}

/// "name version" for every version of a crate in the lock file.
fn versions(locked: &str, name: &str) -> Vec<String> {
    let head = format!("name = \"{name}\"");
    let lines: Vec<&str> = locked.lines().collect();
    let hits = lines.windows(2).filter(|pair| pair[0] == head).filter_map(|pair| pair[1].strip_prefix("version = "));
    hits.map(|version| format!("{name} {}", version.trim_matches('"'))).collect()
}

/// Output of git in a checkout; `None` for empty output, an error, and without git.
fn git(root: &Path, arguments: &[&str]) -> Option<String> {
    let output = Command::new("git").arg("-C").arg(root).args(arguments).output().ok()?;
    let text = String::from_utf8(output.stdout).ok()?.trim().to_owned();
    (output.status.success() && !text.is_empty()).then_some(text)
}
