//! The form for reporting manoeuvring data to IMO: every entry with its value, its limit and where it comes from.
//!
//! An entry is measured where a record is that very manoeuvre, corrected where the record was made in ballast and two
//! models tell the factor, predicted otherwise. What nobody declared is said to be missing; nothing is guessed. The
//! stopping trial is never predicted: no model of this program has a propeller that goes astern.
//!
//! Source: MSC/Circ.1053 (2002), appendix 6; limits of MSC.137(76), 5.3.

mod record;
mod remarks;

pub use record::FormRecord;

pub use document::ImoFormEntry;
use serde_json::Value;
use ship::Particulars;
use simulate::{Manoeuvre, Side};
use trial::imo::Unit;
use trial::{Conditions, Loading};

use crate::imo::{LIMITS, Limit};
use crate::interval::PredictionInterval;
use crate::prediction::Prediction;
use crate::replay::file_of;
use crate::standard;
use record::TestedManoeuvre;

/// Longest track reach of the stopping trial, ship lengths. Source: MSC.137(76), 5.3.4.
pub const TRACK_REACH_LENGTHS: f64 = 15.0;

/// Section of the stopping trial.
pub const STOPPING: &str = "stopping";

/// Most decimals of a result: no trial tells a hundredth of a degree or of a ship length.
pub const DECIMALS: usize = 2;

/// The form.
#[derive(Debug, Clone, PartialEq)]
pub struct Form {
    /// Entries in the order of the form.
    pub entries: Vec<ImoFormEntry>,
    /// Conditions that are not met or not known, and what else is to be said.
    pub remarks: Vec<String>,
}

/// The manoeuvres of the form, to both sides.
///
/// The initial turning is that of the 10/10 zig-zag. Source: MSC/Circ.1053 (2002), appendix 6.
pub fn manoeuvres() -> Vec<Manoeuvre> {
    standard::of_imo().into_iter().flat_map(|kind| [kind.clone().to(Side::Port), kind]).collect()
}

/// What a file declares, with the length of the ship, m.
struct Declared<'a> {
    file: &'a str,
    form: &'a Conditions,
    length: Option<f64>,
}

const SHIP: &str = "ship data (full load)";
const TRIALS: &str = "trials data";

/// Ratio L/V, which is that of the predictions.
const SCALE: &str = "L/V";

/// Section, name, unit and value of what is declared.
type Field = (&'static str, &'static str, &'static str, fn(&Declared) -> Option<Value>);

const FIELDS: [Field; 17] = [
    ("", "administration", "", |own| words(&own.form.administration)),
    (SHIP, "ship type", "", |own| words(&own.form.ship_type)),
    (SHIP, SCALE, "s", |_| None),
    (SHIP, "L/B", "1", |own| number(own.length? / own.form.beam?)),
    (SHIP, "B/T", "1", |own| number(own.form.beam? / own.form.draught_at_full_load()?)),
    (SHIP, "block coefficient", "1", |own| number(own.form.block_coefficient?)),
    (SHIP, "rudder type", "", |own| words(&own.form.rudder_type)),
    (SHIP, "total rudder area/LT", "1", |own| {
        number(own.form.rudder_area? / (own.length? * own.form.draught_at_full_load()?))
    }),
    (SHIP, "number of rudders", "1", |own| number(own.form.rudders?)),
    (SHIP, "propeller type", "", |own| words(&own.form.propeller_type)),
    (SHIP, "number of propellers", "1", |own| number(own.form.propellers?)),
    (SHIP, "trim (by the stern)", "m", |own| number(own.form.trim?)),
    (SHIP, "engine type", "", |own| words(&own.form.engine_type)),
    (SHIP, "ballast condition", "", |own| words(&own.form.ballast)),
    (TRIALS, "water depth/trial draught", "1", |own| number(own.form.depth_in_draughts()?)),
    (TRIALS, "wind: Beaufort number", "1", |own| number(own.form.wind_beaufort?)),
    (TRIALS, "wave: sea state", "1", |own| number(own.form.sea_state?)),
];

fn words(words: &Option<String>) -> Option<Value> {
    words.clone().map(Value::from)
}

fn number(value: impl Into<f64>) -> Option<Value> {
    Some(Value::from(value.into()))
}

/// An entry of one value; without one its source says that it is missing.
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

/// Fills in the form.
///
/// `particulars` are the scale of the predictions, whose L/V decides the limits of the 10/10 zig-zag; `models` is what
/// their source is called. What is declared of the ship is that of the first record that says it; `declared` are such
/// words without a record, from a file.
pub fn fill<'a>(
    predictions: &[Prediction],
    particulars: Option<Particulars>,
    models: &str,
    records: &[FormRecord<'a>],
    declared: Option<(&'a str, &'a Conditions)>,
) -> Form {
    let tested: Vec<TestedManoeuvre> = records.iter().map(TestedManoeuvre::of).collect();
    let of_record = |FormRecord { trial, .. }: &FormRecord<'a>| {
        let own = trial.conditions().particulars.or(trial.particulars());
        Declared { file: file_of(trial), form: trial.conditions(), length: own.map(|own| own.length) }
    };
    let of_file = declared.map(|(file, form)| Declared { file, form, length: form.particulars.map(|own| own.length) });
    let said: Vec<Declared> = records.iter().map(of_record).chain(of_file).collect();
    let scale = if predictions.is_empty() { "scale of the records" } else { "scale of the prediction" };
    let field = |&(section, name, unit, of): &Field| {
        let found = said.iter().find_map(|own| Some((format!("declared with {}", own.file), of(own)?)));
        let ratio = particulars.filter(|_| name == SCALE).map(|own| Value::from(own.length / own.speed));
        let (source, value) = found.or_else(|| Some((scale.into(), ratio?))).unzip();
        entry(section, name, unit, value, source.unwrap_or_default())
    };
    let mut entries: Vec<ImoFormEntry> = FIELDS.iter().map(field).collect();
    entries.push(loading(&tested));
    // The order of the form.
    for limit in [4, 5, 1, 2, 3, 0].map(|place: usize| &LIMITS[place]) {
        for side in ["port", "starboard"] {
            let found = measured(limit, side, &tested);
            entries.push(ImoFormEntry {
                section: limit.section.into(),
                field: limit.field.into(),
                side: Some(side.into()),
                unit: if limit.unit == Unit::Degrees { "deg" } else { "ship lengths" }.into(),
                limit: (limit.of)(particulars),
                ..found.unwrap_or_else(|| predicted(limit, side, predictions, particulars, models))
            });
        }
    }
    entries.push(ImoFormEntry {
        limit: Some(TRACK_REACH_LENGTHS),
        source: "never predicted: no model of this program goes astern; stop the ship and measure".into(),
        ..entry(STOPPING, "track reach", "ship lengths", None, String::new())
    });
    let mut remarks = remarks::remarks(&tested, declared, particulars);
    if entries.iter().any(|entry| entry.extrapolated.is_some()) {
        remarks.push(String::from(
            "predicted entries hold for the loading, the water depth and the weather of the records that the models were \
             fitted to, which a model does not say; they are no trial",
        ));
    }
    if entries.iter().any(|entry| entry.extrapolated == Some(true)) {
        remarks.push(String::from("extrapolated entries are beyond the rudder or the yaw rate of those records"));
    }
    Form { entries, remarks }
}

/// Value and source of a figure that a record shows: what needs no correction, or has one, goes before what was made at
/// partial load.
fn measured(limit: &Limit, side: &str, tested: &[TestedManoeuvre]) -> Option<ImoFormEntry> {
    let show = |tested: &TestedManoeuvre| {
        let (record, quantity) = (tested.record, tested.figure(limit.figure)?);
        let file = file_of(record.trial);
        let corrected = record.correction.and_then(|own| Some((own, own.figures.get(limit.figure)?)));
        if let Some((correction, figure)) = corrected {
            let is_doubtful = !(figure.warnings.is_empty() && correction.warnings.is_empty());
            let doubt = if is_doubtful { "; see the remarks" } else { "" };
            let source = format!(
                "measured at partial load, {file}, and corrected by F/B = {} {}, 90 % {}{doubt}",
                fixed(figure.factor.median, decimals(&figure.factor)),
                range(&figure.factor),
                range(&figure.result),
            );
            return Some((false, of_interval(&figure.result, source)));
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
    let found = tested.iter().filter(|tested| tested.is(limit.manoeuvre, side)).filter_map(show);
    found.min_by_key(|(is_partial, _)| *is_partial).map(|(_, entry)| entry)
}

/// Value and source of a figure that is predicted.
fn predicted(
    limit: &Limit,
    side: &str,
    predictions: &[Prediction],
    particulars: Option<Particulars>,
    models: &str,
) -> ImoFormEntry {
    let untold = |why: &str| ImoFormEntry { source: why.into(), ..ImoFormEntry::default() };
    let kind: Manoeuvre = limit.manoeuvre.parse().expect("the name of a manoeuvre");
    let kind = if side == "port" { kind.to(Side::Port) } else { kind };
    let Some(prediction) = predictions.iter().find(|prediction| prediction.kind == kind) else {
        return untold(match predictions {
            [] => "not measured; `study predict --form` predicts it",
            _ => "hardly a drawn ship comes to the end of the manoeuvre",
        });
    };
    let Some(figure) = prediction.figures.get(limit.figure) else {
        return untold("the length of the ship, or her speed and drift, are not known");
    };
    let passing = (limit.of)(particulars).map(|limit| figure.share_within(limit));
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

/// Decimals of an entry.
fn decimals(interval: &PredictionInterval) -> usize {
    interval.decimals().min(DECIMALS)
}

/// A number with a true minus sign, none before a zero.
fn fixed(value: f64, decimals: usize) -> String {
    let text = format!("{value:.decimals$}");
    match text.strip_prefix('-') {
        Some(rest) if rest.bytes().all(|byte| matches!(byte, b'0' | b'.')) => rest.to_owned(),
        Some(rest) => format!("−{rest}"),
        None => text,
    }
}

/// The interval of nine tenths of the draws.
fn range(interval: &PredictionInterval) -> String {
    let [low, high] = interval.ci90.map(|end| fixed(end, decimals(interval)));
    format!("[{low}, {high}]")
}

/// How the ship was loaded when she was tested.
fn loading(tested: &[TestedManoeuvre]) -> ImoFormEntry {
    let used: Vec<FormRecord> = tested.iter().filter(|one| one.what.is_some()).map(|one| one.record).collect();
    let any = |is: fn(&FormRecord) -> bool| used.iter().any(is);
    let is_partial = |record: &FormRecord| record.correction.is_none() && record.loading() == Some(Loading::Partial);
    let found = [
        (any(|record| record.loading() == Some(Loading::Full)), "tested at full load"),
        (any(|record| record.correction.is_some()), "tested at partial load and corrected"),
        (any(is_partial), "tested at partial load, not corrected"),
        (used.is_empty(), "not tested: every result is predicted"),
    ];
    let words: Vec<&str> = found.into_iter().filter(|(is, _)| *is).map(|(_, words)| words).collect();
    let value = (!words.is_empty()).then(|| Value::from(words.join("; ")));
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

    fn record(mixture: &ShipMixture, kind: &str, conditions: Conditions) -> Trial {
        let trial = testing::record(mixture, kind, 0, from_deg(0.05), 0.5);
        trial.with_particulars(mixture.particulars().expect("made up")).with_conditions(conditions)
    }

    fn predictions(mixture: &ShipMixture) -> Vec<Prediction> {
        manoeuvres().iter().map(|kind| mixture.predict(kind, 60, false).expect("sails")).collect()
    }

    fn entry<'a>(form: &'a Form, section: &str, name: &str, side: Option<&str>) -> &'a ImoFormEntry {
        let is_it = |entry: &&ImoFormEntry| {
            entry.section.contains(section) && entry.field == name && entry.side.as_deref() == side
        };
        form.entries.iter().find(is_it).unwrap_or_else(|| panic!("{section} {name}: {form:?}"))
    }

    fn calm(loading: Loading) -> Conditions {
        Conditions {
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
            ..Conditions::default()
        }
    }

    #[test]
    fn manoeuvres_go_to_both_sides() {
        let names: Vec<String> = manoeuvres().iter().map(Manoeuvre::to_string).collect();
        let wanted = ["zig-zag -10/10", "zig-zag 10/10", "zig-zag -20/20", "zig-zag 20/20"];
        assert_eq!(names[..4], wanted);
        assert_eq!(names[4..], ["turning-circle -35", "turning-circle 35"]);
    }

    #[test]
    fn a_trial_at_partial_load_is_corrected_or_said_to_be_so() {
        let [full, ballast]: [IdentifiedShip; 2] = std::array::from_fn(|_| testing::known());
        let [full, ballast] = [(full, 0.9), (ballast, 1.0)].map(|(mut known, gain)| {
            known.members[0].parameters[1] *= gain;
            testing::mixture(known)
        });
        let trial = record(&ballast, "zig-zag:20/20", calm(Loading::Partial));
        let correction = correction::correct(&full, &ballast, &trial, correction::FULL_LOAD, 60).expect("both sail");
        let told = predictions(&full);
        let with = |correction| {
            fill(&told, full.particulars(), "", &[FormRecord { trial: &trial, correction, current: None }], None)
        };
        let of = |form: &Form| entry(form, "20°/20°", "1st overshoot angle", Some("starboard")).clone();
        let corrected = of(&with(Some(&correction)));
        assert!(corrected.source.contains("corrected by F/B = 0."), "{corrected:?}");
        let form = with(Some(&correction));
        let loading = &entry(&form, "manoeuvring", "loading condition", None).value;
        assert_eq!(loading, &Some("tested at partial load and corrected".into()));
        let plain = with(None);
        assert!(of(&plain).source.contains("at partial load, not corrected"), "{:?}", of(&plain));
        assert!(plain.remarks.iter().any(|remark| remark.contains("--ballast")), "{:?}", plain.remarks);
    }

    /// A record that is another manoeuvre fills in nothing and says why.
    #[test]
    fn what_is_no_manoeuvre_of_the_form_is_said() {
        let ship = testing::mixture(testing::known());
        let said = |kind: &str| {
            let trial = record(&ship, kind, Conditions::default());
            let form = fill(
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
        let circle = said("turning-circle:15");
        assert!(circle.contains("15.0° of rudder") && circle.contains("here 75.00 m at 6.00 m/s"), "{circle}");
        assert!(said("zig-zag:10/20").contains("a zig-zag of 10/20"));
        let declared = Conditions { ship_type: Some("ferry".into()), ..Conditions::default() };
        let form = fill(&predictions(&ship), None, "", &[], Some(("ship.toml", &declared)));
        assert_eq!(entry(&form, "ship", "ship type", None).value, Some("ferry".into()));
        assert_eq!(entry(&form, "ship", "L/V", None).value, None);
        assert_eq!(entry(&form, "10°/10°", "1st overshoot angle", Some("port")).limit, None);
    }
}
