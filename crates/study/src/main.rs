//! The `study` command.

use std::process::ExitCode;

fn main() -> ExitCode {
    estimation::memory::keep_freed_memory();
    study::cli::main()
}
