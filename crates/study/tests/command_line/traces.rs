//! Tests of `study trace` on valid and invalid records.

use std::sync::Arc;

use serde_json::Value;
use ship::effects::{Effect, SecondOrder, listed_effect};
use ship::ships::ShipModel;
use ship::{ResponseModel, Ship, ships};

use crate::desk::{Desk, with_column, zig_zag_csv, zig_zag_csv_of};

/// YUKUN with sway coupling of second order, T₂ = 2.5 s and T₃ = 6.2 s.
pub fn second_order() -> Ship {
    with_effect(Arc::new(SecondOrder), &[2.5, 6.2])
}

fn with_effect(effect: Arc<dyn Effect>, values: &[f64]) -> Ship {
    let mut ship = ships::find_ship("yukun").expect("it is in the registry");
    let ShipModel::Response(response) = &ship.model else { panic!("a response ship") };
    let mut parameters = response.parameters().to_vec();
    parameters.extend(values);
    ship.model = ShipModel::Response(ResponseModel::new(vec![effect]).with_parameters(parameters));
    ship
}

/// Asserts properties of a trace that its schema does not state, for `trials` fitted and `others` held-out records:
/// numbers of entries, order of weights, ranges of coverages, errors at the horizon of 20 s.
fn keeps_the_contract(json: &Value, trials: usize, others: usize) {
    assert_eq!(json["schema"], "trace/4");
    assert!(json["headline"].as_str().is_some_and(|text| text.ends_with('.')), "{}", json["headline"]);
    for key in ["K_per_s", "T_s", "delta_r_deg"] {
        assert!(json["base"][key]["value"].is_f64() && json["base"][key]["sd"].is_f64(), "{key}");
    }
    for effect in json["effects"].as_array().expect("a list") {
        assert!(["probability", "delta_bic", "p_value"].iter().all(|key| effect[*key].is_number()), "{effect}");
        assert!(effect["evidence"].as_str().is_some_and(|text| text.len() > 20));
        let by_odds = effect["probability_by_prior_odds"].as_array().map(Vec::len);
        assert_eq!(by_odds, json["prior"]["odds_factors"].as_array().map(Vec::len), "{effect}");
    }
    let structures = json["structures"].as_array().expect("a list");
    let weights: Vec<f64> = structures.iter().filter_map(|one| one["weight"].as_f64()).collect();
    assert!(weights.len() == structures.len() && weights.is_sorted_by(|one, next| one >= next), "{weights:?}");
    let [fitted, judged] = ["/error/identification", "/error/validation"];
    let counts =
        [("/candidates", 12), ("/records", trials + others), ("/noise", trials), (fitted, trials), (judged, others)];
    for (key, count) in counts {
        assert_eq!(json.pointer(key).and_then(Value::as_array).map(Vec::len), Some(count), "{key}");
    }
    for record in [fitted, judged].iter().filter_map(|key| json.pointer(key)?.as_array()).flatten() {
        assert!(["before", "after"].iter().all(|when| record[when]["horizon_rmse_deg"]["20"].is_f64()), "{record}");
        let coverage = record["after"]["band_coverage_95"].as_f64();
        assert!(coverage.is_some_and(|share| (0.0..=1.0).contains(&share)), "{record}");
        assert!(record["after"]["band_width_95_deg"].as_f64().is_some_and(|width| width > 0.0), "{record}");
    }
    for (key, is_unseen) in [(fitted, false), (judged, true)] {
        let errors = || json.pointer(key).and_then(Value::as_array).into_iter().flatten();
        for on in errors() {
            let error = on["horizons"].as_array().and_then(|all| all.iter().find(|error| error["horizon_s"] == 20.0));
            let expected = is_unseen.then(|| on["after"]["horizon_rmse_deg"]["20"].as_f64());
            assert_eq!(error.map(|error| error["after_deg"].as_f64()), expected, "{on}");
        }
        let is_there = |name: &str, on: &Value| on[name].is_f64() == is_unseen;
        let names = ["with_own_bias_deg", "with_own_moment_deg"];
        assert!(
            errors().all(|on| names.iter().all(|name| ["before", "after"].iter().all(|at| is_there(name, &on[at]))))
        );
    }
    assert!(json["next_trial"].as_str().is_some_and(|text| !text.is_empty()));
    assert!(json["model"]["parameters"].as_array().is_some_and(|all| all.len() >= 3));
}

#[test]
fn an_undeclared_effect_is_named_and_everything_is_written() {
    let desk = Desk::new();
    desk.file("run.csv", zig_zag_csv_of(&second_order()));
    desk.file("other.csv", zig_zag_csv_of(&second_order()));
    let run = desk.draw(&["trace", "run.csv", "--validate", "other.csv"]);
    run.is_done();
    for part in ["The first-order response lacks second order", "held-out records ", "noise: ", "next trial: "] {
        assert!(run.out.contains(part), "{part}: {}", run.out);
    }
    assert!(run.err.contains("validates nothing"), "the same record twice is worth a warning: {}", run.err);
    let json = desk.json("run-trace/trace.json");
    keeps_the_contract(&json, 1, 1);
    let codes: Vec<&Value> = json["warnings"].as_array().into_iter().flatten().map(|own| &own["code"]).collect();
    assert!(codes.contains(&&"repetition".into()), "{codes:?}");
    assert_eq!(json["verdict"], "traced");
    assert_eq!(json["effects"][0]["id"], "second_order");
    assert!(json["effects"][0]["delta_bic"].as_f64().is_some_and(|change| change < -10.0));
    let errors = &json["error"]["identification"][0];
    assert!(errors["after"]["heading_rmse_deg"].as_f64() < errors["before"]["heading_rmse_deg"].as_f64());
    let report = desk.text("run-trace/report.md");
    let parts = [
        "Overshoots",
        "Records that were not fitted",
        "Do not use it for",
        "What is left",
        "Next trial",
        "Every record",
        "Evidence",
        "Model",
        "Settings",
    ];
    let found: Vec<usize> = parts.iter().filter_map(|part| report.find(&format!("\n## {part}\n"))).collect();
    assert!(found.len() == parts.len() && found.is_sorted(), "{found:?}");
    for part in ["Effects", "Candidates", "Noise"] {
        assert!(report.contains(&format!("\n### {part}\n")), "{part}");
    }
    let figures =
        ["hero", "record", "residual", "evidence", "innovations", "held-out-residuals", "held-out", "staircase"];
    for figure in figures {
        assert!(desk.path(&format!("run-trace/{figure}.png")).exists(), "{figure}");
        assert!(report.contains(&format!("({figure}.png)")), "{figure}");
    }
    let page = include_str!("../../../../docs/src/reference/files.md");
    let tables = [
        ("replay", 100),
        ("replay-other", 100),
        ("innovations", 100),
        ("staircase", 100),
        ("missing-moment-run", 100),
        ("missing-moment-run-curves", 20),
    ];
    for (file, rows) in tables {
        let table = desk.text(&format!("run-trace/{file}.csv"));
        let head = table.lines().next().unwrap_or_default();
        for column in head.split(',') {
            let listed = column.replace("before_", "MODEL_").replace("after_", "MODEL_");
            let of_channel = column.find("_moment").or(column.find("_half")).or(column.find("_explained"));
            let of_channel = of_channel.map_or_else(String::new, |at| format!("CHANNEL{}", &column[at..]));
            let of_step = column.replace(|letter: char| letter.is_numeric(), "N");
            let names = [column, &listed, &of_channel, &of_step];
            assert!(names.iter().any(|name| page.contains(&format!("`{name}`"))), "{file}.csv: {column}");
        }
        assert!(table.lines().count() > rows, "{file}.csv: {head}");
    }
}

/// The page begins with the finding, which has the error ratios of fitted and held-out records; the evidence is folded,
/// figures are numbered without gaps, and no caption is repeated.
#[test]
fn the_page_begins_with_the_finding_and_its_figure() {
    let desk = Desk::new();
    desk.file("run.csv", zig_zag_csv_of(&second_order()));
    desk.file("other.csv", zig_zag_csv_of(&second_order()));
    desk.draw(&["trace", "run.csv", "--validate", "other.csv", "--out", "t", "--quiet"]).is_done();
    let report = desk.text("t/report.md");
    let mut paragraphs = report.split("\n\n");
    let (title, headline) = (paragraphs.next().unwrap_or_default(), paragraphs.next().unwrap_or_default());
    assert_eq!(title, "# Trace of run: a 10/10 zig-zag, first to starboard");
    for part in
        ["**The first-order response lacks second order", " %; held-out records ", "In replays restarted every 60 s: "]
    {
        assert!(headline.contains(part), "{part}: {headline}");
    }
    assert!(paragraphs.next().is_some_and(|physics| physics.starts_with("- **second order**: sway")), "{report}");
    assert!(
        paragraphs
            .next()
            .is_some_and(|glance| glance.contains("| 1 fitted     |") && glance.contains("| 1 not fitted |"))
    );
    assert_eq!(paragraphs.next(), Some("![Figure 1](staircase.png)"));
    let numbers = report.match_indices("![Figure ").map(|(at, mark)| report[at + mark.len()..].split(']').next());
    let numbers: Vec<usize> = numbers.map(|cell| cell.and_then(|text| text.parse().ok()).expect("a cell")).collect();
    assert_eq!(numbers, (1..=numbers.len()).collect::<Vec<_>>(), "figures are numbered without gaps");
    let page = desk.text("t/report.html");
    let (shown, folded) = page.split_once("<main").and_then(|(_, main)| main.split_once("<details>")).expect("parts");
    assert_eq!(
        shown.matches("<figure>").count(),
        5,
        "what each effect carries, overshoots, and of held-out records examples, residuals and errors ahead"
    );
    assert!(report.contains("(horizon.png)") && report.contains("(prior-odds.png)"), "{report}");
    assert!(shown.matches("<table").count() == 2 && folded.contains(">Evidence</h2></summary>"));
    let caption = "(a), (b): a fitted record.";
    assert_eq!((report.matches(caption).count(), page.matches(caption).count()), (1, 1));
    desk.draw(&["trace", "run.csv", "--out", "alone", "--quiet"]).is_done();
    let alone = desk.text("alone/report.md");
    assert!(alone.contains("![Figure 1](staircase.png)") && alone.contains("](record.png)"), "{alone}");
    assert!(!desk.path("alone/hero.png").exists());
}

/// If the model fails on a held-out record with more rudder than the fitted records, the limits state it and the next
/// trial has that rudder.
#[test]
fn a_failure_beyond_the_fitted_rudder_is_a_limit_and_the_next_trial() {
    let desk = Desk::new();
    let run = zig_zag_csv_of(&second_order());
    desk.file("run.csv", &run);
    desk.file("other.csv", &run);
    desk.file("stalled.csv", with_column(&run, "rudder_deg", |_, delta| (2.0 * delta).to_string()));
    desk.draw(&["trace", "run.csv", "--validate", "other.csv", "--validate", "stalled.csv", "--out", "t", "--quiet"])
        .is_done();
    let page = desk.text("t/report.md");
    let limit = "largest in the fitted records. There the 95 % band holds ";
    let next = "First a trial with 20° of rudder: beyond the fitted 10° the model fails, and its 95 % band holds ";
    assert!(page.contains(limit) && page.contains(" % of the headings of stalled (") && page.contains(next), "{page}");
    let figure = desk.text("t/hero.svg");
    assert!(["stalled", "other"].iter().all(|name| figure.contains(&format!(">\n{name}\n"))), "{figure}");
}

/// `study report` makes page and figures from `trace.json` and the tables next to it, with the same bytes.
#[test]
fn a_trace_is_drawn_again_from_its_files() {
    let desk = Desk::new();
    desk.file("run.csv", zig_zag_csv_of(&second_order()));
    desk.draw(&["trace", "run.csv", "--out", "t", "--quiet"]).is_done();
    desk.run(&["report", "t", "--out", "again", "--quiet"]).is_done();
    for file in ["report.md", "report.html", "record.svg", "residual.svg", "evidence.svg", "missing-moment-run.svg"] {
        assert!(desk.bytes(&format!("t/{file}")) == desk.bytes(&format!("again/{file}")), "{file}");
    }
    let text = desk.text("t/trace.json");
    desk.file("t/trace.json", text.replacen("\"headline\": \"", "\"headline\": \"Told anew. ", 1));
    assert!(desk.run(&["report", "t"]).is_done().out.starts_with("Told anew. "));
    desk.file("t/replay.csv", "t_s,heading_deg\n0,0\n");
    desk.run(&["report", "t"]).is_refused(2, &["replay.csv", "study trace"]);
    desk.file("bad/trace.json", "{}");
    desk.run(&["report", "bad"]).is_refused(2, &["trace.json", "study trace"]);
}

/// Every fitted record has tables and a figure of the moment that the base lacks; held-out records have none.
#[test]
fn the_missing_moment_is_written() {
    let desk = Desk::new();
    desk.file("Run 1.csv", zig_zag_csv_of(&with_effect(listed_effect("nonlinear_damping", "r³"), &[60.0])));
    desk.file("other.csv", zig_zag_csv());
    desk.draw(&["trace", "Run 1.csv", "--validate", "other.csv", "--out", "here", "--quiet"]).is_done();
    let json = desk.json("here/trace.json");
    let records = json["missing_moment"].as_array().expect("a list");
    assert_eq!((records.len(), records[0]["file"].as_str()), (1, Some("Run 1.csv")));
    assert_eq!(records[0]["moment"], "missing-moment-run-1.csv");
    let best = &records[0]["over"][0];
    assert_eq!((&best["channel"], &best["shows"]), (&Value::from("yaw rate"), &Value::from(true)), "{records:?}");
    assert!(best["inside"].as_array().is_some_and(|inside| inside.contains(&"nonlinear_damping".into())), "{best}");
    let table = desk.text("here/missing-moment-run-1.csv");
    let mut lines = table.lines();
    assert_eq!(
        lines.next(),
        Some(
            "t_s,moment_rudder_deg,sd_rudder_deg,lower95_rudder_deg,upper95_rudder_deg,explained_rudder_deg,\
             yaw_rate_deg_s,rudder_deg,heading_deg"
        )
    );
    let rows: Vec<Vec<f64>> =
        lines.map(|line| line.split(',').map(|value| value.parse().expect("a number")).collect()).collect();
    assert!(rows.len() > 100 && rows.iter().all(|row| row.len() == 9 && row[3] <= row[1] && row[1] <= row[4]));
    let report = desk.text("here/report.md");
    for ending in ["png", "svg"] {
        assert!(desk.path(&format!("here/missing-moment-run-1.{ending}")).exists(), "{ending}");
    }
    assert!(report.contains("(missing-moment-run-1.png)") && report.contains("its curve over the yaw rate explains"));
}

#[test]
fn a_complete_base_is_clean_and_the_exit_code_does_not_judge() {
    let desk = Desk::new();
    desk.file("run.csv", zig_zag_csv());
    let run = desk.run(&["trace", "run.csv", "--out", "here", "--format", "csv"]);
    run.is_done();
    assert!(run.out.starts_with("record,use,model,") && run.out.lines().count() == 3, "{}", run.out);
    let json = desk.json("here/trace.json");
    keeps_the_contract(&json, 1, 0);
    assert_eq!((json["verdict"].as_str(), json["effects"].as_array().map(Vec::len)), (Some("clean"), Some(0)));
}

/// In gusts the 95 % band from the estimated noise holds only 58 % of the headings: the noise does not describe the
/// record, and the verdict is `disturbed`, not `clean`.
#[test]
fn a_record_beside_its_own_band_is_not_clean() {
    let desk = Desk::new();
    desk.file(
        "gusts.toml",
        "question = \"?\"\nseed = 11\nreplicates = 26\nship.first-order = { K-per-s = 0.1, T-s = 16.3 }\n\
         manoeuvre.zig-zag = { rudder-deg = 10.0, heading-deg = 10.0 }\nsteering-gear.rate-deg-s = 2.5\n\
         recording = { sampling-s = 1.0, duration-s = 300.0 }\nsensor.heading-noise-deg = 0.1\n\
         disturbance.gusts = { sd-deg = 0.5, correlation-s = 20.0 }\nidentifier = [{ method.output-error = {} }]\n",
    );
    desk.run(&["simulate", "gusts.toml", "--replicate", "25", "--out", "run.csv", "--quiet"]).is_done();
    let run = desk.run(&["trace", "run.csv", "--out", "here"]);
    run.is_done();
    let json = desk.json("here/trace.json");
    let coverage = json["error"]["identification"][0]["after"]["band_coverage_95"].as_f64().expect("a band");
    assert!(coverage < 0.7, "{coverage}");
    let noise = &json["noise"][0]["describes_what_is_left"];
    assert_eq!((json["verdict"].as_str(), noise.as_bool()), (Some("disturbed"), Some(false)));
    let said = "the 95 % band holds 175 of 301 headings of run, 58 % [";
    assert!(run.out.contains(said) && desk.text("here/report.md").contains(said), "{}", run.out);
}

#[test]
fn a_record_that_cannot_be_traced_is_refused() {
    let desk = Desk::new();
    let good = zig_zag_csv();
    desk.file("still.csv", with_column(&good, "rudder_deg", |_, _| "0".into()));
    desk.run(&["trace", "still.csv"]).is_refused(2, &["still.csv"]);
    desk.run(&["trace", "none.csv"]).is_refused(2, &["none.csv"]);
    desk.run(&["trace"]).is_refused(2, &["TRIAL"]);
    desk.file("run.csv", &good);
    desk.run(&["trace", "run.csv", "--validate", "none.csv"]).is_refused(2, &["none.csv"]);
    desk.run(&["trace", "run.csv", "--without", "heading"]).is_refused(2, &["heading", "wind"]);
    assert!(!desk.path("run-trace").exists());
}

/// A withheld column counts as missing, and a folder of sidecars is searched for the name of the record.
#[test]
fn columns_can_be_withheld_and_described_in_a_folder() {
    let desk = Desk::new();
    let plain = zig_zag_csv();
    let windy: String = plain
        .lines()
        .enumerate()
        .map(|(row, line)| match row {
            0 => format!("{line},wind_relative_speed_m_s,wind_relative_from_deg\n"),
            _ => format!("{line},{},{}\n", 8.0 + (0.05 * row as f64).sin(), 40.0 + 30.0 * (0.02 * row as f64).cos()),
        })
        .collect();
    desk.file("plain.csv", &plain);
    desk.file("windy.csv", &windy);
    desk.run(&["trace", "windy.csv", "--quiet"]).is_done();
    desk.run(&["trace", "windy.csv", "--without", "wind", "--out", "withheld", "--quiet"]).is_done();
    desk.run(&["trace", "plain.csv", "--quiet"]).is_done();
    let forms = |name: &str| {
        let json = desk.json(name);
        let wind = json["candidates"].as_array().into_iter().flatten().find(|one| one["id"] == "wind_moment").cloned();
        wind.map_or(0, |wind| wind["forms"].as_array().map_or(0, Vec::len))
    };
    assert_eq!(
        (forms("windy-trace/trace.json"), forms("withheld/trace.json"), forms("plain-trace/trace.json")),
        (2, 1, 1)
    );
    desk.file("sidecars/windy.trial.toml", "[part]\nfrom-s = 0.0\nuntil-s = 200.0\n");
    desk.run(&["trace", "windy.csv", "--columns", "sidecars", "--out", "cut"]).is_done();
}

#[test]
fn effects_can_be_asked_for_and_excluded() {
    let desk = Desk::new();
    desk.file("run.csv", zig_zag_csv_of(&second_order()));
    let run = desk.run(&["trace", "run.csv", "--with", "speed_loss,moment_drift", "--out", "with"]);
    run.is_done();
    assert!(run.out.contains(", asked for"), "{}", run.out);
    let effects = |name: &str| {
        let json = desk.json(name);
        let all = json["effects"].as_array().cloned().unwrap_or_default();
        all.iter().map(|one| (one["id"].as_str().unwrap_or("").to_owned(), one["asked"] == true)).collect::<Vec<_>>()
    };
    let with = effects("with/trace.json");
    assert!(["speed_loss", "moment_drift"].iter().all(|id| with.contains(&((*id).to_owned(), true))), "{with:?}");
    // With required effects that the ship lacks, her sway coupling is named, or located as a moment of the rudder
    // history.
    let located = desk.json("with/trace.json")["located"].to_string();
    let is_seen = with.contains(&("second_order".to_owned(), false)) || located.contains("history of the rudder");
    assert!(is_seen, "{with:?} {located}");
    desk.run(&["trace", "run.csv", "--only", "second_order", "--out", "only", "--quiet"]).is_done();
    assert_eq!(effects("only/trace.json"), [("second_order".to_owned(), true)]);
    keeps_the_contract(&desk.json("only/trace.json"), 1, 0);
    desk.run(&["trace", "run.csv", "--without-effect", "second_order", "--out", "without", "--quiet"]).is_done();
    assert!(effects("without/trace.json").iter().all(|(id, _)| id != "second_order"));
    desk.run(&["trace", "run.csv", "--with", "sway"]).is_refused(2, &["sway", "second_order"]);
    desk.run(&["trace", "run.csv", "--rule", "pastis"]).is_refused(2, &["pastis", "posterior"]);
    desk.run(&["trace", "run.csv", "--only", "speed_los"]).is_refused(2, &["did you mean `speed_loss`"]);
    desk.run(&["trace", "run.csv", "--only", "wind_moment", "--with", "speed_loss"]).is_refused(2, &["--only"]);
    desk.run(&["trace", "run.csv", "--only", "sway_coupling_measured"]).is_refused(2, &["sway velocity", "run.csv"]);
    let both = ["trace", "run.csv", "--with", "speed_loss", "--without-effect", "speed_loss"];
    desk.run(&both).is_refused(2, &["without-effect", "speed_loss"]);
}

/// If no record is held out, each of several records is left out in turn.
#[test]
fn runs_are_left_out_in_turn() {
    let desk = Desk::new();
    desk.file("one.csv", zig_zag_csv_of(&second_order()));
    desk.file("two.csv", zig_zag_csv_of(&second_order()));
    let run = desk.run(&["trace", "one.csv", "two.csv", "--out", "both"]);
    run.is_done();
    assert!(run.out.contains("records left out in turn "), "{}", run.out);
    let json = desk.json("both/trace.json");
    keeps_the_contract(&json, 2, 0);
    let folds = json["error"]["leave_one_out"].as_array().expect("a list");
    assert_eq!(folds.len(), 2);
    let heading = |fold: &Value, when: &str| fold[when]["heading_rmse_deg"].as_f64().expect("a number");
    assert!(folds.iter().all(|fold| heading(fold, "after") < 0.5 * heading(fold, "before")), "{folds:?}");
    assert!(json["effects"][0]["probability"].as_f64().is_some_and(|probability| probability > 0.9));
    desk.run(&["trace", "one.csv", "--validate", "two.csv", "--quiet"]).is_done();
    assert!(desk.json("one-trace/trace.json")["error"].get("leave_one_out").is_none());
}
