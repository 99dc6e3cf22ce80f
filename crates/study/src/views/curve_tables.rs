//! The curves of replays as CSV, so that anyone can draw them again. They hold the data a figure was handed, of records
//! with more than 4000 rows those that show.

use std::fmt::Write as _;

use campaign::folder::ResultFolder;
use campaign::store::StoredStudy;
use report::figures::Replays;
use report::{Curve, Origin};
use scenario::failure::Failure;

use super::drawings::Drawing;
use super::picture::slug;
use crate::documents::columns::digits;

/// A column: its name with its unit, and its values over what the first column holds.
type Column<'a> = (String, &'a Curve);

/// A name as part of the name of a column.
fn word(origin: &Origin) -> String {
    slug(origin.label()).replace('-', "_")
}

fn finite(curve: &Curve) -> impl Iterator<Item = (f64, f64)> {
    curve.pairs().filter(|(x, y)| x.is_finite() && y.is_finite())
}

/// All columns over the abscissae that any of them has, which ascend in each; empty where a column has no value.
fn table(abscissa: &str, columns: &[Column]) -> String {
    let mut places: Vec<f64> = columns.iter().flat_map(|(_, curve)| finite(curve)).map(|(x, _)| x).collect();
    places.sort_by(f64::total_cmp);
    places.dedup();
    let mut rests: Vec<_> = columns.iter().map(|(_, curve)| finite(curve).peekable()).collect();
    let names: String = columns.iter().map(|(name, _)| format!(",{name}")).collect();
    let mut text = format!("{abscissa}{names}\n");
    for place in places {
        text += &place.to_string();
        for rest in &mut rests {
            let value = rest.next_if(|&(x, _)| x == place).map_or_else(String::new, |(_, y)| digits(y));
            let _ = write!(text, ",{value}");
        }
        text.push('\n');
    }
    text
}

/// Record and replays: `t_s`, `heading_deg`, the rudder where it is at hand, the noise-free heading where there is one,
/// and heading and residual of every method.
pub fn of_replays(replays: &Replays, rudder: Option<&Curve>) -> String {
    let mut columns = vec![("heading_deg".to_owned(), &replays.record)];
    columns.extend(rudder.map(|rudder| ("rudder_deg".to_owned(), rudder)));
    columns.extend(replays.truth.as_ref().map(|truth| ("true_heading_deg".to_owned(), truth)));
    for replay in &replays.replays {
        let name = word(&replay.origin);
        columns.push((format!("{name}_heading_deg"), &replay.heading));
        columns.push((format!("{name}_residual_deg"), &replay.residual));
    }
    table("t_s", &columns)
}

/// Writes the replays of every showcase beside their figure.
pub fn write_showcases(stored: &StoredStudy, drawings: &[Drawing], folder: &ResultFolder) -> Result<(), Failure> {
    for (index, showcase) in stored.showcases.iter().enumerate() {
        let of_replays_figure =
            |drawing: &&Drawing| drawing.showcase == Some(index) && drawing.stem.contains("replays");
        let Some(drawing) = drawings.iter().find(of_replays_figure) else { continue };
        let rudder = showcase.trial.as_ref().map(|trial| &trial.rudder);
        let stem = drawing.stem.replace("replays", "replay");
        folder.write(&format!("{stem}.csv"), of_replays(&showcase.replays, rudder))?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_stand_beside_each_other_by_their_abscissae() {
        let one = Curve::new(vec![0.0, 1.0, 2.0], vec![1.0, f64::NAN, -1.0 / 3.0]);
        let other = Curve::new(vec![0.5, 1.0], vec![1e-9, 4.0]);
        let text = table("t_s", &[("one_deg".into(), &one), ("other_deg".into(), &other)]);
        assert_eq!(text, "t_s,one_deg,other_deg\n0,1,\n0.5,,0.000000001\n1,,4\n2,-0.3333333,\n");
    }
}
