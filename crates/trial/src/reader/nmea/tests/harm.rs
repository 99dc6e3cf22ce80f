//! Whatever sentences a log holds, it is read or refused; and another reader agrees on frames. Any bytes are a matter
//! of the fuzz targets.

use proptest::prelude::*;

use super::super::frame::{Fields, MOST_FIELDS};
use super::*;

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
    let stamp = "(|14:03:[0-5][0-9] |\\[23:5[0-9]:[0-5][0-9]\\.[0-9]\\] |[0-9]{10}(\\.[0-9])? |A[0-9] \
                 |2026-1[0-2]-[0-3][0-9] 0[0-9]:00:00,)";
    (stamp, kinds, prop::collection::vec(field, 0..12), 0..10).prop_map(|(stamp, kind, fields, wrong)| {
        let body = format!("{kind},{}", fields.join(","));
        let line = if wrong == 0 { format!("${body}") } else { summed(&body) };
        format!("{stamp}{line}")
    })
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

proptest! {
    #[test]
    fn no_mixture_of_sentences_does_harm(
        mut lines in prop::collection::vec(any_sentence(), 0..60),
        cuts in prop::collection::vec((any::<prop::sample::Index>(), any::<prop::sample::Index>()), 0..3),
        doubled in prop::collection::vec(any::<prop::sample::Index>(), 0..3),
    ) {
        for (line, at) in cuts {
            if !lines.is_empty() {
                let line = line.get_mut(&mut lines[..]);
                let end = at.index(line.len() + 1);
                line.truncate((0..=end).rev().find(|&end| line.is_char_boundary(end)).unwrap_or(0));
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

    /// Another reader of frames finds the same sentences, checksums and fields.
    #[test]
    fn frames_are_those_of_nmea_kit(body in "[A-Z]{5},[0-9A-Z.,-]{0,60}", wrong in any::<bool>()) {
        let line = format!("${body}*{:02X}", sum(body.as_bytes()) ^ u8::from(wrong));
        match (frame(line.as_bytes()), nmea_kit::parse_frame(&line)) {
            (Line::Sentence(own), Ok(other)) => {
                prop_assert_eq!(&own.address[2..], other.sentence_type.as_bytes());
                prop_assert_eq!(&own.address[..2], other.talker.as_bytes());
                let fields = Fields::new(own.body);
                for (place, field) in other.fields.iter().take(MOST_FIELDS).enumerate() {
                    prop_assert_eq!(fields.at(place + 1), field.as_bytes());
                }
            }
            (Line::Foreign, Ok(other)) => prop_assert!(other.sentence_type.starts_with('P')),
            (Line::WrongSum, Err(nmea_kit::FrameError::BadChecksum { .. })) => prop_assert!(wrong),
            (own, other) => prop_assert!(false, "{:?} {:?}", own, other),
        }
    }
}
