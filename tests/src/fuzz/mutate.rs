//! Damages a file: flips, cuts, splices, repeats, words of the format, other numbers. What comes out depends on the
//! generator alone.

use std::ops::Range;

use rand::{RngExt, rngs::ChaCha8Rng};

/// Largest damaged file, bytes.
const LARGEST: usize = 32 * 1024;

/// Most kinds of damage to one file.
const MOST_DAMAGE: usize = 6;

/// Numbers that readers stumble over.
const NUMBERS: [&str; 20] = [
    "0",
    "-0",
    "1",
    "-1",
    "2",
    "7",
    "360",
    "-360.5",
    "1e-12",
    "1e-320",
    "1e18",
    "1e308",
    "-1e308",
    "1e999",
    "nan",
    "inf",
    "-inf",
    "4294967296",
    "9223372036854775807",
    "18446744073709551616",
];

/// Pieces of records.
pub const RECORD: &[&str] = &[
    "t_s",
    "t_ms",
    "t_min",
    "heading_deg",
    "heading_rad",
    "rudder_deg",
    "rudder_rad",
    "rudder_order_deg",
    "yaw_rate_deg_s",
    "yaw_rate_deg_min",
    "speed_m_s",
    "speed_kn",
    "surge_m_s",
    "sway_m_s",
    "north_m",
    "east_m",
    "roll_deg",
    "propeller_rpm",
    "wind_true_speed_kn",
    "wind_true_from_deg",
    ",",
    ";",
    "\t",
    " ",
    "\"",
    "\"\"",
    "#",
    "\r\n",
    "\n\n",
    "\u{feff}",
    "−",
    "1,5",
    "NaN",
    "-",
    "°",
    "\0",
    "\u{1b}[31m",
    "\u{202e}",
    "=1+1",
];

/// Pieces of logs of sentences.
pub const NMEA: &[&str] = &[
    "$HEHDT,12.3,T",
    "$HEHDT,12.3,T*2D",
    "$IIRSA,-10.0,A,,V",
    "$IIRSA,10.0,A,10.2,A",
    "$GPRMC,140305,A,5400.0,N,01000.0,E,12.0,,201126,,",
    "$GPZDA,140305.00,20,11,2026,00,00",
    "$GPGGA,140306,5400.0,N,01000.0,E,1,8,1,0,M,0,M,,",
    "$TIROT,-12.5,A",
    "$HCHDG,12.3,0.5,E,3.1,W",
    "$VDVHW,,,12.3,M,12.0,N,,",
    "$YXXDR,A,5.0,D,RUDDER",
    "!AIVDM,1,1,,A,x,0*00",
    "\\c:1795183385,s:GP0001*00\\",
    "2026-11-20T14:03:05.2Z ",
    "20.11.2026 14:03:05 ",
    "1795183385000 ",
    "*",
    "$",
    ",",
    "\r\n",
    "\0",
];

/// Pieces of stamps.
pub const STAMP: &[&str] = &[
    "2026-11-20",
    "20.11.2026 ",
    "11/20/2026 ",
    "03/04/2026 ",
    "20-Nov-2026 ",
    "Nov 20, 2026 ",
    "20261120T140305",
    "14:03:05",
    "23:59:60",
    "00:00:00",
    "2h03m05",
    ".25",
    ",5",
    " PM",
    " a.m.",
    "Z",
    "UTC",
    "+01:00",
    "-0330",
    "T",
    "\n",
];

/// Pieces of sidecars.
pub const SIDECAR: &[&str] = &[
    "[table]\n",
    "[part]\n",
    "[[column]]\n",
    "[ship]\n",
    "[noise]\n",
    "[check]\n",
    "skip-lines = 4\n",
    "separator = \"blank\"\n",
    "separator = \"semicolon\"\n",
    "encoding = \"windows-1252\"\n",
    "header = false\n",
    "time-step-s = 0.1\n",
    "from-s = 20.0\n",
    "until-s = 110.0\n",
    "every = 4\n",
    "index = 4\n",
    "name = \"psi\"\n",
    "is = \"heading_rad\"\n",
    "is = \"t_s\"\n",
    "flip = true\n",
    "ignore = true\n",
    "length-m = 7.0\n",
    "speed-kn = 1.0\n",
    "heading-deg = 0.1\n",
    "plausibility = false\n",
    "\n# table\n",
    "\"",
    "\\u001b",
    "\u{1b}",
    "t_s",
    "heading_deg",
    "rudder_deg",
    ",",
];

/// Pieces of scenarios and manifests.
pub const SCENARIO: &[&str] = &[
    "question = \"q\"\n",
    "seed = 1\n",
    "replicates = 2\n",
    "[ship.first-order]\n",
    "[ship.kvlcc2]\n",
    "[ship.mariner]\n",
    "[ship.yukun]\n",
    "K-per-s = 0.1\n",
    "T-s = 16.3\n",
    "K-prime = 1.5\n",
    "length-m = 150.0\n",
    "[[effect]]\n",
    "nonlinear_damping = { n3-s2-per-deg2 = 0.2 }\n",
    "second_order = { T2-s = 2.5, T3-s = 6.2 }\n",
    "[manoeuvre.zig-zag]\n",
    "rudder-deg = 10.0\n",
    "heading-deg = 10.0\n",
    "executes = 6\n",
    "first = \"port\"\n",
    "[steering-gear]\n",
    "rate-deg-s = 2.5\n",
    "rate-deg-s = inf\n",
    "dead-time-s = 0.5\n",
    "[recording]\n",
    "sampling-s = 1.0\n",
    "duration-s = 270.0\n",
    "after-execute = 1\n",
    "[sensor]\n",
    "heading-noise-deg = 0.1\n",
    "rudder-quantum-deg = 1.0\n",
    "jitter-s = 0.3\n",
    "heading-wander = { sd-deg = 0.3, correlation-s = 10.0 }\n",
    "heading-spikes = { probability = 0.01, size-deg = 5.0 }\n",
    "heading-every-rows = 5\n",
    "drop-out = { burst-probability = 0.01, burst-mean-rows = 60.0, whole-row = true }\n",
    "[disturbance]\n",
    "waves = { sd-deg = 0.2, frequency-rad-s = 0.6, damping = 0.1 }\n",
    "[[identifier]]\n",
    "method.output-error = {}\n",
    "method.fourier-published = { triples = 10 }\n",
    "method.fourier-projected = { harmonics = { fixed = 8 } }\n",
    "trace = {}\n",
    "label = \"a\"\n",
    "[[sweep]]\n",
    "key = \"sensor.heading-noise-deg\"\n",
    "key = \"identifier.0.label\"\n",
    "values = [0.1, 0.2]\n",
    "linear = { from = 1.0, to = 2.0, points = 3 }\n",
    "log = { from = 0.1, to = 2.0, points = 3 }\n",
    "points = [{ label = \"x\", set = { \"recording.sampling-s\" = 2.0 } }]\n",
    "[[draw]]\n",
    "key = \"ship.first-order.T-s\"\n",
    "uniform = { from = 1.0, to = 2.0 }\n",
    "log-normal = { median = 16.3, sigma = 0.3 }\n",
    "between = [5.0, 50.0]\n",
    "[validation.manoeuvre.zig-zag]\n",
    "[stop]\n",
    "figure = \"rms-T\"\n",
    "method = \"output-error\"\n",
    "standard-error = 0.05\n",
    "[output]\n",
    "detail = [\"0.1\"]\n",
    "[published]\n",
    "a.",
    "\"\"",
    "\"",
    "'",
    "\"\"\"",
    "{",
    "}",
    "[",
    "]",
    "=",
    "\\u001b",
    "\u{1b}",
    "\u{202e}",
    "../",
    "name = \"../x\"\n",
    "shard = \"1/2\"\n",
    "shard = \"0/0\"\n",
];

/// Pieces of stored designs.
pub const CELLS: &[&str] = &[
    "{",
    "}",
    "[",
    "]",
    ",",
    ":",
    "\"\"",
    "null",
    "\"labels\":[],",
    "\"values\":[],",
    "\"axes\":[\"z\"],",
    "\"methods\":[],",
    "\"missing\":[\"hull\"],",
    "\"bound_percent2\":[[1.0,0.0],[0.0,1.0]]",
    "\"detail\":[7],",
    "\"draws\":[\"a.b\"],",
    "\\u0000",
    "\\u001b",
    "\"figure\":\"../x\",",
    "true",
    "[[[[[[[[[[[[[[[[",
];

/// A damaged copy of one of the files.
pub fn damaged(files: &[Vec<u8>], words: &[&str], generator: &mut ChaCha8Rng) -> Vec<u8> {
    let mut file = one(files, generator).clone();
    // Half of the files are hurt once only: more of them are accepted, and get further.
    let times = if generator.random() { 1 } else { generator.random_range(2..=MOST_DAMAGE) };
    for _ in 0..times {
        damage(&mut file, files, words, generator);
    }
    file.truncate(LARGEST);
    file
}

fn one<'a, T>(things: &'a [T], generator: &mut ChaCha8Rng) -> &'a T {
    &things[generator.random_range(0..things.len())]
}

fn damage(file: &mut Vec<u8>, files: &[Vec<u8>], words: &[&str], generator: &mut ChaCha8Rng) {
    match generator.random_range(0..18) {
        0 => {
            if let Some(place) = place(file, generator) {
                file[place] ^= 1 << generator.random_range(0..8u32);
            }
        }
        1 => {
            if let Some(place) = place(file, generator) {
                file[place] = generator.random();
            }
        }
        2 => {
            let range = range(file, generator);
            file.drain(range);
        }
        3 => {
            let cut = generator.random_range(0..=file.len());
            file.truncate(cut);
        }
        4 => {
            let range = range(file, generator);
            let times = 1 << generator.random_range(0..8u32);
            repeat(file, range, times);
        }
        5 => {
            let other = one(files, generator);
            let (own, others) = (generator.random_range(0..=file.len()), generator.random_range(0..=other.len()));
            file.truncate(own);
            file.extend_from_slice(&other[others..]);
        }
        6 | 7 if !words.is_empty() => {
            let place = generator.random_range(0..=file.len());
            let place = if generator.random_ratio(1, 4) { place } else { line_start(file, place) };
            let word = one(words, generator).bytes();
            file.splice(place..place, word);
        }
        8..=12 => {
            let numbers = numbers(file);
            if !numbers.is_empty() {
                let range = one(&numbers, generator).clone();
                file.splice(range, one(&NUMBERS, generator).bytes());
            }
        }
        13 | 14 => {
            let line = line(file, generator);
            file.drain(line);
        }
        15 | 16 => {
            let line = line(file, generator);
            let moved: Vec<u8> = file[line].to_vec();
            let place = generator.random_range(0..=file.len());
            let place = line_start(file, place);
            file.splice(place..place, moved);
        }
        _ => {
            // Lengths and offsets of binary files.
            let bytes =
                one(&[0, 1, 0x7f, 0x80, u64::from(u32::MAX), i64::MAX as u64, u64::MAX], generator).to_le_bytes();
            let width = *one(&[1, 4, 8], generator);
            if let Some(place) = place(file, generator) {
                let end = file.len().min(place + width);
                file[place..end].copy_from_slice(&bytes[..end - place]);
            }
        }
    }
}

fn place(file: &[u8], generator: &mut ChaCha8Rng) -> Option<usize> {
    (!file.is_empty()).then(|| generator.random_range(0..file.len()))
}

/// A range of at most 256 bytes.
fn range(file: &[u8], generator: &mut ChaCha8Rng) -> Range<usize> {
    let start = generator.random_range(0..=file.len());
    start..file.len().min(start + generator.random_range(0..256usize))
}

fn repeat(file: &mut Vec<u8>, range: Range<usize>, times: usize) {
    let room = LARGEST.saturating_sub(file.len()) / range.len().max(1);
    let block = file[range.clone()].repeat(times.min(room));
    file.splice(range.end..range.end, block);
}

fn line_start(file: &[u8], place: usize) -> usize {
    file[..place].iter().rposition(|&byte| byte == b'\n').map_or(0, |end| end + 1)
}

fn line(file: &[u8], generator: &mut ChaCha8Rng) -> Range<usize> {
    let place = generator.random_range(0..=file.len());
    let end = file[place..].iter().position(|&byte| byte == b'\n').map_or(file.len(), |end| place + end + 1);
    line_start(file, place)..end
}

/// Where numbers stand.
fn numbers(file: &[u8]) -> Vec<Range<usize>> {
    let part = |byte: &u8| byte.is_ascii_digit() || matches!(byte, b'.' | b'-' | b'+' | b'e');
    let mut found = Vec::new();
    let mut place = 0;
    while place < file.len() {
        let length = file[place..].iter().take_while(|byte| part(byte)).count();
        if file[place..place + length].iter().any(u8::is_ascii_digit) {
            found.push(place..place + length);
        }
        place += length.max(1);
    }
    found
}
