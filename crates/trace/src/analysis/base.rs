//! Which base a search begins from: constant K and T, or K and T that follow the measured speed.

use ship::effects::{Effect, SpeedLoss};

use super::elsewhere::worse_on_others;
use crate::candidates::mean_square;
use crate::held_out::HeldOut;
use crate::record::Record;
use crate::search::{Model, Search};
use crate::structure::{SpeedScaling, Structure};

/// Fall of BIC from which on the scaled base is taken: at a speed that hardly changes the two are the same.
const CLEARLY: f64 = 2.0;

/// The base of constant K and T, or that whose K and T follow the speed where all records have it and it explains them
/// better: it has no parameter more. Like an effect it has to be nearer to the records, whatever the noise, must not
/// predict held-out records worse, and can be excluded.
pub(super) fn better_base(search: &Search, constant: &Model, held_out: &[HeldOut]) -> Model {
    let speed = mean_square(&search.problem.records, Record::speed).map(f64::sqrt);
    let scaled = speed.filter(|_| search.wanted.allows(SpeedLoss::Modelled.id())).map(|speed| {
        let structure = Structure { scaling: Some(SpeedScaling::about(speed)), ..constant.structure.clone() };
        search.base(structure, &constant.plain.theta, &constant.plain.initial)
    });
    let is_better = |scaled: &Model| {
        let fits = [(&scaled.judged, &constant.judged), (&scaled.plain, &constant.plain)];
        fits.iter().all(|(scaled, constant)| scaled.bic < constant.bic - CLEARLY)
            && worse_on_others(held_out, constant, scaled).is_none()
    };
    scaled.filter(is_better).unwrap_or_else(|| constant.clone())
}

#[cfg(test)]
mod tests {
    use ship::angle::from_deg;
    use trial::{Channel, Columns, Origin, Trial};

    use super::super::{Analysis, Settings, Verdict, trace};
    use super::*;
    use crate::index::RecordNumber;
    use crate::made_up::{BASE, Plan, record, ship};
    use crate::structure::headings;
    use crate::wanted::Wanted;

    /// A record with a speed that falls from 8 m/s and swings; K and T follow it about 7 m/s if the ship is `scaled`.
    fn slowing(scaled: bool, rudder_deg: f64) -> Trial {
        let plan = Plan { rudder_deg, ..Plan::default() };
        let [noisy, calm] =
            [plan.noise_deg, 0.0].map(|noise_deg| record(&ship(Vec::new()), Plan { noise_deg, ..plan }));
        let time = noisy.time().to_vec();
        let speed: Vec<f64> = time.iter().map(|t| 5.0 + 3.0 * (-t / 60.0).exp() + 0.5 * (0.08 * t).sin()).collect();
        let of = |heading: Vec<f64>| {
            let channels = [
                (Channel::Heading, heading),
                (Channel::Rudder, noisy.rudder().to_vec()),
                (Channel::Speed, speed.clone()),
            ];
            let origin = Origin::Simulated { scenario: "made up".into(), cell: 0, replicate: 0 };
            let columns = Columns { time: time.clone(), channels: channels.into(), unknown: Vec::new() };
            Trial::new("slowing", origin, columns).expect("a valid record")
        };
        let scaling = scaled.then(|| SpeedScaling::about(7.0));
        let response = Structure { scaling, ..Structure::base(1, false) }.response(RecordNumber(0), &BASE);
        let mut heading = noisy.heading().to_vec();
        headings(&response, &Record::whole(&of(heading.clone())), [0.0; 2], |row, psi| {
            heading[row] += psi - calm.heading()[row];
        });
        of(heading)
    }

    fn traced(trial: Trial, held_out: &[Trial], wanted: Wanted) -> Analysis {
        trace(&[trial], held_out, &Settings { wanted, ..Settings::default() }).expect("a base")
    }

    /// A ship whose K and T follow the speed lacks nothing, and its base predicts another manoeuvre.
    #[test]
    fn a_ship_that_follows_its_speed_has_a_base_that_does() {
        let analysis = traced(slowing(true, 10.0), &[slowing(true, 20.0)], Wanted::default());
        let (speed, gain) = analysis.speed_scaling().expect("a scaled base");
        let found: Vec<_> = analysis.effects.iter().map(|effect| (effect.id, effect.form)).collect();
        assert_eq!((found, analysis.verdict), (vec![], Verdict::Clean));
        assert!((5.0..6.5).contains(&speed) && gain > 100.0, "{speed} m/s, {gain}");
        let [k, t] = analysis.indices;
        let bias = analysis.rudder_bias.expect("one bias");
        let truth = [0.1 * speed / 7.0, 16.3 * 7.0 / speed, from_deg(0.5)];
        for (quantity, truth) in [k, t, bias].into_iter().zip(truth) {
            let sd = quantity.sd.expect("an interval");
            assert!((quantity.value - truth).abs() < 4.0 * sd, "{} ± {sd} for {truth}", quantity.value);
        }
        for judged in [&analysis.identification[0], &analysis.validation[0]] {
            let [before, after] = [&judged.before, &judged.after].map(|on| on.errors.heading.to_degrees());
            assert!(before > 0.8 && after < 0.06, "{before} and {after} deg");
        }
    }

    /// Constant K and T stay where they are as good, and where the effect is excluded.
    #[test]
    fn a_speed_that_does_nothing_changes_nothing() {
        let analysis = traced(slowing(false, 10.0), &[], Wanted::default());
        assert!(analysis.speed_scaling().is_none() && analysis.verdict == Verdict::Clean);
        assert!(traced(slowing(true, 10.0), &[], Wanted::among(&[])).speed_scaling().is_none());
    }
}
