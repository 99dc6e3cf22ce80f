use super::points::SignalPoint;
use super::*;
use crate::dynamics::MeasuredChannels;
use crate::effects::effect::Parameter;
use crate::effects::list::{LIST, ListedEffect};

pub(super) fn manoeuvres() -> RecordScales {
    RecordScales {
        ship_length_time: 20.0,
        max_rudder: 0.35,
        duration: 600.0,
        row_interval: 1.0,
        approach_speed: Some(7.0),
        approach_speed_for_sway: Some(7.0),
        mean_square_wind_speed: None,
        rms_propeller_rate: None,
        time_span: [0.0, 600.0],
    }
}

/// Formulas of the list at typical constants: scaling to other units, and the mirror image.
#[test]
fn what_the_list_says_of_constants_is_what_their_formula_does() {
    let rows = LIST.iter().filter_map(|effect| if let ListedEffect::Row(row) = effect { Some(row) } else { None });
    for formula in rows.map(Formula::listed) {
        let name = format!("{} ({})", formula.id(), formula.form());
        let parameters = formula.parameters();
        let keys: Vec<&str> = parameters.iter().map(|p| p.key).collect();
        assert_eq!(formula.program.constants, keys, "{name}");
        assert!(!formula.acts_on.transforms_rudder || formula.program.signals == [FormulaSignal::Rudder], "{name}");
        let (second, metre): (f64, f64) = (2.0, 3.0);
        for point in SignalPoint::all(&SignalScales::ones()) {
            let value = |point: SignalPoint, factor: &dyn Fn(&Parameter) -> f64| {
                let constants: Vec<f64> = parameters.iter().map(|p| p.typical * factor(p)).collect();
                formula.value_at(&constants, &point)
            };
            let is_near = |x: f64, y: f64| (x - y).abs() <= 1e-12 * x.abs();
            let plain = value(point, &|_| 1.0);
            let mirrored = value(point.mirrored(), &|p| if p.is_odd { -1.0 } else { 1.0 });
            assert!(is_near(plain, -mirrored), "{name} of the other side: {plain} {mirrored}");
            let in_units = value(SignalPoint { second, metre, ..point }, &|p| {
                let [seconds, metres] = p.dimension();
                second.powi(seconds) * metre.powi(metres)
            });
            let of_units = if formula.acts_on.transforms_rudder { 1.0 } else { second * second };
            assert!(is_near(plain, in_units * of_units), "{name} in other units: {plain} {in_units}");
        }
    }
}

#[test]
fn sizes_and_shapes_are_told_apart_with_their_symmetry() {
    let bank = Formula::parse("bank = c * tanh(k * psi)").expect("a formula");
    assert_eq!(bank.is_size, [true, false]);
    assert!(bank.parameters().iter().all(|p| !p.is_odd) && bank.is_heading_dependent());
    let even = Formula::parse("drift = c * abs(r) + d * v").expect("a formula");
    assert_eq!(even.parameters().iter().map(|p| p.is_odd).collect::<Vec<_>>(), [true, false]);
    for (line, sides) in [
        ("bank = c * tanh(k * psi)", MirrorSymmetry::Odd),
        ("trend = c * t", MirrorSymmetry::Even),
        ("drift = c * abs(r) + d * abs(v)", MirrorSymmetry::Even),
        ("drift = c * abs(r) + d * v", MirrorSymmetry::Neither),
        ("one_sided = c * max(r, 0)", MirrorSymmetry::Neither),
        ("bank = c * y", MirrorSymmetry::Odd),
        ("banks = c * y + d * y^3", MirrorSymmetry::Odd),
        ("bank = c * abs(y)", MirrorSymmetry::Even),
        ("bank = c * y + d * y^2", MirrorSymmetry::Neither),
    ] {
        assert_eq!(Formula::parse(line).expect("a formula").mirror_symmetry(), sides, "{line}");
    }
    assert!(Formula::parse("trend = c * t").expect("a formula").is_time_dependent());
    let bank = Formula::parse("bank = c * y").expect("a formula");
    assert!(
        !bank.is_time_dependent()
            && !bank.is_heading_dependent()
            && bank.needs().is_none()
            && bank.uses(RegressorChannel::Speed)
    );
    for (line, units) in [
        ("cross = c * r * abs(v)", vec!["s²/m"]),
        ("bank = c * tanh(k * psi)", vec!["1", "1"]),
        ("fast = c * tanh(k * r)", vec!["1", "s"]),
        ("two = a * r^3 + b * v", vec!["s³", "s/m"]),
        ("prime = c * rp * vp", vec!["1"]),
        ("damping = c * r^3 / K_over_T", vec!["s"]),
        ("slow = c * q * v", vec!["s/m"]),
        ("trend = c * (t - start)", vec!["1/s"]),
        ("bank = c * y", vec!["1/m"]),
        ("bank = c * tanh(k * y)", vec!["1", "1/m"]),
        ("fading = c * delta * U^1.6", vec![Parameter::NO_UNIT]),
    ] {
        let formula = Formula::parse(line).expect("a formula");
        assert_eq!(formula.parameters().iter().map(|p| p.unit).collect::<Vec<_>>(), units, "{line}");
    }
}

#[test]
fn priors_follow_from_the_records_or_from_what_is_said() {
    let proposal = |line: &str| Formula::parse(line).expect("a formula").candidate(&manoeuvres());
    let priors = proposal("cross = c * r * abs(v)").expect("speed and sway are there").priors;
    // A moment of 0.07 rad at r = 0.015 rad/s and v 1 m/s.
    assert!((5.0..50.0).contains(&priors[0].sd) && priors[0].mean == 0.0 && !priors[0].is_shape, "{priors:?}");
    let bank = proposal("bank = c * tanh(k * psi)").expect("no channel is needed").priors;
    // The heading reaches 0.35 rad, in the nonlinear range of tanh.
    assert!((1.0..20.0).contains(&bank[1].mean) && bank[1].is_shape, "{bank:?}");
    // About a length to either side, of 140 m.
    let way = proposal("bank = c * y").expect("no channel is needed").priors;
    assert!((2.5e-4..1e-3).contains(&way[0].sd), "{way:?}");
    let declared =
        proposal("bank = c * tanh(k * psi); k about 5; c about 0.02; k from 1 to 20").expect("priors").priors;
    assert_eq!(
        [declared[0].sd, declared[1].mean, declared[1].sd, declared[1].lowest, declared[1].highest],
        [0.02, 5.0, 2.5, 1.0, 20.0]
    );
    assert!(proposal("wind = c * wind_speed^2 * sin(wind_angle)").is_none(), "no record has wind");
}

#[test]
fn what_is_no_effect_is_refused_where_it_stands() {
    for long in ["x".repeat(9000), format!("x = c{}", " * r".repeat(3000)), format!("x = c * r; {}", "c".repeat(9000))]
    {
        let message = Formula::parse(&long).expect_err("too long").to_string();
        assert!(message.len() < 2000, "{} bytes", message.len());
    }
    assert!(
        crate::effects::parse_formula("second_order = c * r").is_err_and(|error| error.problem.contains("on the list"))
    );
    for (line, at, message) in [
        ("bank", 4, "expected `name = formula`"),
        ("bank = c * dleta", 11, "did you mean `delta`"),
        ("bank = c * Y", 11, "did you mean `y`"),
        ("bank = r", 7, "no constant"),
        ("bank = c + r", 7, "removes the effect"),
        ("bank = tanh(c * r) + 1", 7, "removes the effect"),
        ("b nk = c * r", 7, "cannot be the name"),
        ("bank = c * r; k about 5", 13, "expected one of the constants c"),
        ("bank = c * r; c near 5", 13, "expected `c about 5`"),
    ] {
        let error = Formula::parse(line).expect_err(line);
        assert!(error.position == at && error.problem.contains(message), "{line}: {error:?}");
    }
}

/// Record constants of a formula: only the constants required by its signals.
#[test]
fn a_formula_is_had_again_from_what_is_written_of_it() {
    for (line, constants) in [
        ("bank = c * tanh(k * psi); k about 5", vec![]),
        ("prime = c * rp * q", vec![6.0, 150.0]),
        ("trend = c * rp * (t - start)", vec![-20.0, 150.0]),
        ("bank = c * y", vec![7.0, 0.0]),
    ] {
        let formula = Formula::parse(line).expect("a formula");
        let again = crate::effects::find_effect(formula.id(), formula.form(), &constants).expect("it is known");
        let read_back: Vec<f64> = again.constants().into_iter().map(|(constant, _)| constant).collect();
        assert_eq!((again.id(), again.form(), read_back), (formula.id(), formula.form(), constants));
    }
    for (form, constants) in [("c * rp", vec![]), ("c * rp", vec![-1.0]), ("c * r", vec![1.0]), ("c * dleta", vec![])] {
        assert!(crate::effects::find_effect("own", form, &constants).is_none(), "{form}");
    }
    assert!(crate::effects::find_effect("moment_drift", "c * r", &[]).is_none(), "a name of the list");
}

#[test]
fn the_formula_of_a_user_is_a_moment_as_an_angle_of_the_rudder() {
    let measured = MeasuredChannels { speed: Some(6.0), sway: Some(-0.5), ..MeasuredChannels::default() };
    let now = OperatingPoint {
        t: 10.0,
        heading: 0.3,
        yaw_rate: 0.02,
        rudder: 0.2,
        inverse_T: 0.05,
        K_over_T: 0.004,
        measured: &measured,
    };
    let acceleration = |line: &str, now: &OperatingPoint| {
        Formula::parse(line).expect("a formula").with_length(150.0).yaw_acceleration(&[-3.0], &[], now)
    };
    for (line, moment) in [
        ("cross = c * r * abs(v)", -3.0 * 0.02 * 0.5),
        ("sum = c * r + c * v", -3.0 * (0.02 - 0.5)),
        ("prime = c * rp * vp", -3.0 * (0.02 * 150.0 / 6.0) * (-0.5 / 6.0)),
        ("direct = c * r / K_over_T", -3.0 * 0.02 / 0.004),
    ] {
        assert!((acceleration(line, &now) / (0.004 * moment) - 1.0).abs() < 1e-14, "{line}");
    }
    let measured = MeasuredChannels::default();
    assert_eq!(
        acceleration("cross = c * r * abs(v)", &OperatingPoint { measured: &measured, ..now }),
        0.0,
        "no sway, no moment"
    );
    assert_eq!(acceleration("ratio = c * r * q", &OperatingPoint { measured: &measured, ..now }), 0.004 * -3.0 * 0.02);
}
