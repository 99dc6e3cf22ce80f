//! `study merge DIR... --out DIR`: the shards of one study joined and published.

use std::path::PathBuf;

use campaign::folder::ResultFolder;
use campaign::merge::join;
use clap::Args;
use scenario::failure::Failure;

use crate::options::{Common, StudyFigureOptions};
use crate::views::publish::publish;

/// What `study merge` is asked to do.
#[derive(Debug, Clone, Args)]
pub struct MergeRequest {
    /// Folders written with --shard, all of them, in any order
    #[arg(required = true, value_name = "DIR")]
    pub folders: Vec<PathBuf>,
    /// How figures are drawn, and which
    #[command(flatten)]
    pub style: StudyFigureOptions,
}

/// Joins shards and publishes the whole.
pub fn run(MergeRequest { folders, style }: &MergeRequest, common: &Common) -> Result<(), Failure> {
    let theme = style.style.theme()?;
    let Some(out) = &common.out else {
        return Err(Failure::input("no folder for the joined study is given; add --out DIR"));
    };
    let out = ResultFolder::hold(out)?;
    publish(&join(folders, &out)?, &out, &theme, style.figures, common)
}
