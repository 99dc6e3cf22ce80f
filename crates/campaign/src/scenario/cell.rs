//! Cells of a design: everything about a trial but its chance, and how one with drawn values is made.

use std::borrow::Cow;
use std::path::{Path, PathBuf};

use ship::Particulars;
use simulate::{Assumption, Disturbances, Manoeuvre, StreamKey};
use toml::{Table, Value};

use crate::scenario::draw::DrawnKey;
use crate::scenario::method::{IdentifierWire, Method, Procedure, methods};
use crate::scenario::part::ScenarioPart;
use crate::scenario::physics::MissingPhysics;
use crate::scenario::problem::{KeyFault, KeyPath};
use crate::scenario::records::{RecordSet, RecordStudyWire};
use crate::scenario::specification::Specification;
use crate::scenario::wire::ScenarioWire;
use crate::scenario::{limits, reader, resolve, sweep};

/// One cell of the design: everything but chance is fixed.
pub struct DesignCell {
    /// Labels of its points, one an axis.
    pub labels: Vec<String>,
    /// Values of its points, where an axis is a number.
    pub values: Vec<Option<f64>>,
    /// The methods, all on the same trial.
    pub methods: Vec<Method>,
    /// Where its trials come from.
    pub(crate) source: TrialSource,
}

/// Where the trials of a cell come from.
pub(crate) enum TrialSource {
    /// They are simulated.
    Simulated {
        /// How a trial is made; drawn values are in the middle of their distributions.
        specification: Box<Specification>,
        /// How a trial with drawn values is made.
        drawn: Option<DrawnSettings>,
    },
    /// They are records.
    Measured(RecordSet),
}

/// What a trial with drawn values is made from.
pub(crate) struct DrawnSettings {
    draws: Vec<DrawnKey>,
    /// What the document of the cell says of how a trial is made.
    document: Table,
    name: String,
    folder: PathBuf,
}

/// How one trial is made.
pub struct TrialSpecification<'a> {
    /// The specification, whole.
    pub specification: Cow<'a, Specification>,
    /// Drawn values in the units of their keys, in the order of [`Scenario::draws`](crate::scenario::Scenario::draws).
    pub drawn: Vec<f64>,
}

/// Drawn values that make no trial.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error("{0}")]
pub struct Refusal(String);

impl DesignCell {
    fn new(points: &[&sweep::SweepPoint], methods: Vec<Method>, source: TrialSource) -> Self {
        let labels = points.iter().map(|point| point.label.clone()).collect();
        let values = points.iter().map(|point| point.value).collect();
        Self { labels, values, methods, source }
    }

    /// Whether one of its methods is a trace.
    pub fn traces(&self) -> bool {
        self.methods.iter().any(|method| matches!(method.procedure, Procedure::Trace(_)))
    }

    /// The records of a study of measured ones.
    pub fn record_set(&self) -> Option<&RecordSet> {
        match &self.source {
            TrialSource::Simulated { .. } => None,
            TrialSource::Measured(set) => Some(set),
        }
    }

    /// How its trials are simulated, where they are.
    fn specification(&self) -> Option<&Specification> {
        match &self.source {
            TrialSource::Simulated { specification, .. } => Some(specification),
            TrialSource::Measured(_) => None,
        }
    }

    /// Simulated records of each of its trials.
    pub fn records(&self) -> usize {
        self.specification().map_or(0, |own| 1 + own.also.len())
    }

    /// Manoeuvres of a simulated trial: that of its record, those of further ones, and the one that judges.
    pub fn manoeuvres(&self) -> Vec<&Manoeuvre> {
        let Some(Specification { simulation, also, validation, .. }) = self.specification() else { return Vec::new() };
        std::iter::once(simulation).chain(also).chain(validation).map(|made| &made.manoeuvre).collect()
    }

    /// Effects a first-order base lacks in its trials, as far as they are known.
    pub fn missing(&self) -> Vec<String> {
        self.specification().map_or_else(Vec::new, |own| own.missing.clone())
    }

    /// Whether its ship states what is right to say of it.
    pub(crate) fn states_physics(&self) -> bool {
        self.specification().is_some_and(|own| own.stated.is_some())
    }

    /// The physics that a first-order base lacks in its trials: as the ship states it, or effects of the list.
    pub(crate) fn physics(&self) -> Option<MissingPhysics> {
        let Specification { stated, missing, simulation, .. } = self.specification()?;
        let is_disturbed = simulation.sensors.rudder_noise != 0.0 || simulation.disturbances != Disturbances::default();
        stated.clone().or_else(|| MissingPhysics::of_effects(missing, is_disturbed))
    }

    /// Whether the ship is a first-order base with effects, so that its own K and T are not those of the first-order
    /// response nearest to it.
    pub fn has_own_indices(&self) -> bool {
        self.specification().is_some_and(|own| own.truth.is_none() && own.base.is_some())
    }

    /// Whether the ship is simulated and no first-order response, so that K and T of a method are held against those of
    /// the response nearest to it.
    pub fn is_nearest(&self) -> bool {
        self.specification().is_some_and(|own| own.truth.is_none())
    }

    /// Length and approach speed of the ship, where they are known; with drawn values those in the middle.
    pub fn particulars(&self) -> Option<Particulars> {
        match &self.source {
            TrialSource::Simulated { specification, .. } => specification.simulation.vessel.particulars(),
            TrialSource::Measured(set) => set.trials.iter().find_map(|trial| trial.particulars()),
        }
    }

    /// Whether its trials make an assumption.
    pub(crate) fn assumes(&self, assumption: Assumption) -> bool {
        self.specification().is_some_and(|own| assumption.holds(&own.simulation))
    }

    /// Labels of the points joined, or nothing when there is no axis.
    pub fn title(&self) -> String {
        self.labels.join(", ")
    }

    /// Whether all its trials have one specification.
    pub fn is_fixed(&self) -> bool {
        !matches!(self.source, TrialSource::Simulated { drawn: Some(_), .. })
    }

    /// How the trial of `key` is made.
    ///
    /// Fails when drawn values make no trial, which only a distribution without ends can do, and for measured records.
    pub fn specimen(&self, key: &StreamKey) -> Result<TrialSpecification<'_>, Refusal> {
        let TrialSource::Simulated { specification, drawn } = &self.source else {
            return Err(Refusal("the trials are measured records, and nothing is simulated".to_owned()));
        };
        let Some(drawn) = drawn else {
            return Ok(TrialSpecification { specification: Cow::Borrowed(&**specification), drawn: Vec::new() });
        };
        let values: Vec<f64> = drawn.draws.iter().map(|draw| draw.value(key)).collect();
        let specification = drawn.specification(&values).map_err(|problem| Refusal(problem.found))?;
        Ok(TrialSpecification { specification: Cow::Owned(specification), drawn: values })
    }
}

impl DrawnSettings {
    /// Draws for a cell, each tried in the middle and at the ends of its range, and the specification in the middle of
    /// all; `None` where nothing is drawn.
    ///
    /// Fails with the draw at fault and what is wrong with the trial.
    fn new(
        draws: &[DrawnKey],
        document: &Table,
        name: &str,
        folder: &Path,
    ) -> Result<Option<(Self, Specification)>, (usize, KeyFault)> {
        if draws.is_empty() {
            return Ok(None);
        }
        let attributed = |index: usize, problem: KeyFault| {
            let of_key = draws.iter().position(|draw| draw.key.is_related(&problem.key));
            (of_key.unwrap_or(index), problem)
        };
        let middle: Vec<f64> = draws.iter().map(DrawnKey::middle).collect();
        let document = only(document, &[ScenarioPart::Trial]);
        let drawn = Self { draws: draws.to_vec(), document, name: name.to_owned(), folder: folder.to_owned() };
        let specification = drawn.specification(&middle).map_err(|problem| attributed(0, problem))?;
        for (index, draw) in draws.iter().enumerate() {
            for value in draw.ends() {
                let mut values = middle.clone();
                values[index] = value;
                drawn.specification(&values).map_err(|problem| attributed(index, problem))?;
            }
        }
        Ok(Some((drawn, specification)))
    }

    /// The specification with these values.
    fn specification(&self, values: &[f64]) -> Result<Specification, KeyFault> {
        let mut document = self.document.clone();
        for (draw, &value) in self.draws.iter().zip(values) {
            sweep::set(&mut document, &draw.key, Value::Float(value))?;
        }
        let wire: ScenarioWire = reader::document(&document)?;
        resolve::specification(&wire, &self.name, &self.folder)
    }
}

/// Some parts of a document, and empty ones where a document needs more.
pub(crate) fn only(document: &Table, parts: &[ScenarioPart]) -> Table {
    let empty = [
        ("question", Value::String(String::new())),
        ("seed", Value::Integer(0)),
        ("identifier", Value::Array(Vec::new())),
    ];
    let mut some: Table = empty.into_iter().map(|(key, value)| (key.to_owned(), value)).collect();
    let kept = document.iter().filter(|(key, _)| parts.contains(&ScenarioPart::of(key)));
    some.extend(kept.map(|(key, value)| (key.clone(), value.clone())));
    some
}

/// What the points of a cell change.
fn settings<'a>(points: &'a [&sweep::SweepPoint]) -> impl DoubleEndedIterator<Item = &'a sweep::SweepSetting> {
    points.iter().flat_map(|point| &point.set)
}

/// A document with the keys of points changed.
fn changed(document: &Table, points: &[&sweep::SweepPoint]) -> Result<Table, KeyFault> {
    let mut changed = document.clone();
    settings(points).try_for_each(|setting| sweep::set(&mut changed, &setting.key, setting.value.clone()))?;
    Ok(changed)
}

/// The methods of a cell: those of the design, with settings of their own.
fn methods_of_cell(wires: &[IdentifierWire], design: &[Method]) -> Result<Vec<Method>, KeyFault> {
    let methods = methods(wires)?;
    if methods.iter().map(|method| &method.label).eq(design.iter().map(|method| &method.label)) {
        return Ok(methods);
    }
    Err(KeyFault::value(
        KeyPath::dotted("identifier"),
        "the methods are not the same in every cell",
        "expected settings of methods",
        "sweep settings only, and name every method once in an [[identifier]] of its own",
    ))
}

/// One cell of the design: what the document says of trials and methods, with the keys of its points changed, resolved
/// like any scenario.
pub(crate) fn swept(
    document: &Table,
    points: &[&sweep::SweepPoint],
    design: &[Method],
    name: &str,
    folder: &Path,
) -> Result<DesignCell, KeyFault> {
    let labels: Vec<&str> = points.iter().map(|point| point.label.as_str()).collect();
    let cell = (labels.len() > 1).then(|| labels.join(", "));
    // The point that sets the key at fault, or one above or below it; else the last point, which may only be one of
    // several.
    let attribute = |problem: KeyFault| {
        let of_key = settings(points).rfind(|setting| setting.key.is_related(&problem.key));
        match of_key.or_else(|| settings(points).next_back()) {
            Some(setting) => setting.attributed(problem, cell.as_deref()),
            None => problem,
        }
    };
    let changed = changed(document, points).map_err(attribute)?;
    let wire: ScenarioWire = reader::document(&changed).map_err(attribute)?;
    let specification = resolve::specification(&wire, name, folder).map_err(attribute)?;
    let methods = methods_of_cell(&wire.identifier, design).map_err(attribute)?;
    limits::entries("draw", wire.draw.len(), limits::MOST_DRAWS).map_err(attribute)?;
    let draws: Vec<DrawnKey> = wire
        .draw
        .iter()
        .enumerate()
        .map(|(index, draw)| draw.resolve(index))
        .collect::<Result<_, _>>()
        .map_err(|problem| if points.is_empty() { problem } else { attribute(problem) })?;
    let drawn = DrawnSettings::new(&draws, &changed, name, folder)
        .map_err(|(draw, problem)| draws[draw].attributed(problem, cell.as_deref()))?;
    let (drawn, specification) = match drawn {
        Some((drawn, specification)) => (Some(drawn), specification),
        None => (None, specification),
    };
    let source = TrialSource::Simulated { specification: Box::new(specification), drawn };
    Ok(DesignCell::new(points, methods, source))
}

/// One cell of a design of measured records: the document with the keys of its points changed.
///
/// Fails as the document alone would, at the point that is at fault; the document alone need not be whole.
pub(crate) fn measured(
    document: &Table,
    points: &[&sweep::SweepPoint],
    design: &[Method],
    folder: &Path,
) -> Result<DesignCell, KeyFault> {
    let attribute = |problem: KeyFault| match settings(points).rfind(|own| own.key.is_related(&problem.key)) {
        Some(setting) => setting.attributed(problem, None),
        None => problem,
    };
    let changed = changed(document, points).map_err(attribute)?;
    let wire: RecordStudyWire = reader::document(&changed).map_err(attribute)?;
    let set = RecordSet::read(&wire.records, folder).map_err(attribute)?;
    let methods = methods_of_cell(&wire.identifier, design).map_err(attribute)?;
    Ok(DesignCell::new(points, methods, TrialSource::Measured(set)))
}
