//! Tests of the particulars of a ship as options, in a sidecar and in a scenario, and of the priors of hull
//! coefficients that they determine.

use serde_json::Value;

use crate::desk::{Desk, of_repository, zig_zag_csv};

const KVLCC2: [&str; 10] = [
    "--length-m",
    "320",
    "--speed-m-s",
    "7.97",
    "--beam-m",
    "58",
    "--draught-m",
    "20.8",
    "--block-coefficient",
    "0.81",
];

fn priors(desk: &Desk, words: &[&str]) -> Value {
    let run = desk.run(&[&["list", "priors", "--format", "json"], words].concat());
    serde_json::from_str(&run.is_done().out).expect("a document")
}

fn of<'a>(list: &'a Value, key: &str) -> Option<&'a Value> {
    list["entries"].as_array().expect("a list").iter().find(|entry| entry["key"] == key)
}

/// Y_v′ of KVLCC2 is −0.410 by the formula of Kijima (1990); the published value is −0.315.
#[test]
fn particulars_tell_priors_and_a_missing_one_widens_them() {
    let desk = Desk::new();
    let whole = priors(&desk, &KVLCC2);
    let sway = of(&whole, "Yv").expect("a coefficient");
    assert_eq!((sway["mean"].as_f64(), sway["source"].as_str()), (Some(-0.41), Some("Kijima (1990)")));
    assert!(of(&whole, "beam-m").is_none() && of(&whole, "rudder-area-m2").is_some());
    let without = priors(&desk, &KVLCC2[..4]);
    let spread = |list: &Value| {
        let number = |name: &str| of(list, "Yv").expect("a coefficient")[name].as_f64().expect("a number");
        number("sd") / number("mean").abs()
    };
    assert!(spread(&without) > 1.2 * spread(&whole), "{} against {}", spread(&without), spread(&whole));
    assert_eq!(of(&without, "beam-m").expect("filled in")["formula"], "L/B = 6.6 ± 1.1");
    for format in ["text", "markdown", "csv", "latex"] {
        let run = desk.run(&[&["list", "priors", "--format", format][..], &KVLCC2].concat());
        assert!(run.is_done().out.contains("Yoshimura and Masumoto (2012)"), "{format}\n{}", run.out);
    }
}

/// A sidecar gives the same priors as options; an option overrides it.
#[test]
fn a_sidecar_tells_the_particulars() {
    let desk = Desk::new();
    let form = "[form]\ndraught-m = 20.8\nblock-coefficient = 0.81\n";
    desk.file("ship.toml", format!("[ship]\nlength-m = 320\nspeed-m-s = 7.97\nbeam-m = 58\n{form}"));
    assert_eq!(priors(&desk, &["--columns", "ship.toml"]), priors(&desk, &KVLCC2));
    let slender = ["--columns", "ship.toml", "--beam-m", "40"];
    assert_eq!(priors(&desk, &slender), priors(&desk, &KVLCC2.map(|word| if word == "58" { "40" } else { word })));
}

#[test]
fn particulars_of_no_ship_are_refused() {
    let desk = Desk::new();
    desk.file("zz.csv", zig_zag_csv());
    desk.file("ship.toml", "[ship]\nlength-m = 320\nspeed-m-s = 7.97\nbeam-m = 1.27\n");
    let scale = ["--length-m", "320", "--speed-m-s", "7.97"];
    let cases: [(&[&str], &[&str]); 5] = [
        (&["--beam-m", "1.27"], &["L/B (beam-m) is 252, expected 2 to 12", "one scale"]),
        (&["--block-coefficient", "1.2"], &["--block-coefficient", "expected a number from 0.3 to 1"]),
        (&["--rudder-area-m2", "-3"], &["--rudder-area-m2", "expected a number from 0.00001 to 500"]),
        (&["--columns", "ship.toml"], &["ship.toml: line 4: L/B (beam-m) is 252"]),
        (&["--columns", "none.toml"], &["none.toml"]),
    ];
    for (words, parts) in cases {
        desk.run(&[&["list", "priors"], &scale[..], words].concat()).is_refused(2, parts);
    }
    desk.run(&["list", "priors"]).is_refused(2, &["--length-m", "--columns"]);
    desk.run(&["list", "ships", "--beam-m", "58"]).is_refused(2, &["study list priors"]);
    desk.run(&["fit", "zz.csv", "--beam-m", "16"]).is_refused(2, &["zz.csv", "--beam-m", "--length-m"]);
    desk.run(&["fit", "zz.csv", "--length-m", "105", "--speed-m-s", "8.6", "--beam-m", "16", "--draught-m", "1"])
        .is_refused(2, &["zz.csv: B/d (draught-m) is 16"]);
    desk.run(&["fit", "zz.csv", "--length-m", "105", "--speed-m-s", "8.6", "--beam-m", "16"]).is_done();
}

#[test]
fn a_scenario_sails_a_hull_by_her_particulars() {
    let desk = Desk::new();
    let yukun = std::fs::read_to_string(of_repository("scenarios/yukun.toml")).expect("it is there");
    let own = yukun.replace("[ship.yukun]", "[ship.hull]\nlength-m = 105\nspeed-m-s = 8.59\nbeam-m = 18");
    assert_ne!(own, yukun);
    desk.file("own.toml", &own);
    desk.run(&["check", "own.toml"]).is_done();
    desk.file("odd.toml", own.replace("beam-m = 18", "beam-m = 60"));
    desk.run(&["check", "odd.toml"]).is_refused(2, &["odd.toml", "L/B (beam-m) is 1.75", "2 to 12"]);
}
