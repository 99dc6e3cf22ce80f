//! Page over several finished studies, each with its question, its finding and its key figure. It is made from their
//! manifests and figures, without their rows.

use std::path::{Path, PathBuf};

use askama::Template;
use campaign::disk;
use campaign::failure::{Failure, OnPath};
use campaign::files;
use campaign::folder::ResultFolder;
use campaign::manifest::Manifest;
use campaign::scenario::name;
use report::{Page, PlacedFigures};

use super::page_files::KEY_FIGURE_STEM;

/// Name of the page.
const PAGE: &str = "README.md";

/// First line of the page; a file with another first line was not made by this program.
const MARK: &str = "<!-- Made by `study report` of several studies, which writes it anew. -->\n";

/// Maximum size of an existing page that is read, bytes.
const MAX_PAGE_BYTES: u64 = 1 << 26;

/// Section of the page on a study.
struct Section {
    /// Name of the folder.
    name: String,
    /// Path of the folder, relative to the page.
    folder: String,
    /// Question of the study.
    question: String,
    /// Finding of the study.
    finding: String,
    /// File of the key figure; `None` if the scenario names none.
    figure: Option<String>,
}

#[derive(Template)]
#[template(path = "studies.md", escape = "none")]
struct StudiesPage {
    sections: Vec<Section>,
}

/// Checks that all folders are those of studies, and that the page replaces no file of another program.
pub fn check_folders(studies: &[PathBuf], place: &Path) -> Result<(), Failure> {
    if let Some(folder) = studies.iter().find(|folder| !folder.join(files::MANIFEST_FILE).is_file()) {
        let problem = format!("it holds no {}, so it is not the folder of a study", files::MANIFEST_FILE);
        return Err(Failure::in_file(folder, format!("{problem}; give folders of studies, or this folder alone")));
    }
    let path = place.join(PAGE);
    if disk::read(&path, MAX_PAGE_BYTES).on("read", &path)?.is_some_and(|text| !text.starts_with(MARK.as_bytes())) {
        let problem = "this page was not made by `study report`";
        return Err(Failure::in_file(&path, format!("{problem}; move it away, or give another folder with --out")));
    }
    Ok(())
}

/// Writes the page over studies into a folder; returns its path.
///
/// Fails if [`check_folders`] does, if a figure named by a scenario is missing, or if the page cannot be written.
pub fn write(studies: &[PathBuf], target: &ResultFolder) -> Result<PathBuf, Failure> {
    check_folders(studies, target.path())?;
    let place = target.path().canonicalize().on("find", target.path())?;
    let sections = studies.iter().map(|folder| section(folder, &place)).collect::<Result<Vec<_>, _>>()?;
    let page = Page::new(StudiesPage { sections }.render(), PlacedFigures::<()>::default());
    target.write(PAGE, MARK.to_owned() + &page.to_markdown())?;
    Ok(target.path().join(PAGE))
}

fn section(folder: &Path, place: &Path) -> Result<Section, Failure> {
    let path = folder.join(files::MANIFEST_FILE);
    let missing = || Failure::in_file(&path, "there is no such file any more");
    let manifest = Manifest::read(&path)?.ok_or_else(missing)?;
    let prose = manifest.prose();
    let unfit = |stem: &str, unfit| {
        Failure::in_file(&path, format!("`output.figure` is {}; {unfit}", name::quoted_beginning(stem)))
    };
    let figure = match &prose.output.figure {
        Some(stem) => {
            Some(name::check_file_name(stem).map_err(|error| unfit(stem, error)).and_then(|()| figure(folder, stem))?)
        }
        None => None,
    };
    let whole = folder.canonicalize().on("find", folder)?;
    Ok(Section {
        // With --out the folder may have a name other than that of the scenario.
        name: whole.file_name().map_or(manifest.name, |name| name.to_string_lossy().into_owned()),
        folder: way(place, &whole),
        question: prose.question.trim().to_owned(),
        finding: prose.finding.trim().to_owned(),
        figure,
    })
}

/// Relative path from one folder to another, as in a link.
fn way(from: &Path, to: &Path) -> String {
    let shared = from.components().zip(to.components()).take_while(|(a, b)| a == b).count();
    let up = from.components().skip(shared).map(|_| "..".to_owned());
    let down = to.components().skip(shared).map(|part| part.as_os_str().to_string_lossy().into_owned());
    let parts: Vec<String> = up.chain(down).collect();
    if parts.is_empty() { ".".to_owned() } else { parts.join("/") }
}

/// File of the figure that a scenario names. Fails if it is missing.
fn figure(folder: &Path, stem: &str) -> Result<String, Failure> {
    let files = [KEY_FIGURE_STEM, stem].map(|stem| format!("{stem}.png"));
    if let Some(file) = files.into_iter().find(|file| folder.join(file).is_file()) {
        return Ok(file);
    }
    let file = format!("{stem}.png");
    let names = disk::entry_names(folder).on("list", folder)?;
    let stems: Vec<&str> = names.iter().filter_map(|name| name.strip_suffix(".png")).collect();
    let stems = stems.join(", ");
    Err(Failure::in_file(
        folder,
        format!("the scenario has `output.figure = {stem:?}`, and the folder holds no {file}; figures there: {stems}"),
    ))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_link_leads_from_the_page_to_the_study() {
        for (from, to, link) in [("/a", "/a/b", "b"), ("/a/b", "/a/c/d", "../c/d"), ("/a", "/a", ".")] {
            assert_eq!(way(Path::new(from), Path::new(to)), link);
        }
    }
}
