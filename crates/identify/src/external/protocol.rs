//! The lines between this program and an outside estimator, JSON objects both.
//!
//! A question holds one trial: its number, which is made from all else that it holds so that only its own answer can
//! carry it, the times (s), headings and rudder angles (rad) of all rows, yaw rates (rad/s) where the record has them,
//! and the declared standard deviations of heading and rudder (rad). A reading that is missing is `null`. Further
//! records of the same ship follow in `also`.
//!
//! ```json
//! {"trial":17,"t_s":[0.0,1.0],"heading_rad":[0.0,null],"rudder_rad":[0.1,0.1],"yaw_rate_rad_s":null,
//!  "noise":{"heading_rad":0.0017,"rudder_rad":null}}
//! ```
//!
//! An answer holds the number of its question, K (1/s), T (s) and δ_r (rad, 0 when it is left out), and what is known
//! of their errors: standard deviations, or better a covariance in that order. Other keys are not looked at.
//!
//! ```json
//! {"trial":17,"K_per_s":0.1,"T_s":16.3,"delta_r_rad":0.0,"sd":{"K_per_s":0.001,"T_s":0.2,"delta_r_rad":null}}
//! {"trial":17,"failed":"the record is too short"}
//! ```
#![expect(non_snake_case, reason = "K and T are the symbols of the field")]

use nalgebra::Matrix3;
use serde::{Deserialize, Serialize};
use trial::Trial;

use super::answer::{Answer, Errors};
use super::process_error::ProcessError;

#[derive(Serialize)]
struct Record<'a> {
    t_s: &'a [f64],
    heading_rad: &'a [f64],
    rudder_rad: &'a [f64],
    yaw_rate_rad_s: Option<&'a [f64]>,
    noise: DeclaredNoise,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    also: Vec<Record<'a>>,
}

#[derive(Serialize)]
struct DeclaredNoise {
    heading_rad: Option<f64>,
    rudder_rad: Option<f64>,
}

impl<'a> Record<'a> {
    fn of(trial: &'a Trial) -> Self {
        let trial::Noise { heading, rudder, .. } = trial.noise();
        Self {
            t_s: trial.time(),
            heading_rad: trial.heading(),
            rudder_rad: trial.rudder(),
            yaw_rate_rad_s: trial.yaw_rate(),
            noise: DeclaredNoise { heading_rad: heading, rudder_rad: rudder },
            also: Vec::new(),
        }
    }
}

/// The number of a question and its line about a trial, of which further records are those behind the first.
///
/// The number is the same whoever asks and whenever, so a program may draw at random by it. It differs between any two
/// questions of a study, so that a line too many is never taken for the answer to another one; `replicate` tells those
/// about equal records apart.
pub fn question(replicate: u64, trial: &Trial, others: &[Trial]) -> (u64, Vec<u8>) {
    let record = Record { also: others.iter().map(Record::of).collect(), ..Record::of(trial) };
    // Numbers that are not finite become `null`, which is what a missing reading is.
    let body = serde_json::to_vec(&record).expect("numbers and lists can be written to memory");
    let number = number_of(&body, replicate);
    let head = format!("{{\"trial\":{number},");
    (number, [head.as_bytes(), &body[1..], b"\n"].concat())
}

/// Digest of a question (FNV-1a) of at most 14 digits, which every language writes as it reads them.
fn number_of(body: &[u8], replicate: u64) -> u64 {
    const BITS: u32 = 46;
    let step = |hash: u64, byte: &u8| (hash ^ u64::from(*byte)).wrapping_mul(0x0100_0000_01b3);
    let hash = body.iter().chain(&replicate.to_le_bytes()).fold(0xcbf2_9ce4_8422_2325, step);
    (hash ^ (hash >> BITS)) & ((1 << BITS) - 1)
}

#[derive(Deserialize)]
struct Reply {
    trial: Option<f64>,
    failed: Option<String>,
    K_per_s: Option<f64>,
    T_s: Option<f64>,
    delta_r_rad: Option<f64>,
    sd: Option<Deviations>,
    covariance: Option<[[Option<f64>; 3]; 3]>,
}

#[derive(Deserialize)]
struct Deviations {
    K_per_s: Option<f64>,
    T_s: Option<f64>,
    delta_r_rad: Option<f64>,
}

/// Reads the answer to the question with this number; the inner failure is that of the estimator, in its words.
///
/// Fails when the line is no answer to it: no JSON, another number, no K or no T.
pub fn answer(line: &[u8], number: u64) -> Result<Result<Answer, String>, ProcessError> {
    let reply = read(line)?;
    match reply.trial {
        Some(own) if own == number as f64 => {}
        Some(other) => {
            return Err(ProcessError::Nonsense(format!("an answer to trial {other} where {number} was asked")));
        }
        None => return Err(ProcessError::Nonsense("an answer without the number of its trial".to_owned())),
    }
    if let Some(words) = reply.failed {
        return Ok(Err(words));
    }
    let needed = |name: &str, value: Option<f64>| {
        let is_number = |value: &f64| value.is_finite();
        value
            .filter(is_number)
            .ok_or_else(|| ProcessError::Nonsense(format!("{name} is missing or is no finite number")))
    };
    let (K, T) = (needed("K_per_s", reply.K_per_s)?, needed("T_s", reply.T_s)?);
    Ok(Ok(Answer { K, T, rudder_bias: reply.delta_r_rad.unwrap_or(0.0), errors: errors(&reply.covariance, reply.sd) }))
}

/// A covariance where all of it is there, else standard deviations.
fn errors(covariance: &Option<[[Option<f64>; 3]; 3]>, sd: Option<Deviations>) -> Errors {
    let whole = covariance.and_then(|rows| {
        let values = rows.into_iter().flatten().collect::<Option<Vec<f64>>>()?;
        Some(Matrix3::from_row_slice(&values))
    });
    match (whole, sd) {
        (Some(matrix), _) => Errors::Covariance(matrix),
        (None, Some(Deviations { K_per_s, T_s, delta_r_rad })) => Errors::Deviations([K_per_s, T_s, delta_r_rad]),
        (None, None) => Errors::Unknown,
    }
}

fn read(line: &[u8]) -> Result<Reply, ProcessError> {
    let refuse = |error: serde_json::Error| match error.is_data() {
        true => ProcessError::Nonsense(format!("not an answer: {error}")),
        false => ProcessError::Nonsense(format!("not JSON: {}", String::from_utf8_lossy(line))),
    };
    match serde_json::from_slice(line) {
        // Many a library writes NaN where JSON has only null.
        Err(error) if error.is_syntax() => serde_json::from_slice(&without_nan(line)).map_err(refuse),
        read => read.map_err(refuse),
    }
}

/// A line with `null` for every NaN and infinity that stands outside of texts.
fn without_nan(line: &[u8]) -> Vec<u8> {
    const WORDS: [&[u8]; 4] = [b"NaN", b"-NaN", b"Infinity", b"-Infinity"];
    let mut clean = Vec::with_capacity(line.len());
    let (mut rest, mut is_text) = (line, false);
    while let Some(&byte) = rest.first() {
        let word = WORDS.iter().find(|word| !is_text && rest.starts_with(word));
        let (taken, written) = match word {
            Some(word) => (word.len(), &b"null"[..]),
            None if is_text && byte == b'\\' && rest.len() > 1 => (2, &rest[..2]),
            None => (1, &rest[..1]),
        };
        is_text ^= byte == b'"';
        clean.extend_from_slice(written);
        rest = &rest[taken..];
    }
    clean
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::{Case, record};

    fn said(line: &str) -> String {
        answer(line.as_bytes(), 17).expect_err("it is no answer").to_string()
    }

    fn found(line: &str) -> Answer {
        answer(line.as_bytes(), 17).expect("an answer").expect("no failure")
    }

    #[test]
    fn a_question_holds_the_record_to_the_last_bit() {
        let truth = Case { samples: 20, noise_deg: 0.1, ..Case::default() }.trial();
        let mut heading = truth.heading().to_vec();
        heading[3] = f64::NAN;
        let trial = record("gap", truth.time().to_vec(), heading.clone(), truth.rudder().to_vec());
        let trial = trial.with_noise(trial::Noise { heading: Some(0.0017), ..Default::default() });
        let (number, line) = question(17, &trial, std::slice::from_ref(&trial));
        assert_eq!(line.iter().filter(|byte| **byte == b'\n').count(), 1);
        let read: serde_json::Value = serde_json::from_slice(&line).expect("JSON");
        assert_eq!((&read["trial"], &read["yaw_rate_rad_s"]), (&number.into(), &serde_json::Value::Null));
        assert!(number < 100_000_000_000_000 && question(17, &trial, std::slice::from_ref(&trial)).0 == number);
        assert!(
            question(17, &trial, &[]).0 != number && question(18, &trial, std::slice::from_ref(&trial)).0 != number
        );
        assert_eq!(read["noise"].to_string(), r#"{"heading_rad":0.0017,"rudder_rad":null}"#);
        let also = &read["also"][0];
        assert!(also["trial"].is_null() && also["also"].is_null());
        for one in [&read, also] {
            let back: Vec<Option<f64>> = serde_json::from_value(one["heading_rad"].clone()).expect("numbers");
            let own: Vec<Option<f64>> = heading.iter().map(|psi| Some(*psi).filter(|psi| psi.is_finite())).collect();
            assert_eq!(back, own);
        }
    }

    #[test]
    fn an_answer_is_read_with_what_it_leaves_out() {
        let bare = found(r#"{"trial": 17.0, "K_per_s": 0.1, "T_s": 16, "missing": ["wind_moment"], "sd": null}"#);
        assert_eq!(bare, Answer { K: 0.1, T: 16.0, rudder_bias: 0.0, errors: Errors::Unknown });
        let sd = found(r#"{"trial": 17, "K_per_s": 0.1, "T_s": 16, "sd": {"K_per_s": 0.01, "T_s": NaN}}"#);
        assert_eq!(sd.errors, Errors::Deviations([Some(0.01), None, None]));
        let both = r#"{"trial": 17, "K_per_s": 1, "T_s": 1, "covariance": [[1,0,0],[0,2,0],[0,0,3]], "sd": {}}"#;
        assert_eq!(found(both).errors, Errors::Covariance(Matrix3::from_diagonal(&[1.0, 2.0, 3.0].into())));
        let half = both.replace("[1,0,0]", "[Infinity,0,0]");
        assert_eq!(found(&half).errors, Errors::Deviations([None; 3]));
        let failed = answer(br#"{"trial": 17, "failed": "NaN \"NaN"}"#, 17).expect("an answer");
        assert_eq!(failed, Err("NaN \"NaN".to_owned()));
    }

    #[test]
    fn nonsense_is_told_as_what_it_is() {
        for (line, part) in [
            ("Warning: deprecated", "not JSON: Warning: deprecated"),
            ("", "not JSON"),
            ("[1, 2]", "not an answer"),
            (r#"{"trial": 17, "K_per_s": "a lot", "T_s": 1}"#, "not an answer: invalid type"),
            (r#"{"trial": 18, "K_per_s": 0.1, "T_s": 16}"#, "an answer to trial 18 where 17 was asked"),
            (r#"{"K_per_s": 0.1, "T_s": 16}"#, "without the number"),
            (r#"{"trial": 17, "K_per_s": 0.1}"#, "T_s is missing"),
            (r#"{"trial": 17, "K_per_s": NaN, "T_s": 16}"#, "K_per_s is missing or is no finite number"),
            (r#"{"trial": 17, "K_per_s": 0.1, "T_s": -Infinity}"#, "T_s is missing"),
            (r#"{"trial": 17, "K_per_s": 1, "T_s": 1, "covariance": [[1]]}"#, "not an answer"),
        ] {
            assert!(said(line).contains(part), "{line}: {}", said(line));
        }
    }
}
