//! Logs of messages without faults: NMEA 2000 in the format of canboat, and a long table in the format of Signal K.

use super::File;
use super::Outcome::Read;
use super::tables::table;
use super::voyage::{TENTHS, every, time_of_day, voyage};

fn stamp(tenth: usize) -> String {
    format!("2026-11-20T{}00Z", time_of_day(tenth, true))
}

/// JSON line of canboat.
fn json(tenth: usize, [pgn, source]: [usize; 2], fields: &str) -> String {
    format!(r#"{{"timestamp":"{}","prio":2,"src":{source},"dst":255,"pgn":{pgn},"fields":{{{fields}}}}}"#, stamp(tenth))
}

/// All logs of messages without faults.
pub(super) fn all() -> Vec<File> {
    let (heading, rudder) = (|tenth: usize| voyage().heading(tenth), |tenth: usize| voyage().rudder(tenth));
    let lines = every(TENTHS).map(|tenth| {
        let gyro = json(tenth, [127_250, 3], &format!(r#""Heading":{:.1},"Reference":"True""#, heading(tenth)));
        let compass = json(tenth, [127_250, 7], &format!(r#""Heading":{:.0},"Reference":"Magnetic""#, heading(tenth)));
        let feedback = json(tenth, [127_245, 9], &format!(r#""Instance":0,"Position":{:.1}"#, rudder(tenth)));
        let receiver = json(tenth, [129_026, 5], r#""COG":355.0,"SOG":6.2"#);
        format!("{compass}\n{gyro}\n{feedback}\n{receiver}\n")
    });
    let plain = every(TENTHS).map(|tenth| {
        let bytes = |value: f64| (10_000.0 * value.to_radians()).round() as i64 as u16;
        let [low, high] = bytes(heading(tenth)).to_le_bytes();
        let gyro = format!("{},2,127250,3,255,8,ff,{low:02x},{high:02x},ff,7f,ff,7f,fc", stamp(tenth));
        let [low, high] = bytes(rudder(tenth)).to_le_bytes();
        format!("{gyro}\n{},2,127245,9,255,8,00,ff,ff,7f,{low:02x},{high:02x},ff,ff\n", stamp(tenth))
    });
    let long = table("time,path,value,source", every(TENTHS), |tenth| {
        let row = |path: &str, value: f64| format!("{},{path},{value:.5},n2k.3\n", stamp(tenth));
        row("navigation.headingTrue", heading(tenth).to_radians())
            + &row("environment.depth.belowKeel", 12.0)
            + row("steering.rudderAngle", rudder(tenth).to_radians()).trim_end()
    });
    let words = &["heading from the device at address 3", "rudder angle from the device at address 9"];
    vec![
        File::new(
            "canboat.jsonl",
            "NMEA 2000 as JSON lines, with a second compass",
            lines.collect::<String>(),
            Read(&["heading from the device at address 3 (401 readings); not used: the device at address 7 (401)"]),
        )
        .not_kept(),
        File::new("canboat.txt", "NMEA 2000 as plain lines of bytes", plain.collect::<String>(), Read(words))
            .not_kept(),
        File::new("signal-k.csv", "a long table: time, path, value, source", long, Read(&["heading from n2k.3"]))
            .not_kept(),
    ]
}
