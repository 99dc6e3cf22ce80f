//! The definition of a benchmark, read and checked: sets of records, and what is asked of them.

use std::collections::BTreeMap;
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use crate::task::Task as Replicate;
use scenario::failure::Failure;
use scenario::{HULL, Scenario, hex, name};
use sha2::{Digest, Sha256};
use trial::Sidecar;
use trial::file::{self, Kind};

use crate::benchmark::cases::MEASURED;
use crate::benchmark::embedded;
use crate::benchmark::task::Task;
use crate::benchmark::wire::{
    DefinitionWire, MeasuredWire, Name, PredictionWire, RecordWire, SimulatedWire, TasksWire,
};

pub use crate::benchmark::wire::Deed;

/// A benchmark that has been checked.
pub struct Definition {
    /// What it is called.
    pub name: String,
    /// What it says about itself.
    pub about: String,
    /// Label of the method that others are compared with.
    pub reference: String,
    /// SHA-256 of the definition and of every file it names.
    pub sha256: String,
    /// Seed in place of those of the scenarios.
    pub seed: Option<u64>,
    /// The sets, in order.
    pub sets: Vec<Set>,
}

/// Records of one ship, measured, or trials of one cell of a scenario.
pub struct Set {
    /// What it is called; that of a cell has its label behind it.
    pub name: String,
    /// What the definition calls it.
    pub group: String,
    /// What it is, in a sentence.
    pub title: String,
    /// Its records: of a simulated set those of every trial.
    pub records: Vec<Member>,
    /// Where they come from.
    pub source: Source,
    /// What is asked.
    pub questions: Vec<Question>,
}

/// A record of a set.
pub struct Member {
    /// What it is called.
    pub name: String,
    /// What the ship was asked to do.
    pub deed: Deed,
}

/// Where records come from.
pub enum Source {
    /// They were measured, and are not part of the program.
    Measured {
        /// Where to download them.
        download: String,
        /// Their licence.
        licence: String,
        /// What to cite.
        cite: String,
        /// Files that hold each, the preferred one first.
        copies: Vec<Vec<RecordFile>>,
    },
    /// They are made.
    Simulated {
        /// The scenario.
        scenario: Arc<Scenario>,
        /// The cell of it.
        cell: usize,
    },
}

/// One file that holds a record.
pub struct RecordFile {
    /// Its name.
    pub file: String,
    /// Its SHA-256, hexadecimal.
    pub sha256: String,
    /// How it is read; by its header alone without one.
    pub sidecar: Option<Sidecar>,
}

/// One question: which records are fitted, and which is scored.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Question {
    /// The task.
    pub task: Task,
    /// Places of the fitted records in the set.
    pub fit: Vec<usize>,
    /// Place of the scored record; `None` where the ship is asked about.
    pub score: Option<usize>,
}

/// A definition; the published one has a tenth of this.
const DEFINITION: Kind = Kind { name: "the definition of a benchmark", largest: 1 << 20 };

impl Definition {
    /// The benchmark of the project.
    ///
    /// Fails when its texts are at fault, which a test rules out.
    pub fn published(seed: Option<u64>) -> Result<Self, Failure> {
        Self::parse(Path::new(embedded::PLACE), embedded::DEFINITION, seed, &|_, name| {
            embedded::text(name).map(str::to_owned).ok_or_else(|| "it is not part of the program".to_owned())
        })
    }

    /// Reads a definition; files it names are looked for beside it.
    ///
    /// Fails with a message that names file, line and key, what was found and what was expected.
    pub fn read(path: &Path, seed: Option<u64>) -> Result<Self, Failure> {
        let read = |path: &Path| file::read_text(path, DEFINITION).map_err(|error| error.to_string());
        let text = read(path).map_err(|error| Failure::input(format!("{}: {error}", path.display())))?;
        Self::parse(path, &text, seed, &|place, _| read(place))
    }

    fn parse(path: &Path, text: &str, seed: Option<u64>, texts: &Texts) -> Result<Self, Failure> {
        let reading = Reading { path, text, texts, seed };
        let wire: DefinitionWire = toml::from_str(text).map_err(|error| {
            let message = error.message().split_whitespace().collect::<Vec<_>>().join(" ");
            let advice = "scenarios/bench/zigzag-bench.toml is an example with every key";
            Failure::at(path, text, error.span().unwrap_or(0..0), "this is no benchmark", &message, advice)
        })?;
        reading.file_name(&wire.name)?;
        let mut digest = Sha256::new_with_prefix(text);
        let mut sets = Vec::new();
        for measured in &wire.measured {
            sets.push(reading.measured(measured, &mut digest)?);
        }
        for simulated in &wire.simulated {
            sets.extend(reading.simulated(simulated, &mut digest)?);
        }
        let groups = wire.measured.iter().map(|set| &set.name).chain(wire.simulated.iter().map(|set| &set.name));
        reading.distinct(groups, "set")?;
        if sets.is_empty() {
            return Err(Failure::input(format!(
                "{}: no set is defined; add [[measured]] or [[simulated]], as in {}",
                path.display(),
                embedded::PLACE
            )));
        }
        let sha256 = hex(&digest.finalize());
        let DefinitionWire { name, about, reference, .. } = wire;
        Ok(Self { name: name.into_inner(), about, reference, sha256, seed, sets })
    }

    /// The same benchmark with some of its sets and tasks; empty lists leave all.
    ///
    /// Fails when a set is not in it, and when nothing is left.
    pub fn only(mut self, sets: &[String], tasks: &[Task]) -> Result<Self, Failure> {
        let mut known: Vec<String> = self.sets.iter().map(|set| set.group.clone()).collect();
        known.dedup();
        if let Some(unknown) = sets.iter().find(|set| !known.contains(set)) {
            let advice = scenario::problem::suggestion(unknown, &known);
            return Err(Failure::input(format!("--set {unknown}: {} has no such set; {advice}", self.name)));
        }
        self.sets.retain(|set| sets.is_empty() || sets.contains(&set.group));
        for set in &mut self.sets {
            set.questions.retain(|question| tasks.is_empty() || tasks.contains(&question.task));
        }
        self.sets.retain(|set| !set.questions.is_empty());
        match self.sets.is_empty() {
            true => Err(Failure::input(format!("{}: these sets have none of these tasks", self.name))),
            false => Ok(self),
        }
    }
}

/// The text of a file that a definition names, by its path beside it and its name; fails with a reason.
type Texts<'a> = dyn Fn(&Path, &str) -> Result<String, String> + 'a;

/// A definition that is being read.
struct Reading<'a> {
    path: &'a Path,
    text: &'a str,
    texts: &'a Texts<'a>,
    seed: Option<u64>,
}

impl Reading<'_> {
    fn at(&self, span: Range<usize>, found: &str, expected: &str, advice: &str) -> Failure {
        Failure::at(self.path, self.text, span, found, expected, advice)
    }

    /// A name that files are called by.
    fn file_name(&self, own: &Name) -> Result<(), Failure> {
        let unfit = |unfit: name::Unfit| {
            let found = format!("it is called {}", name::shown(own.get_ref()));
            self.at(own.span(), &found, &unfit.to_string(), "give it another name")
        };
        name::file(own.get_ref()).map_err(unfit)
    }

    fn distinct<'n>(&self, names: impl Iterator<Item = &'n Name>, what: &str) -> Result<(), Failure> {
        let mut known: Vec<&str> = Vec::new();
        for own in names {
            let text = own.get_ref().as_str();
            name::label(text).map_err(|unfit| {
                let found = format!("a {what} is called {}", name::shown(text));
                self.at(own.span(), &found, &unfit.to_string(), "give it another name")
            })?;
            if known.contains(&text) {
                let found = format!("two {what}s are called {text:?}");
                return Err(self.at(own.span(), &found, "expected a name of its own", "give it another name"));
            }
            known.push(text);
        }
        Ok(())
    }

    /// The text of a file beside the definition, and where it is.
    fn beside(&self, own: &Name, digest: &mut Sha256) -> Result<(PathBuf, String), Failure> {
        let file = own.get_ref();
        let place = self.path.parent().unwrap_or(Path::new("")).join(file);
        let text = (self.texts)(&place, file).map_err(|error| {
            let found = format!("{} cannot be used: {error}", name::shown(file));
            self.at(own.span(), &found, "expected a file beside the definition", "mend the name, or put the file there")
        })?;
        digest.update(&text);
        Ok((place, text))
    }

    fn measured(&self, wire: &MeasuredWire, digest: &mut Sha256) -> Result<Set, Failure> {
        self.distinct(wire.record.iter().map(|record| &record.name), "record")?;
        let members = wire.record.iter().map(|record| self.member(&record.name, record.manoeuvre));
        let records: Vec<Member> = members.collect();
        let copies = wire.record.iter().map(|record| self.copies(record, digest)).collect::<Result<_, _>>()?;
        let ship = wire.tasks.indices.iter().chain(&wire.tasks.name).next();
        if let Some(of_a_ship) = ship {
            let found = "a measured ship is asked for what nobody knows";
            return Err(self.at(of_a_ship.span(), found, "only simulated ships have it", "leave it out"));
        }
        Ok(Set {
            name: wire.name.get_ref().clone(),
            group: wire.name.get_ref().clone(),
            title: wire.title.clone(),
            questions: self.questions(&wire.tasks, &records)?,
            records,
            source: Source::Measured {
                download: wire.download.clone(),
                licence: wire.licence.clone(),
                cite: wire.cite.clone(),
                copies,
            },
        })
    }

    fn member(&self, own: &Name, deed: Deed) -> Member {
        Member { name: own.get_ref().clone(), deed }
    }

    fn copies(&self, record: &RecordWire, digest: &mut Sha256) -> Result<Vec<RecordFile>, Failure> {
        if record.copies.is_empty() {
            let found = format!("{} has no file", name::shown(record.name.get_ref()));
            return Err(self.at(record.name.span(), &found, "expected at least one of `copies`", "add one"));
        }
        let mut copies = Vec::new();
        for wire in &record.copies {
            let sha256 = wire.sha256.get_ref().to_ascii_lowercase();
            if sha256.len() != 64 || !sha256.bytes().all(|digit| digit.is_ascii_hexdigit()) {
                let found = format!("the SHA-256 of {} is {}", wire.file, name::shown(&sha256));
                return Err(self.at(wire.sha256.span(), &found, "expected 64 hexadecimal digits", "see sha256sum"));
            }
            let sidecar = match &wire.sidecar {
                None => None,
                Some(own) => {
                    let (place, text) = self.beside(own, digest)?;
                    Some(Sidecar::parse(&text, &place).map_err(Failure::input)?)
                }
            };
            copies.push(RecordFile { file: wire.file.clone(), sha256, sidecar });
        }
        Ok(copies)
    }

    fn simulated(&self, wire: &SimulatedWire, digest: &mut Sha256) -> Result<Vec<Set>, Failure> {
        self.distinct(wire.records.iter(), "record")?;
        if wire.name.get_ref() == MEASURED {
            let found = format!("a simulated set is called {MEASURED:?}");
            return Err(self.at(
                wire.name.span(),
                &found,
                "expected another name",
                "the measured sets are called that",
            ));
        }
        let (place, text) = self.beside(&wire.scenario, digest)?;
        let scenario = Arc::new(Scenario::parse(&place, wire.name.get_ref(), text, self.seed)?);
        let several = scenario.cells.len() > 1;
        let of_cell = |cell: usize| {
            let own = &scenario.cells[cell];
            let refuse = |at: &Name, found: String, expected: &str, advice: &str| {
                Err(self.at(at.span(), &found, expected, advice))
            };
            if own.records() != wire.records.len() {
                let found = format!("a trial of {} has {} records", place.display(), own.records());
                return refuse(&wire.scenario, found, "expected as many names as records", "mend `records`");
            }
            let key = crate::engine::key(&scenario, Replicate { cell, replicate: 0 });
            let first = own.specimen(&key).map_err(Failure::input)?;
            let deeds = first.specification.records(&key).map(|(simulation, _)| Deed::of(&simulation.manoeuvre));
            let mut records = Vec::new();
            for (member, deed) in wire.records.iter().zip(deeds) {
                let Some(deed) = deed else {
                    let found = format!("{} is no zig-zag and no turning circle", member.get_ref());
                    return refuse(member, found, "expected one of the two", "change the manoeuvre in the scenario");
                };
                records.push(self.member(member, deed));
            }
            if let Some(at) = wire.tasks.indices.first().filter(|_| !own.is_first_order()) {
                let found = format!("{} is asked for K and T", own.title());
                return refuse(at, found, "expected a ship that is first order", "leave it out");
            }
            let missing = own.missing();
            if let Some(at) = wire.tasks.name.first().filter(|_| missing.len() > 1 || missing.iter().any(|m| m == HULL))
            {
                let found = format!("{} lacks {}", own.title(), missing.join(", "));
                return refuse(at, found, "expected one effect of the list, or none", "leave it out");
            }
            Ok(Set {
                name: if several { format!("{}, {}", wire.name.get_ref(), own.title()) } else { scenario.name.clone() },
                group: wire.name.get_ref().clone(),
                title: wire.title.clone(),
                questions: self.questions(&wire.tasks, &records)?,
                records,
                source: Source::Simulated { scenario: Arc::clone(&scenario), cell },
            })
        };
        (0..scenario.cells.len()).map(of_cell).collect()
    }

    fn questions(&self, tasks: &TasksWire, records: &[Member]) -> Result<Vec<Question>, Failure> {
        let places: BTreeMap<&str, usize> =
            records.iter().enumerate().map(|(place, member)| (member.name.as_str(), place)).collect();
        let place = |own: &Name| {
            places.get(own.get_ref().as_str()).copied().ok_or_else(|| {
                let known: Vec<&str> = records.iter().map(|member| member.name.as_str()).collect();
                let found = format!("there is no record {}", name::shown(own.get_ref()));
                let advice = scenario::problem::suggestion(own.get_ref(), &known);
                self.at(own.span(), &found, "expected a record of the set", &advice)
            })
        };
        let mut questions = Vec::new();
        for (task, own) in
            [(Task::Identify, &tasks.identify), (Task::Indices, &tasks.indices), (Task::Name, &tasks.name)]
        {
            for record in own {
                let fit = place(record)?;
                questions.push(Question { task, fit: vec![fit], score: (task == Task::Identify).then_some(fit) });
            }
        }
        for (task, own) in [
            (Task::OtherSide, &tasks.other_side),
            (Task::OtherAmplitude, &tasks.other_amplitude),
            (Task::Circle, &tasks.circle),
        ] {
            for PredictionWire { fit, score, pairs } in own {
                let asked: Vec<(Vec<&Name>, &Name)> = match (fit.as_slice(), score.as_slice(), pairs.as_slice()) {
                    ([_, ..], score @ [_, ..], []) => score.iter().map(|one| (fit.iter().collect(), one)).collect(),
                    ([], [], [_, _, ..]) => {
                        let of = |one: usize| (0..pairs.len()).filter(move |&other| other != one);
                        let both = |one: usize| of(one).map(move |other| (vec![&pairs[one]], &pairs[other]));
                        (0..pairs.len()).flat_map(both).collect()
                    }
                    _ => {
                        let first = fit.iter().chain(score).chain(pairs).next().map_or(0..0, Name::span);
                        let found = format!("a prediction of `{}` is not whole", task.id());
                        let expected = "expected `fit` and `score`, or two or more `pairs`";
                        return Err(self.at(first, &found, expected, "write { fit = [\"a\"], score = [\"b\"] }"));
                    }
                };
                for (fit, score) in asked {
                    let fitted = fit.into_iter().map(place).collect::<Result<Vec<usize>, _>>()?;
                    let scored = place(score)?;
                    let deeds: Vec<Deed> = fitted.iter().map(|&one| records[one].deed).collect();
                    if let Err(expected) = is_that(task, &deeds, records[scored].deed) {
                        let words: Vec<String> = deeds.into_iter().map(Deed::words).collect();
                        let found =
                            format!("`{}` from {} to {}", task.id(), words.join("; "), records[scored].deed.words());
                        return Err(self.at(
                            score.span(),
                            &found,
                            expected,
                            "name another record, or mend its manoeuvre",
                        ));
                    }
                    questions.push(Question { task, fit: fitted, score: Some(scored) });
                }
            }
        }
        Ok(questions)
    }
}

/// Whether a prediction from some manoeuvres to another one is what its task says; fails with what was expected.
fn is_that(task: Task, fitted: &[Deed], scored: Deed) -> Result<(), &'static str> {
    let zig_zag = |deed: &Deed| match *deed {
        Deed::ZigZag { rudder_deg, heading_deg, first } => Some(([rudder_deg, heading_deg], first)),
        Deed::TurningCircle { .. } => None,
    };
    let Some(fitted) = fitted.iter().map(zig_zag).collect::<Option<Vec<_>>>() else {
        return Err("expected zig-zags to be fitted");
    };
    let holds = match (task, zig_zag(&scored)) {
        (Task::OtherSide, Some((angles, first))) => fitted.iter().all(|own| own.0 == angles && own.1 != first),
        (Task::OtherAmplitude, Some((angles, _))) => fitted.iter().all(|own| own.0 != angles),
        (Task::Circle, None) => true,
        _ => false,
    };
    match task {
        _ if holds => Ok(()),
        Task::OtherSide => Err("expected a zig-zag of the same angles to the other side first"),
        Task::OtherAmplitude => Err("expected a zig-zag of another rudder or heading angle"),
        _ => Err("expected a turning circle to be scored"),
    }
}

#[cfg(test)]
mod tests;
