//! Tests of `--prior`: models of earlier trials of the same ship, of a scale model, of another ship, and without a
//! hull.

use serde_json::Value;
use ship::angle::{from_deg, to_deg};
use simulate::{Manoeuvre, Recording, SimulatedShip, Simulation, SteeringGear, StreamKey};

use crate::desk::{Desk, with_column, zig_zag_csv};

const KVLCC2: [&str; 4] = ["--length-m", "320", "--speed-m-s", "7.97"];

fn record(ship: &str, angle_deg: f64, change_deg: f64) -> String {
    let ship = ship::ships::find_ship(ship).expect("it is in the registry");
    zig_zag_with_speed(SimulatedShip::from_ship(&ship), angle_deg, change_deg)
}

/// CSV record of a zig-zag of a hull without noise, with its speed; a row every 4 s.
pub fn zig_zag_with_speed(ship: SimulatedShip, angle_deg: f64, change_deg: f64) -> String {
    let manoeuvre = Manoeuvre::zig_zag(from_deg(angle_deg), from_deg(change_deg));
    let simulation = Simulation {
        gear: SteeringGear::with_rate(from_deg(2.34)),
        recording: Recording { sampling_period: 4.0, duration: Some(1200.0), ..Recording::default() },
        ..Simulation::new(ship, manoeuvre)
    };
    let truth = simulation.run(&StreamKey { seed: 1, cell: 0, replicate: 0 }).expect("a manoeuvre").truth;
    let speed = truth.speed.as_ref().expect("a hull has a speed");
    let mut text = String::from("t_s,heading_deg,rudder_deg,speed_m_s\n");
    for (row, speed) in speed.iter().enumerate() {
        let [heading, rudder] = [truth.heading[row], truth.rudder[row]].map(to_deg);
        text += &format!("{},{heading:.4},{rudder:.4},{speed:.4}\n", truth.time[row]);
    }
    text
}

/// Folder with the fit of a 20/20 zig-zag of KVLCC2, `f/fit.json`, and the record of her 10/10, `next.csv`.
fn with_model() -> Desk {
    let desk = Desk::new();
    desk.file("first.csv", record("kvlcc2", 20.0, 20.0));
    desk.file("next.csv", record("kvlcc2", 10.0, 10.0));
    desk.run(&[&["fit", "first.csv", "--method", "output-error", "--out", "f", "--quiet"][..], &KVLCC2].concat())
        .is_done();
    desk
}

fn sd(json: &Value, key: &str, name: &str) -> f64 {
    let hulls = json["ships"]["output-error"]["hulls"].as_array().expect("hulls");
    let mmg = hulls.iter().find(|own| own["form"] == "mmg").expect("it is near");
    let own = mmg["coefficients"].as_array().expect("a list").iter().find(|own| own["key"] == key);
    own.expect("a coefficient")[name].as_f64().expect("a number")
}

/// The records agree with a model of the same ship, which narrows the prior of the coefficients, except that of the
/// rudder bias. For a ship of another length the standard deviations are multiplied by a larger factor.
#[test]
fn a_model_of_the_same_ship_is_what_is_expected() {
    let desk = with_model();
    let fit = ["fit", "next.csv", "--method", "output-error", "--prior", "f/fit.json", "--out", "g"];
    let run = desk.run(&[&fit[..], &KVLCC2].concat());
    let said = &run.is_done().out;
    assert!(said.contains("prior: f/fit.json (the same ship, standard deviations × 1.5); the records agree"), "{said}");
    let (before, after) = (desk.json("f/fit.json"), desk.json("g/fit.json"));
    assert_eq!(before["earlier_trials"], Value::Null);
    let entry = &after["earlier_trials"];
    assert_eq!((&entry["models"][0]["likeness"], &entry["conflict"]), (&"same-ship".into(), &false.into()), "{entry}");
    assert!(sd(&after, "Nv", "expected_sd") < 0.8 * sd(&before, "Nv", "expected_sd"));
    assert_eq!(sd(&after, "delta_r", "expected_sd"), sd(&before, "delta_r", "expected_sd"));
    assert_ne!(sd(&after, "Nv", "expected"), sd(&before, "Nv", "expected"));
    // A scale model of the ship, 7 m long, at another Froude number.
    let model = ["--length-m", "7", "--speed-m-s", "0.9", "--out", "h"];
    let run = desk.run(&[&fit[..6], &model].concat());
    assert!(run.is_done().out.contains("(a ship of another length, standard deviations × 2)"), "{}", run.out);
    assert!(run.err.contains("Froude number of 0.142, that of the records at 0.109"), "{}", run.err);
    // The model of the second record contains the first record, too, as its prior.
    let both = ["fit", "first.csv", "--prior", "g/fit.json"];
    desk.run(&[&both[..], &KVLCC2].concat())
        .is_refused(2, &["g/fit.json: first.csv is in this model and in first.csv"]);
}

/// A trace uses the prior; its document, its page and the screen state it.
#[test]
fn a_trace_takes_a_prior() {
    let desk = with_model();
    let trace = ["trace", "next.csv", "--prior", "f/fit.json", "--out", "t"];
    let run = desk.run(&[&trace[..], &KVLCC2].concat());
    assert!(run.is_done().out.contains("\nprior: f/fit.json (the same ship"), "{}", run.out);
    let json = desk.json("t/trace.json");
    assert!(json["earlier_trials"]["hulls"][0]["p_value"].is_f64() && json["prior"]["rule"] == "posterior");
    assert!(desk.text("t/report.md").contains("prior: f/fit.json"));
}

/// A model updated with earlier trials predicts nearly the same as a model that was fitted with them as prior.
#[test]
fn a_prediction_takes_a_prior() {
    let desk = with_model();
    let fit = ["fit", "next.csv", "--method", "output-error", "--quiet"];
    desk.run(&[&fit[..], &KVLCC2, &["--out", "g"]].concat()).is_done();
    desk.run(&[&fit[..], &KVLCC2, &["--prior", "f/fit.json", "--out", "both"]].concat()).is_done();
    let advance = |model: &str, more: &[&str]| {
        let predict = ["predict", model, "--manoeuvre", "turning-circle:35", "--draws", "400", "--out", "p"];
        let run = desk.run(&[&predict[..], more].concat());
        let figure = &desk.json("p/predict.json")["manoeuvres"][0]["figures"]["advance_m"];
        let [low, high] = [0, 1].map(|end| figure["ci90"][end].as_f64().expect("a number"));
        ([figure["median"].as_f64().expect("a number"), high - low], run.is_done().out.clone())
    };
    let ([alone, wide], _) = advance("g/fit.json", &[]);
    let ([refitted, narrow], _) = advance("both/fit.json", &[]);
    let ([weighed, found], said) = advance("g/fit.json", &["--prior", "f/fit.json"]);
    assert!(
        said.contains("g/fit.json: prior: f/fit.json (the same ship, standard deviations × 1.5); the records agree"),
        "{said}"
    );
    assert!(desk.text("p/report.md").contains("prior: f/fit.json"));
    assert!((weighed - refitted).abs() < 0.25 * narrow, "{weighed} {refitted} {alone}");
    assert!(found < 0.9 * wide && (found / narrow - 1.0).abs() < 0.3, "{found} {narrow} {wide}");
    let counted = ["first.csv is in this model and in both/fit.json, but a record counts only once"];
    desk.run(&["predict", "both/fit.json", "--prior", "f/fit.json"]).is_refused(2, &counted);
    let replayed = desk.run(&["predict", "g/fit.json", "--prior", "f/fit.json", "--replay", "first.csv", "--out", "p"]);
    assert!(replayed.is_done().err.contains("is fitted to it; the error on it validates nothing"), "{}", replayed.err);
    desk.run(&["predict", "g/fit.json", "--prior", "f/fit.json", "--ballast", "g/fit.json", "--replay", "first.csv"])
        .is_refused(2, &["--prior", "--ballast"]);
    desk.file("zz.csv", zig_zag_csv());
    desk.run(&["fit", "zz.csv", "--method", "output-error", "--out", "z", "--quiet"]).is_done();
    desk.run(&["predict", "z/fit.json", "--prior", "f/fit.json"])
        .is_refused(2, &["z/fit.json: it has no hull that --prior"]);
}

/// KVLCC2 as the prior of the Mariner gives one warning of a conflict, with the shifts of coefficients.
#[test]
fn another_ship_is_a_conflict() {
    let desk = with_model();
    desk.file("mariner.csv", record("mariner", 20.0, 20.0));
    let fit = ["fit", "mariner.csv", "--method", "output-error", "--prior", "f/fit.json", "--out", "g"];
    let run = desk.run(&[&fit[..], &["--length-m", "160.9", "--speed-kn", "15"]].concat());
    let warning = "--prior f/fit.json: the records contradict it";
    assert_eq!(run.is_done().err.matches(warning).count(), 1, "{}", run.err);
    assert!(run.err.contains("deviations") && run.err.contains("make sure that it is the same ship"), "{}", run.err);
    assert_eq!(desk.json("g/fit.json")["earlier_trials"]["conflict"], true);
}

#[test]
fn a_prior_that_cannot_be_used_is_refused() {
    let desk = with_model();
    desk.file("zz.csv", zig_zag_csv());
    desk.run(&["fit", "zz.csv", "--method", "output-error", "--out", "z", "--quiet"]).is_done();
    let fit = |prior: &str, more: &[&str]| desk.run(&[&["fit", "next.csv", "--prior", prior], more].concat());
    fit("z/fit.json", &KVLCC2).is_refused(2, &["z/fit.json: it holds no hull", "a speed column"]);
    let needed = ["next.csv: --prior cannot be used: length and approach speed", "--length-m", "[ship]"];
    fit("f/fit.json", &[]).is_refused(2, &needed);
    let text = desk.text("f/fit.json");
    for (from, to, part) in [
        ("\"key\": \"Nv\"", "\"key\": \"magic\"", "odd.json: the hull model `"),
        ("fit/2", "fit/7", "odd.json: schema = \"fit/7\", expected \"fit/2\" or \"trace/4\""),
        ("\"length_m\": 320.0", "\"length_m\": -7.0", "odd.json: length-m = -7: expected"),
        ("\"weight\": ", "\"weight\": -", "odd.json: weight = -"),
    ] {
        desk.file("odd.json", text.replace(from, to));
        fit("odd.json", &KVLCC2).is_refused(2, &[part]);
    }
    let twice = [&["--prior", "f/fit.json"][..], &KVLCC2].concat();
    fit("f/fit.json", &twice)
        .is_refused(2, &["f/fit.json: first.csv is in this model and in f/fit.json, but a record counts only once"]);
    desk.file("ms.csv", with_column(&desk.text("next.csv"), "t_s", |_, t| (1e3 * t).to_string()));
    let clock = ["ms has a row every 99.625 L/U over", "expected at most 2 L/U and 1000 L/U; check the clock"];
    desk.run(&[&["fit", "ms.csv", "--prior", "f/fit.json"], &KVLCC2[..]].concat()).is_refused(2, &clock);
    desk.run(&["trace", "next.csv", "--prior", "f/fit.json", "--without-hull"])
        .is_refused(2, &["--prior", "--without-hull"]);
}
