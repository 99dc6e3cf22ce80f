//! Tests of `study score`: answers of another program as a table.

use campaign::rows::StudyRow;
use campaign::store::StoredStudy;

use crate::desk::Desk;
use crate::scenarios::GOOD;

/// Scenario of two cells with three trials each.
fn study() -> String {
    let two = "[[sweep]]\nkey = \"sensor.heading-noise-deg\"\nvalues = [0.1, 0.2]\n";
    format!("{}\n{two}", GOOD.replace("replicates = 2", "replicates = 3"))
}

/// Simulates the trials of the scenario into `records`; returns for each the row of a table of answers with its true K,
/// T and δ_r.
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
        .and_then(|stored| stored.for_each_row(keep))
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
    // The list of the records and the answers in the folder are not read as records.
    let fit = desk.run(&["fit", "records", "--method", "integral-least-squares", "--out", "fitted"]);
    assert!(fit.is_done().out.contains("6 records together"), "{}", fit.out);
    // The answers do not change the rows of the other methods.
    desk.run(&["two.toml", "--seed", "7", "--out", "alone", "--quiet"]).is_done();
    let beside: Vec<StudyRow> = scored.into_iter().filter(|row| row.method < 2).collect();
    assert_eq!(beside, rows(&desk, "alone"));
    // A repeated run is accepted; changed answers are another study.
    desk.run(&["score", "records/perfect.csv", "--out", "scored", "--quiet"]).is_done();
    desk.file("records/perfect.csv", HEAD.to_owned() + &lines[1..].concat());
    let changed = desk.run(&["score", "records/perfect.csv", "--out", "scored"]);
    assert_eq!(changed.code, Some(2), "{}", changed.err);
    assert!(changed.err.contains("another study") && changed.err.contains("a table of answers"), "{}", changed.err);
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
    desk.run(&["score", "records/wrong.csv"])
        .is_refused(2, &["line 3: its trial is already answered in line 2", "line 4: \"other.csv\""]);
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
