//! Remarks under figures: trials, and the meaning of a trace.

use campaign::design::{CellFacts, Design};
use campaign::scenario::TRACE_ID;
use campaign::statistics::NORMAL_QUANTILE_95;
use report::PageFigure;
use report::figures::Plot;

/// Remark under a figure with traces.
pub const TRACE_REMARK: &str = "A trace adds to a first-order model the effects that it lacks.";

/// [`TRACE_REMARK`] if one of the methods is a trace.
pub fn trace_remark(design: &Design) -> Option<&'static str> {
    design.methods.iter().any(|method| method.id == TRACE_ID).then_some(TRACE_REMARK)
}

/// Remark on the number of trials behind every value of a plot, or its range over the cells; for measured records the
/// meaning of n, whose value is in the name of each row. The remark on traces follows if the plot shows one.
pub fn trials_remark(design: &Design, plot: &Plot) -> String {
    let trials = if design.is_measured() {
        String::from("n: predicted records.")
    } else {
        let counts: Vec<u64> = design.cells.iter().map(CellFacts::trial_count).collect();
        let each = if design.cells.len() > 1 { " each" } else { "" };
        format!("{} simulated trials{each}.", count_range(&counts))
    };
    let is_trace = |label: &str| design.methods.iter().any(|method| method.id == TRACE_ID && method.label == label);
    let shows_trace = plot.series_names().into_iter().any(is_trace);
    joined_remarks([Some(trials.as_str()), shows_trace.then_some(TRACE_REMARK)])
}

/// Half width of the 95 % interval of the standard deviation of that many normal errors, per cent.
pub fn sd_half_width_percent(trials: u64) -> f64 {
    100.0 * NORMAL_QUANTILE_95 / (2.0 * trials as f64).sqrt()
}

/// Remarks as one text.
pub fn joined_remarks<const N: usize>(remarks: [Option<&str>; N]) -> String {
    remarks.into_iter().flatten().collect::<Vec<_>>().join(" ")
}

/// Range of counts as text: "4 to 40", or the count that all have.
pub fn count_range(counts: &[u64]) -> String {
    let [least, most] = [counts.iter().min(), counts.iter().max()].map(|end| end.copied().unwrap_or(0));
    if least < most { format!("{least} to {most}") } else { most.to_string() }
}

/// Remark under a figure of simulated trials.
pub const SIMULATED_REMARK: &str = "Simulated trials.";

/// Puts the remark on its trials before the other remarks under a figure, or at the end of the caption of a zig-zag.
pub fn add_trials_remark(figure: &mut PageFigure, remark: &str) {
    match figure.plot.note_mut() {
        Some(note) => *note = Some(joined_remarks([Some(remark), note.as_deref()])),
        None => figure.caption += &format!(" {remark}"),
    }
}

#[cfg(test)]
mod tests {
    use campaign::design::TrialRecords;
    use campaign::scenario::MethodName;
    use report::figures::NamedRows;

    use super::*;

    /// Of measured and of simulated trials alike.
    #[test]
    fn a_figure_without_traces_does_not_speak_of_them() {
        let remark_on = |shown: &str, id: &str, records: Vec<TrialRecords>| {
            let cells = vec![CellFacts { stored_replicates: 0..4, records, ..CellFacts::default() }];
            let methods = vec![MethodName { label: id.to_owned(), id: id.to_owned() }];
            let plot = Plot::from(NamedRows { names: vec![shown.to_owned()], ..NamedRows::default() });
            trials_remark(&Design { methods, cells, ..Design::default() }, &plot)
        };
        let remark = |id: &str, records: Vec<TrialRecords>| remark_on(id, id, records);
        assert_eq!(remark_on("output-error", TRACE_ID, Vec::new()), "4 simulated trials.");
        assert_eq!(remark("output-error", Vec::new()), "4 simulated trials.");
        assert_eq!(remark("output-error", vec![TrialRecords::default()]), "n: predicted records.");
        assert_eq!(remark(TRACE_ID, Vec::new()), format!("4 simulated trials. {TRACE_REMARK}"));
        assert_eq!(remark(TRACE_ID, vec![TrialRecords::default()]), format!("n: predicted records. {TRACE_REMARK}"));
    }
}
