//! Writes VALIDATION.md and docs/validation.csv: every reference number of the validation, with the number of this
//! workspace.

fn main() -> std::io::Result<()> {
    kempf_tests::validation::pages::write()
}
