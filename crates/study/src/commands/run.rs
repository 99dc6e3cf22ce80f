//! `study SCENARIO.toml`: run what is missing, then publish what is stored.

use std::path::Path;

use campaign::collect::collect;
use campaign::files::MANIFEST;
use campaign::folder::ResultFolder;
use campaign::task::{Shard, default_folder};
use scenario::Scenario;
use scenario::failure::Failure;

use super::reply;
use crate::documents::answers::ShardAnswer;
use crate::documents::folder_for;
use crate::options::{Common, RunRequest};
use crate::terminal::Terminal;
use crate::views::publish::publish;

/// Runs a scenario, or a shard of it, and publishes it as `study report` would.
pub fn run(path: &Path, request: &RunRequest, common: &Common) -> Result<(), Failure> {
    let scenario = Scenario::read(path, common.seed)?;
    let shard = request.shard.unwrap_or(Shard::WHOLE);
    let theme = request.style.style.theme()?;
    let place = common.out.clone().unwrap_or_else(|| default_folder(&scenario.name, shard));
    let folder = ResultFolder::hold(&folder_for(MANIFEST, &place)?)?;
    let stored = collect(&scenario, shard, &folder, request.restart, &Terminal::new("trials", common.quiet))?;
    if shard == Shard::WHOLE {
        return publish(&stored, &folder, &theme, request.style.figures, common);
    }
    let place = folder.path().display().to_string();
    let line = format!(
        "shard {shard} of {} is in {place}; `study merge DIR… --out DIR` joins all {}",
        scenario.name, shard.of
    );
    reply(common, &ShardAnswer { folder: place, manifest: &stored.manifest }, &line)
}
