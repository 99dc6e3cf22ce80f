//! Figures of a prediction: headings with bands, tracks, the diagram of steady turns, and figures of merit against the
//! limits of IMO.

use predict::imo::PredictedCriterion;
use predict::interval::PredictionInterval;
use predict::known::ValidityRange;
use predict::prediction::Bands;
use predict::steady::SteadyCurve;
use predict::{PredictDocument, Prediction};
use rayon::prelude::*;
use report::figures::{self, OvershootRow, Overshoots, PhasePlane, PredictionBands, SteadyCurves, Track};
use report::{Curve, Figure, Theme};
use ship::angle::to_deg;
use trial::Manoeuvre;
use trial::imo::Unit;

use super::index_figures;
use super::picture::{first_failure, write_figure};
use super::predict_curves::stems;
use super::predict_tables::words;
use campaign::folder::ResultFolder;
use scenario::failure::Failure;

/// Drawn ships whose steady curves are shown.
const CURVES: usize = 40;

/// Headings drawn along a track.
const HEADINGS: usize = 12;

/// Stem, caption and what is drawn.
type Drawing<'a> = (String, String, Box<dyn Fn() -> Figure + Sync + Send + 'a>);

/// Draws everything into `folder` and returns stems and captions.
pub fn draw(
    document: &PredictDocument,
    theme: &Theme,
    folder: &ResultFolder,
) -> Result<Vec<(String, String)>, Failure> {
    let mut drawings: Vec<Drawing> = Vec::new();
    let stems = stems(document);
    for (prediction, stem) in document.manoeuvres.iter().zip(&stems) {
        let kind = prediction.kind.to_string();
        if matches!(prediction.kind, Manoeuvre::Spiral { .. }) {
            let caption =
                format!("{kind}: steady yaw rate against rudder, the unstable branch dashed; thin: drawn ships.");
            let draw = move || figures::steady_curves(&steady(&prediction.curves, document.seen), theme);
            drawings.push((stem.clone(), caption, Box::new(draw)));
            continue;
        }
        let caption = format!("{kind}: heading of the most probable ship with the bands of {} draws.", document.draws);
        drawings.push((stem.clone(), caption, Box::new(move || bands_of(prediction, theme))));
        if let (Manoeuvre::ZigZag { .. }, Some(passage)) = (&prediction.kind, &prediction.most_probable) {
            let caption = format!("{kind}: yaw rate against heading of the most probable ship.");
            let draw = move || {
                let way = index_figures::phase_named("most probable ship", &passage.heading, &passage.yaw_rate);
                let title = Some(prediction.kind.to_string());
                figures::phase_plane(&PhasePlane { title, fits: vec![way], ..PhasePlane::default() }, theme)
            };
            drawings.push((format!("{stem}-phase"), caption, Box::new(draw)));
        }
        if prediction.most_probable.as_ref().is_some_and(|passage| passage.way.is_some()) {
            let caption =
                format!("{kind}: track of the most probable ship; thin: {} drawn ships.", prediction.tracks.len());
            drawings.push((format!("{stem}-track"), caption, Box::new(move || track(prediction, theme))));
        }
    }
    for (replayed, stem) in document.replays.iter().zip(&stems[document.manoeuvres.len()..]) {
        let caption = format!("{}: the record and its rudder replayed, nothing fitted to it.", replayed.name);
        let draw = move || {
            let [degrees, rudder] = [&replayed.measured, &replayed.rudder[1]]
                .map(|angles| angles.iter().copied().map(to_deg).collect::<Vec<f64>>());
            let recorded = Some(Curve::new(replayed.heading.time.as_slice(), degrees));
            let data = PredictionBands {
                title: Some(format!("{}, predicted", replayed.name)),
                recorded,
                rudder: Curve::new(replayed.rudder[0].as_slice(), rudder),
                ..bands(&replayed.heading)
            };
            figures::prediction_bands(&data, theme)
        };
        drawings.push((stem.clone(), caption, Box::new(draw)));
    }
    for (unit, stem) in [(Unit::Degrees, "imo-overshoots"), (Unit::ShipLengths, "imo-lengths")] {
        let criteria: Vec<&PredictedCriterion> =
            document.imo.iter().filter(|criterion| criterion.unit == unit.symbol()).collect();
        if !criteria.is_empty() {
            let caption = String::from("Criteria of IMO MSC.137(76): what is predicted and what is allowed.");
            let draw = move || figures::overshoots(&limits(&criteria, unit), theme);
            drawings.push((stem.to_owned(), caption, Box::new(draw)));
        }
    }
    let measured: Vec<OvershootRow> = measured(document);
    if !measured.is_empty() {
        let caption = String::from("Overshoots of the records and what was predicted of them.");
        let data = Overshoots {
            title: Some(String::from("Overshoots, measured and predicted")),
            unit: String::from("°"),
            rows: measured,
        };
        drawings.push((String::from("overshoots"), caption, Box::new(move || figures::overshoots(&data, theme))));
    }
    first_failure(drawings.par_iter().map(|(stem, _, draw)| write_figure(&draw(), folder, stem)))?;
    Ok(drawings.into_iter().map(|(stem, caption, _)| (stem, caption)).collect())
}

fn bands(of: &Bands) -> PredictionBands {
    let curve = |values: &mut dyn Iterator<Item = f64>| Curve::new(of.time.as_slice(), values.collect::<Vec<f64>>());
    let quantile = |place: usize| curve(&mut of.quantiles.iter().map(|row| to_deg(row[place])));
    PredictionBands {
        title: None,
        heading: curve(&mut of.most_probable.iter().copied().map(to_deg)),
        band50: [quantile(1), quantile(3)],
        band90: [quantile(0), quantile(4)],
        recorded: None,
        rudder: Curve::default(),
    }
}

fn bands_of(prediction: &Prediction, theme: &Theme) -> Figure {
    let rudder = prediction.most_probable.as_ref().map_or_else(Curve::default, |passage| {
        let time: Vec<f64> = (0..passage.rudder.len()).map(|row| passage.time(row)).collect();
        Curve::new(time, passage.rudder.iter().copied().map(to_deg).collect::<Vec<f64>>())
    });
    let title = Some(prediction.kind.to_string());
    figures::prediction_bands(&PredictionBands { title, rudder, ..bands(&prediction.heading) }, theme)
}

fn track(prediction: &Prediction, theme: &Theme) -> Figure {
    let curve = |track: &[[f64; 2]]| {
        let (east, north): (Vec<f64>, Vec<f64>) = track.iter().map(|place| (place[1], place[0])).unzip();
        Curve::new(east, north)
    };
    let passage = prediction.most_probable.as_ref();
    let own = passage.and_then(|passage| Some(passage.way.as_ref()?.track.as_slice())).unwrap_or_default();
    let step = (own.len() / HEADINGS).max(1);
    let headings = passage.map_or_else(Vec::new, |passage| {
        let place = |row: usize| [own[row][1], own[row][0], to_deg(passage.heading[row])];
        (0..own.len()).step_by(step).map(place).collect()
    });
    let data = Track {
        title: Some(prediction.kind.to_string()),
        unit: String::from("m"),
        most_probable: curve(own),
        drawn: prediction.tracks.iter().map(|track| curve(track)).collect(),
        recorded: None,
        headings,
    };
    figures::track(&data, theme)
}

/// The diagram of steady turns of some ships, the most probable one first, and the range in which it was seen.
pub fn steady(curves: &[SteadyCurve], seen: ValidityRange) -> SteadyCurves {
    let curve = |of: &SteadyCurve, keep: &dyn Fn(usize) -> bool| {
        let rows = 0..of.rudder.len();
        let (x, y): (Vec<f64>, Vec<f64>) = rows
            .map(|row| match keep(row) {
                true => (to_deg(of.rudder[row]), to_deg(of.yaw_rate[row])),
                false => (f64::NAN, f64::NAN),
            })
            .unzip();
        Curve::new(x, y)
    };
    let Some((first, rest)) = curves.split_first() else { return SteadyCurves::default() };
    // Where the rudder goes back while the yaw rate grows.
    let falls = |row: usize| row + 1 < first.rudder.len() && first.rudder[row + 1] < first.rudder[row];
    let is_unstable = |row: usize| falls(row) || (row > 0 && falls(row - 1));
    SteadyCurves {
        title: Some(String::from("Steady turns")),
        most_probable: curve(first, &|_| true),
        unstable: if first.instability().is_some() { curve(first, &is_unstable) } else { Curve::default() },
        drawn: rest.iter().take(CURVES).map(|ship| curve(ship, &|_| true)).collect(),
        seen_rudder_deg: Some(to_deg(seen.rudder_rad)),
        seen_rate_deg_s: Some(to_deg(seen.yaw_rate_rad_s)),
    }
}

fn limits(criteria: &[&PredictedCriterion], unit: Unit) -> Overshoots {
    let row = |criterion: &&PredictedCriterion| OvershootRow {
        limit: Some(criterion.limit),
        extrapolated: criterion.extrapolated,
        ..row(criterion.criterion.clone(), &criterion.interval())
    };
    Overshoots {
        title: Some(String::from("IMO MSC.137(76)")),
        unit: if unit == Unit::Degrees { String::from("°") } else { unit.symbol().to_owned() },
        rows: criteria.iter().map(row).collect(),
    }
}

fn row(label: String, &PredictionInterval { median, ci50, ci90 }: &PredictionInterval) -> OvershootRow {
    OvershootRow { label, median, ci50, ci90, measured: None, limit: None, extrapolated: false }
}

/// Overshoots of replayed records.
fn measured(document: &PredictDocument) -> Vec<OvershootRow> {
    let mut rows = Vec::new();
    for replayed in &document.replays {
        for (name, figure) in replayed.figures.iter().filter(|(name, _)| name.ends_with("overshoot_deg")) {
            let label = format!("{} {}", replayed.name, words(name).0);
            rows.push(OvershootRow { measured: Some(figure.measured), ..row(label, &figure.interval) });
        }
    }
    rows
}
