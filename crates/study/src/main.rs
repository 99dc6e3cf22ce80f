//! The `study` command.

use std::process::ExitCode;

fn main() -> ExitCode {
    study::cli::main()
}
