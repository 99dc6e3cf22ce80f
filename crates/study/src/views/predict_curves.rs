//! The curves behind the figures of a prediction, as tables.

use std::fmt::Write;

use predict::PredictDocument;
use predict::prediction::Bands;
use ship::angle::to_deg;
use trial::Manoeuvre;

use crate::records::names;
use scenario::name::slug;

/// A stem of its own for every manoeuvre and record.
pub fn stems(document: &PredictDocument) -> Vec<String> {
    let own = document.manoeuvres.iter().map(|prediction| {
        let kind = prediction.kind.to_string();
        // A minus is no part of a slug.
        slug(&kind.replace(" -", " port "))
    });
    names(own.chain(document.replays.iter().map(|own| format!("replay-{}", slug(&own.name)))))
}

/// The curves of every manoeuvre and replay: stem and table, angles in degrees.
pub fn curves(document: &PredictDocument) -> Vec<(String, String)> {
    let mut tables = Vec::new();
    let mut stems = stems(document).into_iter();
    for (prediction, stem) in document.manoeuvres.iter().zip(stems.by_ref()) {
        let table = match prediction.kind {
            Manoeuvre::Spiral { .. } => {
                let mut table = String::from("ship,rudder_deg,yaw_rate_deg_s\n");
                for (ship, curve) in prediction.curves.steady.iter().enumerate() {
                    for (rudder, rate) in curve.rudder.iter().zip(&curve.yaw_rate) {
                        let _ = writeln!(table, "{ship},{:.5},{:.6}", to_deg(*rudder), to_deg(*rate));
                    }
                }
                table
            }
            _ => bands(&prediction.curves.heading, None),
        };
        tables.push((stem, table));
    }
    for (replayed, stem) in document.replays.iter().zip(stems) {
        tables.push((stem, bands(&replayed.heading, Some(&replayed.measured))));
    }
    tables
}

fn bands(bands: &Bands, measured: Option<&[f64]>) -> String {
    let mut table = String::from("t_s,heading_deg,q05_deg,q25_deg,q50_deg,q75_deg,q95_deg");
    table += if measured.is_some() { ",measured_deg\n" } else { "\n" };
    for (row, time) in bands.time.iter().enumerate() {
        let cell = |value: f64| if value.is_finite() { format!("{:.5}", to_deg(value)) } else { String::new() };
        let _ = write!(table, "{time:.4},{}", cell(bands.most_probable[row]));
        for quantile in bands.quantiles[row] {
            table += ",";
            table += &cell(quantile);
        }
        if let Some(measured) = measured {
            table += ",";
            table += &cell(measured[row]);
        }
        table.push('\n');
    }
    table
}
