//! Measured trials: the parts that the search finds against those bounded by hand.

use kempf_tests::measured;
use trial::find::{ApproachState, DetectedManoeuvre, LogSignals, detect_manoeuvres};
use trial::{Channel, Columns};

/// The manoeuvres of a measured record.
fn searched(columns: &Columns) -> Vec<DetectedManoeuvre> {
    let channel = |channel| columns.channels.get(&channel).map(Vec::as_slice);
    detect_manoeuvres(&LogSignals {
        time: &columns.time,
        rudder: channel(Channel::Rudder).expect("a column"),
        heading: channel(Channel::Heading).expect("a column"),
        speed: channel(Channel::Speed),
        propeller_rate: channel(Channel::PropellerRate),
    })
}

/// A measured record and the one manoeuvre in it, which has this name.
fn only(file: &str, name: &str) -> Option<(Columns, DetectedManoeuvre)> {
    let table = measured::columns(file)?;
    let mut found = searched(&table);
    assert_eq!(found.len(), 1, "{file}: {found:?}");
    assert_eq!(found[0].name(), name, "{file}");
    Some((table, found.remove(0)))
}

/// Parts bounded by hand (`scenarios/measured`): the row in which the first full order is given, and the last before
/// the rudder is ordered amidships. The approaches are manual, and the model still gathers way.
const BY_HAND: [(&str, &str, f64, f64); 5] = [
    ("zigzag_13_04_24", "zig-zag 20/20", 44.2, 124.3),
    ("zigzag_13_14_21", "zig-zag 30/30", 18.4, 110.5),
    ("zigzag_13_42_53", "zig-zag 30/30", 33.7, 189.5),
    ("zigzag_13_57_45", "zig-zag 20/20", 26.5, 108.1),
    ("zigzag_14_10_05", "zig-zag 20/20", 32.5, 149.2),
];

#[test]
fn whole_logs_of_esso_osaka_give_the_parts_bounded_by_hand() {
    for (file, name, from, until) in BY_HAND {
        let Some((_, found)) = only(&format!("esso_osaka/{file}.csv"), name) else { return };
        assert!((found.start_time - from).abs() < 0.11, "{file}: from {}", found.start_time);
        assert!((found.end_time - until).abs() < 0.11, "{file}: until {}", found.end_time);
        assert_eq!(found.quality.approach, Some(ApproachState::Unsteady), "{file}");
    }
}

/// Begin of the turn as ordered, end before the propeller stops or the rudder is ordered amidships.
const CIRCLES: [(&str, &str, f64, f64); 4] = [
    ("turning_oct14_14_29_49", "turning circle 20 to starboard", 110.0, 440.1),
    ("turning_oct14_15_06_53", "turning circle 20 to port", 110.0, 420.5),
    ("turning_sep14_13_51_45", "turning circle 35 to starboard", 120.0, 401.4),
    ("turning_sep14_14_50_41", "turning circle 35 to starboard", 160.0, 517.3),
];

#[test]
fn turns_of_esso_osaka_are_found() {
    for (file, name, from, until) in CIRCLES {
        let Some((_, found)) = only(&format!("esso_osaka/{file}.csv"), name) else { return };
        assert!((found.start_time - from).abs() < 0.21, "{file}: from {}", found.start_time);
        assert!((found.end_time - until).abs() < 0.11, "{file}: until {}", found.end_time);
    }
}

/// Name, first row with the rudder under way (s) and number of executes of records that a zig-zag fills.
const FILLED: [(&str, &str, f64, usize); 11] = [
    ("kvlcc2_hsva/zigzag_05_01.csv", "zig-zag 5/1", 0.8, 9),
    ("kvlcc2_hsva/zigzag_10_05.csv", "zig-zag 10/5", 1.7, 6),
    ("kvlcc2_hsva/zigzag_10_10_s.csv", "zig-zag 10/10", 0.9, 3),
    ("kvlcc2_hsva/zigzag_15_05.csv", "zig-zag 15/5", 1.4, 8),
    ("kvlcc2_hsva/zigzag_20_05.csv", "zig-zag 20/5", 1.4, 9),
    ("kvlcc2_hsva/zigzag_20_10_s.csv", "zig-zag 20/10", 0.9, 8),
    ("kvlcc2_hsva/zigzag_30_05.csv", "zig-zag 30/5", 0.5, 11),
    ("kvlcc2_hsva/zigzag_35_05.csv", "zig-zag 35/5", 0.9, 12),
    ("kvlcc2_marin/zigzag_-20.csv", "zig-zag 20/20", 7.0, 4),
    ("kvlcc2_marin/zigzag_10.csv", "zig-zag 10/10", 7.6, 3),
    ("kvlcc2_marin/zigzag_20.csv", "zig-zag 20/20", 6.5, 4),
];

#[test]
fn records_filled_by_a_zig_zag_are_taken_whole() {
    for (file, name, start, executes) in FILLED {
        let Some((table, found)) = only(file, name) else { return };
        assert_eq!(found.execute_count, executes, "{file}");
        let ends = (table.time[0], table.time[table.time.len() - 1]);
        assert_eq!((found.start_time, found.end_time), ends, "{file}");
        let row = 1.01 * (table.time[1] - table.time[0]);
        assert!((found.first_execute_time - start).abs() < row, "{file}: starts at {}", found.first_execute_time);
        assert_eq!(found.quality.remarks(), [""; 0], "{file}");
    }
}

/// The record of MARIN goes on with the rudder amidships.
#[test]
fn a_turning_circle_is_followed_by_its_pull_out() {
    let Some(table) = measured::columns("kvlcc2_marin/turning_35.csv") else { return };
    let found = searched(&table);
    let names: Vec<String> = found.iter().map(|found| found.name()).collect();
    assert_eq!(names, ["turning circle 35 to port", "pull-out"]);
    assert_eq!(found[0].start_time, 0.0);
    assert!((found[0].first_execute_time - 4.1).abs() < 0.6 && (found[0].end_time - 1513.0).abs() < 1.1, "{found:?}");
    assert!(found[1].start_time > found[0].end_time && found[1].start_time - found[0].end_time < 0.6);
}
