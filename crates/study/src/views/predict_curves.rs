//! Curves of the figures of a prediction, as tables.

use campaign::curves::degrees;
use predict::PredictDocument;
use predict::prediction::BandedCurve;
use predict::steady::SteadyCurve;
use ship::angle::to_deg;
use trial::Manoeuvre;

use crate::documents::columns::CsvColumns;
use crate::records::unique_names;
use campaign::scenario::name::slug;

/// Unique file stem for every manoeuvre and record.
pub fn manoeuvre_stems(document: &PredictDocument) -> Vec<String> {
    let kinds = document.manoeuvres.iter().map(|prediction| {
        let kind = prediction.kind.to_string();
        // A slug has no minus sign.
        slug(&kind.replace(" -", " port "))
    });
    unique_names(kinds.chain(document.replays.iter().map(|kinds| format!("replay-{}", slug(&kinds.name)))))
}

/// Curves of every manoeuvre and replay: stem and table, angles in degrees.
pub fn curve_tables(document: &PredictDocument) -> Vec<(String, String)> {
    let mut tables = Vec::new();
    let mut stems = manoeuvre_stems(document).into_iter();
    for (prediction, stem) in document.manoeuvres.iter().zip(stems.by_ref()) {
        let table = match prediction.kind {
            Manoeuvre::Spiral { .. } => steady_turns(&prediction.curves.steady),
            _ => bands(&prediction.curves.heading, None),
        };
        tables.push((stem, table));
    }
    for (replayed, stem) in document.replays.iter().zip(stems) {
        tables.push((stem, bands(&replayed.heading_band, Some(&replayed.measured_heading))));
    }
    tables
}

fn steady_turns(ships: &[SteadyCurve]) -> String {
    let number = |(ship, curve): (usize, &SteadyCurve)| vec![ship as f64; curve.rudder.len()];
    let mut table = CsvColumns::default();
    table.push("ship", ships.iter().enumerate().flat_map(number).collect());
    table.push("rudder_deg", ships.iter().flat_map(|ship| degrees(&ship.rudder)).collect());
    table.push("yaw_rate_deg_s", ships.iter().flat_map(|ship| degrees(&ship.yaw_rate)).collect());
    table.to_csv()
}

fn bands(bands: &BandedCurve, measured: Option<&[f64]>) -> String {
    let mut table = CsvColumns::default();
    table.push("t_s", bands.time.clone());
    table.push("heading_deg", degrees(&bands.most_probable));
    for (place, percent) in ["05", "25", "50", "75", "95"].into_iter().enumerate() {
        table.push(format!("q{percent}_deg"), bands.quantiles.iter().map(|row| to_deg(row[place])).collect());
    }
    measured.into_iter().for_each(|heading| table.push("measured_deg", degrees(heading)));
    table.to_csv()
}
