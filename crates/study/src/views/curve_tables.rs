//! Curves of replays as CSV, for plotting again. They hold the data given to a figure; of records with more than 4000
//! rows only the visible ones.

use campaign::failure::Failure;
use campaign::folder::ResultFolder;
use campaign::scenario::name::slug;
use campaign::store::StoredStudy;
use campaign::stored_figures::Replays;
use report::{CurveOrigin, PlotCurve};

use super::study_figures::{FigurePlace, StudyFigure};
use crate::documents::columns::CsvColumns;
use crate::documents::fit_curves::FitCurves;

/// Curve over time with the name of its column, which includes the unit.
type NamedCurve<'a> = (String, &'a PlotCurve);

/// Label of an origin as part of a column name.
fn word(origin: &CurveOrigin) -> String {
    slug(origin.label()).replace('-', "_")
}

fn finite(curve: &PlotCurve) -> impl Iterator<Item = (f64, f64)> {
    curve.pairs().filter(|(x, y)| x.is_finite() && y.is_finite())
}

/// Table of all columns over the union of their times, which ascend in each. A cell without a value is empty.
fn table(columns: Vec<NamedCurve>) -> String {
    let mut places: Vec<f64> = columns.iter().flat_map(|(_, curve)| finite(curve)).map(|(x, _)| x).collect();
    places.sort_by(f64::total_cmp);
    places.dedup();
    let mut table = CsvColumns::default();
    table.push("t_s", places.clone());
    for (name, curve) in columns {
        let mut points = finite(curve).peekable();
        let value = |place: &f64| points.next_if(|(x, _)| x == place).map_or(f64::NAN, |(_, y)| y);
        table.push(name, places.iter().map(value).collect());
    }
    table.to_csv()
}

/// CSV table of a record and its replays: `t_s`, `heading_deg`, the rudder and the noise-free heading if there are any,
/// and heading and residual of every method.
pub fn replay_table(replays: &Replays, rudder: Option<&PlotCurve>) -> String {
    let mut columns = vec![("heading_deg".to_owned(), &replays.record)];
    columns.extend(rudder.map(|rudder| ("rudder_deg".to_owned(), rudder)));
    columns.extend(replays.truth.as_ref().map(|truth| ("true_heading_deg".to_owned(), truth)));
    for replay in &replays.replays {
        let name = word(&replay.origin);
        columns.push((format!("{name}_heading_deg"), &replay.heading));
        columns.push((format!("{name}_residual_deg"), &replay.residual));
    }
    table(columns)
}

/// Writes the table of the replays of every record of a fit, after removal of those of an earlier fit.
pub fn write_replays(curves: &FitCurves, folder: &ResultFolder) -> Result<(), Failure> {
    folder.remove_matching(|name| name.starts_with("replay-") && name.ends_with(".csv"))?;
    curves.records.iter().enumerate().try_for_each(|(number, record)| {
        let suffix = if number == 0 { String::new() } else { format!("-{}", record.name) };
        folder.write(&format!("replay{suffix}.csv"), replay_table(&record.replays, Some(&record.rudder)))
    })
}

/// Writes the replays of every showcase next to their figure.
pub fn write_showcases(stored: &StoredStudy, figures: &[StudyFigure], folder: &ResultFolder) -> Result<(), Failure> {
    for (place, figure) in figures.iter().filter(|(_, figure)| figure.stem.contains("replays")) {
        let FigurePlace::Showcase(index) = place else { continue };
        let showcase = &stored.showcases[*index];
        let rudder = showcase.trial.as_ref().map(|trial| &trial.rudder);
        let stem = figure.stem.replace("replays", "replay");
        folder.write(&format!("{stem}.csv"), replay_table(&showcase.replays, rudder))?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_stand_beside_each_other_by_their_abscissae() {
        let first = PlotCurve::new(vec![0.0, 1.0, 2.0], vec![1.0, f64::NAN, -1.0 / 3.0]);
        let second = PlotCurve::new(vec![0.5, 1.0], vec![1e-9, 4.0]);
        let text = table(vec![("one_deg".into(), &first), ("other_deg".into(), &second)]);
        assert_eq!(text, "t_s,one_deg,other_deg\n0,1,\n0.5,,0.000000001\n1,,4\n2,-0.3333333,\n");
    }
}
