//! Particulars of a ship: keys and units, valid ranges, and typical ratios that replace missing particulars.

use thiserror::Error;

use crate::short_number::ShortNumber;

/// Particulars of a ship in SI units; only length and speed are required, any other is `None` if it is not given.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct HullParticulars {
    /// Length between perpendiculars L, m.
    pub length: f64,
    /// Approach speed U, m/s.
    pub speed: f64,
    /// Beam B, m.
    pub beam: Option<f64>,
    /// Mean draught d, m.
    pub draught: Option<f64>,
    /// Block coefficient C_b.
    pub block_coefficient: Option<f64>,
    /// Area of the movable part of the rudder A_R, m².
    pub rudder_area: Option<f64>,
    /// Height of the rudder H_R, m.
    pub rudder_height: Option<f64>,
    /// Diameter of the propeller D_P, m.
    pub propeller_diameter: Option<f64>,
    /// Revolutions of the propeller at the approach speed n, 1/s.
    pub propeller_rate: Option<f64>,
    /// Mass of the displaced water, kg.
    pub displacement: Option<f64>,
    /// Centre of gravity x_G forward of midship, m.
    pub x_g: Option<f64>,
}

/// Kilograms in a tonne.
const TONNE: f64 = 1000.0;

/// Declaration of a particular, for options, sidecars and scenarios.
#[derive(Debug, Clone, Copy)]
pub struct Particular {
    /// Key, which ends in the unit.
    pub key: &'static str,
    /// Symbol in formulas, such as L or C_b.
    pub symbol: &'static str,
    /// Unit; "1" for a nondimensional particular.
    pub unit: &'static str,
    /// Meaning.
    pub meaning: &'static str,
    /// Minimum and maximum valid value, in its unit.
    pub range: [f64; 2],
    get: fn(&HullParticulars) -> Option<f64>,
    set: fn(&mut HullParticulars, f64),
    /// Value of a complete hull; `None` for a particular that is not a dimension of the hull.
    pub(super) of_form: Option<fn(&HullDimensions) -> f64>,
}

impl Particular {
    /// Particular with this key; `None` for an unknown key.
    pub fn find(key: &str) -> Option<&'static Self> {
        PARTICULARS.iter().find(|particular| particular.key == key)
    }

    /// Value in its unit; `None` if it is not given.
    pub fn get(&self, particulars: &HullParticulars) -> Option<f64> {
        (self.get)(particulars)
    }

    /// Sets a value, in its unit.
    pub fn set(&self, particulars: &mut HullParticulars, value: f64) {
        (self.set)(particulars, value);
    }
}

/// Getter and setter of a particular.
type ParticularAccess = (fn(&HullParticulars) -> Option<f64>, fn(&mut HullParticulars, f64));

/// Getter and setter of an optional field, or of a required field that is zero if it is missing.
macro_rules! access {
    (optional $field:ident) => {
        (|p| p.$field, |p, value| p.$field = Some(value))
    };
    (needed $field:ident) => {
        (|p| (p.$field != 0.0).then_some(p.$field), |p, value| p.$field = value)
    };
}

/// Particular from key, symbol, unit and meaning, range, getter and setter, and value of a complete hull.
const fn particular(
    [key, symbol, unit, meaning]: [&'static str; 4],
    range: [f64; 2],
    (get, set): ParticularAccess,
    of_form: Option<fn(&HullDimensions) -> f64>,
) -> Particular {
    Particular { key, symbol, unit, meaning, range, get, set, of_form }
}

/// All particulars.
pub const PARTICULARS: [Particular; 11] = [
    particular(["length-m", "L", "m", "Length between perpendiculars"], [0.1, 1000.0], access!(needed length), None),
    particular(["beam-m", "B", "m", "Beam"], [0.01, 200.0], access!(optional beam), Some(|form| form.B)),
    particular(["draught-m", "d", "m", "Mean draught"], [0.005, 50.0], access!(optional draught), Some(|form| form.d)),
    particular(
        ["block-coefficient", "C_b", "1", "Block coefficient"],
        [0.3, 1.0],
        access!(optional block_coefficient),
        Some(|form| form.Cb),
    ),
    particular(["speed-m-s", "U", "m/s", "Approach speed"], [0.01, 100.0], access!(needed speed), None),
    particular(
        ["rudder-area-m2", "A_R", "m²", "Area of the rudder, of all rudders together"],
        [1e-5, 500.0],
        access!(optional rudder_area),
        Some(|form| form.AR),
    ),
    particular(
        ["rudder-height-m", "H_R", "m", "Height of the rudder"],
        [0.005, 50.0],
        access!(optional rudder_height),
        Some(|form| form.HR),
    ),
    particular(
        ["propeller-diameter-m", "D_P", "m", "Diameter of the propeller"],
        [0.005, 15.0],
        access!(optional propeller_diameter),
        Some(|form| form.DP),
    ),
    particular(
        ["propeller-rps", "n", "1/s", "Revolutions of the propeller at the approach speed"],
        [0.05, 100.0],
        access!(optional propeller_rate),
        None,
    ),
    particular(
        ["displacement-t", "Δ", "t", "Displacement"],
        [1e-4, 1e6],
        (|p| p.displacement.map(|mass| mass / TONNE), |p, value| p.displacement = Some(value * TONNE)),
        None,
    ),
    particular(
        ["x-g-m", "x_G", "m", "Centre of gravity, forward of midship"],
        [-100.0, 100.0],
        access!(optional x_g),
        Some(|form| form.xG),
    ),
];

/// Typical ratio of ships, with the particular that it replaces.
#[derive(Debug, Clone, Copy)]
pub(super) struct Ratio {
    pub name: &'static str,
    pub fills: &'static str,
    pub mean: f64,
    pub sd: f64,
    /// Range of ships.
    range: [f64; 2],
    ratio: fn(&HullDimensions) -> f64,
}

impl Ratio {
    const fn new(
        [name, fills]: [&'static str; 2],
        [mean, sd]: [f64; 2],
        range: [f64; 2],
        ratio: fn(&HullDimensions) -> f64,
    ) -> Self {
        Self { name, fills, mean, sd, range, ratio }
    }

    /// Mean and standard deviation as text.
    pub fn text(&self) -> String {
        format!("{} = {} ± {}", self.name, self.mean, self.sd)
    }
}

/// Typical ratios: mean and standard deviation over KVLCC2, KCS, ONRT, Esso Osaka and SEIUN MARU, ratios of rudder and
/// propeller without ONRT, which has two rudders and two propellers. Sources: particulars of SIMMAN 2014, of the 3 m
/// model of Esso Osaka (Osaka University, mmg-1p1r-simulator) and of SEIUN MARU (mmgdynamics).
pub(super) const RATIOS: [Ratio; 7] = [
    Ratio::new(["L/B", "beam-m"], [6.6, 1.1], [2.0, 12.0], |form| form.L / form.B),
    Ratio::new(["B/d", "draught-m"], [2.9, 0.35], [1.2, 8.0], |form| form.B / form.d),
    Ratio::new(["C_b", "block-coefficient"], [0.67, 0.15], [0.3, 1.0], |form| form.Cb),
    Ratio::new(["A_R/(L d)", "rudder-area-m2"], [0.019, 0.003], [0.005, 0.1], |form| form.AR / (form.L * form.d)),
    Ratio::new(["H_R/d", "rudder-height-m"], [0.78, 0.12], [0.2, 1.5], |form| form.HR / form.d),
    Ratio::new(["D_P/d", "propeller-diameter-m"], [0.6, 0.18], [0.15, 1.3], |form| form.DP / form.d),
    Ratio::new(["x_G/L", "x-g-m"], [0.0, 0.02], [-0.1, 0.1], |form| form.xG / form.L),
];

/// Usual range of the Froude number of displacement ships in manoeuvring trials. A model with the length of its ship,
/// or a ship with the length of its model, is outside.
pub const USUAL_FROUDE_NUMBER: [f64; 2] = [0.025, 0.6];
/// Range of the advance ratio of propellers that drive a ship ahead.
const ADVANCE_RANGE: [f64; 2] = [0.1, 1.3];
/// Relative tolerance between displacement and C_b L B d.
const DISPLACEMENT_TOLERANCE: f64 = 0.05;

/// Acceleration of gravity, m/s².
pub(super) const GRAVITY: f64 = 9.81;
/// Density of sea water, kg/m³.
const SEA_WATER: f64 = 1025.0;
/// Density of fresh water, kg/m³.
const FRESH_WATER: f64 = 1000.0;
/// Minimum length of a ship in sea water, m; a shorter ship is a model in fresh water.
const MIN_SHIP_LENGTH_M: f64 = 30.0;

/// Complete dimensions of a hull in SI units; `n` is `None` for unknown propeller revolutions.
#[derive(Debug, Clone, Copy)]
pub(super) struct HullDimensions {
    pub L: f64,
    pub U: f64,
    pub B: f64,
    pub d: f64,
    pub Cb: f64,
    pub AR: f64,
    pub HR: f64,
    pub DP: f64,
    pub xG: f64,
    pub n: Option<f64>,
}

/// Error of a particular outside the range of ships.
#[derive(Debug, Clone, PartialEq, Error)]
#[error("{quantity} is {}{}, expected {} to {}{}; {advice}", ShortNumber::rounded(*.value, 4), in_unit(.unit),
    ShortNumber::rounded(.range[0], 4), ShortNumber::rounded(.range[1], 4), in_unit(.unit))]
pub struct ParticularsError {
    /// Key of the particular, or the last key of a contradiction.
    pub key: &'static str,
    /// Quantity, with the keys that give it.
    pub quantity: String,
    /// Rejected value.
    pub value: f64,
    /// Range of ships.
    pub range: [f64; 2],
    /// Unit of value and range.
    pub unit: &'static str,
    /// Advice for the user.
    pub advice: &'static str,
}

fn in_unit(unit: &str) -> String {
    if unit == "1" { String::new() } else { format!(" {unit}") }
}

impl HullParticulars {
    /// Volume of the displaced water, m³; `None` if the displacement is not given.
    fn volume(&self) -> Option<f64> {
        let density = if self.length < MIN_SHIP_LENGTH_M { FRESH_WATER } else { SEA_WATER };
        self.displacement.map(|mass| mass / density)
    }

    /// Complete dimensions, with these values of [`RATIOS`] for missing particulars; a given displacement has
    /// precedence over a ratio.
    pub(super) fn complete_dimensions(&self, ratios: &[f64; 7]) -> HullDimensions {
        let [length_beam, beam_draught, fullness, area, height, diameter, gravity] = *ratios;
        let (L, volume) = (self.length, self.volume());
        let full = self.block_coefficient.unwrap_or(fullness);
        let by_volume = || Some(volume? / (L * self.draught? * full));
        let B = self.beam.or_else(by_volume).unwrap_or(L / length_beam);
        let d = self.draught.or(volume.map(|volume| volume / (L * B * full))).unwrap_or(B / beam_draught);
        let Cb = self.block_coefficient.or(volume.map(|volume| volume / (L * B * d))).unwrap_or(fullness);
        HullDimensions {
            L,
            U: self.speed,
            B,
            d,
            Cb,
            AR: self.rudder_area.unwrap_or(area * L * d),
            HR: self.rudder_height.unwrap_or(height * d),
            DP: self.propeller_diameter.unwrap_or(diameter * d),
            xG: self.x_g.unwrap_or(gravity * L),
            n: self.propeller_rate,
        }
    }

    /// `true` if any particular other than length and speed is given.
    pub fn has_more_than_length_and_speed(&self) -> bool {
        *self != Self { length: self.length, speed: self.speed, ..Self::default() }
    }

    /// Check of every particular, and then of Froude number, ratios, displaced volume and advance ratio, against the
    /// ranges of ships. Fails with the first value outside.
    pub fn check(&self) -> Result<(), ParticularsError> {
        for Particular { key, unit, range, get, .. } in PARTICULARS {
            let needed = matches!(key, "length-m" | "speed-m-s").then_some(0.0);
            if let Some(value) = get(self).or(needed) {
                within(key, key.to_owned(), value, range, unit, "correct the number, or leave it out if unknown")?;
            }
        }
        let form = &self.complete_dimensions(&RATIOS.map(|ratio| ratio.mean));
        let advice = "give length and speed at one scale: both of the ship, or both of the model";
        within(
            "speed-m-s",
            "the Froude number of length-m and speed-m-s".into(),
            self.froude_number(),
            USUAL_FROUDE_NUMBER,
            "1",
            advice,
        )?;
        for Ratio { name, fills, range, ratio, .. } in RATIOS {
            let advice = "give all lengths of one ship at one scale, in metres; a missing particular is estimated from the length \
                        (`study list priors`)";
            within(fills, format!("{name} ({fills})"), ratio(form), range, "1", advice)?;
        }
        if let Some(volume) = self.volume() {
            let share = volume / (form.Cb * form.L * form.B * form.d);
            let range = [1.0 - DISPLACEMENT_TOLERANCE, 1.0 + DISPLACEMENT_TOLERANCE];
            let advice = "correct one of displacement-t, block-coefficient, length-m, beam-m and draught-m";
            let quantity = "the displaced volume of displacement-t over C_b L B d";
            within("displacement-t", quantity.into(), share, range, "1", advice)?;
        }
        let advice = "give revolutions per second, and the diameter and the speed of the same scale";
        let quantity = "the advance ratio of propeller-rps, propeller-diameter-m and speed-m-s";
        within("propeller-rps", quantity.into(), form.advance_ratio(), ADVANCE_RANGE, "1", advice)
    }
}

fn within(
    key: &'static str,
    quantity: String,
    value: f64,
    range: [f64; 2],
    unit: &'static str,
    advice: &'static str,
) -> Result<(), ParticularsError> {
    let [lowest, highest] = range;
    // NaN is outside every range.
    if (lowest..=highest).contains(&value) {
        return Ok(());
    }
    Err(ParticularsError { key, quantity, value, range, unit, advice })
}
