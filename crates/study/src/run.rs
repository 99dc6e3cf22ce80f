//! `study SCENARIO.toml`: run what is missing, then publish what is stored.

use std::path::{Path, PathBuf};

use crate::cli::{Common, RunRequest};
use crate::collect::collect;
use crate::failure::Failure;
use crate::folder::ResultFolder;
use crate::plan::Shard;
use crate::publish;
use crate::scenario::Scenario;
use crate::screen;
use crate::store::Stored;

/// Runs a scenario, or a shard of it, and publishes it as `study report` would.
pub fn run(path: &Path, request: &RunRequest, common: &Common) -> Result<(), Failure> {
    let scenario = Scenario::read(path, common.seed)?;
    let shard = request.shard.unwrap_or(Shard::WHOLE);
    let theme = request.style.theme()?;
    let folder = ResultFolder::hold(&common.out.clone().unwrap_or_else(|| default_folder(&scenario.name, shard)))?;
    collect(&scenario, shard, &folder, request.restart, common.quiet)?;
    if shard == Shard::WHOLE {
        return publish::publish(&Stored::held(&folder)?, &folder, &theme, common);
    }
    match common.quiet {
        true => Ok(()),
        false => screen::say(&format!(
            "shard {shard} of {} is in {}; `study merge` joins all {}",
            scenario.name,
            folder.path().display(),
            shard.of
        )),
    }
}

/// Where a scenario, or a shard of it, is stored unless another folder is named.
pub(crate) fn default_folder(name: &str, shard: Shard) -> PathBuf {
    let whole = Path::new("results").join(name);
    match shard {
        Shard::WHOLE => whole,
        Shard { number, of } => {
            whole.join("shards").join(format!("{number:0width$}-of-{of}", width = of.to_string().len()))
        }
    }
}
