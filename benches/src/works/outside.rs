//! What it costs to ask another program, without what that program computes.

use std::path::Path;
use std::sync::Arc;

use identify::Identifier;
use identify::external::{Settings, protocol};

use crate::records::{first_order_zig_zag, record};
use crate::work::{Reach, Work, WorkGroup};

/// Rows of the record: a zig-zag of some minutes, read every second.
const ROWS: usize = 270;

/// A trial through a process that answers at once, and the writing of its line alone.
pub fn outside(echo: &str) -> WorkGroup {
    let mut group = WorkGroup::new(
        "outside",
        "Outside estimators",
        "One record of 270 rows (10/10, K 0.08 1/s, T 25 s) to an outside estimator that answers at once, and its answer back. \
         The line of the question alone is written to memory.",
    );
    let trial = Arc::new(record(&first_order_zig_zag(ROWS)));
    let method = Settings::new([echo]).build(Path::new("")).expect("valid settings");
    let asked = Arc::clone(&trial);
    let work = Work::answering("question and answer", 1e-9, move || {
        let estimate = method.identify(std::slice::from_ref(&*asked)).ok()?;
        Some([estimate.response.K(), estimate.response.T()])
    });
    group.alone(work, Some(Reach::Time(100e-6)));
    let work = Work::new("question alone", move || protocol::question(0, &trial, &[]));
    group.alone(work, None);
    group
}
