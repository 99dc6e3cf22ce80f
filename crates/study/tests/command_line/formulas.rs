//! Effects as lines of text: in a scenario, in a trace, in a prediction.

use crate::desk::Desk;
use crate::scenarios::GOOD;

const BANK: &str = "bank = c * tanh(k * psi)";

/// A zig-zag of a ship beside a bank, simulated from a scenario.
fn banked(desk: &Desk) -> String {
    let effect = format!("\n[[effect]]\n\"{BANK}\" = {{ c = -0.05, k = 8.0 }}\n");
    desk.file("bank.toml", format!("{GOOD}{effect}"));
    desk.run(&["simulate", "bank.toml", "--out", "bank"]).is_done();
    let files = std::fs::read_dir(desk.path("bank")).expect("a folder").flatten();
    let names = files.map(|entry| entry.file_name().to_string_lossy().into_owned());
    let name = names.filter(|name| name.ends_with(".csv")).min().expect("a record");
    format!("bank/{name}")
}

#[test]
fn a_line_of_text_is_simulated_named_and_predicted_with() {
    let desk = Desk::new();
    let record = banked(&desk);
    desk.run(&["trace", &record, "--effect", BANK, "--out", "t", "--figures", "none"]).is_done();
    let effects = desk.json("t/trace.json")["effects"].clone();
    assert_eq!((&effects[0]["id"], &effects[0]["form"]), (&"bank".into(), &"c * tanh(k * psi)".into()), "{effects}");
    desk.run(&["predict", "t/trace.json", "--manoeuvre", "zig-zag:20/20", "--figures", "none"]).is_done();
    desk.file("own.toml", format!("effects = [\"{BANK}\"]\n"));
    desk.run(&["trace", &record, "--effects", "own.toml", "--out", "file", "--figures", "none"]).is_done();
    assert_eq!(desk.json("file/trace.json")["effects"], effects);
}

#[test]
fn a_line_that_is_no_formula_is_marked() {
    let desk = Desk::new();
    desk.file("run.csv", crate::desk::zig_zag_csv());
    desk.run(&["trace", "run.csv", "--effect", "bank = c * dleta"])
        .is_refused(2, &["did you mean `delta`?", "bank = c * dleta\n             ^"]);
    desk.file("own.toml", "effect = []\n");
    desk.run(&["trace", "run.csv", "--effects", "own.toml"]).is_refused(2, &["unknown field `effect`"]);
    desk.run(&["trace", "run.csv", "--effect", BANK, "--effect", BANK]).is_refused(2, &["bank", "names of their own"]);
    for (line, said) in [
        ("\"bank = c * foo(r)\" = { c = 1.0 }", "`foo` is no function"),
        ("\"bank = c * tanh(k * psi)\" = { c = 1.0 }", "`k`"),
        ("\"bank = c * r\" = { c = 1.0, d = 1.0 }", "`d`"),
    ] {
        desk.file("bad.toml", format!("{GOOD}\n[[effect]]\n{line}\n"));
        desk.run(&["check", "bad.toml"]).is_refused(2, &["bad.toml", said]);
    }
}
