use super::*;
use crate::dynamics::Measured;
use crate::effects::NonlinearDamping;
use crate::number::Tangent;

fn about() -> Manoeuvres {
    Manoeuvres {
        time: 20.0,
        rudder: 0.35,
        duration: 600.0,
        spacing: 1.0,
        speed: Some(7.0),
        sway: Some(7.0),
        wind_square: None,
        propeller: None,
        span: [0.0, 600.0],
    }
}

/// Yaw acceleration over b = K/T of a formula, and of an effect.
fn acceleration<R: Real>(effect: &dyn Acts<R>, p: &[R], yaw_rate: R) -> R {
    let measured = Measured { speed: Some(6.0), sway: Some(-0.5), ..Measured::default() };
    let now = Now {
        t: 10.0,
        heading: R::from(0.3),
        yaw_rate,
        rudder: R::from(0.2),
        inverse_time: R::from(0.05),
        gain: R::from(0.004),
        measured: &measured,
    };
    effect.yaw_acceleration(p, &[], &now)
}

#[test]
fn a_formula_does_what_an_effect_of_the_same_equation_does() {
    let formula = Formula::read("damping = c * r * abs(r)").expect("a formula");
    let (p, r) = (Tangent::variable(-3.0, 0, 1.0), Tangent::variable(0.02, 1, 1.0));
    let own = acceleration(formula.as_ref(), &[p], r);
    let scaled = p * -0.004;
    let known = acceleration(&NonlinearDamping::Quadratic, &[scaled], r);
    assert!((own.value / known.value - 1.0).abs() < 1e-14, "{own:?} {known:?}");
    for (own, known) in own.by.iter().zip(known.by) {
        assert!((own - known).abs() <= 1e-14 * known.abs(), "{own} {known}");
    }
}

#[test]
fn sizes_and_shapes_are_told_apart_with_their_symmetry() {
    let bank = Formula::read("bank = c * tanh(k * psi)").expect("a formula");
    assert_eq!(bank.is_size, [true, false]);
    assert!(bank.parameters().iter().all(|own| !own.odd) && bank.sees_heading());
    let even = Formula::read("drift = c * abs(r) + d * v").expect("a formula");
    assert_eq!(even.parameters().iter().map(|own| own.odd).collect::<Vec<_>>(), [true, false]);
    for (line, sides) in [
        ("bank = c * tanh(k * psi)", Sides::Alike),
        ("trend = c * t", Sides::Same),
        ("drift = c * abs(r) + d * abs(v)", Sides::Same),
        ("drift = c * abs(r) + d * v", Sides::Differ),
        ("one_sided = c * max(r, 0)", Sides::Differ),
    ] {
        assert_eq!(Formula::read(line).expect("a formula").sides(), sides, "{line}");
    }
    assert!(Formula::read("trend = c * t").expect("a formula").is_of_time());
    for (line, units) in [
        ("cross = c * r * abs(v)", vec!["s²/m"]),
        ("bank = c * tanh(k * psi)", vec!["1", "1"]),
        ("fast = c * tanh(k * r)", vec!["1", "s"]),
        ("two = a * r^3 + b * v", vec!["s³", "s/m"]),
        ("prime = c * rp * vp", vec!["1"]),
        ("fading = c * delta * U^1.6", vec![Parameter::NO_UNIT]),
    ] {
        let formula = Formula::read(line).expect("a formula");
        assert_eq!(formula.parameters().iter().map(|own| own.unit).collect::<Vec<_>>(), units, "{line}");
    }
}

#[test]
fn priors_follow_from_the_records_or_from_what_is_said() {
    let proposal = |line: &str| Formula::read(line).expect("a formula").proposal(&about());
    let priors = proposal("cross = c * r * abs(v)").expect("speed and sway are there").priors;
    // A moment of 0.07 rad where r is 0.015 rad/s and v 1 m/s.
    assert!((5.0..50.0).contains(&priors[0].sd) && priors[0].mean == 0.0 && !priors[0].is_shape, "{priors:?}");
    let bank = proposal("bank = c * tanh(k * psi)").expect("no channel is needed").priors;
    // The heading goes to 0.35 rad, where tanh bends.
    assert!((1.0..20.0).contains(&bank[1].mean) && bank[1].is_shape, "{bank:?}");
    let said = proposal("bank = c * tanh(k * psi); k about 5; c about 0.02; k from 1 to 20").expect("said").priors;
    assert_eq!([said[0].sd, said[1].mean, said[1].sd, said[1].lowest, said[1].highest], [0.02, 5.0, 2.5, 1.0, 20.0]);
    assert!(proposal("wind = c * wind_speed^2 * sin(wind_angle)").is_none(), "no record has wind");
}

#[test]
fn what_is_no_effect_is_refused_where_it_stands() {
    for long in ["x".repeat(9000), format!("x = c{}", " * r".repeat(3000)), format!("x = c * r; {}", "c".repeat(9000))]
    {
        let message = Formula::read(&long).expect_err("too long").to_string();
        assert!(message.len() < 2000, "{} bytes", message.len());
    }
    assert!(crate::effects::formula("second_order = c * r").is_err_and(|error| error.problem.contains("on the list")));
    for (line, at, said) in [
        ("bank", 4, "expected `name = formula`"),
        ("bank = c * dleta", 11, "did you mean `delta`"),
        ("bank = r", 7, "no constant"),
        ("bank = c + r", 7, "takes the effect away"),
        ("bank = tanh(c * r) + 1", 7, "takes the effect away"),
        ("b nk = c * r", 7, "cannot be the name"),
        ("bank = c * r; k about 5", 13, "expected one of the constants c"),
        ("bank = c * r; c near 5", 13, "expected `c about 5`"),
    ] {
        let error = Formula::read(line).expect_err(line);
        assert!(error.at == at && error.problem.contains(said), "{line}: {error:?}");
    }
}

#[test]
fn a_formula_is_had_again_from_what_is_written_of_it() {
    let formula = Formula::read("bank = c * tanh(k * psi); k about 5").expect("a formula").with_length(150.0);
    let again = crate::effects::named(formula.id(), formula.form(), &formula.constants()).expect("it is known");
    assert_eq!((again.id(), again.form(), again.constants()), (formula.id(), formula.form(), formula.constants()));
}
