//! Measured trials: the equations fitted to zig-zags of a model, and a turning circle of another one of the same ship.

use std::path::PathBuf;

use trial::{Channel, Columns, Origin, Trial};

use super::sd;
use crate::motion::planar::pooled;
use crate::motion::{MotionOutput, Planar, SYMBOLS, TurningCircleFigures, fit, track, turning_circle};

/// `None` (and one line) where the data are not there.
pub(super) fn measured(file: &str) -> Option<Trial> {
    let folder = std::env::var_os("TRIAL_DATA")
        .map_or_else(|| PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../../shared/data"), PathBuf::from);
    let path = folder.join(file);
    if !path.exists() {
        println!("skipped: no measured record {file}");
        return None;
    }
    let mut table = csv::Reader::from_path(path).expect("a readable file");
    let names = table.headers().expect("a header").clone();
    let known: Vec<_> = names.iter().map(trial::channel::column).collect();
    let mut columns = Columns::default();
    for row in table.records() {
        let row = row.expect("a row");
        let value = |index: usize| row[index].parse::<f64>().expect("a number");
        columns.time.push(value(0));
        for (index, found) in known.iter().enumerate() {
            if let Some((channel, unit)) = found {
                columns.channels.entry(*channel).or_default().push(value(index) * unit.to_si());
            }
        }
    }
    let origin = Origin::Measured { file: file.into(), sha256: String::new() };
    Some(Trial::new(file, origin, columns).expect("a record"))
}

const ZIG_ZAGS: [&str; 5] = ["10_10_s", "20_10_s", "20_05", "30_05", "35_05"];

/// Model of 7 m.
const LENGTH: f64 = 7.0;

fn zig_zags() -> Option<Vec<Trial>> {
    ZIG_ZAGS.iter().map(|name| measured(&format!("kvlcc2_hsva/zigzag_{name}.csv"))).collect()
}

/// Root mean square of what a fit says of surge and sway of a record that it has not seen, over its approach speed.
fn held_out(planar: &Planar, trial: &Trial) -> [f64; 2] {
    let read = |channel| trial.channel(channel).expect("the channel");
    let (surge, sway) = (read(Channel::Surge), read(Channel::Sway));
    let found = planar.drive(trial.time(), trial.yaw_rate().expect("a yaw rate"), trial.rudder(), [surge[0], sway[0]]);
    let rms = |axis: usize, read: &[f64]| {
        let square: f64 = found.iter().zip(read).map(|(found, read)| (found[axis] - read).powi(2)).sum();
        (square / read.len() as f64).sqrt() / planar.approach_speed
    };
    [rms(0, surge), rms(1, sway)]
}

#[test]
fn zig_zags_of_hsva_tell_those_left_out() {
    let Some(trials) = zig_zags() else { return };
    let planar = fit(&trials, LENGTH).expect("a fit");
    assert!((planar.approach_speed - 1.177).abs() < 2e-3, "{}", planar.approach_speed);
    // Measured: 0.0044 and 0.0038 m/s, that is 0.4 and 0.3 % of the approach speed.
    for output in [MotionOutput::Surge, MotionOutput::Sway] {
        let rms = pooled(&planar.records, output).expect("an output");
        println!("fitted {output:?}: {rms:.4} m/s");
        assert!(rms < 0.005, "{output:?}: {rms}");
    }
    for (i, (value, symbol)) in planar.coefficients.to_array().iter().zip(SYMBOLS).enumerate() {
        let deviation = sd(&planar.covariance, i);
        println!("{symbol} {value:.4} ± {deviation:.4}");
        assert!(deviation > 0.0 && deviation < 0.1 * value, "{symbol}: {value} ± {deviation}");
    }
    let held: Vec<[f64; 2]> = (0..trials.len())
        .map(|left_out| {
            let mut rest = trials.clone();
            let out = rest.remove(left_out);
            held_out(&fit(&rest, LENGTH).expect("a fit"), &out)
        })
        .collect();
    println!("held out, of the approach speed: {held:.4?}");
    assert!(held.iter().all(|[surge, sway]| *surge < 0.0075 && *sway < 0.0055), "{held:?}");
}

/// Figures of MARIN's circle from its positions, from its velocities, and as the equations tell them of its yaw rate
/// and rudder.
fn circle(planar: &Planar) -> Option<[TurningCircleFigures; 3]> {
    let circle = measured("kvlcc2_marin/turning_35.csv")?;
    // Up to the end of the turn.
    let rows = circle.time().partition_point(|time| *time < 1513.0);
    let read = |channel| &circle.channel(channel).expect("the channel")[..rows];
    let (time, heading, rudder) = (&circle.time()[..rows], &circle.heading()[..rows], &circle.rudder()[..rows]);
    let (surge, sway, yaw_rate) = (read(Channel::Surge), read(Channel::Sway), read(Channel::YawRate));
    // As `find` bounds it: the rudder leaves 1.2° at 4.1 s.
    let figures =
        |track: &[[f64; 2]], velocity: &[[f64; 2]]| turning_circle([time, heading, yaw_rate], [track, velocity], 4.1);
    let pairs = |one: &[f64], other: &[f64]| one.iter().zip(other).map(|(x, y)| [*x, *y]).collect::<Vec<_>>();
    let (positions, velocity) = (pairs(read(Channel::North), read(Channel::East)), pairs(surge, sway));
    // 15.5 knots, at the Froude number of the model.
    let ship = planar.scaled_to(320.0, 7.974).expect("a ship");
    let told = ship.drive(time, yaw_rate, rudder, [surge[0], sway[0]]);
    Some([
        figures(&positions, &velocity),
        figures(&track(time, heading, &velocity), &velocity),
        figures(&track(time, heading, &told), &told),
    ])
}

/// Errors of advance, transfer and tactical diameter against the measured positions.
fn errors(measured: &TurningCircleFigures, told: &TurningCircleFigures) -> [f64; 3] {
    let of = |figure: fn(&TurningCircleFigures) -> Option<f64>| {
        figure(told).expect("a figure") / figure(measured).expect("a figure") - 1.0
    };
    [of(|c| c.advance), of(|c| c.transfer), of(|c| c.tactical_diameter)]
}

/// Aim: advance within 2 %, tactical diameter within 4 %. Found: −2.0, +1.0 and −1.1 %. Positions and velocities of the
/// record itself differ by −1.2, −1.7 and −3.6 %.
#[test]
fn the_circle_of_another_model_of_that_ship_is_foretold() {
    let Some(trials) = zig_zags() else { return };
    let Some([measured, own, told]) = circle(&fit(&trials, LENGTH).expect("a fit")) else { return };
    println!("measured {measured:.3?}\nfrom measured velocities {own:.3?}\nforetold {told:.3?}");
    println!("errors {:.4?}, of measured velocities {:.4?}", errors(&measured, &told), errors(&measured, &own));
    let [advance, transfer, tactical_diameter] = errors(&measured, &told);
    assert!(advance.abs() < 0.025 && transfer.abs() < 0.03 && tactical_diameter.abs() < 0.04);
    let [drift, expected] = [told, measured].map(|circle| circle.drift_angle.expect("a steady turn"));
    assert!((drift - expected).abs() < 0.06, "{drift} {expected}");
    let [speed, expected] = [told, measured].map(|circle| circle.speed_ratio.expect("a steady turn"));
    assert!((speed - expected).abs() < 0.05, "{speed} {expected}");
}

/// The same zig-zags when only the positions were read. Found: −2.5, +3.3 and +0.2 %. The sway is told less well than
/// by velocities: its damping Y_v is three times as large, and what is turning and what is rudder force differ with it.
#[test]
fn positions_of_the_zig_zags_tell_the_circle_as_well() {
    let Some(trials) = zig_zags() else { return };
    let trials: Vec<Trial> =
        trials.into_iter().map(|trial| trial.without(&[Channel::Surge, Channel::Sway, Channel::Speed])).collect();
    let planar = fit(&trials, LENGTH).expect("a fit");
    let rms = pooled(&planar.records, MotionOutput::Position).expect("positions");
    println!("{:?}\npositions {rms:.4} m", planar.coefficients);
    assert!(rms < 0.05, "{rms}");
    let Some([measured, _, told]) = circle(&planar) else { return };
    println!("errors {:.4?}", errors(&measured, &told));
    let [advance, _, tactical_diameter] = errors(&measured, &told);
    assert!(advance.abs() < 0.04 && tactical_diameter.abs() < 0.04);
}
