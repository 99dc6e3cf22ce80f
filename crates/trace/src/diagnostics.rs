//! What can be said of a residual alone: is it white, and if not, where does it live.

use statrs::distribution::{ChiSquared, ContinuousCDF};

/// Whiteness of a residual.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Whiteness {
    /// Lag-1 autocorrelation, pooled over records.
    pub lag1: f64,
    /// Probability that a white residual has autocorrelations as large (Ljung and Box 1978), pooled over records.
    pub p_value: f64,
}

/// Largest lag of the whiteness test.
const LAGS: usize = 20;

/// Tests the residuals of several records together; missing values are left out.
pub fn whiteness(residuals: &[Vec<f64>]) -> Whiteness {
    let (mut square, mut cross, mut statistic, mut freedom) = (0.0, 0.0, 0.0, 0.0);
    for residual in residuals {
        let present: Vec<f64> = residual.iter().copied().filter(|e| e.is_finite()).collect();
        let n = present.len();
        let lags = LAGS.min(n / 4);
        let correlations = autocorrelation(&present, lags);
        let own: f64 = present.iter().map(|e| e * e).sum();
        square += own;
        cross += correlations.first().copied().unwrap_or(0.0) * own;
        let n = n as f64;
        statistic += correlations
            .iter()
            .enumerate()
            .map(|(k, rho)| n * (n + 2.0) * rho * rho / (n - 1.0 - k as f64))
            .sum::<f64>();
        freedom += lags as f64;
    }
    let p_value = if freedom > 0.0 { ChiSquared::new(freedom).map_or(1.0, |chi| chi.sf(statistic)) } else { 1.0 };
    Whiteness { lag1: if square > 0.0 { cross / square } else { 0.0 }, p_value }
}

/// Autocorrelations at lags 1, 2, …, `lags` of a series about zero.
pub fn autocorrelation(series: &[f64], lags: usize) -> Vec<f64> {
    let square: f64 = series.iter().map(|e| e * e).sum();
    (1..=lags)
        .map(|lag| {
            let cross: f64 = series.iter().zip(series.get(lag..).unwrap_or(&[])).map(|(x, y)| x * y).sum();
            if square > 0.0 { cross / square } else { 0.0 }
        })
        .collect()
}

/// One line of a spectrum.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Line {
    /// Frequency, Hz.
    pub frequency: f64,
    /// Share of the mean square.
    pub share: f64,
}

/// Periodogram of a series on about evenly spaced rows, missing values taken as zero: shares of the mean square.
pub fn spectrum(series: &[f64], spacing: f64) -> Vec<Line> {
    let n = series.len();
    if n < 4 {
        return Vec::new();
    }
    let mut input: Vec<f64> = series.iter().map(|&e| if e.is_finite() { e } else { 0.0 }).collect();
    let power = lanes::transform::power(&mut input).split_off(1);
    let total: f64 = power.iter().sum();
    let line = |(k, power): (usize, f64)| Line {
        frequency: (k + 1) as f64 / (n as f64 * spacing),
        share: if total > 0.0 { power / total } else { 0.0 },
    };
    power.into_iter().enumerate().map(line).collect()
}

/// Where a residual lives.
#[derive(Debug, Clone, PartialEq)]
pub struct Signature {
    /// Number of the record.
    pub record: usize,
    /// Span of time, s, that holds most of it for its length, and its share of the sum of squares.
    pub span: ([f64; 2], f64),
    /// Strongest line of its spectrum.
    pub line: Line,
    /// Band of headings, rad, in which it is largest, and the root mean square there, rad.
    pub heading: ([f64; 2], f64),
    /// Root mean square while the rudder is to port and to starboard, rad.
    pub side: [f64; 2],
    /// Root mean square of all of it, rad.
    pub all: f64,
}

/// Parts of a record among which the fullest is looked for, and bands of headings.
const PARTS: usize = 8;
const BANDS: usize = 4;

/// Describes the residual of one record, row by row.
pub fn signature(
    number: usize,
    time: &[f64],
    residual: &[f64],
    heading: &[f64],
    rudder: &[f64],
    spacing: f64,
) -> Signature {
    let rows: Vec<usize> = (0..time.len()).filter(|&row| residual[row].is_finite()).collect();
    let rms = |rows: &[usize]| {
        if rows.is_empty() {
            return 0.0;
        }
        (rows.iter().map(|&row| residual[row].powi(2)).sum::<f64>() / rows.len() as f64).sqrt()
    };
    let all = rms(&rows);
    let total = all * all * rows.len() as f64;
    let length = (rows.len() / PARTS).max(1);
    let fullest = rows
        .windows(length)
        .map(|part| (rms(part).powi(2) * part.len() as f64, part))
        .max_by(|one, other| one.0.total_cmp(&other.0));
    let span = match fullest {
        Some((square, part)) => ([time[part[0]], time[part[part.len() - 1]]], square / total.max(f64::MIN_POSITIVE)),
        None => ([f64::NAN; 2], 0.0),
    };
    let series: Vec<f64> = rows.iter().map(|&row| residual[row]).collect();
    let line = spectrum(&series, spacing)
        .into_iter()
        .max_by(|one, other| one.share.total_cmp(&other.share))
        .unwrap_or(Line { frequency: 0.0, share: 0.0 });
    let mut by_heading = rows.clone();
    by_heading.sort_by(|&one, &other| heading[one].total_cmp(&heading[other]));
    let largest = by_heading
        .chunks(rows.len().div_ceil(BANDS).max(1))
        .map(|band| ([heading[band[0]], heading[band[band.len() - 1]]], rms(band)))
        .max_by(|one, other| one.1.total_cmp(&other.1))
        .unwrap_or(([0.0; 2], 0.0));
    let on = |sign: f64| rms(&rows.iter().copied().filter(|&row| sign * rudder[row] > 0.0).collect::<Vec<_>>());
    Signature { record: number, span, line, heading: largest, side: [on(-1.0), on(1.0)], all }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_sine_is_one_line_and_far_from_white() {
        let series: Vec<f64> = (0..200).map(|k| (std::f64::consts::TAU * 0.05 * f64::from(k)).sin()).collect();
        let strongest = spectrum(&series, 2.0).into_iter().max_by(|x, y| x.share.total_cmp(&y.share)).expect("lines");
        assert!((strongest.frequency - 0.025).abs() < 1e-12 && strongest.share > 0.99);
        assert!(whiteness(&[series]).p_value < 1e-12);
    }
}
