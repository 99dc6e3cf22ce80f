//! The page of the constants that stand in the source of fits, traces and predictions: values and first sentences of
//! their comments. A change of a constant changes the page.

use std::fs;
use std::path::{Path, PathBuf};

/// Writes the page anew.
const COMMAND: &str = "cargo test -p kempf-tests --test all write_the_constants -- --ignored";

const PAGE: &str = "docs/src/reference/constants.md";

/// Folders of the source, with the heading of their constants.
const FOLDERS: [(&str, &str); 4] = [
    ("crates/trace/src", "Traces"),
    ("crates/identify/src/hull", "Hulls"),
    ("crates/identify/src/likelihood", "Maximum likelihood"),
    ("crates/predict/src", "Predictions"),
];

/// A number in the source.
#[derive(Debug, PartialEq)]
struct Constant {
    name: String,
    value: String,
    meaning: String,
}

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

/// Files of a folder and below, without tests.
fn sources(folder: &Path) -> Vec<PathBuf> {
    let entries = fs::read_dir(folder).unwrap_or_else(|error| panic!("{}: {error}", folder.display()));
    let mut files: Vec<PathBuf> = Vec::new();
    for path in entries.flatten().map(|entry| entry.path()) {
        let stem = path.file_stem().unwrap_or_default();
        match path.is_dir() {
            _ if stem == "tests" || stem == "testing" => {}
            true => files.extend(sources(&path)),
            false => files.push(path),
        }
    }
    files.sort();
    files
}

/// The first sentence of some lines of a comment, in one line.
fn first_sentence(lines: &[&str]) -> String {
    let text = lines.join(" ");
    let end = text.find(". ").map_or(text.len(), |end| end + 1);
    text[..end].replace('|', "\\|").replace(['[', ']'], "")
}

/// Documented numbers of a file, as far as its tests.
fn constants(text: &str) -> Vec<Constant> {
    let mut comment: Vec<&str> = Vec::new();
    let mut constants = Vec::new();
    for line in text.lines().take_while(|line| !line.starts_with("#[cfg(test)]")) {
        let line = line.trim();
        let number = || {
            let (name, typed) = line.split_once("const ")?.1.split_once(": ")?;
            let value = ["f64 = ", "usize = "].iter().find_map(|kind| typed.strip_prefix(kind))?;
            Some((name.to_owned(), value.strip_suffix(';')?.to_owned()))
        };
        match (line.strip_prefix("///"), number()) {
            (Some(words), _) => comment.push(words.trim()),
            (None, Some((name, value))) if !comment.is_empty() => {
                constants.push(Constant { name, value, meaning: first_sentence(&comment) });
            }
            // One comment may be that of several constants in a row.
            (None, _) if line.contains("const ") => {}
            (None, _) => comment.clear(),
        }
    }
    constants
}

/// The whole page.
fn page() -> String {
    let mut page = format!(
        "# Constants\n\nThis page is for readers of the source. It lists the numbers that were chosen and that no setting changes; the \
         columns *file* and *constant* say where each number is set. [Methodology](../../../METHODOLOGY.md) says where they are used, and \
         [Choices](choices.md) what other values change. Made by `{COMMAND}`.\n"
    );
    for (folder, heading) in FOLDERS {
        page += &format!("\n## {heading}\n\n| file | constant | value | what it is |\n|---|---|---:|---|\n");
        let folder = root().join(folder);
        for path in sources(&folder) {
            let file = path.strip_prefix(&folder).expect("below its folder").with_extension("").display().to_string();
            for Constant { name, value, meaning } in constants(&fs::read_to_string(&path).unwrap_or_default()) {
                page += &format!("| {} | {name} | {value} | {meaning} |\n", file.replace('\\', "/"));
            }
        }
    }
    page
}

#[test]
fn the_page_of_constants_is_what_the_source_says() {
    let kept = fs::read_to_string(root().join(PAGE)).unwrap_or_default();
    assert!(kept == page(), "{PAGE} is not what the source says; write it again: {COMMAND}");
}

#[test]
#[ignore = "writes the page"]
fn write_the_constants() {
    fs::write(root().join(PAGE), page()).expect("the folder is there");
}

#[test]
fn a_constant_is_read_with_its_comment() {
    let text = "/// Share of a | b. More.\npub const SHARE: f64 = 0.5;\n\nconst BARE: f64 = 1.0;\n/// Rows.\nconst ROWS: usize = 3;\n\
        #[cfg(test)]\n/// No.\nconst NO: f64 = 2.0;\n";
    let of = |name: &str, value: &str, meaning: &str| Constant {
        name: name.to_owned(),
        value: value.to_owned(),
        meaning: meaning.to_owned(),
    };
    assert_eq!(constants(text), [of("SHARE", "0.5", "Share of a \\| b."), of("ROWS", "3", "Rows.")]);
}
