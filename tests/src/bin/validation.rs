//! Writes VALIDATION.md and docs/validation.csv: every reference number this workspace is held against, beside its own.

use std::path::Path;

use kempf_tests::validation::{self, pages};

fn main() -> std::io::Result<()> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let sections = validation::sections();
    std::fs::write(root.join("VALIDATION.md"), pages::markdown(&sections))?;
    std::fs::write(root.join("docs/validation.csv"), pages::table(&sections))
}
