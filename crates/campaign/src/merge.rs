//! The shards of one study joined to what one run would have given, byte for byte.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use scenario::Scenario;
use scenario::failure::Failure;

use crate::collect::is_same;
use crate::design::Design;
use crate::files::{MANIFEST, ROWS};
use crate::folder::ResultFolder;
use crate::manifest::Manifest;
use crate::rows::{RowLayout, RowWriter};
use crate::sources;
use crate::store::{self, StoredStudy};
use crate::task::Shard;
use crate::timings::Timings;
use crate::unfinished;

/// Missing shards that a message names.
const SHOWN: usize = 10;

/// Joins the shards in these folders to a finished study, byte for byte what one run would have given.
///
/// Fails when they are not all shards of one study, and when `out` holds another one.
pub fn join(folders: &[PathBuf], out: &ResultFolder) -> Result<StoredStudy, Failure> {
    let (folders, manifest) = shards(folders)?;
    if let Some(stored) = store::manifest_of_rows(out.path())? {
        is_same(&stored, &manifest, out.path(), "give another folder with --out")?;
    }
    if unfinished::is_in(out.path())? {
        return Err(Failure::about(out.path(), "a study in it is not finished; give another folder with --out"));
    }
    let mut design = StoredStudy::read(folders[0])?.design;
    design.cells.iter_mut().for_each(|cell| cell.trials = 0..0);
    let layout = RowLayout::of(&design);
    let mut writer = RowWriter::create(out, ROWS, &layout)?;
    if manifest.sources.is_some() {
        sources::keep(&Scenario::read(&folders[0].join(MANIFEST), None)?, out)?;
    }
    let mut timings = Timings::default();
    let mut showcases = Vec::new();
    // One shard after the other: thousands of designs of thousands of cells do not fit into memory.
    for folder in folders {
        let stored = StoredStudy::read(folder)?;
        append(&mut design, &stored.design)
            .map_err(|problem| Failure::about(folder, format!("{problem}; run this shard again")))?;
        stored.rows(|row| writer.push([row]))?;
        timings.join(&stored.timings);
        showcases.extend(stored.showcases);
    }
    if let Some(replicates) = manifest.replicates()
        && let Some(cell) = design.cells.iter().position(|cell| cell.trials != (0..replicates))
    {
        let found = &design.cells[cell].trials;
        return Err(Failure::about(
            out.path(),
            format!(
                "of cell {cell} the shards hold {} of {replicates} trials; run the shards again",
                found.end - found.start
            ),
        ));
    }
    let (rows, sha256) = writer.finish()?;
    rows.put()?;
    store::finish(out, &manifest, sha256, design, showcases, &timings)
}

/// Adds what the next shard knows of the cells. Fails when its trials are not the next ones.
fn append(design: &mut Design, next: &Design) -> Result<(), String> {
    let cells = || design.cells.iter().zip(&next.cells);
    let is_same = (&design.axes, &design.methods, &design.draws) == (&next.axes, &next.methods, &next.draws)
        && design.cells.len() == next.cells.len()
        && cells().all(|(own, theirs)| (&own.labels, &own.values) == (&theirs.labels, &theirs.values));
    if !is_same {
        return Err("its design is not that of the other shards".to_owned());
    }
    for (index, (cell, theirs)) in design.cells.iter_mut().zip(&next.cells).enumerate() {
        cell.bound_percent2 = cell.bound_percent2.or(theirs.bound_percent2);
        if theirs.trials.is_empty() {
            continue;
        }
        if theirs.trials.start != cell.trials.end {
            return Err(format!(
                "its first trial of cell {index} is number {}, and the next one after the shards before it is number {}",
                theirs.trials.start, cell.trials.end
            ));
        }
        cell.trials.end = theirs.trials.end;
    }
    Ok(())
}

/// The folders of the shards in their order and the manifest of the whole, or what is wrong with them.
fn shards(folders: &[PathBuf]) -> Result<(Vec<&Path>, Manifest), Failure> {
    // Of thousands of shards only one manifest is kept: each holds the text of the scenario.
    let mut lowest: Option<(&Path, Manifest)> = None;
    let mut found: BTreeMap<u64, (&Path, f64)> = BTreeMap::new();
    for folder in folders {
        let Some(manifest) = store::manifest_of_rows(folder)? else {
            let problem = match unfinished::is_in(folder)? {
                true => "this shard is not finished; run it again with the same --shard and --out",
                false => "there is no finished shard in it; give folders written with --shard",
            };
            return Err(Failure::about(folder, problem));
        };
        let differences = lowest.as_ref().map_or(Vec::new(), |(_, known)| known.differences_of_study(&manifest));
        if let (Some((first, _)), [_, ..]) = (&lowest, differences.as_slice()) {
            return Err(Failure::input(format!(
                "{} and {} are not shards of one study (there: the first, here: the second):\n  {}\nmerge shards of the same \
                 scenario, seed and program",
                first.display(),
                folder.display(),
                differences.join("\n  ")
            )));
        }
        let shard = manifest.shard;
        if let Some((twice, _)) = found.insert(shard.number, (folder, manifest.machine.wall_time_s)) {
            let (twice, folder) = (twice.display(), folder.display());
            return Err(Failure::input(format!("{twice} and {folder} are both shard {shard}; give each one once")));
        }
        if lowest.as_ref().is_none_or(|(_, known)| shard.number < known.shard.number) {
            lowest = Some((folder, manifest));
        }
    }
    let (_, manifest) =
        lowest.ok_or_else(|| Failure::input("no shards are given; name the folders written with --shard"))?;
    let of = manifest.shard.of;
    let missing: Vec<String> =
        (1..=of).filter(|number| !found.contains_key(number)).map(|number| Shard { number, of }.to_string()).collect();
    if missing.is_empty() {
        let (folders, wall_times): (Vec<&Path>, Vec<f64>) = found.into_values().unzip();
        return Ok((folders, manifest.of_whole(wall_times.iter().sum())));
    }
    let shown = missing[..missing.len().min(SHOWN)].join(", ");
    let more = if missing.len() > SHOWN { ", …" } else { "" };
    Err(Failure::input(format!("{} of {of} shards are missing: {shown}{more}; run them first", missing.len())))
}
