//! Panels of layers (lines, bands, records, marks) over numeric axes: stacked over one axis where they belong to the
//! same one, groups of them side by side where they do not. What a figure shows is data; nothing is drawn anywhere else
//! for records, residuals, bands, phase planes and shares.

use super::shared::{PAD, area_entry, record, record_entry, shaded, widened, zero_line, zero_upright};
use crate::axis::{self, Axis};
use crate::colour::Colour;
use crate::curve::Curve;
use crate::figure::Figure;
use crate::layout::{Grid, Sheet, Side};
use crate::legend::{Entry, Sample};
use crate::markup::symbol;
use crate::palette::{DASHED, DOTTED, Dash, INK, Look, Origin, SOLID};
use crate::panel::Panel;
use crate::scene::{Layer as Height, Stroke};
use crate::theme::Theme;
use crate::ticks::Steps;

/// How an axis is divided.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Division {
    /// Equal steps of 1, 2, 2.5 or 5 times a power of ten.
    #[default]
    Decimal,
    /// Degrees.
    Angle,
    /// Seconds and minutes, without free space at the ends.
    Time,
    /// Equal factors.
    Factors,
    /// From 0 to 100 %, whatever the data.
    Percent,
}

/// An axis: its title with the unit, and how it is divided.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Ruler {
    /// Title with unit.
    pub title: String,
    /// Division.
    pub division: Division,
}

impl Ruler {
    /// An axis.
    pub fn new(title: impl Into<String>, division: Division) -> Self {
        Self { title: title.into(), division }
    }

    /// Time in seconds.
    pub fn time() -> Self {
        Self::new(format!("time {} [s]", symbol("t")), Division::Time)
    }

    /// Heading in degrees.
    pub fn heading() -> Self {
        Self::new(super::shared::heading_title(), Division::Angle)
    }

    /// Rudder in degrees.
    pub fn rudder() -> Self {
        Self::new(super::shared::rudder_title(), Division::Angle)
    }

    /// Yaw rate in degrees a second.
    pub fn yaw_rate() -> Self {
        Self::new(format!("yaw rate {} [°/s]", symbol("r")), Division::Decimal)
    }

    fn axis(&self, ends: Option<(f64, f64)>, pad: f64) -> Axis {
        let (lo, hi) = ends.unwrap_or((f64::NAN, f64::NAN));
        match self.division {
            Division::Factors => Axis::log_covering([lo, hi]),
            Division::Percent => Axis::linear(-3.0, 103.0, Steps::Decimal),
            Division::Time => Axis::covering([lo, hi], 0.0, Steps::Time),
            Division::Angle => Axis::covering([lo, hi], pad, Steps::Angle),
            Division::Decimal => Axis::covering([lo, hi], pad, Steps::Decimal),
        }
    }

    fn has_place(&self, value: f64) -> bool {
        self.division != Division::Factors || value > 0.0
    }
}

/// How a line is drawn.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pen {
    /// Colour.
    pub colour: Colour,
    /// In usual widths.
    pub width: f64,
    /// Dashes.
    pub dash: Dash,
    /// From 0 to 1.
    pub opacity: f64,
}

impl Pen {
    /// A solid line.
    pub fn new(colour: Colour) -> Self {
        Self { colour, width: 1.0, dash: SOLID, opacity: 1.0 }
    }

    /// The line of an origin.
    pub fn of(origin: &Origin) -> Self {
        let look = origin.look();
        Self { dash: look.dash, ..Self::new(look.colour) }
    }

    fn stroke(&self, theme: &Theme) -> Stroke {
        Stroke { colour: self.colour, opacity: self.opacity, width: self.width * theme.line, dash: self.dash }
    }
}

/// How the points of a layer are drawn.
#[derive(Debug, Clone, PartialEq)]
pub enum Drawn {
    /// A line through them.
    Line(Pen),
    /// The area between them and another curve, in a colour and as dense as is said.
    Band(Curve, Colour, f64),
    /// A record: dots, or a wide line where it is dense.
    Record,
    /// Small dots. Single ones far from all others do not set the axis: an arrow at its edge stands for them.
    Dots(Colour),
    /// Marks with intervals, where they have some.
    Marks(Look, Vec<Option<[f64; 2]>>),
}

/// One thing in a panel.
#[derive(Debug, Clone, PartialEq)]
pub struct Layer {
    /// Its name in the key; layers of one name are told once.
    pub name: Option<String>,
    /// The points.
    pub curve: Curve,
    /// How they are drawn.
    pub drawn: Drawn,
    /// Share of the range of everything else by which it may widen the axes before it is cut; `None`: never cut.
    pub room: Option<f64>,
}

impl Layer {
    /// A layer that sets the axes.
    pub fn new(name: impl Into<String>, curve: Curve, drawn: Drawn) -> Self {
        let name = Some(name.into()).filter(|name| !name.is_empty());
        Self { name, curve, drawn, room: None }
    }

    /// The same, cut where it leaves the range of everything else by more than this share of it.
    pub fn within(self, room: f64) -> Self {
        Self { room: Some(room), ..self }
    }

    fn curves(&self) -> impl Iterator<Item = &Curve> {
        let other = if let Drawn::Band(other, ..) = &self.drawn { Some(other) } else { None };
        [&self.curve].into_iter().chain(other)
    }

    fn entry(&self, theme: &Theme, shade: f64) -> Option<Entry> {
        let name = self.name.as_deref()?;
        Some(match &self.drawn {
            Drawn::Line(pen) => Entry::new(Sample::Line(pen.stroke(theme)), name),
            Drawn::Band(_, colour, _) => area_entry(name, *colour, shade, theme),
            Drawn::Record if self.curve.finite().next().is_none() => return None,
            Drawn::Record => record_entry(name, theme, &self.curve),
            Drawn::Dots(colour) => Entry::new(Sample::Dots(*colour), name),
            Drawn::Marks(look, _) => Entry::new(Sample::Marker(*look), name),
        })
    }
}

/// A panel of layers, the first at the bottom.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Layers {
    /// Vertical axis.
    pub y: Ruler,
    /// Height, as a share of the width of the figure.
    pub height: f64,
    /// Whether there is a line at zero.
    pub zero: bool,
    /// Dashed lines from left to right, such as the ends of what chance leaves.
    pub levels: Vec<f64>,
    /// The layers.
    pub layers: Vec<Layer>,
}

/// Panels above each other over one horizontal axis.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Stack {
    /// Horizontal axis.
    pub x: Ruler,
    /// A line above the first panel.
    pub head: Option<String>,
    /// Place of a dotted line from bottom to top.
    pub mark: Option<f64>,
    /// Whether it takes half the width of the figure; two of them stand side by side where there is room.
    pub is_half: bool,
    /// Whether there is a line at zero from bottom to top.
    pub zero: bool,
    /// The panels.
    pub panels: Vec<Layers>,
}

/// What [`panels`] draws.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Panels {
    /// Title above the figure.
    pub title: Option<String>,
    /// The stacks, in reading order.
    pub stacks: Vec<Stack>,
    /// Name of the dotted line in the key.
    pub mark_name: Option<String>,
    /// Numbers that stand in the key.
    pub said: Vec<String>,
    /// A remark under the figure.
    pub note: Option<String>,
    /// A remark where a layer is cut.
    pub cut: Option<String>,
}

/// Draws the stacks below each other, half ones in two columns unless the figure is narrow.
pub fn panels(data: &Panels, theme: &Theme) -> Figure {
    let mut sheet = Sheet::new(theme, data.title.as_deref());
    sheet.legend(&entries(data, theme));
    let (mut is_cut, mut beyond) = (false, 0);
    for row in data.stacks.chunk_by(|one, other| one.is_half && other.is_half) {
        let width = if row[0].is_half && !theme.is_narrow() { 2 } else { 1 };
        let gap = Sheet::gap(theme);
        let part = (theme.width - gap * (width - 1) as f64) / width as f64;
        for side_by_side in row.chunks(width) {
            let top = sheet.height();
            let mut lowest = top;
            for (column, stack) in side_by_side.iter().enumerate() {
                sheet.rewind(top);
                let (cut, outside) = draw(&mut sheet, stack, (column as f64 * (part + gap), part), theme);
                (is_cut, beyond) = (is_cut | cut, usize::max(beyond, outside));
                lowest = lowest.max(sheet.height());
            }
            sheet.rewind(lowest);
        }
    }
    let points = if beyond == 1 { "1 point lies".to_owned() } else { format!("{beyond} points lie") };
    let arrows = (beyond > 0).then(|| format!("{points} beyond a panel, where an arrow is at its edge."));
    let remarks: Vec<String> =
        [data.note.clone(), data.cut.clone().filter(|_| is_cut), arrows].into_iter().flatten().collect();
    if !remarks.is_empty() {
        sheet.note(&remarks.join(" "));
    }
    sheet.finish()
}

fn mark_stroke(theme: &Theme) -> Stroke {
    Stroke::solid(INK, theme.thin).dashed(DOTTED)
}

fn entries(data: &Panels, theme: &Theme) -> Vec<Entry> {
    let mut entries: Vec<Entry> = Vec::new();
    for panel in data.stacks.iter().flat_map(|stack| &stack.panels) {
        // Where a band lies on another one, that shines through.
        let mut light = 1.0;
        for layer in &panel.layers {
            if let Drawn::Band(_, _, opacity) = layer.drawn {
                light *= 1.0 - opacity;
            }
            let entry = layer.entry(theme, 1.0 - light);
            entries.extend(entry.filter(|new| entries.iter().all(|known| known.label != new.label)));
        }
    }
    if let Some(name) = data.mark_name.as_ref().filter(|_| data.stacks.iter().any(|stack| stack.mark.is_some())) {
        entries.push(Entry::new(Sample::Line(mark_stroke(theme)), name.clone()));
    }
    entries.extend(data.said.iter().map(|text| Entry::new(Sample::Nothing, text.clone())));
    entries
}

/// The range of some values of all layers, as far as those have room that may be cut; and whether one is.
fn range<'a>(
    layers: impl Iterator<Item = &'a Layer> + Clone,
    values: impl Fn(&'a Layer) -> Vec<f64>,
) -> (Option<(f64, f64)>, bool) {
    let core = axis::range(layers.clone().filter(|layer| layer.room.is_none()).flat_map(&values));
    let Some((lo, hi)) = core.filter(|(lo, hi)| hi > lo) else {
        return (axis::range(layers.flat_map(&values)).or(core), false);
    };
    let (mut ends, mut is_cut) = ((lo, hi), false);
    for (layer, room) in layers.filter_map(|layer| Some((layer, layer.room?))) {
        let ((low, high), cut) = widened((lo, hi), values(layer).into_iter(), room * (hi - lo));
        ends = (ends.0.min(low), ends.1.max(high));
        is_cut |= cut;
    }
    (Some(ends), is_cut)
}

/// Abscissae or ordinates that have a place on an axis.
fn values(layer: &Layer, ruler: &Ruler, of: fn((f64, f64)) -> f64) -> Vec<f64> {
    let values: Vec<f64> = layer.curves().flat_map(Curve::finite).map(of).filter(|own| ruler.has_place(*own)).collect();
    values
}

/// Share of the points on either side that may be far from all others.
const FAR: f64 = 0.005;

/// Times the range of the other points that an axis reaches beyond them for these.
const REACH: f64 = 0.5;

/// Values with those that are few and far from all others drawn in.
fn robust(mut values: Vec<f64>) -> Vec<f64> {
    values.sort_by(f64::total_cmp);
    let skipped = (FAR * values.len() as f64).ceil() as usize;
    let inner = values.get(skipped..values.len().saturating_sub(skipped)).filter(|inner| inner.len() > 10);
    match inner.and_then(|inner| axis::range(inner.iter().copied())) {
        Some((lo, hi)) => {
            let (lo, hi) = widened((lo, hi), values.into_iter(), REACH * (hi - lo)).0;
            vec![lo, hi]
        }
        None => values,
    }
}

fn side(panel: &Layers, theme: &Theme) -> ((Side, f64), bool) {
    let heights = |layer: &Layer| {
        let own = values(layer, &panel.y, |pair| pair.1);
        if matches!(layer.drawn, Drawn::Dots(_)) { robust(own) } else { own }
    };
    let (ends, is_cut) = range(panel.layers.iter(), heights);
    let ends = axis::range(ends.into_iter().flat_map(|(lo, hi)| [lo, hi]).chain(panel.levels.iter().copied()));
    ((Side::new(panel.y.axis(ends, PAD), panel.y.title.clone()), theme.tall(panel.height)), is_cut)
}

/// Draws a stack into a strip of the page; tells whether a layer is cut, and how many dots lie beyond a panel.
fn draw(sheet: &mut Sheet, stack: &Stack, strip: (f64, f64), theme: &Theme) -> (bool, usize) {
    let all = || stack.panels.iter().flat_map(|panel| &panel.layers);
    let (ends, mut is_cut) = range(all(), |layer| values(layer, &stack.x, |pair| pair.0));
    let across = Side::new(stack.x.axis(ends, 0.02), stack.x.title.clone());
    let (rows, cuts): (Vec<_>, Vec<bool>) = stack.panels.iter().map(|panel| side(panel, theme)).unzip();
    is_cut |= cuts.contains(&true);
    let heads = vec![stack.head.as_ref().map(|head| Entry::new(Sample::Nothing, head.clone()))];
    let mut beyond = 0;
    for (place, panel) in
        sheet.grid_within(Grid { heads, ..Grid::stack(across, rows) }, strip).iter().zip(&stack.panels)
    {
        let scene = &mut sheet.scene;
        if panel.zero {
            zero_line(place, scene, theme);
        }
        if stack.zero {
            zero_upright(place, scene, theme);
        }
        if let Some(mark) = stack.mark {
            place.vertical(scene, Height::Grid, mark, mark_stroke(theme));
        }
        for level in &panel.levels {
            place.horizontal(scene, Height::Grid, *level, Stroke::solid(INK, theme.thin).dashed(DASHED));
        }
        beyond += panel.layers.iter().map(|layer| draw_layer(sheet, place, layer, theme)).sum::<usize>();
    }
    (is_cut, beyond)
}

/// Draws a layer; tells how many dots lie beyond the panel.
fn draw_layer(sheet: &mut Sheet, place: &Panel, layer: &Layer, theme: &Theme) -> usize {
    let scene = &mut sheet.scene;
    match &layer.drawn {
        Drawn::Line(pen) => place.line(scene, layer.curve.pairs(), pen.stroke(theme)),
        Drawn::Band(other, colour, opacity) => shaded(place, scene, [&layer.curve, other], *colour, *opacity),
        Drawn::Record => record(place, scene, theme, &layer.curve, 1.4 * theme.dot),
        Drawn::Dots(colour) => {
            place.dots(scene, layer.curve.finite(), 0.75 * theme.dot, *colour);
            return edges(place, &layer.curve, sheet, 1.2 * theme.marker, *colour);
        }
        Drawn::Marks(look, intervals) => {
            for ((x, _), interval) in layer.curve.pairs().zip(intervals) {
                let ends = interval.and_then(|[lo, hi]| Some((place.inside((x, lo))?, place.inside((x, hi))?)));
                if let Some((from, to)) = ends {
                    scene.line(Height::Data, [from, to], Stroke::solid(look.colour, 0.8 * theme.line));
                }
            }
            layer.curve.pairs().for_each(|pair| place.marker(scene, pair, theme.marker, look));
        }
    }
    0
}

/// Marks points above and below a panel by small arrows at its edge, and counts them.
fn edges(place: &Panel, curve: &Curve, sheet: &mut Sheet, size: f64, colour: Colour) -> usize {
    let (top, bottom) = (place.rect.y, place.rect.bottom());
    let mut count = 0;
    for (x, y) in curve.finite().filter_map(|pair| place.place(pair)) {
        let (tip, back) = match y {
            y if y < top => (top, top + size),
            y if y > bottom => (bottom, bottom - size),
            _ => continue,
        };
        let x = x.clamp(place.rect.x, place.rect.right());
        sheet.scene.fill(Height::Data, [(x, tip), (x - 0.5 * size, back), (x + 0.5 * size, back)], colour, 1.0);
        count += 1;
    }
    count
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_wild_point_does_not_squeeze_a_panel() {
        let x: Vec<f64> = (0..400).map(f64::from).collect();
        let mut y: Vec<f64> = x.iter().map(|x| x.sin()).collect();
        let of = |y: &[f64]| Layers {
            layers: vec![Layer::new("before", Curve::new(x.clone(), y.to_vec()), Drawn::Dots(INK))],
            height: 0.2,
            ..Layers::default()
        };
        let drawn = |panel: Layers| {
            let data = Panels { stacks: vec![Stack { panels: vec![panel], ..Stack::default() }], ..Panels::default() };
            panels(&data, &Theme::screen()).svg().to_owned()
        };
        assert!(!drawn(of(&y)).contains("beyond a panel"));
        y[200] = 500.0;
        let axis = side(&of(&y), &Theme::screen()).0.0.axis;
        assert!(axis.fraction(2.5).is_some_and(|place| place > 1.0), "the axis is that of the rest");
        assert!(drawn(of(&y)).contains("1 point lies beyond a panel"));
    }
}
