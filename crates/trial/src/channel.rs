//! Channels of a record: quantities in addition to time, each with its column names and units. A column name is
//! `quantity_unit`; this module contains both halves and the factor to SI units. Tables are read in [`crate::reader`].

use ship::angle::{DEGREE, KNOT};
use ship::particulars::Dimension;

/// Quantity of a record. In memory, every channel is in SI units and radians.
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
    /// Speed through the water, or over ground if no other was recorded, m/s.
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
    /// Direction from which the relative wind comes, clockwise from the bow, rad.
    WindRelativeFrom,
    /// True wind speed, m/s.
    WindTrueSpeed,
    /// Direction from which the true wind comes, clockwise from north, rad.
    WindTrueFrom,
}

/// Unit that can end a column name.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Unit {
    /// `s`
    Second,
    /// `ms`
    Millisecond,
    /// `us`
    Microsecond,
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
    /// `rpm`, revolutions per minute.
    RevolutionPerMinute,
    /// `rps`, revolutions per second.
    RevolutionPerSecond,
}

/// Every unit in the order of its declaration: suffix of a column name, name in messages, factor to SI units and
/// radians, and its notations in tables, in lower case without blanks.
pub(crate) const UNITS: [(Unit, &str, &str, f64, &str); 14] = [
    (Unit::Second, "s", "seconds", 1.0, "s, sec, secs, second, seconds, sek"),
    (Unit::Millisecond, "ms", "milliseconds", 1e-3, "ms, msec"),
    (Unit::Microsecond, "us", "microseconds", 1e-6, "us, µs, μs, usec"),
    (Unit::Minute, "min", "minutes", 60.0, "min, minutes"),
    (Unit::Degree, "deg", "degrees", DEGREE, "deg, degs, degree, degrees, °, º, grad"),
    (Unit::Radian, "rad", "radians", 1.0, "rad, radian, radians"),
    (Unit::DegreePerSecond, "deg_s", "degrees per second", DEGREE, "deg/s, deg/sec, °/s, º/s, degs-1, grad/s"),
    (
        Unit::DegreePerMinute,
        "deg_min",
        "degrees per minute",
        DEGREE / 60.0,
        "deg/min, °/min, º/min, degmin-1, grad/min, dpm",
    ),
    (Unit::RadianPerSecond, "rad_s", "radians per second", 1.0, "rad/s, rad/sec, rads-1"),
    (Unit::MetrePerSecond, "m_s", "metres per second", 1.0, "m/s, mps, m/sec, ms-1"),
    (Unit::Knot, "kn", "knots", KNOT, "kn, kt, kts, kns, knot, knots, knoten, sm/h, nm/h"),
    (Unit::Metre, "m", "metres", 1.0, "m, metre, metres, meter, meters"),
    (Unit::RevolutionPerMinute, "rpm", "revolutions per minute", 1.0 / 60.0, "rpm, 1/min, min-1, u/min"),
    (Unit::RevolutionPerSecond, "rps", "revolutions per second", 1.0, "rps, 1/s, s-1, hz"),
];

impl Unit {
    /// Unit as the suffix of a column name.
    pub fn id(self) -> &'static str {
        UNITS[self as usize].1
    }

    /// Name of the unit in messages.
    pub fn label(self) -> &'static str {
        UNITS[self as usize].2
    }

    /// Factor from this unit to SI units and radians.
    pub fn si_factor(self) -> f64 {
        UNITS[self as usize].3
    }
}

/// Column name of time in written files.
pub const TIME_COLUMN: &str = "t_s";

/// Units of a quantity, the unit of written files first, and its exponents of second and metre.
type Units = (&'static [Unit], Dimension);

const TIMES: [Unit; 4] = [Unit::Second, Unit::Millisecond, Unit::Microsecond, Unit::Minute];
const ANGLE: Units = (&[Unit::Degree, Unit::Radian], [0, 0]);
const RATE: Units = (&[Unit::DegreePerSecond, Unit::RadianPerSecond, Unit::DegreePerMinute], [-1, 0]);
const SPEED: Units = (&[Unit::MetrePerSecond, Unit::Knot], [-1, 1]);
const LENGTH: Units = (&[Unit::Metre], [0, 1]);
const REVOLUTIONS: Units = (&[Unit::RevolutionPerSecond, Unit::RevolutionPerMinute], [-1, 0]);

/// Every channel in the column order of written files, with the quantity of its column name and its units.
const CHANNELS: [(Channel, &str, Units); 15] = [
    (Channel::Heading, "heading", ANGLE),
    (Channel::Rudder, "rudder", ANGLE),
    (Channel::RudderOrder, "rudder_order", ANGLE),
    (Channel::YawRate, "yaw_rate", RATE),
    (Channel::Speed, "speed", SPEED),
    (Channel::Surge, "surge", SPEED),
    (Channel::Sway, "sway", SPEED),
    (Channel::North, "north", LENGTH),
    (Channel::East, "east", LENGTH),
    (Channel::Roll, "roll", ANGLE),
    (Channel::PropellerRate, "propeller", REVOLUTIONS),
    (Channel::WindRelativeSpeed, "wind_relative_speed", SPEED),
    (Channel::WindRelativeFrom, "wind_relative_from", ANGLE),
    (Channel::WindTrueSpeed, "wind_true_speed", SPEED),
    (Channel::WindTrueFrom, "wind_true_from", ANGLE),
];

impl Channel {
    /// Every channel in the column order of written files, which is the order of declaration.
    pub const ALL: [Channel; CHANNELS.len()] = {
        let mut all = [Channel::Heading; CHANNELS.len()];
        let mut index = 0;
        while index < all.len() {
            all[index] = CHANNELS[index].0;
            index += 1;
        }
        all
    };

    /// Exponents of second and metre in the unit; 0 for angles.
    pub fn dimension(self) -> Dimension {
        CHANNELS[self as usize].2.1
    }

    /// Quantity at the beginning of a column name, such as `yaw_rate`.
    pub fn quantity(self) -> &'static str {
        CHANNELS[self as usize].1
    }

    /// Name of the quantity in messages.
    pub fn label(self) -> &'static str {
        match self {
            Channel::YawRate => "yaw rate",
            Channel::Rudder => "rudder angle",
            Channel::RudderOrder => "rudder order",
            channel => channel.quantity(),
        }
    }

    /// Units of this channel in a table; the first is the unit of written files.
    pub fn units(self) -> &'static [Unit] {
        CHANNELS[self as usize].2.0
    }

    /// `true` for an angle or an angular rate.
    pub(crate) fn is_angle(self) -> bool {
        self.units().iter().any(|unit| matches!(unit, Unit::Radian | Unit::RadianPerSecond))
    }

    /// Unit of this channel in written files.
    pub fn written_unit(self) -> Unit {
        self.units()[0]
    }

    /// Column name of this channel in a unit, for example `heading_deg`.
    pub fn name_in(self, unit: Unit) -> String {
        format!("{}_{}", self.quantity(), unit.id())
    }

    /// Column name of this channel in written files, for example `heading_deg`.
    pub fn column_name(self) -> String {
        self.name_in(self.written_unit())
    }

    /// Every column name of this channel, as text of a message: `heading_deg or heading_rad`.
    pub fn accepted_names(self) -> String {
        self.units().iter().map(|unit| self.name_in(*unit)).collect::<Vec<_>>().join(" or ")
    }
}

/// Channel and unit of a column name; `None` for an unknown name and for time. Surrounding blanks and case are ignored.
pub fn parse_column_name(name: &str) -> Option<(Channel, Unit)> {
    let name = name.trim().to_ascii_lowercase();
    Channel::ALL.into_iter().find_map(|channel| {
        let suffix = name.strip_prefix(channel.quantity())?.strip_prefix('_')?;
        let unit = channel.units().iter().find(|unit| unit.id() == suffix)?;
        Some((channel, *unit))
    })
}

/// Unit of a time column (`t_s`, `t_ms`, `t_us`, `t_min`); `None` for any other name.
pub fn time_column_unit(name: &str) -> Option<Unit> {
    let name = name.trim().to_ascii_lowercase();
    let suffix = name.strip_prefix("t_")?;
    TIMES.into_iter().find(|unit| unit.id() == suffix)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The names occur in files: names may be added, but not changed.
    #[test]
    fn every_name_of_the_contract_is_known() {
        let names = Channel::ALL.map(Channel::accepted_names).join(", ");
        assert_eq!(
            names,
            "heading_deg or heading_rad, rudder_deg or rudder_rad, rudder_order_deg or rudder_order_rad, \
             yaw_rate_deg_s or yaw_rate_rad_s or yaw_rate_deg_min, speed_m_s or speed_kn, surge_m_s or surge_kn, \
             sway_m_s or sway_kn, north_m, east_m, roll_deg or roll_rad, propeller_rps or propeller_rpm, \
             wind_relative_speed_m_s or wind_relative_speed_kn, wind_relative_from_deg or wind_relative_from_rad, \
             wind_true_speed_m_s or wind_true_speed_kn, wind_true_from_deg or wind_true_from_rad"
        );
        assert_eq!((time_column_unit("t_s"), parse_column_name("t_s")), (Some(Unit::Second), None));
    }

    #[test]
    fn written_names_are_read_back_and_all_channels_are_listed_once() {
        for (place, channel) in Channel::ALL.into_iter().enumerate() {
            for &unit in channel.units() {
                assert_eq!(parse_column_name(&channel.name_in(unit)), Some((channel, unit)));
            }
            assert_eq!(channel as usize, place);
        }
    }

    #[test]
    fn names_that_are_not_known_stay_unknown() {
        for name in ["", "heading", "heading_m", "roll_rate_deg_s", "deg", "rudder_order", "heading_deg_s", "t", "T_h"]
        {
            assert_eq!(parse_column_name(name), None, "{name}");
            assert_eq!(time_column_unit(name), None, "{name}");
        }
        assert_eq!(parse_column_name(" Heading_DEG "), Some((Channel::Heading, Unit::Degree)));
    }

    #[test]
    fn factors_lead_to_si_units() {
        approx::assert_relative_eq!(180.0 * Unit::Degree.si_factor(), std::f64::consts::PI);
        // 15.5 knots are 7.974 m/s (1852 m in 3600 s).
        approx::assert_relative_eq!(15.5 * Unit::Knot.si_factor(), 7.973_888_888_888_89, max_relative = 1e-14);
        approx::assert_relative_eq!(60.0 * Unit::DegreePerMinute.si_factor(), Unit::DegreePerSecond.si_factor());
        assert_eq!(90.0 * Unit::RevolutionPerMinute.si_factor(), 1.5);
    }
}
