//! User's style over a theme: sizes, colours and limits of axes, as a program reads them from a file.

use std::collections::BTreeMap;
use std::sync::Arc;

use serde::Deserialize;
use thiserror::Error;

use crate::changes::{StyleChanges, colour};
use crate::palette::{
    BACKGROUND, CurveOrigin, DIMENSION_LINE, GRID, HEADING, INK, MODEL_BEFORE, RECORD, RUDDER, method_ids,
};
use crate::theme::Theme;
use plotters::style::RGBColor;

/// Minimum and maximum font size, points.
const FONT: [f64; 2] = [4.0, 30.0];
/// Minimum and maximum width of lines and radius of markers, points.
const LINE: [f64; 2] = [0.1, 10.0];

/// Style of figures; keys that are not given are as in the theme. All keys are kebab-case.
///
/// The font family is bundled, because labels are placed by its widths.
#[derive(Debug, Clone, PartialEq, Default, Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "kebab-case", deny_unknown_fields, default)]
pub struct Style {
    /// Width of the figures, mm; it makes them figures for print.
    pub width_mm: Option<f64>,
    /// Resolution, dots per inch.
    pub dpi: Option<f64>,
    /// Size of the titles of axes, points; all other type keeps its proportion to it.
    pub font_size_pt: Option<f64>,
    /// Width of curves, points; all other lines keep their proportion to it.
    pub line_width_pt: Option<f64>,
    /// Radius of markers, points; measured points keep their proportion to it.
    pub marker_radius_pt: Option<f64>,
    /// Colours as `#0072B2` by the id of a method, or `ink`, `paper`, `grid`, `record`, `heading`, `rudder`, `before`
    /// or `dimension`. Two keys that share a colour (as `heading` and `integral-least-squares` do) change together.
    pub colours: BTreeMap<String, String>,
    /// Ends of axes by the titles of the axes, in their units.
    pub limits: BTreeMap<String, [f64; 2]>,
}

/// Error of a style.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum StyleError {
    /// A size is out of its range.
    #[error("{key} = {value}: expected a number from {} to {}", range[0], range[1])]
    Size {
        /// Key of the size.
        key: &'static str,
        /// Given value.
        value: f64,
        /// Minimum and maximum value.
        range: [f64; 2],
    },
    /// A key of `colours` that is unknown.
    #[error("[colours] {name}: nothing has this name; expected one of {valid}")]
    Name {
        /// Given name.
        name: String,
        /// All valid names.
        valid: String,
    },
    /// A value that is not a colour.
    #[error("[colours] {name} = \"{value}\": expected red, green and blue as in \"#0072B2\"")]
    Colour {
        /// Key of the colour.
        name: String,
        /// Given value.
        value: String,
    },
    /// Two colours for two keys that share one.
    #[error(
        "[colours] {name} = \"{value}\": it shares its colour with {other}, which is set to another one; set one of them"
    )]
    Shared {
        /// Key of the colour.
        name: String,
        /// Given value.
        value: String,
        /// Key that shares the colour.
        other: String,
    },
    /// Limits in the wrong order.
    #[error("[limits] \"{title}\" = [{}, {}]: expected two numbers, the smaller one first", value[0], value[1])]
    Limits {
        /// Title of the axis.
        title: String,
        /// Given value.
        value: [f64; 2],
    },
}

/// Keys of `colours`, with their default colours.
fn coloured() -> impl Iterator<Item = (&'static str, RGBColor)> {
    let parts = [
        ("ink", INK),
        ("paper", BACKGROUND),
        ("grid", GRID),
        ("record", RECORD),
        ("heading", HEADING),
        ("rudder", RUDDER),
        ("before", MODEL_BEFORE),
        ("dimension", DIMENSION_LINE),
    ];
    parts.into_iter().chain(method_ids().map(|id| (id, CurveOrigin::Method(id.to_owned()).style().colour)))
}

impl Style {
    /// Theme with the sizes, resolution, colours and limits of this style. `width_mm` is not applied: the caller makes
    /// a theme of that width.
    ///
    /// Fails if a size is out of its range, if a colour has an unknown key or no valid value, if two keys that share a
    /// colour have different values, and if limits are not in ascending order.
    pub fn apply_to(&self, theme: Theme) -> Result<Theme, StyleError> {
        let share = |key: &'static str, value: Option<f64>, usual: f64, range: [f64; 2]| match value {
            Some(value) if !(range[0]..=range[1]).contains(&value) => Err(StyleError::Size { key, value, range }),
            value => Ok(value.map_or(1.0, |value| value / usual)),
        };
        let font = share("font-size-pt", self.font_size_pt, theme.label_font, FONT)?;
        let line = share("line-width-pt", self.line_width_pt, theme.line, LINE)?;
        let marker = share("marker-radius-pt", self.marker_radius_pt, theme.marker, LINE)?;
        let dpi = share("dpi", self.dpi, theme.dpi, crate::theme::DPI_RANGE)?;
        Ok(Theme {
            dpi: theme.dpi * dpi,
            tick_font: theme.tick_font * font,
            label_font: theme.label_font * font,
            small_font: theme.small_font * font,
            title_font: theme.title_font * font,
            line: theme.line * line,
            thin: theme.thin * line,
            marker: theme.marker * marker,
            dot: theme.dot * marker,
            changes: Arc::new(StyleChanges { colours: self.colours()?, limits: self.limits()?.clone() }),
            ..theme
        })
    }

    fn colours(&self) -> Result<Vec<(RGBColor, RGBColor)>, StyleError> {
        let mut changes: Vec<(&str, RGBColor, RGBColor)> = Vec::new();
        for (name, text) in &self.colours {
            let Some((_, old)) = coloured().find(|(id, _)| id == name) else {
                let ids: Vec<&str> = coloured().map(|(id, _)| id).collect();
                return Err(StyleError::Name { name: name.clone(), valid: ids.join(", ") });
            };
            let wrong = || StyleError::Colour { name: name.clone(), value: text.clone() };
            let new = colour(text).ok_or_else(wrong)?;
            match changes.iter().find(|(_, other, _)| *other == old) {
                Some((other, _, another)) if *another != new => {
                    let (name, value, other) = (name.clone(), text.clone(), (*other).to_owned());
                    return Err(StyleError::Shared { name, value, other });
                }
                Some(_) => {}
                None => changes.push((name, old, new)),
            }
        }
        Ok(changes.into_iter().map(|(_, old, new)| (old, new)).collect())
    }

    fn limits(&self) -> Result<&BTreeMap<String, [f64; 2]>, StyleError> {
        let wrong = self.limits.iter().find(|(_, [lo, hi])| !(lo.is_finite() && hi.is_finite() && lo < hi));
        match wrong {
            Some((title, ends)) => Err(StyleError::Limits { title: title.clone(), value: *ends }),
            None => Ok(&self.limits),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::curve::PlotCurve;
    use crate::figures::{AxisSpec, Layer, PanelRow, Panels, Pen, Plot};

    fn drawn(style: &Style) -> String {
        let line = |y: [f64; 3], colour| Layer::line("", PlotCurve::new([0.0, 50.0, 100.0], y), Pen::new(colour));
        let rows = vec![
            (PanelRow::new(AxisSpec::heading(), 0.28), vec![line([0.0, 3.0, -2.0], HEADING)]),
            (PanelRow::new(AxisSpec::rudder(), 0.13), vec![line([0.0, 10.0, -10.0], RUDDER)]),
        ];
        let theme = style.apply_to(Theme::screen()).unwrap();
        Plot::from(Panels::over_time(rows)).draw("\"#D55E00\"", &theme).svg().to_owned()
    }

    #[test]
    fn sizes_colours_and_limits_reach_the_figure() {
        let plain = drawn(&Style::default());
        assert!(plain.contains("=\"#D55E00\"") && plain.contains("font-size=\"240"));
        let style = Style {
            font_size_pt: Some(15.0),
            line_width_pt: Some(2.7),
            colours: [("rudder", "#0072B2"), ("ink", "#010203")].map(|(a, b)| (a.into(), b.into())).into(),
            limits: [(String::from("rudder δ [°]"), [-90.0, 90.0])].into(),
            ..Style::default()
        };
        let styled = drawn(&style);
        assert!(styled.contains("font-size=\"300") && styled.contains("stroke-width=\"54\""), "{styled}");
        assert!(styled.contains("=\"#0072B2\"") && styled.contains("=\"#010203\"") && !styled.contains("=\"#D55E00\""));
        assert!(styled.contains("&quot;#D55E00&quot;"), "text is left alone");
        assert!(styled.contains("\n−60\n") || styled.contains("\n−50\n") || styled.contains("\n−80\n"), "{styled}");
    }

    #[test]
    fn what_is_wrong_is_named() {
        let of =
            |name: &str, colour: &str| Style { colours: [(name.into(), colour.into())].into(), ..Style::default() };
        let text = |style: Style| style.apply_to(Theme::screen()).unwrap_err().to_string();
        assert!(
            text(of("output-eror", "#000000")).contains("[colours] output-eror: nothing has this name; expected one")
        );
        for wrong in ["#00", "red", "#00000g", "#ééé"] {
            assert!(text(of("ink", wrong)).contains(wrong), "{wrong}");
        }
        let mut two = of("heading", "#000000");
        two.colours.insert("integral-least-squares".into(), "#FFFFFF".into());
        assert!(text(two).contains("shares its colour with heading"));
        let size = Style { font_size_pt: Some(100.0), ..Style::default() };
        assert_eq!(text(size), "font-size-pt = 100: expected a number from 4 to 30");
        let limits = Style { limits: [("x".into(), [2.0, 1.0])].into(), ..Style::default() };
        assert_eq!(text(limits), "[limits] \"x\" = [2, 1]: expected two numbers, the smaller one first");
    }
}
