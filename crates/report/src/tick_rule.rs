//! Rule by which an axis places its ticks.

/// Rule by which an axis places its ticks.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum TickRule {
    /// Equal steps of 1, 2 or 5 times a power of ten.
    #[default]
    Decimal,
    /// Degrees: multiples of 30° or 90° over a wide range.
    Angle,
    /// Seconds, in multiples of 30 s or 60 s over a long time; no free space at the ends.
    Time,
    /// Equal factors (a logarithmic scale). Zero has a separate place before a break, and negative values are omitted.
    Logarithmic,
    /// From 0 to 100 %, whatever the data.
    Percent,
}

impl TickRule {
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
