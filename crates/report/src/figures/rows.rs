//! Named rows below each other over one or several axes: marks with intervals, bars from zero, limits, distributions.
//! A figure is data; [`super::row_layers`] draws it.

use plotters::style::RGBColor;

use super::panels::{AxisSpec, Pen};
use super::shared::ReferenceBand95;
use crate::palette::CurveStyle;

/// Content of a row.
#[derive(Debug, Clone, PartialEq)]
pub enum RowKind {
    /// Mark at a value, and its interval as a bar; `None` without an interval. An infinite value is an arrow at the
    /// edge.
    Mark(CurveStyle, f64, Option<[f64; 2]>),
    /// Interval as a thin line.
    ThinInterval([f64; 2]),
    /// Interval as a wide bar in a pale colour.
    WideInterval(RGBColor, [f64; 2]),
    /// Bar from zero to a value.
    Bar(CurveStyle, f64),
    /// Vertical line at a value, from the bottom to the top of the row.
    Limit(f64),
    /// No value: the name of the row is a heading of the rows below it.
    Heading,
    /// Distribution: value and density, ascending; its quantiles 2.5, 25, 50, 75 and 97.5 %.
    Violin(CurveStyle, Vec<(f64, f64)>, [f64; 5]),
}

/// Place of an item in its row.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum RowPlace {
    /// Distance below the middle, as a share of the pitch of the rows.
    Shifted(f64),
    /// Separate line below the items before it.
    Below,
    /// Line of the item before it.
    SameLine,
}

/// Item of a row: a mark, bar, interval, limit, distribution or heading, with its name in the legend.
#[derive(Debug, Clone, PartialEq)]
pub struct RowItem {
    /// Name in the legend, where items of one name are listed once; `None` for an item that is not listed.
    pub name: Option<String>,
    /// Kind of the item.
    pub kind: RowKind,
    /// Place of the item in its row.
    pub place: RowPlace,
    /// `true` if the item may be cut when it leaves the range of all other data by more than that range.
    pub may_be_clipped: bool,
    /// Number written at the right end of the row, after its mark if rows have several numbers; `None` without a
    /// number.
    pub number: Option<String>,
}

impl RowItem {
    /// Item in the middle of its row that sets the axis.
    pub fn new(name: impl Into<String>, kind: RowKind) -> Self {
        let name = Some(name.into()).filter(|name| !name.is_empty());
        Self { name, kind, place: RowPlace::Shifted(0.0), may_be_clipped: false, number: None }
    }

    /// Items of a row that is a heading.
    pub fn heading() -> Vec<Self> {
        vec![Self::new("", RowKind::Heading)]
    }

    /// Mark on a line below the items before it in its row.
    pub fn mark_below(name: impl Into<String>, style: CurveStyle, value: f64, interval: Option<[f64; 2]>) -> Self {
        Self { place: RowPlace::Below, ..Self::new(name, RowKind::Mark(style, value, interval)) }
    }

    /// Item that is cut where it is far from all other data, so that it cannot stretch the axis.
    pub fn clipped_if_far(self) -> Self {
        Self { may_be_clipped: true, ..self }
    }

    /// `true` if the item has a value and not only an interval, or is a heading, which needs no value.
    pub(super) fn is_value(&self) -> bool {
        match self.kind {
            RowKind::Mark(_, value, _) | RowKind::Bar(_, value) => !value.is_nan(),
            RowKind::Limit(_) | RowKind::ThinInterval(_) | RowKind::WideInterval(..) => false,
            RowKind::Violin(..) | RowKind::Heading => true,
        }
    }
}

/// All rows over one axis.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct RowsColumn {
    /// The axis.
    pub x: AxisSpec,
    /// Items of every row.
    pub rows: Vec<Vec<RowItem>>,
    /// `true` if the axis includes zero, with a vertical line there; such an axis is linear.
    pub has_zero_line: bool,
    /// Reference value of the results with its 95 % band; `None` without a reference.
    pub reference: Option<ReferenceBand95>,
    /// Vertical lines across all rows: name in the legend, style, value.
    pub vertical_lines: Vec<(String, Pen, f64)>,
    /// Values that the axis always includes.
    pub included_values: Vec<f64>,
}

/// Data of [`super::Plot::Rows`].
#[derive(Debug, Clone, PartialEq, Default)]
pub struct NamedRows {
    /// Title of the names; empty if the names need none.
    pub names_title: String,
    /// Names from top to bottom.
    pub names: Vec<String>,
    /// The columns, side by side.
    pub columns: Vec<RowsColumn>,
    /// Name of the shaded rows in the legend, and their indices; `None` without such rows.
    pub shaded_rows: Option<(String, Vec<usize>)>,
    /// Remark under the figure; `None` without a remark.
    pub note: Option<String>,
    /// Remark that is added if data are beyond an axis; `None` for the usual remark.
    pub overflow_note: Option<String>,
}
