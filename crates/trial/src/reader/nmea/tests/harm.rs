//! Whatever sentences a log holds, it is read or refused; and another reader agrees on frames. Any bytes are a matter
//! of the fuzz targets.

use rand::rngs::ChaCha8Rng;
use rand::{RngExt, SeedableRng};

use super::super::frame::{Fields, MOST_FIELDS};
use super::*;

/// Logs and frames that are tried.
const CASES: u64 = 256;

fn one_of<'a>(chance: &mut ChaCha8Rng, list: &[&'a str]) -> &'a str {
    list[chance.random_range(0..list.len())]
}

/// A text of some length in which every letter is one of those.
fn letters(chance: &mut ChaCha8Rng, length: std::ops::RangeInclusive<usize>, letters: &str) -> String {
    let letters: Vec<char> = letters.chars().collect();
    (0..chance.random_range(length)).map(|_| letters[chance.random_range(0..letters.len())]).collect()
}

const DIGITS: &str = "0123456789";

fn any_field(chance: &mut ChaCha8Rng) -> String {
    let mut number = |most: u32| chance.random_range(0..most);
    match number(14) {
        0..4 => {
            let sign = if number(2) == 0 { "" } else { "-" };
            format!("{sign}{}.{}", letters(chance, 0..=3, DIGITS), letters(chance, 0..=2, DIGITS))
        }
        4..8 => letters(chance, 1..=1, "ATMNKERLSVWD"),
        8..10 => format!("{:02}{:02}{:02}.{}", number(24), number(60), number(60), number(100)),
        10 => format!("{:02}{:02}{:02}", number(40), number(20), number(100)),
        11 => format!("{:04}.{:03}", number(10_000), number(1000)),
        12 => letters(chance, 12..=25, DIGITS),
        _ => letters(chance, 0..=4, "aZ é船\"'*$,;:!\\\u{feff}"),
    }
}

fn any_sentence(chance: &mut ChaCha8Rng) -> String {
    let second = chance.random_range(0..60);
    let stamps = [
        String::new(),
        format!("14:03:{second:02} "),
        format!("[23:5{}:{second:02}.{}] ", second % 10, second / 10),
        format!("{:010} ", 1_700_000_000 + 1000 * u64::from(chance.random::<u32>())),
        format!("A{} ", second % 10),
        format!("2026-1{}-{:02} 0{}:00:00,", second % 3, second % 40, second % 10),
    ];
    let stamp = &stamps[chance.random_range(0..stamps.len())];
    let kinds = "HDT THS HDG HDM ROT RSA HTD VHW VBW VTG RMC GGA GLL ZDA RPM MWV MWD XDR XYZ";
    let kinds: Vec<&str> = kinds.split(' ').collect();
    let (talker, kind) = (one_of(chance, &["HE", "GP", "II"]), one_of(chance, &kinds));
    let fields: Vec<String> = (0..chance.random_range(0..12)).map(|_| any_field(chance)).collect();
    let body = format!("{talker}{kind},{}", fields.join(","));
    let line = if chance.random_range(0..10) == 0 { format!("${body}") } else { summed(&body) };
    format!("{stamp}{line}")
}

/// What must hold of whatever is read.
fn check(bytes: &[u8]) {
    let Ok(source) = read_bytes(bytes) else { return };
    assert!(!source.0.is_empty());
    let first = source.0.iter().map(|series| series.time[0]).fold(f64::INFINITY, f64::min);
    assert_eq!(first, 0.0);
    for series in &source.0 {
        assert_eq!(series.time.len(), series.values.len());
        assert!(series.time.windows(2).all(|pair| pair[0] < pair[1]), "{series:?}");
        assert!(series.time.iter().all(|time| time.is_finite()));
        assert!(series.values.iter().all(|value| !value.is_infinite()));
        if series.channel == Channel::Heading {
            assert!(series.values.iter().all(|value| value.is_nan() || (0.0..2.0 * PI).contains(value)));
        }
    }
    for (place, series) in source.0.iter().enumerate() {
        assert!(source.0[..place].iter().all(|other| other.channel != series.channel));
    }
}

#[test]
fn no_mixture_of_sentences_does_harm() {
    for seed in 0..CASES {
        let chance = &mut ChaCha8Rng::seed_from_u64(seed);
        let mut lines: Vec<String> = (0..chance.random_range(1..60)).map(|_| any_sentence(chance)).collect();
        for _ in 0..chance.random_range(0..3) {
            let place = chance.random_range(0..lines.len());
            let end = chance.random_range(0..=lines[place].len());
            let end = lines[place].floor_char_boundary(end);
            lines[place].truncate(end);
        }
        for _ in 0..chance.random_range(0..3) {
            lines.push(lines[chance.random_range(0..lines.len())].repeat(2));
        }
        check(lines.join("\n").as_bytes());
    }
}

/// Another reader of frames finds the same sentences, checksums and fields.
#[test]
fn frames_are_those_of_nmea_kit() {
    let capitals = "ABCDEFGHIJKLMNOPQRSTUVWXYZ";
    for seed in 0..CASES {
        let chance = &mut ChaCha8Rng::seed_from_u64(seed);
        let fields = letters(chance, 0..=60, &format!("{DIGITS}{capitals}.,-"));
        let (body, wrong) = (format!("{},{fields}", letters(chance, 5..=5, capitals)), chance.random::<bool>());
        let line = format!("${body}*{:02X}", sum(body.as_bytes()) ^ u8::from(wrong));
        match (frame(line.as_bytes()), nmea_kit::parse_frame(&line)) {
            (Line::Sentence(own), Ok(other)) => {
                assert_eq!(&own.address[2..], other.sentence_type.as_bytes());
                assert_eq!(&own.address[..2], other.talker.as_bytes());
                let fields = Fields::new(own.body);
                for (place, field) in other.fields.iter().take(MOST_FIELDS).enumerate() {
                    assert_eq!(fields.at(place + 1), field.as_bytes());
                }
            }
            (Line::Foreign, Ok(other)) => assert!(other.sentence_type.starts_with('P')),
            (Line::WrongSum, Err(nmea_kit::FrameError::BadChecksum { .. })) => assert!(wrong),
            (own, other) => panic!("{line}: {own:?} {other:?}"),
        }
    }
}
