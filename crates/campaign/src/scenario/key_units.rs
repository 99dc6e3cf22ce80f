//! Units in the names of keys, and axis titles from keys.

/// Endings of keys and their units; an ending stands before any shorter ending with which it ends.
const UNITS: [(&str, &str); 23] = [
    ("stop.standard-error", "%"),
    ("-deg-per-root-s", "deg/√s"),
    ("-s2-per-deg2", "s²/deg²"),
    ("-s-per-deg2", "s/deg²"),
    ("-deg-per-s", "deg/s"),
    ("-s-per-deg", "s/deg"),
    ("-per-deg2", "1/deg²"),
    ("-per-s", "1/s"),
    ("-deg-s", "deg/s"),
    ("-rad-s", "rad/s"),
    ("-m-s", "m/s"),
    ("-deg", "deg"),
    ("-kn", "kn"),
    ("-m", "m"),
    ("-s", "s"),
    ("-rows", "rows"),
    ("-percent", "%"),
    ("-minutes", "min"),
    ("-hours", "h"),
    ("-m2", "m²"),
    ("-mm", "mm"),
    ("-t", "t"),
    ("-rps", "1/s"),
];

/// Unit in the name of a key; "1" without one.
pub(crate) fn key_unit(key: &str) -> &'static str {
    UNITS.iter().find(|(ending, _)| key.ends_with(ending)).map_or("1", |(_, unit)| unit)
}

/// Axis title of a dotted key: "heading noise [°]" for `sensor.heading-noise-deg`.
pub fn axis_title(key: &str) -> String {
    let last = key.rsplit('.').next().unwrap_or(key);
    let (name, unit) = match UNITS.iter().find(|(ending, _)| last.len() > ending.len() && last.ends_with(ending)) {
        Some((ending, unit)) => (last.trim_end_matches(ending), format!(" [{}]", unit.replace("deg", "°"))),
        None => (last, String::new()),
    };
    format!("{}{unit}", name.replace('-', " "))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_key_in_words_has_its_unit() {
        assert_eq!(axis_title("sensor.heading-noise-deg"), "heading noise [°]");
        assert_eq!(axis_title("ship.first-order.T-s"), "T [s]");
        assert_eq!(axis_title("replicates"), "replicates");
    }
}
