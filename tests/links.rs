//! Links and images of README, root documents, results, the book and the pages of crates lead somewhere, and no page of
//! the book is missing from its table of contents.

use std::fs;
use std::path::{Path, PathBuf};

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

/// Pages below a folder; of the root only its own.
fn pages(folder: &Path, deeper: bool) -> Vec<PathBuf> {
    let entries = fs::read_dir(folder).unwrap_or_else(|error| panic!("{}: {error}", folder.display()));
    let mut found: Vec<PathBuf> = Vec::new();
    for path in entries.flatten().map(|entry| entry.path()) {
        match path.is_dir() {
            true if deeper => found.extend(pages(&path, true)),
            false if path.extension().is_some_and(|end| end == "md") => found.push(path),
            _ => {}
        }
    }
    found.sort();
    found
}

/// Lines of a page that are not inside a block of code, with their numbers.
fn prose(text: &str) -> impl Iterator<Item = (usize, &str)> {
    let mut inside = false;
    (1..).zip(text.lines()).filter(move |(_, line)| {
        let is_fence = line.trim_start().starts_with("```");
        inside ^= is_fence;
        !is_fence && !inside
    })
}

/// What links, images and includes of a line lead to.
fn targets(line: &str) -> impl Iterator<Item = &str> {
    let links = line.split("](").skip(1).filter_map(|rest| rest.split([')', ' ']).next());
    let included = line.split("{{#include ").skip(1).filter_map(|rest| rest.split('}').next());
    links.chain(included).filter(|target| !target.contains("://") && !target.is_empty())
}

/// The anchor of a heading, as pages of repositories and books have it.
fn anchor(heading: &str) -> String {
    let is_kept = |letter: &char| letter.is_alphanumeric() || " -_".contains(*letter);
    heading.trim_start_matches('#').trim().to_lowercase().chars().filter(is_kept).collect::<String>().replace(' ', "-")
}

/// Links of a page that lead nowhere.
fn faults(page: &Path) -> Vec<String> {
    let read = |path: &Path| fs::read_to_string(path).unwrap_or_default();
    let leads = |target: &str| {
        let (file, place) = target.split_once('#').map_or((target, None), |(file, place)| (file, Some(place)));
        let path = if file.is_empty() { page.to_owned() } else { page.parent().expect("a folder").join(file) };
        let has = |place: &str| prose(&read(&path)).any(|(_, line)| line.starts_with('#') && anchor(line) == place);
        path.exists() && place.is_none_or(has)
    };
    let text = read(page);
    let wrong = prose(&text).flat_map(|(number, line)| targets(line).map(move |target| (number, target)));
    let wrong = wrong.filter(|(_, target)| !leads(target));
    wrong.map(|(number, target)| format!("{}:{number}: {target}", page.display())).collect()
}

#[test]
fn links_lead_somewhere() {
    let folders = ["docs", "crates", "deploy", "examples", "tests"].map(|folder| root().join(folder));
    let below = folders.iter().filter(|folder| folder.is_dir()).flat_map(|folder| pages(folder, true));
    let alone = [root(), root().join("results")].into_iter().flat_map(|folder| pages(&folder, false));
    // Links of a template are those of the page that it becomes.
    let is_page = |page: &PathBuf| !page.iter().any(|part| part == "templates");
    let wrong: Vec<String> = alone.chain(below).filter(is_page).flat_map(|page| faults(&page)).collect();
    assert!(wrong.is_empty(), "links that lead nowhere:\n{}", wrong.join("\n"));
}

#[test]
fn a_link_that_leads_nowhere_is_found() {
    let folder = tempfile::tempdir().expect("a folder");
    let page = folder.path().join("a.md");
    let text =
        "# One & two\n[here](#one--two) [away](https://x.y/z) ![none](b.png) [too](a.md#three)\n```\n[no](c)\n```\n";
    fs::write(&page, text).expect("written");
    let wrong = faults(&page);
    assert!(wrong.len() == 2 && wrong[0].ends_with("a.md:2: b.png") && wrong[1].ends_with("a.md#three"), "{wrong:?}");
}

#[test]
fn every_page_of_the_book_is_in_its_contents() {
    let source = root().join("docs/src");
    let contents = fs::read_to_string(source.join("SUMMARY.md")).expect("a table of contents");
    let listed: Vec<PathBuf> = contents.lines().flat_map(targets).map(|target| source.join(target)).collect();
    let missing: Vec<PathBuf> = pages(&source, true)
        .into_iter()
        .filter(|page| !page.ends_with("SUMMARY.md") && !listed.contains(page))
        .collect();
    assert!(missing.is_empty(), "pages that the table of contents has not: {missing:?}");
}
