//! The page of a prediction: words, tables and figures.

use predict::Kind;
use predict::replay::Replayed;
use report::markdown::text;
use report::number::{fixed, with_uncertainty};
use ship::angle::to_deg;

use super::predict_report::Predicted;
use super::{predict_correction, predict_tables};

/// What was predicted from what.
pub fn words(predicted: &Predicted) -> String {
    let files: Vec<&str> = predicted.models.iter().map(|(file, _)| file.as_str()).collect();
    let weather = match predicted.calm {
        true => "in a calm",
        false => "in the weather of the records",
    };
    let mut words = format!("{}: {} ships drawn, {weather}\n", files.join(", "), predicted.draws);
    if predicted.hull {
        words += "the records have surge and sway: the ship is the hull fitted to them, not the yaw response\n";
    }
    if predicted.manoeuvres.iter().any(|prediction| prediction.extrapolated) {
        words += &format!(
            "extrapolated: beyond the rudder of {}° and the yaw rate of {}°/s of the records\n",
            fixed(to_deg(predicted.seen.rudder_rad), 1),
            fixed(to_deg(predicted.seen.yaw_rate_rad_s), 2)
        );
    }
    let turns = predicted.manoeuvres.iter().filter(|one| matches!(one.kind, Kind::TurningCircle { .. }));
    if turns.filter_map(|one| one.most_probable.as_ref()).any(|passage| passage.way.is_none()) {
        words += "no track: the length of the ship is not known, or its records do not tell speed loss and drift\n";
    }
    if !predicted.ballast.is_empty() {
        words += &format!(
            "records are replayed with {}, manoeuvres are told of the ship above\n",
            predicted.ballast.join(", ")
        );
    }
    for prediction in predicted.manoeuvres.iter().filter(|prediction| prediction.lost > 0) {
        words += &format!("{}: {} drawn ships do not come to its end\n", prediction.kind, prediction.lost);
    }
    words
}

/// What follows the table on the screen.
pub fn rest(predicted: &Predicted) -> String {
    let mut rest = String::new();
    for (trial, replayed) in &predicted.replays {
        rest += &format!("\n{}: {}\n", trial.name(), coverage(replayed));
    }
    rest += &predict_correction::on_screen(predicted);
    if !predicted.criteria.is_empty() {
        rest += &format!("\nIMO MSC.137(76)\n{}", predict_tables::criteria(predicted).to_text());
    } else if predicted.particulars.is_none() && !predicted.manoeuvres.is_empty() {
        rest += "\nIMO: not compared, length and speed of the ship are not known; give --length-m and --speed-kn\n";
    }
    rest
}

/// How near a record is to its replay.
fn coverage(replayed: &Replayed) -> String {
    let mut words = format!(
        "{} % of the headings are inside the 90 % band, rms {}°",
        fixed(100.0 * replayed.band_coverage_90, 0),
        fixed(to_deg(replayed.rms), 2)
    );
    if let Some(current) = replayed.current {
        let doubt = current.deviation[0].hypot(current.deviation[1]);
        let (speed, set) = (with_uncertainty(current.speed(), Some(doubt)), fixed(to_deg(current.set()), 0));
        words += &format!("; a current of {speed} m/s that sets to {set}° is not part of its track");
    }
    words
}

/// The page.
pub fn page(predicted: &Predicted, drawn: &[(String, String)]) -> String {
    let mut page = String::from("# Prediction\n\n");
    for line in words(predicted).lines() {
        page += &format!("{}\n\n", text(line));
    }
    page += "Every row is a figure of merit of ships that are drawn from the model: a structure by its probability, \
             parameters by their covariance, a random moment, a rate of the rudder and a first yaw rate as the records \
             have them. Intervals hold 50 and 90 % of them. \"Mostly from\" names the source that makes most of the \
             interval, each source drawn alone.\n\n";
    page += &predict_tables::figures(predicted).to_markdown();
    if !predicted.criteria.is_empty() {
        page += "\n## IMO MSC.137(76)\n\nThe share of the drawn ships that keep within the limit. The criteria are for \
                 full load, even keel, deep water and calm.\n\n";
        page += &predict_tables::criteria(predicted).to_markdown();
    }
    if !predicted.replays.is_empty() {
        page += "\n## Records\n\nNothing is fitted to these records. The band is that of the recorded rudder; figures of a \
                 zig-zag are those of a helm that reverses the rudder at the headings of the record.\n\n";
        for (trial, replayed) in &predicted.replays {
            page += &format!("- {}: {}\n", text(trial.name()), coverage(replayed));
        }
    }
    page += &predict_correction::section(predicted);
    if predicted.form.is_some() {
        page += "\nThe form of MSC/Circ.1053 is in [trial-form.md](trial-form.md).\n";
    }
    for (stem, caption) in drawn {
        page += &format!("\n![{0}]({stem}.png)\n\n{0}\n", text(caption));
    }
    page
}
