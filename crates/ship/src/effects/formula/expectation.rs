//! Expected values and ranges of the constants, written after a formula.

/// Expectation of a constant: the expected value `about` and the range `ends`, each `None` if it is not given.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(super) struct Expectation {
    pub(super) about: Option<f64>,
    pub(super) ends: Option<[f64; 2]>,
}

/// Expectations of all constants, parsed from `k about 5; c from 0 to 1`. Fails with a message if the text has another
/// form.
pub(super) fn expectations(text: &str, constants: &[String]) -> Result<Vec<Expectation>, String> {
    let mut expected = vec![Expectation::default(); constants.len()];
    for part in text.split(';').map(str::trim).filter(|part| !part.is_empty()) {
        let tokens: Vec<&str> = part.split_whitespace().collect();
        let number = |token: &str| token.parse().ok().filter(|number: &f64| number.is_finite());
        let place = constants.iter().position(|constant| tokens.first() == Some(&constant.as_str()));
        let place = place.ok_or_else(|| format!("`{part}`: expected one of the constants {}", constants.join(", ")))?;
        let expectation = &mut expected[place];
        let unread = || format!("`{part}`: expected `{0} about 5` or `{0} from 1 to 20`", constants[place]);
        match tokens[1..] {
            ["about", about] => expectation.about = Some(number(about).filter(|size| *size != 0.0).ok_or_else(unread)?),
            ["from", lowest, "to", highest] => {
                let ends = [number(lowest).ok_or_else(unread)?, number(highest).ok_or_else(unread)?];
                expectation.ends = Some(ends).filter(|[low, high]| low < high);
                expectation.ends.ok_or_else(unread)?;
            }
            _ => return Err(unread()),
        }
    }
    Ok(expected)
}
