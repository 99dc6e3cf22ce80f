//! The entries of the form of MSC/Circ.1053: particulars and conditions as they are declared, and figures of manoeuvres
//! to both sides, measured, corrected or predicted.

use ship::Particulars;
use trial::{Conditions, Loading};

use crate::form_entry::{Basis, Entry, Record, Value};
use crate::form_tested::{Sort, Tested};
use crate::kind::Kind;
use crate::prediction::Prediction;

const SHIP: &str = "ship data (full load)";
const TRIALS: &str = "trials data";

/// What a file declares, with the length of the ship of its record, m.
type Said<'a> = (&'a str, &'a Conditions, Option<f64>);

/// Particulars and conditions; the first file that says something is taken.
pub(crate) fn ship(said: &[Said], particulars: Option<Particulars>) -> Vec<Entry> {
    let entry = |section, name, unit, found: Option<(String, Value)>| {
        let (value, basis) = match found {
            Some((file, value)) => (Some(value), Basis::Declared { file }),
            None => (None, Basis::NotInRecords),
        };
        Entry { section, name, side: None, value, unit, limit: None, basis }
    };
    let first = |of: &dyn Fn(&Said) -> Option<Value>| said.iter().find_map(|one| Some((one.0.to_owned(), of(one)?)));
    let text = |of: fn(&Conditions) -> &Option<String>| first(&|(_, form, _)| of(form).clone().map(Value::Text));
    let number = |of: fn(&Conditions) -> Option<f64>| first(&|(_, form, _)| of(form).map(Value::Number));
    let count =
        |of: fn(&Conditions) -> Option<u8>| first(&|(_, form, _)| of(form).map(|n| Value::Number(f64::from(n))));
    let length = |(_, form, length): &Said| form.particulars.map(|own| own.length).or(*length);
    let mut scale =
        entry(SHIP, "L/V", "s", particulars.map(|own| (String::new(), Value::Number(own.length / own.speed))));
    if scale.value.is_some() {
        scale.basis = Basis::Scale;
    }
    vec![
        entry("", "administration", "", text(|form| &form.administration)),
        entry(SHIP, "ship type", "", text(|form| &form.ship_type)),
        scale,
        entry(SHIP, "L/B", "1", first(&|one| Some(Value::Number(length(one)? / one.1.beam?)))),
        entry(SHIP, "B/T", "1", number(|form| Some(form.beam? / form.draught_at_full_load()?))),
        entry(SHIP, "block coefficient", "1", number(|form| form.block_coefficient)),
        entry(SHIP, "rudder type", "", text(|form| &form.rudder_type)),
        entry(
            SHIP,
            "total rudder area/LT",
            "1",
            first(&|one| {
                let area = one.1.rudder_area? / (length(one)? * one.1.draught_at_full_load()?);
                Some(Value::Number(area))
            }),
        ),
        entry(SHIP, "number of rudders", "1", count(|form| form.rudders)),
        entry(SHIP, "propeller type", "", text(|form| &form.propeller_type)),
        entry(SHIP, "number of propellers", "1", count(|form| form.propellers)),
        entry(SHIP, "trim (by the stern)", "m", number(|form| form.trim)),
        entry(SHIP, "engine type", "", text(|form| &form.engine_type)),
        entry(SHIP, "ballast condition", "", text(|form| &form.ballast)),
        entry(TRIALS, "water depth/trial draught", "1", number(Conditions::depth_in_draughts)),
        entry(TRIALS, "wind: Beaufort number", "1", count(|form| form.wind_beaufort)),
        entry(TRIALS, "wave: sea state", "1", count(|form| form.sea_state)),
    ]
}

/// A row of the form with an entry for either side.
pub(crate) struct Manoeuvre {
    pub name: &'static str,
    pub section: &'static str,
    /// The manoeuvre it is read from.
    pub manoeuvre: Sort,
    /// The figure of merit.
    pub figure: &'static str,
    pub unit: &'static str,
    pub limit: Option<f64>,
}

impl Manoeuvre {
    /// The entries to port and starboard.
    pub fn entries(&self, predictions: &[Prediction], records: &[Record], tested: &[Tested]) -> [Entry; 2] {
        ["port", "starboard"].map(|side| {
            let (value, basis) =
                self.measured(side, records, tested).unwrap_or_else(|| self.predicted(side, predictions));
            let Self { section, name, unit, limit, .. } = *self;
            Entry { section, name, side: Some(side), value, unit, limit, basis }
        })
    }

    fn measured(&self, side: &str, records: &[Record], tested: &[Tested]) -> Option<(Option<Value>, Basis)> {
        let show = |(record, tested): (&Record, &Tested)| {
            let quantity = tested.figure(self.manoeuvre, side, self.figure)?;
            let file = record.file().to_owned();
            let corrected =
                record.correction.and_then(|correction| Some((correction, correction.figure(self.figure)?)));
            Some(match corrected {
                Some((correction, figure)) => {
                    let doubtful = !(figure.doubts.is_empty() && correction.doubts.is_empty());
                    let basis = Basis::Corrected { file, factor: figure.factor, doubtful };
                    (Some(Value::Interval(figure.result)), basis)
                }
                None => {
                    let partial = record.loading() == Some(Loading::Partial);
                    let value = Value::Measured { value: quantity.value, sd: quantity.sd };
                    (Some(value), Basis::Measured { file, partial })
                }
            })
        };
        let mut found: Vec<(Option<Value>, Basis)> = records.iter().zip(tested).filter_map(show).collect();
        // What needs no correction, or has one, goes before what was made at partial load.
        let is_partial = |(_, basis): &(Option<Value>, Basis)| matches!(basis, Basis::Measured { partial: true, .. });
        found.sort_by_key(is_partial);
        found.into_iter().next()
    }

    fn predicted(&self, side: &str, predictions: &[Prediction]) -> (Option<Value>, Basis) {
        let is_it = |prediction: &&Prediction| {
            let starboard: Option<Kind> = self.manoeuvre.parse().ok();
            let wanted = if side == "port" { starboard.map(|kind| kind.to_port()) } else { starboard };
            Some(prediction.kind) == wanted
        };
        let Some(prediction) = predictions.iter().find(is_it) else {
            return (None, Basis::NotTold { why: "hardly a drawn ship comes to the end of the manoeuvre" });
        };
        let Some(figure) = prediction.figures.iter().find(|figure| figure.name == self.figure) else {
            return (None, Basis::NotTold { why: "the length of the ship, or her speed and drift, are not known" });
        };
        let passing = self.limit.map(|limit| figure.share_within(limit));
        let basis = Basis::Predicted { extrapolated: prediction.extrapolated, passing };
        (Some(Value::Interval(figure.interval)), basis)
    }
}
