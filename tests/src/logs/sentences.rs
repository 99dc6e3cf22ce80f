//! Logs without faults as sentences of NMEA 0183.

use super::File;
use super::Outcome::Read;
use super::voyage::{TENTHS, every, time_of_day, voyage};

/// Sentence with its checksum.
pub fn sentence(body: &str) -> String {
    let sum = body.bytes().fold(0, |sum, byte| sum ^ byte);
    format!("${body}*{sum:02X}")
}

/// Heading sentence of a gyro.
pub(super) fn hdt(tenth: usize) -> String {
    sentence(&format!("HEHDT,{:.2},T", voyage().heading(tenth)))
}

/// Sentence of a single rudder.
pub(super) fn rsa(tenth: usize) -> String {
    sentence(&format!("IIRSA,{:.1},A,,V", voyage().rudder(tenth)))
}

/// Clock sentence of a receiver, with a constant position.
pub(super) fn rmc(tenth: usize) -> String {
    let clock = time_of_day(tenth, false).replace(':', "");
    sentence(&format!("GPRMC,{clock},A,5400.0,N,01000.0,E,,,201126,,"))
}

/// Log with a clock sentence every `epoch` tenths of a second.
pub(super) fn clocked(epoch: usize, more: impl Fn(usize) -> String) -> String {
    every(epoch).map(|tenth| format!("{}\r\n{}\r\n", rmc(tenth), more(tenth))).collect()
}

/// All logs of sentences without faults.
pub(super) fn all() -> Vec<File> {
    let two = |tenth: usize| {
        let (starboard, port) = (voyage().rudder(tenth) + 0.3, voyage().rudder(tenth) - 0.3);
        sentence(&format!("IIRSA,{starboard:.1},A,{port:.1},A"))
    };
    let stamped: String = every(1)
        .map(|tenth| {
            let stamp = format!("2026-11-20T{}00Z", time_of_day(tenth, true));
            let rudder = if tenth % TENTHS == 0 { format!("{stamp} {}\n", rsa(tenth)) } else { String::new() };
            format!("{stamp} {}\n{rudder}", hdt(tenth))
        })
        .collect();
    vec![
        File::new(
            "receiver.nmea",
            "sentences of gyro and rudder every two seconds, timed by those of a receiver (RMC)",
            clocked(2 * TENTHS, |tenth| format!("{}\r\n{}", hdt(tenth), rsa(tenth))),
            Read(&["the clock is $GPRMC"]),
        ),
        File::new(
            "two-rudders.nmea",
            "the same with two rudders",
            clocked(2 * TENTHS, |tenth| format!("{}\r\n{}", hdt(tenth), two(tenth))),
            Read(&["the clock is $GPRMC", "the mean of two rudders"]),
        ),
        File::new("stamped.nmea", "a stamp before every sentence, ten headings a second", stamped, Read(&[]))
            .not_kept(),
    ]
}
