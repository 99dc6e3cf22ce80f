//! Growth of the heading error with the horizon of a replay, on held-out records.

use campaign::statistics::MIN_SUMMARISED_VALUES;
use document::trace::{HorizonEntry, TraceDocument};
use report::figures::{AxisSpec, Layer, PanelGroup, PanelRow, Panels, Pen, TickRule};
use report::number::{counted, significant};
use report::{CurveOrigin, PageFigure, PlotCurve};

/// Horizon named in the finding in addition to the whole record, s; the shortest if the records lack it.
const SHOWN_S: f64 = 20.0;

/// Function that picks the heading error of a model from an entry, deg.
type HorizonError = fn(&HorizonEntry) -> f64;

/// The base and the average of the structures, with their heading errors.
const MODELS: [(CurveOrigin, HorizonError); 2] =
    [(CurveOrigin::Before, |entry| entry.before_deg), (CurveOrigin::After, |entry| entry.after_deg)];

/// Horizons shared by at least half of the records, each with the entries of these records; the last is that of the
/// whole records.
fn common<'a>(records: &[&'a [HorizonEntry]]) -> Vec<Vec<&'a HorizonEntry>> {
    let whole: Vec<&HorizonEntry> = records.iter().filter_map(|record| record.last()).collect();
    let windows = || records.iter().flat_map(|record| record.split_last().map_or(&[][..], |(_, windows)| windows));
    let mut durations: Vec<f64> =
        windows().map(|entry| entry.horizon_s).filter(|duration| *duration < place(&whole)).collect();
    durations.sort_by(f64::total_cmp);
    durations.dedup();
    let of_duration = |duration: f64| windows().filter(|entry| entry.horizon_s == duration).collect::<Vec<_>>();
    let shared = durations.into_iter().map(of_duration).filter(|entries| 2 * entries.len() >= records.len());
    shared.chain([whole.clone()]).collect()
}

/// Root mean square of an error over records.
fn pooled(entries: &[&HorizonEntry], error: HorizonError) -> f64 {
    (entries.iter().map(|entry| error(entry).powi(2)).sum::<f64>() / entries.len() as f64).sqrt()
}

/// Abscissa of a horizon: the mean over its entries, s.
fn place(entries: &[&HorizonEntry]) -> f64 {
    entries.iter().map(|entry| entry.horizon_s).sum::<f64>() / entries.len() as f64
}

/// Finding: errors at one horizon and over the whole record.
fn finding(horizons: &[Vec<&HorizonEntry>], records: &str) -> Option<String> {
    let errors = |entries: &[&HorizonEntry]| {
        let [before, after] = MODELS.map(|(_, error)| significant(pooled(entries, error), 2));
        format!("{after}° instead of {before}°")
    };
    let (whole, windows) = horizons.split_last()?;
    let shown = windows.iter().find(|entries| place(entries) == SHOWN_S).or(windows.first());
    let ahead = shown.map_or_else(String::new, |entries| {
        format!("{} s ahead {}, ", significant(place(entries), 2), errors(entries))
    });
    Some(format!("Heading error {ahead}over the whole record {} ({records})", errors(whole)))
}

/// Lines of one model: the range of the records or every single one, and the pooled error.
fn layers(records: &[&[HorizonEntry]], horizons: &[Vec<&HorizonEntry>], number: usize) -> Vec<Layer> {
    let (origin, error) = &MODELS[number];
    let (style, x) = (origin.style(), horizons.iter().map(|entries| place(entries)).collect::<Vec<f64>>());
    let over = |pool: &dyn Fn(&[&HorizonEntry]) -> f64| {
        PlotCurve::new(x.as_slice(), horizons.iter().map(|entries| pool(entries)).collect::<Vec<f64>>())
    };
    let end = |fold: fn(f64, f64) -> f64| {
        over(&|entries| entries.iter().map(|entry| error(entry)).reduce(fold).unwrap_or(f64::NAN))
    };
    let mut layers = Vec::new();
    if records.len() >= MIN_SUMMARISED_VALUES {
        layers.push(Layer::band("", [end(f64::min), end(f64::max)], style.colour, 0.15));
    } else if records.len() > 1 {
        layers.extend(records.iter().map(|record| {
            let (x, y): (Vec<f64>, Vec<f64>) = record.iter().map(|entry| (entry.horizon_s, error(entry))).unzip();
            let pen = Pen { width: 0.6, opacity: 0.5, ..Pen::from_origin(origin) };
            Layer::line("", PlotCurve::new(x, y), pen)
        }));
    }
    let points = x.iter().zip(horizons).map(|(x, entries)| (*x, pooled(entries, *error), None)).collect();
    layers.push(Layer::marks(origin.label(), style, points).with_line(Pen::from_origin(origin)));
    layers
}

/// Figure of the error growth; `None` if no record was held out, or if the document does not hold the errors.
pub fn horizon_figure(document: &TraceDocument) -> Option<PageFigure> {
    let (_, judged) = document.errors();
    let records: Vec<&[HorizonEntry]> =
        judged.iter().map(|record| record.errors.horizons.as_slice()).filter(|horizons| !horizons.is_empty()).collect();
    let used = judged.iter().find(|record| !record.errors.horizons.is_empty())?.used;
    let horizons = common(&records);
    let layers = (0..MODELS.len()).flat_map(|number| layers(&records, &horizons, number)).collect();
    let x = AxisSpec::new("horizon [s]", TickRule::Logarithmic);
    let row = PanelRow::new(AxisSpec::new("heading error, rms [°]", TickRule::Logarithmic), 0.36);
    let each = match records.len() {
        1 => "",
        2..MIN_SUMMARISED_VALUES => " Thin: every record.",
        _ => " Bands: the range of the records.",
    };
    let caption = format!(
        "Root mean square heading error of replays that are restarted at this interval, from the best heading and yaw \
         rate, on records that were not fitted. The last point is the whole record. Marks: the records together, at \
         intervals that half of them or more have.{each}"
    );
    let finding = finding(&horizons, &format!("{}, {used}", counted(records.len() as u64, "record")))?;
    Some(PageFigure::new("horizon", finding, caption, Panels::new(PanelGroup::over(x, vec![(row, layers)]))))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn record(errors: &[[f64; 3]]) -> Vec<HorizonEntry> {
        let entry = |&[horizon_s, before_deg, after_deg]: &[f64; 3]| HorizonEntry { horizon_s, before_deg, after_deg };
        errors.iter().map(entry).collect()
    }

    /// A horizon is pooled over the records that have it, if these are half of all; the last is the mean duration.
    #[test]
    fn records_are_pooled_over_the_horizons_that_half_of_them_have() {
        let long = record(&[[10.0, 1.0, 0.1], [20.0, 3.0, 0.3], [40.0, 5.0, 1.0], [80.0, 9.0, 1.5], [90.0, 6.0, 2.0]]);
        let short = record(&[[10.0, 7.0, 0.7], [20.0, 4.0, 0.4], [50.0, 8.0, 4.0]]);
        let records = [long.as_slice(), &short];
        let horizons = common(&records);
        let places = |horizons: &[Vec<&HorizonEntry>]| horizons.iter().map(|all| place(all)).collect::<Vec<f64>>();
        assert_eq!(places(&horizons), [10.0, 20.0, 40.0, 70.0]);
        assert_eq!(places(&common(&[&long, &short, &short])), [10.0, 20.0, 190.0 / 3.0]);
        assert_eq!(MODELS.map(|(_, error)| (1e9 * pooled(&horizons[0], error)).round()), [5e9, 5e8]);
        let expected =
            "Heading error 20 s ahead 0.35° instead of 3.5°, over the whole record 3.2° instead of 7.1° (two)";
        assert_eq!(finding(&horizons, "two").as_deref(), Some(expected));
        let whole = record(&[[12.0, 2.0, 1.0]]);
        let expected = "Heading error over the whole record 1.0° instead of 2.0° (one)";
        assert_eq!(finding(&common(&[&whole]), "one").as_deref(), Some(expected));
        // Fewer than five records are lines, five or more a band, and one is shown alone.
        let count = |records: &[&[HorizonEntry]]| layers(records, &common(records), 0).len();
        assert_eq!([count(&[&long]), count(&records), count(&[long.as_slice(); 5])], [1, 3, 2]);
    }
}
