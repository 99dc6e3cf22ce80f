//! Comparison of frames with another reader. Arbitrary sentences and bytes are covered by the fuzz targets.

use rand::rngs::ChaCha8Rng;
use rand::{RngExt, SeedableRng};

use super::super::frame::{Fields, MAX_FIELDS};
use super::*;

/// Number of random frames.
const CASES: u64 = 256;

/// A random text of the given letters.
fn letters(chance: &mut ChaCha8Rng, length: std::ops::RangeInclusive<usize>, letters: &str) -> String {
    let letters: Vec<char> = letters.chars().collect();
    (0..chance.random_range(length)).map(|_| letters[chance.random_range(0..letters.len())]).collect()
}

const DIGITS: &str = "0123456789";

/// Another reader of frames gives the same sentences, checksums and fields.
#[test]
fn frames_are_those_of_nmea_kit() {
    let capitals = "ABCDEFGHIJKLMNOPQRSTUVWXYZ";
    for seed in 0..CASES {
        let chance = &mut ChaCha8Rng::seed_from_u64(seed);
        let fields = letters(chance, 0..=60, &format!("{DIGITS}{capitals}.,-"));
        let (body, wrong) = (format!("{},{fields}", letters(chance, 5..=5, capitals)), chance.random::<bool>());
        let line = format!("${body}*{:02X}", sum(body.as_bytes()) ^ u8::from(wrong));
        match (frame(line.as_bytes()), nmea_kit::parse_frame(&line)) {
            (Line::Sentence(sentence), Ok(other)) => {
                assert_eq!(&sentence.address[2..], other.sentence_type.as_bytes());
                assert_eq!(&sentence.address[..2], other.talker.as_bytes());
                let fields = Fields::new(sentence.body);
                for (index, field) in other.fields.iter().take(MAX_FIELDS).enumerate() {
                    assert_eq!(fields.field(index + 1), field.as_bytes());
                }
            }
            (Line::Foreign, Ok(other)) => assert!(other.sentence_type.starts_with('P')),
            (Line::WrongSum, Err(nmea_kit::FrameError::BadChecksum { .. })) => assert!(wrong),
            (line_kind, other) => panic!("{line}: {line_kind:?} {other:?}"),
        }
    }
}
