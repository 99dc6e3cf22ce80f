//! Predictions: `study predict` on what `fit` and `trace` leave.

use serde_json::Value;

use crate::desk::{Desk, of_repository};

fn record(name: &str) -> String {
    of_repository(&format!("scenarios/records/{name}.csv")).to_string_lossy().into_owned()
}

/// A desk with the answer of every method on the record of a first-order ship.
fn with_fit() -> Desk {
    let desk = Desk::new();
    let first = record("first-order");
    let ship = ["--length-m", "75", "--speed-m-s", "6.2"];
    desk.run(&[&["fit", &first, "--out", "f", "--quiet"][..], &ship].concat()).is_done();
    desk
}

fn figure<'a>(json: &'a Value, kind: &str, name: &str) -> &'a Value {
    let own = json["manoeuvres"].as_array().expect("a list").iter().find(|one| one["kind"] == kind);
    &own.unwrap_or_else(|| panic!("{kind}: {json}"))["figures"][name]
}

/// Every key of the contract, down to its parts.
fn keeps_the_contract(json: &Value) {
    assert_eq!(json["schema"], "predict/1");
    let weights: f64 =
        json["models"].as_array().expect("a list").iter().map(|one| one["weight"].as_f64().expect("1")).sum();
    assert!((weights - 1.0).abs() < 1e-12);
    let holds = |of: &Value| {
        let number = |value: &Value| value.as_f64().unwrap_or_else(|| panic!("{of}"));
        let [median, low, high] = [&of["median"], &of["ci90"][0], &of["ci90"][1]].map(number);
        let [inner, outer] = [&of["ci50"][0], &of["ci50"][1]].map(number);
        assert!(low <= inner && inner <= median && median <= outer && outer <= high, "{of}");
    };
    for manoeuvre in json["manoeuvres"].as_array().expect("a list") {
        for figure in manoeuvre["figures"].as_object().expect("figures").values() {
            holds(figure);
            assert!(figure["extrapolated"].is_boolean());
            let shares: f64 = figure["shares"].as_object().expect("shares").values().filter_map(Value::as_f64).sum();
            assert!(shares == 0.0 || (shares - 1.0).abs() < 1e-9, "{figure}");
        }
    }
    for replay in json["replays"].as_array().expect("a list") {
        assert!((0.0..=1.0).contains(&replay["band_coverage_90"].as_f64().expect("a share")));
        replay["figures"].as_object().expect("figures").values().for_each(holds);
    }
    for criterion in json["imo"].as_array().expect("a list") {
        assert!((0.0..=1.0).contains(&criterion["probability_of_passing"].as_f64().expect("a share")));
        assert!(criterion["criterion"].is_string() && criterion["limit"].is_f64());
    }
}

/// The first overshoot of the ship of that record is 6.82 deg in a 10/10, and the limit of 75 m at 6.2 m/s 11.0 deg.
#[test]
fn a_fit_tells_the_trials_of_the_imo() {
    let desk = with_fit();
    let run = desk.run(&["predict", "f/fit.json", "--out", "p", "--draws", "200"]);
    assert!(run.is_done().out.contains("IMO MSC.137(76)"), "{}", run.out);
    let json = desk.json("p/predict.json");
    keeps_the_contract(&json);
    let first = figure(&json, "zig-zag 10/10", "first_overshoot_deg");
    assert!((first["median"].as_f64().expect("a number") - 6.82).abs() < 0.1, "{first}");
    assert_eq!(first["extrapolated"], false);
    assert_eq!(figure(&json, "zig-zag 20/20", "first_overshoot_deg")["extrapolated"], true);
    let names: Vec<&str> =
        json["imo"].as_array().expect("a list").iter().filter_map(|one| one["criterion"].as_str()).collect();
    assert_eq!(names, ["initial turning", "10/10 first overshoot", "10/10 second overshoot", "20/20 first overshoot"]);
    for file in ["report.md", "zig-zag-10-10.png", "zig-zag-10-10.csv", "imo-overshoots.svg", "turning-circle-35.png"] {
        assert!(!desk.bytes(&format!("p/{file}")).is_empty(), "{file}");
    }
    // The same again, to the byte; another format is a table alone.
    let again =
        desk.run(&["predict", "f/fit.json", "--out", "q", "--draws", "200", "--threads", "1", "--format", "csv"]);
    assert!(again.is_done().out.starts_with("manoeuvre,figure"), "{}", again.out);
    assert_eq!(desk.bytes("p/predict.json"), desk.bytes("q/predict.json"));
}

#[test]
fn a_trace_predicts_and_its_own_record_is_inside() {
    let desk = Desk::new();
    let damping = record("undeclared-damping");
    desk.run(&["trace", &damping, "--out", "t", "--quiet"]).is_done();
    let kinds = ["spiral:15", "pull-out:20", "williamson", "initial-turning:10", "zig-zag:-20/20"];
    let asked: Vec<&str> = kinds.iter().flat_map(|kind| ["--manoeuvre", kind]).collect();
    let rest = ["--replay", &damping, "--draws", "200", "--out", "p"];
    desk.run(&[&["predict", "t/trace.json"][..], &asked, &rest].concat()).is_done();
    let json = desk.json("p/predict.json");
    keeps_the_contract(&json);
    assert_eq!(json["manoeuvres"].as_array().map(Vec::len), Some(5));
    let criteria: Vec<&str> =
        json["imo"].as_array().expect("a list").iter().filter_map(|one| one["criterion"].as_str()).collect();
    assert_eq!(criteria, ["initial turning", "20/20 first overshoot"]);
    assert_eq!(figure(&json, "spiral 15", "loop_width_deg")["median"], 0.0);
    let replay = &json["replays"][0];
    assert!(replay["band_coverage_90"].as_f64().expect("a share") > 0.6, "{replay}");
    let overshoot = &replay["figures"]["first_overshoot_deg"];
    let [measured, median] = ["measured", "median"].map(|key| overshoot[key].as_f64().expect("a number"));
    assert!((measured - median).abs() < 0.5, "{overshoot}");
}

/// Two files are a mixture; a calm has no process noise; another length is scaled by Froude.
#[test]
fn models_are_mixed_calmed_and_scaled() {
    let desk = with_fit();
    let run = ["predict", "f/fit.json", "f/fit.json", "--calm", "--draws", "100", "--manoeuvre", "zig-zag:10/10"];
    desk.run(&[&run[..], &["--out", "c"]].concat()).is_done();
    let json = desk.json("c/predict.json");
    assert_eq!((json["models"].as_array().map(Vec::len), &json["calm"]), (Some(2), &Value::Bool(true)));
    let time = |json: &Value| {
        let figure = figure(json, "zig-zag 10/10", "second_execute_s");
        (figure["median"].as_f64().expect("a number"), figure["shares"]["process-noise"].as_f64())
    };
    let (own, noise) = time(&json);
    assert!(noise.is_none_or(|share| share == 0.0));
    desk.run(&[&run[..], &["--out", "s", "--length-m", "300"]].concat()).is_done();
    let (larger, _) = time(&desk.json("s/predict.json"));
    assert!((larger / own - 2.0).abs() < 0.01, "four times as long is twice as slow: {own} {larger}");
}

/// A ship whose rudder is off by 20 deg makes no 10/10, but a circle.
#[test]
fn a_manoeuvre_that_the_model_cannot_make_is_left_out() {
    let desk = with_fit();
    let mut json = desk.json("f/fit.json");
    for ship in json["ships"].as_object_mut().expect("ships").values_mut() {
        ship["members"][0]["parameters"][2] = (-0.35).into();
    }
    desk.file("off.json", json.to_string());
    let run = desk.run(&["predict", "off.json", "--draws", "50", "--out", "p"]);
    assert!(run.is_done().err.contains("zig-zag 10/10: only 0 of 50"), "{}", run.err);
    let kinds = desk.json("p/predict.json")["manoeuvres"].as_array().map(Vec::len);
    assert!(kinds.is_some_and(|count| (1..3).contains(&count)), "{kinds:?}");
    let alone = ["predict", "off.json", "--draws", "50", "--manoeuvre", "zig-zag:10/10"];
    desk.run(&alone).is_refused(2, &["only 0 of 50"]);
}

#[test]
fn what_cannot_be_predicted_is_refused_with_the_cure() {
    let desk = with_fit();
    let refused = |arguments: &[&str], parts: &[&str]| {
        desk.run(&[&["predict"][..], arguments].concat()).is_refused(2, parts);
    };
    refused(&["nowhere.json"], &["nowhere.json"]);
    refused(&["f/fit.json", "--method", "magic"], &["--method magic", "output-error"]);
    refused(&["f/fit.json", "--manoeuvre", "circle:35"], &["circle:35", "turning-circle:RUDDER"]);
    refused(&["f/fit.json", "--draws", "3"], &["--draws"]);
    desk.file("text.json", "not json");
    refused(&["text.json"], &["text.json", "no JSON"]);
    desk.file("other.json", r#"{"schema": "rows/1"}"#);
    refused(&["other.json"], &["rows/1", "fit.json or trace.json"]);
    desk.file("old.json", r#"{"schema": "fit/1", "methods": []}"#);
    refused(&["old.json"], &["old.json", "older program", "study fit"]);
    let text = String::from_utf8(desk.bytes("f/fit.json")).expect("text");
    desk.file("broken.json", text.replace("\"fitted\"", "\"fited\""));
    refused(&["broken.json"], &["broken.json", "fitted"]);
    // Without the sidecar beside it nobody knows how long the ship is.
    desk.file("plain.csv", std::fs::read(record("first-order")).expect("it is in the repository"));
    desk.run(&["fit", "plain.csv", "--out", "g", "--quiet"]).is_done();
    refused(&["g/fit.json", "--length-m", "300"], &["length and speed", "give them to fit or trace"]);
}
