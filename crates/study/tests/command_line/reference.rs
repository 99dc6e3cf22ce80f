//! Tests of the reference pages of the book that are made from the output of the program.

use std::path::PathBuf;

use crate::desk::{Desk, of_repository};

/// Command that writes the pages.
const COMMAND: &str = "cargo test -p study --test command_line write_the_reference -- --ignored";

/// Pages that print a list of `study list`: name of the page, and name of the list.
const LISTS: [(&str, &str); 6] = [
    ("methods", "identifiers"),
    ("effects", "effects"),
    ("ships", "ships"),
    ("keys", "keys"),
    ("columns", "columns"),
    ("sidecar", "sidecar"),
];

/// Text before the commands.
const COMMANDS: &str = "\
# Commands

This page lists every command of `study` with its arguments and options, as `study COMMAND --help` prints them. [The
tutorial](../tutorial/first-record.md) shows `fit`, `trace` and `predict` at work. `cargo test -p study --test
command_line write_the_reference -- --ignored` makes this page.

";

/// Row of the table of commands for a scenario without a command.
const RUN: &str =
    "| [`study SCENARIO.toml`](#study-scenariotoml) | Run a scenario: trials, identification, tables, plots |\n";

/// Text before the priors of a hull.
const PRIORS: &str = "\
# Priors of a hull

This page lists the prior of every coefficient of an MMG hull (Yasukawa and Yoshimura 2015, prime system ½ρLdU²): mean,
standard deviation, formula and source. The numbers are for the particulars of KVLCC2. L is the length, B the beam, d the
draught, C_b the block coefficient, H_R the height and A_R the area of the rudder.

The formulas use k = 2 d/L, m' = 2 C_b B/L, Λ = H_R²/A_R, and the advance ratio J of the straight approach. `study list
priors` makes the list for any ship. These are the regressions of Zhou (1983):

    m_x'/m' = (.398 + 11.97 C_b (1 + 3.73 d/B) − 2.89 C_b L/B (1 + 1.13 d/B)
              + .175 C_b (L/B)² (1 + .541 d/B) − 1.107 L d/B²)/100
    m_y'/m' = .882 − .54 C_b (1 − 1.6 d/B) − .156 L/B (1 − .673 C_b)
              + .826 L d/B² (1 − .678 d/B) − .638 C_b L d/B² (1 − .669 d/B)

This page is made by `cargo test -p study --test command_line write_the_reference -- --ignored`.

";

/// Options with length and approach speed of KVLCC2, and with her other particulars.
const LENGTH_AND_SPEED: &[&str] = &["--length-m", "320", "--speed-m-s", "7.97"];
const KVLCC2: &str = "--beam-m 58 --draught-m 20.8 --block-coefficient 0.81 --rudder-area-m2 112.5 --rudder-height-m 15.8 \
    --propeller-diameter-m 9.86 --propeller-rps 1.778 --displacement-t 320415 --x-g-m 11.2";

/// Page of the priors of a hull: coefficients, and the ratios that replace missing particulars. `said` returns the
/// output of the program for some arguments.
fn priors(said: impl Fn(&[&str]) -> String) -> String {
    let list = |particulars: &str| {
        let request = ["list", "priors", "--format", "markdown"];
        said(&[&request[..], LENGTH_AND_SPEED, &particulars.split_whitespace().collect::<Vec<_>>()].concat())
    };
    let bare = list("");
    let ratios: Vec<&str> = bare.lines().take_while(|line| !line.starts_with("| mx ")).collect();
    let what = "A particular that is not given is filled in by a ratio, here with length and speed alone:";
    format!(
        "{PRIORS}{}\n\n## Particulars that are filled in\n\n{what}\n\n{}\n",
        list(KVLCC2).trim_end(),
        ratios.join("\n")
    )
}

/// Path of every page, with the text that it must have.
fn pages() -> Vec<(PathBuf, String)> {
    let desk = Desk::new();
    let said = |arguments: &[&str]| desk.run(arguments).is_done().out.clone();
    let lists = LISTS.map(|(page, what)| (page, said(&["list", what, "--format", "markdown"])));
    let all = lists.into_iter().chain([("commands", commands(said)), ("priors", priors(said))]);
    all.map(|(page, text)| (of_repository(&format!("docs/src/reference/{page}.md")), text)).collect()
}

/// Page of all commands. Options of every command are listed once. `said` returns the output of the program for some
/// arguments.
fn commands(said: impl Fn(&[&str]) -> String) -> String {
    let whole = said(&["--help"]);
    let (_, list) = whole.split_once("\nCommands:\n").expect("commands");
    let names = list.lines().take_while(|line| !line.is_empty()).filter_map(|line| line.split_whitespace().next());
    let helps: Vec<(&str, String)> =
        names.filter(|name| *name != "help").map(|name| (name, said(&[name, "--help"]))).collect();
    let has_all = |item: &Item| helps.iter().all(|(_, help)| items(help).contains(item));
    let (common, own): (Vec<Item>, Vec<Item>) = items(&whole).into_iter().partition(has_all);
    let purposes = helps.iter().map(|(name, help)| {
        let summary = help.split("\n\n").next().unwrap_or_default().replace('\n', " ");
        format!("| [`study {name}`](#study-{name}) | {summary} |\n")
    });
    let overview = format!("| command | purpose |\n|---|---|\n{RUN}{}\n", purposes.collect::<String>());
    let mut page =
        format!("{COMMANDS}{overview}## study SCENARIO.toml\n\n{}", section("study [OPTIONS] SCENARIO.toml", &own));
    for (name, help) in &helps {
        let (summary, rest) = help.split_once("\n\nUsage: ").expect("a summary and a usage");
        let usage = rest.lines().next().unwrap_or_default();
        let own: Vec<Item> = items(help).into_iter().filter(|item| !common.contains(item)).collect();
        page.push_str(&format!("## study {name}\n\n{}.\n\n{}", summary.replace('\n', " "), section(usage, &own)));
    }
    page.push_str(&format!("## Options of every command\n\n{}", table(&common)));
    page.trim_end().to_owned() + "\n"
}

/// Usage of a command, and the table of its arguments and options.
fn section(usage: &str, items: &[Item]) -> String {
    format!("```text\n{usage}\n```\n\n{}", table(items))
}

/// Argument or option, and its meaning.
type Item = (String, String);

fn table(items: &[Item]) -> String {
    if items.is_empty() {
        return String::new();
    }
    let cell = |text: &str| text.replace('|', "\\|");
    let rows = items.iter().map(|(name, meaning)| format!("| `{}` | {} |\n", cell(name), cell(meaning)));
    format!("| argument or option | meaning |\n|---|---|\n{}\n", rows.collect::<String>())
}

/// Arguments and options of a help text, in which names are indented by fewer than ten blanks and meanings by ten or
/// more.
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
