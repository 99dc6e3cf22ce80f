use std::f64::consts::PI;

use approx::assert_abs_diff_eq;
use proptest::prelude::*;

use super::frame::{Number, number, sum};
use super::*;
use crate::channel::Channel;
use crate::encoding::Encoding;

/// A sentence with its checksum.
fn summed(body: &str) -> String {
    format!("${body}*{:02X}", sum(body.as_bytes()))
}

fn read_bytes(bytes: &[u8]) -> Result<Source, Problem> {
    read(Vec::new(), Lines::new(bytes, Encoding::Utf8))
}

fn read_log(lines: &[String]) -> Result<Source, Problem> {
    read_bytes(lines.join("\r\n").as_bytes())
}

fn source(lines: &[String]) -> Source {
    read_log(lines).expect("a log that can be read")
}

fn series(source: &Source, channel: Channel) -> &Series {
    source.series.iter().find(|series| series.channel == channel).expect("the channel is there")
}

fn has(source: &Source, channel: Channel) -> bool {
    source.series.iter().any(|series| series.channel == channel)
}

fn degrees(series: &Series) -> Vec<f64> {
    series.values.iter().map(|value| (value.to_degrees() * 1e9).round() / 1e9).collect()
}

fn told(source: &Source, text: &str) -> bool {
    source.warnings.iter().any(|warning| warning.contains(text))
}

/// `14:03:05` and so on, one sentence a second.
fn stamped(bodies: &[&str]) -> Vec<String> {
    bodies.iter().enumerate().map(|(k, body)| format!("2026-11-20T14:03:{:02}Z {}", k, summed(body))).collect()
}

fn rmc(time: &str) -> String {
    summed(&format!("GPRMC,{time},A,5400.000,N,01000.000,E,10.0,90.0,201126,,"))
}

#[test]
fn each_sentence_gives_its_quantities() {
    let deg = PI / 180.0;
    let kn = 1852.0 / 3600.0;
    let cases: &[(&str, Channel, f64)] = &[
        ("HEHDT,274.07,T", Channel::Heading, 274.07 * deg),
        ("HEHDT,360.0,T", Channel::Heading, 0.0),
        ("HETHS,274.07,A", Channel::Heading, 274.07 * deg),
        ("HCHDM,101.1,M", Channel::Heading, 101.1 * deg),
        ("HCHDG,101.1,,,7.1,W", Channel::Heading, 94.0 * deg),
        ("HCHDG,1.1,3.0,W,1.0,E", Channel::Heading, 359.1 * deg),
        ("VWVHW,100.5,T,99.0,M,12.5,N,23.2,K", Channel::Heading, 100.5 * deg),
        ("VWVHW,100.5,T,99.0,M,12.5,N,23.2,K", Channel::Speed, 12.5 * kn),
        ("VWVHW,,T,,M,,N,18.0,K", Channel::Speed, 5.0),
        ("GPROT,35.6,A", Channel::YawRate, 35.6 / 60.0 * deg),
        ("TIROT,-30.0,A", Channel::YawRate, -0.5 * deg),
        ("IIRSA,10.5,A,,V", Channel::Rudder, 10.5 * deg),
        ("IIRSA,-20.0,A,-21.0,A", Channel::Rudder, -20.5 * deg),
        ("IIRSA,,V,7.0,A", Channel::Rudder, 7.0 * deg),
        ("APHTD,V,10.0,L,M,R,15.0,10.0,,,95.0,,,T,A,A,A,95.0", Channel::RudderOrder, -10.0 * deg),
        ("APHTC,V,20.0,R,M,R,25.0,10.0,,,95.0,,,T", Channel::RudderOrder, 20.0 * deg),
        ("GPVTG,054.7,T,034.4,M,005.5,N,010.2,K", Channel::Speed, 5.5 * kn),
        ("GPRMC,123519,A,4807.038,N,01131.000,E,022.4,084.4,230394,003.1,W", Channel::Speed, 22.4 * kn),
        ("VDVBW,12.0,-0.5,A,11.8,0.1,A", Channel::Surge, 12.0 * kn),
        ("VDVBW,12.0,-0.5,A,11.8,0.1,A", Channel::Sway, -0.5 * kn),
        ("VDVBW,3.0,-4.0,A,,,V", Channel::Speed, 5.0 * kn),
        ("VDVBW,,,V,11.8,0.1,A", Channel::Surge, 11.8 * kn),
        ("ERRPM,S,1,120.0,80.0,A", Channel::PropellerRate, 2.0),
        ("IIMWV,214.8,R,36.0,K,A", Channel::WindRelativeSpeed, 10.0),
        ("IIMWV,214.8,R,0.1,M,A", Channel::WindRelativeFrom, 214.8 * deg),
        ("IIMWV,214.8,T,10.0,N,A", Channel::WindTrueSpeed, 10.0 * kn),
        ("WIMWD,270.0,T,268.5,M,12.4,N,6.4,M", Channel::WindTrueFrom, 270.0 * deg),
        ("WIMWD,270.0,T,268.5,M,12.4,N,6.4,M", Channel::WindTrueSpeed, 6.4),
        ("YXXDR,A,5.0,D,PTCH,A,-2.5,D,ROLL", Channel::Roll, -2.5 * deg),
        ("YXXDR,A,-12.0,D,RUDDER", Channel::Rudder, -12.0 * deg),
    ];
    for (body, channel, expected) in cases {
        let source = source(&stamped(&[body, body]));
        let series = series(&source, *channel);
        assert_eq!(series.time, [0.0, 1.0], "{body}");
        assert_abs_diff_eq!(series.values[0], *expected, epsilon = 1e-12);
        assert_eq!(series.values[0], series.values[1]);
    }
}

/// Sentences as manuals of instruments print them, with the checksums printed there.
#[test]
fn published_sentences_have_their_checksums() {
    for line in [
        "$GPHDT,274.07,T*03",
        "$GPRMC,123519,A,4807.038,N,01131.000,E,022.4,084.4,230394,003.1,W*6A",
        "$GPGGA,123519,4807.038,N,01131.000,E,1,08,0.9,545.4,M,46.9,M,,*47",
        "$GPVTG,054.7,T,034.4,M,005.5,N,010.2,K*48",
        "$GPGLL,4916.45,N,12311.12,W,225444,A,*1D",
        "$HCHDG,101.1,,,7.1,W*3C",
        "$GPZDA,201530.00,04,07,2002,00,00*60",
        "$WIMWD,270.0,T,268.5,M,12.4,N,6.4,M*63",
    ] {
        assert!(is_sentence(line), "{line}");
        assert!(matches!(frame(line.as_bytes()), Line::Sentence(frame) if frame.summed), "{line}");
        assert!(nmea_kit::parse_frame(line).is_ok(), "{line}");
    }
}

#[test]
fn what_is_not_valid_is_not_read() {
    for body in [
        "HEHDT,,T",
        "HEHDT,361.0,T",
        "HEHDT,-0.1,T",
        "HEHDT,1e2,T",
        "HETHS,10.0,V",
        "HETHS,10.0,S",
        "GPROT,35.6,V",
        "IIRSA,10.0,V,,V",
        "IIRSA,91.0,A,,V",
        "GPRMC,123519,V,4807.038,N,01131.000,E,022.4,084.4,230394,003.1,W",
        "GPGGA,123519,4807.038,N,01131.000,E,0,08,0.9,545.4,M,46.9,M,,",
        "GPGGA,123519,4867.038,N,01131.000,E,1,08,0.9,545.4,M,46.9,M,,",
        "GPGGA,123519,4807.038,N,,,1,08,0.9,545.4,M,46.9,M,,",
        "GPGLL,4916.45,N,12311.12,W,225444,V,",
        "GPVTG,054.7,T,034.4,M,005.5,N,010.2,K,N",
        "VDVBW,12.0,-0.5,V,11.8,0.1,V",
        "ERRPM,S,1,120.0,80.0,V",
        "IIMWV,214.8,R,0.1,K,V",
        "HCHDG,,,,7.1,W",
    ] {
        assert!(matches!(read_log(&stamped(&[body, body])), Err(Problem::NoReadings { .. })), "{body}");
    }
    let mended = source(&stamped(&["HEHDT,10.0,T", "HEHDT,999.9,T", "HEHDT,,T", "HEHDT,11.0,T"]));
    let heading = series(&mended, Channel::Heading);
    assert_eq!(heading.time.len(), 4);
    assert_eq!(heading.values.iter().filter(|value| value.is_nan()).count(), 2);
    assert!(told(&mended, "1 entry of $HEHDT cannot be a heading"), "{:?}", mended.warnings);
}

#[test]
fn a_course_is_no_heading() {
    let source = source(&stamped(&["GPVTG,054.7,T,034.4,M,005.5,N,010.2,K", &rmc("140300")[1..rmc("").len() + 3]]));
    assert!(!has(&source, Channel::Heading));
}

#[test]
fn checksums_are_counted_and_wrong_ones_left_out() {
    let mut lines = stamped(&["HEHDT,1.0,T", "HEHDT,2.0,T", "HEHDT,3.0,T", "HEHDT,4.0,T"]);
    lines[1] = lines[1].replace(",2.0,", ",7.0,");
    // The end of this one is lost.
    lines[2] = lines[2][..lines[2].len() - 7].to_owned();
    lines.push(String::from("# a remark with $HEHDT,9.0,T"));
    lines.push(String::from("!AIVDM,1,1,,A,13aG?P0P00PD;88MD5MTDww@2<0L,0*23"));
    lines.push(summed("PASHR,1,2,3"));
    lines.push(String::from("recording goes on"));
    let source = source(&lines);
    assert_eq!(degrees(series(&source, Channel::Heading)), [1.0, 4.0]);
    assert!(told(&source, "1 of 8 lines had a wrong checksum and is left out"), "{:?}", source.warnings);
    assert!(told(&source, "1 of 8 lines is cut short"), "{:?}", source.warnings);
    assert!(told(&source, "1 of 8 lines hold no sentence"), "{:?}", source.warnings);
    let bare: Vec<String> = (0..5).map(|k| format!("14:00:0{k} $HEHDT,{k}.5,T")).collect();
    let bare = self::source(&bare);
    assert_eq!(degrees(series(&bare, Channel::Heading)), [0.5, 1.5, 2.5, 3.5, 4.5]);
    assert!(told(&bare, "5 sentences have no checksum"), "{:?}", bare.warnings);
}

#[test]
fn one_channel_is_one_instrument_and_the_choice_is_said() {
    let mut lines = Vec::new();
    for k in 0..60 {
        let stamp = format!("14:03:{k:02}.000");
        lines.push(format!("{stamp},{}", summed("HCHDM,50.0,M")));
        lines.push(format!("{stamp},{}", summed("GPHDT,51.0,T")));
        lines.push(format!("{stamp},{}", summed("HEHDT,52.0,T")));
        if k % 2 == 0 {
            lines.push(format!("{stamp},{}", summed("HCHDG,49.0,,,,")));
        }
        lines.push(format!("{stamp},{}", summed("GPVTG,054.7,T,034.4,M,005.5,N,010.2,K")));
        lines.push(format!("{stamp},{}", summed("VWVHW,,T,,M,5.0,N,,K")));
    }
    let source = source(&lines);
    assert!(degrees(series(&source, Channel::Heading)).iter().all(|&heading| heading == 51.0));
    let expected = "heading from $GPHDT (60 readings); $HEHDT (60), $HCHDM (60) and $HCHDG (30) are not used";
    assert!(source.warnings.iter().any(|told| told == expected), "{:?}", source.warnings);
    let speed = "speed through the water from $VWVHW (60 readings); $GPVTG (60) is not used";
    assert!(source.warnings.iter().any(|told| told == speed), "{:?}", source.warnings);
    // The same sentence of two ports.
    let ports: Vec<String> = (0..20)
        .flat_map(|k| {
            let stamp = format!("2026-11-20T14:03:{k:02}Z");
            [
                format!("{stamp} GYRO1 {}", summed("HEHDT,1.0,T")),
                format!("{stamp} GYRO2 {}", summed("HEHDT,2.0,T")),
                format!("{stamp} GYRO2 {}", summed("HEHDT,2.0,T")),
            ]
        })
        .collect();
    let ports = self::source(&ports);
    assert!(degrees(series(&ports, Channel::Heading)).iter().all(|&heading| heading == 2.0));
    assert!(told(&ports, "heading from $HEHDT of GYRO2 (40 readings); $HEHDT of GYRO1 (20) is not used"));
}

#[test]
fn a_magnetic_heading_is_said_and_a_variation_makes_it_true() {
    let magnetic = source(&stamped(&["HCHDG,101.1,,,,", "HCHDG,102.1,,,,"]));
    assert!(told(&magnetic, "the heading of $HCHDG is magnetic"), "{:?}", magnetic.warnings);
    let held = source(&stamped(&["HCHDG,101.1,,,,", "HCHDG,102.1,,,2.0,E", "HCHDG,359.0,,,,"]));
    assert_eq!(degrees(series(&held, Channel::Heading)), [103.1, 104.1, 1.0]);
    assert!(!told(&held, "magnetic"));
}

#[test]
fn every_notation_of_a_stamp_gives_the_same_series() {
    let bodies = ["HEHDT,359.5,T", "HEHDT,0.5,T", "HEHDT,2.5,T"];
    let fractions = ["05.000", "05.250", "07.500"];
    let epoch = |digits: &str| 1_795_183_380.0 + digits.parse::<f64>().expect("a number");
    let tag = |content: String| format!("\\{content}*{:02x}\\", sum(content.as_bytes()));
    type Write<'a> = &'a dyn Fn(&str, &str) -> String;
    let styles: &[Write] = &[
        &|f, s| format!("2026-11-20T14:03:{f}Z {s}"),
        &|f, s| format!("2026-11-20 14:03:{f} {s}"),
        &|f, s| format!("20.11.2026 14:03:{f};{s}"),
        &|f, s| format!("20.11.2026 14:03:{},{s}", f.replace('.', ",")),
        &|f, s| format!("14:03:{f},{s}"),
        &|f, s| format!("[14:03:{f}] {s}"),
        &|f, s| format!("<14:03:{f}>{s}"),
        &|f, s| format!("{:.3} {s}", epoch(f)),
        &|f, s| format!("{:.0},{s}", 1000.0 * epoch(f)),
        &|f, s| format!("\"2026-11-20 14:03:{f}\",\"{s}\""),
        &|f, s| format!("\"2026-11-20\";\"14:03:{f}\";\"{s}\""),
        &|f, s| format!("{}{s}", tag(format!("c:{:.0}", 1000.0 * epoch(f)))),
        &|f, s| format!("{}{s}", tag(format!("s:GYRO,c:{:.3}", epoch(f)))),
        &|f, s| format!("2026-11-20T14:03:{f}Z GYRO1 {s}"),
        &|f, s| format!("COM3: 2026-11-20 14:03:{f} UTC {s}"),
        &|f, s| format!("17 2026-11-20T15:03:{f}+01:00\t{s}"),
    ];
    for style in styles {
        let lines: Vec<String> =
            bodies.iter().zip(fractions).map(|(body, fraction)| style(fraction, &summed(body))).collect();
        assert!(is_sentence(&lines[0]), "{}", lines[0]);
        let source = source(&lines);
        let heading = series(&source, Channel::Heading);
        assert_eq!(heading.time, [0.0, 0.25, 2.5], "{}", lines[0]);
        assert_eq!(degrees(heading), [359.5, 0.5, 2.5], "{}", lines[0]);
        let clock = source.clock.expect("there are stamps");
        assert_eq!(&clock.at(0.0)[3..], "03:05", "{}", lines[0]);
        let day = clock.day;
        assert!(day.is_none_or(|day| day == 20_777), "{}: {day:?}", lines[0]);
    }
}

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
    assert!(told(&source, "spread evenly"));
}

/// Heading in tenths of a degree shows the true time: ten sentences a second, and one clock sentence.
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
    let expected = "the time is that of $GPRMC (6 times), and sentences between two of them are spread evenly over the time \
                    between";
    assert!(told(&source, expected), "{:?}", source.warnings);
    assert!(told(&source, "1 sentence before the first time is left out"));
    let clock = source.clock.expect("RMC has one");
    assert_eq!((clock.date_at(0.0), clock.at(0.0)), (Some("2026-11-20".into()), "14:03:05".into()));
}

#[test]
fn missing_seconds_stay_a_gap() {
    for (seconds, heard) in [
        // The recorder stopped.
        (vec![0, 1, 2, 3, 20, 21, 22], None),
        // The GPS was silent and the gyro was not.
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
    let of_day = |k: usize| if k < 2 { "201126" } else { "211126" };
    let clocks: [&dyn Fn(usize) -> String; 4] = [
        &|k| summed(&format!("GPRMC,{},A,5400.0,N,01000.0,E,10.0,90.0,{},,", times[k], of_day(k))),
        &|k| summed(&format!("GPGGA,{},5400.0,N,01000.0,E,1,08,0.9,545.4,M,46.9,M,,", times[k])),
        &|k| summed(&format!("GPGLL,5400.0,N,01000.0,E,{},A,A", times[k])),
        &|k| summed(&format!("GPZDA,{}.00,{},11,2026,00,00", times[k], &of_day(k)[..2])),
    ];
    for clock in clocks {
        let lines: Vec<String> = (0..4).flat_map(|k| [clock(k), summed("HEHDT,10.0,T")]).collect();
        let source = source(&lines);
        assert_eq!(series(&source, Channel::Heading).time, expected, "{}", lines[0]);
        assert_eq!(source.clock.expect("it has one").at(0.0), "23:59:58");
    }
    // The date of another sentence dates the clock.
    let mut lines: Vec<String> = (0..4).flat_map(|k| [clocks[1](k), summed("HEHDT,10.0,T")]).collect();
    lines.insert(6, summed("GPZDA,000000.00,21,11,2026,00,00"));
    assert_eq!(source(&lines).clock.expect("it has one").date_at(0.0), Some("2026-11-20".into()));
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
        assert!(told(&source, "1 time of $GPRMC far from its neighbours left out"), "{stray}: {:?}", source.warnings);
    }
    let again = ten_to_one(&[10, 11, 12, 13, 1, 2, 3], |_, _| true);
    let problem = read_log(&again).expect_err("time starts anew");
    assert_eq!(
        problem.to_string(),
        "line 46: the clock of the log goes back from 14:03:13 to 14:03:01, expected one recording; cut the log there and \
         give the parts one by one"
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
        assert!(told(&source, "1 sentence with a stamp far from its neighbours is left out"), "{:?}", source.warnings);
    }
    let problem = read_log(&write(&[10, 11, 12, 13, 1, 2, 3])).expect_err("time starts anew");
    assert!(problem.to_string().starts_with("line 5: the clock of the log goes back from 14:03:13 to 14:03:01"));
}

#[test]
fn damaged_lines_are_counted_and_read_past() {
    let mut bytes = Vec::new();
    for k in 0..20 {
        bytes.extend(format!("14:03:{k:02} {}\r\n", summed(&format!("HEHDT,{k}.0,T"))).bytes());
        if k % 5 == 0 {
            bytes.extend(b"\xff\xfe\x80$HEHDT,1\n");
            bytes.extend(b"$HEHDT,\0\0,T\n");
        }
    }
    bytes.extend(vec![b'x'; 3 << 20]);
    bytes.extend(b"\n\n\n");
    let source = read_bytes(&bytes).expect("most lines are sound");
    assert_eq!(series(&source, Channel::Heading).time.len(), 20);
    assert_eq!(source.lines, 31);
    assert!(told(&source, "9 of 31 lines are cut short or not text"), "{:?}", source.warnings);
}

#[test]
fn a_log_that_is_none_is_refused_with_the_numbers() {
    let mut noise = stamped(&["HEHDT,10.0,T"; 3]);
    noise.extend(["$HEHDT,1*", "$HEHDT,11.0,T*00", "$HE", "$HEHDT,*1"].map(String::from));
    assert_eq!(
        read_log(&noise).expect_err("noise").to_string(),
        "4 of 7 lines are damaged (1 with a wrong checksum, 3 cut short or not text), expected at most half; check the \
         speed and the wiring of the serial line, or export the log again"
    );
    let timeless: Vec<String> = (0..9).map(|k| summed(&format!("HEHDT,{k}.0,T"))).collect();
    assert_eq!(
        read_log(&timeless).expect_err("no time").to_string(),
        "the log has no time: found no time stamp before its 9 sentences and 0 valid times in ZDA, RMC, GGA or GLL, \
         expected the one or at least two of the other; record it with time stamps, or with the sentences of a GPS \
         (`time-step-s` is not possible for sentences)"
    );
    let one = [rmc("140300"), timeless[0].clone()];
    assert!(matches!(read_log(&one), Err(Problem::NoClock { sentences: 2, clocks: 1 })));
    assert!(matches!(read_log(&stamped(&["GPGSV,1,1,00"])), Err(Problem::NoReadings { sentences: 1 })));
    let dates: Vec<String> =
        ["03/04/2026 12:00:00", "07/04/2026 12:00:00"].map(|t| format!("{t} {}", timeless[0])).to_vec();
    let problem = read_log(&dates).expect_err("either may be the month");
    assert!(problem.to_string().starts_with("line 2: the date of the stamp `07/04/2026 12:00:00`"), "{problem}");
}

#[test]
fn two_rudders_are_one_where_they_go_together() {
    let rudder = |bodies: &[&str]| {
        let source = source(&stamped(bodies));
        (degrees(series(&source, Channel::Rudder)), source.warnings)
    };
    let (mean, told) = rudder(&["IIRSA,10.0,A,11.0,A", "IIRSA,12.0,A,12.0,A"]);
    assert_eq!(mean, [10.5, 12.0]);
    assert!(told[0].contains("mean of two rudders, 0.7° apart"), "{told:?}");
    let (one, told) = rudder(&["IIRSA,10.0,A,-11.0,A", "IIRSA,12.0,A,-12.0,A"]);
    assert_eq!(one, [10.0, 12.0]);
    assert!(told[0].contains("differ by 22.5° (rms)") && told[0].contains("starboard"), "{told:?}");
    let (port, told) = rudder(&["IIRSA,,V,-11.0,A", "IIRSA,,V,-12.0,A"]);
    assert_eq!(port, [-11.0, -12.0]);
    assert!(told[0].contains("port rudder; the other one has 0 readings"), "{told:?}");
    let (single, told) = rudder(&["IIRSA,1.0,A,,V", "IIRSA,2.0,A,,V"]);
    assert_eq!((single, told.len()), (vec![1.0, 2.0], 0));
}

#[test]
fn shafts_give_their_mean_whatever_way_they_turn() {
    let bodies = ["ERRPM,S,1,120.0,,A", "ERRPM,S,2,-126.0,,A", "ERRPM,E,1,600.0,,A"];
    let lines: Vec<String> =
        (0..10).flat_map(|k| bodies.map(|body| format!("14:03:{k:02}.{} {}", body.len() % 7, summed(body)))).collect();
    let source = source(&lines);
    let rate = series(&source, Channel::PropellerRate);
    assert_eq!(rate.values.len(), 10);
    assert_abs_diff_eq!(rate.values[4], 123.0 / 60.0, epsilon = 1e-12);
    assert!(told(&source, "mean of 2 shafts") && told(&source, "$ERRPM S2 turns counter-clockwise"));
}

#[test]
fn true_wind_from_the_bow_becomes_one_from_north() {
    let with = source(&stamped(&["HEHDT,300.0,T", "IIMWV,90.0,T,10.0,M,A", "HEHDT,300.0,T", "IIMWV,90.0,T,10.0,M,A"]));
    assert_eq!(degrees(series(&with, Channel::WindTrueFrom)), [30.0, 30.0]);
    let without = source(&stamped(&["IIMWV,90.0,T,10.0,M,A"; 2]));
    assert!(has(&without, Channel::WindTrueSpeed) && !has(&without, Channel::WindTrueFrom));
    assert!(told(&without, "without a heading its direction is left out"));
}

/// A degree of latitude has 111 132.954 m - 1.175 m at 45°, by the series of the meridian arc, and a minute of longitude
/// 1855.325 m at the equator (WGS 84).
#[test]
fn positions_are_metres_from_the_first() {
    let gga = |lat: &str, lon: &str| format!("GPGGA,140300,{lat},{lon},1,08,0.9,545.4,M,46.9,M,,");
    let (a, b) = (gga("4459.500,N", "01000.000,E"), gga("4500.500,N", "01000.000,E"));
    let source = source(&stamped(&[&a, &b]));
    assert_abs_diff_eq!(series(&source, Channel::North).values[1], 111_131.779 / 60.0, epsilon = 0.001);
    assert_abs_diff_eq!(series(&source, Channel::East).values[1], 0.0, epsilon = 1e-9);
    let (a, b) = (gga("0000.000,N", "17959.500,E"), gga("0000.000,S", "17959.500,W"));
    let source = self::source(&stamped(&[&a, &b]));
    assert_abs_diff_eq!(series(&source, Channel::East).values[1], 1855.325, epsilon = 0.01);
}

#[test]
fn first_lines_count_and_the_hash_is_that_of_the_file() {
    let text = stamped(&["HEHDT,1.0,T", "HEHDT,2.0,T", "HEHDT,3.0,T"]).join("\n");
    let mut lines = Lines::new(text.as_bytes(), Encoding::Utf8);
    let first = vec![lines.next_line().expect("text").expect("a line").to_owned()];
    let source = read(first, lines).expect("a log");
    assert_eq!((source.lines, series(&source, Channel::Heading).time.len()), (3, 3));
    assert_eq!(source.sha256, read_bytes(text.as_bytes()).expect("a log").sha256);
}

#[test]
fn rows_of_a_table_are_no_sentences() {
    for line in
        ["t_s,heading_deg,rudder_deg", "0.0,12.5,-3", "", "price,$5", "a $heading,b", "# $HEHDT,1.0,T", "$", "!"]
    {
        assert!(!is_sentence(line), "{line}");
    }
    for line in ["$PASHR,1", "!AIVDM,1,1,,A,1,0*23", "x $HEHDT,1.0,T", "\\c:1763647385*5F\\$HEHDT,1.0,T"] {
        assert!(is_sentence(line), "{line}");
    }
}

fn any_sentence() -> impl Strategy<Value = String> {
    let kinds = "(HE|GP|II)(HDT|THS|HDG|HDM|ROT|RSA|HTD|VHW|VBW|VTG|RMC|GGA|GLL|ZDA|RPM|MWV|MWD|XDR|XYZ)";
    let field = prop_oneof![
        4 => "-?[0-9]{0,3}(\\.[0-9]{0,2})?",
        4 => "[ATMNKERLSVWD]",
        2 => "(0[0-9]|1[0-9]|2[0-3])[0-5][0-9][0-5][0-9](\\.[0-9]{1,2})?",
        1 => "[0-3][0-9][01][0-9][0-9]{2}",
        1 => "[0-9]{4}\\.[0-9]{3}",
        1 => "[0-9]{12,25}",
        1 => "\\PC{0,4}",
    ];
    let stamp = "(|14:03:[0-5][0-9] |\\[23:5[0-9]:[0-5][0-9]\\.[0-9]\\] |[0-9]{10}(\\.[0-9])? |A[0-9] |2026-1[0-2]-[0-3][0-9] 0[0-9]:00:00,)";
    (stamp, kinds, prop::collection::vec(field, 0..12), 0..10).prop_map(|(stamp, kind, fields, wrong)| {
        let body = format!("{kind},{}", fields.join(","));
        let line = if wrong == 0 { format!("${body}") } else { summed(&body) };
        format!("{stamp}{line}")
    })
}

/// What must hold of whatever is read.
fn check(bytes: &[u8]) {
    let Ok(source) = read_bytes(bytes) else { return };
    assert!(!source.series.is_empty());
    let first = source.series.iter().map(|series| series.time[0]).fold(f64::INFINITY, f64::min);
    assert_eq!(first, 0.0);
    for series in &source.series {
        assert_eq!(series.time.len(), series.values.len());
        assert!(series.time.windows(2).all(|pair| pair[0] < pair[1]), "{series:?}");
        assert!(series.time.iter().all(|time| time.is_finite()));
        assert!(series.values.iter().all(|value| !value.is_infinite()));
        if series.channel == Channel::Heading {
            assert!(series.values.iter().all(|value| value.is_nan() || (0.0..2.0 * PI).contains(value)));
        }
    }
    for (place, series) in source.series.iter().enumerate() {
        assert!(source.series[..place].iter().all(|other| other.channel != series.channel));
    }
}

proptest! {
    #[test]
    fn no_bytes_do_harm(bytes in prop::collection::vec(any::<u8>(), 0..400)) {
        check(&bytes);
    }

    #[test]
    fn no_text_does_harm(text in "([0-9:.,;$!*\\\\ \n\"ACDEHTZ-]|\\$HEHDT,){0,200}") {
        is_sentence(&text);
        check(text.as_bytes());
    }

    #[test]
    fn no_mixture_of_sentences_does_harm(
        mut lines in prop::collection::vec(any_sentence(), 0..60),
        cuts in prop::collection::vec((any::<prop::sample::Index>(), any::<prop::sample::Index>()), 0..3),
        doubled in prop::collection::vec(any::<prop::sample::Index>(), 0..3),
    ) {
        for (line, at) in cuts {
            if !lines.is_empty() {
                let line = line.get_mut(&mut lines[..]);
                let place = (0..=line.len()).rev().find(|&place| place <= at.index(line.len() + 1) && line.is_char_boundary(place));
                line.truncate(place.unwrap_or(0));
            }
        }
        for line in doubled {
            if !lines.is_empty() {
                let twice = line.get(&lines).repeat(2);
                lines.push(twice);
            }
        }
        check(lines.join("\n").as_bytes());
    }

    #[test]
    fn numbers_are_those_of_the_standard_library(text in "[-+]?[0-9]{0,18}\\.?[0-9]{0,8}") {
        let expected = text.parse::<f64>().ok().map_or(if text.is_empty() { Number::Empty } else { Number::Not }, Number::Of);
        prop_assert_eq!(number(text.as_bytes()), expected);
    }

    /// Another reader of frames finds the same sentences, checksums and fields.
    #[test]
    fn frames_are_those_of_nmea_kit(body in "[A-Z]{5},[0-9A-Z.,-]{0,60}", wrong in any::<bool>()) {
        let line = format!("${body}*{:02X}", sum(body.as_bytes()) ^ u8::from(wrong));
        match (frame(line.as_bytes()), nmea_kit::parse_frame(&line)) {
            (Line::Sentence(own), Ok(other)) => {
                prop_assert_eq!(&own.address[2..], other.sentence_type.as_bytes());
                prop_assert_eq!(&own.address[..2], other.talker.as_bytes());
                let fields = super::frame::Fields::new(own.body);
                for (place, field) in other.fields.iter().take(16).enumerate() {
                    prop_assert_eq!(fields.at(place + 1), field.as_bytes());
                }
            }
            (Line::Foreign, Ok(other)) => prop_assert!(other.sentence_type.starts_with('P')),
            (Line::WrongSum, Err(nmea_kit::FrameError::BadChecksum { .. })) => prop_assert!(wrong),
            (own, other) => prop_assert!(false, "{:?} {:?}", own, other),
        }
    }
}

/// How fast logs are read; `--release -- --ignored --nocapture` shows it.
#[test]
#[ignore = "a measurement"]
fn speed() {
    use std::time::Instant;
    let mut logs = [String::new(), String::new()];
    for k in 0..300_000_u32 {
        let angle = f64::from(k % 3600) / 10.0;
        let rudder = f64::from(k % 70) - 35.0;
        let mut bodies = vec![
            format!("HEHDT,{angle:.2},T"),
            format!("IIRSA,{rudder:.1},A,,V"),
            format!("TIROT,{rudder:.2},A"),
            format!("IIMWV,{angle:.1},R,12.3,N,A"),
        ];
        let second = k / 10;
        let time = format!("{:02}{:02}{:02}.00", second / 3600 % 24, second / 60 % 60, second % 60);
        if k % 10 == 0 {
            let day = 20 + second / 86_400;
            bodies.insert(0, format!("GPRMC,{time},A,5400.1234,N,01000.5678,E,10.0,90.0,{day}1126,1.5,E,A"));
            bodies.push(format!("GPGGA,{time},5400.1234,N,01000.5678,E,1,08,0.9,12.4,M,46.9,M,,"));
            bodies.push(format!("VWVHW,{angle:.1},T,,M,12.5,N,23.2,K"));
            bodies.push("GPGSV,3,1,11,03,03,111,00,04,15,270,00,06,01,010,00,13,06,292,00".to_owned());
        }
        for body in bodies {
            let line = summed(&body);
            logs[0].push_str(&format!("{line}\r\n"));
            let (hour, minute) = (second / 3600 % 24, second / 60 % 60);
            let stamp = format!("2026-11-{:02}T{hour:02}:{minute:02}", 20 + second / 86_400);
            logs[1].push_str(&format!("{stamp}:{:02}.{}00Z {line}\r\n", second % 60, k % 10));
        }
    }
    for (name, log) in ["GPS clock", "stamps"].iter().zip(&logs) {
        let (megabytes, lines) = (log.len() as f64 / 1e6, log.lines().count() as f64);
        let show = |what: &str, run: &dyn Fn()| {
            let best = (0..5).map(|_| {
                let begin = Instant::now();
                run();
                begin.elapsed().as_secs_f64()
            });
            let seconds = best.fold(f64::INFINITY, f64::min);
            let (rate, sentences) = (megabytes / seconds, 1e-6 * lines / seconds);
            println!("{name}, {what}: {rate:.0} MB/s, {sentences:.2} million lines a second");
        };
        show("all", &|| {
            std::hint::black_box(read_bytes(log.as_bytes()).expect("a log"));
        });
        if std::env::var_os("ONLY_ALL").is_some() {
            continue;
        }
        show("lines and SHA-256 alone", &|| {
            let mut lines = Lines::new(log.as_bytes(), Encoding::Utf8);
            while lines.next_bytes().expect("lines").is_some() {}
            std::hint::black_box(lines.sha256());
        });
        show("SHA-256 alone", &|| {
            use sha2::{Digest, Sha256};
            std::hint::black_box(Sha256::digest(log.as_bytes()));
        });
        show("framing alone", &|| {
            for line in log.as_bytes().split(|&byte| byte == b'\n') {
                std::hint::black_box(frame(line.trim_ascii_end()));
            }
        });
        show("framing and fields alone", &|| {
            for line in log.as_bytes().split(|&byte| byte == b'\n') {
                if let Line::Sentence(frame) = frame(line.trim_ascii_end()) {
                    std::hint::black_box(super::frame::Fields::new(frame.body).at(1));
                }
            }
        });
        show("framing of nmea-kit alone", &|| {
            for line in log.lines() {
                let line = &line[line.find('$').unwrap_or(0)..];
                std::hint::black_box(nmea_kit::parse_frame(line).is_ok());
            }
        });
    }
}
