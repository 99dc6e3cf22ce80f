//! The figures: time of one identification by method, and growth with samples and with trials.

use std::path::Path;

use kempf_benches::measure::Measured;
use kempf_benches::process::Outcome;
use kempf_benches::works;
use report::figures::{
    Dot, DotColumn, DotPlot, ErrorCell, ErrorCurve, ErrorCurves, ErrorPoint, Reference95, Scale, dots, error_curves,
};
use report::{Origin, Theme};

use crate::Measurements;
use crate::growth::Growth;
use crate::trials::Trials;

/// A journal column, mm, and a resolution for print.
const WIDTH_MM: f64 = 85.0;
const DPI: f64 = 600.0;

/// Writes all figures as PNG and SVG.
pub fn write(folder: &Path, measured: &[Measurements], samples: &[Growth], trials: &Trials) -> Outcome<()> {
    let theme = Theme::paper(WIDTH_MM, DPI)?;
    if let Some(plot) = measured.iter().find(|one| one.group.name == "identify").map(identification) {
        dots(&plot, &theme).write(folder, "identification")?;
    }
    // The rival is in the table; its line runs among ours.
    let own = samples.iter().filter(|growth| growth.name != works::RIVAL);
    let remark = "A line ends where a method has no answer. It may fall where the answer is worth nothing: the report names \
                  those that are off by more than half.";
    let with_samples = ErrorCurves { note: Some(remark.to_owned()), ..curves("samples of the record", own) };
    error_curves(&with_samples, &theme).write(folder, "growth-samples")?;
    error_curves(&curves("trials of the study", trials.growth.iter()), &theme).write(folder, "growth-trials")?;
    Ok(())
}

/// Milliseconds, so that both ends of the axis can be read as numbers.
const MS: f64 = 1e3;

fn identification(measured: &Measurements) -> DotPlot {
    let rival = measured.lines.iter().find(|line| line.row.work.name == works::RIVAL);
    let mut lines: Vec<_> = measured.lines.iter().collect();
    lines.sort_by(|a, b| a.time.value.total_cmp(&b.time.value));
    let dot = |name: &str, time: &Measured| Dot {
        origin: Origin::Method(name.to_owned()),
        x: time.value * MS,
        interval: Some(time.interval.map(|end| end * MS)),
        hollow: false,
    };
    let samples = measured.lines.iter().map(|line| line.time.samples).max().unwrap_or(0);
    DotPlot {
        title: None,
        names: lines.iter().map(|line| line.row.work.name.clone()).collect(),
        columns: vec![DotColumn {
            limit: None,
            x_title: "time of a fit [ms]".to_owned(),
            scale: Scale::Log,
            reference: rival
                .map(|line| Reference95 { value: line.time.value * MS, band: line.time.interval.map(|end| end * MS) }),
            rows: lines.iter().map(|line| vec![dot(&line.row.work.name, &line.time)]).collect(),
        }],
        rows_are_methods: true,
        quiet: Vec::new(),
        note: Some(format!(
            "Record of 1201 samples, one core; median and its 95 % interval of up to {samples} samples. Hollow: \
             another library, or 200 triples; \
             upright line: its SRIVC on the heading."
        )),
    }
}

fn curves<'a>(x_title: &str, growths: impl Iterator<Item = &'a Growth>) -> ErrorCurves {
    let point = |(size, time): &(f64, Measured)| {
        ErrorPoint::new(*size, time.value, (time.samples > 1).then_some(time.interval))
    };
    let curve = |growth: &Growth| {
        ErrorCurve::new(Origin::Method(growth.name.clone()), growth.points.iter().map(point).collect())
    };
    ErrorCurves {
        x_title: x_title.to_owned(),
        x_scale: Scale::Log,
        y_scale: Scale::Log,
        rows: vec!["time [s]".to_owned()],
        columns: vec![String::new()],
        cells: vec![ErrorCell { row: 0, column: 0, curves: growths.map(curve).collect() }],
        ..ErrorCurves::default()
    }
}
