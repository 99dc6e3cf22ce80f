//! `study overview DIR`: one page over all published studies of a folder, each with its question, its answer in a
//! sentence and the figure that stands for it. Made from the manifests, so it needs no rows. Where the folder says what
//! is published from it, results that no scenario makes stand before the studies.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use clap::Args;
use report::markdown;

use super::reply;
use crate::documents::answers::{OverviewAnswer, PublishedStudy};
use crate::options::Common;
use crate::views::page_files::{KEY_FIGURE, REPORT};
use crate::work::publication::{PLAN, PUBLISHED, PublicationPlan, PublishedProgram};
use campaign::disk;
use campaign::files;
use campaign::folder::ResultFolder;
use campaign::manifest::Manifest;
use scenario::failure::{Failure, OnPath};
use scenario::name;

/// Name of the page.
const PAGE: &str = "README.md";

/// How the page begins; one that begins otherwise belongs to somebody else.
const MARK: &str = "<!-- Made by `study overview`, which writes it anew. -->\n";

/// Largest page that is looked at, bytes.
const LARGEST: u64 = 1 << 26;

/// What `study overview` is asked to do.
#[derive(Debug, Clone, Args)]
pub struct OverviewRequest {
    /// Folder that holds the folders of studies
    #[arg(value_name = "DIR")]
    pub folder: PathBuf,
}

/// Writes `README.md` into the folder, or to `--out`.
pub fn run(OverviewRequest { folder }: &OverviewRequest, common: &Common) -> Result<(), Failure> {
    let plan = PublicationPlan::read(folder)?;
    let studies = studies(folder, plan.as_ref())?;
    let target = ResultFolder::make(common.out.as_deref().unwrap_or(folder))?;
    let path = write(&studies, &target)?;
    let answer = OverviewAnswer { page: path.display().to_string(), studies: &studies };
    let noun = if studies.len() == 1 { "study" } else { "studies" };
    reply(common, &answer, &format!("{} {noun}: {}", studies.len(), path.display()))
}

/// Writes the page into a folder; returns its path.
///
/// Fails when a page of somebody else is there, and when it cannot be written.
pub fn write(studies: &[PublishedStudy], target: &ResultFolder) -> Result<PathBuf, Failure> {
    let path = target.path().join(PAGE);
    if disk::read(&path, LARGEST).on("read", &path)?.is_some_and(|text| !text.starts_with(MARK.as_bytes())) {
        return Err(Failure::about(
            &path,
            "this page was not made by `study overview`; move it away, or give another folder with --out",
        ));
    }
    target.write(PAGE, MARK.to_owned() + &markdown::prose(&page(studies)))?;
    Ok(path)
}

/// What the programs of a plan made, and the studies of a folder in the order of their names.
///
/// Fails when there is no study, and when a figure that is named is not there.
pub fn studies(folder: &Path, plan: Option<&PublicationPlan>) -> Result<Vec<PublishedStudy>, Failure> {
    let (place, inside) = match plan {
        Some(_) => (&folder.join(PUBLISHED), format!("{PUBLISHED}/")),
        None => (&folder.to_owned(), String::new()),
    };
    let programs = plan.iter().flat_map(|plan| &plan.programs).filter(|own| place.join(&own.name).is_dir());
    let programs = programs.map(|own| program(own, place, &inside)).collect::<Result<Vec<_>, _>>()?;
    let studies = of_scenarios(place, &inside)?;
    Ok(programs.into_iter().chain(studies).collect())
}

/// What a program made.
fn program(own: &PublishedProgram, place: &Path, inside: &str) -> Result<PublishedStudy, Failure> {
    let PublishedProgram { name, question, finding, page, figure, .. } = own;
    let folder = place.join(name);
    if let Some(missing) = figure.iter().chain([page]).find(|file| !folder.join(file).is_file()) {
        return Err(Failure::about(&folder, format!("{PLAN} names {missing}, and the folder holds no such file")));
    }
    Ok(PublishedStudy {
        folder: format!("{inside}{name}"),
        name: name.clone(),
        page: page.clone(),
        question: question.trim().to_owned(),
        finding: finding.trim().to_owned(),
        figure: figure.clone(),
    })
}

/// The studies of a folder in the order of their names.
fn of_scenarios(folder: &Path, inside: &str) -> Result<Vec<PublishedStudy>, Failure> {
    let names = disk::names(folder).map_err(|error| {
        Failure::about(folder, format!("{error}; give the folder that holds the folders of studies"))
    })?;
    let folders = names.iter().map(|name| folder.join(name)).filter(|own| own.join(files::MANIFEST).is_file());
    let studies: Vec<PublishedStudy> = folders.map(|folder| study(&folder, inside)).collect::<Result<_, _>>()?;
    if studies.is_empty() {
        let problem = format!("no folder in it holds a {}", files::MANIFEST);
        return Err(Failure::about(folder, format!("{problem}; run a scenario first")));
    }
    Ok(studies)
}

fn study(folder: &Path, inside: &str) -> Result<PublishedStudy, Failure> {
    let path = folder.join(files::MANIFEST);
    let missing = || Failure::about(&path, "there is no such file any more");
    let manifest = Manifest::read(&path)?.ok_or_else(missing)?;
    let words = manifest.words();
    let unfit = |stem: &str, unfit| Failure::about(&path, format!("`output.figure` is {}; {unfit}", name::shown(stem)));
    let figure = match &words.output.figure {
        Some(stem) => Some(name::file(stem).map_err(|error| unfit(stem, error)).and_then(|()| figure(folder, stem))?),
        None => None,
    };
    // A link needs the name of the folder, which --out may have made another than that of the scenario.
    let name = folder.file_name().map_or_else(|| manifest.name.clone(), |name| name.to_string_lossy().into_owned());
    Ok(PublishedStudy {
        folder: format!("{inside}{name}"),
        name,
        page: REPORT.to_owned(),
        question: words.question.trim().to_owned(),
        finding: words.finding.trim().to_owned(),
        figure,
    })
}

/// File of the figure that a scenario names.
fn figure(folder: &Path, stem: &str) -> Result<String, Failure> {
    let files = [KEY_FIGURE, stem].map(|stem| format!("{stem}.png"));
    if let Some(file) = files.into_iter().find(|file| folder.join(file).is_file()) {
        return Ok(file);
    }
    let file = format!("{stem}.png");
    let names = disk::names(folder).on("list", folder)?;
    let known: Vec<&str> = names.iter().filter_map(|name| name.strip_suffix(".png")).collect();
    Err(Failure::about(
        folder,
        format!(
            "the scenario has `output.figure = {stem:?}`, and the folder holds no {file}; figures there: {}",
            known.join(", ")
        ),
    ))
}

fn page(studies: &[PublishedStudy]) -> String {
    let mut page = String::from(
        "# Results\n\nOne study a section: its question, what came out, and the figure that shows it. The folder of a \
         study holds the whole\nreport, every figure with its 95 % interval as CSV and LaTeX, and a manifest from which \
         `study NAME/manifest.toml --out DIR`\nruns it again; a study that starts other programs is run from its scenario.\n",
    );
    for PublishedStudy { name, folder, page: file, question, finding, figure } in studies {
        write!(page, "\n## [{name}]({folder}/{file})\n\n**{question}**\n").expect("writing to a string does not fail");
        if !finding.is_empty() {
            write!(page, "\n{finding}\n").expect("writing to a string does not fail");
        }
        if let Some(figure) = figure {
            write!(page, "\n![Figure of {name}]({folder}/{figure})\n").expect("writing to a string does not fail");
        }
    }
    page
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_study_without_a_figure_is_listed_too() {
        let study = |figure: Option<&str>| PublishedStudy {
            name: "noise".into(),
            folder: "published/noise".into(),
            page: "report.md".into(),
            question: "How much?".into(),
            finding: "Little.".into(),
            figure: figure.map(str::to_owned),
        };
        let page = page(&[study(Some("errors.png")), study(None)]);
        assert_eq!(page.matches("## [noise](published/noise/report.md)\n\n**How much?**\n\nLittle.\n").count(), 2);
        assert_eq!(page.matches("![Figure of noise](published/noise/errors.png)").count(), 1);
    }
}
