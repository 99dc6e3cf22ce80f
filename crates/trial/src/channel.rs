//! The quantities a record can hold beside time, each with the column names and units it is known by. A column name is
//! `quantity_unit`; this module knows both halves and the factor to SI units, and nothing of files.

use ship::angle::{DEGREE, KNOT};
use ship::particulars::Dimension;

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

/// A unit that can end a column name.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Unit {
    /// `s`
    Second,
    /// `ms`
    Millisecond,
    /// `min`
    Minute,
    /// `deg`
    Degree,
    /// `rad`
    Radian,
    /// `deg_s`
    DegreePerSecond,
    /// `deg_min`, the unit of rate-of-turn indicators.
    DegreePerMinute,
    /// `rad_s`
    RadianPerSecond,
    /// `m_s`
    MetrePerSecond,
    /// `kn`
    Knot,
    /// `m`
    Metre,
    /// `rps`, revolutions per second.
    PerSecond,
    /// `rpm`, revolutions per minute.
    PerMinute,
}

impl Unit {
    /// The unit as it ends a column name.
    pub fn id(self) -> &'static str {
        match self {
            Unit::Second => "s",
            Unit::Millisecond => "ms",
            Unit::Minute => "min",
            Unit::Degree => "deg",
            Unit::Radian => "rad",
            Unit::DegreePerSecond => "deg_s",
            Unit::DegreePerMinute => "deg_min",
            Unit::RadianPerSecond => "rad_s",
            Unit::MetrePerSecond => "m_s",
            Unit::Knot => "kn",
            Unit::Metre => "m",
            Unit::PerSecond => "rps",
            Unit::PerMinute => "rpm",
        }
    }

    /// The unit in words, for messages.
    pub fn spoken(self) -> &'static str {
        match self {
            Unit::Second => "seconds",
            Unit::Millisecond => "milliseconds",
            Unit::Minute => "minutes",
            Unit::Degree => "degrees",
            Unit::Radian => "radians",
            Unit::DegreePerSecond => "degrees per second",
            Unit::DegreePerMinute => "degrees per minute",
            Unit::RadianPerSecond => "radians per second",
            Unit::MetrePerSecond => "metres per second",
            Unit::Knot => "knots",
            Unit::Metre => "metres",
            Unit::PerSecond => "revolutions per second",
            Unit::PerMinute => "revolutions per minute",
        }
    }

    /// What a number in this unit is multiplied with to be in SI units and radians.
    pub fn to_si(self) -> f64 {
        match self {
            Unit::Second
            | Unit::Radian
            | Unit::RadianPerSecond
            | Unit::MetrePerSecond
            | Unit::Metre
            | Unit::PerSecond => 1.0,
            Unit::Millisecond => 1e-3,
            Unit::Minute => 60.0,
            Unit::Degree | Unit::DegreePerSecond => DEGREE,
            Unit::DegreePerMinute => DEGREE / 60.0,
            Unit::Knot => KNOT,
            Unit::PerMinute => 1.0 / 60.0,
        }
    }
}

/// Column name of time in files this crate writes.
pub const TIME_COLUMN: &str = "t_s";

const TIMES: [Unit; 3] = [Unit::Second, Unit::Millisecond, Unit::Minute];
const ANGLES: [Unit; 2] = [Unit::Degree, Unit::Radian];
const ANGULAR_RATES: [Unit; 3] = [Unit::DegreePerSecond, Unit::RadianPerSecond, Unit::DegreePerMinute];
const SPEEDS: [Unit; 2] = [Unit::MetrePerSecond, Unit::Knot];
const LENGTHS: [Unit; 1] = [Unit::Metre];
const REVOLUTIONS: [Unit; 2] = [Unit::PerSecond, Unit::PerMinute];

impl Channel {
    /// Every channel, in the order in which files are written.
    pub const ALL: [Channel; 15] = [
        Channel::Heading,
        Channel::Rudder,
        Channel::RudderOrder,
        Channel::YawRate,
        Channel::Speed,
        Channel::Surge,
        Channel::Sway,
        Channel::North,
        Channel::East,
        Channel::Roll,
        Channel::PropellerRate,
        Channel::WindRelativeSpeed,
        Channel::WindRelativeFrom,
        Channel::WindTrueSpeed,
        Channel::WindTrueFrom,
    ];

    /// Exponents of second and metre in the unit; angles have none.
    pub fn dimension(self) -> Dimension {
        match self {
            Channel::Heading
            | Channel::Rudder
            | Channel::RudderOrder
            | Channel::Roll
            | Channel::WindRelativeFrom
            | Channel::WindTrueFrom => [0, 0],
            Channel::YawRate | Channel::PropellerRate => [-1, 0],
            Channel::Speed | Channel::Surge | Channel::Sway | Channel::WindRelativeSpeed | Channel::WindTrueSpeed => {
                [-1, 1]
            }
            Channel::North | Channel::East => [0, 1],
        }
    }

    /// The quantity as it begins a column name.
    pub fn quantity(self) -> &'static str {
        match self {
            Channel::Heading => "heading",
            Channel::Rudder => "rudder",
            Channel::RudderOrder => "rudder_order",
            Channel::YawRate => "yaw_rate",
            Channel::Speed => "speed",
            Channel::Surge => "surge",
            Channel::Sway => "sway",
            Channel::North => "north",
            Channel::East => "east",
            Channel::Roll => "roll",
            Channel::PropellerRate => "propeller",
            Channel::WindRelativeSpeed => "wind_relative_speed",
            Channel::WindRelativeFrom => "wind_relative_from",
            Channel::WindTrueSpeed => "wind_true_speed",
            Channel::WindTrueFrom => "wind_true_from",
        }
    }

    /// The units a column of this channel may have; the first is the one files are written in.
    pub fn units(self) -> &'static [Unit] {
        match self {
            Channel::Heading
            | Channel::Rudder
            | Channel::RudderOrder
            | Channel::Roll
            | Channel::WindRelativeFrom
            | Channel::WindTrueFrom => &ANGLES,
            Channel::YawRate => &ANGULAR_RATES,
            Channel::Speed | Channel::Surge | Channel::Sway | Channel::WindRelativeSpeed | Channel::WindTrueSpeed => {
                &SPEEDS
            }
            Channel::North | Channel::East => &LENGTHS,
            Channel::PropellerRate => &REVOLUTIONS,
        }
    }

    /// The unit this channel is written in.
    pub fn written_unit(self) -> Unit {
        self.units()[0]
    }

    /// The column name this channel is written under, for example `heading_deg`.
    pub fn column_name(self) -> String {
        format!("{}_{}", self.quantity(), self.written_unit().id())
    }

    /// Every column name this channel is read from, for messages: `heading_deg or heading_rad`.
    pub fn accepted_names(self) -> String {
        let names: Vec<String> = self.units().iter().map(|unit| format!("{}_{}", self.quantity(), unit.id())).collect();
        names.join(" or ")
    }
}

/// The channel and unit a column name stands for; `None` for a name that is not known and for time.
///
/// Blanks around the name and the case of its letters do not matter.
pub fn column(name: &str) -> Option<(Channel, Unit)> {
    let name = name.trim().to_ascii_lowercase();
    Channel::ALL.into_iter().find_map(|channel| {
        let suffix = name.strip_prefix(channel.quantity())?.strip_prefix('_')?;
        let unit = channel.units().iter().find(|unit| unit.id() == suffix)?;
        Some((channel, *unit))
    })
}

/// The unit of a column that holds time (`t_s`, `t_ms`, `t_min`); `None` for any other name.
pub fn time_column(name: &str) -> Option<Unit> {
    let name = name.trim().to_ascii_lowercase();
    let suffix = name.strip_prefix("t_")?;
    TIMES.into_iter().find(|unit| unit.id() == suffix)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_name_of_the_contract_is_known() {
        let expected = [
            ("heading_deg", Channel::Heading, Unit::Degree),
            ("heading_rad", Channel::Heading, Unit::Radian),
            ("rudder_deg", Channel::Rudder, Unit::Degree),
            ("rudder_rad", Channel::Rudder, Unit::Radian),
            ("rudder_order_deg", Channel::RudderOrder, Unit::Degree),
            ("yaw_rate_deg_s", Channel::YawRate, Unit::DegreePerSecond),
            ("yaw_rate_rad_s", Channel::YawRate, Unit::RadianPerSecond),
            ("speed_m_s", Channel::Speed, Unit::MetrePerSecond),
            ("speed_kn", Channel::Speed, Unit::Knot),
            ("surge_m_s", Channel::Surge, Unit::MetrePerSecond),
            ("sway_m_s", Channel::Sway, Unit::MetrePerSecond),
            ("north_m", Channel::North, Unit::Metre),
            ("east_m", Channel::East, Unit::Metre),
            ("roll_deg", Channel::Roll, Unit::Degree),
            ("propeller_rps", Channel::PropellerRate, Unit::PerSecond),
            ("propeller_rpm", Channel::PropellerRate, Unit::PerMinute),
            ("wind_relative_speed_m_s", Channel::WindRelativeSpeed, Unit::MetrePerSecond),
            ("wind_relative_from_deg", Channel::WindRelativeFrom, Unit::Degree),
            ("wind_true_speed_m_s", Channel::WindTrueSpeed, Unit::MetrePerSecond),
            ("wind_true_from_deg", Channel::WindTrueFrom, Unit::Degree),
        ];
        for (name, channel, unit) in expected {
            assert_eq!(column(name), Some((channel, unit)), "{name}");
        }
        assert_eq!(time_column("t_s"), Some(Unit::Second));
        assert_eq!(column("t_s"), None);
    }

    #[test]
    fn written_names_are_read_back_and_all_channels_are_listed_once() {
        for (place, channel) in Channel::ALL.into_iter().enumerate() {
            assert_eq!(column(&channel.column_name()), Some((channel, channel.written_unit())));
            assert!(!Channel::ALL[..place].contains(&channel));
        }
    }

    #[test]
    fn names_that_are_not_known_stay_unknown() {
        for name in ["", "heading", "heading_m", "roll_rate_deg_s", "deg", "rudder_order", "heading_deg_s", "t", "T_h"]
        {
            assert_eq!(column(name), None, "{name}");
            assert_eq!(time_column(name), None, "{name}");
        }
        assert_eq!(column(" Heading_DEG "), Some((Channel::Heading, Unit::Degree)));
    }

    #[test]
    fn factors_lead_to_si_units() {
        approx::assert_relative_eq!(180.0 * Unit::Degree.to_si(), std::f64::consts::PI);
        // 15.5 knots are 7.974 m/s (1852 m in 3600 s).
        approx::assert_relative_eq!(15.5 * Unit::Knot.to_si(), 7.973_888_888_888_89, max_relative = 1e-14);
        approx::assert_relative_eq!(60.0 * Unit::DegreePerMinute.to_si(), Unit::DegreePerSecond.to_si());
        assert_eq!(90.0 * Unit::PerMinute.to_si(), 1.5);
    }
}
