//! The form for reporting manoeuvring data to IMO: every entry with its value, its limit and where it comes from.
//!
//! An entry is measured where a record is that very manoeuvre, corrected where the record was made in ballast and two
//! models tell the factor, predicted otherwise. What nobody declared is said to be missing; nothing is guessed. The
//! stopping trial is never predicted: no model of this program has a propeller that goes astern.
//!
//! Source: MSC/Circ.1053 (2002), appendix 6; limits of MSC.137(76), 5.3.

use ship::Particulars;
use trial::imo;
use trial::{Conditions, Loading};

use crate::form_entries::{self, Manoeuvre};
pub use crate::form_entry::{Basis, Entry, Form, Record, Value};
use crate::form_remarks;
use crate::form_tested::{self, Tested};
use crate::kind::Kind;
use crate::prediction::Prediction;

/// Longest track reach of the stopping trial, ship lengths. Source: MSC.137(76), 5.3.4.
pub const TRACK_REACH_LENGTHS: f64 = 15.0;

/// The manoeuvres of the form, to both sides.
///
/// The initial turning is that of the 10/10 zig-zag. Source: MSC/Circ.1053 (2002), appendix 6.
pub fn manoeuvres() -> Vec<Kind> {
    Kind::of_imo().into_iter().flat_map(|kind| [kind.to_port(), kind]).collect()
}

/// Fills in the form.
///
/// `particulars` are the scale of the predictions, whose L/V decides the limits of the 10/10 zig-zag. What is declared
/// of the ship is that of the first record that says it; `declared` are such words without a record, from `file`.
pub fn fill(
    predictions: &[Prediction],
    particulars: Option<Particulars>,
    records: &[Record],
    declared: Option<(&str, &Conditions)>,
) -> Form {
    let tested: Vec<Tested> = records.iter().map(form_tested::of).collect();
    let mut said: Vec<(&str, &Conditions, Option<f64>)> = records
        .iter()
        .map(|record| (record.file(), record.trial.conditions(), record.trial.particulars().map(|own| own.length)))
        .collect();
    said.extend(declared.map(|(file, conditions)| (file, conditions, None)));
    let mut entries = form_entries::ship(&said, particulars);
    entries.push(loading(records, &tested));
    let limit = |of: fn(Particulars) -> f64| particulars.map(of);
    let [first, second] = [imo::first_overshoot_10_10_limit_deg, imo::second_overshoot_10_10_limit_deg].map(limit);
    let of =
        |name, section, manoeuvre, figure, unit, limit| Manoeuvre { name, section, manoeuvre, figure, unit, limit };
    let lengths = "ship lengths";
    let [circle, ten, twenty] = ["turning circle, rudder 35°", "zig-zag 10°/10°", "zig-zag 20°/20°"];
    let rows = [
        of("advance", circle, form_tested::CIRCLE, "advance_lengths", lengths, Some(imo::ADVANCE_LENGTHS)),
        of(
            "tactical diameter",
            circle,
            form_tested::CIRCLE,
            "tactical_diameter_lengths",
            lengths,
            Some(imo::TACTICAL_DIAMETER_LENGTHS),
        ),
        of("1st overshoot angle", ten, form_tested::TEN, "first_overshoot_deg", "deg", first),
        of("2nd overshoot angle", ten, form_tested::TEN, "second_overshoot_deg", "deg", second),
        of(
            "1st overshoot angle",
            twenty,
            form_tested::TWENTY,
            "first_overshoot_deg",
            "deg",
            Some(imo::FIRST_OVERSHOOT_20_20_DEG),
        ),
        of(
            "distance to turn 10° with 10° rudder",
            "initial turning",
            form_tested::TEN,
            "initial_turning_lengths",
            lengths,
            Some(imo::INITIAL_TURNING_LENGTHS),
        ),
    ];
    for row in &rows {
        entries.extend(row.entries(predictions, records, &tested));
    }
    entries.push(Entry {
        section: "stopping",
        name: "track reach",
        side: None,
        value: None,
        unit: lengths,
        limit: Some(TRACK_REACH_LENGTHS),
        basis: Basis::NotTold {
            why: "never predicted: no model of this program goes astern; stop the ship and measure",
        },
    });
    let remarks = form_remarks::remarks(&entries, records, &tested, declared, particulars);
    Form { entries, remarks }
}

/// How the ship was loaded when she was tested.
fn loading(records: &[Record], tested: &[Tested]) -> Entry {
    let used: Vec<&Record> =
        records.iter().zip(tested).filter(|(_, tested)| tested.is_used()).map(|(record, _)| record).collect();
    let has = |loading: Option<Loading>| used.iter().any(|record| record.loading() == loading);
    let corrected = used.iter().any(|record| record.correction.is_some());
    let mut words = Vec::new();
    words.extend(has(Some(Loading::Full)).then_some("tested at full load"));
    words.extend(corrected.then_some("tested at partial load and corrected"));
    let uncorrected = |record: &&&Record| record.correction.is_none() && record.loading() == Some(Loading::Partial);
    words.extend(used.iter().find(uncorrected).map(|_| "tested at partial load, not corrected"));
    let (value, basis) = match (words.is_empty(), used.is_empty()) {
        (false, _) => (Some(Value::Text(words.join("; "))), Basis::Loading),
        (true, false) => (None, Basis::NotInRecords),
        (true, true) => (Some(Value::Text(String::from("not tested: every result is predicted"))), Basis::Loading),
    };
    Entry { section: "manoeuvring data", name: "loading condition", side: None, value, unit: "", limit: None, basis }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::correction;
    use crate::known::KnownShip;
    use crate::made_up;
    use crate::mixture::Mixture;
    use ship::angle::from_deg;
    use simulate::{Simulation, StreamKey, Vessel};
    use trial::Trial;

    fn mixture() -> Mixture {
        Mixture::new(vec![(made_up::known(), 1.0)]).expect("made up")
    }

    fn record(mixture: &Mixture, kind: &str, conditions: Conditions) -> Trial {
        let ship = mixture.draw(5, &[]);
        let kind: Kind = kind.parse().expect("known");
        let manoeuvre = kind.manoeuvre(mixture.timescale()).expect("steered");
        let mut simulation = Simulation::new(Vessel::response(ship.response), manoeuvre);
        simulation.gear = ship.gear;
        simulation.recording.period = 0.5;
        simulation.sensors.heading.noise = from_deg(0.05);
        let trial = simulation.run(&StreamKey::default()).expect("a trial").trial;
        let particulars = mixture.particulars().expect("made up");
        trial.with_particulars(particulars).with_conditions(conditions)
    }

    fn predictions(mixture: &Mixture) -> Vec<Prediction> {
        manoeuvres().iter().map(|kind| mixture.predict(kind, 60, false).expect("sails")).collect()
    }

    fn entry<'a>(form: &'a Form, section: &str, name: &str, side: Option<&str>) -> &'a Entry {
        let is_it = |entry: &&Entry| entry.section.contains(section) && entry.name == name && entry.side == side;
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
        let names: Vec<String> = manoeuvres().iter().map(Kind::to_string).collect();
        let wanted = ["zig-zag -10/10", "zig-zag 10/10", "zig-zag -20/20", "zig-zag 20/20"];
        assert_eq!(names[..4], wanted);
        assert_eq!(names[4..], ["turning-circle -35", "turning-circle 35"]);
    }

    /// One side is measured, the other predicted; what nobody declared is missing.
    #[test]
    fn every_entry_names_its_source() {
        let ship = mixture();
        let trial = record(&ship, "zig-zag:-10/10", calm(Loading::Full));
        let records = [Record { trial: &trial, correction: None, current: None }];
        let form = fill(&predictions(&ship), ship.particulars(), &records, None);
        let port = entry(&form, "10°/10°", "1st overshoot angle", Some("port"));
        let starboard = entry(&form, "10°/10°", "1st overshoot angle", Some("starboard"));
        assert!(matches!(port.basis, Basis::Measured { partial: false, .. }), "{port:?}");
        assert!(matches!(starboard.basis, Basis::Predicted { extrapolated: false, passing: Some(_) }), "{starboard:?}");
        // L/V = 12.5 s: 11.25 and 26.875 deg.
        assert!((port.limit.expect("known") - 11.25).abs() < 1e-12);
        let (Some(Value::Measured { value, sd: Some(sd) }), Some(Value::Interval(told))) =
            (&port.value, &starboard.value)
        else {
            panic!("{port:?} {starboard:?}")
        };
        assert!((value - told.median).abs() < 1.5 && *sd < 0.2, "{value} {sd} {told:?}");
        let turning = entry(&form, "initial", "distance to turn 10° with 10° rudder", Some("port"));
        assert!(matches!(turning.basis, Basis::Measured { .. }), "{turning:?}");
        assert_eq!(entry(&form, "ship", "L/B", None).value, Some(Value::Number(5.0)));
        assert_eq!(entry(&form, "ship", "B/T", None).value, Some(Value::Number(3.0)));
        assert_eq!(entry(&form, "ship", "total rudder area/LT", None).value, Some(Value::Number(0.02)));
        assert_eq!(entry(&form, "trials", "water depth/trial draught", None).value, Some(Value::Number(12.0)));
        assert_eq!(entry(&form, "ship", "rudder type", None).basis, Basis::NotInRecords);
        let loading = entry(&form, "manoeuvring", "loading condition", None);
        assert_eq!(loading.value, Some(Value::Text("tested at full load".into())));
        // No speed and no drift: nobody tells the circle; nobody ever tells the stopping trial.
        assert!(matches!(entry(&form, "circle", "advance", Some("port")).basis, Basis::NotTold { .. }));
        assert!(entry(&form, "stopping", "track reach", None).value.is_none());
        for part in ["sea state 6", "tried to port only", "20/20 zig-zag: not tried", "no speed is recorded"] {
            assert!(form.remarks.iter().any(|remark| remark.contains(part)), "{part}: {:?}", form.remarks);
        }
    }

    #[test]
    fn a_trial_at_partial_load_is_corrected_or_said_to_be_so() {
        let [full, ballast]: [KnownShip; 2] = std::array::from_fn(|_| made_up::known());
        let [full, ballast] = [(full, 0.9), (ballast, 1.0)].map(|(mut known, gain)| {
            known.members[0].parameters[1] *= gain;
            Mixture::new(vec![(known, 1.0)]).expect("made up")
        });
        let trial = record(&ballast, "zig-zag:20/20", calm(Loading::Partial));
        let correction = correction::correct(&full, &ballast, &trial, 60).expect("both sail");
        let told = predictions(&full);
        let with =
            |correction| fill(&told, full.particulars(), &[Record { trial: &trial, correction, current: None }], None);
        let of = |form: &Form| entry(form, "20°/20°", "1st overshoot angle", Some("starboard")).clone();
        let corrected = of(&with(Some(&correction)));
        assert!(matches!(corrected.basis, Basis::Corrected { .. }), "{corrected:?}");
        let loading = with(Some(&correction)).entries.into_iter().find(|entry| entry.name == "loading condition");
        let words = Value::Text("tested at partial load and corrected".into());
        assert_eq!(loading.and_then(|entry| entry.value), Some(words));
        let plain = with(None);
        assert!(matches!(of(&plain).basis, Basis::Measured { partial: true, .. }), "{:?}", of(&plain));
        assert!(plain.remarks.iter().any(|remark| remark.contains("--ballast")), "{:?}", plain.remarks);
    }

    /// A record that is another manoeuvre fills in nothing and says why.
    #[test]
    fn what_is_no_manoeuvre_of_the_form_is_said() {
        let ship = mixture();
        let said = |kind: &str| {
            let trial = record(&ship, kind, Conditions::default());
            let form = fill(
                &predictions(&ship),
                ship.particulars(),
                &[Record { trial: &trial, correction: None, current: None }],
                None,
            );
            let measured = |entry: &Entry| matches!(entry.basis, Basis::Measured { .. });
            assert!(!form.entries.iter().any(measured), "{kind}");
            form.remarks.join("\n")
        };
        let circle = said("turning-circle:15");
        assert!(circle.contains("15.0° of rudder") && circle.contains("here 75.00 m at 6.00 m/s"), "{circle}");
        assert!(said("zig-zag:10/20").contains("a zig-zag of 10/20"));
        let declared = Conditions { ship_type: Some("ferry".into()), ..Conditions::default() };
        let form = fill(&predictions(&ship), None, &[], Some(("ship.toml", &declared)));
        assert_eq!(entry(&form, "ship", "ship type", None).value, Some(Value::Text("ferry".into())));
        assert_eq!(entry(&form, "ship", "L/V", None).value, None);
        assert_eq!(entry(&form, "10°/10°", "1st overshoot angle", Some("port")).limit, None);
    }
}
