//! Damage to a file: flips, cuts, splices, repeats, words of the format, other numbers. The result depends on the
//! generator alone.

use std::ops::Range;

use rand::{RngExt, rngs::ChaCha8Rng};

/// Maximum size of a damaged file, bytes.
const LARGEST: usize = 32 * 1024;

/// Maximum number of kinds of damage to one file.
const MOST_DAMAGE: usize = 6;

/// Numbers that often cause errors in readers.
const NUMBERS: &str = "0 -0 1 -1 2 7 360 -360.5 1e-12 1e-320 1e18 1e308 -1e308 \
                       1e999 nan inf -inf 4294967296 9223372036854775807 18446744073709551616";

/// Damaged copy of one of the files.
pub fn damaged(files: &[Vec<u8>], words: &[Vec<u8>], generator: &mut ChaCha8Rng) -> Vec<u8> {
    let mut file = one(files, generator).clone();
    // Half of the files are damaged only once: more of them are accepted and pass the first checks.
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

fn damage(file: &mut Vec<u8>, files: &[Vec<u8>], words: &[Vec<u8>], generator: &mut ChaCha8Rng) {
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
            let word = one(words, generator).iter().copied();
            file.splice(place..place, word);
        }
        8..=12 => {
            let numbers = numbers(file);
            if !numbers.is_empty() {
                let range = one(&numbers, generator).clone();
                file.splice(range, one(&NUMBERS.split(' ').collect::<Vec<_>>(), generator).bytes());
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

/// Range of at most 256 bytes.
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

/// Positions of the numbers.
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
