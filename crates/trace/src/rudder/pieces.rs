//! Piecewise linear rudder of a steering gear: rests and strokes of one rate, fitted to readings with white noise.
//!
//! δ(t) = δ_k + ρ_k (t − t_k) in piece k, ρ_k = 0 in a rest. The pieces minimise Σ (δ_i − δ(t_i))²/s² + penalty, with a
//! penalty of 2 log n for a rest and 3 log n for a stroke (optimal partitioning with pruning; Jackson et al. 2005,
//! Killick et al. 2012; penalties as Schwarz 1978). Levels of rests, and rates of strokes, that do not differ
//! significantly are pooled; a stroke meets a rest at the intersection of their lines.

/// Minimum number of readings of a stroke.
const MIN_STROKE_ROWS: usize = 3;

/// Maximum shift of an end to the intersection with the next piece, rows; pieces of less than twice as many rows keep
/// their ends.
const MAX_SHIFT_ROWS: usize = 2;

/// Maximum number of iterations of ends and pooled rates.
const MAX_ROUNDS: usize = 3;

/// Segment of a recorded rudder: a rest (constant angle) or a stroke (constant rate).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RudderPiece {
    /// First row.
    pub from_row: usize,
    /// Index after the last row.
    pub end_row: usize,
    /// Mean time of the rows, s.
    time: f64,
    /// Angle at that time, rad.
    angle: f64,
    /// Rate, rad/s.
    rate: f64,
    /// Σ (t − t_k)², s².
    spread: f64,
    /// `true` if the rudder moves.
    pub is_stroke: bool,
}

impl RudderPiece {
    /// Number of rows.
    pub fn rows(&self) -> usize {
        self.end_row - self.from_row
    }

    /// Angle at a time, rad.
    pub fn angle_at(&self, time: f64) -> f64 {
        self.angle + self.rate * (time - self.time)
    }

    /// Least-squares line through the rows `from` to `to`, the last excluded; of rate 0 for a rest.
    fn fit(time: &[f64], angle: &[f64], from: usize, to: usize, is_stroke: bool) -> Self {
        let rows = (to - from) as f64;
        let mean = |values: &[f64]| values[from..to].iter().sum::<f64>() / rows;
        let (at, level) = (mean(time), mean(angle));
        let pairs = || time[from..to].iter().zip(&angle[from..to]);
        let spread: f64 = pairs().map(|(t, _)| (t - at).powi(2)).sum();
        let product: f64 = pairs().map(|(t, delta)| (t - at) * (delta - level)).sum();
        let rate = if is_stroke { product / spread } else { 0.0 };
        Self { from_row: from, end_row: to, time: at, angle: level, rate, spread, is_stroke }
    }
}

/// Sums over all rows before a row: t, t², y, t y and y², with the time t since the first row (s) and the change y of
/// the angle since the first row, in standard deviations of a reading.
type PieceSums = [f64; 5];

/// Residual sums of squares of a level and of a line for the rows between two sums.
fn residual_squares(from: &PieceSums, to: &PieceSums, rows: f64) -> [f64; 2] {
    let [t, tt, y, ty, yy] = std::array::from_fn(|k| to[k] - from[k]);
    let (level, spread, product) = (yy - y * y / rows, tt - t * t / rows, ty - t * y / rows);
    let line = if spread > 0.0 { level - product * product / spread } else { level };
    [level.max(0.0), line.max(0.0)]
}

/// Partition of least squares plus penalty: first row, index after the last row, and `true` for a stroke.
fn partition(time: &[f64], angle: &[f64], sd: f64) -> Vec<(usize, usize, bool)> {
    let rows = time.len();
    let penalty = (rows as f64).ln();
    let mut sums: Vec<PieceSums> = vec![[0.0; 5]];
    for (t, y) in time.iter().map(|t| t - time[0]).zip(angle.iter().map(|y| (y - angle[0]) / sd)) {
        let last = sums[sums.len() - 1];
        let row = [t, t * t, y, t * y, y * y];
        sums.push(std::array::from_fn(|k| last[k] + row[k]));
    }
    let mut best = vec![(0.0, 0, false)];
    let mut open: Vec<usize> = Vec::new();
    for end in 1..=rows {
        open.push(end - 1);
        let squares: Vec<[f64; 2]> =
            open.iter().map(|&from| residual_squares(&sums[from], &sums[end], (end - from) as f64)).collect();
        let mut lowest = (f64::INFINITY, 0, false);
        for (&from, [level, line]) in open.iter().zip(&squares) {
            let level = best[from].0 + level + 2.0 * penalty;
            let stroke = best[from].0 + line + 3.0 * penalty;
            if level < lowest.0 {
                lowest = (level, from, false);
            }
            if end - from >= MIN_STROKE_ROWS && stroke < lowest.0 {
                lowest = (stroke, from, true);
            }
        }
        best.push(lowest);
        // A start whose cost without the penalty of its last piece is not below the minimum never becomes the best.
        let mut squares = squares.into_iter();
        open.retain(|&from| squares.next().is_some_and(|[_, line]| best[from].0 + line < lowest.0));
    }
    let mut pieces = Vec::new();
    let mut end = rows;
    while end > 0 {
        let (_, from, is_stroke) = best[end];
        pieces.push((from, end, is_stroke));
        end = from;
    }
    pieces.reverse();
    pieces
}

/// Values pooled to their weighted mean if they do not differ significantly; weights are inverse variances.
fn pooled(values: &[(f64, f64)], penalty: f64) -> Vec<f64> {
    let mut order: Vec<usize> = (0..values.len()).collect();
    order.sort_by(|&a, &b| values[a].0.total_cmp(&values[b].0));
    let mut groups: Vec<(f64, f64, Vec<usize>)> = order.iter().map(|&k| (values[k].0, values[k].1, vec![k])).collect();
    loop {
        let distance = |pair: &[(f64, f64, Vec<usize>)]| {
            (pair[1].0 - pair[0].0).powi(2) * pair[0].1 * pair[1].1 / (pair[0].1 + pair[1].1)
        };
        let nearest = groups.windows(2).map(distance).enumerate().min_by(|a, b| a.1.total_cmp(&b.1));
        let Some((place, _)) = nearest.filter(|(_, distance)| *distance < penalty) else { break };
        let (value, weight, members) = groups.remove(place + 1);
        let into = &mut groups[place];
        into.0 = (into.0 * into.1 + value * weight) / (into.1 + weight);
        into.1 += weight;
        into.2.extend(members);
    }
    let mut pooled = vec![0.0; values.len()];
    groups.iter().for_each(|(value, _, members)| members.iter().for_each(|&k| pooled[k] = *value));
    pooled
}

/// Pools levels of rests, and rates of strokes without their signs, that do not differ significantly; `sd` is that of a
/// reading, rad.
fn pool_gear(pieces: &mut [RudderPiece], sd: f64, penalty: f64) {
    let weight = 1.0 / (sd * sd);
    let rests: Vec<usize> = (0..pieces.len()).filter(|&k| !pieces[k].is_stroke && pieces[k].rows() > 1).collect();
    let levels: Vec<(f64, f64)> = rests.iter().map(|&k| (pieces[k].angle, pieces[k].rows() as f64 * weight)).collect();
    rests.iter().zip(pooled(&levels, penalty)).for_each(|(&k, level)| pieces[k].angle = level);
    let strokes: Vec<usize> = (0..pieces.len()).filter(|&k| pieces[k].is_stroke).collect();
    let rates: Vec<(f64, f64)> = strokes.iter().map(|&k| (pieces[k].rate.abs(), pieces[k].spread * weight)).collect();
    for (&k, rate) in strokes.iter().zip(pooled(&rates, penalty)) {
        pieces[k].rate = rate.copysign(pieces[k].rate);
    }
}

/// Row at which a piece ends and the next begins: the intersection of their lines, if it is near the old end.
fn intersection(time: &[f64], piece: &RudderPiece, next: &RudderPiece) -> usize {
    let bend = piece.rate - next.rate;
    let near = 2 * MAX_SHIFT_ROWS;
    if piece.is_stroke == next.is_stroke || piece.rows() < near || next.rows() < near {
        return piece.end_row;
    }
    let end = time[piece.end_row];
    let row = time.partition_point(|t| *t < end + (next.angle_at(end) - piece.angle_at(end)) / bend);
    if row.abs_diff(piece.end_row) <= MAX_SHIFT_ROWS { row } else { piece.end_row }
}

/// Pieces of a rudder (s, rad) with measurement noise of standard deviation `sd`, rad.
pub fn pieces(time: &[f64], angle: &[f64], sd: f64) -> Vec<RudderPiece> {
    let mut parts = partition(time, angle, sd);
    let penalty = (time.len() as f64).ln();
    for round in 0.. {
        let mut all: Vec<RudderPiece> =
            parts.iter().map(|&(from, to, is_stroke)| RudderPiece::fit(time, angle, from, to, is_stroke)).collect();
        pool_gear(&mut all, sd, penalty);
        let ends: Vec<usize> = all.windows(2).map(|pair| intersection(time, &pair[0], &pair[1])).collect();
        let is_settled = ends.iter().zip(&parts).all(|(end, part)| *end == part.1);
        if is_settled || round == MAX_ROUNDS {
            return all;
        }
        for (k, end) in ends.into_iter().enumerate() {
            (parts[k].1, parts[k + 1].0) = (end, end);
        }
    }
    unreachable!("the last round returns")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::{noisy, strokes};

    #[test]
    fn rests_and_strokes_are_those_of_the_gear() {
        let (time, clean) = strokes(400);
        let read = noisy(&clean, 0.3);
        let fitted = pieces(&time, &read, 0.3_f64.to_radians());
        let rates: Vec<f64> = fitted.iter().filter(|piece| piece.is_stroke).map(|piece| piece.rate.abs()).collect();
        let is_near = |rate: &f64| (rate.to_degrees() - 2.5).abs() < 0.1;
        assert!(rates.len() > 5 && rates.iter().all(is_near), "{rates:?}");
        let mut distinct = rates.clone();
        distinct.sort_by(f64::total_cmp);
        distinct.dedup();
        assert!(distinct.len() < 3, "{distinct:?}");
        let path = fitted.iter().flat_map(|p| time[p.from_row..p.end_row].iter().map(|t| p.angle_at(*t)));
        let left = |values: &mut dyn Iterator<Item = f64>| -> f64 {
            values.zip(&clean).map(|(value, clean)| (value - clean).powi(2)).sum::<f64>().sqrt()
        };
        assert!(left(&mut path.into_iter()) < 0.25 * left(&mut read.iter().copied()));
    }

    #[test]
    fn values_that_do_not_differ_significantly_are_pooled() {
        let mean = pooled(&[(1.0, 4.0), (3.0, 4.0), (1.1, 4.0)], 2.0);
        assert_eq!((mean[0], mean[0], mean[1]), (mean[2], 0.5 * (1.0 + 1.1), 3.0));
    }

    /// A jump is no stroke, and a single deviating reading is kept.
    #[test]
    fn a_helm_that_jumps_has_rests_alone() {
        let time: Vec<f64> = (0..60).map(f64::from).collect();
        let angle: Vec<f64> = (0..60).map(|row| if row == 31 { 0.2 } else { 0.1 * f64::from(row / 20) }).collect();
        let fitted = pieces(&time, &angle, 0.003);
        assert!(fitted.iter().all(|piece| !piece.is_stroke), "{fitted:?}");
        let path = fitted.iter().flat_map(|p| time[p.from_row..p.end_row].iter().map(|t| p.angle_at(*t)));
        assert!(path.zip(&angle).all(|(path, angle)| (path - angle).abs() < 1e-12));
    }
}
