//! What is said of the constants of a formula, behind it.

/// What is said of a constant: an expected size, and ends.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(super) struct Expectation {
    pub(super) about: Option<f64>,
    pub(super) ends: Option<[f64; 2]>,
}

/// Reads `k about 5; c from 0 to 1`.
pub(super) fn expectations(said: &str, constants: &[String]) -> Result<Vec<Expectation>, String> {
    let mut expected = vec![Expectation::default(); constants.len()];
    for part in said.split(';').map(str::trim).filter(|part| !part.is_empty()) {
        let words: Vec<&str> = part.split_whitespace().collect();
        let number = |word: &str| word.parse().ok().filter(|number: &f64| number.is_finite());
        let place = constants.iter().position(|known| words.first() == Some(&known.as_str()));
        let place = place.ok_or_else(|| format!("`{part}`: expected one of the constants {}", constants.join(", ")))?;
        let own = &mut expected[place];
        let unread = || format!("`{part}`: expected `{0} about 5` or `{0} from 1 to 20`", constants[place]);
        match words[1..] {
            ["about", about] => own.about = Some(number(about).filter(|size| *size != 0.0).ok_or_else(unread)?),
            ["from", lowest, "to", highest] => {
                let ends = [number(lowest).ok_or_else(unread)?, number(highest).ok_or_else(unread)?];
                own.ends = Some(ends).filter(|[low, high]| low < high);
                own.ends.ok_or_else(unread)?;
            }
            _ => return Err(unread()),
        }
    }
    Ok(expected)
}
