//! Tests of `--load`: a ship tried in ballast only, predicted and corrected at full load.
//!
//! The ship is synthetic: her coefficients are those of the formulas at each draught, plus the same departure at both.

use std::sync::Arc;

use document::identified_hull::{IdentifiedHull, keyed_particulars};
use serde_json::{Value, json};
use ship::vessel::prime::{HullCoefficient, HullModel, is_frictional, is_trial_specific};
use ship::vessel::prior::{HullParticulars, hull_prior};
use ship::vessel::scaled::ScaledHull;
use simulate::SimulatedShip;

use crate::desk::{Desk, zig_zag_csv};
use crate::earlier::zig_zag_with_speed;

const FULL: &str = "[form]\ndraught-m = 9.5\nblock-coefficient = 0.74\n";

const TRIAL: &str = "--length-m 160 --speed-m-s 7.7 --beam-m 24 --draught-m 6.5 --block-coefficient 0.7 --rudder-area-m2 27 \
                     --rudder-height-m 5.5 --propeller-diameter-m 4.8";

/// Arguments of a command line, separated by blanks.
fn words(text: &str) -> Vec<&str> {
    text.split_whitespace().collect()
}

fn particulars(draught: f64, block_coefficient: f64) -> HullParticulars {
    let (beam, block_coefficient) = (Some(24.0), Some(block_coefficient));
    let (rudder_area, rudder_height) = (Some(27.0), Some(5.5));
    let (draught, propeller_diameter) = (Some(draught), Some(4.8));
    let form = HullParticulars { beam, draught, block_coefficient, rudder_area, ..HullParticulars::default() };
    HullParticulars { length: 160.0, speed: 7.7, rudder_height, propeller_diameter, ..form }
}

/// Hull by the formulas at a loading, and the true values of its coefficients.
fn values(at: &HullParticulars) -> (HullModel, Vec<f64>) {
    let [form, ballast] = [at, &particulars(6.5, 0.7)].map(|own| HullModel::mmg(&hull_prior(own).expect("a ship")));
    let departs = |(place, (own, trial)): (usize, (&HullCoefficient, f64))| {
        let is_ship = !is_frictional(own.key) && !is_trial_specific(own.key);
        own.mean + if is_ship { [0.5, -0.3, 0.4][place % 3] * trial } else { 0.0 }
    };
    let sd = ballast.coefficients().iter().map(|own| own.sd);
    let values = form.coefficients().iter().zip(sd).enumerate().map(departs).collect();
    (form, values)
}

/// CSV record of a zig-zag of the ship in ballast, the same angle for rudder and heading.
fn record(angle_deg: f64) -> String {
    let (form, values) = values(&particulars(6.5, 0.7));
    let hull = form.with_coefficients(&values).expect("a ship");
    let ship = ScaledHull { hull, length: 160.0, speed: 7.7, propeller_rate: None };
    zig_zag_with_speed(SimulatedShip::from_dynamics(Arc::new(ship)), angle_deg, angle_deg)
}

/// Folder with the fit of a 20/20 and a 10/10 in ballast, `f/fit.json`, their records, `run.csv` and `other.csv`, and
/// the loading, `full.toml`.
fn with_trial() -> Desk {
    let desk = Desk::new();
    desk.file("full.toml", FULL);
    desk.file("run.csv", record(20.0));
    desk.file("other.csv", record(10.0));
    let fit = "fit run.csv other.csv --method output-error --out f --quiet ";
    desk.run(&words(&[fit, TRIAL].concat())).is_done();
    desk
}

/// Writes `truth.json`: the fit with the true hull at full load, without uncertainty.
fn truth(desk: &Desk) {
    let mut document = desk.json("f/fit.json");
    let ship = &mut document["ships"]["output-error"];
    let own = ship["hulls"].as_array().expect("hulls").iter().find(|own| own["form"] == "mmg").expect("it is near");
    let mut hull: IdentifiedHull = serde_json::from_value(own.clone()).expect("a hull");
    let at = particulars(9.5, 0.74);
    hull.particulars = keyed_particulars(&at);
    hull.coefficients.iter_mut().zip(values(&at).1).for_each(|(own, value)| own.value = value);
    hull.covariance.iter_mut().flatten().for_each(|entry| *entry = 0.0);
    hull.model_error_moment.sd_rudder_rad = 0.0;
    ship["hulls"] = json!([hull]);
    desk.file("truth.json", document.to_string());
}

fn predicted(desk: &Desk, asked: &str) -> Value {
    let kinds = " --manoeuvre zig-zag:10/10 --manoeuvre zig-zag:20/20 --manoeuvre turning-circle:35";
    desk.run(&words(&["predict ", asked, kinds, " --draws 300 --out p"].concat())).is_done();
    desk.json("p/predict.json")
}

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or_else(|| panic!("{value}"))
}

/// At full load at least nine of ten true figures lie in their predicted intervals, and at least eight of ten medians
/// are nearer to the truth than those of the ballast model. The first overshoot of the 20/20 is 17.0° at full load and
/// 11.5° in ballast; the measured overshoot is corrected to full load.
#[test]
fn a_ship_tried_in_ballast_is_predicted_at_full_load() {
    let desk = with_trial();
    let ballast = predicted(&desk, "f/fit.json");
    let full = predicted(&desk, "f/fit.json --load full.toml");
    let report = desk.text("p/report.md");
    for part in ["fit.json at the loading of full.toml", "from a draught of 6.5 m to 9.5 m", "deviations × 3"] {
        assert!(report.contains(part), "{part}\n{report}");
    }
    truth(&desk);
    let truth = predicted(&desk, "truth.json");
    let [mut held, mut nearer, mut all] = [0; 3];
    for (place, kind) in truth["manoeuvres"].as_array().expect("a list").iter().enumerate() {
        for (name, truth) in kind["figures"].as_object().expect("figures") {
            let [own, before] = [&full, &ballast].map(|json| &json["manoeuvres"][place]["figures"][name]);
            let away = |told: &Value| (number(&told["median"]) - number(&truth["median"])).abs();
            held += usize::from(holds90(own, truth));
            nearer += usize::from(away(own) < away(before));
            all += 1;
        }
    }
    assert!(all > 30 && 10 * held >= 9 * all && 10 * nearer >= 8 * all, "{held} and {nearer} of {all}");
    let correct = "predict f/fit.json --load full.toml --ballast f/fit.json --replay run.csv --form --draws 300 --out c \
                   --length-m 160 --speed-m-s 7.7";
    let run = desk.run(&words(correct));
    let from = "Corrected to the loading of full.toml, R = T F/B (MSC/Circ.1053, 3.4.1.2)\n\
                F from fit.json at the loading of full.toml, B from fit.json";
    assert!(run.is_done().out.contains(from) && run.err.contains("x-g-m = 0 is taken"), "{}\n{}", run.out, run.err);
    let first = &desk.json("c/predict.json")["corrected"][0]["figures"]["first_overshoot_deg"];
    let truth = &truth["manoeuvres"][1]["figures"]["first_overshoot_deg"];
    assert!(holds90(first, truth) && number(&first["factor"]["ci90"][0]) > 1.2, "{truth} {first}");
    assert!(desk.text("c/trial-form.md").contains("predicted from fit.json at the loading of full.toml"));
    let report = desk.text("c/report.md");
    assert!(
        report.contains("## Corrected to the loading of full.toml") && !report.contains("the model at full load"),
        "{report}"
    );
}

fn holds90(figure: &Value, truth: &Value) -> bool {
    (number(&figure["ci90"][0])..=number(&figure["ci90"][1])).contains(&number(&truth["median"]))
}

#[test]
fn a_loading_that_cannot_be_taken_is_refused() {
    let desk = with_trial();
    let refused = |words: &str, part: &str| desk.run(&self::words(words)).is_refused(2, &[part]);
    for (text, part) in [
        (
            "[form]\ndraught-m = 6.6",
            "load.toml: this is not another loading of the ship of f/fit.json: all is within 2 %",
        ),
        ("[form]\ndraught-m = 22", "load.toml: B/d (draught-m) is 1.091, expected 1.2 to 8"),
        (
            "[form]\ndraught-m = 3.5",
            "load.toml: at draught-m = 3.5 the rudder (rudder-height-m = 5.5) is out of the water too far: its height is \
             1.571 draughts, expected at most 1.5",
        ),
        (
            "[ship]\nlength-m = 160\nspeed-m-s = 7.7\nrudder-height-m = 3.2\n[form]\ndraught-m = 3.5",
            "load.toml: at draught-m = 3.5 the propeller (propeller-diameter-m = 4.8) is out of the water too far",
        ),
        ("[ship]\nlength-m = 32\nspeed-m-s = 3.4\ndraught-m = 1.9", "length-m differs"),
        ("[form]\nbeam-m = 25\ndraught-m = 9.5", "beam-m differs"),
        ("[form]\nbeam-m = 24", "load.toml: it has no draught-m"),
        ("[form]\ndraft-m = 9.5", "load.toml: line 2"),
    ] {
        desk.file("load.toml", text);
        refused("predict f/fit.json --load load.toml", part);
    }
    refused("predict f/fit.json --load none.toml", "none.toml");
    desk.file("zz.csv", zig_zag_csv());
    for (fit, lacks) in [
        ("zz.csv", "b/fit.json: it has no hull of the form mmg"),
        ("run.csv --length-m 160 --speed-m-s 7.7", "c/fit.json: it has no beam-m, draught-m, block-coefficient"),
    ] {
        let folder = &lacks[..1];
        desk.run(&words(&format!("fit --method output-error --out {folder} --quiet {fit}"))).is_done();
        refused(&format!("predict {folder}/fit.json --load full.toml"), lacks);
        refused(&format!("predict f/fit.json --load full.toml --ballast {folder}/fit.json --replay run.csv"), lacks);
    }
    desk.file("b/fit.json", desk.text("f/fit.json").replace("\"form\": \"mmg\"", "\"form\": \"cubic\""));
    refused(
        "predict b/fit.json --load full.toml",
        "b/fit.json: --load needs a hull of the form mmg: a hull of the form mmg does not fit the records",
    );
}
