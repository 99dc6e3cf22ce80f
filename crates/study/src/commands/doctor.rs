//! `study doctor`: properties of this machine that make a study slow or prevent it from being written.

use std::io::IsTerminal;
use std::path::Path;

use campaign::failure::Failure;
use campaign::folder::ResultFolder;
use campaign::manifest;
use report::{Table, TableHead};

use super::reply;
use crate::documents::answers::DoctorAnswer;
use crate::options::CommonOptions;
use crate::{screen, threads};

/// Name of a test file that is written and removed again.
const PROBE: &str = ".study-doctor";

/// Prints the properties of the machine.
///
/// Fails if no file can be written to the folder of results.
pub fn run(common: &CommonOptions) -> Result<(), Failure> {
    let folder = common.out.as_deref().unwrap_or(Path::new("."));
    let written = probe(folder);
    let terminal = |is: bool, coloured: bool| match (is, coloured) {
        (false, _) => "no terminal",
        (true, false) => "terminal without colours",
        (true, true) => "terminal with colours",
    };
    let (output, errors) = (std::io::stdout(), std::io::stderr());
    let checks = [
        ("version", manifest::version()),
        ("machine", format!("{}-{}", std::env::consts::ARCH, std::env::consts::OS)),
        ("processors", threads::core_count().to_string()),
        ("threads", threads::thread_count(common).to_string()),
        ("instruction set", estimation::lanes::instruction_set().to_owned()),
        ("standard output", terminal(output.is_terminal(), screen::has_terminal_colours(&output)).to_owned()),
        ("standard error", terminal(errors.is_terminal(), screen::has_terminal_colours(&errors)).to_owned()),
        ("spreadsheets", String::from(if cfg!(feature = "spreadsheets") { "read" } else { "not compiled in" })),
        (
            "writing",
            written.as_ref().map_or_else(|error| error.message.clone(), |()| format!("works in {}", folder.display())),
        ),
    ];
    let mut table = Table::new(TableHead::default().texts(["what", "found"]));
    checks.iter().for_each(|(name, value)| table.push([name, value.as_str()]));
    let checks = checks.into_iter().map(|(name, value)| (name.replace(' ', "_"), value)).collect();
    reply(common, &DoctorAnswer { checks }, common.format.render(&table).trim_end())?;
    written
}

/// Writes a file in the way results are written, and removes it.
fn probe(folder: &Path) -> Result<(), Failure> {
    let folder = ResultFolder::make(folder)?;
    folder.write(PROBE, "written and read\n")?;
    let path = folder.path().join(PROBE);
    std::fs::remove_file(&path)
        .map_err(|error| Failure::execution(format!("failed to remove {}: {error}", path.display())))
}
