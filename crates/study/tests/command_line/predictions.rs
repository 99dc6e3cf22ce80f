//! Tests of `study predict` on documents of `study fit` and `study trace`.

use parquet::record::Field;
use serde_json::Value;

use crate::desk::{Desk, Run, number, of_repository};

fn record(name: &str) -> String {
    of_repository(&format!("scenarios/records/{name}.csv")).to_string_lossy().into_owned()
}

/// Folder with a fit of the record of a first-order ship by the usual methods, `f/fit.json`, and the record with a
/// sidecar, `run.csv`.
fn with_fit() -> Desk {
    let desk = Desk::new();
    desk.file("run.csv", std::fs::read(record("first-order")).expect("it is in the repository"));
    desk.file("run.trial.toml", DECLARED);
    let fit = ["fit", &record("first-order"), "--out", "f", "--quiet", "--length-m", "75", "--speed-m-s", "6.2"];
    desk.run(&fit).is_done();
    desk
}

fn predict(desk: &Desk, words: &str) -> Run {
    desk.run(&["predict"].into_iter().chain(words.split(' ')).collect::<Vec<_>>())
}

/// Writes the file `name`: `f/fit.json` with every ship changed.
fn changed(desk: &Desk, name: &str, change: impl Fn(&mut Value)) {
    let mut json = desk.json("f/fit.json");
    json["ships"].as_object_mut().expect("ships").values_mut().for_each(change);
    desk.file(name, json.to_string());
}

fn figure<'a>(json: &'a Value, kind: &str, name: &str) -> &'a Value {
    let own = json["manoeuvres"].as_array().expect("a list").iter().find(|one| one["kind"] == kind);
    &own.unwrap_or_else(|| panic!("{kind}: {json}"))["figures"][name]
}

/// Asserts properties of a prediction that its schema does not state: sums of weights and shares, order of medians and
/// interval ends, ranges of probabilities.
fn keeps_the_contract(json: &Value) {
    assert_eq!(json["schema"], "predict/2");
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
    }
}

fn criteria(json: &Value) -> Vec<&str> {
    json["imo"].as_array().into_iter().flatten().filter_map(|one| one["criterion"].as_str()).collect()
}

/// In a 10/10 the first overshoot of the ship is 6.82°; the IMO limit for 75 m at 6.2 m/s is 11.0°.
#[test]
fn a_fit_tells_the_trials_of_the_imo() {
    let desk = with_fit();
    let run = desk.draw(&["predict", "f/fit.json", "--out", "p", "--draws", "200"]);
    assert!(run.is_done().out.contains("IMO MSC.137(76)"), "{}", run.out);
    let json = desk.json("p/predict.json");
    keeps_the_contract(&json);
    let first = figure(&json, "zig-zag 10/10", "first_overshoot_deg");
    assert!((first["median"].as_f64().expect("a number") - 6.82).abs() < 0.1, "{first}");
    assert_eq!(first["extrapolated"], false);
    assert_eq!(figure(&json, "zig-zag 20/20", "first_overshoot_deg")["extrapolated"], true);
    let names = criteria(&json);
    assert_eq!(names, ["initial turning", "10/10 first overshoot", "10/10 second overshoot", "20/20 first overshoot"]);
    for file in ["report.md", "zig-zag-10-10.png", "zig-zag-10-10.csv", "imo-overshoots.svg", "turning-circle-35.png"] {
        assert!(!desk.bytes(&format!("p/{file}")).is_empty(), "{file}");
    }
    // A repeated prediction has the same bytes; with `--format csv` standard output is a table alone.
    let again = predict(&desk, "f/fit.json --out q --draws 200 --threads 1 --format csv");
    assert!(again.is_done().out.starts_with("manoeuvre,figure"), "{}", again.out);
    assert_eq!(desk.bytes("p/predict.json"), desk.bytes("q/predict.json"));
}

#[test]
fn a_trace_predicts_and_its_own_record_is_inside() {
    let desk = Desk::new();
    let damping = record("undeclared-damping");
    desk.run(&["trace", &damping, "--out", "t", "--quiet"]).is_done();
    let kinds = ["spiral:15", "pull-out:20", "williamson", "initial-turning:10", "zig-zag:-20/20"];
    let asked = kinds.map(|kind| format!("--manoeuvre {kind} ")).concat();
    let run = predict(&desk, &format!("t/trace.json {asked}--replay {damping} --draws 200 --out p"));
    assert!(run.is_done().err.contains("t/trace.json is fitted to it; the error on it validates nothing"));
    let json = desk.json("p/predict.json");
    keeps_the_contract(&json);
    assert!(json["warnings"].as_array().into_iter().flatten().any(|own| own["code"] == "repetition"), "{json}");
    assert_eq!(json["manoeuvres"].as_array().map(Vec::len), Some(5));
    let criteria = criteria(&json);
    assert_eq!(criteria, ["initial turning", "20/20 first overshoot"]);
    assert_eq!(figure(&json, "spiral 15", "loop_width_deg")["median"], 0.0);
    let replay = &json["replays"][0];
    assert!(replay["band_coverage_90"].as_f64().expect("a share") > 0.6, "{replay}");
    let overshoot = &replay["figures"]["first_overshoot_deg"];
    let [measured, median] = ["measured", "median"].map(|key| overshoot[key].as_f64().expect("a number"));
    assert!((measured - median).abs() < 0.5, "{overshoot}");
}

/// Several models are mixed, `--calm` removes the random moment, and `--length-m` scales by Froude's law.
#[test]
fn models_are_mixed_calmed_and_scaled() {
    let desk = with_fit();
    changed(&desk, "model.json", |ship| (ship["length_m"], ship["speed_m_s"]) = (3.0.into(), 1.24.into()));
    let run = "f/fit.json f/fit.json --calm --draws 100 --manoeuvre zig-zag:10/10 --out";
    predict(&desk, &format!("{run} c")).is_done();
    let json = desk.json("c/predict.json");
    assert_eq!((json["models"].as_array().map(Vec::len), &json["calm"]), (Some(2), &Value::Bool(true)));
    let time = |json: &Value| {
        let figure = figure(json, "zig-zag 10/10", "second_execute_s");
        (figure["median"].as_f64().expect("a number"), figure["shares"]["process-noise"].as_f64())
    };
    let (own, noise) = time(&json);
    assert!(noise.is_none_or(|share| share == 0.0));
    predict(&desk, &format!("{run} s --length-m 300")).is_done();
    let (larger, _) = time(&desk.json("s/predict.json"));
    assert!((larger / own - 2.0).abs() < 0.01, "four times as long is twice as slow: {own} {larger}");
    let both = "f/fit.json model.json --draws 50 --manoeuvre zig-zag:10/10 --out m";
    let sizes = "model.json: its ship is 3.00 m long at 1.24 m/s, that of f/fit.json 75.00 m long at 6.20 m/s";
    predict(&desk, both).is_refused(2, &[sizes, "give --length-m and --speed-kn", "one at a time"]);
    let run = predict(&desk, &format!("{both} --length-m 300 --speed-m-s 1.2"));
    assert!(run.is_done().err.contains("300 m at 1.200 m/s is a Froude number of 0.022"), "{}", run.err);
    let json = desk.json("m/predict.json");
    assert_eq!((&json["length_m"], &json["speed_m_s"]), (&300.0.into(), &1.2.into()));
}

/// The period of a record with four executes is that of its only cycle, from execute 2 to execute 4, measured and
/// predicted.
#[test]
fn a_period_is_of_the_cycles_of_the_record() {
    let desk = with_fit();
    let text = desk.text("run.csv");
    desk.file("run.csv", text.lines().take(195).collect::<Vec<_>>().join("\n"));
    predict(&desk, "f/fit.json --replay run.csv --draws 200 --out p").is_done();
    let figures = &desk.json("p/predict.json")["replays"][0]["figures"];
    for key in ["measured", "median"] {
        let of = |name: &str| figures[name][key].as_f64().unwrap_or_else(|| panic!("{name}: {figures}"));
        let cycle = of("fourth_execute_s") - of("second_execute_s");
        assert!(figures["fifth_execute_s"].is_null() && (of("period_s") - cycle).abs() < 0.02, "{key}: {figures}");
    }
}

/// The ship of the replayed record or of the sidecar, 105 m long, sets the scale of the prediction; options override
/// it. No IMO criterion applies to a circle with 10° of rudder. For a ship of 75 m the page states that the criteria
/// are for ships of 100 m and above.
#[test]
fn the_ship_of_the_record_is_the_scale() {
    let desk = with_fit();
    let first = record("first-order");
    let predicted = |rest: &str| {
        let run = "f/fit.json --manoeuvre zig-zag:10/10 --manoeuvre turning-circle:10 --draws 50 --out p";
        predict(&desk, &format!("{run}{rest}")).is_done();
        let (words, json) = (desk.text("p/report.md"), desk.json("p/predict.json"));
        assert!(json["imo"].as_array().expect("a list").iter().all(|one| one["manoeuvre"] == "zig-zag 10/10"));
        let time = figure(&json, "zig-zag 10/10", "second_execute_s")["median"].as_f64().expect("a number");
        (time, words.contains("the criteria are for ships of 100 m and above"))
    };
    let (own, is_said) = predicted("");
    assert!(is_said && desk.text("f/report.md").contains("the criteria are for ships of 100 m and above"));
    let length_over_speed = |length: f64, speed: f64| (length / speed) / (75.0 / 6.2);
    for (rest, slower, is_short) in [
        (format!(" --replay {first}"), length_over_speed(105.0, 8.591_222), false),
        (format!(" --columns {}", first.replace(".csv", ".trial.toml")), length_over_speed(105.0, 8.591_222), false),
        (format!(" --replay {first} --length-m 75 --speed-m-s 6"), length_over_speed(75.0, 6.0), true),
    ] {
        let (time, is_said) = predicted(&rest);
        assert!((time / own / slower - 1.0).abs() < 0.01 && is_said == is_short, "{rest:?}: {time} {own}");
    }
    let both = format!("f/fit.json --replay {first} --replay run.csv");
    predict(&desk, &both).is_refused(2, &["run.csv: its ship is 75.00 m long", "105.00 m long", "give --length-m"]);
}

/// A ship with a rudder bias of 20° completes no 10/10, but a turning circle.
#[test]
fn a_manoeuvre_that_the_model_cannot_make_is_left_out() {
    let desk = with_fit();
    changed(&desk, "off.json", |ship| ship["members"][0]["parameters"][2] = (-0.35).into());
    let run = predict(&desk, "off.json --draws 50 --out p");
    assert!(run.is_done().err.contains("zig-zag 10/10: only 0 of 50"), "{}", run.err);
    let kinds = desk.json("p/predict.json")["manoeuvres"].as_array().map(Vec::len);
    assert!(kinds.is_some_and(|count| (1..3).contains(&count)), "{kinds:?}");
    predict(&desk, "off.json --draws 50 --manoeuvre zig-zag:10/10").is_refused(2, &["only 0 of 50"]);
}

#[test]
fn what_cannot_be_predicted_is_refused_with_the_cure() {
    let desk = with_fit();
    let refused = |words: &str, parts: &[&str]| predict(&desk, words).is_refused(2, parts);
    refused("nowhere.json", &["nowhere.json"]);
    refused("f/fit.json --method magic", &["--method magic", "output-error"]);
    refused("f/fit.json --manoeuvre circle:35", &["circle:35", "turning-circle:RUDDER"]);
    refused("f/fit.json --draws 3", &["--draws"]);
    // `study predict` has no option for a draught or for a part of a record.
    refused("f/fit.json --draught-m 8", &["--draught-m"]);
    refused("f/fit.json --replay x.csv --from 10", &["--from"]);
    desk.file("text.json", "not json");
    refused("text.json", &["text.json", "no JSON"]);
    desk.file("other.json", r#"{"schema": "rows/1"}"#);
    refused("other.json", &["rows/1", "fit.json or trace.json"]);
    desk.file("old.json", r#"{"schema": "fit/1", "methods": []}"#);
    refused("old.json", &["old.json: schema = \"fit/1\"", "make it again with `study fit`"]);
    desk.file("bare.json", r#"{"schema": "fit/2", "methods": []}"#);
    refused("bare.json", &["bare.json", "older program", "study fit"]);
    let text = desk.text("f/fit.json");
    desk.file("broken.json", text.replace("\"fitted\"", "\"fited\""));
    refused("broken.json", &["broken.json", "fitted"]);
    // Without a sidecar the length of the ship is unknown.
    desk.file("plain.csv", std::fs::read(record("first-order")).expect("it is in the repository"));
    desk.run(&["fit", "plain.csv", "--out", "g", "--quiet"]).is_done();
    refused("g/fit.json --length-m 300", &["length and speed", "give them to `study fit` or `study trace`"]);
}

/// Writes the file `name`: the fit of a ship at another loading, with 1/T times `damping` and K/T times `gain`.
fn at_another_load(desk: &Desk, name: &str, [damping, gain]: [f64; 2]) {
    changed(desk, name, |ship| {
        let parameters = &mut ship["members"][0]["parameters"];
        for (place, share) in [(0, damping), (1, gain)] {
            parameters[place] = (share * parameters[place].as_f64().expect("a number")).into();
        }
    });
}

fn entry<'a>(json: &'a Value, field: &str, side: &str) -> &'a Value {
    let form = json["form"].as_array().expect("a form");
    let is_it = |one: &&Value| one["field"] == field && (side.is_empty() || one["side"] == side);
    form.iter().find(is_it).unwrap_or_else(|| panic!("{field} {side}: {json}"))
}

/// Sidecar of the record `run.csv`.
const DECLARED: &str = "[ship]\nlength-m = 75.0\nspeed-m-s = 6.2\n[form]\nship-type = \"training | ship\"\nbeam-m = 12.5\n\
                        draught-m = 5.0\nfull-load-draught-m = 5.0\nrudder-area-m2 = 7.5\nwater-depth-m = 15.0\n\
                        wind-beaufort = 6\nsea-state = 3\n";

/// The 10/10 to starboard is measured, that to port predicted; the 20/20 is extrapolated beyond the rudder of the
/// record.
#[test]
fn the_form_of_the_circular_names_the_source_of_every_entry() {
    let desk = with_fit();
    let run = predict(&desk, "f/fit.json --form --replay run.csv --draws 100 --out p");
    assert!(run.is_done().out.contains("trial-form.md"), "{}", run.out);
    let json = desk.json("p/predict.json");
    keeps_the_contract(&json);
    assert_eq!(json["manoeuvres"].as_array().map(Vec::len), Some(6));
    let first = entry(&json, "1st overshoot angle", "starboard");
    assert!((first["value"].as_f64().expect("measured") - 6.82).abs() < 0.1, "{first}");
    assert!(first["source"].as_str().is_some_and(|source| source.starts_with("measured, run.csv ± ")), "{first}");
    let told = entry(&json, "1st overshoot angle", "port");
    // The ship has a rudder bias, so her overshoots to both sides differ.
    let port = told["median"].as_f64().expect("predicted");
    assert!((5.5..6.5).contains(&port), "{told}");
    let source = told["source"].as_str().unwrap_or_default();
    assert!(source.starts_with("predicted from fit.json, 90 % [") && !source.contains("extrapolated"), "{source}");
    let twenty = json["form"].as_array().expect("a list").iter().find(|one| one["limit"] == 25.0).expect("20/20");
    assert_eq!(twenty["extrapolated"], true);
    // Ratios are those of the ship of the sidecar.
    assert_eq!(entry(&json, "L/B", "")["value"], 6.0);
    assert_eq!(entry(&json, "total rudder area/LT", "")["value"], 0.02);
    assert_eq!(entry(&json, "water depth/trial draught", "")["value"], 3.0);
    assert_eq!(entry(&json, "engine type", "")["source"], "not in the records");
    assert_eq!(entry(&json, "loading condition", "")["value"], "tested at full load");
    assert!(entry(&json, "track reach", "")["source"].as_str().is_some_and(|why| why.contains("never predicted")));
    let remarks = json["form_remarks"].to_string();
    for part in ["3.0 mean draughts", "Beaufort 6", "tested to starboard only", "20/20 zig-zag: not tested"] {
        assert!(remarks.contains(part), "{part}: {remarks}");
    }
    let page = desk.text("p/trial-form.md");
    for part in
        ["training \\| ship", "| track reach", "≤ 11.0", "measured, run.csv", "not in the records", "Beaufort 6"]
    {
        assert!(page.contains(part), "{part}\n{page}");
    }
    let widths = |line: &str| line.replace("\\|", "").matches('|').count();
    assert!(page.lines().filter(|line| line.starts_with("| zig-zag")).all(|line| widths(line) == 8), "{page}");
    // Without a record the declared entries come from --columns; without --form there is no form.
    predict(&desk, "f/fit.json --form --draws 50 --columns run.trial.toml --out q").is_done();
    let json = desk.json("q/predict.json");
    assert_eq!(entry(&json, "ship type", "")["source"], "declared with run.trial.toml");
    assert!(entry(&json, "1st overshoot angle", "starboard")["median"].is_f64());
    predict(&desk, "f/fit.json --draws 50 --manoeuvre zig-zag:10/10 --out r").is_done();
    assert!(desk.json("r/predict.json").get("form").is_none() && !desk.path("r/trial-form.md").exists());
}

/// The record is of the ship in ballast; at full load she has less damping and larger overshoots.
#[test]
fn a_trial_in_ballast_is_corrected_to_full_load() {
    let desk = with_fit();
    at_another_load(&desk, "full.json", [0.6, 0.9]);
    desk.file("run.trial.toml", format!("{DECLARED}loading = \"partial\"\n"));
    let run = predict(&desk, "full.json --ballast f/fit.json --replay run.csv --form --out p --draws 200");
    assert!(run.is_done().out.contains("Corrected to full load"), "{}", run.out);
    let json = desk.json("p/predict.json");
    let corrected = &json["corrected"][0];
    assert_eq!((&corrected["full"][0], &corrected["ballast"][0]), (&"full.json".into(), &"f/fit.json".into()));
    let number = |value: &Value| value.as_f64().unwrap_or_else(|| panic!("{corrected}"));
    for (name, kind) in [("first_overshoot_deg", "zig-zag 10/10"), ("second_overshoot_deg", "zig-zag 10/10")] {
        let own = &corrected["figures"][name];
        let truth = number(&figure(&json, kind, name)["median"]);
        assert!(number(&own["ci90"][0]) - 0.1 < truth && truth < number(&own["ci90"][1]) + 0.1, "{own} {truth}");
        assert!(number(&own["factor"]["median"]) > 1.1 && number(&own["median"]) > number(&own["measured"]), "{own}");
        assert!(own["sd"].is_f64() && own["warnings"].is_array());
    }
    let first = entry(&json, "1st overshoot angle", "starboard");
    let source = first["source"].as_str().unwrap_or_default();
    assert!(source.starts_with("measured at partial load, run.csv, and corrected by F/B = 1."), "{source}");
    assert_eq!(entry(&json, "loading condition", "")["value"], "tested at partial load and corrected");
    // The record is replayed with the model in ballast.
    assert!(json["replays"][0]["band_coverage_90"].as_f64().is_some_and(|share| share > 0.6), "{}", json["replays"]);
    let page = desk.text("p/report.md");
    assert!(page.contains("## Corrected to full load") && page.contains("trial-form.md"), "{page}");
    // With F = B the factor is exactly 1.
    predict(&desk, "f/fit.json --ballast f/fit.json --replay run.csv --out s --draws 200").is_done();
    let same = &desk.json("s/predict.json")["corrected"][0]["figures"]["first_overshoot_deg"];
    assert_eq!((&same["factor"]["median"], &same["factor"]["ci90"]), (&1.0.into(), &serde_json::json!([1.0, 1.0])));
    let [measured, low, high] = [&same["measured"], &same["ci90"][0], &same["ci90"][1]].map(number);
    assert!(low < measured && measured < high, "{same}");
}

#[test]
fn a_correction_without_its_trial_is_refused_and_unlike_models_are_told() {
    let desk = with_fit();
    predict(&desk, "f/fit.json --ballast f/fit.json").is_refused(2, &["--ballast", "--replay"]);
    predict(&desk, "f/fit.json --ballast no.json --replay x.csv").is_refused(2, &["no.json"]);
    let damping = record("undeclared-damping");
    desk.run(&["trace", &damping, "--out", "t", "--quiet"]).is_done();
    let first = record("first-order");
    let run = predict(&desk, &format!("t/trace.json --ballast f/fit.json --replay {first} --draws 50 --out p"));
    for part in ["different structure", "different methods: trace at full load", "different scale"] {
        assert!(run.is_done().out.contains(part), "{part}: {}", run.out);
    }
}

/// The record of a scale model is replayed at the scale of the model; the form has the limits of the ship and lengths
/// in ship lengths.
#[test]
fn a_model_is_replayed_as_a_model_and_told_as_a_ship() {
    let desk = with_fit();
    let ship = "--length-m 300 --speed-m-s 7.5";
    let run = predict(&desk, &format!("f/fit.json --form --replay run.csv --draws 50 --out p {ship}"));
    assert!(run.is_done().err.contains("replayed at that scale"), "{}", run.err);
    let json = desk.json("p/predict.json");
    assert!(json["replays"][0]["band_coverage_90"].as_f64().is_some_and(|share| share > 0.6), "{}", json["replays"]);
    let first = entry(&json, "1st overshoot angle", "starboard");
    assert_eq!(first["limit"], 20.0, "L/V = 40 s");
    let turning = "distance to turn 10° with 10° rudder";
    let [measured, told] = [("starboard", "value"), ("port", "median")]
        .map(|(side, key)| entry(&json, turning, side)[key].as_f64().expect("a number"));
    assert!((measured / told - 1.0).abs() < 0.15, "{measured} {told}");
}

/// `draws.parquet` has a row with parameters and figures of every drawn ship; their medians are those of the document.
#[test]
fn the_drawn_ships_are_a_table_on_request() {
    let desk = with_fit();
    let words = "f/fit.json --draws 60 --manoeuvre zig-zag:10/10 --manoeuvre spiral:15 --quiet --out";
    predict(&desk, &format!("{words} plain")).is_done();
    assert!(!desk.path("plain/draws.parquet").exists());
    predict(&desk, &format!("{words} p --draws-file")).is_done();
    predict(&desk, &format!("{words} again --draws-file --threads 1")).is_done();
    assert!(desk.bytes("p/draws.parquet") == desk.bytes("again/draws.parquet"), "one number is one ship");
    assert_eq!(desk.bytes("p/predict.json"), desk.bytes("plain/predict.json"));
    let rows = desk.rows("p/draws.parquet");
    assert_eq!(rows.len(), 60);
    assert!(rows.iter().zip(0..).all(|(row, number)| row["draw"] == Field::Long(number)));
    let [model, structure] = ["f/fit.json", "first_order"].map(|text| Field::Str(text.into()));
    assert!(rows.iter().all(|row| row["model"] == model && row["structure"] == structure), "{:?}", rows[0]);
    assert!(rows.iter().all(|row| number(row, "weight") == 1.0));
    let json = desk.json("p/predict.json");
    for (kind, name) in [("zig-zag 10/10", "first_overshoot_deg"), ("spiral 15", "rate_starboard_deg_s")] {
        let mut values: Vec<f64> = rows.iter().map(|row| number(row, &format!("figure.{kind}.{name}"))).collect();
        values.sort_by(f64::total_cmp);
        let median = figure(&json, kind, name)["median"].as_f64().expect("a number");
        assert!(values[29] <= median && median <= values[30], "{name}: {median} {values:?}");
    }
    let gains: Vec<f64> = rows.iter().map(|row| number(row, "parameter.K_over_T")).collect();
    let mean = gains.iter().sum::<f64>() / 60.0;
    assert!((mean / (0.1 / 16.3) - 1.0).abs() < 0.01 && gains[0] != gains[1], "{mean}");
}
