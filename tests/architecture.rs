//! The house: arrows between crates and between the files of a crate point down, no file is too long to read, no line
//! too wide.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

/// The crates from the ground up: each may use those before it.
const FLOORS: [&str; 13] = [
    "estimation",
    "ship",
    "document",
    "trial",
    "simulate",
    "predict",
    "identify",
    "trace",
    "report",
    "campaign",
    "kempf",
    "study",
    "python",
];

/// Maximum file, lines, unless its first line says why.
const LONGEST_FILE: usize = 450;

/// Words in the first line of a longer file.
const EXCUSE: &str = "Longer than most:";

/// Widest line, characters, as in `rustfmt.toml`.
const WIDEST_LINE: usize = 120;

/// The packages that users ask for by name, each with the crate whose work it does and the files that show it.
const ASKED_FOR: [(&str, &str, &[&str]); 6] = [
    ("nalgebra", "crates/identify", &["src/profile.rs"]),
    ("rand", "crates/simulate", &["src/stream.rs"]),
    ("rand_distr", "crates/simulate", &["src/stream.rs"]),
    ("rayon", "crates/campaign", &["src/collect.rs"]),
    ("criterion", "benches", &["all.rs"]),
    ("plotters", "crates/report", &["src/sheet.rs", "src/chart.rs", "src/backend.rs"]),
];

/// What draws a kind of figure.
const KINDS: [&str; 4] = ["layers", "row_layers", "cells", "zigzag_trial"];

/// What a reader of the README types first.
const COMMANDS: [(&str, &str); 2] = [("sh", "cargo run -p study -- scenarios/yukun.toml"), ("sh,skip=", "cargo test")];

pub fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

/// Rust files below a folder, sorted.
fn sources(folder: &Path) -> Vec<PathBuf> {
    files(folder, &["rs"])
}

/// Files with one of some endings below a folder, sorted; hidden folders and what is built hold none.
pub fn files(folder: &Path, endings: &[&str]) -> Vec<PathBuf> {
    let mut all = Vec::new();
    let entries = fs::read_dir(folder).unwrap_or_else(|error| panic!("{}: {error}", folder.display()));
    for entry in entries.flatten() {
        let (path, name) = (entry.path(), entry.file_name().to_string_lossy().into_owned());
        match path.is_dir() {
            true if name.starts_with('.') || name == "target" => {}
            true => all.extend(files(&path, endings)),
            false if endings.contains(&ending(&path)) => all.push(path),
            false => {}
        }
    }
    all.sort();
    all
}

/// How the name of a file ends, without the dot.
pub fn ending(path: &Path) -> &str {
    path.extension().and_then(|ending| ending.to_str()).unwrap_or_default()
}

pub fn read(path: &Path) -> String {
    fs::read_to_string(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

/// Crates of this workspace that a crate depends on, those of its tests left out.
fn dependencies(name: &str) -> Vec<String> {
    let manifest = read(&root().join("crates").join(name).join("Cargo.toml"));
    let (_, list) = manifest.split_once("[dependencies]").unwrap_or_default();
    let own = list.lines().take_while(|line| !line.starts_with('['));
    let keys = own.filter_map(|line| line.split(['.', ' ', '=']).next());
    keys.filter(|key| FLOORS.contains(key)).map(str::to_owned).collect()
}

/// Methods build without figures, the command line and files of other programs.
#[test]
fn methods_take_no_figures_command_line_or_parquet() {
    for package in ["kempf-identify", "kempf-trace"] {
        let mut cargo = Command::new(env!("CARGO"));
        cargo.args(["tree", "--offline", "--package", package, "--edges", "normal", "--prefix", "none"]);
        let tree = cargo.current_dir(root()).output().expect("cargo runs");
        let tree = String::from_utf8(tree.stdout).expect("names of packages");
        assert!(tree.starts_with(&format!("{package} v")), "{package}: {tree}");
        for heavy in ["parquet v", "plotters v", "clap v", "askama v", "kempf-simulate v"] {
            assert!(tree.lines().all(|line| !line.starts_with(heavy)), "{package} takes {heavy}");
        }
    }
}

/// With a default feature a crate, and all above it, is compiled once for the workspace and again for a package.
#[test]
fn no_crate_has_a_default_feature() {
    for name in FLOORS {
        let manifest = read(&root().join("crates").join(name).join("Cargo.toml"));
        assert!(!manifest.contains("\ndefault = "), "{name} has a default feature; name it where it is needed");
    }
}

#[test]
fn crates_depend_on_those_below_them() {
    let floor = |name: &str| FLOORS.iter().position(|known| *known == name).expect("a floor");
    let mut found: Vec<String> = fs::read_dir(root().join("crates"))
        .expect("crates")
        .flatten()
        .map(|c| c.file_name().into_string().unwrap())
        .collect();
    found.sort();
    let mut known = FLOORS.map(str::to_owned);
    known.sort();
    assert_eq!(found, known, "every crate has a floor");
    let mut below: BTreeMap<&str, BTreeSet<String>> = BTreeMap::new();
    for name in FLOORS {
        let own = dependencies(name);
        for other in &own {
            assert!(floor(other) < floor(name), "{name} stands below {other} and may not depend on it");
        }
        let more = own.iter().flat_map(|other| below[other.as_str()].clone()).collect::<Vec<_>>();
        below.insert(name, own.into_iter().chain(more).collect());
    }
    for method in ["identify", "trace"] {
        assert!(!below[method].contains("simulate"), "{method} must not be able to reach the truth");
    }
    assert!(!below["campaign"].contains("study"), "a campaign knows no command line");
}

/// What a file says outside of comments and tests.
fn code(text: &str) -> String {
    let body = text.find("#[cfg(test)]\nmod tests {").map_or(text, |tests| &text[..tests]);
    body.lines().map(|line| line.find("//").map_or(line, |comment| &line[..comment])).collect::<Vec<_>>().join("\n")
}

type Module = Vec<String>;

/// The modules of a crate with their code; those for tests left out.
fn modules(name: &str) -> BTreeMap<Module, String> {
    let folder = root().join("crates").join(name).join("src");
    let mut modules = BTreeMap::new();
    let mut of_tests: Vec<Module> = Vec::new();
    for path in sources(&folder) {
        let inside = path.strip_prefix(&folder).expect("below the folder").with_extension("");
        let mut module: Module = inside.iter().map(|part| part.to_string_lossy().into_owned()).collect();
        if module.last().is_some_and(|last| ["mod", "lib", "main"].contains(&last.as_str())) {
            module.pop();
        }
        let text = read(&path);
        for (place, _) in text.match_indices("#[cfg(test)]\n") {
            let line = text[place..].lines().nth(1).unwrap_or_default().trim();
            let declared = line.trim_start_matches("pub ").strip_prefix("mod ").and_then(|rest| rest.strip_suffix(';'));
            of_tests.extend(declared.map(|child| module.iter().cloned().chain([child.to_owned()]).collect::<Module>()));
        }
        modules.insert(module, code(&text));
    }
    modules.retain(|module, _| !of_tests.iter().any(|test| module.starts_with(test)));
    modules
}

/// The paths at the beginning of a text, written as in a `use`: with groups in braces.
fn paths(text: &str) -> Vec<Module> {
    let mut head: Module = Vec::new();
    let mut rest = text;
    loop {
        rest = rest.trim_start();
        if let Some(group) = rest.strip_prefix('{') {
            let mut depth = 1;
            let end = group.find(|c| {
                depth += i32::from(c == '{') - i32::from(c == '}');
                depth == 0
            });
            let group = &group[..end.unwrap_or(group.len())];
            let mut parts = Vec::new();
            let (mut depth, mut start) = (0, 0);
            for (place, c) in group.char_indices() {
                depth += i32::from(c == '{') - i32::from(c == '}');
                if c == ',' && depth == 0 {
                    parts.push(&group[start..place]);
                    start = place + 1;
                }
            }
            parts.push(&group[start..]);
            let below = parts.into_iter().filter(|part| !part.trim().is_empty()).flat_map(paths);
            return below.map(|path| head.iter().cloned().chain(path).collect()).collect();
        }
        let end = rest.find(|c: char| !(c.is_alphanumeric() || c == '_')).unwrap_or(rest.len());
        head.push(rest[..end].to_owned());
        match rest[end..].strip_prefix("::") {
            Some(after) => rest = after,
            None => return vec![head],
        }
    }
}

/// The modules that a module names.
fn named(module: &Module, text: &str, modules: &BTreeMap<Module, String>) -> BTreeSet<Module> {
    let parent = || module[..module.len().saturating_sub(1)].to_vec();
    let mut found = Vec::new();
    for (word, base) in [("crate::", Vec::new()), ("self::", module.clone()), ("super::", parent())] {
        for (place, _) in text.match_indices(word) {
            let is_word = !text[..place].ends_with(|c: char| c.is_alphanumeric() || c == '_' || c == ':' || c == '$');
            if is_word {
                found.extend(paths(&text[place + word.len()..]).into_iter().map(|path| [base.clone(), path].concat()));
            }
        }
    }
    // Children, which need no word before them.
    for (place, _) in text.match_indices("use ") {
        let own = paths(&text[place + "use ".len()..]).into_iter().map(|path| [module.clone(), path].concat());
        found.extend(own.filter(|path| modules.contains_key(&path[..=module.len()])));
    }
    let known =
        |path: Module| (0..=path.len()).rev().map(|end| path[..end].to_vec()).find(|head| modules.contains_key(head));
    // Nothing stands where a macro will put a name.
    found.retain(|path: &Module| path.last().is_some_and(|last| !last.is_empty()) || path.is_empty());
    found.into_iter().filter_map(known).filter(|other| other != module).collect()
}

/// A circle of modules, if there is one: each names the next, the last the first.
fn circle(arrows: &BTreeMap<Module, BTreeSet<Module>>) -> Option<Vec<Module>> {
    fn follow(
        from: &Module,
        arrows: &BTreeMap<Module, BTreeSet<Module>>,
        way: &mut Vec<Module>,
        done: &mut BTreeSet<Module>,
    ) -> Option<Vec<Module>> {
        if let Some(start) = way.iter().position(|step| step == from) {
            return Some(way[start..].to_vec());
        }
        if !done.insert(from.clone()) {
            return None;
        }
        way.push(from.clone());
        let found = arrows[from].iter().find_map(|next| follow(next, arrows, way, done));
        way.pop();
        found
    }
    let mut done = BTreeSet::new();
    arrows.keys().find_map(|module| follow(module, arrows, &mut Vec::new(), &mut done))
}

#[test]
fn the_files_of_a_crate_form_no_circle() {
    let mut circles = Vec::new();
    for name in FLOORS {
        let modules = modules(name);
        let arrows = modules.iter().map(|(module, text)| (module.clone(), named(module, text, &modules))).collect();
        if let Some(circle) = circle(&arrows) {
            let steps: Vec<String> = circle.iter().map(|module| format!("{name}::{}", module.join("::"))).collect();
            circles.push(steps.join(" -> "));
        }
    }
    assert!(circles.is_empty(), "files that use one another in a circle:\n{}", circles.join("\n"));
}

#[test]
fn a_circle_is_found() {
    let module = |name: &str| vec![name.to_owned()];
    let files = [
        ("a", "use crate::b::{c, D};"),
        ("b", "fn f() -> crate::c::X {}"),
        ("c", "use super::a;"),
        ("d", "use crate::a;"),
    ];
    let modules: BTreeMap<Module, String> = files.map(|(name, text)| (module(name), text.to_owned())).into();
    let arrows = modules.iter().map(|(module, text)| (module.clone(), named(module, text, &modules))).collect();
    assert_eq!(circle(&arrows), Some(["a", "b", "c"].map(module).to_vec()));
    assert_eq!(paths("a::{b, c::{d, E}}; rest"), [vec!["a", "b"], vec!["a", "c", "d"], vec!["a", "c", "E"]]);
}

#[test]
fn files_and_lines_can_be_read() {
    let mut wrong = Vec::new();
    for folder in ["crates", "tests", "benches"] {
        for path in sources(&root().join(folder)) {
            let text = read(&path);
            let lines = text.lines().count();
            if lines > LONGEST_FILE && !text.lines().next().is_some_and(|first| first.contains(EXCUSE)) {
                wrong.push(format!("{}: {lines} lines, and no \"{EXCUSE}\" in the first", path.display()));
            }
            // `cargo fmt` sees to the code, and nobody to comments. Rows of a table and addresses cannot be broken.
            let is_prose = |line: &str| line.starts_with("//") && !line.contains(" | ") && !line.contains("http");
            let is_wide = |line: &str| line.chars().count() > WIDEST_LINE && is_prose(line.trim_start());
            if let Some(number) = text.lines().position(is_wide) {
                wrong.push(format!("{}:{}: wider than {WIDEST_LINE} characters", path.display(), number + 1));
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn every_package_that_users_ask_for_does_its_work() {
    for (package, user, files) in ASKED_FOR {
        let manifest = read(&root().join(user).join("Cargo.toml"));
        let is_list = |section: &&str| section.lines().next().is_some_and(|head| head.ends_with("dependencies]"));
        let lists = manifest.split("\n[").filter(is_list);
        let mut keys = lists.flat_map(str::lines).filter_map(|line| line.split(['.', ' ', '=']).next());
        assert!(keys.any(|key| key == package), "{user} does not depend on {package}");
        for file in files {
            let text = code(&read(&root().join(user).join(file)));
            assert!(text.contains(&format!("use {package}::")), "{user}/{file} does not use {package}");
        }
    }
}

#[test]
fn every_kind_of_figure_is_a_chart_of_plotters() {
    let report = root().join("crates/report/src");
    let text = |name: &str| code(&read(&report.join(name)));
    assert!(text("sheet.rs").contains("ChartBuilder::on(") && text("sheet.rs").contains(".configure_mesh()"));
    for (element, file) in
        [("LineSeries::new(", "chart.rs"), ("ErrorBar::new_", "chart.rs"), ("Polygon::new(", "chart.rs")]
    {
        assert!(text(file).contains(element), "{file} draws no {element}");
    }
    for kind in KINDS {
        let text = text(&format!("figures/{kind}.rs"));
        let is_chart = ["sheet.grid", "layers::annotated("].iter().any(|way| text.contains(way));
        assert!(is_chart, "{kind}: its panels are not those of the sheet");
    }
    let elements = ["<path", "<polyline", "<polygon", "<circle", "<text", "<line"];
    for path in sources(&report).iter().filter(|path| !path.ends_with("backend.rs") && !path.ends_with("tests.rs")) {
        let text = code(&read(path));
        let written = elements.iter().find(|element| text.contains(*element));
        assert!(written.is_none(), "{}: {written:?} is written by the backend alone", path.display());
    }
}

#[test]
fn the_readme_begins_with_what_is_typed_first() {
    let (page, script) = (read(&root().join("README.md")), read(&root().join(".ci/run")));
    for (language, command) in COMMANDS {
        let mut blocks = page.split("\n```").filter(|block| block.starts_with(language));
        assert!(blocks.any(|block| block.lines().any(|line| line == command)), "README: a block of {command}");
        assert!(script.lines().any(|line| line.contains(command)), ".ci/run: {command}");
    }
}
