//! Cells of a design: the specification of their trials, sampled values included, and their methods.

use std::borrow::Cow;
use std::path::{Path, PathBuf};

use ship::Particulars;
use simulate::{Assumption, Disturbances, Manoeuvre, StreamKey};
use toml::{Table, Value};

use crate::scenario::draw::SampledKey;
use crate::scenario::method::{IdentifierWire, Method, Procedure, methods};
use crate::scenario::part::ScenarioPart;
use crate::scenario::physics::MissingPhysics;
use crate::scenario::problem::{KeyFault, KeyPath};
use crate::scenario::records::{RecordScenarioWire, RecordSet};
use crate::scenario::specification::Specification;
use crate::scenario::wire::ScenarioWire;
use crate::scenario::{limits, reader, resolve, sweep};

/// Cell of a design: trials of one distribution, and the methods that are applied to them.
pub struct DesignCell {
    /// Labels of the points, one per axis.
    pub labels: Vec<String>,
    /// Values of the points, one per axis; `None` on an axis of labels.
    pub values: Vec<Option<f64>>,
    /// Methods, all on the same trial.
    pub methods: Vec<Method>,
    /// Source of the trials.
    pub(crate) source: TrialSource,
}

/// Source of the trials of a cell.
pub(crate) enum TrialSource {
    /// Trials simulated from a specification.
    Simulated {
        /// Specification of a trial, with random values at the middle of their distributions.
        specification: Box<Specification>,
        /// Template for trials with sampled values; `None` if no key is sampled.
        drawn: Option<DrawnSettings>,
    },
    /// Measured records.
    Measured(RecordSet),
}

/// Template of trials with sampled values.
pub(crate) struct DrawnSettings {
    draws: Vec<SampledKey>,
    /// Part of the document that specifies a trial.
    document: Table,
    name: String,
    folder: PathBuf,
}

/// Specification of one trial, with its sampled values.
pub struct SampledSpecification<'a> {
    /// Complete specification.
    pub specification: Cow<'a, Specification>,
    /// Sampled values in the units of their keys, in the order of
    /// [`Scenario::drawn_keys`](crate::scenario::Scenario::drawn_keys).
    pub drawn: Vec<f64>,
}

/// Error of sampled values with which no trial can be simulated.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error("{0}")]
pub struct InvalidSample(String);

impl DesignCell {
    fn new(points: &[&sweep::SweepPoint], methods: Vec<Method>, source: TrialSource) -> Self {
        let labels = points.iter().map(|point| point.label.clone()).collect();
        let values = points.iter().map(|point| point.value).collect();
        Self { labels, values, methods, source }
    }

    /// `true` if one of its methods is a trace.
    pub fn is_traced(&self) -> bool {
        self.methods.iter().any(|method| matches!(method.procedure, Procedure::Trace(_)))
    }

    /// Records of a cell of measured records; `None` for simulated trials.
    pub fn record_set(&self) -> Option<&RecordSet> {
        match &self.source {
            TrialSource::Simulated { .. } => None,
            TrialSource::Measured(set) => Some(set),
        }
    }

    /// Specification of simulated trials; `None` for measured records.
    fn specification(&self) -> Option<&Specification> {
        match &self.source {
            TrialSource::Simulated { specification, .. } => Some(specification),
            TrialSource::Measured(_) => None,
        }
    }

    /// Number of simulated records per trial, without the validation; 0 for measured records.
    pub fn record_count(&self) -> usize {
        self.specification().map_or(0, |spec| 1 + spec.further_simulations.len())
    }

    /// Manoeuvres of a simulated trial: of its record, of further records, and of the validation; empty for measured
    /// records.
    pub fn manoeuvres(&self) -> Vec<&Manoeuvre> {
        let Some(Specification { simulation, further_simulations: further, validation, .. }) = self.specification()
        else {
            return Vec::new();
        };
        std::iter::once(simulation).chain(further).chain(validation).map(|run| &run.manoeuvre).collect()
    }

    /// Identifiers of the effects missing from a first-order base in its trials.
    pub fn missing_effects(&self) -> Vec<String> {
        self.specification().map_or_else(Vec::new, |spec| spec.missing_effects.clone())
    }

    /// `true` if its ship states the missing physics.
    pub(crate) fn states_physics(&self) -> bool {
        self.specification().is_some_and(|spec| spec.stated_physics.is_some())
    }

    /// Physics that a first-order base lacks in its trials: as stated in the scenario, or from its listed effects;
    /// `None` for measured records, and if neither determines it.
    pub(crate) fn physics(&self) -> Option<MissingPhysics> {
        let Specification { stated_physics: stated, missing_effects: missing, simulation, .. } =
            self.specification()?;
        let is_disturbed = simulation.sensors.rudder_noise != 0.0 || simulation.disturbances != Disturbances::default();
        stated.clone().or_else(|| MissingPhysics::from_effects(missing, is_disturbed))
    }

    /// `true` for a response ship with effects, whose first-order base differs from the nearest first-order response.
    pub fn is_base_with_effects(&self) -> bool {
        self.specification().is_some_and(|spec| spec.true_response.is_none() && spec.base_response.is_some())
    }

    /// `true` for a simulated ship that is not first order, so that K and T are compared with the nearest response.
    pub fn is_compared_with_nearest(&self) -> bool {
        self.specification().is_some_and(|spec| spec.true_response.is_none())
    }

    /// Length and approach speed of the ship, if known; for random values at the middle of their distributions.
    pub fn particulars(&self) -> Option<Particulars> {
        match &self.source {
            TrialSource::Simulated { specification, .. } => specification.simulation.ship.particulars(),
            TrialSource::Measured(set) => set.trials.iter().find_map(|trial| trial.particulars()),
        }
    }

    /// `true` if its trials make an assumption.
    pub(crate) fn assumes(&self, assumption: Assumption) -> bool {
        self.specification().is_some_and(|spec| assumption.is_made_by(&spec.simulation))
    }

    /// Labels of the points joined by commas; empty without axes.
    pub fn title(&self) -> String {
        self.labels.join(", ")
    }

    /// `true` if all its trials share one specification.
    pub fn is_fixed(&self) -> bool {
        !matches!(self.source, TrialSource::Simulated { drawn: Some(_), .. })
    }

    /// Specification of the trial of `key`.
    ///
    /// Fails for measured records, and for sampled values that specify no trial, possible for unbounded distributions
    /// only.
    pub fn trial_spec(&self, key: &StreamKey) -> Result<SampledSpecification<'_>, InvalidSample> {
        let TrialSource::Simulated { specification, drawn } = &self.source else {
            return Err(InvalidSample("the trials are measured records, and nothing is simulated".to_owned()));
        };
        let Some(drawn) = drawn else {
            return Ok(SampledSpecification { specification: Cow::Borrowed(&**specification), drawn: Vec::new() });
        };
        let values: Vec<f64> = drawn.draws.iter().map(|draw| draw.sample(key)).collect();
        let specification = drawn.specification(&values).map_err(|fault| InvalidSample(fault.problem))?;
        Ok(SampledSpecification { specification: Cow::Owned(specification), drawn: values })
    }
}

impl DrawnSettings {
    /// Template of a cell with the specification at the middle of all draws; `None` without draws. Each draw is checked
    /// at the middle and at the ends of its range.
    ///
    /// Fails with the index of the faulty draw and the fault.
    fn new(
        draws: &[SampledKey],
        document: &Table,
        name: &str,
        folder: &Path,
    ) -> Result<Option<(Self, Specification)>, (usize, KeyFault)> {
        if draws.is_empty() {
            return Ok(None);
        }
        let attributed = |index: usize, fault: KeyFault| {
            let of_key = draws.iter().position(|draw| draw.key.is_related(&fault.key));
            (of_key.unwrap_or(index), fault)
        };
        let middle: Vec<f64> = draws.iter().map(SampledKey::median_value).collect();
        let document = select_parts(document, &[ScenarioPart::Trial]);
        let drawn = Self { draws: draws.to_vec(), document, name: name.to_owned(), folder: folder.to_owned() };
        let specification = drawn.specification(&middle).map_err(|fault| attributed(0, fault))?;
        for (index, draw) in draws.iter().enumerate() {
            for value in draw.range_ends() {
                let mut values = middle.clone();
                values[index] = value;
                drawn.specification(&values).map_err(|fault| attributed(index, fault))?;
            }
        }
        Ok(Some((drawn, specification)))
    }

    /// Specification of a trial in which the drawn keys have these values, one per draw.
    fn specification(&self, values: &[f64]) -> Result<Specification, KeyFault> {
        let mut document = self.document.clone();
        for (draw, &value) in self.draws.iter().zip(values) {
            sweep::set_key(&mut document, &draw.key, Value::Float(value))?;
        }
        let wire: ScenarioWire = reader::read_document(&document)?;
        resolve::trial_specification(&wire, &self.name, &self.folder)
    }
}

/// Selected parts of a document, with empty values for other required keys.
pub(crate) fn select_parts(document: &Table, parts: &[ScenarioPart]) -> Table {
    let empty = [
        ("question", Value::String(String::new())),
        ("seed", Value::Integer(0)),
        ("identifier", Value::Array(Vec::new())),
    ];
    let mut some: Table = empty.into_iter().map(|(key, value)| (key.to_owned(), value)).collect();
    let kept = document.iter().filter(|(key, _)| parts.contains(&ScenarioPart::from_key(key)));
    some.extend(kept.map(|(key, value)| (key.clone(), value.clone())));
    some
}

/// Keys and values that the points of a cell set, in the order of the axes.
fn settings<'a>(points: &'a [&sweep::SweepPoint]) -> impl DoubleEndedIterator<Item = &'a sweep::SweepSetting> {
    points.iter().flat_map(|point| &point.set)
}

/// Document with the settings of points applied.
fn changed(document: &Table, points: &[&sweep::SweepPoint]) -> Result<Table, KeyFault> {
    let mut changed = document.clone();
    settings(points).try_for_each(|setting| sweep::set_key(&mut changed, &setting.key, setting.value.clone()))?;
    Ok(changed)
}

/// Methods of a cell. Fails unless their labels equal the labels of the design.
fn methods_of_cell(wires: &[IdentifierWire], design: &[Method]) -> Result<Vec<Method>, KeyFault> {
    let methods = methods(wires)?;
    if methods.iter().map(|method| &method.label).eq(design.iter().map(|method| &method.label)) {
        return Ok(methods);
    }
    Err(KeyFault::value(
        KeyPath::from_dotted("identifier"),
        "the methods are not the same in every cell",
        "expected the same labels in every cell",
        "sweep only settings of methods, and give every method one [[identifier]]",
    ))
}

/// One cell of simulated trials: the document with the settings of its points, resolved as a scenario.
pub(crate) fn simulated_cell(
    document: &Table,
    points: &[&sweep::SweepPoint],
    design: &[Method],
    name: &str,
    folder: &Path,
) -> Result<DesignCell, KeyFault> {
    let labels: Vec<&str> = points.iter().map(|point| point.label.as_str()).collect();
    let cell = (labels.len() > 1).then(|| labels.join(", "));
    // The point that sets the faulty key, or a key above or below it; otherwise the last point.
    let attribute = |fault: KeyFault| {
        let of_key = settings(points).rfind(|setting| setting.key.is_related(&fault.key));
        match of_key.or_else(|| settings(points).next_back()) {
            Some(setting) => setting.attributed(fault, cell.as_deref()),
            None => fault,
        }
    };
    let changed = changed(document, points).map_err(attribute)?;
    let wire: ScenarioWire = reader::read_document(&changed).map_err(attribute)?;
    let specification = resolve::trial_specification(&wire, name, folder).map_err(attribute)?;
    let methods = methods_of_cell(&wire.identifier, design).map_err(attribute)?;
    limits::check_count("draw", wire.draw.len(), limits::MAX_DRAW_ENTRIES).map_err(attribute)?;
    let draws: Vec<SampledKey> = wire
        .draw
        .iter()
        .enumerate()
        .map(|(index, draw)| draw.resolve(index))
        .collect::<Result<_, _>>()
        .map_err(|fault| if points.is_empty() { fault } else { attribute(fault) })?;
    let drawn = DrawnSettings::new(&draws, &changed, name, folder)
        .map_err(|(draw, fault)| draws[draw].attributed(fault, cell.as_deref()))?;
    let (drawn, specification) = match drawn {
        Some((drawn, specification)) => (Some(drawn), specification),
        None => (None, specification),
    };
    let source = TrialSource::Simulated { specification: Box::new(specification), drawn };
    Ok(DesignCell::new(points, methods, source))
}

/// One cell of measured records: the document with the settings of its points.
///
/// Fails at the faulty point; the document without the points may be incomplete.
pub(crate) fn measured_cell(
    document: &Table,
    points: &[&sweep::SweepPoint],
    design: &[Method],
    folder: &Path,
) -> Result<DesignCell, KeyFault> {
    let attribute = |fault: KeyFault| match settings(points).rfind(|setting| setting.key.is_related(&fault.key)) {
        Some(setting) => setting.attributed(fault, None),
        None => fault,
    };
    let changed = changed(document, points).map_err(attribute)?;
    let wire: RecordScenarioWire = reader::read_document(&changed).map_err(attribute)?;
    let set = RecordSet::read(&wire.records, folder).map_err(attribute)?;
    let methods = methods_of_cell(&wire.identifier, design).map_err(attribute)?;
    Ok(DesignCell::new(points, methods, TrialSource::Measured(set)))
}
