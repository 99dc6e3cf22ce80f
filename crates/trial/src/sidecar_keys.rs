//! The keys of a sidecar with what they mean: the list that `study list sidecar` and the documentation are made from.

/// A key of a sidecar.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Key {
    /// Table and key.
    pub key: &'static str,
    /// What it may be.
    pub value: &'static str,
    /// What it says, and what holds where it is absent.
    pub meaning: &'static str,
}

const fn key(key: &'static str, value: &'static str, meaning: &'static str) -> Key {
    Key { key, value, meaning }
}

/// All keys, in the order in which they are written.
pub const KEYS: [Key; 40] = [
    key(
        "[table] skip-lines",
        "number",
        "Lines before the header, or before the rows when there is none; not even decoded.",
    ),
    key("[table] separator", "comma, semicolon, tab or blank", "What stands between cells; recognised when absent."),
    key("[table] encoding", "utf-8 or windows-1252", "How bytes stand for letters; utf-8 when absent."),
    key("[table] header", "true or false", "Whether a line with names comes before the rows; true when absent."),
    key(
        "[table] time-step-s",
        "s",
        "Row i (from 0, empty lines not counted) is at i times this, and a column of time is not used. Rows that are missing \
         shift all that follow: for tables without time only.",
    ),
    key("[part] from-s", "s", "First time that is used, on the clock of the record."),
    key("[part] until-s", "s", "Last time that is used."),
    key("[part] every", "number", "The first row of the part and every n-th after it."),
    key("[[column]] index", "number", "Which column: counted from 1; this or its name."),
    key("[[column]] name", "text", "Which column: its name in the header."),
    key(
        "[[column]] is",
        "name such as heading_rad",
        "What it holds: a name of `study list columns`; its own name when absent.",
    ),
    key("[[column]] flip", "true", "Change the sign."),
    key("[[column]] ignore", "true", "Leave the column out."),
    key("[ship] length-m", "m", "Length between perpendiculars; needs a speed beside it."),
    key("[ship] speed-m-s", "m/s", "Approach speed."),
    key("[ship] speed-kn", "kn", "The same in knots."),
    key("[noise] heading-deg", "deg", "Standard deviation of the heading, where it is known."),
    key("[noise] yaw-rate-deg-s", "deg/s", "The same of the yaw rate."),
    key("[noise] rudder-deg", "deg", "The same of the rudder."),
    key(
        "[check] plausibility",
        "true or false",
        "With false nothing is mended, and what looks implausible is a warning in place of an error.",
    ),
    key(
        "[form] administration",
        "text",
        "Administration the form of MSC/Circ.1053 goes to; texts have at most 100 characters.",
    ),
    key("[form] ship-type", "text", "Container ship, tanker, gas carrier, ro-ro ship, bulk carrier, ..."),
    key("[form] beam-m", "m", "Breadth of the ship; lengths are of the scale of [ship] length-m."),
    key("[form] draught-m", "m", "Mean draught at the trial."),
    key("[form] full-load-draught-m", "m", "Mean draught at full load."),
    key("[form] block-coefficient", "1", "Block coefficient at full load."),
    key("[form] rudder-type", "text", "Full spade, semi-spade, high lift, ..."),
    key("[form] rudder-area-m2", "m²", "Area of all rudders together."),
    key("[form] rudders", "number", "Number of rudders."),
    key("[form] propeller-type", "text", "Fixed pitch, controllable pitch, with or without nozzle, ..."),
    key("[form] propellers", "number", "Number of propellers."),
    key("[form] engine-type", "text", "Diesel, steam turbine, gas turbine, diesel-electric, ..."),
    key("[form] trim-m", "m", "Trim, positive by the stern, 0 for an even keel."),
    key("[form] ballast", "text", "Ballast condition in words."),
    key("[form] water-depth-m", "m", "Depth of the water at the trial."),
    key("[form] wind-beaufort", "0 to 12", "Wind at the trial, Beaufort number."),
    key("[form] sea-state", "0 to 9", "Sea state at the trial."),
    key(
        "[form] loading",
        "full or partial",
        "Loading at the trial; by the two draughts, with a tolerance of 5 %, when absent.",
    ),
    key("[form] remark", "text", "A remark for the form."),
    key("#", "text", "A remark, to the end of the line."),
];
