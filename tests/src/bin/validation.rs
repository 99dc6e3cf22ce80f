//! Prints VALIDATION.md: every published number this workspace is held against, beside its own.

use kempf_tests::validation;

fn main() {
    print!("{}", validation::markdown(&validation::sections()));
}
