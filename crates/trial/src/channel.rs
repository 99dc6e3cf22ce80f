//! The quantities a record can hold beside time, each with the column names and units it is known by.

/// A quantity of a record. Inside, every channel is in SI units and radians.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Channel {
    /// Heading ψ, rad, clockwise, unwrapped.
    Heading,
    /// Rudder angle δ, rad, positive turns to starboard.
    Rudder,
    /// Ordered rudder angle, rad.
    RudderOrder,
    /// Yaw rate r, rad/s.
    YawRate,
    /// Speed, m/s.
    Speed,
    /// Surge velocity, m/s, forward.
    Surge,
    /// Sway velocity, m/s, to starboard.
    Sway,
    /// Position north, m.
    North,
    /// Position east, m.
    East,
    /// Roll angle, rad.
    Roll,
    /// Propeller revolutions, 1/s.
    PropellerRate,
    /// Relative wind speed, m/s.
    WindRelativeSpeed,
    /// Direction the relative wind comes from, clockwise from the bow, rad.
    WindRelativeFrom,
    /// True wind speed, m/s.
    WindTrueSpeed,
    /// Direction the true wind comes from, rad.
    WindTrueFrom,
}
