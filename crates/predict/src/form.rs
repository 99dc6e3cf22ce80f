//! Form for reporting manoeuvring data to IMO: entries with value, limit and source.
//!
//! An entry is measured if a record is of that manoeuvre, corrected if the record was made in ballast and two models
//! give the factor, and otherwise predicted. Undeclared data are reported as missing. The stopping trial is never
//! predicted: no model of this program has a propeller that goes astern.
//!
//! Source: MSC/Circ.1053 (2002), appendix 6; limits of MSC.137(76), 5.3.

mod record;
mod remarks;

pub use record::FormRecord;

pub use document::ImoFormEntry;
use serde_json::Value;
use ship::Particulars;
use simulate::{Manoeuvre, Side};
use trial::imo::CriterionUnit;
use trial::{DeclaredConditions, Loading};

use crate::imo::{IMO_LIMITS, ImoLimit};
use crate::interval::PredictionInterval;
use crate::prediction::Prediction;
use crate::replay::record_file;
use crate::standard;
use record::TestedManoeuvre;

/// Limit on the track reach of the stopping trial, ship lengths. Source: MSC.137(76), 5.3.4.
pub const MAX_TRACK_REACH_LENGTHS: f64 = 15.0;

/// Section of the form for the stopping trial.
pub const STOPPING_SECTION: &str = "stopping";

/// Maximum number of decimals of a result: no trial resolves a hundredth of a degree or of a ship length.
pub const MAX_DECIMALS: usize = 2;

/// Form of MSC/Circ.1053.
#[derive(Debug, Clone, PartialEq)]
pub struct ImoForm {
    /// Entries in the order of the form.
    pub entries: Vec<ImoFormEntry>,
    /// Remarks: unmet or unknown conditions, untested sides, records outside the form.
    pub remarks: Vec<String>,
}

/// Manoeuvres of the form, to both sides.
///
/// The initial turning is read from the 10/10 zig-zag. Source: MSC/Circ.1053 (2002), appendix 6.
pub fn form_manoeuvres() -> Vec<Manoeuvre> {
    standard::imo_manoeuvres().into_iter().flat_map(|kind| [kind.clone().with_first_side(Side::Port), kind]).collect()
}

/// Declarations of a file, with the length of the ship, m.
struct Declared<'a> {
    file: &'a str,
    form: &'a DeclaredConditions,
    length: Option<f64>,
}

const SHIP: &str = "ship data (full load)";
const TRIALS: &str = "trials data";

/// Name of the ratio L/V of the predictions.
const SCALE: &str = "L/V";

/// Section, name, unit and value of a declared entry.
type Field = (&'static str, &'static str, &'static str, fn(&Declared) -> Option<Value>);

const FIELDS: [Field; 17] = [
    ("", "administration", "", |ship| text(&ship.form.administration)),
    (SHIP, "ship type", "", |ship| text(&ship.form.ship_type)),
    (SHIP, SCALE, "s", |_| None),
    (SHIP, "L/B", "1", |ship| number(ship.length? / ship.form.beam?)),
    (SHIP, "B/T", "1", |ship| number(ship.form.beam? / ship.form.draught_at_full_load()?)),
    (SHIP, "block coefficient", "1", |ship| number(ship.form.block_coefficient?)),
    (SHIP, "rudder type", "", |ship| text(&ship.form.rudder_type)),
    (SHIP, "total rudder area/LT", "1", |ship| {
        number(ship.form.rudder_area? / (ship.length? * ship.form.draught_at_full_load()?))
    }),
    (SHIP, "number of rudders", "1", |ship| number(ship.form.rudders?)),
    (SHIP, "propeller type", "", |ship| text(&ship.form.propeller_type)),
    (SHIP, "number of propellers", "1", |ship| number(ship.form.propellers?)),
    (SHIP, "trim (by the stern)", "m", |ship| number(ship.form.trim?)),
    (SHIP, "engine type", "", |ship| text(&ship.form.engine_type)),
    (SHIP, "ballast condition", "", |ship| text(&ship.form.ballast)),
    (TRIALS, "water depth/trial draught", "1", |ship| number(ship.form.depth_in_draughts()?)),
    (TRIALS, "wind: Beaufort number", "1", |ship| number(ship.form.wind_beaufort?)),
    (TRIALS, "wave: sea state", "1", |ship| number(ship.form.sea_state?)),
];

fn text(declared: &Option<String>) -> Option<Value> {
    declared.clone().map(Value::from)
}

fn number(value: impl Into<f64>) -> Option<Value> {
    Some(Value::from(value.into()))
}

/// Entry with a single value; a missing value is reported in its source.
fn entry(section: &str, field: &str, unit: &str, value: Option<Value>, source: String) -> ImoFormEntry {
    let source = if value.is_some() { source } else { String::from("not in the records") };
    ImoFormEntry {
        section: section.into(),
        field: field.into(),
        unit: unit.into(),
        value,
        source,
        ..ImoFormEntry::default()
    }
}

/// Fills in the form from records, declarations and predictions.
///
/// `particulars` are at the scale of the predictions; their L/V sets the limits of the 10/10 zig-zag. `models` names
/// the source of the predictions. Declarations of the ship come from the first record that has them; `declared` are
/// declarations without a record, from a file.
pub fn fill_form<'a>(
    predictions: &[Prediction],
    particulars: Option<Particulars>,
    models: &str,
    records: &[FormRecord<'a>],
    declared: Option<(&'a str, &'a DeclaredConditions)>,
) -> ImoForm {
    let tested: Vec<TestedManoeuvre> = records.iter().map(TestedManoeuvre::from_record).collect();
    let length = |particulars: Option<Particulars>| particulars.map(|ship| ship.length);
    let of_record = |FormRecord { trial, .. }: &FormRecord<'a>| {
        let form = trial.conditions();
        Declared { file: record_file(trial), form, length: length(form.particulars.or(trial.particulars())) }
    };
    let of_file =
        |(file, form): (&'a str, &'a DeclaredConditions)| Declared { file, form, length: length(form.particulars) };
    let declarations: Vec<Declared> = records.iter().map(of_record).chain(declared.map(of_file)).collect();
    let scale = if predictions.is_empty() { "scale of the records" } else { "scale of the prediction" };
    let field = |&(section, name, unit, value): &Field| {
        let declared = declarations.iter().find_map(|d| Some((format!("declared with {}", d.file), value(d)?)));
        let ratio = particulars.filter(|_| name == SCALE).map(|ship| Value::from(ship.length / ship.speed));
        let (source, value) = declared.or_else(|| Some((scale.into(), ratio?))).unzip();
        entry(section, name, unit, value, source.unwrap_or_default())
    };
    let mut entries: Vec<ImoFormEntry> = FIELDS.iter().map(field).collect();
    entries.push(loading(&tested));
    // The order of the form.
    for limit in [4, 5, 1, 2, 3, 0].map(|place: usize| &IMO_LIMITS[place]) {
        for side in ["port", "starboard"] {
            let from_record = measured(limit, side, &tested);
            entries.push(ImoFormEntry {
                section: limit.section.into(),
                field: limit.field.into(),
                side: Some(side.into()),
                unit: if limit.unit == CriterionUnit::Degrees { "deg" } else { "ship lengths" }.into(),
                limit: (limit.value)(particulars),
                ..from_record.unwrap_or_else(|| predicted(limit, side, predictions, particulars, models))
            });
        }
    }
    entries.push(ImoFormEntry {
        limit: Some(MAX_TRACK_REACH_LENGTHS),
        source: "never predicted: no model of this program goes astern; measure the stopping trial".into(),
        ..entry(STOPPING_SECTION, "track reach", "ship lengths", None, String::new())
    });
    let mut remarks = remarks::remarks(&tested, declared, particulars);
    if entries.iter().any(|entry| entry.extrapolated.is_some()) {
        remarks.push(String::from(
            "predicted entries apply to the loading, the water depth and the weather of the records that the models were \
             fitted to, which the models do not state; they do not replace a trial",
        ));
    }
    if entries.iter().any(|entry| entry.extrapolated == Some(true)) {
        remarks.push(String::from("extrapolated entries are beyond the rudder or the yaw rate of those records"));
    }
    ImoForm { entries, remarks }
}

/// Value and source of a characteristic that a record shows: a record at full load or with a correction is preferred to
/// a record at partial load. `None` if no record shows it.
fn measured(limit: &ImoLimit, side: &str, tested: &[TestedManoeuvre]) -> Option<ImoFormEntry> {
    let show = |tested: &TestedManoeuvre| {
        let (record, quantity) = (tested.record, tested.figure(limit.figure)?);
        let file = record_file(record.trial);
        let corrected = record.correction.and_then(|all| Some((all, all.figures.get(limit.figure)?)));
        if let Some((correction, figure)) = corrected {
            let is_doubtful = !(figure.warnings.is_empty() && correction.warnings.is_empty());
            let doubt = if is_doubtful { "; see the remarks" } else { "" };
            let source = format!(
                "measured at partial load, {file}, and corrected by F/B = {} {}, 90 % {}{doubt}",
                fixed(figure.factor.median, decimals(&figure.factor)),
                range(&figure.factor),
                range(&figure.corrected),
            );
            return Some((false, of_interval(&figure.corrected, source)));
        }
        let is_partial = record.loading() == Some(Loading::Partial);
        let load = if is_partial { ", at partial load, not corrected" } else { "" };
        let sd = quantity.sd.map_or_else(String::new, |sd| match sd < 1.0 {
            true => format!(" ± {}", ship::ShortNumber::rounded(sd, 1)),
            false => format!(" ± {sd:.0}"),
        });
        let source = format!("measured, {file}{sd}{load}");
        Some((
            is_partial,
            ImoFormEntry { value: number(quantity.value), sd: quantity.sd, source, ..ImoFormEntry::default() },
        ))
    };
    let entries = tested.iter().filter(|tested| tested.matches(limit.manoeuvre, side)).filter_map(show);
    entries.min_by_key(|(is_partial, _)| *is_partial).map(|(_, entry)| entry)
}

/// Value and source of a predicted characteristic.
fn predicted(
    limit: &ImoLimit,
    side: &str,
    predictions: &[Prediction],
    particulars: Option<Particulars>,
    models: &str,
) -> ImoFormEntry {
    let missing = |why: &str| ImoFormEntry { source: why.into(), ..ImoFormEntry::default() };
    let kind: Manoeuvre = limit.manoeuvre.parse().expect("the name of a manoeuvre");
    let kind = if side == "port" { kind.with_first_side(Side::Port) } else { kind };
    let Some(prediction) = predictions.iter().find(|prediction| prediction.kind == kind) else {
        return missing(match predictions {
            [] => "not measured; `study predict --form` predicts it",
            _ => "too few drawn ships complete the manoeuvre",
        });
    };
    let Some(figure) = prediction.figures.get(limit.figure) else {
        return missing("needs the length of the ship and a model of her speed and drift");
    };
    let passing = (limit.value)(particulars).map(|limit| figure.share_within(limit));
    let beyond = if figure.extrapolated { ", extrapolated" } else { "" };
    let pass = passing.map_or_else(String::new, |share| format!("; {:.0} % pass", 100.0 * share));
    let source = format!("predicted from {models}, 90 % {}{beyond}{pass}", range(&figure.interval));
    ImoFormEntry {
        extrapolated: Some(figure.extrapolated),
        probability_of_passing: passing,
        ..of_interval(&figure.interval, source)
    }
}

fn of_interval(interval: &PredictionInterval, source: String) -> ImoFormEntry {
    ImoFormEntry { median: Some(interval.median), ci90: Some(interval.ci90), source, ..ImoFormEntry::default() }
}

/// Number of decimals of an entry.
fn decimals(interval: &PredictionInterval) -> usize {
    interval.decimals().min(MAX_DECIMALS)
}

/// Number with a minus sign, and without a sign before a zero.
fn fixed(value: f64, decimals: usize) -> String {
    let text = format!("{value:.decimals$}");
    match text.strip_prefix('-') {
        Some(digits) if digits.bytes().all(|byte| matches!(byte, b'0' | b'.')) => digits.to_owned(),
        Some(digits) => format!("−{digits}"),
        None => text,
    }
}

/// Text of the 90 % interval.
fn range(interval: &PredictionInterval) -> String {
    let [low, high] = interval.ci90.map(|end| fixed(end, decimals(interval)));
    format!("[{low}, {high}]")
}

/// Loading of the ship in her tests.
fn loading(tested: &[TestedManoeuvre]) -> ImoFormEntry {
    let used: Vec<FormRecord> = tested.iter().filter(|test| test.manoeuvre.is_some()).map(|test| test.record).collect();
    let any = |is: fn(&FormRecord) -> bool| used.iter().any(is);
    let is_partial = |record: &FormRecord| record.correction.is_none() && record.loading() == Some(Loading::Partial);
    let statements = [
        (any(|record| record.loading() == Some(Loading::Full)), "tested at full load"),
        (any(|record| record.correction.is_some()), "tested at partial load and corrected"),
        (any(is_partial), "tested at partial load, not corrected"),
        (used.is_empty(), "not tested: every result is predicted"),
    ];
    let texts: Vec<&str> = statements.into_iter().filter(|(holds, _)| *holds).map(|(_, text)| text).collect();
    let value = (!texts.is_empty()).then(|| Value::from(texts.join("; ")));
    entry("manoeuvring data", "loading condition", "", value, "from the records given".into())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::correction;
    use crate::mixture::ShipMixture;
    use crate::testing;
    use document::identified_ship::IdentifiedShip;
    use ship::angle::from_deg;
    use trial::Trial;

    fn record(mixture: &ShipMixture, kind: &str, conditions: DeclaredConditions) -> Trial {
        let trial = testing::record(mixture, kind, 0, from_deg(0.05), 0.5);
        trial.with_particulars(mixture.particulars().expect("made up")).with_conditions(conditions)
    }

    fn predictions(mixture: &ShipMixture) -> Vec<Prediction> {
        form_manoeuvres().iter().map(|kind| mixture.predict(kind, 60, false).expect("sails")).collect()
    }

    fn entry<'a>(form: &'a ImoForm, section: &str, name: &str, side: Option<&str>) -> &'a ImoFormEntry {
        let is_it = |entry: &&ImoFormEntry| {
            entry.section.contains(section) && entry.field == name && entry.side.as_deref() == side
        };
        form.entries.iter().find(is_it).unwrap_or_else(|| panic!("{section} {name}: {form:?}"))
    }

    fn calm(loading: Loading) -> DeclaredConditions {
        DeclaredConditions {
            ship_type: Some("training ship".into()),
            beam: Some(15.0),
            draught: Some(5.0),
            particulars: Some(Particulars { length: 75.0, speed: 6.0 }),
            full_load_draught: Some(5.0),
            rudder_area: Some(7.5),
            water_depth: Some(60.0),
            wind_beaufort: Some(2),
            sea_state: Some(6),
            declared_loading: Some(loading),
            ..DeclaredConditions::default()
        }
    }

    #[test]
    fn manoeuvres_go_to_both_sides() {
        let names: Vec<String> = form_manoeuvres().iter().map(Manoeuvre::to_string).collect();
        let expected = ["zig-zag -10/10", "zig-zag 10/10", "zig-zag -20/20", "zig-zag 20/20"];
        assert_eq!(names[..4], expected);
        assert_eq!(names[4..], ["turning-circle -35", "turning-circle 35"]);
    }

    #[test]
    fn a_trial_at_partial_load_is_corrected_or_reported() {
        let [full, ballast]: [IdentifiedShip; 2] = std::array::from_fn(|_| testing::identified_ship());
        let [full, ballast] = [(full, 0.9), (ballast, 1.0)].map(|(mut ship, gain)| {
            ship.members[0].parameters[1] *= gain;
            testing::mixture(ship)
        });
        let trial = record(&ballast, "zig-zag:20/20", calm(Loading::Partial));
        let correction =
            correction::correct_to_loading(&full, &ballast, &trial, correction::FULL_LOAD, 60).expect("both sail");
        let all = predictions(&full);
        let with = |correction| {
            fill_form(&all, full.particulars(), "", &[FormRecord { trial: &trial, correction, current: None }], None)
        };
        let of = |form: &ImoForm| entry(form, "20°/20°", "1st overshoot angle", Some("starboard")).clone();
        let corrected = of(&with(Some(&correction)));
        assert!(corrected.source.contains("corrected by F/B = 0."), "{corrected:?}");
        let form = with(Some(&correction));
        let loading = &entry(&form, "manoeuvring", "loading condition", None).value;
        assert_eq!(loading, &Some("tested at partial load and corrected".into()));
        let plain = with(None);
        assert!(of(&plain).source.contains("at partial load, not corrected"), "{:?}", of(&plain));
        assert!(plain.remarks.iter().any(|remark| remark.contains("--ballast")), "{:?}", plain.remarks);
    }

    /// A record of another manoeuvre gives a remark and no entry.
    #[test]
    fn other_manoeuvres_are_reported() {
        let ship = testing::mixture(testing::identified_ship());
        let remarks = |kind: &str| {
            let trial = record(&ship, kind, DeclaredConditions::default());
            let form = fill_form(
                &predictions(&ship),
                ship.particulars(),
                "",
                &[FormRecord { trial: &trial, correction: None, current: None }],
                None,
            );
            let measured = |entry: &ImoFormEntry| entry.source.starts_with("measured");
            assert!(!form.entries.iter().any(measured), "{kind}");
            form.remarks.join("\n")
        };
        let circle = remarks("turning-circle:15");
        assert!(
            circle.contains("15.0° of rudder") && circle.contains("those of a ship of 75.00 m at 6.00 m/s"),
            "{circle}"
        );
        assert!(remarks("zig-zag:10/20").contains("a zig-zag of 10/20"));
        let declared = DeclaredConditions { ship_type: Some("ferry".into()), ..DeclaredConditions::default() };
        let form = fill_form(&predictions(&ship), None, "", &[], Some(("ship.toml", &declared)));
        assert_eq!(entry(&form, "ship", "ship type", None).value, Some("ferry".into()));
        assert_eq!(entry(&form, "ship", "L/V", None).value, None);
        assert_eq!(entry(&form, "10°/10°", "1st overshoot angle", Some("port")).limit, None);
    }
}
