//! `study completions SHELL` and `study man DIR`: completion scripts and manual pages, generated from the options.

use std::path::PathBuf;

use campaign::failure::{Failure, OnPath};
use campaign::folder::ResultFolder;
use clap::{Args, Command};
use clap_complete::Shell;

use super::reply;
use crate::documents::answers::{CompletionsAnswer, ManAnswer};
use crate::options::{CommonOptions, Format};
use crate::screen;

/// Arguments of `study completions`.
#[derive(Debug, Clone, Args)]
pub struct CompletionsRequest {
    /// The shell
    pub shell: Shell,
}

/// Arguments of `study man`.
#[derive(Debug, Clone, Args)]
pub struct ManRequest {
    /// Folder for the pages, such as ~/.local/share/man/man1
    #[arg(value_name = "DIR")]
    pub folder: PathBuf,
}

/// Prints the completion script of a shell.
pub fn completions(
    &CompletionsRequest { shell }: &CompletionsRequest,
    mut command: Command,
    common: &CommonOptions,
) -> Result<(), Failure> {
    let name = command.get_name().to_owned();
    let mut script = Vec::new();
    clap_complete::generate(shell, &mut command, &name, &mut script);
    let script = String::from_utf8_lossy(&script).into_owned();
    if common.format != Format::Json {
        // A script is read by a shell, not shown to a person.
        return screen::print_unescaped(&script);
    }
    reply(common, &CompletionsAnswer { shell: shell.to_string(), script }, "")
}

/// Writes a page for the program and one for each of its commands.
///
/// Fails if the folder cannot be written.
pub fn man(ManRequest { folder }: &ManRequest, mut command: Command, common: &CommonOptions) -> Result<(), Failure> {
    command.build();
    let pages = ResultFolder::make(folder)?;
    let mut files = Vec::new();
    let program = command.get_name().to_owned();
    let below: Vec<Command> = command.get_subcommands().filter(|entry| entry.get_name() != "help").cloned().collect();
    let below = below.into_iter().map(|entry| (format!("{program}-{}", entry.get_name()), entry));
    for (name, command) in std::iter::once((program.clone(), command.clone())).chain(below) {
        let file = format!("{name}.1");
        let path = folder.join(&file);
        // `man` accepts no blank in a name.
        let page = clap_mangen::Man::new(command.name(name));
        let mut text = Vec::new();
        page.render(&mut text).on("make", &path)?;
        pages.write(&file, text)?;
        files.push(path.display().to_string());
    }
    let line = format!("{} pages in {}; read one with `man {}`", files.len(), folder.display(), files[0]);
    reply(common, &ManAnswer { files }, &line)
}
