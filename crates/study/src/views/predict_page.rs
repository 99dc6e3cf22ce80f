//! Page of a prediction: texts, tables and figures.

use askama::Template;
use document::names;
use predict::document::{OtherLoading, file_names};
use predict::replay::RecordReplay;
use predict::{PredictDocument, Prediction};
use report::markdown::escaped_text;
use report::number::{counted, fixed, with_uncertainty};
use report::{Page, PlacedFigures};
use ship::angle::to_deg;
use ship::{Particulars, ShortNumber};
use trial::{Manoeuvre, imo};

use super::{predict_figures, predict_tables};

/// Text above the table: models, number of draws, weather, hull, range of validity, incomplete manoeuvres.
pub fn text_above_table(document: &PredictDocument) -> String {
    let weather = match document.calm {
        true => "in a calm",
        false => "in the weather of the records",
    };
    let mut summary = format!("{}: {} ships drawn from the model, {weather}\n", document.model_files(), document.draws);
    if let Some(OtherLoading { draughts_at_trials_m: before, draught_m, factor, .. }) = &document.load {
        let before: Vec<String> = before.iter().map(|draught| ShortNumber(*draught).to_string()).collect();
        summary += &format!(
            "the ship is the mmg hull, taken from a draught of {} m to {} m by the formulas of `study list priors`, with standard \
             deviations × {factor}; no measurement confirms this step\n",
            before.join(", "),
            ShortNumber(*draught_m)
        );
    } else if document.hull {
        summary += "predicted with the fitted hulls of three degrees of freedom, not with the yaw response\n";
    }
    document.earlier_trials.iter().for_each(|sentence| summary += &format!("{sentence}\n"));
    let is_extrapolated = |replayed: &RecordReplay| replayed.extrapolated;
    if document.manoeuvres.iter().any(Prediction::is_extrapolated) || document.replays.iter().any(is_extrapolated) {
        summary += &format!(
            "extrapolated: beyond the rudder of {}° or the yaw rate of {}°/s in the records\n",
            fixed(to_deg(document.validity_range.rudder_rad), 1),
            fixed(to_deg(document.validity_range.yaw_rate_rad_s), 2)
        );
    }
    let turns = document.manoeuvres.iter().filter(|turn| matches!(turn.kind, Manoeuvre::TurningCircle { .. }));
    if turns.filter_map(|turn| turn.curves.most_probable.as_ref()).any(|passage| passage.track().is_none()) {
        summary += "no track, because the model has no hull: fit the records again with the length of the ship and a \
            column of speed or positions\n";
    }
    if !document.ballast.is_empty() {
        summary += &format!(
            "records are replayed with {}, manoeuvres are those of the ship above\n",
            file_names(&document.ballast)
        );
    }
    for prediction in document.manoeuvres.iter().filter(|prediction| prediction.incomplete_draws > 0) {
        let lost = counted(prediction.incomplete_draws as u64, "drawn ship");
        summary += &format!("{}: {lost} did not complete it\n", prediction.kind);
    }
    summary
}

/// Text below the table on the screen: replays, corrections to another loading, IMO criteria.
pub fn text_below_table(document: &PredictDocument) -> String {
    let mut below_table = String::new();
    for replayed in &document.replays {
        below_table += &format!("\n{}: {}\n", names::record_name(&replayed.name), coverage(replayed));
    }
    if !document.corrected.is_empty() {
        let table = predict_tables::loading_correction_table(document).to_text();
        below_table += &format!(
            "\nCorrected to {}, R = T F/B (MSC/Circ.1053, 3.4.1.2)\n{}\n{table}",
            OtherLoading::name(document.load.as_ref()),
            corrected_from(document)
        );
        doubts(document).for_each(|doubt| below_table += &format!("{doubt}\n"));
    }
    if !document.imo.is_empty() {
        let caution = caution(document).map_or_else(String::new, |caution| format!("{caution}\n"));
        below_table += &format!("\nIMO MSC.137(76)\n{caution}{}", predict_tables::criterion_table(document).to_text());
    } else if (document.length_m.is_none() || document.speed_m_s.is_none()) && !document.manoeuvres.is_empty() {
        below_table +=
            "\nIMO: not compared, length and speed of the ship are unknown; give --length-m and --speed-kn\n";
    }
    below_table
}

/// Caution on the IMO limits for a ship shorter than 100 m.
fn caution(document: &PredictDocument) -> Option<String> {
    document
        .length_m
        .zip(document.speed_m_s)
        .and_then(|(length, speed)| imo::short_ship_caution(Particulars { length, speed }))
}

/// Agreement of a record with its replay: coverage of the 90 % band, heading error, current removed.
fn coverage(replayed: &RecordReplay) -> String {
    let mut sentence = format!(
        "{} % of the headings are inside the 90 % band; {}",
        fixed(100.0 * replayed.band_coverage_90, 0),
        predict_figures::heading_error_phrase(replayed)
    );
    if let Some(current) = replayed.current {
        let doubt = current.north_sd_m_s.hypot(current.east_sd_m_s);
        let (speed, set) = (with_uncertainty(current.speed_m_s, Some(doubt)), fixed(current.set_deg, 0));
        sentence += &format!("; a current of {speed} m/s that sets to {set}° is removed from its track");
    }
    sentence
}

/// Statement on the files of the models from which a correction takes F and B.
fn corrected_from(document: &PredictDocument) -> String {
    format!("F from {}, B from {}", document.model_files(), file_names(&document.ballast))
}

/// Warnings on the corrected records, a line each.
fn doubts(document: &PredictDocument) -> impl Iterator<Item = String> {
    document
        .corrected
        .iter()
        .flat_map(|record| record.warnings.iter().map(|doubt| format!("{}: {}", record.name, doubt.text)))
}

/// Template of `report.md`.
#[derive(Template)]
#[template(path = "predict.md", escape = "none")]
struct PredictPage<'a> {
    document: &'a PredictDocument,
    lines: Vec<String>,
    caution: Option<String>,
    replays: Vec<String>,
    loading: String,
    corrected_from: String,
    doubts: Vec<String>,
    figures: PlacedFigures<&'static str>,
}

/// Content of `report.md` with its figures.
pub fn page(document: &PredictDocument) -> Page {
    let mut figures = PlacedFigures::default();
    figures.put("all", predict_figures::figures(document));
    let replay =
        |replay: &RecordReplay| format!("{}: {}", escaped_text(&names::record_name(&replay.name)), coverage(replay));
    let page = PredictPage {
        document,
        lines: text_above_table(document).lines().map(str::to_owned).collect(),
        caution: caution(document),
        replays: document.replays.iter().map(replay).collect(),
        loading: escaped_text(&OtherLoading::name(document.load.as_ref())),
        corrected_from: corrected_from(document),
        doubts: doubts(document).collect(),
        figures,
    };
    Page::new(page.render(), page.figures)
}
