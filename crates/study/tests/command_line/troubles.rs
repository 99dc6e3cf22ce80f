//! Records with the faults that instruments and loggers have: mended with a word, or nothing said that is wrong.

use ship::ships;

use crate::desk::{Desk, with_column, zig_zag_csv_every};

/// K (1/s) and T (s) of output error, the overshoots (deg) of all swings, and what was said.
fn fitted(csv: &str) -> (f64, f64, Vec<Option<f64>>, String) {
    let desk = Desk::new();
    desk.file("run.csv", csv);
    let run = desk.run(&["fit", "run.csv"]);
    run.is_done();
    let json = desk.json("run-fit/fit.json");
    let methods = json["methods"].as_array().expect("a list");
    let method = methods.iter().find(|method| method["method"] == "output-error").expect("it is among them");
    let value = |key: &str| method["parameters"][key]["value"].as_f64().expect("a number");
    let overshoots = json["zigzag"]["overshoots_deg"].as_array().cloned().unwrap_or_default();
    (value("K_per_s"), value("T_s"), overshoots.iter().map(serde_json::Value::as_f64).collect(), run.out + &run.err)
}

fn yukun(period: f64) -> String {
    zig_zag_csv_every(&ships::find("yukun").expect("it is in the registry"), period)
}

/// The answer is that of the record without the fault, to 2 %, and the fault is told.
fn is_mended(sound: &str, faulty: &str, word: &str) {
    let (k, t, overshoots, said) = fitted(sound);
    assert!(!said.contains(word), "{said}");
    let (found_k, found_t, found, said) = fitted(faulty);
    assert!(said.contains(word), "{word:?} was not said:\n{said}");
    assert!((found_k / k - 1.0).abs() < 0.02 && (found_t / t - 1.0).abs() < 0.02, "{found_k} 1/s, {found_t} s");
    if said.contains("no zig-zag characteristics: no heading within") {
        return;
    }
    assert_eq!(found.len(), overshoots.len());
    for (swing, (found, own)) in found.iter().zip(&overshoots).enumerate() {
        let near = found.zip(*own).is_none_or(|(found, own)| (found - own).abs() < 0.3);
        assert!(near, "swing {swing}: {found:?} deg, without the fault {own:?} deg");
    }
    assert!(found.iter().flatten().count() + 1 >= overshoots.len(), "{found:?} of {overshoots:?}");
}

#[test]
fn instruments_fail_and_the_answer_stays() {
    let sound = yukun(1.0);
    let heading = |rows: &'static [usize], value: &'static str| {
        with_column(&sound, "heading_deg", |row, psi| if rows.contains(&row) { value.into() } else { psi.to_string() })
    };
    is_mended(&sound, &heading(&[100, 200], "-999"), "holds -999 2 times");
    let wild =
        with_column(&sound, "rudder_deg", |row, delta| if row == 150 { "-327".into() } else { delta.to_string() });
    is_mended(&sound, &wild, "1 row with a rudder angle no rudder has");
    for (rows, told) in [(121..=150, "from 120 s to 150 s"), (131..=142, "from 130 s to 142 s")] {
        let kept = std::cell::Cell::new(0.0);
        let frozen = with_column(&sound, "heading_deg", |row, psi| {
            if !rows.contains(&row) {
                kept.set(psi);
            }
            kept.get().to_string()
        });
        is_mended(&sound, &frozen, told);
    }
}

/// A rudder that comes once a second into rows of a tenth is not a rudder that waits.
#[test]
fn a_rudder_that_repeats_old_values_is_no_lag() {
    let sound = yukun(0.1);
    let kept = std::cell::Cell::new(0.0);
    let stale = with_column(&sound, "rudder_deg", |row, delta| {
        if row % 10 == 0 {
            kept.set(delta);
        }
        kept.get().to_string()
    });
    is_mended(&sound, &stale, "the rudder is new in every 10th row only");
}
