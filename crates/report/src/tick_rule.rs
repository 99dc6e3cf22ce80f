//! Division of an axis by its ticks.

/// Division of an axis.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Division {
    /// Equal steps of 1, 2 or 5 times a power of ten.
    #[default]
    Decimal,
    /// Degrees.
    Angle,
    /// Seconds and minutes, without free space at the ends.
    Time,
    /// Equal factors; zero has a separate place beyond a break, and negative values are omitted.
    Factors,
    /// From 0 to 100 %, whatever the data.
    Percent,
}

impl Division {
    /// Unit of the ticks over a span: one, 30° or 30 s, 90° or 60 s.
    pub(crate) fn unit(self, span: f64) -> f64 {
        match (self, span) {
            (Self::Time, 1e3..) => 60.0,
            (Self::Angle, 400.0..) => 90.0,
            (Self::Time | Self::Angle, 100.0..) => 30.0,
            _ => 1.0,
        }
    }
}
