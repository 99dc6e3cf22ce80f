//! Frames of a CAN bus, in the hexadecimal notation of candump and bus loggers, or in base64 as from python-can:
//! recognised but not read, because a frame does not state its meaning.

/// Maximum extended identifier, of 29 bits.
const MAX_IDENTIFIER: u32 = 0x1fff_ffff;

/// Columns of a frame in the `CSVWriter` of python-can.
const PYTHON_CAN: [&str; 7] = ["timestamp", "arbitration_id", "extended", "remote", "error", "dlc", "data"];

/// Hexadecimal digits of a standard and of an extended identifier.
const DIGITS: [usize; 2] = [3, 8];

/// `true` if most lines are frames.
pub fn is_log<'a>(lines: impl Iterator<Item = &'a str>) -> bool {
    let written = lines.filter(|line| !line.trim().is_empty());
    let (frames, all) = written.fold((0, 0), |(frames, all), line| (frames + usize::from(is_frame(line)), all + 1));
    2 * frames > all
}

/// `true` if the first nonempty line is the header of python-can's `CSVWriter`.
pub fn is_python_can<'a>(mut lines: impl Iterator<Item = &'a str>) -> bool {
    let header = lines.find(|line| !line.trim().is_empty()).unwrap_or_default();
    header.trim_start_matches('\u{feff}').split(',').map(|name| name.trim().trim_matches('"')).eq(PYTHON_CAN)
}

/// `true` for a frame: an identifier with its bytes as `09F1120A#FF1027FF`, or an identifier, the number of bytes, and
/// the bytes in cells or as a word. A letter among the digits distinguishes it from a row of numbers.
fn is_frame(line: &str) -> bool {
    let cells = line.split([',', ';', '\t', ' ', '"', '\r']).map(str::trim).filter(|cell| !cell.is_empty());
    let cells: Vec<&str> = cells.collect();
    let bytes = cells.iter().rev().take_while(|cell| is_hexadecimal(cell, 2)).count();
    let word = cells.last().map_or(0, |cell| unprefixed(cell).len());
    let in_word =
        (word > 2 && word.is_multiple_of(2) && is_hexadecimal(cells[cells.len() - 1], word)).then_some((word / 2, 1));
    let is_counted = |(count, length): (usize, usize)| {
        let (head, data) = cells.split_at(cells.len() - length);
        let mut identifiers = head.iter().filter(|cell| is_identifier(cell)).peekable();
        let is_there = identifiers.peek().is_some();
        let has_letter = |cell: &&str| cell.bytes().any(|digit| digit.is_ascii_alphabetic());
        let is_count = |cell: &&str| cell.trim_matches(['[', ']']).parse() == Ok(count);
        is_there && head.iter().any(is_count) && identifiers.chain(data).any(has_letter)
    };
    cells.iter().any(|cell| is_joined(cell)) || (1..=bytes).map(|count| (count, count)).chain(in_word).any(is_counted)
}

fn unprefixed(cell: &str) -> &str {
    cell.strip_prefix("0x").or_else(|| cell.strip_prefix("0X")).unwrap_or(cell)
}

fn is_hexadecimal(cell: &str, digits: usize) -> bool {
    let cell = unprefixed(cell);
    cell.len() == digits && cell.bytes().all(|digit| digit.is_ascii_hexdigit())
}

/// `true` for an identifier: three or eight digits, or any number of digits with a prefix or the `x` of an extended
/// identifier.
fn is_identifier(cell: &str) -> bool {
    let digits = unprefixed(cell).trim_end_matches(['x', 'X', 'h', 'H']);
    let is_whole = digits.len() < cell.len() || DIGITS.contains(&digits.len());
    is_whole && u32::from_str_radix(digits, 16).is_ok_and(|number| number <= MAX_IDENTIFIER)
}

/// `true` for an identifier with its bytes, as in files of candump.
fn is_joined(cell: &str) -> bool {
    let Some((id, bytes)) = cell.split_once('#') else { return false };
    let is_even = bytes.len().is_multiple_of(2) && is_hexadecimal(bytes, bytes.len());
    DIGITS.contains(&id.len()) && is_identifier(id) && is_even
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn frames_are_told_from_numbers() {
        let frames = [
            "(1436509052.249713) can0 09F1120A#FF1027FF7FFF7FFD",
            "  can0  09F1120A   [8]  FF 10 27 FF 7F FF 7F FD",
            " (1436509052.249713)  can0  123   [2]  0A 00",
            "0.010000 1  09F1120Ax Rx d 8 FF 10 27 FF 7F FF 7F FD",
            "0.01,0x9F1120A,8,FF,10,27,FF,7F,FF,7F,FD",
            "0.01;09F1120A;8;FF1027FF7FFF7FFD",
            "0.01,09F1120A,true,Rx,0,8,\"FF 10 27 FF 7F FF 7F FD\"",
            "12,0x123,2,0x0a,0x00",
        ];
        frames.iter().for_each(|line| assert!(is_frame(line), "{line}"));
        let other_lines = [
            "0.0,350.0,10.5",
            "20261120 12345678 8 10 20 30 40 50 60 70 80",
            "t_s,heading_deg,rudder_deg",
            "2026-11-20T14:03:05.2,123,45,6,10,20",
            "12,123,2,1500",
            "12,123,E,2,1500",
            "abc,def,123",
            "# one of them",
            "$HEHDT,350.0,T*2F",
            "",
        ];
        other_lines.iter().for_each(|line| assert!(!is_frame(line), "{line}"));
        assert!(is_log(["Time,ID,DLC,Data", frames[4], "", frames[4]].into_iter()) && !is_log(other_lines.into_iter()));
        assert!(!is_log([frames[4], other_lines[0]].into_iter()) && !is_log([].into_iter()));
        let python_can =
            ["", "timestamp,arbitration_id,extended,remote,error,dlc,data", "0.01,0x9f1120a,1,0,0,8,/xAn/3//f/0="];
        assert!(is_python_can(python_can.into_iter()) && !is_log(python_can.into_iter()));
        assert!(!is_python_can(other_lines.into_iter()) && !is_python_can([].into_iter()));
    }
}
