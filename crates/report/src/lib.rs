//! Tables and journal-grade figures of stored results.
//!
//! This crate draws given data and computes no science: every number in a table or a figure is plain data in the units
//! of the reader (degrees, seconds). Of ship manoeuvring it contains only the names of methods with their colours, the
//! axes of heading, rudder and yaw rate, and the figure of a zig-zag; it depends on no crate of ships or trials.
//!
//! | to learn about | read |
//! |---|---|
//! | the kinds of figure | [`figures`] |
//! | sizes for screen and print | [`theme`] |
//! | which method has which colour, marker and dash | [`palette`] |
//! | SVG and PNG files | [`drawing`] |
//! | tables for terminal, Markdown, CSV and LaTeX | [`table`] |
//! | a page of texts, tables and figures | [`Page`] |
//! | a page for a browser, from the Markdown of a report and its figures | [`html`] |
//! | values with uncertainty, intervals, missing values | [`number`] |
//! | text from outside, escaped for a page or a file | [`markdown`], [`printable`] |
//!
//! ```
//! use kempf_report::figures::{AxisSpec, Layer, LayerKind, PanelRow, Panels, Plot};
//! use kempf_report::{PlotCurve, Theme};
//!
//! let heading = PlotCurve::new([0.0, 1.0, 2.0], [0.0, 0.5, 2.0]);
//! let layers = vec![Layer::new("recorded heading", heading, LayerKind::Record)];
//! let figure = Plot::from(Panels::over_time(vec![(PanelRow::new(AxisSpec::heading(), 0.3), layers)]));
//! let figure = figure.draw("The heading grows by 2° in 2 s", &Theme::screen());
//! assert!(figure.svg().contains("heading"));
//! ```
//!
//! A figure never fails for its data: an undefined number is omitted, and a figure without any data is an empty frame.

pub mod curve;
pub mod drawing;
pub mod error;
pub mod figures;
pub mod html;
pub mod markdown;
pub mod number;
mod page;
pub mod palette;
pub mod printable;
pub mod style;
mod svg_group;
pub mod table;
pub mod theme;

mod axis;
mod backend;
mod canvas;
mod changes;
mod chart;
mod fonts;
mod indexed;
mod legend;
mod lines;
mod markup;
mod sheet;
mod tick_rule;

pub use curve::PlotCurve;
pub use drawing::Drawing;
pub use error::ReportError;
pub use markup::symbol;
pub use page::{Page, PageFigure, PlacedFigures};
pub use palette::CurveOrigin;
pub use style::Style;
pub use table::{Alignment, Table, TableColumn, TableHead};
pub use theme::Theme;
