//! Display names of effects, records and figures of merit, from their identifiers in files.

/// Effects whose display name is not their identifier with blanks: identifier and display name.
const EFFECTS: [(&str, &str); 5] = [
    ("port_starboard_asymmetry", "port-starboard asymmetry"),
    ("rudder_deadband", "rudder dead band"),
    ("sway_coupling_measured", "measured sway"),
    ("transient_disturbance", "transient moment"),
    ("wave_yaw", "yaw in waves"),
];

/// Physics of the effects of the program by their identifiers: a sentence without its full stop.
const PHYSICS: [(&str, &str); 12] = [
    ("second_order", "sway responds to the rudder with its own time constant, and yaws the ship"),
    ("sway_coupling_measured", "the ship drifts in a turn, and the drift yaws her"),
    ("nonlinear_damping", "the resistance to turning grows faster than the yaw rate"),
    ("wind_moment", "the wind yaws the ship, depending on her heading"),
    ("speed_loss", "the ship loses speed in a turn, and with it rudder force"),
    ("steering_lag", "the rudder acts later than it was recorded"),
    ("rudder_saturation", "each further degree of rudder has less effect"),
    ("rudder_deadband", "the gear has play, so small movements do not reach the rudder"),
    ("port_starboard_asymmetry", "the rudder has more effect to one side"),
    ("moment_drift", "a yaw moment changes slowly during the record"),
    ("transient_disturbance", "a yaw moment acts during a part of the record"),
    ("wave_yaw", "waves yaw the ship at their frequency of encounter"),
];

/// Suffixes of identifiers with their units. The first match counts, so a suffix precedes all that it ends in.
const UNITS: [(&str, &str); 7] = [
    ("_deg_s", "deg/s"),
    ("_deg", "deg"),
    ("_lengths", "L"),
    ("_m_s", "m/s"),
    ("_share", "1"),
    ("_m", "m"),
    ("_s", "s"),
];

/// Display name of an effect: its identifier with blanks, unless `EFFECTS` lists another name.
pub fn effect_name(id: &str) -> String {
    let listed = EFFECTS.iter().find(|(key, _)| *key == id);
    listed.map_or_else(|| with_blanks(id), |(_, name)| (*name).to_owned())
}

/// Physics of an effect as a sentence without its full stop; `None` for an effect given as a formula.
pub fn effect_physics(id: &str) -> Option<&'static str> {
    PHYSICS.iter().find(|(key, _)| *key == id).map(|(_, sentence)| *sentence)
}

/// Display names of several effects, joined by `between`.
pub fn effect_names<S: AsRef<str>>(ids: &[S], between: &str) -> String {
    ids.iter().map(|id| effect_name(id.as_ref())).collect::<Vec<_>>().join(between)
}

/// Display name of an effect in one of its forms, such as `nonlinear damping (r³)`. A form that is part of the name of
/// the effect is not repeated.
pub fn effect_form_name(id: &str, form: &str) -> String {
    let name = effect_name(id);
    if name.contains(form) { name } else { format!("{name} ({form})") }
}

/// Display name of a record from the stem of its file: `zigzag_20_10_s` becomes `20/10, first to starboard`. A file
/// name with an extension is not changed.
pub fn record_name(stem: &str) -> String {
    if stem.contains('.') { stem.to_owned() } else { zigzag(stem).unwrap_or_else(|| with_blanks(stem)) }
}

/// Display name and unit of a figure of merit from the unit suffix of its identifier; the unit is empty without a
/// suffix.
pub fn figure_of_merit(id: &str) -> (String, &'static str) {
    let suffixed = UNITS.into_iter().find_map(|(suffix, unit)| Some((id.strip_suffix(suffix)?, unit)));
    let (stem, unit) = suffixed.unwrap_or((id, ""));
    (with_blanks(stem), unit)
}

/// Identifier with blanks for underscores.
pub fn with_blanks(id: &str) -> String {
    id.replace('_', " ")
}

/// Display name of a zig-zag from the stem `zigzag_RUDDER_HEADING`, with `_p` or `_s` for its first side; `None` for
/// any other stem.
fn zigzag(stem: &str) -> Option<String> {
    let mut parts = stem.strip_prefix("zigzag_")?.split('_');
    let mut angle = || parts.next()?.parse::<u8>().ok();
    let (rudder, heading) = (angle()?, angle()?);
    let side = match (parts.next(), parts.next()) {
        (None, None) => "",
        (Some("p"), None) => ", first to port",
        (Some("s"), None) => ", first to starboard",
        _ => return None,
    };
    Some(format!("{rudder}/{heading}{side}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn effects_have_names_without_repetition() {
        assert_eq!(effect_form_name("nonlinear_damping", "r³"), "nonlinear damping (r³)");
        assert_eq!(effect_form_name("sway_coupling_measured", "measured sway"), "measured sway");
        assert_eq!(effect_form_name("rudder_deadband", "dead band"), "rudder dead band");
        assert_eq!(effect_name("my_bank"), "my bank");
        assert_eq!(effect_names(&["speed_loss", "wave_yaw"], " + "), "speed loss + yaw in waves");
        for listed in ship::effects::all_effects() {
            assert!(!effect_form_name(listed.id(), listed.form()).contains('_'), "{}", listed.id());
        }
        assert!(EFFECTS.iter().all(|(id, _)| ship::effects::all_effects().iter().any(|listed| listed.id() == *id)));
        assert!(ship::effects::all_effects().iter().all(|listed| effect_physics(listed.id()).is_some()));
    }

    #[test]
    fn zig_zags_are_called_by_their_angles() {
        assert_eq!(record_name("zigzag_20_10_s"), "20/10, first to starboard");
        assert_eq!(record_name("zigzag_10_10_p"), "10/10, first to port");
        assert_eq!(record_name("zigzag_35_05"), "35/5");
        assert_eq!(record_name("zigzag_13_14_21"), "zigzag 13 14 21");
        assert_eq!(record_name("zigzag_20"), "zigzag 20");
        assert_eq!(record_name("turning_35"), "turning 35");
        assert_eq!(record_name("zigzag_20_10_s.csv"), "zigzag_20_10_s.csv");
    }

    #[test]
    fn figures_end_in_their_unit() {
        assert_eq!(figure_of_merit("first_overshoot_deg"), ("first overshoot".to_owned(), "deg"));
        assert_eq!(figure_of_merit("largest_yaw_rate_deg_s"), ("largest yaw rate".to_owned(), "deg/s"));
        assert_eq!(figure_of_merit("approach_m_s"), ("approach".to_owned(), "m/s"));
        assert_eq!(figure_of_merit("stable"), ("stable".to_owned(), ""));
    }
}
