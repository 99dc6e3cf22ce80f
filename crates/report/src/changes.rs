//! Changes of a style to a finished drawing in addition to sizes: replaced colours, and ends of axes.

use std::collections::BTreeMap;

use crate::axis::Axis;
use crate::markup::is_markup;
use plotters::style::RGBColor;

/// Replacement colours, and ends of axes by their titles.
#[derive(Debug, Clone, PartialEq, Default)]
pub(crate) struct StyleChanges {
    /// Colours with their replacements.
    pub colours: Vec<(RGBColor, RGBColor)>,
    /// Lower and upper ends of axes by their titles.
    pub limits: BTreeMap<String, [f64; 2]>,
}

/// Colour read from text such as `#0072B2`; `None` for any other text.
pub(crate) fn colour(text: &str) -> Option<RGBColor> {
    let digits = text.strip_prefix('#').filter(|digits| digits.len() == 6 && digits.is_ascii())?;
    let part = |at: usize| u8::from_str_radix(&digits[at..at + 2], 16).ok();
    Some(RGBColor(part(0)?, part(2)?, part(4)?))
}

impl StyleChanges {
    /// Replacement of a colour; the colour itself if it has none.
    pub(crate) fn replacement(&self, colour: RGBColor) -> RGBColor {
        self.colours.iter().find(|(old, _)| *old == colour).map_or(colour, |(_, new)| *new)
    }

    /// Axis with the ends given for its title. A list of names is unchanged, as is a logarithmic axis whose given lower
    /// end is zero or negative.
    pub(crate) fn limited(&self, axis: Axis, title: &str) -> Axis {
        let is_titled = |wanted: &str| wanted.chars().eq(title.chars().filter(|&c| !is_markup(c)));
        match self.limits.iter().find(|(wanted, _)| is_titled(wanted)) {
            Some((_, [lo, hi])) if !axis.is_names() && (*lo > 0.0 || !axis.is_logarithmic()) => axis.between(*lo, *hi),
            _ => axis,
        }
    }
}
