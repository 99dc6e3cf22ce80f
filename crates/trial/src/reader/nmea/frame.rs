//! Frame of a line of a log: a sentence with a verified checksum, or a line of another kind. The frame of NMEA 0183
//! (start, address, fields, checksum) and plain numbers are read here, without allocation; sentences are decoded in
//! [`super::sentence`].
//!
//! Source: NMEA 0183 version 4.11, IEC 61162-1.

/// Kind of a line.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Line<'a> {
    /// Sentence of the standard.
    Sentence(Frame<'a>),
    /// Sentence that is not read: AIS (`!`), proprietary (`$P`), or with an address outside the standard.
    Foreign,
    /// Empty, or a comment.
    Blank,
    /// Text without a sentence.
    Text,
    /// Sentence with a wrong checksum.
    WrongSum,
    /// Not text, or cut short.
    Damaged,
}

/// Parts of a sentence of the standard.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Frame<'a> {
    /// Text before the sentence.
    pub before: &'a str,
    /// Talker (two characters) and formatter of the sentence (three).
    pub address: [u8; 5],
    /// Bytes between the comma after the address and the checksum.
    pub body: &'a [u8],
    /// `true` for a sentence with a checksum.
    pub has_checksum: bool,
}

/// Maximum length of a line with a sentence, bytes: 82 of the standard, and room for the text of a logger.
const MAX_LINE_BYTES: usize = 4096;

/// Kind of a line, with the parts of a sentence.
pub(super) fn frame(line: &[u8]) -> Line<'_> {
    if line.len() > MAX_LINE_BYTES {
        return Line::Damaged;
    }
    let Some(start) = line.iter().position(|&byte| byte == b'$') else { return without_start(line) };
    let (before, sentence) = (&line[..start], &line[start + 1..]);
    let Some(before) = text(before) else { return Line::Damaged };
    if before.trim_start().starts_with('#') {
        return Line::Blank;
    }
    // The star is the third character from the end of most lines.
    let star = match sentence.len().checked_sub(3) {
        Some(place) if sentence[place] == b'*' => Some(place),
        _ => sentence.iter().position(|&byte| byte == b'*'),
    };
    let (body, has_checksum) = match star {
        Some(star) => {
            let digits = sentence.get(star + 1).zip(sentence.get(star + 2)).map(|(&high, &low)| (hex(high), hex(low)));
            let Some((Some(high), Some(low))) = digits else { return Line::Damaged };
            if sum(&sentence[..star]) != 16 * high + low {
                return Line::WrongSum;
            }
            (&sentence[..star], true)
        }
        None => {
            let end = sentence.iter().position(|byte| matches!(byte, b'"' | b'\r')).unwrap_or(sentence.len());
            let body = sentence[..end].trim_ascii_end();
            // Without a checksum the body itself is checked.
            if body.contains(&b'$') || text(body).is_none() {
                return Line::Damaged;
            }
            (body, false)
        }
    };
    let Some((address, body)) = body.split_at_checked(5) else {
        return if has_checksum { Line::Foreign } else { Line::Damaged };
    };
    let named = address.iter().all(|byte| byte.is_ascii_uppercase() || byte.is_ascii_digit());
    match (body.first(), <[u8; 5]>::try_from(address)) {
        (Some(b','), Ok(address)) if named && address[0] != b'P' => {
            Line::Sentence(Frame { before, address, body: &body[1..], has_checksum })
        }
        _ if has_checksum || address[0] == b'P' => Line::Foreign,
        _ => Line::Damaged,
    }
}

/// Bytes as text; `None` for invalid UTF-8 and for a zero byte.
fn text(bytes: &[u8]) -> Option<&str> {
    if bytes.is_empty() {
        return Some("");
    }
    std::str::from_utf8(bytes).ok().filter(|_| !bytes.contains(&0))
}

/// Kind of a line without the start of a sentence.
fn without_start(line: &[u8]) -> Line<'_> {
    let Some(text) = text(line) else { return Line::Damaged };
    let text = text.trim();
    if text.is_empty() || text.starts_with('#') {
        Line::Blank
    } else if text.split_once('!').is_some_and(|(_, ais)| ais.as_bytes().get(5) == Some(&b',')) {
        Line::Foreign
    } else {
        Line::Text
    }
}

fn hex(digit: u8) -> Option<u8> {
    char::from(digit).to_digit(16).map(|value| value as u8)
}

/// Checksum of the standard: exclusive or of all bytes.
pub(super) fn sum(bytes: &[u8]) -> u8 {
    bytes.iter().fold(0, |sum, byte| sum ^ byte)
}

/// Maximum number of fields that are read: the ninth of RMC is its date.
pub(super) const MAX_FIELDS: usize = 9;

/// Fields of a sentence, up to [`MAX_FIELDS`]; missing fields are empty.
pub(super) struct Fields<'a> {
    fields: [&'a [u8]; MAX_FIELDS],
}

impl<'a> Fields<'a> {
    /// Fields of the body of a sentence, separated by commas. Fields after the first [`MAX_FIELDS`] are ignored.
    pub fn new(body: &'a [u8]) -> Self {
        let mut fields = [&body[..0]; MAX_FIELDS];
        let (mut begin, mut place) = (0, 0);
        for (end, byte) in body.iter().enumerate() {
            if *byte == b',' {
                fields[place] = &body[begin..end];
                (begin, place) = (end + 1, place + 1);
                if place == MAX_FIELDS {
                    return Self { fields };
                }
            }
        }
        fields[place] = &body[begin..];
        Self { fields }
    }

    /// Field by its number, from 1, counted after the address as in the standard.
    pub fn field(&self, number: usize) -> &'a [u8] {
        self.fields[number - 1]
    }

    /// `true` for a field that contains only the given letter.
    pub fn is(&self, field: usize, letter: u8) -> bool {
        self.field(field) == [letter]
    }

    /// Number in a field.
    pub fn number(&self, field: usize) -> Number {
        number(self.field(field))
    }
}

/// Content of a field of a number.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Number {
    /// Empty field: the instrument has no reading.
    Empty,
    /// Number.
    Value(f64),
    /// Text that is not a plain decimal number.
    Invalid,
}

/// Reads a plain decimal number.
pub(super) fn number(field: &[u8]) -> Number {
    let field = field.trim_ascii();
    if field.is_empty() {
        return Number::Empty;
    }
    let is_plain = |byte: &u8| matches!(byte, b'0'..=b'9' | b'.' | b'-' | b'+');
    let text = std::str::from_utf8(field).ok().filter(|_| field.iter().all(is_plain));
    text.and_then(|text| text.parse().ok()).filter(|x: &f64| x.is_finite()).map_or(Number::Invalid, Number::Value)
}
