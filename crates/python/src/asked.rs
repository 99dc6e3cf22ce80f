//! Keywords of Python as options of the command line, so that what may be asked for is declared and checked there.

use clap::{Args, Parser};
use scenario::failure::Failure;

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
    OptionWords::try_parse_from(words).map(|words| words.request).map_err(|usage| {
        let said = usage.to_string();
        let (said, _) = said.split_once("\n\nUsage:").unwrap_or((&said, ""));
        let (said, _) = said.split_once("\n\nFor more information").unwrap_or((said, ""));
        Failure::input(said.trim().trim_start_matches("error: "))
    })
}
