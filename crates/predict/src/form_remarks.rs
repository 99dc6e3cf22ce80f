//! Remarks of the form of MSC/Circ.1053: conditions that are not met or not known, sides that were not tried, records
//! that are no manoeuvre of the form, and what is to be known of predicted entries.

use ship::Particulars;
use trial::{Conditions, Loading};

use crate::form::{FormEntry, FormRecord};
use crate::form_record::Tested;
use crate::imo::{CIRCLE, TEN, TWENTY};
use crate::replay::file_of;

/// Length from which the criteria hold, m. Source: MSC.137(76), 2.
const SHORTEST_SHIP: f64 = 100.0;

/// The remarks, in the order in which a reader asks.
pub(crate) fn remarks(
    entries: &[FormEntry],
    records: &[FormRecord],
    tested: &[Tested],
    declared: Option<(&str, &Conditions)>,
    particulars: Option<Particulars>,
) -> Vec<String> {
    let mut remarks = Vec::new();
    if let Some(Particulars { length, speed }) = particulars.filter(|own| own.length < SHORTEST_SHIP) {
        remarks.push(format!(
            "the criteria are for ships of 100 m and above (chemical tankers and gas carriers of any length), and limits of \
             the 10/10 zig-zag follow L/V, here {length:.2} m at {speed:.2} m/s; for a model give --length-m and \
             --speed-kn of the ship"
        ));
    }
    let mut of_files = OfFiles::default();
    for (record, tested) in records.iter().zip(tested) {
        for text in of_record(record, tested) {
            of_files.add(file_of(record.trial), text);
        }
    }
    if let Some((file, text)) = declared.and_then(|(file, form)| Some((file, form.remark.clone()?))) {
        of_files.add(file, text);
    }
    remarks.extend(of_files.0.into_iter().map(|(text, files)| format!("{}: {text}", files.join(", "))));
    for (manoeuvre, name) in [(TEN, "10/10 zig-zag"), (TWENTY, "20/20 zig-zag"), (CIRCLE, "turning circle")] {
        let has = |side: &'static str| tested.iter().any(|tested| tested.what == Some((manoeuvre, side)));
        match [has("port"), has("starboard")] {
            [true, true] => {}
            [true, false] => remarks.push(format!("{name}: tried to port only; trials are asked for to both sides")),
            [false, true] => {
                remarks.push(format!("{name}: tried to starboard only; trials are asked for to both sides"));
            }
            [false, false] => remarks.push(format!("{name}: not tried")),
        }
    }
    if tested.iter().any(Tested::is_used) {
        remarks.push(String::from(
            "not looked at: the test speed (at least 90 % of that at 85 % of the engine output) and the engine",
        ));
    }
    for (record, tested) in records.iter().zip(tested) {
        let is_circle = tested.what.is_some_and(|(manoeuvre, _)| manoeuvre == CIRCLE);
        match record.current {
            Some(current) => remarks.push(format!(
                "{}: a current of {:.2} m/s that sets to {:.0}° was taken out of the track",
                file_of(record.trial),
                current.speed_m_s,
                current.set_deg
            )),
            None if is_circle => remarks.push(format!(
                "{}: the turn is shorter than the 720° that show a current; what one did to the track is not known",
                file_of(record.trial)
            )),
            None => {}
        }
    }
    for (manoeuvre, side) in
        [TEN, TWENTY, CIRCLE].into_iter().flat_map(|manoeuvre| ["port", "starboard"].map(|side| (manoeuvre, side)))
    {
        if tested.iter().filter(|tested| tested.what == Some((manoeuvre, side))).count() > 1 {
            remarks.push(format!(
                "{manoeuvre} to {side}: several records; the first that is at full load or corrected is used"
            ));
        }
    }
    if entries.iter().any(|entry| entry.extrapolated.is_some()) {
        remarks.push(String::from(
            "predicted entries hold for the loading, the water depth and the weather of the records that the models were \
             fitted to, which a model does not say; they are no trial",
        ));
    }
    if entries.iter().any(|entry| entry.extrapolated == Some(true)) {
        remarks.push(String::from("extrapolated entries are beyond the rudder or the yaw rate of those records"));
    }
    remarks
}

/// Remarks with the files they are of; what holds for several is said once.
#[derive(Default)]
struct OfFiles(Vec<(String, Vec<String>)>);

impl OfFiles {
    fn add(&mut self, file: &str, text: String) {
        match self.0.iter_mut().find(|(own, _)| *own == text) {
            Some((_, files)) => files.push(file.to_owned()),
            None => self.0.push((text, vec![file.to_owned()])),
        }
    }
}

/// What is to be said of one record.
fn of_record(record: &FormRecord, tested: &Tested) -> Vec<String> {
    let mut remarks: Vec<String> = tested.remark.iter().cloned().collect();
    // A record that fills in nothing need not be by the book.
    if tested.is_used() {
        remarks.extend(record.trial.shortcomings().iter().map(ToString::to_string));
        if record.loading() == Some(Loading::Partial) && record.correction.is_none() {
            remarks.push(String::from(
                "tested at partial load and not corrected, and the criteria are for full load; give --ballast with a model \
                 of the ship as she was tried",
            ));
        }
        if let Some(correction) = record.correction {
            remarks.extend(correction.warnings.iter().map(|doubt| format!("correction to full load: {doubt}")));
            let is_entry = |name: &str| tested.figures.iter().any(|(own, _)| *own == name);
            for (name, figure) in correction.figures.iter().filter(|(name, _)| is_entry(name)) {
                let name = name.replace('_', " ");
                remarks.extend(figure.warnings.iter().map(|doubt| format!("correction of {name}: {doubt}")));
            }
        }
    }
    remarks.extend(record.trial.conditions().remark.clone());
    remarks
}
