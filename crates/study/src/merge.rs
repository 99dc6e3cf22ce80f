//! `study merge DIR... --out DIR`: the shards of one study joined to what one run would have given, byte for byte.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use crate::cli::{Common, Style};
use crate::collect::is_same;
use crate::failure::{Failure, result_folder};
use crate::manifest::Manifest;
use crate::plan::{Shard, Task};
use crate::publish;
use crate::rows::{Layout, Reader, Writer};
use crate::store::{self, Design};
use crate::timings::Timings;
use crate::unfinished;

/// Missing shards that a message names.
const SHOWN: usize = 10;

/// All shards of one study.
struct Shards<'a> {
    /// Their folders, in their order.
    folders: Vec<&'a Path>,
    /// The manifest of the whole.
    manifest: Manifest,
}

/// Joins shards and publishes the whole.
pub fn merge(folders: &[PathBuf], style: &Style, common: &Common) -> Result<(), Failure> {
    let Some(out) = &common.out else {
        return Err(Failure::input("no folder for the joined study is given; add --out DIR"));
    };
    let Shards { folders, manifest } = shards(folders)?;
    result_folder(out)?;
    if let Some(stored) = store::manifest_of_rows(out)? {
        is_same(&stored, &manifest, out)?;
    }
    if unfinished::is_in(out) {
        return Err(Failure::input(format!(
            "{}: a study in it is not finished; give another folder with --out",
            out.display()
        )));
    }
    let design = design(&folders)?;
    let layout = Layout::of(&design);
    let mut writer = Writer::create(&out.join(store::ROWS), &layout)?;
    let mut last: Option<(Task, usize)> = None;
    let mut timings = Timings::new(design.methods.len());
    let mut showcases = Vec::new();
    for folder in folders {
        Reader::open(&folder.join(store::ROWS), &layout)?.for_each(|row| {
            let place = (Task { cell: row.cell as usize, replicate: row.replicate }, row.method);
            if last.is_some_and(|last| place <= last) {
                return Err(Failure::input(format!(
                    "{}: its rows do not come after those of the shard before it; run this shard again",
                    folder.display()
                )));
            }
            last = Some(place);
            writer.push([row])
        })?;
        timings.join(&Timings::read(&folder.join(store::TIMINGS), &design)?);
        showcases.extend(store::read_showcases(folder)?);
    }
    writer.finish()?;
    store::write_design(out, &design)?;
    store::write_showcases(out, &showcases)?;
    timings.write(&out.join(store::TIMINGS), &design)?;
    manifest.write(&out.join(store::MANIFEST))?;
    publish::report(out, style, common)
}

/// The design with all that the shards know of its cells. One shard after the other: thousands of designs of thousands of
/// cells do not fit into memory.
fn design(folders: &[&Path]) -> Result<Design, Failure> {
    let (first, others) = folders.split_first().expect("a study has at least one shard");
    let mut design = store::read_design(first)?;
    for folder in others {
        let other = store::read_design(folder)?;
        for (cell, theirs) in design.cells.iter_mut().zip(&other.cells) {
            cell.bound_percent2 = cell.bound_percent2.or(theirs.bound_percent2);
        }
    }
    Ok(design)
}

/// The shards in their order, or what is wrong with them.
fn shards(folders: &[PathBuf]) -> Result<Shards<'_>, Failure> {
    // Of thousands of shards only one manifest is kept: each holds the text of the scenario.
    let mut lowest: Option<(&Path, Manifest)> = None;
    let mut found: BTreeMap<u64, (&Path, f64)> = BTreeMap::new();
    for folder in folders {
        let Some(manifest) = store::manifest_of_rows(folder)? else {
            let problem = match unfinished::is_in(folder) {
                true => "this shard is not finished; run it again with the same --shard and --out",
                false => "there is no finished shard in it; give folders written with --shard",
            };
            return Err(Failure::input(format!("{}: {problem}", folder.display())));
        };
        if let Some((first, known)) = &lowest {
            let differences = known.differences_of_study(&manifest);
            if !differences.is_empty() {
                return Err(Failure::input(format!(
                    "{} and {} are not shards of one study (there: the first, here: the second):\n  {}\nmerge shards of the \
                     same scenario, seed and program",
                    first.display(),
                    folder.display(),
                    differences.join("\n  ")
                )));
            }
        }
        if let Some((twice, _)) = found.insert(manifest.shard.number, (folder, manifest.machine.wall_time_s)) {
            return Err(Failure::input(format!(
                "{} and {} are both shard {}; give each one once",
                twice.display(),
                folder.display(),
                manifest.shard
            )));
        }
        if lowest.as_ref().is_none_or(|(_, known)| manifest.shard.number < known.shard.number) {
            lowest = Some((folder, manifest));
        }
    }
    let Some((_, manifest)) = lowest else {
        return Err(Failure::input("no shards are given; name the folders written with --shard"));
    };
    let of = manifest.shard.of;
    let missing: Vec<String> =
        (1..=of).filter(|number| !found.contains_key(number)).map(|number| Shard { number, of }.to_string()).collect();
    if missing.is_empty() {
        let wall_time_s = found.values().map(|(_, wall_time_s)| wall_time_s).sum();
        let folders = found.into_values().map(|(folder, _)| folder).collect();
        return Ok(Shards { folders, manifest: manifest.of_whole(wall_time_s) });
    }
    let shown = missing[..missing.len().min(SHOWN)].join(", ");
    let more = if missing.len() > SHOWN { ", …" } else { "" };
    Err(Failure::input(format!("{} of {of} shards are missing: {shown}{more}; run them first", missing.len())))
}
