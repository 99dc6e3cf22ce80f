//! Rule by which an axis places its ticks.

/// Rule by which an axis places its ticks.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum TickRule {
    /// Equal steps of 1, 2 or 5 times a power of ten.
    #[default]
    Decimal,
    /// Degrees: the decimal steps are in units of 30° over 100° or more, and of 90° over 400° or more.
    Angle,
    /// Seconds: the decimal steps are in units of 30 s over 100 s or more, and of 60 s over 1000 s or more; no free
    /// space at the ends.
    Time,
    /// Equal factors (a logarithmic scale). Zero has a separate place before a break, and negative values are omitted.
    Logarithmic,
    /// From 0 to 100 %, whatever the data.
    Percent,
}

impl TickRule {
    /// Unit of the steps of the ticks over a span: 1, 30 (degrees or seconds), 60 (seconds) or 90 (degrees).
    pub(crate) fn unit(self, span: f64) -> f64 {
        match (self, span) {
            (Self::Time, 1e3..) => 60.0,
            (Self::Angle, 400.0..) => 90.0,
            (Self::Time | Self::Angle, 100.0..) => 30.0,
            _ => 1.0,
        }
    }
}
