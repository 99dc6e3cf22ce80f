//! Remarks of the form of MSC/Circ.1053: conditions that are not met or unknown, sides that were not tested, and
//! records that are not a manoeuvre of the form.

use document::names;
use indexmap::IndexMap;
use ship::Particulars;
use trial::{DeclaredConditions, Loading, imo};

use super::record::TestedManoeuvre;
use crate::imo::{TURNING_CIRCLE_35, ZIG_ZAG_10_10, ZIG_ZAG_20_20};
use crate::replay::record_file;

/// Remarks, in order of relevance.
pub(crate) fn remarks(
    tested: &[TestedManoeuvre],
    declared: Option<(&str, &DeclaredConditions)>,
    particulars: Option<Particulars>,
) -> Vec<String> {
    let mut remarks: Vec<String> = particulars.and_then(imo::short_ship_caution).into_iter().collect();
    // A remark on several files appears once.
    let mut files: IndexMap<String, Vec<&str>> = IndexMap::new();
    for manoeuvre in tested {
        for text in of_record(manoeuvre) {
            files.entry(text).or_default().push(record_file(manoeuvre.record.trial));
        }
    }
    if let Some((file, text)) = declared.and_then(|(file, form)| Some((file, form.remark.clone()?))) {
        files.entry(text).or_default().push(file);
    }
    remarks.extend(files.into_iter().map(|(text, files)| format!("{}: {text}", files.join(", "))));
    remarks.extend(sides(tested));
    if tested.iter().any(|tested| tested.manoeuvre.is_some()) {
        remarks.push(String::from(
            "not checked: the test speed (at least 90 % of that at 85 % of the engine output) and the engine",
        ));
    }
    remarks.extend(tested.iter().filter_map(of_current));
    for manoeuvre in [ZIG_ZAG_10_10, ZIG_ZAG_20_20, TURNING_CIRCLE_35] {
        for side in ["port", "starboard"] {
            if tested.iter().filter(|tested| tested.matches(manoeuvre, side)).count() > 1 {
                remarks.push(format!(
                    "{manoeuvre} to {side}: several records; the first that is at full load or corrected is used"
                ));
            }
        }
    }
    remarks
}

/// Remarks on manoeuvres that were not tested, or were tested to one side only.
fn sides(tested: &[TestedManoeuvre]) -> Vec<String> {
    let names =
        [(ZIG_ZAG_10_10, "10/10 zig-zag"), (ZIG_ZAG_20_20, "20/20 zig-zag"), (TURNING_CIRCLE_35, "turning circle")];
    let missing = |(manoeuvre, name): (&'static str, &str)| {
        let done =
            ["port", "starboard"].map(|side| tested.iter().any(|test| test.matches(manoeuvre, side)).then_some(side));
        match done {
            [Some(_), Some(_)] => None,
            [None, None] => Some(format!("{name}: not tested")),
            [Some(side), None] | [None, Some(side)] => {
                Some(format!("{name}: tested to {side} only; the form needs trials to both sides"))
            }
        }
    };
    names.into_iter().filter_map(missing).collect()
}

/// Remark on a current in the track of a record.
fn of_current(tested: &TestedManoeuvre) -> Option<String> {
    let file = record_file(tested.record.trial);
    match tested.record.current {
        Some(current) => Some(format!(
            "{file}: a current of {:.2} m/s that sets to {:.0}° was removed from the track",
            current.speed_m_s, current.set_deg
        )),
        None => tested.manoeuvre.filter(|(manoeuvre, _)| *manoeuvre == TURNING_CIRCLE_35).map(|_| {
            format!(
                "{file}: the turn is shorter than the 720° that reveal a current, so its effect on the track is unknown"
            )
        }),
    }
}

/// Remarks on one record.
fn of_record(tested: &TestedManoeuvre) -> Vec<String> {
    let record = &tested.record;
    let mut remarks: Vec<String> = tested.remark.iter().cloned().collect();
    // A record without entries need not meet the standard.
    if tested.manoeuvre.is_some() {
        remarks.extend(record.trial.shortcomings().iter().map(ToString::to_string));
        if record.loading() == Some(Loading::Partial) && record.correction.is_none() {
            remarks.push(String::from(
                "tested at partial load and not corrected, and the criteria are for full load; give --ballast with a model \
                 of the ship in that condition",
            ));
        }
        if let Some(correction) = record.correction {
            remarks.extend(correction.warnings.iter().map(|each| format!("correction to full load: {}", each.text)));
            for (name, figure) in correction.figures.iter().filter(|(name, _)| tested.figure(name).is_some()) {
                let name = names::with_blanks(name);
                remarks.extend(figure.warnings.iter().map(|warning| format!("correction of {name}: {}", warning.text)));
            }
        }
    }
    remarks.extend(record.trial.conditions().remark.clone());
    remarks
}
