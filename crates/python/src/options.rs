//! Keyword arguments of Python, parsed as options of the command line, which declares and checks them.

use campaign::failure::Failure;
use clap::{Args, Parser};
use study::cli::usage_failure;

#[derive(Parser)]
#[command(no_binary_name = true)]
struct KeywordOptions<R: Args> {
    #[command(flatten)]
    request: R,
}

/// Request parsed from options, each written as `--name=value`, and from arguments after `--`.
///
/// Fails with the usage error of the command line.
pub fn parse_request<R: Args>(options: Vec<String>) -> Result<R, Failure> {
    KeywordOptions::try_parse_from(options).map(|parsed| parsed.request).map_err(|usage| usage_failure(&usage))
}
