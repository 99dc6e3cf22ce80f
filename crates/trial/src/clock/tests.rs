use super::*;

fn seconds(stamps: &[&str]) -> Result<Vec<f64>, StampFault> {
    let mut clock = StampConverter::default();
    stamps.iter().map(|text| clock.seconds(TimeStamp::parse(text).expect(text))).collect()
}

#[test]
fn the_calendar_agrees_with_known_days() {
    // Day numbers of the Unix epoch: 2000-03-01 is day 11017, 2026-11-20 day 20777 (POSIX formula).
    for (given, day) in [((1970, 1, 1), 0), ((2000, 3, 1), 11_017), ((2026, 11, 20), 20_777), ((1969, 12, 31), -1)] {
        assert_eq!(days_since_1970(given.0, given.1, given.2), Some(day));
    }
    assert_eq!(
        [date(20_777), date(-1), date(-719_528)].map(|day| day.to_string()),
        ["2026-11-20", "1969-12-31", "0000-01-01"]
    );
    assert_eq!(
        [
            days_since_1970(2025, 2, 29),
            days_since_1970(2024, 13, 1),
            days_since_1970(2024, 4, 31),
            days_since_1970(2024, 0, 1)
        ],
        [None; 4]
    );
    assert!(
        days_since_1970(2024, 2, 29).is_some()
            && days_since_1970(1900, 2, 29).is_none()
            && days_since_1970(2000, 2, 29).is_some()
    );
}

#[test]
fn one_moment_in_many_notations() {
    let same = [
        "2026-11-20T14:03:05",
        "2026-11-20 14:03:05",
        "2026/11/20 14:03:05.0",
        "20261120T140305",
        "20.11.2026 14:03:05",
        "20.11.26 14:03:05,00",
        "11/20/2026 2:03:05 PM",
        "20/11/2026 14:03:05",
        "20-Nov-2026 14:03:05",
        "20 November 2026 14:03:05",
        "Nov 20, 2026 2:03:05 pm",
    ];
    for text in same {
        let mut stamps = StampConverter::default();
        assert_eq!(stamps.seconds(TimeStamp::parse(text).expect(text)), Ok(0.0));
        let clock = stamps.clock().expect("a stamp was read");
        assert_eq!((clock.day, clock.second, clock.utc_offset_min), (Some(20_777), 50_585.0, None), "{text}");
        assert_eq!((clock.time_of_day_at(60.0), clock.date_at(60.0)), ("14:04:05".into(), Some("2026-11-20".into())));
    }
    let zone = |text| TimeStamp::parse(text).expect(text).utc_offset_min;
    assert_eq!(zone("2026-11-20T14:03:05Z"), Some(0));
    assert_eq!(zone("2026-11-20T14:03:05.25+01:00"), Some(60));
    assert_eq!(zone("2026-11-20 14:03:05 -0330"), Some(-210));
    assert_eq!(zone("14:03:05 UTC"), Some(0));
}

#[test]
fn what_is_no_stamp_is_none() {
    for text in [
        "",
        "12.5",
        "20261120",
        "2026-13-01 00:00:00",
        "25:00:00",
        "14:61:00",
        "2026-11-20T",
        "heading",
        "31.02.2026 10:00:00",
        "2026-11-20T14:03:05 sea",
        "1:2:3:4",
        "-1",
        "123456789012",
        "Ä",
        "20-Nov",
    ] {
        assert_eq!(TimeStamp::parse(text), None, "{text}");
    }
    assert!(TimeStamp::parse("20.11.2026").is_some_and(|stamp| !stamp.has_time()));
    assert!(TimeStamp::parse("14:03").is_some_and(|stamp| stamp.has_time()));
}

#[test]
fn time_runs_on_over_midnight_zones_and_missing_seconds() {
    assert_eq!(seconds(&["23:59:58", "23:59:59.5", "00:00:01", "00:00:04"]), Ok(vec![0.0, 1.5, 3.0, 6.0]));
    assert_eq!(seconds(&["31.12.2026 23:59:58", "01.01.2027 00:00:01"]), Ok(vec![0.0, 3.0]));
    assert_eq!(seconds(&["2026-11-20T14:00:00+01:00", "2026-11-20T13:00:10Z"]), Ok(vec![0.0, 10.0]));
    // A small step back is no midnight: the reader refuses it.
    assert_eq!(seconds(&["12:00:05", "12:00:03"]), Ok(vec![0.0, -2.0]));
}

#[test]
fn which_number_is_the_month_shows_where_the_date_changes() {
    assert_eq!(seconds(&["03/04/2026 23:59:59", "03/04/2026 23:59:59.5"]), Ok(vec![0.0, 0.5]));
    assert_eq!(seconds(&["03/04/2026 23:59:59", "04/04/2026 00:00:01"]), Ok(vec![0.0, 2.0]));
    assert_eq!(seconds(&["03/04/2026 23:59:59", "03/05/2026 00:00:01"]), Ok(vec![0.0, 2.0]));
    assert_eq!(seconds(&["12/31/2026 23:59:59", "01/01/2027 00:00:01"]), Ok(vec![0.0, 2.0]));
    assert_eq!(seconds(&["03/04/2026 12:00:00", "09/04/2026 12:00:00"]), Err(StampFault::AmbiguousDate));
    assert_eq!(seconds(&["20.11.2026"]), Err(StampFault::NoTime));
}

#[test]
fn a_clock_finds_its_times() {
    let mut stamps = StampConverter::default();
    stamps.seconds(TimeStamp::parse("2026-11-20 23:00:00").expect("a stamp")).expect("it has a time");
    let clock = stamps.clock().expect("a stamp was read");
    let at = |text| clock.record_time(&TimeStamp::parse(text).expect(text));
    assert_eq!(at("23:10"), Some(600.0));
    assert_eq!(at("00:10:00"), Some(4200.0));
    assert_eq!(at("2026-11-21T00:10:00"), Some(4200.0));
}
