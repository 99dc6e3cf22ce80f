//! Length and speed of a ship.

/// Length and speed, the two numbers every nondimensional index needs.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Particulars {
    /// Length between perpendiculars L, m.
    pub length: f64,
    /// Approach speed V, m/s.
    pub speed: f64,
}
