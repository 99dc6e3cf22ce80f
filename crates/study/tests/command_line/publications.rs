//! Tests of the published results: they belong to the scenarios, and the page over them is that of the script.

use std::ffi::OsStr;
use std::fs;
use std::process::Command;

use toml::{Table, Value};

use crate::desk::{Desk, of_repository};

/// The manifest of every published study holds the present text of its scenario.
#[test]
fn published_results_belong_to_the_scenarios() {
    let results = of_repository("results");
    let folders = ["scenarios", "scenarios/measured"].map(of_repository);
    for entry in folders.iter().flat_map(|folder| fs::read_dir(folder).expect("the folder is there")) {
        let path = entry.expect("readable").path();
        let name = path.file_name().and_then(|name| name.to_str()?.strip_suffix(".toml"));
        let Some(name) = name.filter(|name| !name.ends_with(".trial")) else { continue };
        let manifest = results.join("published").join(name).join("manifest.toml");
        let manifest = fs::read_to_string(&manifest).unwrap_or_else(|error| panic!("{name}: {error}"));
        let manifest: Table = manifest.parse().expect("it is TOML");
        let scenario = fs::read_to_string(&path).expect("it was just listed");
        let stored = manifest["scenario"].as_str().expect("a manifest has its scenario");
        assert!(stored == scenario, "{name} was changed after its results were made; run `results/publish.py`");
    }
}

/// `results/README.md` is the page that `results/publish.py --page` makes.
#[test]
fn the_page_over_published_results_is_that_of_the_script() {
    let desk = Desk::new();
    let results = of_repository("results");
    let page = desk.path("README.md");
    let python = |arguments: &[&OsStr]| Command::new("python3").args(arguments).output();
    if !python(&["-c".as_ref(), "import tomllib".as_ref()]).is_ok_and(|known| known.status.success()) {
        return eprintln!("skipped: there is no python3 of version 3.11 or later");
    }
    let script = results.join("publish.py");
    let made = python(&[script.as_ref(), "--page".as_ref(), page.as_ref()]).expect("it has just been started");
    assert!(made.status.success(), "{}", String::from_utf8_lossy(&made.stderr));
    let stored = fs::read(results.join("README.md")).expect("there is a page");
    assert!(fs::read(page).expect("it was made") == stored, "run `python3 results/publish.py --page`");
}

/// The rows of a published study are not stored; its manifest is a valid scenario from which they can be computed.
/// Studies of measured records are left out, because they need the folder of records.
#[test]
fn manifests_of_published_studies_can_be_run() {
    let desk = Desk::new();
    let published = of_repository("results/published");
    for name in campaign::disk::entry_names(&published).expect("the folder is there") {
        let manifest = published.join(&name).join("manifest.toml");
        if fs::read_to_string(&manifest).is_ok_and(|text| !text.contains("records.")) {
            desk.run(&["check", &manifest.to_string_lossy()]).is_done();
        }
    }
}

/// Name of every folder of published results, and the entries on the program that made it: `manifest.toml`, else the
/// table in `program.toml`; empty without either.
fn programs() -> Vec<(String, Table)> {
    let published = of_repository("results/published");
    let program = |name: &String| {
        let table = |file: &str| fs::read_to_string(published.join(name).join(file)).ok()?.parse::<Table>().ok();
        let stamp = || table("program.toml")?.remove("program")?.try_into().ok();
        table("manifest.toml").or_else(stamp).unwrap_or_default()
    };
    let names = campaign::disk::entry_names(&published).expect("the folder is there");
    names.iter().map(|name| (name.clone(), program(name))).collect()
}

/// All folders were made by the same revision, without uncommitted changes.
#[test]
fn published_results_are_of_one_revision() {
    let programs = programs();
    let maker = |program: &Table| {
        ["version", "git-revision"].map(|key| program.get(key).and_then(Value::as_str).map(str::to_owned))
    };
    let first = maker(&programs.first().expect("a study").1);
    let is_clean = |program: &Table| {
        let is_changed = program.get("git-dirty").is_some_and(|dirty| dirty.as_bool() != Some(false));
        maker(program) == first && first.iter().all(Option::is_some) && !is_changed
    };
    let others = programs.iter().filter(|(_, program)| !is_clean(program)).map(|(name, _)| name);
    let others: Vec<_> = others.collect();
    assert!(others.is_empty(), "not made by one clean revision, {first:?}; run `results/publish.py`: {others:?}");
}

/// The published results are at most 10.2 MB, so a clone stays small.
#[test]
fn published_results_have_little_more_than_ten_megabytes() {
    let root = of_repository("");
    let options = ["ls-files", "-z", "--cached", "--others", "--exclude-standard", "results/published"];
    let listed = Command::new("git").args(options).current_dir(&root).output();
    let Some(listed) = listed.ok().filter(|listed| listed.status.success()) else {
        return eprintln!("skipped: this is no clone, or there is no git");
    };
    let files = String::from_utf8(listed.stdout).expect("UTF-8");
    let size = |file| fs::metadata(root.join(file)).map_or(0, |known| known.len());
    let total: u64 = files.split_terminator('\0').map(size).sum();
    assert!(total > 1_000_000 && total <= 10_200_000, "{total} bytes");
}
