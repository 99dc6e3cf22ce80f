//! Tests of tracks: records with positions but no speed, and the current in a turning circle.

use ship::angle::{from_deg, to_deg};
use simulate::{Manoeuvre, Recording, Side, SimulatedShip, Simulation, SteeringGear, StreamKey};

use crate::desk::{Desk, measured, of_repository};

const SCALE: [&str; 4] = ["--length-m", "160.9", "--speed-kn", "15"];

/// Distance of the pivot point ahead of the point whose positions are recorded, m.
const PIVOT: f64 = 60.0;

/// Time constant with which the sway velocity follows the yaw rate, s.
const LAG: f64 = 12.0;

/// A record of the Mariner with positions in a current (north and east, m/s), and without speed; 1 Hz.
fn record(manoeuvre: Manoeuvre, duration: f64, current: [f64; 2]) -> String {
    let ship = ship::ships::find_ship("mariner").expect("it is in the registry");
    let simulation = Simulation {
        gear: SteeringGear::with_rate(from_deg(2.5)),
        recording: Recording { sampling_period: 1.0, duration: Some(duration), ..Recording::default() },
        ..Simulation::new(SimulatedShip::from_ship(&ship), manoeuvre)
    };
    let truth = simulation.run(&StreamKey { seed: 1, cell: 0, replicate: 0 }).expect("a manoeuvre").truth;
    let speed = truth.speed.as_ref().expect("a hull has a speed");
    let (mut place, mut sway) = ([0.0; 2], 0.0);
    let mut text = String::from("t_s,heading_deg,rudder_deg,north_m,east_m\n");
    for (row, speed) in speed.iter().enumerate() {
        let surge = (speed.powi(2) - sway * sway).max(0.0).sqrt();
        let (sin, cos) = truth.heading[row].sin_cos();
        let over_ground = [surge * cos - sway * sin + current[0], surge * sin + sway * cos + current[1]];
        let [heading, rudder] = [truth.heading[row], truth.rudder[row]].map(to_deg);
        text += &format!("{},{heading:.6},{rudder:.4},{:.4},{:.4}\n", truth.time[row], place[0], place[1]);
        place = [0, 1].map(|axis| place[axis] + over_ground[axis]);
        sway += (-PIVOT * truth.yaw_rate[row] - sway) / LAG;
    }
    text
}

fn zig_zag() -> String {
    record(Manoeuvre::zig_zag(from_deg(20.0), from_deg(20.0)), 600.0, [0.0; 2])
}

fn circle(current: [f64; 2], turn_deg: f64) -> String {
    let heading_change = Some(from_deg(turn_deg));
    let turn =
        Manoeuvre::TurningCircle { rudder: from_deg(20.0), side: Side::Starboard, duration: None, heading_change };
    record(turn, if turn_deg > 700.0 { 1700.0 } else { 700.0 }, current)
}

/// A fit measures a circle among its records: the advance is the distance ahead at 90° change of heading. The page has
/// the circle to scale, and the IMO criteria that the zig-zag measures.
#[test]
fn a_fit_measures_a_circle_and_the_criteria() {
    let desk = Desk::new();
    let text = circle([0.0; 2], 400.0);
    let rows: Vec<Vec<f64>> = text
        .lines()
        .skip(1)
        .map(|line| line.split(',').map(|cell| cell.parse().expect("a number")).collect())
        .collect();
    desk.file("zig.csv", zig_zag());
    desk.file("turn.csv", text);
    let fit = ["fit", "zig.csv", "turn.csv", "--method", "output-error", "--out", "f", "--quiet"];
    desk.draw(&[&fit[..], &SCALE].concat()).is_done();
    let json = desk.json("f/fit.json");
    let turn = &json["trials"][1]["circle"];
    assert_eq!(turn["side"], "starboard");
    let begin = rows.iter().rposition(|row| row[2] == 0.0).unwrap_or(0);
    let ahead = |turned: f64| rows.iter().find(|row| row[1] >= turned).expect("she turns on");
    let lengths = |key: &str| turn[key].as_f64().expect("a number");
    let start = &rows[begin];
    assert!((lengths("advance_lengths") - (ahead(90.0)[3] - start[3]) / 160.9).abs() < 0.05, "{turn}");
    assert!((lengths("transfer_lengths") - (ahead(90.0)[4] - start[4]) / 160.9).abs() < 0.05, "{turn}");
    assert!((lengths("tactical_diameter_lengths") - (ahead(180.0)[4] - start[4]) / 160.9).abs() < 0.05, "{turn}");
    let form = json["form"].as_array().expect("entries");
    let overshoot = |side: &str| {
        let is_it = |entry: &&serde_json::Value| entry["section"] == "zig-zag 20°/20°" && entry["side"] == side;
        form.iter().find(is_it).and_then(|entry| entry["value"].as_f64())
    };
    assert_eq!(overshoot("starboard"), json["zigzag"]["overshoots_deg"][0].as_f64());
    assert_eq!(overshoot("port"), None);
    let page = desk.text("f/report.md");
    for part in ["## Against IMO MSC.137(76)", "## Turning circle", "](circle.png)", "## Form for reporting"] {
        assert!(page.contains(part), "{part}: {page}");
    }
    assert!(page.contains("turn, a turning circle to starboard with 20.0° of rudder: advance"), "{page}");
    // The predicted circle has the rudder of the measured circle, and its median track passes the median
    // characteristics.
    let predicted = &json["predicted_circle"];
    let tactical = predicted["tactical_diameter_lengths"]["median"].as_f64().expect("a number");
    assert!((tactical / lengths("tactical_diameter_lengths") - 1.0).abs() < 0.15, "{predicted} {turn}");
    assert!((predicted["rudder_deg"].as_f64().expect("a number") - 20.0).abs() < 0.1, "{predicted}");
    assert!(
        page.contains(
            "Predicted with the hulls fitted to the records, a turning circle to starboard with 20.0° of rudder"
        ),
        "{page}"
    );
    let track = &desk.json("f/curves.json")["predicted_circle"];
    let point = |axis: &str, number: usize| track[axis][number].as_f64().expect("a point every 3°");
    let median = |key: &str| predicted[key]["median"].as_f64().expect("a number");
    assert!((point("y", 30) - median("advance_lengths")).abs() < 1e-6, "{predicted}");
    assert!((point("x", 30) - median("transfer_lengths")).abs() < 1e-6, "{predicted}");
    assert!((point("x", 60) - tactical).abs() < 1e-6, "{predicted}");
    // A zig-zag without the length of the ship has no measured and no predicted circle.
    desk.run(&["fit", "zig.csv", "--method", "output-error", "--out", "bare", "--quiet"]).is_done();
    let bare = desk.json("bare/fit.json");
    assert!(bare["trials"][0].get("circle").is_none() && bare.get("predicted_circle").is_none());
}

/// A hull fitted to a record with positions predicts advance, drift angle, speed loss and pivot point of a turn.
#[test]
fn a_record_of_positions_tells_a_track() {
    let desk = Desk::new();
    desk.file("zig.csv", zig_zag());
    desk.run(&[&["fit", "zig.csv", "--method", "maximum-likelihood", "--out", "f", "--quiet"][..], &SCALE].concat())
        .is_done();
    let circle = ["predict", "f/fit.json", "--manoeuvre", "turning-circle:20", "--draws", "60", "--out", "p"];
    desk.run(&circle).is_done();
    let json = desk.json("p/predict.json");
    // The circle of IMO is predicted only if the verdict recommends K and T.
    desk.run(&[&["fit", "zig.csv", "--method", "output-error", "--out", "c", "--quiet"][..], &SCALE].concat())
        .is_done();
    let predicted = ["f", "c"].map(|folder| desk.json(&format!("{folder}/fit.json"))["predicted_circle"].clone());
    assert!(predicted[0].is_null(), "{}", predicted[0]);
    let [side, rudder, extrapolated] = ["side", "rudder_deg", "extrapolated"].map(|key| &predicted[1][key]);
    assert!(side == "starboard" && *rudder == 35.0 && *extrapolated == true, "{}", predicted[1]);
    let figures = &json["manoeuvres"][0]["figures"];
    let median = |name: &str| figures[name]["median"].as_f64().unwrap_or_else(|| panic!("{name}: {figures}"));
    assert!((2.0..5.0).contains(&median("advance_lengths")), "{figures}");
    assert!((0.2..1.0).contains(&median("pivot_ahead_lengths")), "{figures}");
    assert!(median("drift_angle_deg") > 2.0 && median("speed_loss_share") > 0.05, "{figures}");
    // Heading and rudder alone give no track.
    let bare: String =
        zig_zag().lines().map(|line| line.rsplitn(3, ',').last().unwrap_or(line).to_owned() + "\n").collect();
    desk.file("bare.csv", bare);
    desk.run(&[&["fit", "bare.csv", "--method", "maximum-likelihood", "--out", "b", "--quiet"][..], &SCALE].concat())
        .is_done();
    let run = desk.run(&["predict", "b/fit.json", "--manoeuvre", "turning-circle:20", "--draws", "60", "--out", "q"]);
    assert!(run.is_done().out.contains("no track"), "{}", run.out);
}

/// The current in a circle of two rounds is removed from its track, and from that of another record.
#[test]
fn a_current_is_found_and_taken_out() {
    let desk = Desk::new();
    desk.file("zig.csv", zig_zag());
    desk.file("still.csv", circle([0.0; 2], 400.0));
    desk.file("drifting.csv", circle([0.6, -0.8], 400.0));
    desk.file("two-rounds.csv", circle([0.6, -0.8], 760.0));
    desk.run(&[&["fit", "zig.csv", "--method", "maximum-likelihood", "--out", "f", "--quiet"][..], &SCALE].concat())
        .is_done();
    let replayed = |record: &str, more: &[&str]| {
        let run =
            [&["predict", "f/fit.json", "--replay", record, "--draws", "60", "--out", "p"][..], &SCALE, more].concat();
        desk.run(&run).is_done();
        desk.json("p/predict.json")["replays"][0].clone()
    };
    let measured = |replay: &serde_json::Value, name: &str| {
        replay["figures"][name]["measured"].as_f64().unwrap_or_else(|| panic!("{name}: {replay}"))
    };
    let own = replayed("two-rounds.csv", &[]);
    let current = &own["current"];
    assert!((current["north_m_s"].as_f64().expect("found") - 0.6).abs() < 0.05, "{current}");
    assert!((current["east_m_s"].as_f64().expect("found") + 0.8).abs() < 0.05, "{current}");
    let (still, drifting) = (replayed("still.csv", &[]), replayed("drifting.csv", &[]));
    assert!(still["current"].is_null() && drifting["current"].is_null(), "one round tells no current");
    let own_method = ["--method", "maximum-likelihood"];
    let drawn = ["predict", "f/fit.json", "--replay", "still.csv", "--draws", "60", "--out", "drawn"];
    let run = desk.draw(&[&drawn[..], &SCALE, &own_method].concat());
    assert!(run.is_done().err.contains("the ship is steered with her fitted hulls"), "{}", run.err);
    // The page names no folder of this machine, and no source of uncertainty, because a replay draws none alone.
    let page = desk.text("drawn/report.md");
    let shown = ["\n\nfit.json: 60 ships", "which adds up over 1.1 rounds: the mean yaw rate is"];
    assert!(shown.iter().all(|part| page.contains(part)) && !page.contains("ostly from"), "{page}");
    let figure = desk.text("drawn/replay-still-track.svg");
    assert!(figure.contains("median of the drawn ships") && figure.contains("measured"), "both circles are drawn");
    let mended = replayed("drifting.csv", &["--current-from", "two-rounds.csv"]);
    for name in ["advance_m", "tactical_diameter_m"] {
        let [truth, with, without] = [&still, &drifting, &mended].map(|replay| measured(replay, name));
        assert!((without - truth).abs() < 0.1 * (with - truth).abs() + 5.0, "{name}: {truth} {with} {without}");
        assert!((measured(&own, name) - truth).abs() < 10.0, "{name}");
    }
    let wrong = ["predict", "f/fit.json", "--replay", "still.csv", "--current-from", "drifting.csv"];
    desk.run(&wrong).is_refused(2, &["--current-from drifting.csv", "720°"]);
    desk.run(&["predict", "f/fit.json", "--current-from", "two-rounds.csv"]).is_refused(2, &["--replay"]);
}

/// Three circles of Esso Osaka on the same pond have two rounds; their estimated currents are nearly equal.
#[test]
fn the_current_of_one_circle_is_about_that_of_another() {
    let Some(data) = measured() else { return };
    let desk = Desk::new();
    desk.file("zig.csv", zig_zag());
    desk.run(&[&["fit", "zig.csv", "--method", "maximum-likelihood", "--out", "f", "--quiet"][..], &SCALE].concat())
        .is_done();
    let sidecars = of_repository("scenarios/measured").to_string_lossy().into_owned();
    let path = |name: &str| data.join("esso_osaka").join(name).to_string_lossy().into_owned();
    let names = ["oct14_15_06_53", "sep14_13_51_45", "sep14_14_50_41", "oct14_14_29_49"];
    let records = names.map(|name| path(&format!("turning_{name}.csv")));
    let replays = records.iter().flat_map(|record| ["--replay", record.as_str()]);
    let run: Vec<&str> = ["predict", "f/fit.json", "--columns", &sidecars, "--draws", "50", "--out", "p"]
        .into_iter()
        .chain(replays)
        .collect();
    desk.run(&run).is_done();
    let json = desk.json("p/predict.json");
    let currents: Vec<Option<[f64; 2]>> = (0..4)
        .map(|replay| {
            let current = &json["replays"][replay]["current"];
            Some([current["north_m_s"].as_f64()?, current["east_m_s"].as_f64()?])
        })
        .collect();
    assert_eq!(currents[3], None, "671° tell no current");
    let shown: Vec<[f64; 2]> = currents.into_iter().flatten().collect();
    assert_eq!(shown.len(), 3);
    for one in &shown {
        for other in &shown {
            let [size, between] = [one[0].hypot(one[1]), (one[0] - other[0]).hypot(one[1] - other[1])];
            assert!((0.02..0.035).contains(&size) && between < 0.009, "{shown:?}");
        }
    }
}
