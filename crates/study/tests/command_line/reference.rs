//! The pages of the book that the program can write itself are what it says of itself.

use std::path::PathBuf;

use crate::desk::{Desk, of_repository};

/// Writes the pages anew.
const COMMAND: &str = "cargo test -p study --test command_line write_the_reference -- --ignored";

/// Pages that are a list of the program: the name of the page, and what is listed.
const LISTS: [(&str, &str); 6] = [
    ("methods", "identifiers"),
    ("effects", "effects"),
    ("ships", "ships"),
    ("keys", "keys"),
    ("columns", "columns"),
    ("sidecar", "sidecar"),
];

/// What stands before the commands.
const COMMANDS: &str = "\
# Commands

What `study` can be asked, command by command, in the words of `study COMMAND --help`. Made from them by `cargo test -p study
--test command_line write_the_reference -- --ignored`.

";

/// Every page with what it has to hold.
fn pages() -> Vec<(PathBuf, String)> {
    let desk = Desk::new();
    let said = |arguments: &[&str]| desk.run(arguments).is_done().out.clone();
    let lists = LISTS.map(|(page, what)| (page, said(&["list", what, "--format", "markdown"])));
    let all = lists.into_iter().chain([("commands", commands(said))]);
    all.map(|(page, text)| (of_repository(&format!("docs/src/reference/{page}.md")), text)).collect()
}

/// The page of all commands. An option that every command has is told once.
fn commands(said: impl Fn(&[&str]) -> String) -> String {
    let whole = said(&["--help"]);
    let (_, list) = whole.split_once("\nCommands:\n").expect("commands");
    let names = list.lines().take_while(|line| !line.is_empty()).filter_map(|line| line.split_whitespace().next());
    let helps: Vec<(&str, String)> =
        names.filter(|name| *name != "help").map(|name| (name, said(&[name, "--help"]))).collect();
    let has_all = |item: &Item| helps.iter().all(|(_, help)| items(help).contains(item));
    let (common, own): (Vec<Item>, Vec<Item>) = items(&whole).into_iter().partition(has_all);
    let mut page = format!("{COMMANDS}## study SCENARIO.toml\n\n{}", section("study [OPTIONS] SCENARIO.toml", &own));
    for (name, help) in &helps {
        let (summary, rest) = help.split_once("\n\nUsage: ").expect("a summary and a usage");
        let usage = rest.lines().next().unwrap_or_default();
        let own: Vec<Item> = items(help).into_iter().filter(|item| !common.contains(item)).collect();
        page.push_str(&format!("## study {name}\n\n{}.\n\n{}", summary.replace('\n', " "), section(usage, &own)));
    }
    page.push_str(&format!("## Options of every command\n\n{}", table(&common)));
    page.trim_end().to_owned() + "\n"
}

/// How a command is called, and what it takes.
fn section(usage: &str, items: &[Item]) -> String {
    format!("```text\n{usage}\n```\n\n{}", table(items))
}

/// An argument or an option, and what it means.
type Item = (String, String);

fn table(items: &[Item]) -> String {
    if items.is_empty() {
        return String::new();
    }
    let cell = |text: &str| text.replace('|', "\\|");
    let rows = items.iter().map(|(name, meaning)| format!("| `{}` | {} |\n", cell(name), cell(meaning)));
    format!("| argument or option | meaning |\n|---|---|\n{}\n", rows.collect::<String>())
}

/// Arguments and options of a help text: a name is indented by less than ten blanks, its meaning by ten.
fn items(help: &str) -> Vec<Item> {
    let mut items: Vec<Item> = Vec::new();
    let mut is_list = false;
    for line in help.lines() {
        is_list = (is_list || ["Arguments:", "Options:"].contains(&line)) && line != "Commands:";
        let text = line.trim();
        match line.len() - line.trim_start().len() {
            _ if !is_list || text.is_empty() => {}
            1..10 => items.push((text.to_owned(), String::new())),
            10.. => {
                let meaning = &mut items.last_mut().expect("a name stands first").1;
                let value = text.strip_prefix("- ").and_then(|value| value.split_once(':'));
                let text = match value {
                    Some((value, what)) => format!("`{value}` – {}", what.trim()),
                    None => text.to_owned(),
                };
                let joint = match value {
                    _ if meaning.is_empty() => "",
                    Some(_) if !meaning.ends_with(':') => "; ",
                    None if !text.starts_with('[') => ". ",
                    _ => " ",
                };
                meaning.push_str(joint);
                meaning.push_str(&text);
            }
            0 => {}
        }
    }
    items
}

#[test]
fn the_reference_is_what_the_program_says() {
    for (path, text) in pages() {
        let page = std::fs::read_to_string(&path).unwrap_or_default();
        assert!(page == text, "{} is not what the program says; write it again: {COMMAND}", path.display());
    }
}

#[test]
#[ignore = "writes the pages"]
fn write_the_reference() {
    for (path, text) in pages() {
        std::fs::write(&path, text).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    }
}
