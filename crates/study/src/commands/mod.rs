//! The commands, one file each: they read options, call [`crate::work`] or the crates below for the computation, and
//! hand the results to [`crate::views`].

pub mod bench;
pub mod check;
pub mod doctor;
pub mod find;
pub mod fit;
pub mod fit_each;
pub mod inspect;
pub mod list;
pub mod predict;
pub mod report;
pub mod run;
pub mod schema;
pub mod score;
pub mod shell;
pub mod sidecar;
pub mod simulate;
pub mod trace;

use campaign::failure::Failure;

use crate::documents::answers::CommandAnswer;
use crate::options::{CommonOptions, Format};
use crate::{documents, screen};

/// Prints a reply as a line of text, or as a JSON document with `--format json`; prints nothing if the output is
/// silent.
///
/// Fails as [`screen::print_lines`] does.
fn reply(common: &CommonOptions, answer: &impl CommandAnswer, line: &str) -> Result<(), Failure> {
    match common.format {
        Format::Json => documents::print_document(answer),
        _ if common.quiet => Ok(()),
        _ => screen::print_lines(line),
    }
}
