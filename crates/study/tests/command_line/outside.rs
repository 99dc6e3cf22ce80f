//! Methods that are other programs, as far as the command line goes: what is said of them, and answers that come as a
//! table. What a program answers is tested where there is one, with the tests of the whole workspace.

use campaign::rows::StudyRow;
use campaign::store::StoredStudy;

use crate::desk::{Desk, zig_zag_csv};
use crate::scenarios::GOOD;

const OUTSIDE: &str =
    "[[identifier]]\nlabel = \"mine\"\nmethod.external = { command = [\"no-such-program-here\", \"a b.py\"] }\n";

/// A script that answers every question with K = 0.1 1/s and T = 16 s.
const ANSWER: &str =
    r#"while IFS= read -r line; do n=${line#*:}; echo "{\"trial\":${n%%,*},\"K_per_s\":0.1,\"T_s\":16}"; done"#;

#[test]
fn a_check_names_the_commands_and_starts_nothing() {
    let desk = Desk::new();
    desk.file("outside.toml", format!("{GOOD}\n{OUTSIDE}"));
    let run = desk.run(&["check", "outside.toml"]);
    run.is_done();
    assert!(
        run.out.contains("3 methods") && run.out.contains("a run starts `no-such-program-here \"a b.py\"` for `mine`")
    );
    let resolved = desk.run(&["check", "--resolved", "outside.toml"]);
    assert!(resolved.is_done().out.contains("timeout-s = 60.0  # default"), "{}", resolved.out);
    desk.run(&["outside.toml"]).is_refused(2, &["`mine`", "`no-such-program-here` on the PATH", "outside.toml"][..2]);
    desk.file(
        "script.toml",
        format!("{GOOD}\n{OUTSIDE}").replace("no-such-program-here\", \"a b.py", "sh\", \"mine.sh"),
    );
    desk.run(&["script.toml"]).is_refused(2, &["there is no file mine.sh in", "manifest"]);
    assert!(["outside", "script"].iter().all(|name| !desk.path("results").join(name).join("unfinished").exists()));
}

/// A terminal would not tell the program, and one that computes does not see that its input has ended.
#[cfg(unix)]
#[test]
fn ctrl_c_leaves_no_program_behind() {
    use std::time::{Duration, Instant};
    let desk = Desk::new();
    let busy =
        "method.external = { command = [\"sh\", \"-c\", \"echo $$ > pid.tmp; mv pid.tmp pid; exec sleep 3600\"] }";
    desk.file("busy.toml", format!("{GOOD}\n[[identifier]]\n{busy}\n"));
    let mut run = desk.start(&["busy.toml", "--threads", "1", "--quiet"]);
    let wait = |until: &mut dyn FnMut() -> bool| {
        let start = Instant::now();
        while !until() {
            assert!(start.elapsed() < Duration::from_secs(60), "nothing happens");
            std::thread::sleep(Duration::from_millis(10));
        }
    };
    wait(&mut || desk.path("pid").exists());
    let pid = desk.text("pid").trim().to_owned();
    let kill = |signal: &str, pid: &str| {
        let mut kill = std::process::Command::new("kill");
        kill.args([signal, pid]).stderr(std::process::Stdio::null()).status().expect("it is on every system").success()
    };
    assert!(kill("-0", &pid), "it is at work");
    assert!(kill("-INT", &run.id().to_string()));
    assert_eq!(run.wait().expect("it ends").code(), Some(1));
    wait(&mut || !kill("-0", &pid));
}

/// Sixty trials of half a second each would be half a minute.
#[cfg(unix)]
#[test]
fn a_program_that_hangs_costs_three_trials_and_one_line() {
    let desk = Desk::new();
    let hangs = "method.external = { command = [\"sleep\", \"3600\"], timeout-s = 0.5 }";
    let good = GOOD.replace("replicates = 2", "replicates = 60");
    desk.file("hangs.toml", format!("{good}\n[[identifier]]\nlabel = \"mine\"\n{hangs}\n"));
    let start = std::time::Instant::now();
    let run = desk.run(&["hangs.toml", "--threads", "1", "--out", "out"]);
    assert!(start.elapsed().as_secs() < 15, "{:?}", start.elapsed());
    assert_eq!(run.is_done().err.matches("given up").count(), 1, "{}", run.err);
    assert!(run.err.contains("warning: mine: `sleep 3600` gave no answer within 0.5 s"), "{}", run.err);
    let found = rows(&desk, "out");
    let own: Vec<_> = found.iter().filter(|row| row.method == 2).collect();
    assert!(own.len() == 60 && own.iter().all(|row| row.failure == own[0].failure && row.failure.is_some()));
    // The same rows whatever the threads, and when it is looked at again.
    desk.run(&["hangs.toml", "--threads", "2", "--out", "two"]).is_done();
    assert_eq!(found, rows(&desk, "two"));
    desk.run(&["hangs.toml", "--out", "out"]).is_done();
}

/// A manifest has the scripts beside it, be they beside the scenario or elsewhere, and shards hand them on.
#[cfg(unix)]
#[test]
fn a_manifest_runs_its_scripts_where_it_lies() {
    let desk = Desk::new();
    desk.file("here/deep/mine.sh", ANSWER);
    desk.file("tools/theirs.sh", ANSWER.replace("16", "17"));
    let method = |label: &str, script: &str| {
        format!("[[identifier]]\nlabel = {label:?}\nmethod.external = {{ command = [\"sh\", {script:?}] }}\n")
    };
    let text = format!("{GOOD}\n{}{}", method("mine", "deep/mine.sh"), method("theirs", "../tools/theirs.sh"));
    desk.file("here/own.toml", text);
    desk.run(&["here/own.toml", "--out", "out"]).is_done();
    desk.run(&["here/own.toml", "--out", "one", "--shard", "1/2"]).is_done();
    desk.run(&["here/own.toml", "--out", "two", "--shard", "2/2"]).is_done();
    for folder in ["here", "tools"] {
        std::fs::remove_dir_all(desk.path(folder)).expect("they were there");
    }
    desk.run(&["merge", "one", "two", "--out", "joined"]).is_done();
    let first = rows(&desk, "out");
    assert!(first.iter().filter(|row| row.method >= 2).all(|row| row.failure.is_none()));
    for (manifest, out) in
        [("out/manifest.toml", "again"), ("joined/manifest.toml", "third"), ("out/manifest.toml", "out")]
    {
        desk.run(&[manifest, "--out", out]).is_done();
        assert_eq!(first, rows(&desk, out), "{manifest}");
    }
    // A script that was changed there is another study.
    desk.file("out/sources/up/deep/mine.sh", ANSWER.replace("16", "15"));
    let changed = desk.run(&["out/manifest.toml", "--out", "again"]);
    assert!(changed.code == Some(2) && changed.err.contains("a file that a command in it names"), "{}", changed.err);
}

#[test]
fn wrong_settings_of_a_command_are_shown_where_they_stand() {
    let desk = Desk::new();
    for (settings, parts) in [
        ("{}", &["`command`"][..]),
        ("{ command = [] }", &["a list of 0", "1 to 64 words"]),
        ("{ command = \"python3 mine.py\" }", &["command", "a list"]),
        ("{ command = [\"a\"], timeout-s = -1 }", &["timeout-s", "from 0.01 to 86400 s"]),
        ("{ command = [\"a\"], timeout = 1 }", &["no such key", "`timeout-s`"]),
    ] {
        desk.file("wrong.toml", format!("{GOOD}\n[[identifier]]\nmethod.external = {settings}\n"));
        let run = desk.run(&["check", "wrong.toml"]);
        run.is_refused(2, parts);
        assert!(run.err.contains("--> wrong.toml:29:"), "{}", run.err);
    }
}

#[test]
fn the_list_of_methods_has_the_outside_ones_with_their_keys() {
    let run = Desk::new().run(&["list", "identifiers"]);
    run.is_done();
    let line = run.out.lines().find(|line| line.starts_with("external")).expect("it is listed");
    assert!(line.contains("command") && line.contains("timeout-s = 60.0"), "{line}");
}

#[test]
fn a_wrong_command_is_refused_before_a_record_is_read() {
    let desk = Desk::new();
    let fit = |external: &str| desk.run(&["fit", "none.csv", "--external", external]);
    fit("mine").is_refused(2, &["LABEL=COMMAND"]);
    fit("mine='python3").is_refused(2, &["quote"]);
    fit("mine=no-such-program-here 'x y'").is_refused(2, &["--external mine=…", "`no-such-program-here` on the PATH"]);
    fit("srivc=no-such-program-here").is_refused(2, &["another method"]);
    assert!(!desk.path("none-fit").exists());
}

/// Two cells of three trials each.
fn study() -> String {
    let two = "[[sweep]]\nkey = \"sensor.heading-noise-deg\"\nvalues = [0.1, 0.2]\n";
    format!("{}\n{two}", GOOD.replace("replicates = 2", "replicates = 3"))
}

/// The trials of the study in a folder, and for each the line of a table of answers with the true K, T and δ_r.
fn simulated(desk: &Desk) -> Vec<String> {
    desk.file("two.toml", study());
    let all = ["simulate", "two.toml", "--replicate", "all", "--seed", "7", "--out", "records", "--quiet"];
    desk.run(&all).is_done();
    let list = desk.text("records/trials.csv");
    assert_eq!(list.lines().next(), Some("record,cell,label,replicate,also"));
    let line = |line: &str| {
        let record = line.split(',').next().expect("a record");
        let truth = desk.json(&format!("records/{}", record.replace(".csv", ".truth.json")));
        let [k, t, bias] = ["K_per_s", "T_s", "delta_r_deg"].map(|name| truth["nearest"][name].clone());
        format!("{record},{k},{t},{bias}\n")
    };
    list.lines().skip(1).map(line).collect()
}

const HEAD: &str = "record,K_per_s,T_s,delta_r_deg\n";

/// The rows of a finished study.
pub fn rows(desk: &Desk, folder: &str) -> Vec<StudyRow> {
    let mut rows = Vec::new();
    let keep = |row| {
        rows.push(row);
        Ok(())
    };
    StoredStudy::read(&desk.path(folder))
        .and_then(|stored| stored.rows(keep))
        .unwrap_or_else(|failure| panic!("{failure}"));
    rows
}

#[test]
fn answers_from_the_truth_have_no_error() {
    let desk = Desk::new();
    let lines = simulated(&desk);
    assert_eq!(lines.len(), 6);
    desk.file("records/perfect.csv", HEAD.to_owned() + &lines.concat());
    let run = desk.run(&["score", "records/perfect.csv", "--out", "scored"]);
    assert!(run.is_done().out.contains("perfect") && run.err.is_empty(), "{}\n{}", run.out, run.err);
    let scored = rows(&desk, "scored");
    assert_eq!(scored.len(), 18);
    for row in &scored {
        let is_ours = row.method == 2;
        let error = row.errors()[1].expect("all answered").abs();
        assert!(if is_ours { error < 1e-12 } else { error > 1e-6 }, "{row:?}");
    }
    // Among the records of the folder neither their list nor the answers are taken for one.
    let fit = desk.run(&["fit", "records", "--method", "integral-least-squares", "--out", "fitted"]);
    assert!(fit.is_done().out.contains("6 records together"), "{}", fit.out);
    // The other methods answer as if nobody else had.
    desk.run(&["two.toml", "--seed", "7", "--out", "alone", "--quiet"]).is_done();
    let beside: Vec<StudyRow> = scored.into_iter().filter(|row| row.method < 2).collect();
    assert_eq!(beside, rows(&desk, "alone"));
    // Whoever asks again gets the same, and answers that have changed are another study.
    desk.run(&["score", "records/perfect.csv", "--out", "scored", "--quiet"]).is_done();
    desk.file("records/perfect.csv", HEAD.to_owned() + &lines[1..].concat());
    let changed = desk.run(&["score", "records/perfect.csv", "--out", "scored"]);
    assert_eq!(changed.code, Some(2), "{}", changed.err);
    assert!(changed.err.contains("another study") && changed.err.contains("answers that were read"), "{}", changed.err);
    assert!(changed.err.contains("1 of 6 trials have no answer"), "{}", changed.err);
    desk.run(&["score", "records/perfect.csv", "--out", "scored", "--restart", "--label", "less", "--quiet"]).is_done();
    let failed: Vec<Option<Box<str>>> = rows(&desk, "scored").into_iter().map(|row| row.failure).collect();
    assert_eq!(failed.iter().flatten().collect::<Vec<_>>(), [&Box::from("outside: no answer")]);
}

#[test]
fn answers_to_other_trials_are_refused() {
    let desk = Desk::new();
    let lines = simulated(&desk);
    let wrong = format!("{HEAD}{}{}other.csv,0.1,16,0\n", lines[0], lines[0]);
    desk.file("records/wrong.csv", wrong);
    desk.run(&["score", "records/wrong.csv"]).is_refused(2, &["line 3: the trial of line 2", "line 4: \"other.csv\""]);
    desk.file("elsewhere.csv", HEAD.to_owned() + &lines.concat());
    desk.run(&["score", "elsewhere.csv"]).is_refused(2, &["--scenario"]);
    desk.run(&["score", "elsewhere.csv", "--scenario", "two.toml", "--seed", "7", "--quiet"]).is_done();
    assert!(desk.path("results/two-score/report.md").exists());
    desk.file("records/right.csv", HEAD.to_owned() + &lines.concat());
    desk.run(&["score", "records/right.csv", "--seed", "8"]).is_refused(2, &["another seed"]);
    desk.file("changed.toml", study().replace("[0.1, 0.2]", "[0.1, 0.3]"));
    let changed = ["score", "records/right.csv", "--scenario", "changed.toml"];
    desk.run(&changed).is_refused(2, &["are not those of the scenario"]);
}

/// A fit asks other programs too. What one says beside its answers could act on a terminal, and has no end.
#[cfg(unix)]
#[test]
fn what_a_program_of_a_fit_says_goes_into_a_bounded_log() {
    let desk = Desk::new();
    desk.file("answers.sh", ANSWER);
    desk.file("zz.csv", zig_zag_csv());
    let talks = "read line; printf '\\033]0;title\\007' >&2; head -c 3000000 /dev/zero | tr '\\0' z >&2; exit 3";
    desk.file("talks.sh", talks);
    let fit = ["fit", "zz.csv", "--method", "least-squares", "--external", "it talks=sh talks.sh", "--out", "o"];
    let run = desk.run(&[&fit[..], &["--external", "my own=sh answers.sh"]].concat());
    assert!(run.is_done().err.len() < 10_000 && !run.err.contains('\u{1b}'), "{} bytes", run.err.len());
    let size = std::fs::metadata(desk.path("o/external-it-talks.log")).expect("a log").len();
    assert!((1 << 20..(1 << 20) + 100).contains(&size), "{size} bytes");
    let fitted = desk.json("o/fit.json");
    let [ours, _, own] = [0, 1, 2].map(|number| &fitted["methods"][number]);
    assert!(ours["id"].is_null() && own["id"] == "external" && own["method"] == "my own", "{own}");
    let k = own["parameters"]["K_per_s"]["value"].as_f64().expect("an answer");
    assert!((k - 0.1).abs() < 1e-12 && desk.text("o/report.md").contains("my own"), "{k}");
}
