//! The page of a prediction: words, tables and figures.

use askama::Template;
use document::names;
use predict::document::OtherLoading;
use predict::replay::RecordReplay;
use predict::{PredictDocument, Prediction};
use report::markdown::text;
use report::number::{counted, fixed, with_uncertainty};
use report::{Page, PlacedFigures};
use ship::angle::to_deg;
use ship::{Particulars, ShortNumber};
use trial::{Manoeuvre, imo};

use super::{predict_figures, predict_tables};

/// What was predicted from what.
pub fn words(document: &PredictDocument) -> String {
    let weather = match document.calm {
        true => "in a calm",
        false => "in the weather of the records",
    };
    let mut words = format!("{}: {} ships drawn, {weather}\n", document.model_files(), document.draws);
    if let Some(OtherLoading { draughts_at_trials_m: before, draught_m, factor, .. }) = &document.load {
        let before: Vec<String> = before.iter().map(|draught| ShortNumber(*draught).to_string()).collect();
        words += &format!(
            "the ship is the hull of the form mmg, taken from a draught of {} m to {} m by the formulas of \
             `study list priors`, standard deviations × {factor}; this was checked against no measurement\n",
            before.join(", "),
            ShortNumber(*draught_m)
        );
    } else if document.hull {
        words += "predicted with the fitted hulls of three degrees of freedom, not with the yaw response\n";
    }
    document.earlier_trials.iter().for_each(|said| words += &format!("{said}\n"));
    if document.manoeuvres.iter().any(Prediction::is_extrapolated) {
        words += &format!(
            "extrapolated: beyond the rudder of {}° or the yaw rate of {}°/s of the records\n",
            fixed(to_deg(document.seen.rudder_rad), 1),
            fixed(to_deg(document.seen.yaw_rate_rad_s), 2)
        );
    }
    let turns = document.manoeuvres.iter().filter(|one| matches!(one.kind, Manoeuvre::TurningCircle { .. }));
    if turns.filter_map(|one| one.curves.most_probable.as_ref()).any(|passage| passage.track().is_none()) {
        words += "no track: the model has no hull; fit records with a speed or positions again, with the length of the ship\n";
    }
    if !document.ballast.is_empty() {
        words += &format!(
            "records are replayed with {}, manoeuvres are those of the ship above\n",
            document.ballast.join(", ")
        );
    }
    for prediction in document.manoeuvres.iter().filter(|prediction| prediction.lost > 0) {
        let lost = counted(prediction.lost as u64, "drawn ship");
        words += &format!("{}: not completed by {lost}\n", prediction.kind);
    }
    words
}

/// What follows the table on the screen.
pub fn rest(document: &PredictDocument) -> String {
    let mut rest = String::new();
    for replayed in &document.replays {
        rest += &format!("\n{}: {}\n", names::record(&replayed.name), coverage(replayed));
    }
    if !document.corrected.is_empty() {
        let table = predict_tables::corrected(document).to_text();
        rest += &format!(
            "\nCorrected to {}, R = T F/B (MSC/Circ.1053, 3.4.1.2)\n{}\n{table}",
            OtherLoading::name(document.load.as_ref()),
            corrected_from(document)
        );
        doubts(document).for_each(|doubt| rest += &format!("{doubt}\n"));
    }
    if !document.imo.is_empty() {
        let caution = caution(document).map_or_else(String::new, |caution| format!("{caution}\n"));
        rest += &format!("\nIMO MSC.137(76)\n{caution}{}", predict_tables::criteria(document).to_text());
    } else if (document.length_m.is_none() || document.speed_m_s.is_none()) && !document.manoeuvres.is_empty() {
        rest += "\nIMO: not compared, length and speed of the ship are not known; give --length-m and --speed-kn\n";
    }
    rest
}

/// What the limits mean for a short ship.
fn caution(document: &PredictDocument) -> Option<String> {
    document.length_m.zip(document.speed_m_s).and_then(|(length, speed)| imo::caution(Particulars { length, speed }))
}

/// How near a record is to its replay.
fn coverage(replayed: &RecordReplay) -> String {
    let mut words = format!(
        "{} % of the headings are inside the 90 % band, rms {}°",
        fixed(100.0 * replayed.band_coverage_90, 0),
        fixed(replayed.heading_rmse_deg, 2)
    );
    if let Some(current) = replayed.current {
        let doubt = current.north_sd_m_s.hypot(current.east_sd_m_s);
        let (speed, set) = (with_uncertainty(current.speed_m_s, Some(doubt)), fixed(current.set_deg, 0));
        words += &format!("; a current of {speed} m/s that sets to {set}° is not part of its track");
    }
    words
}

/// The models of a correction.
fn corrected_from(document: &PredictDocument) -> String {
    format!("F from {}, B from {}", document.model_files(), document.ballast.join(", "))
}

/// What is to be said of whole records that were corrected, a line each.
fn doubts(document: &PredictDocument) -> impl Iterator<Item = String> {
    document.corrected.iter().flat_map(|own| own.warnings.iter().map(|doubt| format!("{}: {}", own.name, doubt.text)))
}

/// `report.md`.
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

/// `report.md` with its figures.
pub fn page(document: &PredictDocument) -> Page {
    let mut figures = PlacedFigures::default();
    figures.put("all", predict_figures::figures(document));
    let replay = |replay: &RecordReplay| format!("{}: {}", text(&names::record(&replay.name)), coverage(replay));
    let page = PredictPage {
        document,
        lines: words(document).lines().map(str::to_owned).collect(),
        caution: caution(document),
        replays: document.replays.iter().map(replay).collect(),
        loading: text(&OtherLoading::name(document.load.as_ref())),
        corrected_from: corrected_from(document),
        doubts: doubts(document).collect(),
        figures,
    };
    Page::new(page.render(), page.figures)
}
