//! Peak of a residual within a record: in time, frequency, heading and side of the rudder.

use estimation::residuals::{GappedSeries, SpectralLine, periodogram};

/// Peak of the residual of a record: time span, frequency, headings and rudder side at which it is largest.
#[derive(Debug, Clone, PartialEq)]
pub struct ResidualPeak {
    /// Index of the record.
    pub record_index: usize,
    /// First and last time (s) of the eighth of the rows with the largest sum of squares, and its share of the total.
    pub span_and_share: ([f64; 2], f64),
    /// Strongest line of the spectrum; `None` for fewer than four headings, or if nearly all of the record is gaps.
    pub spectral_line: Option<SpectralLine>,
    /// Heading range (rad) of the quarter of the rows, sorted by heading, with the largest root mean square, and this
    /// root mean square, rad.
    pub heading_range_and_rms: ([f64; 2], f64),
    /// Root mean square with the rudder to port and to starboard, rad.
    pub side_rms: [f64; 2],
    /// Root mean square over the record, rad.
    pub rms: f64,
}

/// Number of rows of a record over the number of rows of a window.
const WINDOWS_PER_RECORD: usize = 8;

/// Number of bands of headings, with equally many rows each.
const HEADING_BANDS: usize = 4;

/// Peak of the residual (rad) of one record: time (s), residual, heading and rudder (rad) by row, `spacing` in s.
pub fn residual_peak(
    record_index: usize,
    time: &[f64],
    residual: &[f64],
    heading: &[f64],
    rudder: &[f64],
    spacing: f64,
) -> ResidualPeak {
    let rows: Vec<usize> = (0..time.len()).filter(|&row| residual[row].is_finite()).collect();
    let rms = |rows: &[usize]| {
        if rows.is_empty() {
            return 0.0;
        }
        (rows.iter().map(|&row| residual[row].powi(2)).sum::<f64>() / rows.len() as f64).sqrt()
    };
    let whole = rms(&rows);
    let total = whole * whole * rows.len() as f64;
    let length = (rows.len() / WINDOWS_PER_RECORD).max(1);
    // Cumulative Σ e², so that a window is a difference of two sums.
    let mut sums = vec![0.0];
    sums.extend(rows.iter().scan(0.0, |sum, &row| {
        *sum += residual[row].powi(2);
        Some(*sum)
    }));
    let fullest = rows
        .windows(length)
        .enumerate()
        .max_by(|(a, _), (b, _)| (sums[a + length] - sums[*a]).total_cmp(&(sums[b + length] - sums[*b])))
        .map(|(_, part)| (rms(part).powi(2) * part.len() as f64, part));
    let span = match fullest {
        Some((square, part)) => ([time[part[0]], time[part[part.len() - 1]]], square / total.max(f64::MIN_POSITIVE)),
        None => ([f64::NAN; 2], 0.0),
    };
    let series = GappedSeries::new(time, residual, spacing);
    let line = periodogram(&series).into_iter().max_by(|a, b| a.mean_square_share.total_cmp(&b.mean_square_share));
    let mut by_heading = rows.clone();
    by_heading.sort_by(|&a, &b| heading[a].total_cmp(&heading[b]));
    let largest = by_heading
        .chunks(rows.len().div_ceil(HEADING_BANDS).max(1))
        .map(|band| ([heading[band[0]], heading[band[band.len() - 1]]], rms(band)))
        .max_by(|a, b| a.1.total_cmp(&b.1))
        .unwrap_or(([0.0; 2], 0.0));
    let on = |sign: f64| rms(&rows.iter().copied().filter(|&row| sign * rudder[row] > 0.0).collect::<Vec<_>>());
    ResidualPeak {
        record_index,
        span_and_share: span,
        spectral_line: line,
        heading_range_and_rms: largest,
        side_rms: [on(-1.0), on(1.0)],
        rms: whole,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The window is also found in a record too long to sum every window separately.
    #[test]
    fn the_fullest_part_of_a_long_record_is_found() {
        let rows = 400_000;
        let time: Vec<f64> = (0..rows).map(f64::from).collect();
        let residual: Vec<f64> = (0..rows).map(|k| if (100_000..150_000).contains(&k) { 2.0 } else { 1.0 }).collect();
        let peak = residual_peak(0, &time, &residual, &time, &time, 1.0);
        assert_eq!(peak.span_and_share.0, [100_000.0, 149_999.0]);
        assert!((peak.span_and_share.1 - 200.0 / 550.0).abs() < 1e-9);
    }
}
