//! Heading, yaw rate and yaw acceleration above each other: what differentiation makes of a small error in the heading.

use serde::{Deserialize, Serialize};

use super::shared::{PAD, heading_title, time_side};
use crate::axis::Axis;
use crate::curve::Curve;
use crate::figure::Figure;
use crate::layout::{Grid, Sheet, Side};
use crate::legend::{Entry, stroke_of};
use crate::markup::symbol;
use crate::palette::Origin;
use crate::theme::Theme;
use crate::ticks::Steps;

/// One source of heading, yaw rate and yaw acceleration; an empty curve is not drawn.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct MotionCurves {
    /// Where the curves come from; decides how they look.
    pub origin: Origin,
    /// Name in the legend, when it is not that of the origin.
    pub name: Option<String>,
    /// Heading, degrees over seconds.
    pub heading: Curve,
    /// Yaw rate, degrees per second over seconds.
    pub yaw_rate: Curve,
    /// Yaw acceleration, degrees per second squared over seconds.
    pub yaw_acceleration: Curve,
}

/// What [`derivatives`] draws.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Derivatives {
    /// Title above the figure.
    pub title: Option<String>,
    /// The sources, drawn in this order.
    pub curves: Vec<MotionCurves>,
}

type Pick = fn(&MotionCurves) -> &Curve;
const QUANTITIES: [Pick; 3] = [|c| &c.heading, |c| &c.yaw_rate, |c| &c.yaw_acceleration];

/// Draws the three panels over one time axis.
pub fn derivatives(data: &Derivatives, theme: &Theme) -> Figure {
    let mut sheet = Sheet::new(theme, data.title.as_deref());
    let name = |c: &MotionCurves| c.name.clone().unwrap_or_else(|| c.origin.label().to_owned());
    let entries: Vec<Entry> =
        data.curves.iter().map(|c| Entry { label: name(c), ..Entry::line_of(&c.origin, theme) }).collect();
    sheet.legend(&entries);
    let titles =
        [heading_title(), format!("yaw rate {} [°/s]", symbol("r")), format!("yaw accel. {} [°/s²]", symbol("ṙ"))];
    let side = |pick: Pick, title| {
        let values = data.curves.iter().flat_map(|c| pick(c).finite().map(|(_, y)| y));
        (Side::new(Axis::covering(values, PAD, Steps::Decimal), title), theme.tall(0.2))
    };
    let rows = QUANTITIES.into_iter().zip(titles).map(|(pick, title)| side(pick, title)).collect();
    let time = time_side(data.curves.iter().flat_map(|c| QUANTITIES.map(|pick| pick(c))));
    let panels = sheet.grid(Grid::stack(time, rows));
    for (panel, pick) in panels.iter().zip(QUANTITIES) {
        for curves in &data.curves {
            panel.line(&mut sheet.scene, pick(curves).pairs(), stroke_of(&curves.origin, theme));
        }
    }
    sheet.finish()
}
