//! What people and programs see: tables, figures, pages and JSON. Views read what was computed and compute nothing.

pub mod bench_figures;
pub mod bench_page;
pub mod bench_tables;
pub mod charts;
pub mod coverage_table;
pub mod curve_tables;
pub mod fit_figures;
pub mod fit_page;
pub mod key_figure;
pub mod method_table;
pub mod missing_moment;
pub mod page_files;
pub mod pooled_charts;
pub mod predict_curves;
pub mod predict_figures;
pub mod predict_form;
pub mod predict_page;
pub mod predict_tables;
pub mod publish;
pub mod record_figures;
pub mod scale_tables;
pub mod study_figures;
pub mod study_page;
pub mod tables;
pub mod trace_charts;
pub mod trace_figures;
pub mod trace_page;
pub mod trace_tables;
pub mod tracing_table;

pub use crate::documents as document;
