//! Numbers in words: where a sentence stands in a text, and how a number in it is written anew.

/// The numbers in the braces of a sentence.
pub fn numbers(says: &str) -> Vec<String> {
    says.split('{').skip(1).filter_map(|part| part.split_once('}')).map(|(number, _)| number.to_owned()).collect()
}

/// A number with a sign as pages write it.
pub fn parsed(written: &str) -> Option<f64> {
    written.replace('−', "-").parse().ok()
}

fn digits(written: &str) -> usize {
    written.split_once('.').map_or(0, |(_, digits)| digits.len())
}

/// `true` if a number that is written is the stored one, rounded.
pub fn is_rounded(written: &str, stored: f64) -> bool {
    let Some(value) = parsed(written) else { return false };
    // Half of the last digit, and a hair for what stands exactly between two.
    (value - stored).abs() <= 0.5 * 10f64.powi(-(digits(written) as i32)) * (1.0 + 1e-6)
}

/// The stored number in the form of the one that is written: as many decimals, or as many significant digits where it
/// has become ten times larger or smaller. What is right stays, also where it stands between two.
pub fn in_the_form_of(written: &str, stored: f64) -> String {
    if is_rounded(written, stored) {
        return written.to_owned();
    }
    let size = |value: f64| value.abs().log10().floor() as i32;
    let decimals = match parsed(written) {
        Some(old) if old != 0.0 && stored != 0.0 && (size(stored) - size(old)).abs() > 1 => {
            (digits(written) as i32 + size(old) - size(stored)).max(0) as usize
        }
        _ => digits(written),
    };
    let text = format!("{:.decimals$}", stored.abs());
    match stored < 0.0 && parsed(&text) != Some(0.0) {
        true => format!("−{text}"),
        false if written.starts_with('+') => format!("+{text}"),
        false => text,
    }
}

/// Where words stand in a text, whatever its lines are: for every place the bytes of all letters, and the end.
pub fn places(text: &str, words: &str) -> Vec<Vec<usize>> {
    let letters: Vec<(usize, char)> = text.char_indices().filter(|(_, letter)| !letter.is_whitespace()).collect();
    let wanted: Vec<char> = words.chars().filter(|letter| !letter.is_whitespace()).collect();
    let is_here = |part: &&[(usize, char)]| part.iter().map(|(_, letter)| letter).eq(&wanted);
    let end = |part: &[(usize, char)]| part.last().map_or(0, |(place, letter)| place + letter.len_utf8());
    let bytes = |part: &[(usize, char)]| part.iter().map(|(place, _)| *place).chain([end(part)]).collect();
    letters.windows(wanted.len().max(1)).filter(is_here).map(bytes).collect()
}

/// A part of a text and what takes its place.
pub type Edit = (usize, usize, String);

/// The edits that put `new` into the braces of `says`, wherever a text has these words.
pub fn edits(text: &str, says: &str, new: &[String]) -> Vec<Edit> {
    let mut parts: Vec<(usize, usize)> = Vec::new();
    let mut count = 0;
    for letter in says.chars().filter(|letter| !letter.is_whitespace()) {
        match letter {
            '{' => parts.push((count, count)),
            '}' => parts.last_mut().expect("a brace was opened").1 = count,
            _ => count += 1,
        }
    }
    let at = |place: &Vec<usize>| -> Vec<Edit> {
        parts.iter().zip(new).map(|((from, to), new)| (place[*from], place[*to - 1], new.clone())).collect()
    };
    places(text, &says.replace(['{', '}'], "")).iter().flat_map(at).collect()
}

/// A text with its edits; the second number of an edit is the place of its last letter.
pub fn edited(text: &str, mut edits: Vec<Edit>) -> Result<String, String> {
    edits.sort();
    edits.dedup();
    if let Some(two) = edits.windows(2).find(|two| two[1].0 <= two[0].1) {
        return Err(format!("two claims write {:?} and {:?} in one place", two[0].2, two[1].2));
    }
    let mut text = text.to_owned();
    for (from, last, new) in edits.into_iter().rev() {
        let end = last + text[last..].chars().next().map_or(0, char::len_utf8);
        text.replace_range(from..end, &new);
    }
    Ok(text)
}

/// A page without code and the targets of links.
pub fn sentences(page: &str) -> String {
    let links = page.split("](").enumerate().map(|(index, part)| match index {
        0 => part,
        _ => part.split_once(')').map_or("", |(_, rest)| rest),
    });
    links.collect::<String>().split('`').step_by(2).collect()
}

#[test]
fn a_number_is_right_to_its_last_digit() {
    assert!(is_rounded("89.8", 89.84) && !is_rounded("89.8", 89.86) && is_rounded("−14", -13.6));
    assert!(is_rounded("57", 56.7) && !is_rounded("57", 57.6) && !is_rounded("x", 0.0));
    assert_eq!(numbers("K in {94.5} % and T in {94.9} %"), ["94.5", "94.9"]);
}

#[test]
fn a_number_is_written_in_the_form_that_it_had() {
    let new = |written, stored| in_the_form_of(written, stored);
    assert_eq!([new("0.49", 0.517), new("−14", -12.6), new("+29", 3.2)], ["0.52", "−13", "+3"]);
    assert_eq!([new("0.36", 0.355), new("83", 82.5)], ["0.36", "83"]);
    assert_eq!([new("22", 0.84), new("0.063", 6.31), new("0.1", -0.04)], ["0.84", "6.3", "0.0"]);
    let page = "holds T in 74 %\n  [71, 76], not 74 %";
    let edits = edits(page, "in {74} % [{71}, {76}]", &["8".into(), "7".into(), "9".into()]);
    assert_eq!(edited(page, edits).as_deref(), Ok("holds T in 8 %\n  [7, 9], not 74 %"));
    assert!(edited("74", vec![(0, 1, "7".into()), (0, 1, "8".into())]).is_err());
}
