//! The boat of Fuzhou, whose headings were interpolated between packets: no noise of the trace describes them.

use std::fs;
use std::path::Path;

use document::trace::TraceVerdict;
use kempf_tests::measured;
use trace::Settings;

/// Structures that replay a record no nearer than the base, under a noise that does not describe what they leave, name
/// nothing, whatever their probability. On her turning circle they are worse than the base by two and a half.
#[test]
fn interpolated_headings_name_no_effect() {
    let Some(path) = measured::place("usv_fuzhou/zigzag_30_inter_xy.csv") else { return };
    let scratch = tempfile::tempdir().expect("a folder");
    let copy = scratch.path().join("boat.csv");
    fs::write(&copy, without_jumps(&fs::read_to_string(path).expect("text"), "zcourse")).expect("a copy");
    let sidecar = Path::new(env!("CARGO_MANIFEST_DIR")).join("../scenarios/measured/zigzag_30_inter_xy.trial.toml");
    let trial = trial::read_with_sidecar(&copy, Some(&sidecar)).expect("a record").trial;
    let analysis = trace::trace(&[trial], &[], &Settings::default()).expect("a base");
    let document = analysis.document;
    assert!(document.effects.is_empty(), "{:?}", document.effects);
    assert_eq!(document.verdict, TraceVerdict::Unexplained);
    assert!(!document.noise[0].is_adequate);
    // The rule has something to hold back: the search found effects.
    assert!(document.candidates.iter().any(|own| own.probability > 0.9), "{:?}", document.candidates);
    assert!(document.error.kept_base.is_some_and(|words| words.contains("no effect is named")));
}

/// Difference, deg, between two rows from which a direction has passed north: no ship turns so fast.
const JUMP: f64 = 60.0;

/// The same table with empty cells in a column of directions, deg, on either side of every jump.
fn without_jumps(text: &str, column: &str) -> String {
    let mut rows: Vec<Vec<&str>> = text.lines().map(|line| line.split(',').collect()).collect();
    let Some(place) = rows.first().and_then(|head| head.iter().position(|name| *name == column)) else {
        return text.to_owned();
    };
    let direction = |row: &Vec<&str>| row.get(place).and_then(|cell| cell.parse::<f64>().ok());
    let directions: Vec<Option<f64>> = rows.iter().map(direction).collect();
    for (before, pair) in directions.windows(2).enumerate() {
        let [Some(one), Some(two)] = *pair else { continue };
        if (two - one).abs() > JUMP {
            rows[before][place] = "";
            rows[before + 1][place] = "";
        }
    }
    rows.iter().map(|row| row.join(",") + "\n").collect()
}
