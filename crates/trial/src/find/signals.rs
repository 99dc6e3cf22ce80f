//! What a search looks at.

/// The channels that a search looks at, row by row, in SI units and radians.
///
/// All have the length of `time`. Time increases strictly; its spacing may be uneven and have gaps.
#[derive(Debug, Clone, Copy)]
pub struct Signals<'a> {
    /// Time, s.
    pub time: &'a [f64],
    /// Rudder angle or order, rad; finite in every row.
    pub rudder: &'a [f64],
    /// Heading, rad, unwrapped; NaN where it was not read.
    pub heading: &'a [f64],
    /// Speed, m/s.
    pub speed: Option<&'a [f64]>,
    /// Revolutions of the propeller, any unit.
    pub propeller: Option<&'a [f64]>,
}

impl Signals<'_> {
    /// Whether the channels are as documented: a search in anything else finds nothing.
    pub(crate) fn is_sound(&self) -> bool {
        let rows = self.time.len();
        self.rudder.len() == rows
            && self.heading.len() == rows
            && self.time.iter().all(|t| t.is_finite())
            && self.time.windows(2).all(|pair| pair[0] < pair[1])
            && self.rudder.iter().all(|delta| delta.is_finite())
    }
}
