//! Geometry of a line before it is drawn: cut at the frame, thinned to what can be seen. Points are in points on the
//! page, y downwards.

/// A place on the page, points from the upper left corner.
pub(crate) type PagePoint = (f64, f64);

/// A rectangle on the page.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Rect {
    pub x: f64,
    pub y: f64,
    pub w: f64,
    pub h: f64,
}

impl Rect {
    pub(crate) fn right(&self) -> f64 {
        self.x + self.w
    }

    pub(crate) fn bottom(&self) -> f64 {
        self.y + self.h
    }

    pub(crate) fn contains(&self, (x, y): PagePoint) -> bool {
        // A point on the frame is inside, whatever the last bit says.
        let slack = 1e-6;
        x >= self.x - slack && x <= self.right() + slack && y >= self.y - slack && y <= self.bottom() + slack
    }
}

/// The parts of a polyline inside `rect`; `None` in the input is a gap.
pub(crate) fn clip(line: impl IntoIterator<Item = Option<PagePoint>>, rect: &Rect) -> Vec<Vec<PagePoint>> {
    let mut parts: Vec<Vec<PagePoint>> = Vec::new();
    let mut current: Vec<PagePoint> = Vec::new();
    let mut previous: Option<PagePoint> = None;
    for place in line {
        if let (Some(from), Some(to)) = (previous, place) {
            match segment(from, to, rect) {
                Some((a, b)) => {
                    if current.last() != Some(&a) {
                        finish(&mut parts, &mut current);
                        current.push(a);
                    }
                    current.push(b);
                }
                None => finish(&mut parts, &mut current),
            }
        } else if place.is_none() {
            finish(&mut parts, &mut current);
        }
        previous = place;
    }
    finish(&mut parts, &mut current);
    parts
}

fn finish(parts: &mut Vec<Vec<PagePoint>>, current: &mut Vec<PagePoint>) {
    if current.len() > 1 {
        parts.push(std::mem::take(current));
    }
    current.clear();
}

/// The part of a segment inside `rect` (Liang & Barsky 1984).
fn segment((x0, y0): PagePoint, (x1, y1): PagePoint, rect: &Rect) -> Option<(PagePoint, PagePoint)> {
    let (dx, dy) = (x1 - x0, y1 - y0);
    let (mut enter, mut leave) = (0.0_f64, 1.0_f64);
    for (p, q) in [(-dx, x0 - rect.x), (dx, rect.right() - x0), (-dy, y0 - rect.y), (dy, rect.bottom() - y0)] {
        if p == 0.0 {
            if q < 0.0 {
                return None;
            }
        } else if p < 0.0 {
            enter = enter.max(q / p);
        } else {
            leave = leave.min(q / p);
        }
    }
    if enter > leave {
        return None;
    }
    // Ends inside the frame are kept to the bit, so that neighbouring segments join.
    let at = |s: f64| (x0 + s * dx, y0 + s * dy);
    Some((if enter == 0.0 { (x0, y0) } else { at(enter) }, if leave == 1.0 { (x1, y1) } else { at(leave) }))
}

/// Keeps of every run of points within one `column` (in points) only first, lowest, highest and last: a record of a
/// hundred thousand samples looks the same and draws as fast as one of a thousand.
pub(crate) fn thin(line: Vec<PagePoint>, column: f64) -> Vec<PagePoint> {
    const WORTH_IT: usize = 400;
    if line.len() < WORTH_IT {
        return line;
    }
    let mut kept = Vec::with_capacity(WORTH_IT);
    let mut start = 0;
    while start < line.len() {
        let cell = (line[start].0 / column).floor();
        let run = line[start..].iter().take_while(|p| (p.0 / column).floor() == cell).count();
        let last = start + run - 1;
        let extreme = |sign: f64| {
            (start..=last)
                .max_by(|a, b| (sign * line[*a].1).total_cmp(&(sign * line[*b].1)))
                .expect("a run has at least one point")
        };
        let mut indices = [start, extreme(1.0), extreme(-1.0), last];
        indices.sort_unstable();
        for (i, index) in indices.iter().enumerate() {
            if i == 0 || indices[i - 1] != *index {
                kept.push(line[*index]);
            }
        }
        start = last + 1;
    }
    kept
}

#[cfg(test)]
mod tests {
    use super::*;

    const UNIT: Rect = Rect { x: 0.0, y: 0.0, w: 10.0, h: 10.0 };

    #[test]
    fn lines_are_cut_at_the_frame_and_at_gaps() {
        let line = [(-5.0, 5.0), (5.0, 5.0), (5.0, 25.0), (8.0, 25.0), (8.0, 5.0)].map(Some);
        let parts = clip(line, &UNIT);
        assert_eq!(parts, [vec![(0.0, 5.0), (5.0, 5.0), (5.0, 10.0)], vec![(8.0, 10.0), (8.0, 5.0)]]);
        let gap = clip([Some((1.0, 1.0)), Some((2.0, 2.0)), None, Some((3.0, 3.0)), Some((4.0, 4.0))], &UNIT);
        assert_eq!(gap.len(), 2);
        assert!(clip([Some((1.0, 1.0))], &UNIT).is_empty());
    }

    #[test]
    fn thinning_keeps_the_extremes() {
        let line: Vec<PagePoint> = (0..100_000).map(|i| (f64::from(i) * 1e-3, f64::from(i * 7919 % 1000))).collect();
        let thinned = thin(line.clone(), 0.25);
        assert!(thinned.len() <= 4 * 401);
        assert_eq!((thinned[0], thinned.last()), (line[0], line.last()));
        assert!(thinned.iter().any(|p| p.1 == 0.0) && thinned.iter().any(|p| p.1 == 999.0));
        assert!(thinned.windows(2).all(|w| w[0].0 <= w[1].0));
    }
}
