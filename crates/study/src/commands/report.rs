//! `study report DIR`: tables, figures and pages of a finished study, a fit, a trace, a prediction or a benchmark, from
//! stored files alone. For several studies also one page over them.

use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use ::predict::PredictDocument;
use campaign::collect::complete;
use campaign::failure::Failure;
use campaign::folder::ResultFolder;
use campaign::store;
use clap::Args;

use super::{bench, fit, predict, trace};
use crate::documents::curves::TraceCurves;
use crate::documents::{BENCH_FILE, CURVES_FILE, FIT_FILE, PREDICT_FILE, TRACE_FILE, read_document, read_json};
use crate::options::{CommonOptions, Format, StudyFigureOptions};
use crate::screen;
use crate::terminal::Terminal;
use crate::views::page_files::HTML_REPORT_FILE;
use crate::views::publish::write_results;
use crate::views::studies_page;

/// Arguments of `study report`.
#[derive(Debug, Clone, Args)]
pub struct ReportRequest {
    /// Folder of a finished study, a fit, a trace, a prediction or a benchmark; for several studies also one page over
    /// all is written, README.md in the folder that holds them or in --out
    #[arg(required = true, value_name = "DIR")]
    pub folders: Vec<PathBuf>,
    /// Show report.html in a browser
    #[arg(long)]
    pub open: bool,
    /// How figures are drawn, and which
    #[command(flatten)]
    pub style: StudyFigureOptions,
}

/// Makes tables, figures and pages of a finished study, a fit, a trace, a prediction or a benchmark in its folder, or
/// in `--out`; with `open` shows the page in a browser. Several studies are each made in their own folders, and the
/// page over them in the folder that holds them all, or in `--out`.
pub fn run(request: &ReportRequest, common: &CommonOptions) -> Result<(), Failure> {
    let folders = &request.folders[..];
    if let [folder] = folders {
        return report(folder, request, common);
    }
    if common.format != Format::Text {
        return Err(Failure::input("--format applies to one study; give one folder, or leave --format out"));
    }
    let place = common.out.clone().map_or_else(|| shared_folder(folders), Ok)?;
    studies_page::check_folders(folders, &place)?;
    let in_place = CommonOptions { out: None, ..common.clone() };
    folders.iter().try_for_each(|folder| report(folder, request, &in_place))?;
    let page = studies_page::write(folders, &ResultFolder::make(&place)?)?;
    if common.quiet {
        Ok(())
    } else {
        screen::print_lines(&format!("page over {} studies: {}", folders.len(), page.display()))
    }
}

/// Common parent folder of some folders. Fails if they lie in different ones.
fn shared_folder(folders: &[PathBuf]) -> Result<PathBuf, Failure> {
    let holding = |folder: &PathBuf| match folder.file_name().and(folder.parent()) {
        Some(parent) if parent == Path::new("") => Some(PathBuf::from(".")),
        parent => parent.map(Path::to_owned),
    };
    let mut all = folders.iter().map(holding);
    let first = all.next().flatten().filter(|first| all.all(|other| other.as_ref() == Some(first)));
    let problem = "the folders do not lie beside each other; give a place for the page over them with --out DIR";
    first.ok_or_else(|| Failure::input(problem))
}

/// Makes all output of one folder.
fn report(stored: &Path, request: &ReportRequest, common: &CommonOptions) -> Result<(), Failure> {
    let ReportRequest { open, style, .. } = request;
    let folder = common.out.as_deref().unwrap_or(stored);
    let held = || ResultFolder::make(folder);
    let theme = || style.style.theme();
    let has = |name: &str| stored.join(name).is_file();
    match () {
        () if has(TRACE_FILE) => {
            let (folder, theme) = (held()?, theme()?);
            let (document, text) = read_document(&stored.join(TRACE_FILE), document::trace::SCHEMA)?;
            let curves = TraceCurves::read(&document, stored)?;
            trace::write_results(&folder, &document, &curves, &text, Some(&theme), common, &[])?
        }
        () if has(FIT_FILE) => {
            let (folder, theme) = (held()?, theme()?);
            let (document, text) = read_document(&stored.join(FIT_FILE), document::fit::SCHEMA)?;
            let (curves, _) = read_json(&stored.join(CURVES_FILE), "fit")?;
            fit::write_results(&folder, &document, &curves, &text, Some(&theme), common)?
        }
        () if has(PREDICT_FILE) => {
            let (folder, theme) = (held()?, theme()?);
            let (document, text) = read_document(&stored.join(PREDICT_FILE), ::predict::document::SCHEMA)?;
            let predicted = PredictDocument::with_curves(document, read_json(&stored.join(CURVES_FILE), "predict")?.0);
            predict::write_results(&folder, &predicted, &text, Some(&theme), common, &predicted.warnings)?
        }
        () if has(BENCH_FILE) => {
            bench::write_results(&read_json(&stored.join(BENCH_FILE), "bench")?.0, &held()?, &theme()?, common)?
        }
        () => rebuild(stored, style, common)?,
    }
    if *open { show(&folder.join(HTML_REPORT_FILE)) } else { Ok(()) }
}

fn rebuild(rows: &Path, style: &StudyFigureOptions, common: &CommonOptions) -> Result<(), Failure> {
    let theme = style.style.theme()?;
    store::required_manifest(rows)?;
    let stored = complete(&ResultFolder::make(rows)?, &Terminal::new("trials", common.quiet))?;
    let folder = ResultFolder::make(common.out.as_deref().unwrap_or(rows))?;
    write_results(&stored, &folder, &theme, style.figures, common)
}

/// Program that opens a file in the user's browser, and its options.
#[cfg(target_os = "macos")]
const OPENER: (&str, &[&str]) = ("open", &[]);
#[cfg(windows)]
const OPENER: (&str, &[&str]) = ("cmd", &["/C", "start", ""]);
#[cfg(not(any(target_os = "macos", windows)))]
const OPENER: (&str, &[&str]) = ("xdg-open", &[]);

/// Shows a page in a browser. Fails if there is no page, or if no program can open it.
fn show(page: &Path) -> Result<(), Failure> {
    let shown = page.display();
    if !page.is_file() {
        return Err(Failure::input(format!(
            "{shown}: there is no such page; run the command that made the folder again to write it"
        )));
    }
    let (program, options) = OPENER;
    let opened = Command::new(program).args(options).arg(page).stdout(Stdio::null()).stderr(Stdio::null()).status();
    match opened {
        Ok(status) if status.success() => Ok(()),
        Ok(status) => Err(Failure::execution(format!("{program} did not open {shown} ({status}); open it by hand"))),
        Err(error) => Err(Failure::execution(format!("failed to run {program}: {error}; open {shown} by hand"))),
    }
}
