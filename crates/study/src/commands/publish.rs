//! `study publish`: every study of a folder of scenarios, and what `publish.toml` names beside them, made by this
//! program into the folder `published`; the page over them, checks, and what changed. What this program has made is
//! left as it is, so a publication that was stopped goes on.

use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::Instant;

use campaign::collect::collect;
use campaign::disk;
use campaign::files::MANIFEST;
use campaign::folder::ResultFolder;
use campaign::manifest::{Manifest, ProgramRevision};
use campaign::task::Shard;
use campaign::{store, unfinished};
use clap::Args;
use report::Theme;
use report::number::counted;
use scenario::Scenario;
use scenario::failure::{Failure, OnPath};
use scenario::problem::suggestion;

use super::{overview, reply};
use crate::documents::answers::{PublicationEntry, PublicationState, PublishAnswer};
use crate::options::{Common, FigureChoice};
use crate::terminal::Terminal;
use crate::views::page_files::REPORT;
use crate::views::publish::put;
use crate::work::publication::{PLAN, PUBLISHED, STAMP, published_files};
use crate::work::publication::{ProgramStamp, PublicationPlan, PublishedProgram};
use crate::work::publication_changes::{MovedFigure, PublicationChanges, changes};
use crate::{interrupt, screen};

/// What was published when this publication began, in the folder of results.
const BEFORE: &str = "before";

/// What changed since, in words.
const CHANGES: &str = "changes.txt";

/// Where programs work before their results take the place of the old ones.
const SCRATCH: &str = "scratch";

/// Figures of a study that are shown of all that moved.
const SHOWN: usize = 3;

/// What `study publish` is asked to do.
#[derive(Debug, Clone, Args)]
pub struct PublishRequest {
    /// Folder of results, with publish.toml
    #[arg(value_name = "DIR", default_value = "results")]
    pub folder: PathBuf,
    /// Studies and programs that are made [default: all]
    #[arg(long, value_name = "NAME,…", value_delimiter = ',')]
    pub only: Vec<String>,
    /// Folder with the measured records; without it, what needs them is left as it is
    #[arg(long, value_name = "DIR")]
    pub data: Option<PathBuf>,
    /// Make anew also what this program has made
    #[arg(long)]
    pub restart: bool,
}

/// What became of a study or a program: its state, and why where it was skipped.
type PublicationOutcome = (PublicationState, Option<String>);

const MADE: PublicationOutcome = (PublicationState::Made, None);
const CURRENT: PublicationOutcome = (PublicationState::Current, None);

/// Makes what is missing or was made by another program, says what changed, and has it checked.
///
/// Fails at once when the folder holds no `publish.toml` and when it is interrupted; in the end when something cannot
/// be made, was skipped or does not pass a check.
pub fn run(request: &PublishRequest, common: &Common) -> Result<(), Failure> {
    if common.seed.is_some() || common.out.is_some() {
        return Err(Failure::input("`study publish` takes neither --seed nor --out: scenarios and folder decide"));
    }
    let publication = Publication::new(request, common)?;
    let mut entries = publication.make()?;
    let all = overview::studies(&request.folder, Some(&publication.plan))?;
    let page = overview::write(&all, &publication.results)?;
    for check in &publication.plan.checks {
        let held = publication.start(&check.command, &[]).map(|()| MADE);
        entries.push(entry(&check.name, held, PublicationChanges::default()));
    }
    let is_whole = |entry: &PublicationEntry| matches!(entry.state, PublicationState::Made | PublicationState::Current);
    let wrong: Vec<&PublicationEntry> = entries.iter().filter(|entry| !is_whole(entry)).collect();
    if wrong.is_empty() && request.only.is_empty() {
        remove_folder(&request.folder.join(BEFORE))?;
    }
    let wrong: Vec<String> = wrong
        .into_iter()
        .map(|entry| format!("{}: {}", entry.name, entry.reason.as_deref().unwrap_or("not made")))
        .collect();
    let text: String = entries.iter().map(words).collect();
    publication.results.write(CHANGES, &text)?;
    let line = format!("{text}page: {}", page.display());
    reply(common, &PublishAnswer { page: page.display().to_string(), entries }, &line)?;
    match wrong.is_empty() {
        true => Ok(()),
        false => Err(Failure::work(format!("the publication is not whole:\n  {}", wrong.join("\n  ")))),
    }
}

/// A publication under way.
struct Publication<'a> {
    request: &'a PublishRequest,
    common: &'a Common,
    plan: PublicationPlan,
    /// Names and files of the scenarios.
    scenarios: Vec<(String, PathBuf)>,
    /// The folder of results, which nobody else publishes into.
    results: ResultFolder,
    /// Where the folder of results lies.
    root: PathBuf,
    /// Measured records.
    records: Option<PathBuf>,
}

impl<'a> Publication<'a> {
    fn new(request: &'a PublishRequest, common: &'a Common) -> Result<Self, Failure> {
        let folder = &request.folder;
        let missing = || Failure::about(folder, format!("there is no {PLAN} in it; give the folder that holds one"));
        let plan = PublicationPlan::read(folder)?.ok_or_else(missing)?;
        let scenarios = scenarios(&folder.join(&plan.scenarios))?;
        let names = scenarios.iter().map(|(name, _)| name).chain(plan.programs.iter().map(|own| &own.name));
        let known: Vec<String> = names.cloned().collect();
        if let Some(name) = request.only.iter().find(|name| !known.contains(name)) {
            let advice = suggestion(name, &known);
            return Err(Failure::input(format!("--only {name}: nothing of that name is published; {advice}")));
        }
        let path = |path: &Path| path.canonicalize().map_err(|error| Failure::about(path, error));
        let records = request.data.as_deref().map(path).transpose()?;
        let root = path(folder)?.parent().map_or_else(PathBuf::new, Path::to_owned);
        let results = ResultFolder::hold(folder)?;
        if ProgramRevision::own().git_dirty {
            let warning = "the source of this program was changed since its revision; commit it and build again";
            screen::warn_of(common, &[warning.to_owned()]);
        }
        let publication = Self { request, common, plan, scenarios, results, root, records };
        publication.unknown(&known)?;
        publication.keep_before()?;
        Ok(publication)
    }

    fn published(&self) -> PathBuf {
        self.request.folder.join(PUBLISHED)
    }

    /// Tells of folders that nothing makes any more.
    fn unknown(&self, known: &[String]) -> Result<(), Failure> {
        let path = self.published();
        disk::create_folder(&path).on("make the folder", &path)?;
        for name in disk::names(&path).on("list", &path)?.iter().filter(|name| !known.contains(name)) {
            let place = path.join(name);
            screen::warn_of(self.common, &[format!("{}: no scenario and no program makes it", place.display())]);
        }
        Ok(())
    }

    /// Keeps what was published before, unless a publication that was stopped has done so.
    fn keep_before(&self) -> Result<(), Failure> {
        let (published, before) = (self.published(), self.request.folder.join(BEFORE));
        if before.is_dir() {
            return Ok(());
        }
        let part = self.request.folder.join(format!("{BEFORE}.tmp"));
        remove_folder(&part)?;
        disk::create_folder(&part).on("make the folder", &part)?;
        for file in published_files(&published)? {
            let copy = part.join(&file);
            copy.parent().map_or(Ok(()), disk::create_folder).on("make a folder for", &copy)?;
            fs::copy(published.join(&file), &copy).on("copy", &copy)?;
        }
        disk::rename(&part, &before).on("make the folder", &before)
    }

    /// Makes everything that is asked for, and says what became of it. Fails at once when it is interrupted.
    fn make(&self) -> Result<Vec<PublicationEntry>, Failure> {
        let is_asked = |name: &&String| self.request.only.is_empty() || self.request.only.contains(name);
        let mut entries = Vec::new();
        let mut see = |name: &String, outcome: Result<PublicationOutcome, Failure>| {
            if outcome.is_err() && interrupt::is_asked() {
                return outcome.map(drop);
            }
            let changes = changes(&self.request.folder.join(BEFORE).join(name), &self.published().join(name))?;
            entries.push(entry(name, outcome, changes));
            Ok(())
        };
        for (name, path) in self.scenarios.iter().filter(|(name, _)| is_asked(&name)) {
            see(name, self.study(name, path))?;
        }
        for program in self.plan.programs.iter().filter(|program| is_asked(&&program.name)) {
            see(&program.name, self.program(program))?;
        }
        Ok(entries)
    }

    fn begin(&self, name: &str) {
        if !self.common.quiet {
            screen::warn(&format!("publishing {name}"));
        }
    }

    /// Runs a study, or what is missing of it, and draws it, unless this program has done so.
    fn study(&self, name: &str, path: &Path) -> Result<PublicationOutcome, Failure> {
        let scenario = Scenario::read(path, None)?;
        let place = self.published().join(name);
        let own = Manifest::new(&scenario, Shard::WHOLE);
        let has_rows_of =
            |stored: &Manifest| stored.program() == own.program() && stored.design_sha256 == own.design_sha256;
        let page = place.join(REPORT);
        // One that cannot be read belongs to another version.
        let stored = Manifest::read(&place.join(MANIFEST)).ok().flatten();
        let is_current = stored.is_some_and(|stored| has_rows_of(&stored) && stored.scenario == own.scenario);
        if is_current && page.is_file() && !self.request.restart {
            return Ok(CURRENT);
        }
        self.begin(name);
        let folder = ResultFolder::hold(&place)?;
        // It is written last: a study without it is not finished.
        disk::remove_if_there(&page).on("remove", &page)?;
        let begun = match unfinished::manifest_in(&place)? {
            None => store::manifest_of_rows(&place)?,
            begun => begun,
        };
        let restart = self.request.restart || begun.is_some_and(|begun| !has_rows_of(&begun));
        let terminal = Terminal::new("trials", self.common.quiet);
        let stored = collect(&scenario, Shard::WHOLE, &folder, restart, &terminal)?;
        put(&stored, &folder, &Theme::screen(), FigureChoice::Named)?;
        let text = fs::read_to_string(&page).on("read", &page)?;
        folder.remove_all(|name| {
            let stem = name.strip_suffix(".png").or_else(|| name.strip_suffix(".svg"));
            stem.is_some_and(|stem| !text.contains(&format!("{stem}.png")))
        })?;
        Ok(MADE)
    }

    /// Has a program work in a folder of its own, which takes the place of the old one when all went well.
    fn program(&self, own: &PublishedProgram) -> Result<PublicationOutcome, Failure> {
        let place = self.published().join(&own.name);
        let program = ProgramRevision::own();
        let is_of = |stored: ProgramStamp| stored.commands == own.commands && stored.program == program;
        if ProgramStamp::read(&place).ok().flatten().is_some_and(is_of) && !self.request.restart {
            return Ok(CURRENT);
        }
        if own.needs_records && self.records.is_none() {
            let why = "it needs the measured records; give their folder with --data";
            return Ok((PublicationState::Skipped, Some(why.to_owned())));
        }
        self.begin(&own.name);
        let scratch = self.request.folder.join(SCRATCH);
        remove_folder(&scratch)?;
        let made = scratch.join(&own.name);
        disk::create_folder(&made).on("make the folder", &made)?;
        // As seen from where the commands run, for it may be written into a page.
        let shown = |path: &Path| {
            let name = self.request.folder.canonicalize().ok().and_then(|path| Some(path.file_name()?.to_owned()));
            let inside = path.strip_prefix(&self.request.folder).unwrap_or(path);
            Path::new(&name.unwrap_or_default()).join(inside).display().to_string()
        };
        let records = self.records.as_deref().unwrap_or(Path::new("")).display().to_string();
        let places = [("{folder}", shown(&made)), ("{records}", records)];
        let start = Instant::now();
        own.commands.iter().try_for_each(|command| self.start(command, &places))?;
        let wall_time_s = start.elapsed().as_secs_f64().round();
        let stamp = ProgramStamp { commands: own.commands.clone(), wall_time_s, program };
        let text = toml::to_string(&stamp).on("describe", &made)?;
        ResultFolder::shared(&made)?.write(STAMP, text)?;
        remove_folder(&place)?;
        disk::rename(&made, &place).on("make the folder", &place)?;
        remove_folder(&scratch)?;
        Ok(MADE)
    }

    /// Runs a command where the folder of results lies, with `places` put into its words.
    fn start(&self, command: &[String], places: &[(&str, String)]) -> Result<(), Failure> {
        let place = |word: &String| places.iter().fold(word.clone(), |word, (name, path)| word.replace(name, path));
        let words: Vec<String> = command.iter().map(place).collect();
        let Some((name, arguments)) = words.split_first() else { return Ok(()) };
        let program = if name == "study" { std::env::current_exe().on("find", Path::new(name))? } else { name.into() };
        let mut started = Command::new(program);
        started.args(arguments).current_dir(&self.root).stdin(Stdio::null()).stdout(Stdio::null());
        if let Some(records) = &self.records {
            started.env("TRIAL_DATA", records).env("KEMPF_DATA", records);
        }
        let said = words.join(" ");
        match started.status() {
            Ok(status) if status.success() => Ok(()),
            Ok(status) => Err(Failure::work(format!("`{said}` failed ({status}); what it said stands above"))),
            Err(error) => Err(Failure::work(format!("failed to start `{said}`: {error}"))),
        }
    }
}

/// Names and files of the scenarios in a folder, sorted.
fn scenarios(folder: &Path) -> Result<Vec<(String, PathBuf)>, Failure> {
    let names = disk::names(folder).map_err(|error| {
        Failure::about(folder, format!("{error}; `scenarios` of {PLAN} has to be the folder of the scenarios"))
    })?;
    let files = names.iter().filter_map(|name| Some((name.strip_suffix(".toml")?.to_owned(), folder.join(name))));
    Ok(files.collect())
}

/// Removes a folder with all that is in it, where it is there.
fn remove_folder(path: &Path) -> Result<(), Failure> {
    if disk::is_there(path).on("look for", path)? { fs::remove_dir_all(path).on("remove", path) } else { Ok(()) }
}

fn entry(name: &str, outcome: Result<PublicationOutcome, Failure>, changes: PublicationChanges) -> PublicationEntry {
    let (state, reason) =
        outcome.unwrap_or_else(|failure| (PublicationState::Failed, Some(failure.message.replace('\n', " "))));
    PublicationEntry {
        name: name.to_owned(),
        state,
        reason,
        changed_files: changes.files.iter().map(|file| file.display().to_string()).collect(),
        figures: changes.figures,
        moved: changes.moved.iter().map(moved).collect(),
    }
}

fn moved(MovedFigure { place, before, after }: &MovedFigure) -> String {
    let figure = |[value, low, high]: &[f64; 3]| format!("{value} [{low}, {high}]");
    format!("{place}: {} → {}", figure(before), figure(after))
}

/// An entry in words: one line, and below it the figures that moved farthest.
fn words(entry: &PublicationEntry) -> String {
    let PublicationEntry { name, state, reason, changed_files, figures, moved } = entry;
    let state = match state {
        PublicationState::Made => "made",
        PublicationState::Current => "there already",
        PublicationState::Skipped => "skipped",
        PublicationState::Failed => "failed",
    };
    let mut text = format!("{name}: {state}");
    let mut add = |part: String| text.write_str(&part).expect("writing to a string does not fail");
    reason.iter().for_each(|why| add(format!(": {why}")));
    if !changed_files.is_empty() {
        add(format!("; {} changed", counted(changed_files.len() as u64, "file")));
    }
    if *figures > 0 {
        add(format!("; {} of {figures} figures moved beyond noise", moved.len()));
    }
    add("\n".to_owned());
    moved.iter().take(SHOWN).for_each(|line| add(format!("  {line}\n")));
    text
}
