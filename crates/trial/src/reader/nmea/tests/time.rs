//! Stamps, clocks, epochs, gaps and midnights.

use super::*;

#[test]
fn whole_seconds_are_spread_and_a_gap_stays() {
    let mut lines = Vec::new();
    for second in [0, 1, 2, 3, 8, 9] {
        for k in 0..10 {
            lines.push(format!("14:03:{second:02} {}", summed(&format!("HEHDT,{second}.{k},T"))));
        }
    }
    let source = source(&lines);
    let heading = series(&source, Channel::Heading);
    assert_eq!(heading.time.len(), 60);
    for (time, value) in heading.time.iter().zip(degrees(heading)) {
        assert_abs_diff_eq!(*time, value, epsilon = 1e-6);
    }
    assert!(has_warning(&source, "spread evenly"));
}

/// Heading in tenths of a degree encodes the true time: ten sentences a second, and one clock sentence.
fn ten_to_one(seconds: &[u32], heading: impl Fn(u32, u32) -> bool) -> Vec<String> {
    let mut lines = vec![summed("HEHDT,200.0,T")];
    for &second in seconds {
        lines.push(rmc(&format!("1403{second:02}")));
        for k in 0..10 {
            if heading(second, k) {
                lines.push(summed(&format!("HEHDT,{second}.{k},T")));
            }
        }
    }
    lines
}

#[test]
fn ten_headings_a_second_under_a_clock_of_one() {
    let source = source(&ten_to_one(&[5, 6, 7, 8, 9, 10], |_, _| true));
    let heading = series(&source, Channel::Heading);
    assert_eq!(heading.time.len(), 60);
    for (time, value) in heading.time.iter().zip(degrees(heading)) {
        assert_abs_diff_eq!(*time + 5.0, value, epsilon = 1e-6);
    }
    assert_eq!(series(&source, Channel::Speed).time, [0.0, 1.0, 2.0, 3.0, 4.0, 5.0]);
    let expected = "the clock is $GPRMC (6 times, every 1.0 s): each sentence gets the time before it, so heading and rudder \
                    may be off by that much; sentences between two times are spread evenly";
    assert!(has_warning(&source, expected), "{:?}", source.1.warnings);
    assert!(has_warning(&source, "1 sentence before the first time is left out"));
    let clock = source.1.clock.expect("RMC has one");
    assert_eq!((clock.date_at(0.0), clock.time_of_day_at(0.0)), (Some("2026-11-20".into()), "14:03:05".into()));
}

#[test]
fn missing_seconds_stay_a_gap() {
    for (seconds, heard) in [
        // A stopped recorder.
        (vec![0, 1, 2, 3, 20, 21, 22], None),
        // A silent GPS with a running gyro.
        (vec![0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12], Some(4..8)),
    ] {
        let mut lines = ten_to_one(&seconds, |_, _| true);
        if let Some(silent) = &heard {
            lines.retain(|line| !silent.clone().any(|second| line.contains(&format!(",1403{second:02},"))));
        }
        let source = source(&lines);
        let heading = series(&source, Channel::Heading);
        assert_eq!(heading.time.len(), 10 * seconds.len());
        for (time, value) in heading.time.iter().zip(degrees(heading)) {
            assert_abs_diff_eq!(*time, value, epsilon = 1e-5);
        }
    }
}

#[test]
fn midnight_is_passed_with_and_without_dates() {
    let expected = [0.0, 1.0, 2.0, 3.0];
    let times = ["235958", "235959", "000000", "000001"];
    let date = |k: usize| if k < 2 { "201126" } else { "211126" };
    let clocks: [&dyn Fn(usize) -> String; 4] = [
        &|k| summed(&format!("GPRMC,{},A,5400.0,N,01000.0,E,10.0,90.0,{},,", times[k], date(k))),
        &|k| summed(&format!("GPGGA,{},5400.0,N,01000.0,E,1,08,0.9,545.4,M,46.9,M,,", times[k])),
        &|k| summed(&format!("GPGLL,5400.0,N,01000.0,E,{},A,A", times[k])),
        &|k| summed(&format!("GPZDA,{}.00,{},11,2026,00,00", times[k], &date(k)[..2])),
    ];
    for clock in clocks {
        let lines: Vec<String> = (0..4).flat_map(|k| [clock(k), summed("HEHDT,10.0,T")]).collect();
        let source = source(&lines);
        assert_eq!(series(&source, Channel::Heading).time, expected, "{}", lines[0]);
        assert_eq!(source.1.clock.expect("it has one").time_of_day_at(0.0), "23:59:58");
    }
    // The clock has the date of another sentence.
    let mut lines: Vec<String> = (0..4).flat_map(|k| [clocks[1](k), summed("HEHDT,10.0,T")]).collect();
    lines.insert(6, summed("GPZDA,000000.00,21,11,2026,00,00"));
    assert_eq!(source(&lines).1.clock.expect("it has one").date_at(0.0), Some("2026-11-20".into()));
    let stamped: Vec<String> = ["23:59:58", "23:59:59", "00:00:00", "00:00:01"]
        .iter()
        .map(|time| format!("{time} {}", summed("HEHDT,10.0,T")))
        .collect();
    assert_eq!(series(&source(&stamped), Channel::Heading).time, expected);
}

#[test]
fn a_clock_that_strays_once_is_left_out_and_one_that_starts_anew_is_refused() {
    for stray in ["140201", "000000", "140900", "235959"] {
        let mut lines = ten_to_one(&[0, 1, 2, 3, 4, 5, 6], |_, _| true);
        let bad = lines.iter().position(|line| line.contains(",140303,")).expect("it is there");
        lines[bad] = rmc(stray);
        let source = source(&lines);
        let heading = series(&source, Channel::Heading);
        for (time, value) in heading.time.iter().zip(degrees(heading)) {
            assert_abs_diff_eq!(*time, value, epsilon = 1e-5);
        }
        assert!(
            has_warning(&source, "1 time of $GPRMC far from its neighbours left out"),
            "{stray}: {:?}",
            source.1.warnings
        );
    }
    let again = ten_to_one(&[10, 11, 12, 13, 1, 2, 3], |_, _| true);
    let problem = read_log(&again).expect_err("time starts anew");
    assert_eq!(
        problem.to_string(),
        "line 46: the clock of the log goes back from 14:03:13 to 14:03:01, expected a single recording; cut the log \
         there and use the parts one by one"
    );
}

#[test]
fn a_stamp_that_strays_once_is_left_out_and_a_log_that_starts_anew_is_refused() {
    let write = |seconds: &[u32]| -> Vec<String> {
        seconds.iter().map(|second| format!("14:03:{second:02}.5 {}", summed(&format!("HEHDT,{second}.0,T")))).collect()
    };
    for (seconds, kept) in [([10, 11, 2, 13, 14], [0.0, 1.0, 3.0, 4.0]), ([10, 11, 50, 13, 14], [0.0, 1.0, 3.0, 4.0])] {
        let source = source(&write(&seconds));
        assert_eq!(series(&source, Channel::Heading).time, kept);
        assert!(
            has_warning(&source, "1 sentence with a stamp far from its neighbours is left out"),
            "{:?}",
            source.1.warnings
        );
    }
    let problem = read_log(&write(&[10, 11, 12, 13, 1, 2, 3])).expect_err("time starts anew");
    assert!(problem.to_string().starts_with("line 5: the clock of the log goes back from 14:03:13 to 14:03:01"));
}
