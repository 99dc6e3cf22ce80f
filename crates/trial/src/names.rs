//! What people call the columns of their tables: a heading, split into the words that name a quantity and the unit
//! beside them, becomes a [`Said`]. It knows names and units; which column of a table is used is decided by the reader.

use crate::channel::{Channel, Unit, column, time_column};

/// What the name of a column says.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Said {
    /// Time, or a stamp of date and time.
    Time(Option<Unit>),
    /// A date alone.
    Date,
    /// A channel; its unit where the name has it.
    Channel(Channel, Option<Unit>),
    /// A speed over ground, which stands for the speed where there is none through the water.
    OverGround(Option<Unit>),
    /// Latitude, degrees north.
    Latitude,
    /// Longitude, degrees east.
    Longitude,
    /// The course over ground, which is no heading.
    Course,
}

/// Longest name and unit that are looked at, bytes.
const LONGEST: usize = 80;

/// Names of the quantities in small letters, words separated by one blank: English first, then German, French, Spanish.
const NAMES: [(&str, Said); 115] = {
    use Channel::*;
    use Said::{Course as COURSE, Date as DATE, Latitude as LATITUDE, Longitude as LONGITUDE};
    const TIME: Said = Said::Time(None);
    const fn of(channel: Channel) -> Said {
        Said::Channel(channel, None)
    }
    const GROUND: Said = Said::OverGround(None);
    [
        ("t", TIME),
        ("time", TIME),
        ("timestamp", TIME),
        ("time stamp", TIME),
        ("date time", TIME),
        ("datetime", TIME),
        ("date and time", TIME),
        ("utc", TIME),
        ("gmt", TIME),
        ("time utc", TIME),
        ("utc time", TIME),
        ("local time", TIME),
        ("elapsed time", TIME),
        ("elapsed", TIME),
        ("zeit", TIME),
        ("uhrzeit", TIME),
        ("zeitstempel", TIME),
        ("datum zeit", TIME),
        ("temps", TIME),
        ("heure", TIME),
        ("tiempo", TIME),
        ("hora", TIME),
        ("date", DATE),
        ("datum", DATE),
        ("fecha", DATE),
        ("heading", of(Heading)),
        ("hdg", of(Heading)),
        ("hdt", of(Heading)),
        ("heading true", of(Heading)),
        ("true heading", of(Heading)),
        ("gyro", of(Heading)),
        ("gyro heading", of(Heading)),
        ("heading gyro", of(Heading)),
        ("compass heading", of(Heading)),
        ("ship heading", of(Heading)),
        ("ships heading", of(Heading)),
        ("psi", of(Heading)),
        ("ψ", of(Heading)),
        ("yaw", of(Heading)),
        ("yaw angle", of(Heading)),
        ("heading angle", of(Heading)),
        ("steuerkurs", of(Heading)),
        ("kurs gyro", of(Heading)),
        ("kreiselkurs", of(Heading)),
        ("cap", of(Heading)),
        ("rumbo", of(Heading)),
        ("rudder", of(Rudder)),
        ("rudder angle", of(Rudder)),
        ("rudder actual", of(Rudder)),
        ("actual rudder", of(Rudder)),
        ("actual rudder angle", of(Rudder)),
        ("rudder angle actual", of(Rudder)),
        ("rudder feedback", of(Rudder)),
        ("rudder position", of(Rudder)),
        ("rudder response", of(Rudder)),
        ("rudder indicator", of(Rudder)),
        ("rudder sensor angle", of(Rudder)),
        ("rsa", of(Rudder)),
        ("delta", of(Rudder)),
        ("δ", of(Rudder)),
        ("ruder", of(Rudder)),
        ("ruderlage", of(Rudder)),
        ("ruderwinkel", of(Rudder)),
        ("ruder ist", of(Rudder)),
        ("angle de barre", of(Rudder)),
        ("timon", of(Rudder)),
        ("rudder order", of(RudderOrder)),
        ("ordered rudder", of(RudderOrder)),
        ("rudder angle order", of(RudderOrder)),
        ("rudder command", of(RudderOrder)),
        ("rudder cmd", of(RudderOrder)),
        ("commanded rudder", of(RudderOrder)),
        ("rudder demand", of(RudderOrder)),
        ("rudder setpoint", of(RudderOrder)),
        ("rudder set", of(RudderOrder)),
        ("ruder soll", of(RudderOrder)),
        ("rot", of(YawRate)),
        ("rate of turn", of(YawRate)),
        ("turn rate", of(YawRate)),
        ("yaw rate", of(YawRate)),
        ("yaw velocity", of(YawRate)),
        ("drehrate", of(YawRate)),
        ("wendegeschwindigkeit", of(YawRate)),
        ("speed", of(Speed)),
        ("stw", of(Speed)),
        ("speed through water", of(Speed)),
        ("water speed", of(Speed)),
        ("log speed", of(Speed)),
        ("ship speed", of(Speed)),
        ("fahrt", of(Speed)),
        ("fahrt durch wasser", of(Speed)),
        ("sog", GROUND),
        ("speed over ground", GROUND),
        ("gps speed", GROUND),
        ("fahrt über grund", GROUND),
        ("surge velocity", of(Surge)),
        ("longitudinal speed", of(Surge)),
        ("sway velocity", of(Sway)),
        ("transverse speed", of(Sway)),
        ("northing", of(North)),
        ("easting", of(East)),
        ("latitude", LATITUDE),
        ("lat", LATITUDE),
        ("longitude", LONGITUDE),
        ("lon", LONGITUDE),
        ("cog", COURSE),
        ("course", COURSE),
        ("course over ground", COURSE),
        ("kurs über grund", COURSE),
        ("heel", of(Roll)),
        ("rpm", Said::Channel(PropellerRate, Some(Unit::PerMinute))),
        ("apparent wind speed", of(WindRelativeSpeed)),
        ("aws", of(WindRelativeSpeed)),
        ("awa", of(WindRelativeFrom)),
        ("tws", of(WindTrueSpeed)),
    ]
};

/// Units as they are written, without blanks and in small letters.
const UNITS: [(&str, Unit); 61] = {
    use Unit::*;
    [
        ("s", Second),
        ("sec", Second),
        ("secs", Second),
        ("second", Second),
        ("seconds", Second),
        ("sek", Second),
        ("ms", Millisecond),
        ("msec", Millisecond),
        ("min", Minute),
        ("minutes", Minute),
        ("deg", Degree),
        ("degs", Degree),
        ("degree", Degree),
        ("degrees", Degree),
        ("°", Degree),
        ("º", Degree),
        ("grad", Degree),
        ("rad", Radian),
        ("radian", Radian),
        ("radians", Radian),
        ("deg/s", DegreePerSecond),
        ("deg/sec", DegreePerSecond),
        ("°/s", DegreePerSecond),
        ("º/s", DegreePerSecond),
        ("degs-1", DegreePerSecond),
        ("grad/s", DegreePerSecond),
        ("deg/min", DegreePerMinute),
        ("°/min", DegreePerMinute),
        ("º/min", DegreePerMinute),
        ("degmin-1", DegreePerMinute),
        ("grad/min", DegreePerMinute),
        ("dpm", DegreePerMinute),
        ("rad/s", RadianPerSecond),
        ("rad/sec", RadianPerSecond),
        ("rads-1", RadianPerSecond),
        ("m/s", MetrePerSecond),
        ("mps", MetrePerSecond),
        ("m/sec", MetrePerSecond),
        ("ms-1", MetrePerSecond),
        ("kn", Knot),
        ("kt", Knot),
        ("kts", Knot),
        ("kns", Knot),
        ("knot", Knot),
        ("knots", Knot),
        ("knoten", Knot),
        ("sm/h", Knot),
        ("nm/h", Knot),
        ("m", Metre),
        ("metre", Metre),
        ("metres", Metre),
        ("meter", Metre),
        ("meters", Metre),
        ("rpm", PerMinute),
        ("1/min", PerMinute),
        ("min-1", PerMinute),
        ("u/min", PerMinute),
        ("rps", PerSecond),
        ("1/s", PerSecond),
        ("s-1", PerSecond),
        ("hz", PerSecond),
    ]
};

/// What people call the columns of a record, with what it says.
pub fn names() -> impl Iterator<Item = (&'static str, Said)> {
    NAMES.into_iter()
}

/// How units are written.
pub fn units() -> impl Iterator<Item = (&'static str, Unit)> {
    UNITS.into_iter()
}

/// The unit a text stands for, brackets around it left out: `[deg]`, `(°/min)`, `kn`.
pub fn unit(text: &str) -> Option<Unit> {
    if text.len() > LONGEST {
        return None;
    }
    let inner = text.trim().trim_matches(['[', ']', '(', ')', '{', '}']);
    let plain: String = inner
        .chars()
        .flat_map(char::to_lowercase)
        .filter(|c| !c.is_whitespace() && !matches!(c, '.' | '^' | '·' | '*' | '⁻'))
        .map(|c| if c == '¹' { '1' } else { c })
        .collect();
    UNITS.iter().find(|(name, _)| *name == plain).map(|(_, unit)| *unit)
}

/// A name in words: small letters, one blank between words, marks of all kinds as blanks, `RudderAngle` as two words.
fn words(name: &str) -> String {
    let mut words = String::new();
    let mut small_before = false;
    for c in name.chars() {
        if !c.is_alphanumeric() {
            words.push(' ');
        } else {
            if c.is_uppercase() && small_before {
                words.push(' ');
            }
            words.extend(c.to_lowercase());
        }
        small_before = c.is_lowercase();
    }
    words.split_whitespace().collect::<Vec<_>>().join(" ")
}

fn known(words: &str) -> Option<Said> {
    let plain = NAMES.iter().find(|(name, _)| *name == words).map(|(_, said)| *said);
    // What the contract calls `wind_true_speed` is said by the same words.
    plain.or_else(|| {
        let contract = Channel::ALL.into_iter().find(|channel| channel.quantity().replace('_', " ") == words)?;
        Some(Said::Channel(contract, None))
    })
}

/// What the name of a column says; `None` for a name that is not known, or whose unit its quantity cannot have.
///
/// A unit may follow in brackets, after a comma, a slash or a blank (`ROT deg/min`, `Heading [°]`, `SOG_kn`), with `in`
/// before it or not. Case does not matter.
pub fn said(name: &str) -> Option<Said> {
    let name = name.trim();
    if name.len() > LONGEST {
        return None;
    }
    if let Some(unit) = time_column(name) {
        return Some(Said::Time(Some(unit)));
    }
    if let Some((channel, unit)) = column(name) {
        return Some(Said::Channel(channel, Some(unit)));
    }
    let marks =
        name.char_indices().filter(|(_, c)| c.is_whitespace() || matches!(c, '[' | '(' | '{' | ',' | '/' | '_'));
    for (at, mark) in marks {
        let rest = name[at + usize::from(!matches!(mark, '[' | '(' | '{')) * mark.len_utf8()..].trim();
        let rest = rest.strip_prefix("in ").unwrap_or(rest);
        if let (Some(said), Some(unit)) = (known(&words(&name[..at])), unit_after(rest)) {
            return with_unit(said, unit);
        }
    }
    known(&words(name))
}

/// A unit at the end of a name, where blanks and `_` may stand for a slash: `deg_s` as well as `deg/s`.
fn unit_after(text: &str) -> Option<Unit> {
    unit(text).or_else(|| unit(&text.replace(['_', ' '], "/")))
}

/// The same with a unit; `None` where the quantity cannot have it.
pub fn with_unit(said: Said, unit: Unit) -> Option<Said> {
    match said {
        Said::Time(_) => time_column(&format!("t_{}", unit.id())).map(|unit| Said::Time(Some(unit))),
        Said::Channel(channel, _) => {
            // A rate of turn in "ms" is nothing; a speed in "ms" was written for m/s.
            let speed = unit == Unit::Millisecond && channel.units().contains(&Unit::MetrePerSecond);
            let unit = if speed { Unit::MetrePerSecond } else { unit };
            channel.units().contains(&unit).then_some(Said::Channel(channel, Some(unit)))
        }
        Said::OverGround(_) => match with_unit(Said::Channel(Channel::Speed, None), unit)? {
            Said::Channel(_, unit) => Some(Said::OverGround(unit)),
            _ => None,
        },
        Said::Latitude | Said::Longitude | Said::Course => (unit == Unit::Degree).then_some(said),
        Said::Date => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_people_use_are_understood() {
        use Channel::*;
        let channel = |channel, unit| Some(Said::Channel(channel, unit));
        let cases = [
            ("Heading", channel(Heading, None)),
            ("Heading [deg]", channel(Heading, Some(Unit::Degree))),
            ("HDG (°)", channel(Heading, Some(Unit::Degree))),
            ("TrueHeading", channel(Heading, None)),
            ("Gyro heading, deg", channel(Heading, Some(Unit::Degree))),
            ("ψ / rad", channel(Heading, Some(Unit::Radian))),
            ("Rudder Angle", channel(Rudder, None)),
            ("rudder_angle_deg", channel(Rudder, Some(Unit::Degree))),
            ("RUDDER_ACTUAL [deg]", channel(Rudder, Some(Unit::Degree))),
            ("Rudder Command (deg)", channel(RudderOrder, Some(Unit::Degree))),
            ("Ruderlage [Grad]", channel(Rudder, Some(Unit::Degree))),
            ("ROT deg/min", channel(YawRate, Some(Unit::DegreePerMinute))),
            ("Rate of Turn (°/min)", channel(YawRate, Some(Unit::DegreePerMinute))),
            ("yaw rate [rad s^-1]", channel(YawRate, Some(Unit::RadianPerSecond))),
            ("yawRate_deg_s", channel(YawRate, Some(Unit::DegreePerSecond))),
            ("STW (kts)", channel(Speed, Some(Unit::Knot))),
            ("Speed in m/s", channel(Speed, Some(Unit::MetrePerSecond))),
            ("SOG", Some(Said::OverGround(None))),
            ("SOG [kn]", Some(Said::OverGround(Some(Unit::Knot)))),
            ("RPM", channel(PropellerRate, Some(Unit::PerMinute))),
            ("Wind True Speed (m/s)", channel(WindTrueSpeed, Some(Unit::MetrePerSecond))),
            ("Time [s]", Some(Said::Time(Some(Unit::Second)))),
            ("Zeit (min)", Some(Said::Time(Some(Unit::Minute)))),
            ("t_ms", Some(Said::Time(Some(Unit::Millisecond)))),
            ("Timestamp", Some(Said::Time(None))),
            ("DateTime", Some(Said::Time(None))),
            ("Date", Some(Said::Date)),
            ("Latitude [deg]", Some(Said::Latitude)),
            ("COG", Some(Said::Course)),
        ];
        for (name, said_of) in cases {
            assert_eq!(said(name), said_of, "{name}");
        }
        // Neither what is not known nor a unit that the quantity cannot have.
        for name in
            ["", "helm", "rudder port", "heading_m", "Heading [kn]", "course_deg_x", "wind speed", "load_t", "Ä["]
        {
            assert_eq!(said(name), None, "{name}");
        }
    }

    #[test]
    fn every_name_is_there_once_and_reads_as_itself() {
        for (place, (name, meaning)) in NAMES.iter().enumerate() {
            assert!(NAMES[..place].iter().all(|(other, _)| other != name), "{name}");
            assert_eq!(said(name), Some(*meaning), "{name}");
            assert_eq!(words(name), *name);
        }
        for (place, (name, meaning)) in UNITS.iter().enumerate() {
            assert!(UNITS[..place].iter().all(|(other, _)| other != name), "{name}");
            assert_eq!(unit(&format!("[{name}]")), Some(*meaning), "{name}");
        }
    }
}
