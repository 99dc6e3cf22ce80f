//! Customary names of columns: the header of a column, split into a quantity and its unit, becomes a [`ColumnMeaning`].
//! This module contains names and units; the reader decides which column of a table is used.

use crate::channel::{Channel, UNITS, Unit, parse_column_name, time_column_unit};

/// Meaning of a column name: quantity and, if stated, unit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum ColumnMeaning {
    /// Time, or a stamp of date and time, with its unit if stated.
    Time(Option<Unit>),
    /// Date without a time.
    Date,
    /// Channel, with its unit if stated.
    Channel(Channel, Option<Unit>),
    /// Speed over ground, with its unit if stated; used as the speed if there is none through the water.
    SpeedOverGround(Option<Unit>),
    /// Latitude, degrees north.
    Latitude,
    /// Longitude, degrees east.
    Longitude,
    /// Course over ground, which is not a heading.
    CourseOverGround,
}

/// Maximum length of a name or unit, bytes; a longer text has no meaning.
const MAX_NAME_BYTES: usize = 80;

/// Names of the quantities in small letters, words separated by one blank: English first, then German, French, Spanish,
/// Norwegian and Japanese in Latin letters.
const NAMES: [(ColumnMeaning, &str); 20] = {
    use crate::channel::Channel as C;
    use ColumnMeaning::*;
    [
        (
            Time(None),
            "t, time, timestamp, time stamp, date time, datetime, date and time, utc, gmt, time utc, utc time, \
         local time, elapsed time, elapsed, zeit, uhrzeit, zeitstempel, datum zeit, temps, heure, tiempo, \
         hora, tid, klokkeslett, jikoku, jikan",
        ),
        (Date, "date, datum, fecha"),
        (
            Channel(C::Heading, None),
            "heading, hdg, hdt, heading true, true heading, gyro, gyro heading, heading gyro, compass heading, \
         ship heading, ships heading, psi, ψ, yaw, yaw angle, heading angle, steuerkurs, kurs gyro, \
         kreiselkurs, kompasskurs, kurs rechtweisend, rwk, kurs, cap, cap gyro, cap vrai, rumbo, rumbo verdadero, \
         rumbo giro, styrekurs, kurs rettvisende, shinro, shinrokaku, kaito kaku",
        ),
        (
            Channel(C::Rudder, None),
            "rudder, rudder angle, rudder actual, actual rudder, actual rudder angle, rudder angle actual, \
         rudder feedback, rudder position, rudder response, rudder indicator, rudder sensor angle, rsa, \
         delta, δ, ruder, ruderlage, ruderwinkel, ruder ist, ruder istwert, angle de barre, barre, timon, angulo de \
         timon, ángulo de timón, \
         rorvinkel, rorutslag, ror, kaji, dakaku",
        ),
        (
            Channel(C::RudderOrder, None),
            "rudder order, ordered rudder, rudder angle order, rudder command, rudder cmd, commanded rudder, \
         rudder demand, rudder setpoint, rudder set, ruder soll, ruder sollwert, ordre de barre, barre ordonnée, \
         orden de timon, rorordre, shirei dakaku",
        ),
        (
            Channel(C::YawRate, None),
            "rot, rate of turn, turn rate, yaw rate, yaw velocity, drehrate, wendegeschwindigkeit, vitesse de \
             rotation, taux de giration, velocidad de giro, \
         svinghastighet, kaito kakusokudo",
        ),
        (
            Channel(C::Speed, None),
            "speed, stw, speed through water, water speed, log speed, ship speed, fahrt, fahrt durch wasser, vitesse, \
             vitesse surface, velocidad, fart, sokuryoku, sensoku",
        ),
        (SpeedOverGround(None), "sog, speed over ground, gps speed, fahrt über grund"),
        (Channel(C::Surge, None), "surge velocity, longitudinal speed"),
        (Channel(C::Sway, None), "sway velocity, transverse speed"),
        (Channel(C::North, None), "northing"),
        (Channel(C::East, None), "easting"),
        (Latitude, "latitude, lat"),
        (Longitude, "longitude, lon"),
        (CourseOverGround, "cog, course, course over ground, kurs über grund"),
        (Channel(C::Roll, None), "heel"),
        (Channel(C::PropellerRate, Some(Unit::RevolutionPerMinute)), "rpm"),
        (Channel(C::WindRelativeSpeed, None), "apparent wind speed, aws"),
        (Channel(C::WindRelativeFrom, None), "awa"),
        (Channel(C::WindTrueSpeed, None), "tws"),
    ]
};

/// Every customary column name, normalised, with its meaning.
pub fn known_column_names() -> impl Iterator<Item = (&'static str, ColumnMeaning)> {
    NAMES.iter().flat_map(|&(meaning, names)| names.split(", ").map(move |name| (name, meaning)))
}

/// Every notation of a unit, in lower case without blanks, with its unit.
pub fn known_unit_names() -> impl Iterator<Item = (&'static str, Unit)> {
    UNITS.iter().flat_map(|&(unit, .., names)| names.split(", ").map(move |name| (name, unit)))
}

/// Unit of a text with or without brackets: `[deg]`, `(°/min)`, `kn`; `None` for an unknown unit.
pub fn parse_unit(text: &str) -> Option<Unit> {
    if text.len() > MAX_NAME_BYTES {
        return None;
    }
    let inner = text.trim().trim_matches(['[', ']', '(', ')', '{', '}']);
    let plain: String = inner
        .chars()
        .flat_map(char::to_lowercase)
        .filter(|c| !c.is_whitespace() && !matches!(c, '.' | '^' | '·' | '*' | '⁻'))
        .map(|c| if c == '¹' { '1' } else { c })
        .collect();
    known_unit_names().find(|(name, _)| *name == plain).map(|(_, unit)| unit)
}

/// Normalised name: small letters, single blanks in place of all other characters, `RudderAngle` as two words.
fn normalised(name: &str) -> String {
    let mut spaced = String::new();
    let mut small_before = false;
    for c in name.chars() {
        if !c.is_alphanumeric() {
            spaced.push(' ');
        } else {
            if c.is_uppercase() && small_before {
                spaced.push(' ');
            }
            spaced.extend(c.to_lowercase());
        }
        small_before = c.is_lowercase();
    }
    spaced.split_whitespace().collect::<Vec<_>>().join(" ")
}

/// Meaning of a normalised name without a unit.
fn unitless_meaning(normalised: &str) -> Option<ColumnMeaning> {
    let customary = known_column_names().find(|(name, _)| *name == normalised).map(|(_, meaning)| meaning);
    // `wind true speed` is the quantity `wind_true_speed` of a column name.
    customary.or_else(|| {
        let channel = Channel::ALL.into_iter().find(|channel| channel.quantity().replace('_', " ") == normalised)?;
        Some(ColumnMeaning::Channel(channel, None))
    })
}

/// Meaning of a `quantity_unit` name such as `t_s` or `heading_deg`.
pub(crate) fn quantity_unit_meaning(name: &str) -> Option<ColumnMeaning> {
    let of_channel = |(channel, unit)| ColumnMeaning::Channel(channel, Some(unit));
    time_column_unit(name)
        .map(|unit| ColumnMeaning::Time(Some(unit)))
        .or_else(|| parse_column_name(name).map(of_channel))
}

/// Meaning of a column name; `None` for an unknown name and for a unit that the quantity cannot have.
///
/// A unit may follow in brackets, after a comma, a slash or a blank (`ROT deg/min`, `Heading [°]`, `SOG_kn`), with or
/// without `in`. Case does not matter.
pub fn column_meaning(name: &str) -> Option<ColumnMeaning> {
    let name = name.trim();
    if name.len() > MAX_NAME_BYTES {
        return None;
    }
    if let Some(meaning) = quantity_unit_meaning(name) {
        return Some(meaning);
    }
    let marks =
        name.char_indices().filter(|(_, c)| c.is_whitespace() || matches!(c, '[' | '(' | '{' | ',' | '/' | '_'));
    for (at, mark) in marks {
        let suffix = name[at + usize::from(!matches!(mark, '[' | '(' | '{')) * mark.len_utf8()..].trim();
        let suffix = suffix.strip_prefix("in ").unwrap_or(suffix);
        if let (Some(meaning), Some(unit)) = (unitless_meaning(&normalised(&name[..at])), suffix_unit(suffix)) {
            return meaning_with_unit(meaning, unit);
        }
    }
    unitless_meaning(&normalised(name))
}

/// Unit at the end of a name; blanks and `_` may replace a slash: `deg_s` as well as `deg/s`.
fn suffix_unit(text: &str) -> Option<Unit> {
    parse_unit(text).or_else(|| parse_unit(&text.replace(['_', ' '], "/")))
}

/// Unit of a channel for a written unit; `None` if the channel cannot have it.
fn channel_unit(channel: Channel, unit: Unit) -> Option<Unit> {
    // A rate of turn in "ms" has no meaning; a speed in "ms" means m/s.
    let speed = unit == Unit::Millisecond && channel.units().contains(&Unit::MetrePerSecond);
    Some(if speed { Unit::MetrePerSecond } else { unit }).filter(|unit| channel.units().contains(unit))
}

/// Meaning of a column with its unit replaced; `None` if the quantity cannot have the unit.
pub fn meaning_with_unit(meaning: ColumnMeaning, unit: Unit) -> Option<ColumnMeaning> {
    match meaning {
        ColumnMeaning::Time(_) => {
            time_column_unit(&format!("t_{}", unit.id())).map(|unit| ColumnMeaning::Time(Some(unit)))
        }
        ColumnMeaning::Channel(channel, _) => {
            channel_unit(channel, unit).map(|unit| ColumnMeaning::Channel(channel, Some(unit)))
        }
        ColumnMeaning::SpeedOverGround(_) => {
            channel_unit(Channel::Speed, unit).map(Some).map(ColumnMeaning::SpeedOverGround)
        }
        ColumnMeaning::Latitude | ColumnMeaning::Longitude | ColumnMeaning::CourseOverGround => {
            (unit == Unit::Degree).then_some(meaning)
        }
        ColumnMeaning::Date => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_people_use_are_understood() {
        use Channel::*;
        let channel = |channel, unit| Some(ColumnMeaning::Channel(channel, unit));
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
            ("SOG", Some(ColumnMeaning::SpeedOverGround(None))),
            ("SOG [kn]", Some(ColumnMeaning::SpeedOverGround(Some(Unit::Knot)))),
            ("RPM", channel(PropellerRate, Some(Unit::RevolutionPerMinute))),
            ("Wind True Speed (m/s)", channel(WindTrueSpeed, Some(Unit::MetrePerSecond))),
            ("Time [s]", Some(ColumnMeaning::Time(Some(Unit::Second)))),
            ("Zeit (min)", Some(ColumnMeaning::Time(Some(Unit::Minute)))),
            ("t_ms", Some(ColumnMeaning::Time(Some(Unit::Millisecond)))),
            ("Timestamp", Some(ColumnMeaning::Time(None))),
            ("DateTime", Some(ColumnMeaning::Time(None))),
            ("Date", Some(ColumnMeaning::Date)),
            ("Latitude [deg]", Some(ColumnMeaning::Latitude)),
            ("COG", Some(ColumnMeaning::CourseOverGround)),
        ];
        for (name, expected) in cases {
            assert_eq!(column_meaning(name), expected, "{name}");
        }
        // Unknown names, and units that the quantity cannot have, give no meaning.
        for name in
            ["", "helm", "rudder port", "heading_m", "Heading [kn]", "course_deg_x", "wind speed", "load_t", "Ä["]
        {
            assert_eq!(column_meaning(name), None, "{name}");
        }
    }

    #[test]
    fn every_name_is_there_once_and_reads_as_itself() {
        for (place, (name, expected)) in known_column_names().enumerate() {
            assert!(known_column_names().take(place).all(|(other, _)| other != name), "{name}");
            assert_eq!(column_meaning(name), Some(expected), "{name}");
            assert_eq!(normalised(name), name);
        }
        for (place, (name, expected)) in known_unit_names().enumerate() {
            assert!(known_unit_names().take(place).all(|(other, _)| other != name), "{name}");
            assert_eq!(parse_unit(&format!("[{name}]")), Some(expected), "{name}");
        }
    }
}
