//! Keywords of Python as options of the command line, so that what may be asked for is declared and checked there.

use campaign::failure::Failure;
use clap::{Args, Parser};
use study::cli::misused;

#[derive(Parser)]
#[command(no_binary_name = true)]
struct OptionWords<R: Args> {
    #[command(flatten)]
    request: R,
}

/// The request that options make, each written as `--name=value`.
///
/// Fails as the command line does.
pub fn request<R: Args>(words: Vec<String>) -> Result<R, Failure> {
    OptionWords::try_parse_from(words).map(|words| words.request).map_err(|usage| misused(&usage))
}
