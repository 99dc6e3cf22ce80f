mod harm;
mod time;

use std::f64::consts::PI;

use approx::assert_abs_diff_eq;

use super::frame::sum;
use super::*;
use crate::channel::Channel;
use crate::encoding::Encoding;

/// A sentence with its checksum.
fn summed(body: &str) -> String {
    format!("${body}*{:02X}", sum(body.as_bytes()))
}

/// Content of a log of sentences.
type Sentences = (Vec<Series>, InstrumentLog);

fn read_from(bytes: &[u8]) -> Result<Sentences, ReadProblem> {
    read(Lines::new(bytes, Encoding::Utf8))
}

fn read_log(lines: &[String]) -> Result<Sentences, ReadProblem> {
    read_from(lines.join("\r\n").as_bytes())
}

fn source(lines: &[String]) -> Sentences {
    read_log(lines).expect("a log that can be read")
}

fn series(source: &Sentences, channel: Channel) -> &Series {
    source.0.iter().find(|series| series.channel == channel).expect("the channel is there")
}

fn has(source: &Sentences, channel: Channel) -> bool {
    source.0.iter().any(|series| series.channel == channel)
}

fn degrees(series: &Series) -> Vec<f64> {
    series.values.iter().map(|value| (value.to_degrees() * 1e9).round() / 1e9).collect()
}

fn has_warning(source: &Sentences, text: &str) -> bool {
    source.1.warnings.iter().any(|warning| warning.text.contains(text))
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

/// Sentences as printed in manuals of instruments, with their checksums.
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
        assert!(matches!(frame(line.as_bytes()), Line::Sentence(frame) if frame.has_checksum), "{line}");
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
        assert!(matches!(read_log(&stamped(&[body, body])), Err(ReadProblem::NoReadings { .. })), "{body}");
    }
    let mended = source(&stamped(&["HEHDT,10.0,T", "HEHDT,999.9,T", "HEHDT,,T", "HEHDT,11.0,T"]));
    let heading = series(&mended, Channel::Heading);
    assert_eq!(heading.time.len(), 4);
    assert_eq!(heading.values.iter().filter(|value| value.is_nan()).count(), 2);
    assert!(has_warning(&mended, "1 entry of $HEHDT cannot be a heading"), "{:?}", mended.1.warnings);
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
    // The end of this sentence is lost.
    lines[2] = lines[2][..lines[2].len() - 7].to_owned();
    lines.push(String::from("# a remark with $HEHDT,9.0,T"));
    lines.push(String::from("!AIVDM,1,1,,A,13aG?P0P00PD;88MD5MTDww@2<0L,0*23"));
    lines.push(summed("PASHR,1,2,3"));
    lines.push(String::from("recording goes on"));
    let source = source(&lines);
    assert_eq!(degrees(series(&source, Channel::Heading)), [1.0, 4.0]);
    assert!(has_warning(&source, "1 of 8 lines had a wrong checksum and is left out"), "{:?}", source.1.warnings);
    assert!(has_warning(&source, "1 of 8 lines is cut short"), "{:?}", source.1.warnings);
    assert!(has_warning(&source, "1 of 8 lines holds no sentence"), "{:?}", source.1.warnings);
    let bare: Vec<String> = (0..5).map(|k| format!("14:00:0{k} $HEHDT,{k}.5,T")).collect();
    let bare = self::source(&bare);
    assert_eq!(degrees(series(&bare, Channel::Heading)), [0.5, 1.5, 2.5, 3.5, 4.5]);
    assert!(has_warning(&bare, "5 sentences have no checksum"), "{:?}", bare.1.warnings);
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
    assert!(source.1.warnings.iter().any(|warning| warning.text == expected), "{:?}", source.1.warnings);
    let speed = "speed through the water from $VWVHW (60 readings); $GPVTG (60) is not used";
    assert!(source.1.warnings.iter().any(|warning| warning.text == speed), "{:?}", source.1.warnings);
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
    assert!(has_warning(&ports, "heading from $HEHDT of GYRO2 (40 readings); $HEHDT of GYRO1 (20) is not used"));
}

#[test]
fn a_magnetic_heading_is_said_and_a_variation_makes_it_true() {
    let magnetic = source(&stamped(&["HCHDG,101.1,,,,", "HCHDG,102.1,,,,"]));
    assert!(has_warning(&magnetic, "the heading of $HCHDG is magnetic"), "{:?}", magnetic.1.warnings);
    let held = source(&stamped(&["HCHDG,101.1,,,,", "HCHDG,102.1,,,2.0,E", "HCHDG,359.0,,,,"]));
    assert_eq!(degrees(series(&held, Channel::Heading)), [103.1, 104.1, 1.0]);
    assert!(!has_warning(&held, "magnetic"));
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
    let source = read_from(&bytes).expect("most lines are sound");
    assert_eq!(series(&source, Channel::Heading).time.len(), 20);
    assert_eq!(source.1.rows, 31);
    assert!(has_warning(&source, "9 of 31 lines are cut short or not text"), "{:?}", source.1.warnings);
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
        "the log has no time: there is no time stamp before its 9 sentences, and 0 valid times in ZDA, RMC, GGA or GLL \
         (at least two are needed); record it with time stamps, or with the sentences of a GPS (`time-step-s` is not \
         possible for sentences)"
    );
    let one = [rmc("140300"), timeless[0].clone()];
    assert!(matches!(read_log(&one), Err(ReadProblem::NoClock { sentences: 2, clocks: 1 })));
    assert!(matches!(read_log(&stamped(&["GPGSV,1,1,00"])), Err(ReadProblem::NoReadings { sentences: 1 })));
    let dates: Vec<String> =
        ["03/04/2026 12:00:00", "07/04/2026 12:00:00"].map(|t| format!("{t} {}", timeless[0])).to_vec();
    let problem = read_log(&dates).expect_err("either may be the month");
    assert!(problem.to_string().starts_with("line 2: `07/04/2026 12:00:00` can be read"), "{problem}");
}

#[test]
fn two_rudders_are_one_where_they_go_together() {
    let rudder = |bodies: &[&str]| {
        let source = source(&stamped(bodies));
        (degrees(series(&source, Channel::Rudder)), source.1.warnings)
    };
    let (mean, warnings) = rudder(&["IIRSA,10.0,A,11.0,A", "IIRSA,12.0,A,12.0,A"]);
    assert_eq!(mean, [10.5, 12.0]);
    assert!(warnings[0].text.contains("mean of two rudders, 0.7° apart"), "{warnings:?}");
    let (first, warnings) = rudder(&["IIRSA,10.0,A,-11.0,A", "IIRSA,12.0,A,-12.0,A"]);
    assert_eq!(first, [10.0, 12.0]);
    assert!(
        warnings[0].text.contains("differ by 22.5° (rms)") && warnings[0].text.contains("starboard"),
        "{warnings:?}"
    );
    let (port, warnings) = rudder(&["IIRSA,,V,-11.0,A", "IIRSA,,V,-12.0,A"]);
    assert_eq!(port, [-11.0, -12.0]);
    assert!(warnings[0].text.contains("port rudder; the other rudder has 0 readings"), "{warnings:?}");
    let (single, warnings) = rudder(&["IIRSA,1.0,A,,V", "IIRSA,2.0,A,,V"]);
    assert_eq!((single, warnings.len()), (vec![1.0, 2.0], 0));
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
    assert!(has_warning(&source, "mean of 2 shafts") && has_warning(&source, "$ERRPM S2 turns counter-clockwise"));
}

#[test]
fn true_wind_from_the_bow_becomes_one_from_north() {
    let with = source(&stamped(&["HEHDT,300.0,T", "IIMWV,90.0,T,10.0,M,A", "HEHDT,300.0,T", "IIMWV,90.0,T,10.0,M,A"]));
    assert_eq!(degrees(series(&with, Channel::WindTrueFrom)), [30.0, 30.0]);
    let without = source(&stamped(&["IIMWV,90.0,T,10.0,M,A"; 2]));
    assert!(has(&without, Channel::WindTrueSpeed) && !has(&without, Channel::WindTrueFrom));
    assert!(has_warning(&without, "without a heading its direction is left out"));
}

/// A degree of latitude has 111 132.954 m - 1.175 m at 45° by the series of the meridian arc, and a minute of
/// longitude 1855.325 m at the equator (WGS 84).
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
fn lines_are_counted_and_the_hash_is_that_of_the_file() {
    let text = stamped(&["HEHDT,1.0,T", "HEHDT,2.0,T", "HEHDT,3.0,T"]).join("\n");
    let source = read_from(text.as_bytes()).expect("a log");
    assert_eq!((source.1.rows, series(&source, Channel::Heading).time.len()), (3, 3));
    assert_eq!(source.1.sha256, crate::reader::lines::sha256(text.as_bytes()));
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
