//! Scripts that a study starts, kept beside its manifest so that the manifest runs the study again where it lies.
//! What a script loads by itself is not known here and not kept.

use std::fs;
use std::io;
use std::path::{Component, Path};

use scenario::failure::{Failure, OnPath};
use scenario::{Scenario, Script};

use crate::disk;
use crate::files::SOURCES;
use crate::folder::ResultFolder;

/// Largest script that is kept, bytes.
const LARGEST: u64 = 1 << 20;

/// What stands for a folder above that of the scenario.
const UP: &str = "up";

fn kept(scenario: &Scenario) -> impl Iterator<Item = &Script> {
    scenario.scripts.iter().filter(|script| script.path.metadata().is_ok_and(|about| about.len() <= LARGEST))
}

/// The folder that stands for that of the scenario, with `/` between its parts: deep enough that no script comes to lie
/// outside of [`SOURCES`]. `None` where no script is kept.
pub fn place(scenario: &Scenario) -> Option<String> {
    let depth = |script: &Script| {
        let (mut depth, mut above) = (0_i32, 0);
        for part in Path::new(&script.word).components() {
            depth += match part {
                Component::ParentDir => -1,
                Component::Normal(_) => 1,
                _ => 0,
            };
            above = above.max(-depth);
        }
        above
    };
    let above = kept(scenario).map(depth).max()?;
    let parts: Vec<&str> = std::iter::once(SOURCES).chain((0..above).map(|_| UP)).collect();
    Some(parts.join("/"))
}

/// Writes the scripts of a scenario into the folder of its study.
///
/// Fails when one cannot be read or written.
pub fn keep(scenario: &Scenario, folder: &ResultFolder) -> Result<(), Failure> {
    let Some(place) = place(scenario) else { return Ok(()) };
    for Script { word, path } in kept(scenario) {
        let mut parts: Vec<String> = place.split('/').map(str::to_owned).collect();
        for part in Path::new(word).components() {
            match part {
                Component::ParentDir => drop(parts.pop()),
                Component::Normal(name) => parts.push(name.to_string_lossy().into_owned()),
                _ => {}
            }
        }
        let Some((name, above)) = parts.split_last() else { continue };
        let text = disk::read(path, LARGEST).and_then(|text| text.ok_or_else(|| io::ErrorKind::NotFound.into()));
        let text = text.on("read", path)?;
        let (first, rest) = above.split_first().expect("they lie below the folder of sources");
        let own = rest.iter().try_fold(folder.inside(first)?, |folder, name| folder.inside(name))?;
        own.write(name, text)?;
        let copy = own.path().join(name);
        // A script may be started by itself.
        path.metadata().and_then(|about| fs::set_permissions(&copy, about.permissions())).on("write", &copy)?;
    }
    Ok(())
}
