//! Tests of `study fit` and `study trace` on records of similar ships at different scales.

use crate::desk::{Desk, with_column, zig_zag_csv};

/// Sidecar with length and speed of YUKUN.
const SHIP: &str = "[ship]\nlength-m = 105.0\nspeed-m-s = 8.59\n";

/// Sidecar of her scale model, 1:25, at the same Froude number.
const MODEL: &str = "[ship]\nlength-m = 4.2\nspeed-m-s = 1.718\n";

/// Factor from times of the model to times of the ship, √25.
const FACTOR: f64 = 5.0;

/// Writes a record of the ship, and the same record at the scale of the model.
fn both(desk: &Desk) {
    let ship = zig_zag_csv();
    desk.file("ship.csv", &ship);
    desk.file("ship.trial.toml", SHIP);
    desk.file("model.csv", with_column(&ship, "t_s", |_, t| (t / FACTOR).to_string()));
    desk.file("model.trial.toml", MODEL);
}

fn value(of: &serde_json::Value) -> f64 {
    of["value"].as_f64().expect("a number")
}

#[test]
fn one_record_has_prime_indices_where_its_ship_is_known() {
    let desk = Desk::new();
    both(&desk);
    let run = desk.draw(&["fit", "ship.csv", "--method", "output-error", "--out", "known", "--paper", "85"]);
    assert!(run.is_done().out.contains("prime indices K′ = K L/V"), "{}", run.out);
    let method = &desk.json("known/fit.json")["methods"][0];
    assert!((value(&method["prime"]["K"]) - 0.1 * 105.0 / 8.59).abs() < 1e-3, "{method}");
    assert!((value(&method["prime"]["T"]) - 16.3 * 8.59 / 105.0).abs() < 1e-3, "{method}");
    assert!(method["prime"]["K"]["sd"].is_f64() && method["prime"]["T"]["ci95"].is_array());
    for figure in ["indices.png", "trial.png"] {
        assert!(desk.path(&format!("known/{figure}")).is_file(), "{figure}");
    }
    assert!(!desk.path("known/amplitude.png").exists(), "one record has one amplitude");
    desk.file("unknown.csv", zig_zag_csv());
    let run = desk.run(&["fit", "unknown.csv", "--method", "output-error", "--out", "unknown"]);
    assert!(!run.is_done().out.contains("prime"));
    assert!(desk.json("unknown/fit.json")["methods"][0].get("prime").is_none());
}

#[test]
fn a_model_and_its_ship_are_one_analysis() {
    let desk = Desk::new();
    both(&desk);
    let run = desk.draw(&["fit", "model.csv", "ship.csv", "--method", "output-error", "--out", "fit"]);
    for part in ["together in prime time", "1 record of L = 105 m, V = 8.59 m/s, time × 0.2000", "each scale fitted"] {
        assert!(run.is_done().out.contains(part), "{part}:\n{}", run.out);
    }
    let fit = desk.json("fit/fit.json");
    // Numbers with a dimension are those of the first record, the model; K' is that of both.
    let parameters = &fit["methods"][0]["parameters"];
    assert!((value(&parameters["K_per_s"]) - 0.5).abs() < 1e-3 && (value(&parameters["T_s"]) - 3.26).abs() < 1e-2);
    assert!((value(&fit["methods"][0]["prime"]["K"]) - 1.2224).abs() < 1e-3);
    assert_eq!(fit["scales"]["groups"][1]["length_m"], 105.0);
    let terms = fit["scales"]["comparisons"][0]["terms"].as_array().expect("a list");
    let symbols: Vec<&str> = terms.iter().filter_map(|term| term["symbol"].as_str()).collect();
    assert_eq!(symbols, ["K′", "T′", "1/T′", "K′/T′", "δ_r"]);
    for term in &terms[..4] {
        assert_eq!(term["verdict"], "scales", "{term}");
        assert!(term["own"].as_array().is_some_and(|own| own.len() == 2), "{term}");
    }
    // Characteristics read from a record stay at its scale.
    let period = |k: usize| fit["trials"][k]["zigzag"]["period_s"].as_f64().expect("a zig-zag");
    assert!((period(1) / period(0) - FACTOR).abs() < 1e-3);
    assert!(desk.path("fit/amplitude.png").is_file());
}

/// If the prime response differs between the scales, the terms do not scale.
#[test]
fn a_model_that_answers_otherwise_does_not_scale() {
    let desk = Desk::new();
    both(&desk);
    let slow = with_column(&zig_zag_csv(), "t_s", |_, t| (0.25 * t).to_string());
    desk.file("model.csv", slow);
    let run = desk.run(&["fit", "ship.csv", "model.csv", "--method", "output-error", "--out", "fit"]);
    assert!(run.is_done().out.contains("does not scale") || run.out.contains("do not scale"), "{}", run.out);
    let fit = desk.json("fit/fit.json");
    assert_eq!(fit["scales"]["comparisons"][0]["terms"][3]["verdict"], "does not scale");
}

#[test]
fn a_trace_is_told_without_dimension() {
    let desk = Desk::new();
    both(&desk);
    let run = desk.draw(&["trace", "ship.csv", "model.csv", "--out", "traced", "--paper", "85"]);
    assert!(run.is_done().out.contains("together in prime time"), "{}", run.out);
    let trace = desk.json("traced/trace.json");
    // Records of one amplitude do not exclude a stall, which goes with a larger K.
    assert!((value(&trace["model"]["prime"]["K"]) - 1.2224).abs() < 5e-2, "{}", trace["model"]);
    let parameters = trace["model"]["parameters"].as_array().expect("a list");
    let inverse = parameters.iter().find(|one| one["key"] == "inverse_T").expect("part of the base");
    assert_eq!(inverse["prime"]["unit"], "1");
    assert!((value(&inverse["prime"]) - 105.0 / 8.59 / 16.3).abs() < 2e-3, "{inverse}");
    assert!(
        trace["scales"].as_str().is_some_and(|text| text.contains("1 record of L = 4.20 m")),
        "{}",
        trace["scales"]
    );
    let page = desk.text("traced/report.md");
    for part in ["together in prime time", "Prime values are without dimension", "steady.png"] {
        assert!(page.contains(part), "{part}");
    }
    assert!(desk.path("traced/overshoots.png").is_file());
}

#[test]
fn a_record_without_a_scale_is_not_pooled_with_two() {
    let desk = Desk::new();
    both(&desk);
    desk.file("other.csv", zig_zag_csv());
    for command in ["fit", "trace"] {
        desk.run(&[command, "ship.csv", "model.csv", "other.csv"])
            .is_refused(2, &["2 scales", "length and speed of other", "sidecar"]);
    }
    // Without the model there is one scale, and no sentence on scales.
    let run = desk.run(&["fit", "ship.csv", "other.csv", "--method", "output-error", "--out", "one"]);
    assert!(!run.is_done().out.contains("prime time"), "{}", run.out);
    assert!(desk.json("one/fit.json").get("scales").is_none());
}
