//! Every published or independently computed number against ours, and VALIDATION.md and docs/validation.csv against the
//! program that writes them.

use std::collections::BTreeSet;
use std::path::PathBuf;
use std::sync::OnceLock;

use kempf_tests::validation::{self, Section, pages};

/// Computed once for the tests of this file.
fn sections() -> &'static [Section] {
    static SECTIONS: OnceLock<Vec<Section>> = OnceLock::new();
    SECTIONS.get_or_init(validation::sections)
}

#[test]
fn every_number_agrees_with_the_published_one() {
    let checks = sections().iter().flat_map(|section| &section.checks);
    let wrong: Vec<String> = checks
        .filter(|check| !check.holds())
        .map(|check| format!("{}: {} for {} ({:?})", check.id, check.ours, check.published, check.tolerance))
        .collect();
    assert!(wrong.is_empty(), "{} numbers differ:\n{}", wrong.len(), wrong.join("\n"));
}

#[test]
fn no_check_is_made_twice_and_none_is_missing() {
    let ids: BTreeSet<&str> =
        sections().iter().flat_map(|section| &section.checks).map(|check| check.id.as_str()).collect();
    let count: usize = sections().iter().map(|section| section.checks.len()).sum();
    assert_eq!(ids.len(), count, "identifiers are unique");
    assert!(sections().iter().all(|section| !section.checks.is_empty()));
}

fn check_file(path: &str, made: &str) {
    let root = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("..");
    let kept = std::fs::read_to_string(root.join(path)).unwrap_or_else(|error| panic!("{path}: {error}"));
    let differing = made.lines().zip(kept.lines()).find(|(made, kept)| made != kept);
    assert!(
        made == kept,
        "{path} is not what `cargo run -p kempf-tests --bin validation` writes; first different line: {differing:?}"
    );
}

#[test]
fn documents_are_what_the_program_writes() {
    check_file("VALIDATION.md", &pages::markdown(sections()));
    check_file("docs/validation.csv", &pages::table(sections()));
}
