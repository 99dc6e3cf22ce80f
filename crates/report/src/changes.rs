//! What a style changes in a finished drawing besides sizes: one colour for another, and the ends of axes.

use std::collections::BTreeMap;

use crate::axis::Axis;
use crate::markup::is_markup;
use plotters::style::RGBColor;

/// Colours in the place of others, and ends of axes by their titles.
#[derive(Debug, Clone, PartialEq, Default)]
pub(crate) struct Changes {
    pub colours: Vec<(RGBColor, RGBColor)>,
    pub limits: BTreeMap<String, [f64; 2]>,
}

/// Reads `#0072B2`.
pub(crate) fn colour(text: &str) -> Option<RGBColor> {
    let digits = text.strip_prefix('#').filter(|digits| digits.len() == 6 && digits.is_ascii())?;
    let part = |at: usize| u8::from_str_radix(&digits[at..at + 2], 16).ok();
    Some(RGBColor(part(0)?, part(2)?, part(4)?))
}

impl Changes {
    /// The colour in whose place this one stands.
    pub(crate) fn of(&self, colour: RGBColor) -> RGBColor {
        self.colours.iter().find(|(old, _)| *old == colour).map_or(colour, |(_, new)| *new)
    }

    /// The axis of a title with the ends that are given for it. A list of names stays, as does a logarithmic axis that
    /// should begin at zero or below.
    pub(crate) fn limited(&self, axis: Axis, title: &str) -> Axis {
        let is_titled = |wanted: &str| wanted.chars().eq(title.chars().filter(|&c| !is_markup(c)));
        match self.limits.iter().find(|(wanted, _)| is_titled(wanted)) {
            Some((_, [lo, hi])) if !axis.is_names() && (*lo > 0.0 || !axis.is_logarithmic()) => axis.between(*lo, *hi),
            _ => axis,
        }
    }
}
