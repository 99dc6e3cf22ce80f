//! Measured trials: what is read off them against what the raw samples show.

use ship::angle::{from_deg, to_deg};

use trial::zigzag::{BaseCourseSource, Side, ZigZag, ZigZagError};
use trial::{RecordOrigin, Trial};

/// A measured record; `None` if the data are not there.
fn measured(file: &str) -> Option<Trial> {
    let origin = RecordOrigin::Measured { file: file.into(), sha256: String::new() };
    Some(Trial::new(file, origin, kempf_tests::measured::columns(file)?).expect("consistent columns"))
}

/// What the rows of a record show to the eye: pair, first side, time of the first execute, number of executes and of
/// peaks, speed of the rudder in deg/s where the rudder and not its order was recorded.
type Seen = (&'static str, (f64, f64), Side, f64, usize, usize, Option<f64>);

const SEEN: [Seen; 13] = [
    ("kvlcc2_hsva/zigzag_05_01.csv", (5.0, 1.0), Side::Starboard, 0.75, 9, 8, None),
    ("kvlcc2_hsva/zigzag_10_05.csv", (10.0, 5.0), Side::Starboard, 1.6, 6, 5, Some(15.8)),
    ("kvlcc2_hsva/zigzag_10_10_s.csv", (10.0, 10.0), Side::Starboard, 0.8, 3, 2, Some(15.8)),
    ("kvlcc2_hsva/zigzag_15_05.csv", (15.0, 5.0), Side::Starboard, 1.3, 8, 7, Some(15.8)),
    ("kvlcc2_hsva/zigzag_20_05.csv", (20.0, 5.0), Side::Starboard, 1.35, 9, 8, Some(15.8)),
    ("kvlcc2_hsva/zigzag_20_10_s.csv", (20.0, 10.0), Side::Starboard, 0.85, 8, 7, Some(15.8)),
    ("kvlcc2_marin/zigzag_10.csv", (10.0, 10.0), Side::Port, 7.1, 3, 2, Some(2.34)),
    ("kvlcc2_marin/zigzag_20.csv", (20.0, 20.0), Side::Port, 6.5, 4, 2, Some(2.34)),
    ("esso_osaka/zigzag_13_04_24.csv", (20.0, 20.0), Side::Starboard, 44.15, 5, 3, None),
    ("esso_osaka/zigzag_13_14_21.csv", (30.0, 30.0), Side::Starboard, 18.35, 5, 4, None),
    ("esso_osaka/zigzag_13_42_53.csv", (30.0, 30.0), Side::Starboard, 33.65, 5, 4, None),
    ("esso_osaka/zigzag_13_57_45.csv", (20.0, 20.0), Side::Starboard, 26.45, 4, 3, None),
    ("esso_osaka/zigzag_14_10_05.csv", (20.0, 20.0), Side::Starboard, 32.45, 4, 3, None),
];

#[test]
fn characteristics_are_what_the_samples_show() {
    for (file, (delta_deg, psi_deg), side, first, executes, peaks, rudder_rate_deg_s) in SEEN {
        let Some(trial) = measured(file) else { return };
        let zigzag = ZigZag::from_trial(&trial).expect("a zig-zag");
        let pair = zigzag.nominal_angles.expect("the headings at the executes agree");
        assert!(pair.is_deg(delta_deg, psi_deg), "{file}: {pair}");
        assert_eq!(zigzag.first_side, Some(side), "{file}");
        assert_eq!(zigzag.base_course.source, BaseCourseSource::Approach, "{file}");
        let begin = zigzag.executes[0].time.value;
        assert!((begin - first).abs() < 0.1, "{file}: first execute at {begin}");
        assert_eq!((zigzag.executes.len(), zigzag.overshoots.len()), (executes, peaks), "{file}");
        if let Some(expected) = rudder_rate_deg_s {
            let rate = to_deg(zigzag.rudder_rate.expect("the ramp is resolved"));
            assert!((rate / expected - 1.0).abs() < 0.03, "{file}: rudder rate {rate}");
        }
        assert!(zigzag.initial_turning_time.is_some() && zigzag.reach.is_some(), "{file}");
        check_peaks(file, &trial, &zigzag);
    }
}

/// The largest raw heading of a swing is at most a few noise deviations above the smooth peak and never far below it.
/// The HSVA headings hold for several rows and then step by up to 0.02 degrees, the Esso Osaka headings, from two
/// antennas, jump by a degree or more.
fn check_peaks(file: &str, trial: &Trial, zigzag: &ZigZag) {
    let noise = zigzag.heading_noise_sd.expect("enough rows to estimate it");
    let tolerance = if file.starts_with("esso") { from_deg(1.2) } else { from_deg(0.02) + 4.0 * noise };
    for overshoot in &zigzag.overshoots {
        let execute = &zigzag.executes[overshoot.execute];
        let until = zigzag.executes.get(overshoot.execute + 1).map_or(f64::INFINITY, |next| next.time.value);
        let side = -execute.side().sign();
        let raw = trial
            .observed_rows()
            .filter(|&row| (execute.time.value..until).contains(&trial.time()[row]))
            .map(|row| side * trial.heading()[row])
            .fold(f64::NEG_INFINITY, f64::max);
        let difference = raw - side * overshoot.peak_heading.value;
        assert!(difference.abs() < tolerance, "{file}: the samples peak {:.3} deg higher", to_deg(difference));
        assert!(overshoot.angle.value > 0.0 && overshoot.time_to_check_yaw.value > 0.0, "{file}");
    }
}

#[test]
fn a_turning_circle_is_refused() {
    let Some(trial) = measured("kvlcc2_marin/turning_35.csv") else { return };
    assert_eq!(ZigZag::from_trial(&trial), Err(ZigZagError::TooFewReversals { reversals: 0, needed: 2 }));
}
