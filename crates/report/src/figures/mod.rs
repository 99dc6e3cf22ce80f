//! Kinds of figure: panels of layers, named rows, maps of cells, and the zig-zag with its dimension lines. A figure is
//! a specification, plain data in display units; [`Plot::draw`] draws it.

mod cells;
mod extents;
mod layers;
mod panels;
mod piles;
mod point_labels;
mod row_layers;
mod rows;
mod shared;
mod side_labels;
mod zigzag_trial;

pub use cells::{CellMap, MapCell, Outline, Shades};
pub use extents::OutlierLimit;
pub use panels::{
    AxisLine, AxisSpec, Layer, LayerKind, LayeredPanel, Marks, PanelGroup, PanelRow, Panels, Pen, TickRule,
};
pub use rows::{NamedRows, RowItem, RowKind, RowPlace, RowsColumn};
pub use shared::ReferenceBand95;
pub use zigzag_trial::{OvershootMark, TimeSpan, ZigZagMark, ZigZagPlot};

use crate::drawing::Drawing;
use crate::markup::is_markup;
use crate::theme::Theme;

/// Figure to be drawn.
#[derive(Debug, Clone, PartialEq)]
pub enum Plot {
    /// Layers over numeric axes.
    Panels(Panels),
    /// Named rows.
    Rows(NamedRows),
    /// Map of cells.
    Cells(CellMap),
    /// A zig-zag trial with its characteristic quantities.
    ZigZag(ZigZagPlot),
}

impl Plot {
    /// Drawing with its finding above it, one sentence without its full stop; no such line if the finding is empty.
    pub fn draw(&self, finding: &str, theme: &Theme) -> Drawing {
        let drawn = match self {
            Self::Panels(data) => layers::panels(data, finding, theme),
            Self::Rows(data) => row_layers::rows(data, finding, theme),
            Self::Cells(data) => cells::cells(data, finding, theme),
            Self::ZigZag(data) => zigzag_trial::zigzag_trial(data, finding, theme),
        };
        drawn.expect("the backend writes into memory, which does not fail")
    }

    /// Mutable remark under the figure; `None` for a zig-zag, whose remark follows from its data.
    pub fn note_mut(&mut self) -> Option<&mut Option<String>> {
        match self {
            Self::Panels(data) => Some(&mut data.note),
            Self::Rows(data) => Some(&mut data.note),
            Self::Cells(data) => Some(&mut data.note),
            Self::ZigZag(_) => None,
        }
    }

    /// Names of the layers, panels, rows and items that are drawn.
    pub fn series_names(&self) -> Vec<&str> {
        match self {
            Self::Panels(data) => {
                let panels = data.groups.iter().flat_map(|group| &group.panels);
                let names = panels.flat_map(|panel| panel.layers.iter().map(|layer| &layer.name).chain([&panel.head]));
                names.flatten().map(String::as_str).collect()
            }
            Self::Rows(data) => {
                let items = data.columns.iter().flat_map(|column| &column.rows).flatten();
                items.filter_map(|item| item.name.as_ref()).chain(&data.names).map(String::as_str).collect()
            }
            Self::Cells(data) => data.panels.iter().filter_map(|(name, _)| name.as_deref()).collect(),
            Self::ZigZag(_) => Vec::new(),
        }
    }

    /// Titles of the numeric axes, without italics: the keys of the limits in a style.
    pub fn axis_titles(&self) -> Vec<String> {
        let rulers: Vec<AxisSpec> = match self {
            Self::Panels(data) => {
                let of = |group: &PanelGroup| {
                    [group.x.clone(), group.rows.iter().map(|row| row.y.clone()).collect()].concat()
                };
                data.groups.iter().flat_map(of).collect()
            }
            Self::Rows(data) => data.columns.iter().map(|column| column.x.clone()).collect(),
            Self::Cells(_) => Vec::new(),
            Self::ZigZag(_) => vec![AxisSpec::time(), AxisSpec::heading(), AxisSpec::rudder()],
        };
        let titles = rulers.iter().map(|ruler| ruler.title.replace(is_markup, ""));
        titles.filter(|title| !title.is_empty()).collect()
    }
}

macro_rules! plots_of {
    ($($kind:ident $data:ty;)*) => {$(
        impl From<$data> for Plot {
            fn from(data: $data) -> Self {
                Self::$kind(data)
            }
        }
    )*};
}

plots_of! {
    Panels Panels;
    Rows NamedRows;
    Cells CellMap;
    ZigZag ZigZagPlot;
}

#[cfg(test)]
mod tests;
