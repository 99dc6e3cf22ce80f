//! The table `[form]` of a sidecar: what the form of MSC/Circ.1053 asks for and no record holds. Every value is checked
//! by hand, so that a message names key, value and what was expected.

use serde::Deserialize;
use ship::Particulars;
use toml::{Spanned, Value};

use crate::conditions::{Conditions, Loading};
use crate::sidecar_error::{Fault, SidecarProblem};
use crate::words::shortened;

/// Longest text of a key, characters.
const LONGEST_TEXT: usize = 100;

type Entry = Option<Spanned<Value>>;

/// The table as it is written.
#[derive(Deserialize, Default, schemars::JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub(crate) struct WireForm {
    #[schemars(with = "Option<String>")]
    administration: Entry,
    #[schemars(with = "Option<String>")]
    ship_type: Entry,
    #[schemars(with = "Option<f64>")]
    beam_m: Entry,
    #[schemars(with = "Option<f64>")]
    draught_m: Entry,
    #[schemars(with = "Option<f64>")]
    full_load_draught_m: Entry,
    #[schemars(with = "Option<f64>")]
    block_coefficient: Entry,
    #[schemars(with = "Option<String>")]
    rudder_type: Entry,
    #[schemars(with = "Option<f64>")]
    rudder_area_m2: Entry,
    #[schemars(with = "Option<u8>")]
    rudders: Entry,
    #[schemars(with = "Option<String>")]
    propeller_type: Entry,
    #[schemars(with = "Option<u8>")]
    propellers: Entry,
    #[schemars(with = "Option<String>")]
    engine_type: Entry,
    #[schemars(with = "Option<f64>")]
    trim_m: Entry,
    #[schemars(with = "Option<String>")]
    ballast: Entry,
    #[schemars(with = "Option<f64>")]
    water_depth_m: Entry,
    #[schemars(with = "Option<u8>")]
    wind_beaufort: Entry,
    #[schemars(with = "Option<u8>")]
    sea_state: Entry,
    #[schemars(with = "Option<String>")]
    loading: Entry,
    #[schemars(with = "Option<String>")]
    remark: Entry,
}

fn fault(key: &'static str, entry: &Spanned<Value>, expected: &'static str) -> Fault {
    let found = shortened(&entry.get_ref().to_string());
    (Some(entry.span()), SidecarProblem::Form { key, found, expected })
}

/// A value that is read by `take`, or the fault that says what was expected.
fn read<T>(
    key: &'static str,
    entry: &Entry,
    expected: &'static str,
    take: impl Fn(&Value) -> Option<T>,
) -> Result<Option<T>, Fault> {
    let Some(entry) = entry else { return Ok(None) };
    take(entry.get_ref()).map(Some).ok_or_else(|| fault(key, entry, expected))
}

fn number(value: &Value) -> Option<f64> {
    let number = value.as_float().or_else(|| value.as_integer().map(|whole| whole as f64))?;
    number.is_finite().then_some(number)
}

fn text(key: &'static str, entry: &Entry) -> Result<Option<String>, Fault> {
    let expected = "a text of 1 to 100 characters in one line";
    read(key, entry, expected, |value| {
        let text = value.as_str()?.trim();
        let fits = !text.is_empty() && text.chars().count() <= LONGEST_TEXT && !text.chars().any(char::is_control);
        fits.then(|| text.to_owned())
    })
}

fn metres(key: &'static str, entry: &Entry) -> Result<Option<f64>, Fault> {
    read(key, entry, "a number of metres above 0", |value| number(value).filter(|value| *value > 0.0))
}

fn whole(
    key: &'static str,
    entry: &Entry,
    [least, most]: [u8; 2],
    expected: &'static str,
) -> Result<Option<u8>, Fault> {
    read(key, entry, expected, |value| {
        let whole = u8::try_from(value.as_integer()?).ok()?;
        (least..=most).contains(&whole).then_some(whole)
    })
}

/// Checks the table; `particulars` are those of the ship in the same sidecar.
///
/// Fails for texts that are empty or long, for numbers outside their range, and for lengths that no ship has together:
/// a breadth above the length, a draught above the depth of the water.
pub(crate) fn conditions(wire: &WireForm, particulars: Option<Particulars>) -> Result<Conditions, Fault> {
    let loading = |value: &Value| match value.as_str() {
        Some("full") => Some(Loading::Full),
        Some("partial") => Some(Loading::Partial),
        _ => None,
    };
    let share = |value: &Value| number(value).filter(|value| *value > 0.0 && *value <= 1.0);
    let area = |value: &Value| number(value).filter(|value| *value > 0.0);
    let form = Conditions {
        administration: text("administration", &wire.administration)?,
        ship_type: text("ship-type", &wire.ship_type)?,
        particulars,
        beam: metres("beam-m", &wire.beam_m)?,
        draught: metres("draught-m", &wire.draught_m)?,
        full_load_draught: metres("full-load-draught-m", &wire.full_load_draught_m)?,
        block_coefficient: read("block-coefficient", &wire.block_coefficient, "a number above 0, at most 1", share)?,
        rudder_type: text("rudder-type", &wire.rudder_type)?,
        rudder_area: read("rudder-area-m2", &wire.rudder_area_m2, "a number of square metres above 0", area)?,
        rudders: whole("rudders", &wire.rudders, [1, 10], "a whole number from 1 to 10")?,
        propeller_type: text("propeller-type", &wire.propeller_type)?,
        propellers: whole("propellers", &wire.propellers, [1, 10], "a whole number from 1 to 10")?,
        engine_type: text("engine-type", &wire.engine_type)?,
        trim: read("trim-m", &wire.trim_m, "a number of metres, positive by the stern", number)?,
        ballast: text("ballast", &wire.ballast)?,
        water_depth: metres("water-depth-m", &wire.water_depth_m)?,
        wind_beaufort: whole(
            "wind-beaufort",
            &wire.wind_beaufort,
            [0, 12],
            "a whole number from 0 to 12 (the Beaufort scale)",
        )?,
        sea_state: whole("sea-state", &wire.sea_state, [0, 9], "a whole number from 0 to 9 (WMO sea state)")?,
        declared_loading: read("loading", &wire.loading, "\"full\" or \"partial\"", loading)?,
        remark: text("remark", &wire.remark)?,
    };
    let above = |one: Option<f64>, other: Option<f64>| matches!((one, other), (Some(one), Some(other)) if one >= other);
    let crossed = [
        (
            "beam-m",
            &wire.beam_m,
            above(form.beam, particulars.map(|own| own.length)),
            "a breadth below the length of [ship]",
        ),
        ("draught-m", &wire.draught_m, above(form.draught, form.water_depth), "a draught below water-depth-m"),
        ("draught-m", &wire.draught_m, above(form.draught, form.beam), "a draught below beam-m"),
        (
            "full-load-draught-m",
            &wire.full_load_draught_m,
            above(form.full_load_draught, form.beam),
            "a draught below beam-m",
        ),
    ];
    for (key, entry, is_wrong, expected) in crossed {
        if let Some(entry) = entry.as_ref().filter(|_| is_wrong) {
            return Err(fault(key, entry, expected));
        }
    }
    Ok(form)
}
