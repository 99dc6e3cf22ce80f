//! What people and programs see: tables, figures, pages and JSON. Views read what was computed and compute nothing.

pub mod charts;
pub mod coverage_table;
pub mod drawings;
pub mod fit_figures;
pub mod fit_file;
pub mod method_table;
pub mod missing_moment;
pub mod picture;
pub mod predict_figures;
pub mod predict_file;
pub mod predict_page;
pub mod predict_report;
pub mod predict_tables;
pub mod publish;
pub mod study_page;
pub mod tables;
pub mod trace_charts;
pub mod trace_entries;
pub mod trace_figures;
pub mod trace_file;
pub mod trace_page;
pub mod trace_report;
pub mod trace_tables;
pub mod tracing_table;
pub mod truth_file;
