//! `study merge DIR... --out DIR`: the shards of one study joined and published.

use std::path::PathBuf;

use campaign::folder::ResultFolder;
use campaign::merge::join;
use scenario::failure::Failure;

use crate::options::{Common, StudyStyle};
use crate::views::publish::publish;

/// Joins shards and publishes the whole.
pub fn run(folders: &[PathBuf], style: &StudyStyle, common: &Common) -> Result<(), Failure> {
    let theme = style.style.theme()?;
    let Some(out) = &common.out else {
        return Err(Failure::input("no folder for the joined study is given; add --out DIR"));
    };
    let out = ResultFolder::hold(out)?;
    publish(&join(folders, &out)?, &out, (&theme, style.figures), common)
}
