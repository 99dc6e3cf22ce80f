//! Steps from the residual of the base to that of the model, one row per effect: residual before it, the part it
//! explains, residual after it.

use document::names;
use document::trace::{InclusionStepEntry, TraceDocument};
use report::figures::{AxisSpec, Layer, LayeredPanel, PanelGroup, PanelRow, Panels, Pen, TickRule};
use report::number::significant;
use report::{CurveOrigin, PageFigure, PlotCurve};

use super::trace_tables::{effect_text, unnamed_remark};
use crate::documents::curves::TraceCurves;

/// Heading errors along the steps: `1.9° → 0.90° (speed loss) → 0.32° (sway coupling)`.
fn sentence(document: &TraceDocument) -> String {
    let size = |step: &InclusionStepEntry| format!("{}°", significant(step.heading_rmse_deg, 2));
    let step_words = |step: &InclusionStepEntry| match &step.id {
        None => size(step),
        Some(id) => format!("{} ({}{})", size(step), names::effect_name(id), unnamed_remark(document, id)),
    };
    document.staircase.iter().map(step_words).collect::<Vec<_>>().join(" → ")
}

/// Figure of the steps; `None` if the model adds no effect to the base.
pub fn staircase_figure(document: &TraceDocument, curves: &TraceCurves) -> Option<PageFigure> {
    let steps = &document.staircase;
    let [times, residuals] = &curves.staircase_residuals;
    let time = times.first()?;
    let panel = |head: String, values: Vec<f64>, origin: &CurveOrigin| LayeredPanel {
        head: Some(head),
        layers: vec![Layer::line(
            "",
            PlotCurve::new(time.as_slice(), values),
            Pen::new(origin.style().colour).width(0.9),
        )],
        ..LayeredPanel::default()
    };
    let mut panels = Vec::new();
    for (number, (pair, step)) in residuals.windows(2).zip(&steps[1..]).enumerate() {
        let carried = pair[0].iter().zip(&pair[1]).map(|(before, after)| before - after).collect();
        let name = match (&step.id, &step.form) {
            (Some(id), Some(form)) => effect_text(id, form, None),
            _ => String::new(),
        };
        let size = |number: usize| significant(steps[number].heading_rmse_deg, 2);
        panels.push(panel(format!("error {}°", size(number)), pair[0].clone(), &CurveOrigin::Before));
        panels.push(panel(format!("{name} explains"), carried, &CurveOrigin::Record));
        panels.push(panel(format!("error {}°", size(number + 1)), pair[1].clone(), &CurveOrigin::After));
    }
    let row = PanelRow::zeroed(AxisSpec::new("heading [°]", TickRule::Angle), 0.085);
    let group = PanelGroup { is_unbroken: true, ..PanelGroup::multiples(3, AxisSpec::time(), row, panels) };
    let plot = Panels::new(group);
    let caption = format!(
        "{}: heading error before an effect, the part that the effect explains, and the error after it. Every step is refitted for \
         the closest replay; degrees are root mean squares over all fitted records.",
        names::record_name(&document.records.first()?.name)
    );
    (!residuals.is_empty())
        .then(|| PageFigure::new("staircase", format!("Heading error {}", sentence(document)), caption, plot))
}
