//! The size of the house: it does not grow, and what was cleared away does not come back.

use std::collections::{BTreeMap, BTreeSet};

use crate::architecture::{ending, files, read, root};

/// Longest function, lines.
const LONGEST_FUNCTION: usize = 60;

/// What the house has reached. Whoever raises a number says why in the same commit; whoever can lowers it.
const REACHED: Size = Size {
    code: 71_100,
    tests: 32_010,
    long_functions: 0,
    shared_types: 7,
    packages: 298,
    tuple_parameters: 0,
    text_lists: 0,
    leaks: 3,
    looked_up: 0,
    largest_crate: 11_950,
};

/// Endings of sources in Rust, Python and JavaScript.
const LANGUAGES: [&str; 3] = ["rs", "py", "js"];

/// Folders that hold sources.
const FOLDERS: [&str; 5] = ["benches", "crates", "docs", "examples", "tests"];

/// Programs of the tests package that make pages: code, wherever they lie.
const PRODUCT: [&str; 1] = ["bin"];

/// The size of the house: lines of code and tests, and what is counted outside of tests.
#[derive(Debug, Default, PartialEq)]
struct Size {
    /// Lines of code that are neither blank, comment nor test.
    code: usize,
    /// Lines of tests.
    tests: usize,
    /// Functions longer than [`LONGEST_FUNCTION`].
    long_functions: usize,
    /// Names of types that stand in more than one package.
    shared_types: usize,
    /// Packages in the lock file.
    packages: usize,
    /// Functions with a tuple for a parameter.
    tuple_parameters: usize,
    /// Lists of texts that a function adds to: `&mut Vec<String>`.
    text_lists: usize,
    /// Texts that are never given back: `.leak()`.
    leaks: usize,
    /// Diagnostics that are looked up by a word in the code.
    looked_up: usize,
    /// Lines of code of the crate that has most.
    largest_crate: usize,
}

/// A function whose end is not seen yet.
struct OpenFunction {
    start: usize,
    depth: isize,
    /// What stands before its body.
    head: String,
}

/// Whether a file below the root holds tests alone.
fn is_of_tests(file: &str) -> bool {
    let product = file.strip_prefix("tests/src/").and_then(|inside| inside.split_once('/'));
    let is_test = file.starts_with("tests/")
        || file.contains("/tests/")
        || ["tests.rs", "testing.rs"].iter().any(|end| file.ends_with(end));
    is_test && !product.is_some_and(|(folder, _)| PRODUCT.contains(&folder))
}

/// The package of a file.
fn package(file: &str) -> &str {
    let depth = if file.starts_with("crates/") { 2 } else { 1 };
    file.match_indices('/').nth(depth - 1).map_or(file, |(end, _)| &file[..end])
}

/// The name of the type that a line declares.
fn declared_type(line: &str) -> Option<&str> {
    let line = line.strip_prefix("pub(").and_then(|rest| rest.split_once(") ")).map_or(line, |(_, rest)| rest);
    let line = line.strip_prefix("pub ").unwrap_or(line);
    let rest = ["struct ", "enum ", "trait ", "type "].iter().find_map(|word| line.strip_prefix(word))?;
    rest.split(|c: char| !c.is_alphanumeric() && c != '_').next()
}

/// Whether a line begins a function.
fn begins_function(line: &str) -> bool {
    let before = line.split_once("fn ").map(|(before, _)| before.trim());
    before.is_some_and(|before| before.split(' ').all(|word| ["", "const"].contains(&word) || word.starts_with("pub")))
}

impl Size {
    /// Adds a file of a package; `names` gathers its types.
    fn add(&mut self, text: &str, language: &str, mut is_test: bool, names: &mut BTreeSet<String>) {
        let is_rust = language == "rs";
        let comment = if language == "py" { "#" } else { "//" };
        let mut function: Option<OpenFunction> = None;
        for (number, line) in text.lines().enumerate() {
            let content = line.trim();
            is_test |= is_rust && content.starts_with("#[cfg(test)]");
            if content.is_empty() || content.starts_with(comment) {
                continue;
            }
            *(if is_test { &mut self.tests } else { &mut self.code }) += 1;
            if is_test || !is_rust {
                continue;
            }
            names.extend(declared_type(content).map(str::to_owned));
            self.text_lists += content.matches("&mut Vec<String>").count();
            self.leaks += content.matches(".leak()").count();
            self.looked_up += content.matches(".diagnostic(\"").count();
            if function.is_none() && begins_function(line) {
                function = Some(OpenFunction { start: number, depth: 0, head: String::new() });
            }
            if let Some(open) = &mut function {
                if !open.head.contains('{') {
                    open.head += line;
                }
                open.depth += line.matches('{').count() as isize - line.matches('}').count() as isize;
                if open.depth == 0 && (line.contains('}') || line.trim_end().ends_with(';')) {
                    self.long_functions += usize::from(number - open.start + 1 > LONGEST_FUNCTION);
                    let parameters = open.head.split("->").next().unwrap_or_default();
                    self.tuple_parameters += usize::from(parameters.contains(": ("));
                    function = None;
                }
            }
        }
    }

    fn of_the_house() -> Self {
        let mut size = Self::default();
        let mut names: BTreeMap<String, BTreeSet<String>> = BTreeMap::new();
        let mut code: BTreeMap<String, usize> = BTreeMap::new();
        for path in FOLDERS.iter().flat_map(|folder| files(&root().join(folder), &LANGUAGES)) {
            let file = path.strip_prefix(root()).expect("it lies below the root").to_string_lossy().into_owned();
            let (package, before) = (package(&file), size.code);
            let names = names.entry(package.to_owned()).or_default();
            size.add(&read(&path), ending(&path), is_of_tests(&file), names);
            *code.entry(package.to_owned()).or_default() += size.code - before;
        }
        let crates = code.iter().filter(|(package, _)| package.starts_with("crates/"));
        size.largest_crate = crates.map(|(_, lines)| *lines).max().unwrap_or(0);
        let mut packages: BTreeMap<&String, usize> = BTreeMap::new();
        names.values().flatten().for_each(|name| *packages.entry(name).or_default() += 1);
        let usual = ["Settings", "Error", "Result"];
        size.shared_types =
            packages.iter().filter(|(name, count)| **count > 1 && !usual.contains(&name.as_str())).count();
        size.packages = read(&root().join("Cargo.lock")).matches("[[package]]").count();
        size
    }

    /// What is counted, in the order of its declaration.
    fn counts(&self) -> [usize; 10] {
        [
            self.code,
            self.tests,
            self.long_functions,
            self.shared_types,
            self.packages,
            self.tuple_parameters,
            self.text_lists,
            self.leaks,
            self.looked_up,
            self.largest_crate,
        ]
    }
}

#[test]
fn the_house_does_not_grow() {
    let size = Size::of_the_house();
    let is_within = size.counts().iter().zip(REACHED.counts()).all(|(count, reached)| *count <= reached);
    assert!(is_within, "{size:?} is more than {REACHED:?}: take away, or raise the number and say why");
}

#[test]
fn lines_are_counted_as_what_they_are() {
    let long = "    x();\n".repeat(LONGEST_FUNCTION);
    let text = format!("//! Text.\n\npub(crate) struct A;\npub fn f() {{\n{long}}}\n#[cfg(test)]\nmod tests {{}}\n");
    let (mut size, mut names) = (Size::default(), BTreeSet::new());
    size.add(&text, "rs", false, &mut names);
    assert_eq!(size, Size { code: LONGEST_FUNCTION + 3, tests: 2, long_functions: 1, ..Size::default() });
    assert_eq!(names, BTreeSet::from(["A".to_owned()]));
    let mut size = Size::default();
    size.add("# Text.\nx = 1  # one\n", "py", false, &mut BTreeSet::new());
    assert_eq!(size, Size { code: 1, ..Size::default() });
}

#[test]
fn what_is_to_go_is_seen() {
    let text = "fn f(\n    (a, b): (u8, u8),\n    c: &mut Vec<String>,\n) -> (u8, u8) {\n    d.leak();\n    \
                e.diagnostic(\"noise\")\n}\nfn g() -> (u8, u8) {\n    (1, 2)\n}\n";
    let mut size = Size::default();
    size.add(text, "rs", false, &mut BTreeSet::new());
    let seen = Size { tuple_parameters: 1, text_lists: 1, leaks: 1, looked_up: 1, ..Size::default() };
    assert_eq!(Size { code: 0, ..size }, seen);
}

#[test]
fn pages_are_code_wherever_they_lie() {
    assert!(
        ["tests/golden.rs", "tests/src/lib.rs", "crates/a/tests/b.py", "crates/a/src/b/tests.rs"].map(is_of_tests)
            == [true; 4]
    );
    assert!(["tests/src/bin/a.rs", "crates/a/src/b.rs", "benches/all.rs"].map(is_of_tests) == [false; 3]);
    assert_eq!(["crates/trace/src/a.rs", "tests/a/b.rs"].map(package), ["crates/trace", "tests"]);
}
