//! Logs of a simulated ship with one manoeuvre or several, and logs without manoeuvres.

mod confusers;
mod ship;

use ::ship::angle::{from_deg, to_deg};

use self::ship::SimulatedLog;
use super::{ApproachState, DetectedManoeuvre, detect_manoeuvres};
use crate::Manoeuvre;

/// A zig-zag after twelve minutes on a course, followed by a straight course.
fn half_an_hour(step: f64) -> (SimulatedLog, (f64, f64)) {
    let mut log = SimulatedLog::new(step);
    log.keep(720.0);
    log.hold(0.0, 60.0);
    let part = log.zig_zag(10.0, 10.0, 12);
    log.hold(0.0, 60.0);
    let course = log.course;
    log.steer(course, 600.0);
    (log, part)
}

fn assert_part(part: &DetectedManoeuvre, (start, until): (f64, f64), step: f64) {
    assert!(
        (part.first_execute_time - start).abs() <= 2.001 * step,
        "starts at {} for {start}",
        part.first_execute_time
    );
    assert!((part.end_time - until).abs() <= 2.001 * step, "ends at {} for {until}", part.end_time);
}

#[test]
fn a_zig_zag_in_half_an_hour_is_found_to_the_row() {
    for step in [0.1, 0.5, 1.0] {
        let (log, part) = half_an_hour(step);
        let detected = log.detected();
        assert_eq!(detected.len(), 1, "{:?}", log.names());
        assert_part(&detected[0], part, step);
        assert_eq!(detected[0].execute_count, 12);
        let Some(Manoeuvre::ZigZag { rudder, heading, .. }) = detected[0].manoeuvre else { panic!("a zig-zag") };
        assert!((to_deg(rudder) - 10.0).abs() < 0.01, "{}", to_deg(rudder));
        assert!((to_deg(heading) - 10.0).abs() < 0.8, "{}", to_deg(heading));
        assert_eq!(detected[0].quality.approach, Some(ApproachState::Steady));
        assert!(
            detected[0].start_time < part.0 - 5.0 && detected[0].start_time > part.0 - 60.0,
            "from {}",
            detected[0].start_time
        );
        assert_eq!(log.names(), ["straight", "zig-zag 10/10", "straight"]);
    }
}

#[test]
fn an_unsteady_approach_is_left_out() {
    let (mut log, part) = half_an_hour(0.2);
    let rows = log.time.len();
    for row in 0..rows {
        // The speed increases until some time in the trial.
        log.speed[row] = 8.0 * (log.time[row] / 900.0).min(1.0);
    }
    let detected = log.detected();
    assert_eq!(detected.len(), 1);
    assert!((detected[0].start_time - part.0).abs() < 0.41, "{} for {}", detected[0].start_time, part.0);
    assert_eq!(detected[0].quality.approach, Some(ApproachState::Unsteady));
    assert!(detected[0].quality.remarks().iter().any(|remark| remark.contains("grew")));
}

#[test]
fn the_stop_of_the_propeller_ends_a_part() {
    let (mut log, part) = half_an_hour(0.2);
    let stop = part.1 - 15.0;
    (0..log.time.len())
        .filter(|&row| log.time[row] > stop)
        .collect::<Vec<_>>()
        .iter()
        .for_each(|&row| log.propeller[row] = 0.0);
    let detected = log.detected();
    assert!((detected[0].end_time - stop).abs() < 0.41, "{} for {stop}", detected[0].end_time);
}

/// Periods of 20 s at 50 Hz and of 15 minutes at 1 Hz, fast and slow gear.
#[test]
fn models_and_tankers() {
    for (step, factor, gear_deg) in
        [(0.02, 0.15, 20.0), (0.01, 0.2, 1e4), (1.0, 8.0, 2.3), (1.0, 8.0, 1e4), (2.0, 4.0, 3.0)]
    {
        for (delta_deg, psi_deg) in [(10.0, 10.0), (20.0, 20.0), (20.0, 10.0), (35.0, 20.0)] {
            let mut log = SimulatedLog::scaled(step, factor);
            log.gear = from_deg(gear_deg);
            log.hold(0.0, 200.0 * factor);
            let part = log.zig_zag(delta_deg, psi_deg, 5);
            log.hold(0.0, 200.0 * factor);
            let detected = log.detected();
            assert_eq!(detected.len(), 1, "{step} {factor} {delta_deg}/{psi_deg}: {:?}", log.names());
            assert_part(&detected[0], part, step);
            assert_eq!(detected[0].execute_count, 5);
            let Some(Manoeuvre::ZigZag { heading, .. }) = detected[0].manoeuvre else { panic!("a zig-zag") };
            let share = to_deg(heading) / psi_deg;
            assert!(share > 0.95 && share < 1.25, "{step} {factor} {delta_deg}/{psi_deg}: {share}");
        }
    }
}

#[test]
fn faults_of_a_rudder_do_not_hide_a_zig_zag() {
    type Fault = fn(&mut SimulatedLog);
    let faults: [(&str, Fault, f64); 5] = [
        (
            "noise",
            |log| (0..log.rudder.len()).for_each(|row| log.rudder[row] += from_deg(0.3) * log.chance.draw()),
            0.9,
        ),
        ("whole degrees", |log| log.rudder.iter_mut().for_each(|x| *x = from_deg(to_deg(*x).round())), 0.5),
        ("offset", |log| log.rudder.iter_mut().for_each(|x| *x += from_deg(1.5)), 0.41),
        ("spikes", |log| log.rudder.iter_mut().step_by(97).for_each(|x| *x = 0.5), 0.41),
        ("no headings at times", |log| log.heading.iter_mut().skip(3).step_by(3).for_each(|x| *x = f64::NAN), 0.41),
    ];
    for (name, fault, tolerance) in faults {
        let (mut log, part) = half_an_hour(0.2);
        fault(&mut log);
        let detected = log.detected();
        assert_eq!(detected.len(), 1, "{name}: {:?}", log.names());
        assert_eq!((detected[0].name().as_str(), detected[0].execute_count), ("zig-zag 10/10", 12), "{name}");
        assert!(
            (detected[0].first_execute_time - part.0).abs() < tolerance,
            "{name}: {} for {}",
            detected[0].first_execute_time,
            part.0
        );
        assert!((detected[0].end_time - part.1).abs() < tolerance, "{name}: {} for {}", detected[0].end_time, part.1);
    }
}

#[test]
fn a_neutral_rudder_of_two_degrees() {
    let mut log = SimulatedLog::new(0.2);
    log.neutral = from_deg(2.0);
    log.keep(600.0);
    log.hold(log.neutral, 60.0);
    let part = log.zig_zag(10.0, 10.0, 6);
    log.keep(600.0);
    let detected = log.detected();
    assert_eq!(detected.len(), 1, "{:?}", log.names());
    assert_part(&detected[0], part, 0.2);
    assert_eq!(detected[0].quality.approach, Some(ApproachState::Steady));
}

#[test]
fn zig_zags_of_two_angles_or_with_a_pause_are_two() {
    for (second_deg, pause) in [(20.0, 300.0), (20.0, 60.0), (20.0, 0.0), (10.0, 150.0), (10.0, 300.0)] {
        let mut log = SimulatedLog::new(0.5);
        log.keep(300.0);
        let first = log.zig_zag(10.0, 10.0, 5);
        if pause > 0.0 {
            log.keep(pause);
        }
        let second = log.zig_zag(second_deg, second_deg, 5);
        log.keep(300.0);
        let detected = log.detected();
        assert_eq!(detected.len(), 2, "{second_deg} after {pause} s: {detected:?}");
        assert_part(&detected[0], first, 0.5);
        assert_part(&detected[1], second, 0.5);
        assert!(detected[1].start_time > detected[0].end_time);
        let names: Vec<String> = detected.iter().map(|manoeuvre| manoeuvre.name()).collect();
        assert_eq!(names, [String::from("zig-zag 10/10"), format!("zig-zag {second_deg:.0}/{second_deg:.0}")]);
    }
}

/// Log with every kind of manoeuvre: straight, zig-zag, turn with pull-out, spiral.
fn all_kinds(step: f64) -> SimulatedLog {
    let mut log = SimulatedLog::new(step);
    log.keep(600.0);
    log.zig_zag(20.0, 20.0, 5);
    log.keep(400.0);
    log.hold(from_deg(35.0), 200.0);
    log.hold(0.0, 150.0);
    log.keep(400.0);
    log.zig_zag(10.0, 10.0, 5);
    log.keep(400.0);
    for step in (-3..=3).rev().chain(-2..=3) {
        log.hold(from_deg(5.0 * f64::from(step)), 120.0);
    }
    log.keep(600.0);
    log.hold(from_deg(-20.0), 150.0);
    log.keep(300.0);
    log
}

#[test]
fn all_kinds_are_told_apart() {
    let log = all_kinds(0.5);
    let expected = [
        "straight",
        "zig-zag 20/20",
        "straight",
        "turning circle 35 to starboard",
        "pull-out",
        "straight",
        "zig-zag 10/10",
        "straight",
        "spiral",
        "straight",
        "turning circle 20 to port",
        "straight",
    ];
    let mut list = detect_manoeuvres(&log.signals());
    assert!(
        list.windows(2)
            .all(|pair| pair[0].end_time < pair[1].start_time && pair[0].start_time <= pair[0].first_execute_time)
    );
    // A course that is reached slowly may count as two pieces.
    list.dedup_by(|piece, before| piece.manoeuvre.is_none() && before.manoeuvre.is_none());
    let names: Vec<String> = list.iter().map(|manoeuvre| manoeuvre.name()).collect();
    assert_eq!(names, expected);
    let rudder_deg =
        |place: usize| list[place].manoeuvre.as_ref().map(|manoeuvre| to_deg(manoeuvre.max_rudder()).round());
    assert_eq!((rudder_deg(8), list[8].execute_count, rudder_deg(4)), (Some(15.0), 13, Some(35.0)));
}

/// Hours with the rudder at rest, compared with which every hold of a manoeuvre is short.
#[test]
fn a_rudder_that_rests_for_hours_hides_no_manoeuvre() {
    for hours in [0.1, 0.5, 2.0, 12.0] {
        for after in [0.1, hours] {
            let mut log = SimulatedLog::new(1.0);
            log.hold(0.0, 3600.0 * hours);
            log.zig_zag(10.0, 10.0, 6);
            log.hold(0.0, 3600.0 * after);
            log.hold(from_deg(35.0), 200.0);
            log.hold(0.0, 3600.0 * after);
            log.zig_zag(20.0, 20.0, 5);
            log.hold(0.0, 3600.0 * hours);
            let expected = ["zig-zag 10/10", "turning circle 35 to starboard", "pull-out", "zig-zag 20/20"];
            for noise_deg in [0.0, 0.1] {
                // Readings of a tenth of a degree.
                for rudder in &mut log.rudder {
                    *rudder = from_deg((10.0 * (to_deg(*rudder) + noise_deg * log.chance.draw())).round() / 10.0);
                }
                let mut names = log.names();
                names.retain(|name| name != "straight");
                assert_eq!(names, expected, "{hours} h before, {after} h between, {noise_deg} deg of noise");
            }
        }
    }
}

/// Parts, without the values whose sign changes.
fn parts(list: &[DetectedManoeuvre]) -> Vec<(f64, f64, f64, usize)> {
    list.iter().map(|part| (part.start_time, part.end_time, part.first_execute_time, part.execute_count)).collect()
}

#[test]
fn mirrored_logs_have_the_same_parts() {
    let mut log = all_kinds(0.5);
    let list = detect_manoeuvres(&log.signals());
    log.rudder.iter_mut().chain(&mut log.heading).for_each(|x| *x = -*x);
    let mirrored = detect_manoeuvres(&log.signals());
    assert_eq!(parts(&list), parts(&mirrored));
    assert_eq!(mirrored[3].name(), "turning circle 35 to port");
}

#[test]
fn the_unit_of_time_does_not_matter() {
    let mut log = all_kinds(0.5);
    let list = detect_manoeuvres(&log.signals());
    log.time.iter_mut().for_each(|t| *t *= 10.0);
    let slow = detect_manoeuvres(&log.signals());
    assert_eq!(list.len(), slow.len());
    for (a, b) in parts(&list).iter().zip(parts(&slow)) {
        for (a, b) in [(a.0, b.0), (a.1, b.1), (a.2, b.2)] {
            assert!((10.0 * a - b).abs() < 1e-6 * b.max(1.0), "{a} and {b}");
        }
    }
}

/// Log of a day at 10 Hz, with and without noise. The time of the search is printed; it should be about 0.5 s.
#[test]
fn a_day_at_ten_hertz() {
    let mut log = SimulatedLog::new(0.1);
    while log.time.len() < 864_000 {
        log.keep(1800.0);
        log.zig_zag(10.0, 10.0, 6);
        log.keep(1800.0);
        log.zig_zag(20.0, 20.0, 6);
        log.keep(1800.0);
        log.hold(from_deg(35.0), 600.0);
        log.keep(1800.0);
    }
    for noise_deg in [0.0, 0.3] {
        (0..log.rudder.len()).for_each(|row| log.rudder[row] += from_deg(noise_deg) * log.chance.draw());
        let start = std::time::Instant::now();
        let detected = log.detected();
        println!("{} rows in {:.3} s", log.time.len(), start.elapsed().as_secs_f64());
        let executes: Vec<usize> = detected.iter().map(|manoeuvre| manoeuvre.execute_count).collect();
        // In noise one of very many holds may be split into two.
        let expected = [6, 6, 1].repeat(11);
        let others = executes.iter().zip(&expected).filter(|(executes, expected)| executes != expected).count();
        let allowed = usize::from(noise_deg > 0.0);
        assert!(executes.len() == expected.len() && others <= allowed, "{noise_deg} deg of noise: {executes:?}");
    }
}
