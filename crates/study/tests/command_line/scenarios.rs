//! Tests of valid and invalid scenarios: `study check`.

use crate::desk::{Desk, of_repository, zig_zag_csv};

pub const GOOD: &str = "\
question = \"Does it run?\"
seed = 1
replicates = 2

[ship.yukun]

[manoeuvre.zig-zag]
rudder-deg = 10.0
heading-deg = 20.0

[steering-gear]
rate-deg-s = 2.5

[recording]
sampling-s = 1.0
duration-s = 270.0
after-execute = 1

[sensor]
heading-noise-deg = 0.1

[[identifier]]
method.output-error = {}

[[identifier]]
method.least-squares = {}
";

/// [`GOOD`] with the first occurrence of `from` replaced.
fn changed(from: &str, to: &str) -> String {
    assert!(GOOD.contains(from), "{from}");
    GOOD.replacen(from, to, 1)
}

fn refused(text: &str, line: usize, parts: &[&str]) {
    let desk = Desk::new();
    desk.file("case.toml", text);
    let run = desk.run(&["check", "case.toml"]);
    run.is_refused(2, parts);
    assert!(run.err.contains(&format!("--> case.toml:{line}:")), "expected line {line}:\n{}", run.err);
    assert!(run.err.contains("= help: "), "what to do is missing:\n{}", run.err);
}

#[test]
fn a_misspelt_key_is_shown_with_the_one_that_was_meant() {
    for (from, to, line, meant) in [
        ("rudder-deg", "ruder-deg", 8, "`rudder-deg`"),
        ("rate-deg-s", "rate-deg", 12, "`rate-deg-s`"),
        ("sampling-s", "sampling", 15, "`sampling-s`"),
        ("heading-noise-deg", "heading-nois-deg", 20, "`heading-noise-deg`"),
        ("[sensor]", "[senser]", 19, "`sensor`"),
        ("method.output-error", "methd.output-error", 23, "`method`"),
        ("output-error = {}", "output-error = { iteration = 3 }", 23, "`iterations`"),
        ("[sensor]", "[sensor]\ndrop-out.probabilty = 0.1", 20, "`probability`"),
        ("[ship.yukun]", "[ship.first-order]\nK-per = 0.1\nT-s = 16.0", 6, "`K-per-s`"),
        ("[sensor]", "[disturbance.wind]\nmoment = 1.0\n[sensor]", 20, "`moment-deg`"),
        ("[sensor]", "[[effect]]\nspeed_loss = { recovery = 20 }\n[sensor]", 20, "`recovery-s`"),
        ("[sensor]", "[published]\nK-pers = 0.1\n[sensor]", 20, "`K-per-s`"),
        ("[sensor]", "[output]\nshow-case = true\n[sensor]", 20, "`showcase`"),
    ] {
        refused(&changed(from, to), line, &["no such key here", "did you mean", meant]);
    }
    refused(&changed("replicates", "replicate"), 3, &["a scenario has no key `replicate`", "`replicates`"]);
    let sweep = |text: &str| format!("{GOOD}[[sweep]]\n{text}\n");
    refused(&sweep("ky = \"sensor.heading-noise-deg\""), 28, &["`key`"]);
    refused(&sweep("points = [{ lable = \"a\", set = {} }]"), 28, &["`lable`", "`label`"]);
}

#[test]
fn an_unknown_name_is_shown_with_the_known_ones() {
    refused(&changed("output-error", "output-eror"), 23, &["no method is called `output-eror`", "`output-error`"]);
    refused(&changed("zig-zag", "zigzag"), 7, &["no manoeuvre is called `zigzag`", "`zig-zag`"]);
    refused(&changed("yukun", "yukum"), 5, &["no ship is called `yukum`", "`yukun`"]);
    let effect = changed("[sensor]", "[[effect]]\nrudder_dedband.backlash-deg = 1.0\n[sensor]");
    refused(&effect, 20, &["no effect is called `rudder_dedband`", "`rudder_deadband`"]);
    let side = changed("heading-deg = 20.0", "heading-deg = 20.0\nfirst = \"left\"");
    refused(&side, 10, &["is the text \"left\"", "`starboard`"]);
    let order = changed("output-error = {}", "fourier-projected.harmonics.fixd = 6");
    refused(&order, 23, &["no setting is called `fixd`", "`fixed`"]);
}

#[test]
fn a_value_of_the_wrong_kind_is_shown_with_what_was_expected() {
    for (from, to, line, found, expected) in [
        ("10.0", "\"ten\"", 8, "is the text \"ten\"", "expected a number"),
        ("seed = 1", "seed = 1.5", 2, "`seed` is 1.5", "expected a whole number"),
        ("seed = 1", "seed = -1", 2, "`seed` is -1", "expected a whole number, 0 or above"),
        ("seed = 1", "seed = 2020-01-01", 2, "the date 2020-01-01", "expected a whole number"),
        ("\"Does it run?\"", "3", 1, "`question` is 3", "expected a text in quotes"),
        ("[ship.yukun]", "[ship]\nyukun = 3", 6, "`ship.yukun` is 3", "expected a table"),
        ("rate-deg-s = 2.5", "rate-deg-s = true", 12, "rate-deg-s` is true", "expected a number"),
        ("seed = 1", "seed = 1\neffect = 3", 3, "`effect` is 3", "expected a list"),
        ("method.output-error = {}", "method = \"output-error\"", 23, "\"output-error\"", "`method.output-error = {}`"),
    ] {
        refused(&changed(from, to), line, &[found, expected]);
    }
    let ship = changed("[ship.yukun]\n", "").replace("seed = 1", "seed = 1\nship = \"yukun\"");
    refused(&ship, 3, &["`ship` is the text \"yukun\"", "[ship.yukun]"]);
    refused(&changed("[sensor]", "[effect]\nx = 1\n[sensor]"), 19, &["`effect` is a table", "[[effect]]"]);
}

#[test]
fn a_missing_key_is_named_where_it_belongs() {
    let zig_zag = "[manoeuvre.zig-zag]\nrudder-deg = 10.0\nheading-deg = 20.0";
    for (from, to, line, texts) in [
        ("question = \"Does it run?\"\n", "", 1, ["a scenario lacks the key `question`", "here"]),
        ("sampling-s = 1.0\n", "", 14, ["`sampling-s`", "here"]),
        ("heading-deg = 20.0\n", "", 7, ["`heading-deg`", "here"]),
        ("duration-s = 270.0\n", "", 14, ["`recording.duration-s` is missing", "nothing else ends the run"]),
        ("[ship.yukun]", "[ship.first-order]\nK-per-s = 0.1", 5, ["`ship.first-order` lacks the key", "`T-s`"]),
        (zig_zag, "[manoeuvre]", 7, ["`manoeuvre` names nothing", "`zig-zag`"]),
    ] {
        refused(&changed(from, to), line, &texts);
    }
    let methods = GOOD.find("[[identifier]]").expect("there are methods");
    refused(&GOOD[..methods], 1, &["`identifier`", "method.output-error"]);
    let none = changed("seed = 1", "seed = 1\nidentifier = []");
    refused(none.split("[[identifier]]").next().expect("it begins"), 3, &["names no method"]);
}

#[test]
fn a_value_out_of_range_is_shown_with_the_range() {
    for (from, to, line, found, expected) in [
        ("rate-deg-s = 2.5", "rate-deg-s = -2.5", 12, "is -2.5", "expected a number above 0"),
        ("sampling-s = 1.0", "sampling-s = 0.0", 15, "`recording.sampling-s` is 0", "expected a number above 0"),
        ("sampling-s = 1.0", "sampling-s = inf", 15, "is inf", "expected a finite number"),
        ("rudder-deg = 10.0", "rudder-deg = nan", 8, "is NaN", "expected a finite number"),
        ("noise-deg = 0.1", "noise-deg = nan", 20, "is NaN", "expected a finite number"),
        ("rate-deg-s = 2.5", "maximum-deg = 5.0", 8, "rudder-deg` is 10", "expected at most 5"),
        ("rudder-deg = 10.0", "rudder-deg = 100", 8, "is 100", "expected at most 90"),
        ("replicates = 2", "replicates = 0", 3, "`replicates` is 0", "expected at least 1"),
        ("replicates = 2", "replicates = 9000000000000000000", 3, "9000000000000000000", "expected at most"),
        ("replicates = 2", "replicates = 99999999999999999999", 3, "not valid TOML", "too many digits"),
        ("duration-s = 270.0", "duration-s = 1e18", 16, "is 1e18", "expected at most 1000000"),
        ("after-execute = 1", "after-execute = 0", 17, "is 0", "count the executes from 1"),
        ("after-execute = 1", "after-execute = 90000", 17, "is 90000", "this one can take 6.5e8"),
        ("heading-deg = 20.0", "heading-deg = 20.0\nexecutes = 1000000000", 10, "is 1000000000", "from 1 to 100000"),
        ("[ship.yukun]", "[approach]\nlead-in-s = 1e300\n[ship.yukun]", 6, "is 1e300", "expected at most 10000000"),
        ("output-error = {}", "output-error.iterations = 0", 23, "output-error.iterations` is 0", "expected 1 to 1000"),
        ("[sensor]", "[sensor]\ndrop-out.probability = 1.5", 20, "is 1.5", "expected a number from 0 to 1"),
    ] {
        refused(&changed(from, to), line, &[found, expected]);
    }
    let ship = |numbers: &str| changed("[ship.yukun]", &format!("[ship.first-order]\n{numbers}"));
    refused(&ship("K-per-s = -0.1\nT-s = 16.0"), 6, &["K-per-s` is -0.1", "sign"]);
    refused(&ship("K-per-s = 0.1\nT-s = 0.0"), 7, &["T-s` is 0.0", "finite and not zero"]);
    refused(
        &ship("K-per-s = 0.1\nT-s = 16.0\nlength-m = 100.0"),
        8,
        &["`length-m` without `speed-kn`", "leave both out"],
    );
}

#[test]
fn what_contradicts_itself_is_refused() {
    refused(&changed("least-squares", "output-error"), 25, &["two methods are called `output-error`", "label"]);
    let both = changed("heading-deg = 20.0", "heading-deg = 20.0\nexecutes = 5\nduration-s = 100.0");
    refused(&both, 11, &["both `executes` and `duration-s`", "leave out"]);
    refused(
        &changed("after-execute = 1", "offset-s = 1.0"),
        17,
        &["`after-execute` is missing", "add `after-execute = 1`"],
    );
    let late = changed("heading-deg = 20.0", "heading-deg = 20.0\nexecutes = 3")
        .replace("after-execute = 1", "after-execute = 4");
    refused(&late, 18, &["after-execute` is 4", "ends after execute 3", "expected at most 3"]);
    refused(&changed("[ship.yukun]", "[ship.yukun]\n[ship.mariner]"), 5, &["names 2 things at once", "exactly one"]);
    refused(
        &changed("[ship.yukun]", "[ship.yukun]\nK-per-s = 0.1"),
        5,
        &["`yukun` has settings", "[ship.first-order]"],
    );
    refused(
        &changed("output-error = {}", "output-error = {}\nmethod.srivc = {}"),
        23,
        &["2 things at once", "keep one"],
    );
    let hull =
        changed("yukun", "kvlcc2").replace("[sensor]", "[[effect]]\nmoment_drift.rudder-deg-per-s = 0.01\n[sensor]");
    refused(&hull, 19, &["`kvlcc2`, a hull", "response models"]);
    let effect = |text: &str| changed("[sensor]", &format!("[[effect]]\n{text}\n[sensor]"));
    refused(&effect("rudder_deadband.backlash-deg = -1.0"), 20, &["backlash-deg` is -1", "from 0 to 8.594"]);
    refused(&effect("rudder_deadband.backlash-deg = nan"), 20, &["backlash-deg` is NaN"]);
    refused(&effect("wind_moment = { rudder-deg = 50.0, from-deg = 45.0 }"), 20, &["rudder-deg` is 50", "34.38"]);
}

#[test]
fn a_faulty_sweep_is_shown_at_its_place() {
    let refused = |text: &str, line: usize, parts: &[&str]| refused(&format!("{GOOD}[[sweep]]\n{text}\n"), line, parts);
    refused(
        "key = \"sensor.heading-nose-deg\"\nvalues = [0.1]",
        28,
        &["has no key `heading-nose-deg`", "`heading-noise-deg`"],
    );
    refused("key = \"sensor.heading-noise-deg\"\nvalues = [0.1, -0.2]", 29, &["to -0.2", "0 or above"]);
    refused("key = \"sensor.heading-noise-deg\"\nvalues = [0.1, \"x\"]", 29, &["to \"x\"", "expected a number"]);
    refused("key = \"identifier.7.label\"\nvalues = [\"a\"]", 28, &["`7`", "from 0 to 1"]);
    refused("key = \"seed\"\nvalues = [1, 2]", 28, &["`seed`", "the whole study"]);
    refused("key = \"a\"\nvalues = [1]\nlog = { from = 1, to = 2, points = 3 }", 27, &["`points` alone"]);
    let noise = "key = \"sensor.heading-noise-deg\"\n";
    refused(&format!("{noise}values = []"), 27, &["no points"]);
    refused(&format!("{noise}values = [1, 1]"), 27, &["two points", "`1`"]);
    refused(&format!("{noise}log = {{ from = 0, to = 1, points = 10 }}"), 29, &["from 0 to 1", "above 0"]);
    refused(&format!("{noise}log = {{ from = 0.1, to = 1, points = 1000000000000000 }}"), 29, &["2 to 100000 points"]);
    let wide = "linear = { from = 0.1, to = 1, points = 1000 }";
    refused(
        &format!("{noise}{wide}\n[[sweep]]\nkey = \"recording.sampling-s\"\n{wide}"),
        27,
        &["1000 × 1000 = 1000000 cells"],
    );
    refused(&format!("{noise}values = [1]\n[[sweep]]\n{noise}values = [2]"), 30, &["two sweeps change"]);
    refused(
        "points = [{ label = \"a\", set = {} }, { label = \"b\", set = { \"recording.sampling-s\" = 0 } }]",
        28,
        &["`recording.sampling-s` to 0", "above 0"],
    );
}

#[test]
fn a_faulty_draw_is_shown_at_its_place() {
    let draw = |text: &str| format!("{}[[draw]]\n{text}\n", first_order());
    let noise = "key = \"sensor.heading-noise-deg\"\n";
    refused(&draw("key = \"seed\"\nuniform = { from = 1, to = 2 }"), 30, &["changes `seed`", "a key of the trial"]);
    refused(
        &draw("key = \"sensor.heading-nose-deg\"\nuniform = { from = 0.1, to = 0.2 }"),
        30,
        &["has no key `heading-nose-deg`", "`heading-noise-deg`"],
    );
    refused(&draw(noise), 29, &["has no distribution", "`log-normal`"]);
    refused(&draw(&format!("{noise}gamma = 3")), 31, &["no such key", "`normal`"]);
    refused(&draw(&format!("{noise}uniform = {{ from = 0.2, to = 0.1 }}")), 31, &["`to`", "is 0.1", "above 0.2"]);
    refused(&draw(&format!("{noise}normal = {{ mean = 0.1, sd = -1 }}")), 31, &["`sd`", "is -1", "above 0"]);
    // Draws that can make no trial are found before any trial runs, and the message names the draw.
    let period = "key = \"ship.first-order.T-s\"\nuniform = { from = 0.0, to = 3.0 }";
    refused(&draw(period), 31, &["draw of `ship.first-order.T-s` reaches", "T-s` is 0.0"]);
    let cut = format!("{noise}normal = {{ mean = 0.1, sd = 0.01 }}\nbetween = [0.5, 0.6]");
    refused(&draw(&cut), 32, &["between 0.5 and 0.6", "0.1 % of the draws"]);
    let swept = format!("{noise}uniform = {{ from = 0.1, to = 0.2 }}\n[[sweep]]\n{noise}values = [0.1]");
    refused(&draw(&swept), 30, &["is drawn, and a sweep changes it too", "draw.0.normal.sd"]);
}

#[test]
fn a_faulty_rule_or_validation_is_shown_at_its_place() {
    let stop = |text: &str| format!("{GOOD}[stop]\nstandard-error = 0.1\n{text}\n");
    refused(&stop("figure = \"rms-k\""), 29, &["rms-k", "`rms-K`"]);
    refused(&stop("figure = \"rms-K\"\nmethod = \"output-eror\""), 30, &["output-eror", "did you mean `output-error`"]);
    refused(&stop("figure = \"rms-K\"").replace("error = 0.1", "error = 0"), 28, &["is 0", "above 0"]);
    let second = |text: &str| format!("{GOOD}[validation.manoeuvre.zig-zag]\nheading-deg = 20.0\n{text}\n");
    refused(&second("rudder-deg = 95.0"), 29, &["in the validation manoeuvre", "is 95", "at most 90"]);
    refused(&second("ruder-deg = 20.0"), 29, &["no such key", "`rudder-deg`"]);
    let own = "rudder-deg = 20.0\n[validation.recording]\nsampling-s = 0.0\nduration-s = 9.0";
    refused(&second(own), 31, &["in the validation manoeuvre", "sampling-s` is 0"]);
    refused(&changed("after-execute = 1", "rudder = \"ordered\""), 17, &["ordered", "`orders`"]);
    refused(
        &changed("after-execute = 1", "rudder = \"orders\"\nassumed-rudder-rate-deg-s = 0"),
        18,
        &["assumed-rudder-rate-deg-s` is 0", "above 0"],
    );
    let output = |text: &str| format!("{GOOD}[output]\n{text}\n");
    refused(&output("detail = [\"20/20\"]"), 28, &["20/20", "cell"]);
    refused(&output("highlight = { series = [\"output-eror\"] }"), 28, &["output-eror", "output-error"]);
    refused(&output("marks = [{ axis = \"noise\", at = 1, label = \"a\" }]"), 28, &["no axis", "noise", "a sweep"]);
    refused(&output("figures = [\"../errors\"]"), 28, &["output.figures", "/"]);
}

/// [`GOOD`] with a first-order ship given by K and T.
fn first_order() -> String {
    changed("[ship.yukun]", "[ship.first-order]\nK-per-s = 0.1\nT-s = 16.3")
}

#[test]
fn text_that_is_no_toml_is_shown_where_it_stops_to_be() {
    refused(&changed("10.0", "= 10.0"), 8, &["not valid TOML"]);
    refused(&changed("[recording]", "[recording"), 14, &["not valid TOML"]);
    refused(&changed("seed = 1", "seed = 1\nseed = 2"), 3, &["duplicate key"]);
    refused("", 1, &["nothing in this scenario"]);
    refused("# only a note\n", 1, &["nothing in this scenario"]);
}

#[test]
fn a_path_that_is_no_scenario_is_refused() {
    let desk = Desk::new();
    desk.file("record.csv", zig_zag_csv());
    desk.file("binary.toml", [0x71, 0x20, 0xff, 0xfe, 0x00]);
    desk.file("folder/x", "");
    for run in ["check", "run"] {
        let refused = |name: &str, parts: &[&str]| match run {
            "check" => desk.run(&["check", name]).is_refused(2, parts),
            _ => desk.run(&[name]).is_refused(2, parts),
        };
        refused("missing.toml", &["missing.toml: there is no such file", "TOML"]);
        refused("folder", &["folder: this is a folder"]);
        refused("binary.toml", &["binary.toml: line 1", "0xff", "UTF-8"]);
        refused("record.csv", &["record.csv:1", "study fit"]);
    }
    assert!(!desk.path("results").exists(), "nothing is written for a scenario that is refused");
}

#[test]
fn the_record_of_a_replay_is_read_with_the_scenario() {
    let replay = |file: &str| {
        changed(
            "[manoeuvre.zig-zag]\nrudder-deg = 10.0\nheading-deg = 20.0",
            &format!("[manoeuvre.replay]\nfile = \"{file}\""),
        )
        .replace("after-execute = 1\n", "")
    };
    refused(&replay("nope.csv"), 8, &["nope.csv", "no such file"]);
    refused(&replay("."), 8, &["folder"]);
    let desk = Desk::new();
    desk.file("studies/case.toml", replay("../record.csv"));
    desk.file("record.csv", zig_zag_csv());
    desk.run(&["check", "studies/case.toml"]).is_done();
    // The sidecar of the record changes the rows.
    desk.run(&["studies/case.toml", "--out", "out", "--quiet"]).is_done();
    desk.file("record.trial.toml", "[part]\nuntil-s = 100.0\n");
    desk.run(&["studies/case.toml", "--out", "out"]).is_refused(2, &["another study", "record"]);
    let late = replay("../record.csv").replace("duration-s = 270.0\n", "duration-s = 270.0\nafter-execute = 1\n");
    desk.file("studies/case.toml", late);
    desk.run(&["check", "studies/case.toml"]).is_refused(2, &["`recording.after-execute` is 1", "leave the key out"]);
}

#[test]
fn line_endings_byte_order_marks_and_whole_numbers_do_no_harm() {
    let desk = Desk::new();
    desk.file("plain.toml", GOOD);
    desk.file("windows.toml", GOOD.replace('\n', "\r\n"));
    desk.file("mark.toml", format!("\u{feff}{GOOD}"));
    desk.file("船 10°.toml", changed("10.0", "10"));
    let run = desk.run(&["check", "plain.toml", "windows.toml", "mark.toml", "船 10°.toml"]);
    assert_eq!(run.is_done().out.lines().count(), 4);
    assert!(run.out.contains("船 10°.toml: 1 cell, 2 methods, 2 trials each"), "{}", run.out);
    refused(&changed("rate-deg-s = 2.5", "rate-deg-s = -2.5").replace('\n', "\r\n"), 12, &["is -2.5"]);
}

#[test]
fn check_names_what_is_right_and_what_is_wrong() {
    let desk = Desk::new();
    desk.file("good.toml", GOOD);
    desk.file("bad.toml", changed("yukun", "titanic"));
    let run = desk.run(&["check", "bad.toml", "good.toml"]);
    assert_eq!(run.code, Some(2));
    assert!(run.out.starts_with("good.toml: "), "{}", run.out);
    assert!(run.err.contains("titanic"), "{}", run.err);
}

#[test]
fn check_tells_of_a_rudder_that_moves_instantly() {
    let desk = Desk::new();
    desk.file("given.toml", GOOD);
    desk.file("left-out.toml", changed("rate-deg-s = 2.5", "dead-band-deg = 0.1"));
    let run = desk.run(&["check", "given.toml", "left-out.toml"]);
    let lines: Vec<&str> = run.is_done().out.lines().collect();
    assert_eq!(lines.len(), 3, "{}", run.out);
    assert!(lines[1].starts_with("left-out.toml: "), "{}", run.out);
    let note =
        "  note: the rudder moves instantly, because `[steering-gear] rate-deg-s` is not given and the ship has none; ";
    assert!(lines[2].starts_with(note), "{}", run.out);
    desk.file("bad.toml", changed("yukun", "titanic"));
    let quiet = desk.run(&["check", "--quiet", "left-out.toml", "bad.toml"]);
    assert_eq!((quiet.code, quiet.out.as_str()), (Some(2), ""));
    assert!(quiet.err.contains("titanic"), "{}", quiet.err);
}

#[test]
fn a_resolved_scenario_is_a_scenario() {
    let desk = Desk::new();
    desk.file("good.toml", GOOD);
    let run = desk.run(&["check", "good.toml", "--resolved"]);
    assert!(run.is_done().out.starts_with("# good.toml: 1 cell, 2 methods, 2 trials each\n"), "{}", run.out);
    assert!(run.out.contains("\nrate-deg-s = 2.5\n") && run.out.contains("\nlag-s = 0.0  # default\n"), "{}", run.out);
    desk.run(&["check", desk.file("again.toml", &run.out)]).is_done();
}

#[test]
fn every_scenario_of_the_repository_is_right() {
    let desk = Desk::new();
    let mut files: Vec<String> = std::fs::read_dir(of_repository("scenarios"))
        .expect("the folder is there")
        .map(|entry| entry.expect("readable").path())
        .filter(|path| path.extension().is_some_and(|extension| extension == "toml"))
        .map(|path| path.display().to_string())
        .collect();
    files.sort();
    let data = crate::desk::measured();
    let of_records = ["measured", "predicted"].map(|name| of_repository(&format!("scenarios/measured/{name}.toml")));
    files.extend(data.iter().flat_map(|_| &of_records).map(|path| path.display().to_string()));
    assert!(files.len() > 20);
    let mut command = desk.command(&[]);
    command.arg("check").args(&files).envs(data.map(|data| ("KEMPF_DATA", data)));
    let run = crate::desk::Run::of(command.output().expect("the program starts"));
    // Notes under a scenario are indented.
    assert_eq!(run.is_done().out.lines().filter(|line| !line.starts_with(' ')).count(), files.len());
}

/// Every method named in the title of a key figure is highlighted, if any method is.
#[test]
fn a_title_names_what_is_highlighted() {
    let mut titles = 0;
    for entry in std::fs::read_dir(of_repository("scenarios")).expect("the folder is there").flatten() {
        let Ok(text) = std::fs::read_to_string(entry.path()) else { continue };
        let scenario: toml::Table = text.parse().expect("it is TOML");
        let words = campaign::scenario::Prose::from_scenario_text(&text).output;
        let Some(title) = words.title.filter(|_| !words.highlight.series.is_empty()) else { continue };
        let ids = scenario["identifier"].as_array().expect("a list").iter().filter_map(|identifier| {
            let method = identifier.get("method").and_then(|method| method.as_table()?.keys().next().cloned());
            identifier.get("label").and_then(|label| label.as_str().map(str::to_owned)).or(method)
        });
        for id in ids.filter(|id| title.to_lowercase().contains(&id.replace('-', " "))) {
            assert!(words.highlight.series.contains(&id), "{}: {id} in \"{title}\"", entry.path().display());
            titles += 1;
        }
    }
    assert!(titles > 6, "{titles}");
}
