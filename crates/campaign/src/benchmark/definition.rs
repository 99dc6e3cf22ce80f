//! The definition of a benchmark, read and checked: sets of records, and what is asked of them.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};
use trial::file::{self, Kind};
use trial::{Manoeuvre, Sidecar};

use crate::benchmark::cases::{BenchTask, MEASURED};
use crate::benchmark::embedded;
use crate::benchmark::wire::{
    DefinitionWire, MeasuredWire, Name, PredictionWire, RecordWire, SimulatedWire, TasksWire, words,
};
use crate::failure::Failure;
use crate::scenario::{HULL, Scenario, hex, name};
use crate::task::Task;

/// Which definition was run.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Identity {
    /// What it is called.
    pub name: String,
    /// What it says about itself.
    pub about: String,
    /// SHA-256 of it and of all files it names.
    pub sha256: String,
    /// Seed in place of those of the scenarios.
    pub seed: Option<u64>,
}

/// A benchmark that has been checked.
pub struct Definition {
    /// Which it is.
    pub identity: Identity,
    /// Label of the method that others are compared with.
    pub reference: String,
    /// The sets, in order.
    pub sets: Vec<RecordSet>,
}

/// Records of one ship, measured, or trials of one cell of a scenario.
pub struct RecordSet {
    /// What it is called; that of a cell has its label behind it.
    pub name: String,
    /// What the definition calls it.
    pub group: String,
    /// What it is, in a sentence.
    pub title: String,
    /// Its records: of a simulated set those of every trial.
    pub records: Vec<SetRecord>,
    /// Where they come from.
    pub source: SetSource,
    /// What is asked.
    pub questions: Vec<Question>,
}

/// A record of a set.
pub struct SetRecord {
    /// What it is called.
    pub name: String,
    /// What the ship was asked to do.
    pub manoeuvre: Manoeuvre,
}

/// Where records come from.
pub enum SetSource {
    /// They were measured, and are not part of the program.
    Measured {
        /// Where to download them, their licence, and what to cite.
        origin: [String; 3],
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
    pub task: BenchTask,
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
        let text = read(path).map_err(|error| Failure::about(path, error))?;
        Self::parse(path, &text, seed, &|place, _| read(place))
    }

    fn parse(path: &Path, text: &str, seed: Option<u64>, texts: &Texts) -> Result<Self, Failure> {
        let reader = DefinitionReader { path, text, texts, seed };
        let wire: DefinitionWire = toml::from_str(text).map_err(|error| {
            let message = error.message().split_whitespace().collect::<Vec<_>>().join(" ");
            let advice = "scenarios/bench/zigzag-bench.toml is an example with every key";
            Failure::at(path, text, error.span().unwrap_or(0..0), "this is no benchmark", &message, advice)
        })?;
        reader.file_name(&wire.name)?;
        let mut digest = Sha256::new_with_prefix(text);
        let mut sets = Vec::new();
        let simulated = wire.simulated.iter().map(|set| &set.name);
        reader.distinct(wire.measured.iter().map(|set| &set.name).chain(simulated), "set")?;
        for measured in wire.measured {
            sets.push(reader.measured(measured, &mut digest)?);
        }
        for simulated in &wire.simulated {
            sets.extend(reader.simulated(simulated, &mut digest)?);
        }
        if sets.is_empty() {
            return Err(Failure::about(
                path,
                format!("no set is defined; add [[measured]] or [[simulated]], as in {}", embedded::PLACE),
            ));
        }
        let sha256 = hex(&digest.finalize());
        let DefinitionWire { name, about, reference, .. } = wire;
        Ok(Self { identity: Identity { name: name.into_inner(), about, sha256, seed }, reference, sets })
    }

    /// The same benchmark with some of its sets and tasks; empty lists leave all.
    ///
    /// Fails when a set is not in it, and when nothing is left.
    pub fn only(mut self, sets: &[String], tasks: &[BenchTask]) -> Result<Self, Failure> {
        let mut known: Vec<String> = self.sets.iter().map(|set| set.group.clone()).collect();
        known.dedup();
        if let Some(unknown) = sets.iter().find(|set| !known.contains(set)) {
            let advice = crate::scenario::problem::suggestion(unknown, &known);
            return Err(Failure::input(format!("--set {unknown}: {} has no such set; {advice}", self.identity.name)));
        }
        self.sets.retain(|set| sets.is_empty() || sets.contains(&set.group));
        for set in &mut self.sets {
            set.questions.retain(|question| tasks.is_empty() || tasks.contains(&question.task));
        }
        self.sets.retain(|set| !set.questions.is_empty());
        match self.sets.is_empty() {
            true => Err(Failure::input(format!("{}: these sets have none of these tasks", self.identity.name))),
            false => Ok(self),
        }
    }
}

/// The text of a file that a definition names, by its path beside it and its name; fails with a reason.
type Texts<'a> = dyn Fn(&Path, &str) -> Result<String, String> + 'a;

/// A definition that is being read.
struct DefinitionReader<'a> {
    path: &'a Path,
    text: &'a str,
    texts: &'a Texts<'a>,
    seed: Option<u64>,
}

impl DefinitionReader<'_> {
    fn at(&self, own: &Name, found: &str, expected: &str, advice: &str) -> Failure {
        Failure::at(self.path, self.text, own.span(), found, expected, advice)
    }

    /// A name that files are called by.
    fn file_name(&self, own: &Name) -> Result<(), Failure> {
        let unfit = |unfit: name::Unfit| {
            let found = format!("it is called {}", name::shown(own.get_ref()));
            self.at(own, &found, &unfit.to_string(), "give it another name")
        };
        name::file(own.get_ref()).map_err(unfit)
    }

    fn distinct<'n>(&self, names: impl Iterator<Item = &'n Name>, what: &str) -> Result<(), Failure> {
        let mut known: Vec<&str> = Vec::new();
        for own in names {
            let text = own.get_ref().as_str();
            let refuse = |found: String, expected: &str| Err(self.at(own, &found, expected, "give it another name"));
            if let Err(unfit) = name::label(text) {
                return refuse(format!("a {what} is called {}", name::shown(text)), &unfit.to_string());
            }
            if known.contains(&text) {
                return refuse(format!("two {what}s are called {text:?}"), "expected a name of its own");
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
            self.at(own, &found, "expected a file beside the definition", "mend the name, or put the file there")
        })?;
        digest.update(&text);
        Ok((place, text))
    }

    fn measured(&self, wire: MeasuredWire, digest: &mut Sha256) -> Result<RecordSet, Failure> {
        self.distinct(wire.record.iter().map(|record| &record.name), "record")?;
        let copies = wire.record.iter().map(|record| self.copies(record, digest)).collect::<Result<_, _>>()?;
        if let Some(own) = wire.tasks.indices.iter().chain(&wire.tasks.name).next() {
            let found = "a measured ship is asked for what nobody knows";
            return Err(self.at(own, found, "only simulated ships have it", "leave it out"));
        }
        let record =
            |own: &RecordWire| SetRecord { name: own.name.get_ref().clone(), manoeuvre: own.manoeuvre.clone() };
        let records: Vec<SetRecord> = wire.record.iter().map(record).collect();
        let name = wire.name.into_inner();
        Ok(RecordSet {
            group: name.clone(),
            name,
            title: wire.title,
            questions: self.questions(&wire.tasks, &records)?,
            records,
            source: SetSource::Measured { origin: [wire.download, wire.licence, wire.cite], copies },
        })
    }

    fn copies(&self, record: &RecordWire, digest: &mut Sha256) -> Result<Vec<RecordFile>, Failure> {
        if record.copies.is_empty() {
            let found = format!("{} has no file", name::shown(record.name.get_ref()));
            return Err(self.at(&record.name, &found, "expected at least one of `copies`", "add one"));
        }
        let mut copies = Vec::new();
        for wire in &record.copies {
            let sha256 = wire.sha256.get_ref().to_ascii_lowercase();
            if sha256.len() != 64 || !sha256.bytes().all(|digit| digit.is_ascii_hexdigit()) {
                let found = format!("the SHA-256 of {} is {}", wire.file, name::shown(&sha256));
                return Err(self.at(&wire.sha256, &found, "expected 64 hexadecimal digits", "see sha256sum"));
            }
            let sidecar = wire.sidecar.as_ref().map(|own| {
                let (place, text) = self.beside(own, digest)?;
                Sidecar::parse(&text, &place).map_err(Failure::input)
            });
            copies.push(RecordFile { file: wire.file.clone(), sha256, sidecar: sidecar.transpose()? });
        }
        Ok(copies)
    }

    fn simulated(&self, wire: &SimulatedWire, digest: &mut Sha256) -> Result<Vec<RecordSet>, Failure> {
        self.distinct(wire.records.iter(), "record")?;
        if wire.name.get_ref() == MEASURED {
            let found = format!("a simulated set is called {MEASURED:?}");
            return Err(self.at(&wire.name, &found, "expected another name", "the measured sets are called that"));
        }
        let (place, text) = self.beside(&wire.scenario, digest)?;
        let scenario = Arc::new(Scenario::parse(&place, wire.name.get_ref(), text, self.seed)?);
        (0..scenario.cells.len()).map(|cell| self.cell(wire, &place, &scenario, cell)).collect()
    }

    /// The set of one cell of a scenario.
    fn cell(
        &self,
        wire: &SimulatedWire,
        place: &Path,
        scenario: &Arc<Scenario>,
        cell: usize,
    ) -> Result<RecordSet, Failure> {
        let own = &scenario.cells[cell];
        if own.records() != wire.records.len() {
            let found = format!("a trial of {} has {} records", place.display(), own.records());
            return Err(self.at(&wire.scenario, &found, "expected as many names as records", "mend `records`"));
        }
        let key = crate::engine::key(scenario, Task { cell, replicate: 0 });
        let first = own.specimen(&key).map_err(Failure::input)?;
        let mut records = Vec::new();
        for (name, (simulation, _)) in wire.records.iter().zip(first.specification.records(&key)) {
            let manoeuvre = simulation.manoeuvre.clone();
            if !matches!(manoeuvre, Manoeuvre::ZigZag { .. } | Manoeuvre::TurningCircle { .. }) {
                let found = format!("{} is no zig-zag and no turning circle", name.get_ref());
                let advice = "change the manoeuvre in the scenario";
                return Err(self.at(name, &found, "expected one of the two", advice));
            }
            records.push(SetRecord { name: name.get_ref().clone(), manoeuvre });
        }
        if let Some(at) = wire.tasks.indices.first().filter(|_| own.is_nearest()) {
            let found = format!("{} is asked for K and T", own.title());
            return Err(self.at(at, &found, "expected a ship that is first order", "leave it out"));
        }
        let missing = own.missing();
        if let Some(at) = wire.tasks.name.first().filter(|_| missing.len() > 1 || missing.iter().any(|m| m == HULL)) {
            let found = format!("{} lacks {}", own.title(), missing.join(", "));
            return Err(self.at(at, &found, "expected one effect of the list, or none", "leave it out"));
        }
        let group = wire.name.get_ref().clone();
        let several = scenario.cells.len() > 1;
        Ok(RecordSet {
            name: if several { format!("{group}, {}", own.title()) } else { scenario.name.clone() },
            group,
            title: wire.title.clone(),
            questions: self.questions(&wire.tasks, &records)?,
            records,
            source: SetSource::Simulated { scenario: Arc::clone(scenario), cell },
        })
    }

    fn questions(&self, tasks: &TasksWire, records: &[SetRecord]) -> Result<Vec<Question>, Failure> {
        let place = |own: &Name| {
            let known = || records.iter().map(|record| record.name.as_str());
            known().position(|name| name == own.get_ref()).ok_or_else(|| {
                let found = format!("there is no record {}", name::shown(own.get_ref()));
                let advice = crate::scenario::problem::suggestion(own.get_ref(), &known().collect::<Vec<_>>());
                self.at(own, &found, "expected a record of the set", &advice)
            })
        };
        let mut questions = Vec::new();
        let alone = [
            (BenchTask::Identify, &tasks.identify),
            (BenchTask::Indices, &tasks.indices),
            (BenchTask::Name, &tasks.name),
        ];
        for (task, record) in alone.iter().flat_map(|(task, own)| own.iter().map(move |record| (*task, record))) {
            let fit = place(record)?;
            questions.push(Question { task, fit: vec![fit], score: (task == BenchTask::Identify).then_some(fit) });
        }
        let predicted = [
            (BenchTask::OtherSide, &tasks.other_side),
            (BenchTask::OtherAmplitude, &tasks.other_amplitude),
            (BenchTask::Circle, &tasks.circle),
        ];
        for (task, wire) in predicted.iter().flat_map(|(task, own)| own.iter().map(move |wire| (*task, wire))) {
            for (fit, score) in self.pairs(task, wire)? {
                let (fit, scored) = (fit.into_iter().map(place).collect::<Result<Vec<usize>, _>>()?, place(score)?);
                let fitted: Vec<Manoeuvre> = fit.iter().map(|&one| records[one].manoeuvre.clone()).collect();
                if let Err(expected) = is_that(task, &fitted, &records[scored].manoeuvre) {
                    let fitted: Vec<String> = fitted.iter().map(words).collect();
                    let to = words(&records[scored].manoeuvre);
                    let found = format!("`{}` from {} to {to}", task.id(), fitted.join("; "));
                    return Err(self.at(score, &found, expected, "name another record, or mend its manoeuvre"));
                }
                questions.push(Question { task, fit, score: Some(scored) });
            }
        }
        Ok(questions)
    }

    /// Which records are fitted together, and which one is scored.
    fn pairs<'n>(&self, task: BenchTask, wire: &'n PredictionWire) -> Result<Vec<(Vec<&'n Name>, &'n Name)>, Failure> {
        let PredictionWire { fit, score, pairs } = wire;
        match (fit.as_slice(), score.as_slice(), pairs.as_slice()) {
            ([_, ..], [_, ..], []) => Ok(score.iter().map(|one| (fit.iter().collect(), one)).collect()),
            ([], [], [_, _, ..]) => {
                let others = |one: usize| (0..pairs.len()).filter(move |&other| other != one);
                let both = |one: usize| others(one).map(move |other| (vec![&pairs[one]], &pairs[other]));
                Ok((0..pairs.len()).flat_map(both).collect())
            }
            _ => {
                let span = fit.iter().chain(score).chain(pairs).next().map_or(0..0, Name::span);
                let found = format!("a prediction of `{}` is not whole", task.id());
                let expected = "expected `fit` and `score`, or two or more `pairs`";
                let advice = "write { fit = [\"a\"], score = [\"b\"] }";
                Err(Failure::at(self.path, self.text, span, &found, expected, advice))
            }
        }
    }
}

/// Whether a prediction from some manoeuvres to another one is what its task says; fails with what was expected.
fn is_that(task: BenchTask, fitted: &[Manoeuvre], scored: &Manoeuvre) -> Result<(), &'static str> {
    let zig_zag = |manoeuvre: &Manoeuvre| match *manoeuvre {
        Manoeuvre::ZigZag { rudder, heading, first, .. } => Some(([rudder, heading], first)),
        _ => None,
    };
    let Some(fitted) = fitted.iter().map(zig_zag).collect::<Option<Vec<_>>>() else {
        return Err("expected zig-zags to be fitted");
    };
    let holds = match (task, zig_zag(scored)) {
        (BenchTask::OtherSide, Some((angles, first))) => fitted.iter().all(|own| own.0 == angles && own.1 != first),
        (BenchTask::OtherAmplitude, Some((angles, _))) => fitted.iter().all(|own| own.0 != angles),
        (BenchTask::Circle, None) => true,
        _ => false,
    };
    match task {
        _ if holds => Ok(()),
        BenchTask::OtherSide => Err("expected a zig-zag of the same angles to the other side first"),
        BenchTask::OtherAmplitude => Err("expected a zig-zag of another rudder or heading angle"),
        _ => Err("expected a turning circle to be scored"),
    }
}

#[cfg(test)]
mod tests;
