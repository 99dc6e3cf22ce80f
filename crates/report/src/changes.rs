//! What a style changes in a finished drawing besides sizes: one colour for another, and the ends of axes.

use crate::axis::Axis;
use crate::colour::Colour;
use crate::markup::is_markup;

/// Most colours that can be changed.
pub(crate) const COLOURS: usize = 16;

/// Colours in the place of others, and ends of axes by their titles.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct Changes {
    pub colours: [Option<(Colour, Colour)>; COLOURS],
    pub limits: &'static [(String, [f64; 2])],
}

/// Reads `#0072B2`.
pub(crate) fn colour(text: &str) -> Option<Colour> {
    let digits = text.strip_prefix('#').filter(|digits| digits.len() == 6 && digits.is_ascii())?;
    let part = |at: usize| u8::from_str_radix(&digits[at..at + 2], 16).ok();
    Some(Colour(part(0)?, part(2)?, part(4)?))
}

impl Changes {
    /// An SVG document in other colours.
    pub(crate) fn recoloured(&self, svg: String) -> String {
        if self.colours.iter().all(Option::is_none) {
            return svg;
        }
        // Quotes inside a text are escaped, so this is the beginning of a colour.
        let mut pieces = svg.split("=\"#");
        let mut out = String::from(pieces.next().unwrap_or_default());
        for piece in pieces {
            let own = piece.get(..6).and_then(|digits| colour(&format!("#{digits}")));
            let new = own.and_then(|own| self.colours.iter().flatten().find(|(old, _)| *old == own));
            out.push_str("=\"#");
            match new {
                Some((_, Colour(red, green, blue))) => {
                    out.push_str(&format!("{red:02X}{green:02X}{blue:02X}{}", &piece[6..]));
                }
                None => out.push_str(piece),
            }
        }
        out
    }

    /// Ends of the axis with a title, where they are given. A list of names stays, as does a logarithmic axis that
    /// should begin at zero or below.
    pub(crate) fn limit(&self, axis: &mut Axis, title: &str) {
        let is_titled = |wanted: &str| wanted.chars().eq(title.chars().filter(|&c| !is_markup(c)));
        let Some((_, [lo, hi])) = self.limits.iter().find(|(wanted, _)| is_titled(wanted)) else { return };
        if axis.is_numeric() && (*lo > 0.0 || !axis.is_logarithmic()) {
            *axis = axis.clone().between(*lo, *hi);
        }
    }
}
