//! Checks of every number of a scenario: NaN is refused with a message at its key and line. Any other extreme value is
//! refused, or its trials end.

use std::path::Path;

use simulate::limits::MAX_STEPS;

use crate::engine::{TrialRunner, stream_key};
use crate::scenario::Scenario;
use crate::scenario::keys::ScenarioKey;
use crate::shard::TrialId;

/// Scenarios that together contain every numeric key, one per line.
const EVERYTHING: [&str; 5] = [
    include_str!("tests/disturbed.toml"),
    include_str!("tests/second_order.toml"),
    include_str!("tests/turning_circle.toml"),
    include_str!("tests/pull_out.toml"),
    include_str!("tests/draws.toml"),
];

/// Numeric keys of the study and its methods missing from [`EVERYTHING`].
const OF_STUDY: &str = include_str!("tests/of_study.toml");

/// Numbers of a trace.
const OF_TRACE: &str = include_str!("tests/of_trace.toml");

/// Extreme values, including integers, which are read as numbers.
const EXTREMES: [&str; 11] = [
    "0",
    "-1",
    "nan",
    "inf",
    "-inf",
    "1e-300",
    "1e-12",
    "1e300",
    "1000000000",
    "1000000000000000000",
    "9223372036854775807",
];

fn parse(text: &str) -> Result<Scenario, String> {
    let text = format!("question = \"?\"\nseed = 1{text}\n[[identifier]]\nmethod.srivc = {{}}\n");
    Scenario::parse(Path::new("all.toml"), "all", text, None).map_err(|failure| failure.message)
}

#[test]
fn every_number_is_checked_and_found_again() {
    for text in EVERYTHING {
        parse(text).unwrap_or_else(|message| panic!("{message}"));
        with_each_number(text, "nan", |line, key, changed| {
            if ["after-execute", "heading-every-rows"].contains(&key) {
                return;
            }
            let Err(message) = parse(changed) else { panic!("`{key} = nan` was accepted in\n{text}") };
            let name = key.rsplit('.').next().expect("a key");
            let place = format!("--> all.toml:{}:", line + 2);
            assert!(message.contains(&place) && message.contains(name), "{key}, expected {place}\n{message}");
            assert!(message.to_lowercase().contains("is nan"), "{key}\n{message}");
        });
    }
}

/// Every number of the settings of a trial is among these tests.
#[test]
fn every_declared_number_is_among_them() {
    let texts = EVERYTHING.into_iter().chain([OF_STUDY]);
    let documents: Vec<toml::Table> = texts.map(|text| text.parse().expect("it is TOML")).collect();
    const OF_A_TRIAL: [&str; 7] =
        ["manoeuvre", "steering-gear", "helmsman", "approach", "recording", "sensor", "disturbance"];
    for ScenarioKey { key, unit, .. } in crate::scenario::keys::scenario_keys() {
        let is_of_a_trial = key.split('.').next().is_some_and(|part| OF_A_TRIAL.contains(&part));
        if !is_of_a_trial || unit == "table" || unit == "text" || unit.contains(" or ") {
            continue;
        }
        let (part, below) = key.split_once('.').expect("a key of a part");
        let is_in = |document: &toml::Table| {
            document.get(part).and_then(|part| below.split('.').try_fold(part, |value, name| value.get(name))).is_some()
        };
        assert!(documents.iter().any(is_in), "{key}");
    }
}

/// Texts with one number at a time set to `value`, with line and key of the number.
fn with_each_number(text: &str, value: &str, mut see: impl FnMut(usize, &str, &str)) {
    let lines: Vec<&str> = text.lines().collect();
    for number in 0..lines.len() {
        let Some((key, before)) = lines[number].rsplit_once(" = ") else { continue };
        if before.parse::<f64>().is_ok() {
            let line = format!("{key} = {value}");
            let mut changed = lines.clone();
            changed[number] = &line;
            see(number, key, &changed.join("\n"));
        }
    }
}

/// Every extreme at every number is refused with a message, or the first trial is simulated and identified by every
/// method. The test passes if it ends.
fn is_refused_or_ends(text: &str) {
    parse(text).unwrap_or_else(|message| panic!("{message}"));
    for value in EXTREMES {
        with_each_number(text, value, |_, _, changed| match parse(changed) {
            Err(message) => assert!(message.contains("--> all.toml:") && message.contains("= help: "), "{message}"),
            Ok(scenario) => {
                let task = TrialId { cell: 0, replicate: 0 };
                if let Ok(trial_spec) = scenario.cells[0].trial_spec(&stream_key(&scenario, task)) {
                    let steps = trial_spec.specification.simulation.cost().max_steps;
                    assert!(steps <= MAX_STEPS as f64, "{steps} steps in\n{changed}");
                }
                let rows = TrialRunner::new(&scenario, 0..=0).run(task).rows;
                assert_eq!(rows.len(), scenario.cells[0].methods.len());
            }
        });
    }
}

#[test]
fn no_number_of_a_disturbed_zig_zag_makes_a_trial_without_end() {
    is_refused_or_ends(EVERYTHING[0]);
}

#[test]
fn no_number_of_another_manoeuvre_makes_a_trial_without_end() {
    EVERYTHING[1..4].iter().for_each(|text| is_refused_or_ends(text));
}

#[test]
fn no_number_of_a_draw_makes_a_trial_without_end() {
    is_refused_or_ends(EVERYTHING[4]);
}

#[test]
fn no_number_of_a_study_or_a_method_makes_a_trial_without_end() {
    is_refused_or_ends(OF_STUDY);
}

/// A trace is too slow to be run for every number here; its parameters do not change the length of its loops.
#[test]
fn no_number_of_a_trace_is_taken_for_another() {
    for value in EXTREMES {
        with_each_number(OF_TRACE, value, |_, _, changed| {
            if !changed.contains(&OF_TRACE[..OF_TRACE.find("probability").expect("a trace")]) {
                // Number of another method than the trace.
                return;
            }
            let expected = value == "0" && changed.contains("monomials = 0");
            assert_eq!(parse(changed).is_ok(), expected, "{changed}");
        });
    }
}

/// Samples of an unbounded distribution cannot be checked in advance: a trial with an invalid sample is a row with its
/// reason, and the other trials are simulated.
#[test]
fn a_drawn_trial_without_end_is_a_failed_row() {
    let head = EVERYTHING[4].split("[stop]").next().expect("the trial");
    let draw = "[[draw]]\nkey = \"approach.lead-in-s\"\n[draw.log-normal]\nmedian = 10.0\nsigma = 20.0\n";
    let scenario = parse(&format!("{head}{draw}")).unwrap_or_else(|message| panic!("{message}"));
    let runner = TrialRunner::new(&scenario, 0..=0);
    let failures: Vec<Option<String>> = (0..40)
        .map(|replicate| {
            runner.run(TrialId { cell: 0, replicate }).rows[0].failure.as_ref().map(|reason| reason.to_string())
        })
        .collect();
    let refused =
        failures.iter().flatten().filter(|reason| reason.starts_with("specification: `approach.lead-in-s` is"));
    assert!(refused.count() > 2 && failures.iter().any(Option::is_none), "{failures:?}");
}

/// Limits on the number of entries and on the depth of keys.
#[test]
fn no_list_is_longer_than_a_person_writes() {
    let head = EVERYTHING[4].split("[stop]").next().expect("the trial");
    let entries = |list: &str, body: &dyn Fn(usize) -> String, count: usize| {
        let all: String = (0..count).map(|index| format!("[[{list}]]\n{}\n", body(index))).collect();
        parse(&format!("{head}{all}")).err().unwrap_or_default()
    };
    let key = "a.".repeat(60_000);
    for (part, message) in [
        ("`sweep` has 8000 entries", entries("sweep", &|k| format!("key = \"sensor.k{k}\"\nvalues = [0.1]"), 8000)),
        (
            "`draw` has 65 entries",
            entries("draw", &|k| format!("key = \"sensor.k{k}\"\nnormal = {{ mean = 1.0, sd = 0.1 }}"), 65),
        ),
        (
            "`identifier` has 102 entries",
            entries("identifier", &|k| format!("label = \"{k}\"\nmethod.srivc = {{}}"), 101),
        ),
        ("`effect` has 21 entries", entries("effect", &|_| "moment_drift.rudder-deg-per-s = 0.0".to_owned(), 21)),
        ("60000 names joined by dots", entries("sweep", &|_| format!("key = \"{key}\"\nvalues = [0.1]"), 1)),
        (
            "60000 names joined by dots",
            entries("sweep", &|_| format!("points = [{{ label = \"a\", set = {{ \"{key}\" = 1 }} }}]"), 1),
        ),
        (
            "60000 names joined by dots",
            entries("draw", &|_| format!("key = \"{key}\"\nnormal = {{ mean = 1.0, sd = 0.1 }}"), 1),
        ),
    ] {
        assert!(message.contains(part), "{part}\n{}", &message[..message.len().min(400)]);
    }
}

/// Magnitudes that a fixed number of digits would hide or print in full.
#[test]
fn numbers_are_shown_as_they_are_written() {
    for (key, value, shown) in [
        ("sampling-s = 1.0", "1e-12", "`recording.sampling-s` is 1e-12"),
        ("heading-deg = 20.0", "-1e300", "`manoeuvre.zig-zag.heading-deg` is -1e300"),
        ("duration-s = 200.0", "1e300", "`manoeuvre.zig-zag.duration-s` is 1e300"),
        ("T-s = 16.3", "1e-12", "`ship.first-order.T-s` is 1e-12"),
        ("T2-s = 2.0", "1e-12", "`effect.0.second_order.T2-s` is 1e-12"),
        ("probability = 0.1", "1e300", "probability` is 1e300"),
    ] {
        let (name, _) = key.split_once(" = ").expect("a key");
        let message = parse(&EVERYTHING[0].replacen(key, &format!("{name} = {value}"), 1)).err().expect("refused");
        assert!(message.contains(shown), "{message}");
    }
}

/// The keys listed by `study list effects` are exactly those allowed in a scenario.
#[test]
fn the_listed_keys_of_an_effect_are_those_it_has() {
    for effect in ship::effects::all_effects() {
        let Some(numbers) = effect.scenario_keys() else { continue };
        let lines: Vec<String> = numbers.iter().map(|number| format!("{} = 0.3\n", number.key)).collect();
        let text = format!(
            "\n[ship.yukun]\n[[effect]]\n[effect.{}]\n{}[manoeuvre.zig-zag]\nrudder-deg = 10\nheading-deg = 10\n[recording]\n\
             sampling-s = 1\nduration-s = 100",
            effect.id(),
            lines.concat(),
        );
        // 0.3 may be outside its range (no 0.3 s of squall), but every key is known.
        if let Err(message) = parse(&text) {
            assert!(message.contains("` is 0.3"), "{message}");
        }
    }
    let listed = ship::effects::all_effects().iter().filter(|effect| effect.scenario_keys().is_some()).count();
    assert_eq!(listed, 16, "all forms but those of measured channels");
}
