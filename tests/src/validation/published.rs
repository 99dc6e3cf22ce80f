//! Numbers in print that the program computes: limits of the IMO criteria, and hull coefficients that follow from the
//! particulars of a ship.

use ship::Particulars;
use ship::ships::kvlcc2;
use ship::vessel::prior::{HullParticulars, hull_prior};
use trial::imo;

use super::{Check, Section, Tolerance};

/// Tolerance, in standard deviations of the prior.
const DEVIATIONS: f64 = 2.0;

/// KVLCC2 at full scale. Source: Yasukawa and Yoshimura (2015).
const KVLCC2: HullParticulars = HullParticulars {
    length: 320.0,
    speed: 7.97,
    beam: Some(58.0),
    draught: Some(20.8),
    block_coefficient: Some(0.81),
    rudder_area: Some(112.5),
    rudder_height: Some(15.8),
    propeller_diameter: Some(9.86),
    propeller_rate: Some(1.778),
    displacement: Some(1025.0 * 312_600.0),
    x_g: Some(11.2),
};

/// Number of printed decimals of the coefficients of Yasukawa and Yoshimura (2015).
const DECIMALS: usize = 3;

/// Checks of the limits of MSC.137(76).
pub fn limits() -> Section {
    let at = |seconds: f64| Particulars { length: seconds, speed: 1.0 };
    let mut checks = Vec::new();
    let mut push = |what: String, limit: f64, ours: f64, unit| {
        let check = Check::new(format!("imo/{what}"), what, (limit, 2), ours, Tolerance::Absolute(1e-9), unit);
        checks.push(check.from("IMO MSC.137(76)"));
    };
    // Both are constant below 10 s and from 30 s on, and straight lines of L/V between.
    for (seconds, first, second) in [(9.9, 10.0, 25.0), (10.0, 10.0, 25.0), (20.0, 15.0, 32.5), (30.0, 20.0, 40.0)] {
        let (first_ours, second_ours) =
            (imo::first_overshoot_10_10_limit_deg(at(seconds)), imo::second_overshoot_10_10_limit_deg(at(seconds)));
        push(format!("limit of the first overshoot of a 10/10 at L/V = {seconds} s"), first, first_ours, "deg");
        push(format!("limit of the second overshoot of a 10/10 at L/V = {seconds} s"), second, second_ours, "deg");
    }
    push("limit of the first overshoot of a 20/20".into(), 25.0, imo::MAX_FIRST_OVERSHOOT_20_20_DEG, "deg");
    push("limit of the initial turning".into(), 2.5, imo::MAX_INITIAL_TURNING_LENGTHS, "L");
    push("limit of the advance".into(), 4.5, imo::MAX_ADVANCE_LENGTHS, "L");
    push("limit of the tactical diameter".into(), 5.0, imo::MAX_TACTICAL_DIAMETER_LENGTHS, "L");
    Section {
        title: "Limits of the IMO criteria",
        method: "Limits as `study fit` and `study predict` use them, at the ends and in the middle of the range of L/V.",
        checks,
    }
}

/// Checks of the priors of a hull: priors of KVLCC2 from its particulars alone against its published coefficients.
pub fn hull_coefficients() -> Section {
    let prior = hull_prior(&KVLCC2).expect("KVLCC2 is a ship");
    let mut published = kvlcc2::FULL_SCALE;
    let mut checks = Vec::new();
    // Values taken from KVLCC2 itself would agree by construction.
    for coefficient in
        prior.coefficient_priors.iter().filter(|coefficient| !coefficient.formula.source.contains("KVLCC2"))
    {
        let Some(&mut value) = published.coefficient_mut(coefficient.formula.key) else { continue };
        let what = format!("KVLCC2 from her particulars: {}", coefficient.formula.symbol);
        let tolerance = Tolerance::Absolute(DEVIATIONS * coefficient.sd);
        let id = format!("priors/kvlcc2/{}", coefficient.formula.key);
        let check = Check::new(id, what, (value, DECIMALS), coefficient.mean, tolerance, "");
        checks.push(check.from("Yasukawa and Yoshimura (2015)"));
    }
    Section {
        title: "Hull coefficients from the particulars of a ship",
        method: "Means of `study list priors` (prime system ½ρLdU²) for the particulars of KVLCC2, against the coefficients that were \
            measured in a tank. Tolerance two standard deviations of the prior. Values typical of several hulls, KVLCC2 among \
            them, are left out: they would agree by construction.",
        checks,
    }
}
