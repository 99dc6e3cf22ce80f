//! One line of a log and what it is: a sentence with its checksum verified, or why it is none. It knows the frame of
//! NMEA 0183 (start, address, fields, checksum) and plain numbers, and nothing of what a sentence says. It allocates
//! nothing.

/// What a line is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Line<'a> {
    /// A sentence of the standard.
    Sentence(Frame<'a>),
    /// A sentence that is not read: of AIS (`!`), of one maker (`$P`), or with an address that is not of the standard.
    Foreign,
    /// Empty, or a comment.
    Blank,
    /// Text without a sentence.
    Text,
    /// A sentence whose checksum is not its own.
    WrongSum,
    /// Not text, or cut short.
    Damaged,
}

/// A sentence of the standard.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Frame<'a> {
    /// What stands before it in the line.
    pub before: &'a str,
    /// Talker (two characters) and sentence (three).
    pub address: [u8; 5],
    /// All between the comma after the address and the checksum.
    pub body: &'a [u8],
    /// Whether it has a checksum.
    pub summed: bool,
}

/// Longest line with a sentence, bytes: 82 of the standard, and room for what loggers write around it.
const LONGEST: usize = 4096;

/// Tells what a line is.
pub(super) fn frame(line: &[u8]) -> Line<'_> {
    if line.len() > LONGEST {
        return Line::Damaged;
    }
    let Some(start) = line.iter().position(|&byte| byte == b'$') else { return without_start(line) };
    let (before, rest) = (&line[..start], &line[start + 1..]);
    let Some(before) = text(before) else { return Line::Damaged };
    if before.trim_start().starts_with('#') {
        return Line::Blank;
    }
    // The star stands third from the end of most lines.
    let star = match rest.len().checked_sub(3) {
        Some(place) if rest[place] == b'*' => Some(place),
        _ => rest.iter().position(|&byte| byte == b'*'),
    };
    let (body, summed) = match star {
        Some(star) => {
            let digits = rest.get(star + 1).zip(rest.get(star + 2)).map(|(&high, &low)| (hex(high), hex(low)));
            let Some((Some(high), Some(low))) = digits else { return Line::Damaged };
            if sum(&rest[..star]) != 16 * high + low {
                return Line::WrongSum;
            }
            (&rest[..star], true)
        }
        None => {
            let end = rest.iter().position(|byte| matches!(byte, b'"' | b'\r')).unwrap_or(rest.len());
            let body = rest[..end].trim_ascii_end();
            // Where there is a right checksum, there is nothing else to see to.
            if body.contains(&b'$') || text(body).is_none() {
                return Line::Damaged;
            }
            (body, false)
        }
    };
    let Some((address, body)) = body.split_at_checked(5) else {
        return if summed { Line::Foreign } else { Line::Damaged };
    };
    let named = address.iter().all(|byte| byte.is_ascii_uppercase() || byte.is_ascii_digit());
    match (body.first(), <[u8; 5]>::try_from(address)) {
        (Some(b','), Ok(address)) if named && address[0] != b'P' => {
            Line::Sentence(Frame { before, address, body: &body[1..], summed })
        }
        _ if summed || address[0] == b'P' => Line::Foreign,
        _ => Line::Damaged,
    }
}

/// Bytes that are text, which has no zero byte.
fn text(bytes: &[u8]) -> Option<&str> {
    if bytes.is_empty() {
        return Some("");
    }
    std::str::from_utf8(bytes).ok().filter(|_| !bytes.contains(&0))
}

/// What a line without the start of a sentence is.
fn without_start(line: &[u8]) -> Line<'_> {
    let Some(text) = text(line) else { return Line::Damaged };
    let text = text.trim();
    if text.is_empty() || text.starts_with('#') {
        Line::Blank
    } else if text.split_once('!').is_some_and(|(_, rest)| rest.as_bytes().get(5) == Some(&b',')) {
        Line::Foreign
    } else {
        Line::Text
    }
}

fn hex(digit: u8) -> Option<u8> {
    char::from(digit).to_digit(16).map(|value| value as u8)
}

/// The checksum of the standard: exclusive or of all bytes.
pub(super) fn sum(bytes: &[u8]) -> u8 {
    bytes.iter().fold(0, |sum, byte| sum ^ byte)
}

/// Most fields that are looked at: the ninth of RMC is its date.
pub(super) const MOST_FIELDS: usize = 9;

/// The fields of a sentence, as many as are looked at; those that are not there are empty.
pub(super) struct Fields<'a> {
    fields: [&'a [u8]; MOST_FIELDS],
}

impl<'a> Fields<'a> {
    /// The first fields of `body`.
    pub fn new(body: &'a [u8]) -> Self {
        let mut fields = [&body[..0]; MOST_FIELDS];
        let (mut begin, mut place) = (0, 0);
        for (end, byte) in body.iter().enumerate() {
            if *byte == b',' {
                fields[place] = &body[begin..end];
                (begin, place) = (end + 1, place + 1);
                if place == MOST_FIELDS {
                    return Self { fields };
                }
            }
        }
        fields[place] = &body[begin..];
        Self { fields }
    }

    /// The field with number `place`, from 1 as the standard counts them after the address.
    pub fn at(&self, place: usize) -> &'a [u8] {
        self.fields[place - 1]
    }

    /// Whether a field is one capital letter.
    pub fn is(&self, place: usize, letter: u8) -> bool {
        self.at(place) == [letter]
    }

    /// The number in a field.
    pub fn number(&self, place: usize) -> Number {
        number(self.at(place))
    }
}

/// What stands where a number is expected.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Number {
    /// Nothing: the instrument has no reading.
    Empty,
    /// A number.
    Of(f64),
    /// Something else.
    Not,
}

/// Reads a plain decimal number.
pub(super) fn number(field: &[u8]) -> Number {
    let field = field.trim_ascii();
    if field.is_empty() {
        return Number::Empty;
    }
    let is_plain = |byte: &u8| matches!(byte, b'0'..=b'9' | b'.' | b'-' | b'+');
    let text = std::str::from_utf8(field).ok().filter(|_| field.iter().all(is_plain));
    text.and_then(|text| text.parse().ok()).filter(|value: &f64| value.is_finite()).map_or(Number::Not, Number::Of)
}
