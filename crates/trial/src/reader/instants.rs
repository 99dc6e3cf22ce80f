//! Instants of rows that share a coarse time stamp, such as ten rows per second with stamps of whole seconds.

use estimation::statistics::upper_median;

/// Spreads rows with a shared stamp evenly over the time to the next stamp. Returns the typical number of rows per
/// stamp; `None` for fewer than three stamps, which are unchanged, and if at most a single pair of rows shares a stamp.
///
/// `time` (s) does not decrease. The width of a stamp is the usual step between two stamps, so that gaps stay gaps. The
/// first and the last stamp may be incomplete: their rows fill the end and the beginning of their width.
pub(super) fn spread_shared_stamps(time: &mut [f64]) -> Option<usize> {
    let mut begins: Vec<usize> = (0..time.len()).filter(|&row| row == 0 || time[row] != time[row - 1]).collect();
    if begins.len() == time.len() || begins.len() < 3 {
        return None;
    }
    begins.push(time.len());
    let steps = begins.windows(2).filter(|pair| pair[1] < time.len()).map(|pair| time[pair[1]] - time[pair[0]]);
    let width = upper_median(steps)?;
    let inner = begins[1..begins.len() - 1].windows(2).map(|pair| (pair[1] - pair[0]) as f64);
    let usual = upper_median(inner)? as usize;
    let last = begins.len() - 2;
    for (number, pair) in begins.windows(2).enumerate() {
        let rows = pair[1] - pair[0];
        let whole = if number == 0 || number == last { rows.max(usual) } else { rows };
        let before = if number == 0 { whole - rows } else { 0 };
        let stamp = time[pair[0]];
        for (row, instant) in time[pair[0]..pair[1]].iter_mut().enumerate() {
            *instant = stamp + width * (before + row) as f64 / whole as f64;
        }
    }
    (usual > 1 || begins.len() < time.len()).then_some(usual)
}

#[cfg(test)]
mod tests {
    use super::spread_shared_stamps;

    #[test]
    fn rows_of_one_second_are_spread_over_it() {
        let mut time = [0.0, 0.0, 1.0, 1.0, 1.0, 1.0, 2.0, 2.0, 2.0, 2.0, 5.0, 5.0, 5.0, 5.0, 6.0];
        assert_eq!(spread_shared_stamps(&mut time), Some(4));
        assert_eq!(time, [0.5, 0.75, 1.0, 1.25, 1.5, 1.75, 2.0, 2.25, 2.5, 2.75, 5.0, 5.25, 5.5, 5.75, 6.0]);
        let mut single = [0.0, 1.0, 2.0, 3.5];
        assert_eq!(spread_shared_stamps(&mut single), None);
        assert_eq!(spread_shared_stamps(&mut []), None);
        assert_eq!(spread_shared_stamps(&mut [1.0; 9]), None);
    }
}
