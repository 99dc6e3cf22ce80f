//! `study SCENARIO.toml`: run what is missing, then publish what is stored.

use std::path::Path;

use campaign::collect::collect;
use campaign::folder::ResultFolder;
use campaign::task::{Shard, default_folder};
use scenario::Scenario;
use scenario::failure::Failure;
use serde_json::json;

use crate::options::{Common, Format, RunRequest};
use crate::screen;
use crate::terminal::Terminal;
use crate::views::document;
use crate::views::publish::publish;

/// Runs a scenario, or a shard of it, and publishes it as `study report` would.
pub fn run(path: &Path, request: &RunRequest, common: &Common) -> Result<(), Failure> {
    let scenario = Scenario::read(path, common.seed)?;
    let shard = request.shard.unwrap_or(Shard::WHOLE);
    let theme = request.style.style.theme()?;
    let folder = ResultFolder::hold(&common.out.clone().unwrap_or_else(|| default_folder(&scenario.name, shard)))?;
    let stored = collect(&scenario, shard, &folder, request.restart, &Terminal::new(common.quiet))?;
    if shard == Shard::WHOLE {
        return publish(&stored, &folder, (&theme, request.style.figures), common);
    }
    match common.format {
        _ if common.quiet => Ok(()),
        Format::Json => {
            let folder = folder.path().display().to_string();
            document::say("shard/1", json!({ "folder": folder, "manifest": stored.manifest }))
        }
        _ => screen::say(&format!(
            "shard {shard} of {} is in {}; `study merge` joins all {}",
            scenario.name,
            folder.path().display(),
            shard.of
        )),
    }
}
