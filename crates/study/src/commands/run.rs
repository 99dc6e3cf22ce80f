//! `study SCENARIO.toml`: run the missing trials, then publish the stored rows.

use std::path::Path;

use campaign::collect::{collect, collect_shard};
use campaign::failure::Failure;
use campaign::files::MANIFEST_FILE;
use campaign::folder::ResultFolder;
use campaign::scenario::Scenario;
use campaign::shard::default_result_folder;

use super::reply;
use crate::documents::answers::ShardAnswer;
use crate::documents::folder_for;
use crate::options::{CommonOptions, RunRequest};
use crate::screen;
use crate::terminal::Terminal;
use crate::views::publish::write_results;

/// Runs a scenario and publishes it as `study report` does; a single shard is run and stored, but not published.
pub fn run(path: &Path, request: &RunRequest, common: &CommonOptions) -> Result<(), Failure> {
    let scenario = Scenario::read(path, common.seed)?;
    if !scenario.unknown_output.is_empty() && !common.quiet {
        let keys = scenario.unknown_output.join(", ");
        screen::print_to_stderr(&format!(
            "note: {keys} under [output] is of another version and left out; it decides no row"
        ));
    }
    let theme = request.style.style.theme()?;
    let place = common.out.clone().unwrap_or_else(|| default_result_folder(&scenario.name));
    let folder = ResultFolder::make(&folder_for(MANIFEST_FILE, &place)?)?;
    let terminal = Terminal::new("trials", common.quiet);
    let Some(shard) = request.shard else {
        let stored = collect(&scenario, &folder, request.restart, &terminal)?;
        return write_results(&stored, &folder, &theme, request.style.figures, common);
    };
    let manifest = collect_shard(&scenario, shard, &folder, request.restart, &terminal)?;
    let place = folder.path().display().to_string();
    let line = format!(
        "shard {shard} of {} is in {place}; copy all {} shards into one folder and run `study report` on it",
        scenario.name, shard.count
    );
    reply(common, &ShardAnswer { folder: place, manifest: &manifest }, &line)
}
