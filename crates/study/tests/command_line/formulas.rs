//! Tests of effects given as formulas: in a scenario, in a trace and in a prediction.

use crate::desk::Desk;
use crate::scenarios::GOOD;

const BANK: &str = "bank = c * tanh(k * psi)";

/// Simulates a zig-zag with the effect [`BANK`] and returns the path of the record.
fn banked(desk: &Desk) -> String {
    let effect = format!("\n[[effect]]\nformula = \"{BANK}\"\nc = -0.05\nk = 8.0\n");
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
    desk.run(&["trace", &record, "--effect", BANK, "--out", "t"]).is_done();
    let effects = desk.json("t/trace.json")["effects"].clone();
    assert_eq!((&effects[0]["id"], &effects[0]["form"]), (&"bank".into(), &"c * tanh(k * psi)".into()), "{effects}");
    let page = desk.text("t/report.md");
    assert!(page.contains("`bank = c * tanh(k * psi)` acts equally to port and to starboard."), "{page}");
    desk.run(&["predict", "t/trace.json", "--manoeuvre", "zig-zag:20/20"]).is_done();
    desk.file("own.toml", format!("effects = [\"{BANK}\"]\n"));
    desk.run(&["trace", &record, "--effects", "own.toml", "--out", "file"]).is_done();
    assert_eq!(desk.json("file/trace.json")["effects"], effects);
    let run = desk.run(&["trace", &record, "--effect", BANK, "--only", "bank", "--out", "only"]);
    run.is_done();
    assert!(run.out.contains("\nbank = c * tanh(k * psi) acts equally to port and to starboard\n"), "{}", run.out);
    let only = desk.json("only/trace.json")["effects"].clone();
    assert_eq!((only.as_array().map(Vec::len), &only[0]["asked"]), (Some(1), &true.into()), "{only}");
    desk.run(&["trace", &record, "--effect", BANK, "--with", "banc"]).is_refused(2, &["--with", "did you mean `bank`"]);
}

#[test]
fn a_line_that_is_no_formula_is_marked() {
    let desk = Desk::new();
    desk.file("run.csv", crate::desk::zig_zag_csv());
    desk.run(&["trace", "run.csv", "--effect", "bank = c * dleta"])
        .is_refused(2, &["did you mean `delta`?", "bank = c * dleta\n             ^"]);
    desk.file("own.toml", "effect = []\n");
    desk.run(&["trace", "run.csv", "--effects", "own.toml"]).is_refused(2, &["unknown field `effect`"]);
    desk.file("own.toml", "effects = [\n  \"cross = c * r\",\n  \"bank = c * dleta\",\n]\n");
    desk.run(&["trace", "run.csv", "--effects", "own.toml"])
        .is_refused(2, &["own.toml", "line 3: `dleta` is not a signal", "bank = c * dleta\n             ^"]);
    desk.run(&["trace", "run.csv", "--effect", BANK, "--effect", BANK]).is_refused(2, &["bank", "names of their own"]);
}

/// The message on an invalid formula has its line and column in the scenario file.
#[test]
fn a_formula_of_a_scenario_is_marked_in_the_file() {
    let desk = Desk::new();
    let line = GOOD.lines().count() + 3;
    for (text, said, column) in [
        ("formula = \"bank = c * foo(r)\"\nc = 1.0", "`foo` is not a function", 23),
        ("c = 1.0\nformula = 'bank = c * dleta'", "did you mean `delta`", 23),
        ("formula = \"bank = c * tanh(k * psi)\"\nc = 1.0", "lacks the key `k`", 0),
        ("formula = \"bank = c * r\"\nc = 1.0\nd = 1.0", "no key `d`", 0),
        ("c = 1.0", "`effect.0.c` is 1.0", 0),
        ("formula = \"cross = c * r * abs(v)\"\nc = 1.0", "needs sway velocity", 0),
        ("formula='x=c*t'\nc=1\nstands-for=['speed_los']", "did you mean `speed_loss`", 0),
        ("formula='x=c*t'\nc=1\nstands-for=[]", "both or neither of", 0),
        ("formula='x=c*t'\nc=1\ndepends-on='weather'", "use one of `time`, `heading`", 0),
        ("formula='x=c*t'\nc=1\ndepends-on='time'\nstands-for=['speed_loss']", "both or neither of", 0),
        ("formula='x=c*t'\nc=1\ndepends-on='heading'\nchanges-s=[9]", "does not depend on time", 0),
        ("formula='x=c*t'\nc=1\ndepends-on='time'\nchanges-s=[9]\nperiod-s=[4,7]", "with a period", 0),
        ("formula='x=c*t'\nc=1\ndepends-on='time'\nperiod-s=[70,40]", "the shorter first", 0),
        ("formula='x=c*t'\nc=1\ndepends-on='time'\n[[effect]]\nsteering_lag.dead-time-s=1", "this effect alone", 0),
    ] {
        desk.file("bad.toml", format!("{GOOD}\n[[effect]]\n{text}\n"));
        let run = desk.run(&["check", "bad.toml"]);
        run.is_refused(2, &["bad.toml", said]);
        let line = line + usize::from(text.starts_with("c = 1.0\n"));
        let place = format!("--> bad.toml:{line}:{column}");
        assert!(column == 0 || run.err.contains(&place), "{place}: {}", run.err);
    }
    desk.file("good.toml", format!("{GOOD}\n[[effect]]\nformula = \"bank = c * y\"\nc = -0.004\n"));
    desk.run(&["check", "good.toml"]).is_done();
    let typed = "\n[[identifier]]\ntrace.formulas = [\"bank = c * r\", \"bend = c * dleta\"]\n";
    desk.file("bad.toml", format!("{GOOD}{typed}"));
    desk.run(&["check", "bad.toml"]).is_refused(2, &[&format!("--> bad.toml:{line}:47"), "did you mean `delta`"]);
    let swept = "\n[[sweep]]\nname = \"x\"\npoints = [{ label = \"x\", set = { effect = [{ formula = \"b = c * foo(r)\" }] } }]\n";
    desk.file("bad.toml", format!("{GOOD}{swept}"));
    let place = format!("--> bad.toml:{}:65", line + 1);
    desk.run(&["check", "bad.toml"]).is_refused(2, &[&place, "`foo` is not a function"]);
}

/// Records of a response model with speed and sway have both channels, and a formula of sway changes the motion.
#[test]
fn a_ship_with_speed_and_sway_has_moments_of_them() {
    let desk = Desk::new();
    let planar = "\n[speed-and-sway]\nX_0 = 0.05\nX_vr = 1.3\nX_dd = 0.1\nX_dv = 0.1\nY_v = 0.4\nY_vv = 2.0\nY_r = 0.5\nY_d = 0.1\n";
    let cross = |c: f64| format!("\n[[effect]]\nformula = \"cross = c * r * abs(v)\"\nc = {c:.1}\n");
    let trials = |name: &str, text: String| {
        desk.file(&format!("{name}.toml"), text);
        desk.run(&["simulate", &format!("{name}.toml"), "--out", name]).is_done();
        desk.text(&format!("{name}/{name}-0.csv"))
    };
    let plain = trials("plain", format!("{GOOD}{planar}"));
    assert!(plain.contains("speed_m_s,sway_m_s"), "{plain:.200}");
    assert_eq!(plain, trials("zero", format!("{GOOD}{planar}{}", cross(0.0))));
    assert_ne!(plain, trials("damped", format!("{GOOD}{planar}{}", cross(-2.0))));
    desk.file("bad.toml", format!("{GOOD}{}", planar.replace("X_vr = 1.3", "X_vr = -1.0")));
    desk.run(&["check", "bad.toml"]).is_refused(2, &["speed-and-sway.X_vr", "from 0 to 5"]);
    desk.file("bad.toml", format!("{}{planar}", GOOD.replace("yukun", "kvlcc2")));
    desk.run(&["check", "bad.toml"]).is_refused(2, &["speed-and-sway", "kvlcc2", "response model"]);
}
