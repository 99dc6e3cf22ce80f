//! Reasons why a method gives no estimate, with the relevant numbers.

use std::borrow::Cow;

use estimation::least_squares::LeastSquaresError;
use thiserror::Error;

/// Reason why a method gives no estimate; in a study the failure is a row like any estimate.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum IdentifyError {
    /// No trial was given.
    #[error("no trial was given")]
    NoTrial,
    /// The ship was hardly steered: the record does not determine the parameters.
    #[error(
        "not excited: the rudder of {trial} moves over {rudder_deg:.2} deg and the heading over {heading_deg:.2} deg; \
         give a record in which the rudder is put to both sides"
    )]
    NotExcited {
        /// Name of the trial.
        trial: String,
        /// Range of the rudder, deg.
        rudder_deg: f64,
        /// Range of the heading, deg.
        heading_deg: f64,
    },
    /// Duration outside 1e-6 to 1e9 s, or an angle above 1e6 rad: powers of such numbers may overflow.
    #[error(
        "{trial} is not a manoeuvre: it lasts {duration_s:.1e} s and its angles reach {angle_rad:.1e} rad; check the units \
        of its columns"
    )]
    OutOfRange {
        /// Name of the trial.
        trial: String,
        /// Time from the first to the last heading, s.
        duration_s: f64,
        /// Maximum heading or rudder angle, rad.
        angle_rad: f64,
    },
    /// Fewer samples than the method requires.
    #[error("needs at least {needed} samples, {trial} has {count}")]
    TooFewSamples {
        /// Name of the trial.
        trial: String,
        /// Number of samples required.
        needed: usize,
        /// Number of samples in the record.
        count: usize,
    },
    /// Fewer points of a kind than the method requires.
    #[error("needs at least {needed} {kind}, found {count}")]
    TooFewPoints {
        /// Kind of the points, e.g. "heading extrema".
        kind: &'static str,
        /// Number of points required.
        needed: usize,
        /// Number of points in the records.
        count: usize,
    },
    /// The method requires a channel that the record does not have.
    #[error("{trial} has no {channel}")]
    NoChannel {
        /// Name of the trial.
        trial: String,
        /// Name of the channel.
        channel: &'static str,
    },
    /// The equations are singular or too ill-conditioned.
    #[error("the equations are singular (condition number {condition:.1e}, limit {limit:.0e})")]
    Singular {
        /// Condition number of the scaled equations.
        condition: f64,
        /// Maximum accepted condition number.
        limit: f64,
    },
    /// The iteration did not converge.
    #[error("did not converge in {iterations} iterations (last relative step {step:.1e})")]
    NotConverged {
        /// Number of iterations.
        iterations: usize,
        /// Last relative step, dimensionless.
        step: f64,
    },
    /// The record does not show that the rudder acts, as in a steady turn, which does not separate K from δ_r.
    #[error(
        "the record does not show an effect of the rudder: K/T = {K_over_T:.1e} ± {sd:.1e} 1/s²; give a record in which \
         the rudder is put to both sides"
    )]
    NoRudderEffect {
        /// K/T, 1/s².
        K_over_T: f64,
        /// Standard deviation of K/T, 1/s².
        sd: f64,
    },
    /// Estimate that is no ship: K/T ≤ 0 or not finite.
    #[error(
        "the estimate is not a ship: 1/T = {inverse_T:.3e} 1/s, K/T = {K_over_T:.3e} 1/s²; expected K/T above 0; check the signs \
         and units of rudder and heading, or give a zig-zag: a rudder that is put over once does not separate K and T"
    )]
    NotAShip {
        /// 1/T, 1/s.
        inverse_T: f64,
        /// K/T, 1/s².
        K_over_T: f64,
    },
    /// Reason why an outside estimator gave no estimate, on one printable line, from
    /// [`IdentifyError::from_outside_message`].
    #[error("outside: {0}")]
    Outside(String),
}

impl From<LeastSquaresError> for IdentifyError {
    fn from(unsolvable: LeastSquaresError) -> Self {
        match unsolvable {
            LeastSquaresError::TooFewRows { columns, rows } => {
                Self::TooFewPoints { kind: "equations", needed: columns, count: rows }
            }
            LeastSquaresError::Singular { condition, limit } => Self::Singular { condition, limit },
        }
    }
}

/// Maximum number of characters in the reason of an outside estimator.
const MAX_REASON_CHARS: usize = 80;

impl IdentifyError {
    /// Failure of an outside estimator with its message, on one line of at most 80 characters. Runs of blanks become a
    /// single blank, and invisible characters are shown as escapes.
    pub fn from_outside_message(message: &str) -> Self {
        let one_line = message.split_whitespace().collect::<Vec<_>>().join(" ");
        let shown = |c: char| match c {
            ' '..='~' => c.to_string(),
            // After a letter, which a combining accent requires.
            c => ['a', c].iter().collect::<String>().escape_debug().skip(1).collect(),
        };
        let mut reason = String::new();
        let mut room = MAX_REASON_CHARS;
        for piece in one_line.chars().map(shown) {
            match room.checked_sub(piece.chars().count()) {
                // Room for the ellipsis.
                Some(remaining) if remaining > 0 => (room, reason) = (remaining, reason + &piece),
                _ => {
                    reason.push('…');
                    break;
                }
            }
        }
        Self::Outside(if reason.is_empty() { "no reason given".to_owned() } else { reason })
    }

    /// Kind of the failure, in kebab-case, for tables and rows.
    pub fn kind(&self) -> &'static str {
        match self {
            Self::NoTrial => "no-trial",
            Self::NotExcited { .. } => "not-excited",
            Self::OutOfRange { .. } => "out-of-range",
            Self::TooFewSamples { .. } => "too-few-samples",
            Self::TooFewPoints { .. } => "too-few-points",
            Self::NoChannel { .. } => "no-channel",
            Self::Singular { .. } => "singular",
            Self::NotConverged { .. } => "not-converged",
            Self::NoRudderEffect { .. } => "no-rudder-effect",
            Self::NotAShip { .. } => "not-a-ship",
            Self::Outside(_) => "outside",
        }
    }

    /// Text of the failure in a row of a study: its kind, and for an outside estimator the reason as well.
    pub fn row_text(&self) -> Cow<'static, str> {
        match self {
            Self::Outside(_) => self.to_string().into(),
            error => error.kind().into(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_outside_message_is_a_single_short_line() {
        let row = |message: &str| IdentifyError::from_outside_message(message).row_text().into_owned();
        assert_eq!(row(" K̂ is\t0 at \"10°\"\n"), "outside: K̂ is 0 at \"10°\"");
        assert_eq!(row("\u{1b}[31mred\u{202e}"), "outside: \\u{1b}[31mred\\u{202e}");
        assert_eq!(row(" \n"), "outside: no reason given");
        let long = row(&"é\u{7}".repeat(100_000));
        assert!(long.chars().count() <= "outside: ".len() + MAX_REASON_CHARS && long.ends_with('…'), "{long}");
        assert_eq!(IdentifyError::NoTrial.row_text(), "no-trial");
    }
}
