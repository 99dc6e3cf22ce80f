//! Tests of ship, date and draughts on the first page of a report, and of draws of the estimates as a file.

use parquet::record::Field;

use crate::desk::{Desk, number, zig_zag_csv};

const FIT: [&str; 5] = ["fit", "run.csv", "--method", "output-error", "--quiet"];

/// Particulars come from the sidecar and from options, which override it; without a date there the day is that of the
/// time stamps.
#[test]
fn a_report_begins_with_ship_day_and_draughts() {
    let desk = Desk::new();
    desk.file("run.csv", zig_zag_csv());
    let fit = |more: &[&str]| {
        desk.run(&[&FIT[..], more].concat()).is_done();
        (desk.json("run-fit/fit.json")["trials"][0]["trial_particulars"].clone(), desk.text("run-fit/report.md"))
    };
    let (none, page) = fit(&[]);
    assert!(none.is_null() && !page.contains("date of the trial"), "{page}");
    let declared = "[trial]\nship-name = \"Yu Kun\"\ndate = 2012-05-04\ndraught-fore-m = 5.2\ndraught-aft-m = 5.6\n";
    desk.file("run.trial.toml", declared);
    let (of_sidecar, page) = fit(&[]);
    let expected = serde_json::json!({ "ship_name": "Yu Kun", "date": "2012-05-04", "draught_fore_m": 5.2,
        "draught_aft_m": 5.6, "draught_m": 5.4 });
    assert_eq!(of_sidecar, expected);
    let row = page.lines().find(|line| line.contains("Yu Kun")).expect("the first page names the ship");
    assert!(["2012-05-04", "5.20", "5.60", "5.40"].iter().all(|cell| row.contains(cell)), "{row}");
    assert!(page.find("Yu Kun") < page.find("Take K"), "{page}");
    let (of_options, _) = fit(&["--date", "2026-11-20", "--ship-name", "Kempf"]);
    assert_eq!([&of_options["ship_name"], &of_options["date"]], ["Kempf", "2026-11-20"]);
    desk.run(&[&FIT[..], &["--date", "20.11.2026"]].concat()).is_refused(2, &["--date", "2026-11-20"]);
    desk.run(&["trace", "run.csv", "--quiet", "--only", "steering_lag", "--out", "t"]).is_done();
    assert_eq!(desk.json("t/trace.json")["records"][0]["trial_particulars"], expected);
    assert!(desk.text("t/report.md").contains("| Yu Kun"));

    let stamped = |line: &str| match line.split_once(',') {
        Some(("t_s", rest)) => format!("time,{rest}\n"),
        Some((seconds, rest)) => {
            let seconds: u32 = seconds.parse().expect("whole seconds");
            format!("2026-11-20T14:{:02}:{:02}Z,{rest}\n", seconds / 60, seconds % 60)
        }
        None => String::new(),
    };
    desk.file("stamped.csv", zig_zag_csv().lines().map(stamped).collect::<String>());
    desk.run(&["fit", "stamped.csv", "--method", "output-error", "--quiet"]).is_done();
    let of_stamps = &desk.json("stamped-fit/fit.json")["trials"][0]["trial_particulars"];
    assert_eq!(*of_stamps, serde_json::json!({ "date": "2026-11-20" }));
}

/// The draws depend on the seed alone; their means and standard deviations are those of the estimate.
#[test]
fn draws_of_an_answer_are_a_table_on_request() {
    let desk = Desk::new();
    let swung = |row: usize, psi: f64| (psi + 0.3 * (1.7 * row as f64).sin()).to_string();
    desk.file("run.csv", crate::desk::with_column(&zig_zag_csv(), "heading_deg", swung));
    let fit = |folder: &str, more: &[&str]| {
        desk.run(&[&FIT[..], &["--out", folder], more].concat()).is_done();
    };
    fit("plain", &[]);
    assert!(!desk.path("plain/draws.parquet").exists());
    fit("f", &["--draws-file", "--draws", "400"]);
    fit("again", &["--draws-file", "--draws", "400", "--threads", "1", "--seed", "0"]);
    fit("other", &["--draws-file", "--draws", "400", "--seed", "1"]);
    assert!(desk.bytes("f/draws.parquet") == desk.bytes("again/draws.parquet"), "one seed is one file");
    assert!(desk.bytes("f/draws.parquet") != desk.bytes("other/draws.parquet"));
    let rows = desk.rows("f/draws.parquet");
    assert!(rows.len() == 400 && rows.iter().zip(0..).all(|(row, number)| row["draw"] == Field::Long(number)));
    let [method, structure] = ["output-error", "first_order"].map(|text| Field::Str(text.into()));
    assert!(rows.iter().all(|row| row["method"] == method && row["structure"] == structure), "{:?}", rows[0]);
    let parameters = &desk.json("f/fit.json")["methods"][0]["parameters"];
    for (column, key) in [("K_per_s", "K_per_s"), ("T_s", "T_s")] {
        let values: Vec<f64> = rows.iter().map(|row| number(row, column)).collect();
        let mean = values.iter().sum::<f64>() / 400.0;
        let sd = (values.iter().map(|value| (value - mean).powi(2)).sum::<f64>() / 399.0).sqrt();
        let told = |name: &str| parameters[key][name].as_f64().expect("a number");
        assert!((mean - told("value")).abs() < 0.3 * told("sd"), "{column}: {mean} {parameters}");
        assert!((sd / told("sd") - 1.0).abs() < 0.2, "{column}: {sd} {parameters}");
    }
    assert!(rows.iter().all(|row| number(row, "parameter.inverse_T") * number(row, "T_s") - 1.0 < 1e-12));

    let trace = ["trace", "run.csv", "--quiet", "--only", "nonlinear_damping", "--draws-file", "--draws", "50"];
    for folder in ["t", "t-again"] {
        desk.run(&[&trace[..], &["--out", folder]].concat()).is_done();
    }
    assert!(desk.bytes("t/draws.parquet") == desk.bytes("t-again/draws.parquet"), "one seed is one file");
    let rows = desk.rows("t/draws.parquet");
    assert!(rows.len() == 50 && rows[0]["method"] == Field::Str("trace".into()), "{:?}", rows[0]);
    assert!(rows[0].keys().any(|name| name.starts_with("parameter.nonlinear_damping.")), "{:?}", rows[0]);
}
