//! Looks of curves by their origin: one colour, marker and dash for every identification method, the record, the truth
//! and the bound, the same in every figure. The colours of methods are those of Okabe & Ito (2008), "Color universal
//! design", distinguishable with any common colour blindness. Two methods have the wine red and the indigo of Tol
//! (2021) instead, because yellow is too pale on paper and black is the colour of the truth. Marker and dash repeat the
//! distinction for prints in grey.

use serde::{Deserialize, Serialize};

pub use plotters::style::RGBColor;

/// Origin of a curve or a value.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum CurveOrigin {
    /// Measured (or simulated and noisy) record.
    Record,
    /// Noise-free truth of a simulation.
    Truth,
    /// Value printed in the literature.
    Published,
    /// Cramér–Rao bound.
    Bound,
    /// Model before an addition.
    Before,
    /// Model after effects are added.
    After,
    /// One of several series that are not methods, in greys.
    Series {
        /// Name in the legend.
        label: String,
        /// Number of the series, from 0.
        number: usize,
    },
    /// Identification method with its usual settings, by its id.
    Method(String),
    /// Identification method with other settings.
    Variant {
        /// Name in the legend.
        label: String,
        /// Id of the method, whose colour it keeps.
        method: String,
        /// Number of the variant of the method, from 0.
        number: usize,
    },
}

impl CurveOrigin {
    /// Name in a legend.
    pub fn label(&self) -> &str {
        match self {
            Self::Record => "record",
            Self::Truth => "truth",
            Self::Published => "published",
            Self::Bound => "Cramér–Rao bound",
            Self::Before => "before",
            Self::After => "after",
            Self::Method(label) | Self::Variant { label, .. } | Self::Series { label, .. } => label,
        }
    }

    /// Colour, marker and dash of the origin.
    pub fn style(&self) -> CurveStyle {
        match self {
            Self::Record => CurveStyle::new(RECORD, Marker::Circle, SOLID),
            Self::Truth => CurveStyle::new(INK, Marker::Circle, SOLID),
            Self::Published => CurveStyle::new(RECORD, Marker::Cross, DASHED),
            Self::Bound => CurveStyle::new(INK, Marker::Plus, DOTTED),
            Self::Before => CurveStyle::new(MODEL_BEFORE, Marker::Square, DASHED),
            Self::After => CurveStyle::new(HEADING, Marker::Circle, SOLID),
            Self::Method(id) => method_style(id),
            Self::Variant { method, number, .. } => variant_style(method, *number),
            Self::Series { number, .. } => series_style(*number),
        }
    }
}

/// Lengths of dash and gap, in line widths; empty is a solid line.
pub type Dash = &'static [f64];

/// Solid line.
pub const SOLID: Dash = &[];
/// Dashed line.
pub const DASHED: Dash = &[5.0, 2.5];
/// Dotted line.
pub const DOTTED: Dash = &[1.4, 1.8];
/// Dash-dotted line.
pub const DASH_DOT: Dash = &[6.0, 2.0, 1.4, 2.0];
/// Line of long dashes.
const LONG_DASH: Dash = &[10.0, 2.5];
/// Line of a dash and two dots.
const DASH_DOT_DOT: Dash = &[6.0, 1.8, 1.4, 1.8, 1.4, 1.8];
/// Line of short dashes.
pub const SHORT_DASH: Dash = &[3.0, 1.6];
/// Line of alternating long and short dashes.
const LONG_SHORT: Dash = &[12.0, 2.0, 3.0, 2.0];

/// Colour of text, frames and the truth.
pub const INK: RGBColor = RGBColor(0x11, 0x11, 0x11);
/// Colour of the record.
pub const RECORD: RGBColor = RGBColor(0x77, 0x77, 0x77);
/// Colour of data that are not highlighted.
pub const UNHIGHLIGHTED: RGBColor = RGBColor(0xB0, 0xB0, 0xB0);
/// Colour of grid lines.
pub const GRID: RGBColor = RGBColor(0xE2, 0xE2, 0xE2);
/// Colour of the background.
pub const BACKGROUND: RGBColor = RGBColor(0xFF, 0xFF, 0xFF);
/// Colour of the heading in a figure without methods.
pub const HEADING: RGBColor = RGBColor(0x00, 0x72, 0xB2);
/// Colour of the rudder.
pub const RUDDER: RGBColor = RGBColor(0xD5, 0x5E, 0x00);
/// Colour of a model before an addition.
pub const MODEL_BEFORE: RGBColor = RGBColor(0x88, 0x22, 0x55);
/// Colour of dimension lines and their numbers.
pub const DIMENSION_LINE: RGBColor = RGBColor(0x00, 0x7A, 0x5A);

/// Shape of a marker.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Marker {
    /// ●
    Circle,
    /// ■
    Square,
    /// ▲
    Up,
    /// ▼
    Down,
    /// ◆
    Diamond,
    /// +
    Plus,
    /// ×
    Cross,
    /// ★
    Star,
}

/// Style of the curves of an origin: colour, marker and dash.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CurveStyle {
    /// Colour of line and marker.
    pub colour: RGBColor,
    /// Shape at the data points.
    pub marker: Marker,
    /// Pattern of the line.
    pub dash: Dash,
    /// `true` if the marker is an outline only.
    pub is_hollow: bool,
}

impl CurveStyle {
    const fn new(colour: RGBColor, marker: Marker, dash: Dash) -> Self {
        Self { colour, marker, dash, is_hollow: false }
    }
}

/// Methods with their styles, in the order of figures.
const METHODS: [(&str, CurveStyle); 8] = [
    ("fourier-published", CurveStyle::new(RGBColor(0xE6, 0x9F, 0x00), Marker::Up, DASHED)),
    ("fourier-projected", CurveStyle::new(RGBColor(0xD5, 0x5E, 0x00), Marker::Down, DASH_DOT)),
    ("characteristic-points", CurveStyle::new(RGBColor(0xCC, 0x79, 0xA7), Marker::Diamond, DOTTED)),
    ("least-squares", CurveStyle::new(RGBColor(0x56, 0xB4, 0xE9), Marker::Square, LONG_DASH)),
    ("integral-least-squares", CurveStyle::new(RGBColor(0x00, 0x72, 0xB2), Marker::Plus, SHORT_DASH)),
    ("output-error", CurveStyle::new(RGBColor(0x00, 0x9E, 0x73), Marker::Circle, SOLID)),
    ("srivc", CurveStyle::new(RGBColor(0x88, 0x22, 0x55), Marker::Cross, DASH_DOT_DOT)),
    ("maximum-likelihood", CurveStyle::new(RGBColor(0x33, 0x22, 0x88), Marker::Star, LONG_SHORT)),
];

/// Colours of external estimators, which no method has: olive, brown, magenta, grey, sand, teal (after Tol, 2021).
const OUTSIDE: [RGBColor; 6] = [
    RGBColor(0x99, 0x99, 0x33),
    BROWN,
    RGBColor(0xAA, 0x44, 0x99),
    RGBColor(0x5A, 0x5A, 0x5A),
    RGBColor(0xDD, 0xCC, 0x77),
    RGBColor(0x44, 0xAA, 0x99),
];

/// Common id of external estimators.
const EXTERNAL: &str = "external";
/// Number of different styles of external estimators: the least common multiple of 6 colours, 5 markers and 4 dashes.
const STYLES: u64 = 60;

const BROWN: RGBColor = RGBColor(0x66, 0x11, 0x00);

/// Ids of the methods with a fixed style, in the order of figures.
pub fn method_ids() -> impl Iterator<Item = &'static str> {
    METHODS.iter().map(|(id, _)| *id)
}

/// Style of a variant: one of three shades of the colour of its method, a hollow marker, and marker and dash by its
/// number. External estimators have different colours, which repeat after six.
fn variant_style(method: &str, number: usize) -> CurveStyle {
    const MARKERS: [Marker; 5] = [Marker::Circle, Marker::Square, Marker::Diamond, Marker::Up, Marker::Down];
    const DASHES: [Dash; 4] = [DOTTED, SHORT_DASH, DASH_DOT, LONG_DASH];
    let (marker, dash) = (MARKERS[number % MARKERS.len()], DASHES[number % DASHES.len()]);
    let shade = |part: u8| (f64::from(part) * 0.6_f64.powi((number % 3) as i32)) as u8;
    let colour = match method {
        EXTERNAL => OUTSIDE[number % OUTSIDE.len()],
        method => {
            let RGBColor(red, green, blue) = method_style(method).colour;
            RGBColor(shade(red), shade(green), shade(blue))
        }
    };
    CurveStyle { marker, dash, is_hollow: true, colour }
}

/// Style of a series: a grey, so that it does not look like a method, and marker and dash by its number.
fn series_style(number: usize) -> CurveStyle {
    const SHADES: [RGBColor; 3] = [INK, RGBColor(0x5A, 0x5A, 0x5A), RGBColor(0x96, 0x96, 0x96)];
    const MARKERS: [Marker; 5] = [Marker::Circle, Marker::Square, Marker::Diamond, Marker::Up, Marker::Down];
    const DASHES: [Dash; 4] = [SOLID, SHORT_DASH, DOTTED, DASH_DOT];
    CurveStyle {
        is_hollow: number % 2 == 1,
        ..CurveStyle::new(SHADES[number % SHADES.len()], MARKERS[number % MARKERS.len()], DASHES[number % DASHES.len()])
    }
}

/// Style of a method; a method outside the list has the style of an external estimator, chosen by its name, in all
/// figures.
fn method_style(id: &str) -> CurveStyle {
    // A trace and the rule that chooses a method are not in the list of methods, but are shown with them.
    match id {
        "trace" => return CurveStyle::new(INK, Marker::Square, SOLID),
        "recommended" => return CurveStyle { is_hollow: true, ..CurveStyle::new(BROWN, Marker::Diamond, DASHED) },
        _ => {}
    }
    if let Some((_, style)) = METHODS.iter().find(|(method, _)| *method == id) {
        return *style;
    }
    // FNV-1a, because the standard hasher does not guarantee the same value in the next release.
    let hash = id.bytes().fold(0xcbf2_9ce4_8422_2325_u64, |h, b| (h ^ u64::from(b)).wrapping_mul(0x0100_0000_01b3));
    variant_style(EXTERNAL, (hash % STYLES) as usize)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn methods_differ_in_colour_marker_and_dash() {
        for (i, (_, a)) in METHODS.iter().enumerate() {
            for (_, b) in &METHODS[i + 1..] {
                assert!(a.colour != b.colour && a.marker != b.marker && a.dash != b.dash);
            }
        }
    }

    #[test]
    fn variants_have_shades_of_the_colour_of_their_method() {
        let variant = |number| CurveOrigin::Variant { label: "other".into(), method: "srivc".into(), number }.style();
        let method = CurveOrigin::Method("srivc".into()).style();
        assert_eq!(variant(0).colour, method.colour);
        assert_eq!(variant(1).colour, RGBColor(0x51, 0x14, 0x33));
        assert!(variant(0).marker != variant(1).marker && variant(0).dash != variant(1).dash);
    }

    #[test]
    fn estimators_outside_differ_in_colour() {
        let outside =
            |number| CurveOrigin::Variant { label: "other".into(), method: "external".into(), number }.style();
        for number in 0..OUTSIDE.len() {
            assert!(METHODS.iter().all(|(_, style)| style.colour != outside(number).colour));
            assert!((0..number).all(|other| outside(other).colour != outside(number).colour));
        }
    }

    #[test]
    fn unknown_method_has_a_stable_hollow_style() {
        let style = CurveOrigin::Method("ridge".into()).style();
        assert_eq!(style, CurveOrigin::Method("ridge".into()).style());
        assert!(style.is_hollow);
    }
}
