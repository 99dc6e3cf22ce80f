//! `study merge DIR... --out DIR`: the shards of one study joined to what one run would have given, byte for byte.

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

/// A finished shard.
struct Part<'a> {
    folder: &'a Path,
    manifest: Manifest,
}

/// Joins shards and publishes the whole.
pub fn merge(folders: &[PathBuf], style: &Style, common: &Common) -> Result<(), Failure> {
    let Some(out) = &common.out else {
        return Err(Failure::input("no folder for the joined study is given; add --out DIR"));
    };
    let parts = parts(folders)?;
    let manifest = Manifest::joined(parts.iter().map(|part| &part.manifest));
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
    let designs: Vec<Design> = parts.iter().map(|part| store::read_design(part.folder)).collect::<Result<_, _>>()?;
    let mut design = designs[0].clone();
    for other in &designs[1..] {
        for (cell, theirs) in design.cells.iter_mut().zip(&other.cells) {
            cell.bound_percent2 = cell.bound_percent2.or(theirs.bound_percent2);
        }
    }
    let layout = Layout::of(&design);
    let mut writer = Writer::create(&out.join(store::ROWS), &layout)?;
    let mut last: Option<(Task, usize)> = None;
    let mut timings = Timings::new(design.methods.len());
    let mut showcases = Vec::new();
    for part in &parts {
        Reader::open(&part.folder.join(store::ROWS), &layout)?.for_each(|row| {
            let place = (Task { cell: row.cell as usize, replicate: row.replicate }, row.method);
            if last.is_some_and(|last| place <= last) {
                return Err(Failure::input(format!(
                    "{}: its rows do not come after those of the shard before it; run this shard again",
                    part.folder.display()
                )));
            }
            last = Some(place);
            writer.push([row])
        })?;
        timings.join(&Timings::read(&part.folder.join(store::TIMINGS), &design)?);
        showcases.extend(store::read_showcases(part.folder)?);
    }
    writer.finish()?;
    store::write_design(out, &design)?;
    store::write_showcases(out, &showcases)?;
    timings.write(&out.join(store::TIMINGS), &design)?;
    manifest.write(&out.join(store::MANIFEST))?;
    publish::report(out, style, common)
}

/// The shards in their order, or what is wrong with them.
fn parts(folders: &[PathBuf]) -> Result<Vec<Part<'_>>, Failure> {
    let mut parts: Vec<Part> = Vec::with_capacity(folders.len());
    for folder in folders {
        let Some(manifest) = store::manifest_of_rows(folder)? else {
            let problem = match unfinished::is_in(folder) {
                true => "this shard is not finished; run it again with the same --shard and --out",
                false => "there is no finished shard in it; give folders written with --shard",
            };
            return Err(Failure::input(format!("{}: {problem}", folder.display())));
        };
        if let Some(first) = parts.first() {
            let differences = first.manifest.differences_of_study(&manifest);
            if !differences.is_empty() {
                return Err(Failure::input(format!(
                    "{} and {} are not shards of one study (there: the first, here: the second):\n  {}\nmerge shards of the \
                     same scenario, seed and program",
                    first.folder.display(),
                    folder.display(),
                    differences.join("\n  ")
                )));
            }
        }
        if let Some(twice) = parts.iter().find(|part| part.manifest.shard.number == manifest.shard.number) {
            return Err(Failure::input(format!(
                "{} and {} are both shard {}; give each one once",
                twice.folder.display(),
                folder.display(),
                manifest.shard
            )));
        }
        parts.push(Part { folder, manifest });
    }
    parts.sort_by_key(|part| part.manifest.shard.number);
    let of = parts.first().map_or(0, |part| part.manifest.shard.of);
    let missing: Vec<String> = (1..=of)
        .filter(|number| parts.iter().all(|part| part.manifest.shard.number != *number))
        .map(|number| Shard { number, of }.to_string())
        .collect();
    if missing.is_empty() {
        return Ok(parts);
    }
    let shown = missing[..missing.len().min(SHOWN)].join(", ");
    let more = if missing.len() > SHOWN { ", …" } else { "" };
    Err(Failure::input(format!("{} of {of} shards are missing: {shown}{more}; run them first", missing.len())))
}
