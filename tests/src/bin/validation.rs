//! Writes VALIDATION.md and docs/validation.csv: every reference number this workspace is held against, beside its own.

fn main() -> std::io::Result<()> {
    kempf_tests::validation::pages::write()
}
