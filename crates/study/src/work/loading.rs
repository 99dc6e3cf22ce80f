//! Models converted to another loading of the ship (`--load`): by the formulas of her particulars, and by her departure
//! from these formulas at the trials. Only hulls of the MMG form are converted, since no other form depends on the
//! draught.

use std::path::Path;

use campaign::earlier_trials::earlier_hulls;
use campaign::failure::Failure;
use document::identified_hull::IdentifiedHull;
use document::{IdentifiedShip, WarningCode, WarningSource, Warnings};
use identify::hull::HullFormPrior;
use predict::drawable_hull;
use ship::ShortNumber;
use ship::vessel::prior::{HullParticulars, PARTICULARS, Particular, ParticularsError, hull_prior};
use trial::{Sidecar, file};

/// Hull form that is made from particulars.
const FORM: &str = "mmg";

/// Message if the records rule out a hull of this form.
pub const FORM_RULED_OUT: &str = "a hull of the form mmg does not fit the records: its heading error is more than three \
    times that of another hull, or its \
                                replay fails";

/// `true` if records rule out a hull of this form: hulls were fitted, but none of this form.
pub fn is_form_ruled_out(hulls: &[IdentifiedHull]) -> bool {
    !hulls.is_empty() && hulls.iter().all(|hull| hull.form != FORM)
}

/// Required particulars of the ship at her trials; the displacement can replace the last.
const NEEDED: [&str; 3] = ["beam-m", "draught-m", "block-coefficient"];

/// Loading described in a file.
#[derive(Debug)]
pub struct LoadingCondition {
    /// Name of the file in messages.
    pub file: String,
    /// Particulars in the file; length and speed are 0 if it gives none.
    given: HullParticulars,
}

impl LoadingCondition {
    /// Particulars in `[ship]` and `[form]` of a file, read as in a sidecar.
    ///
    /// Fails as a sidecar does, or if the file has no draught.
    pub fn from_file(path: &Path) -> Result<Self, Failure> {
        let given = Sidecar::load(path).map_err(Failure::input)?.conditions.hull;
        let loading = Self { file: file::display_path(path).display().to_string(), given };
        match given.draught {
            Some(_) => Ok(loading),
            None => Err(loading.refused("it has no draught-m; give the mean draught of the loading under [form]")),
        }
    }

    /// Mean draught, m.
    pub fn draught(&self) -> f64 {
        self.given.draught.unwrap_or_default()
    }

    fn refused(&self, problem: impl std::fmt::Display) -> Failure {
        Failure::in_file(&self.file, problem)
    }

    /// Ship at this loading, with one hull, and her draught at the trials, m; `shown` is the name of her model in
    /// messages.
    ///
    /// Her hull is the one expected at this loading, given the trials. Her steering gear is unchanged, yaw rates are
    /// proportional to the approach speed, and the yaw response, which does not depend on draught, is not used.
    ///
    /// Fails as [`with_convertible_hull`] does, if the loading is of another ship, or if it is that of the trials.
    pub fn convert_ship(
        &self,
        shown: &str,
        ship: &IdentifiedShip,
        warnings: &mut Warnings,
    ) -> Result<(IdentifiedShip, f64), Failure> {
        let mut ship = with_convertible_hull(shown, ship)?;
        let earlier = earlier_hulls(&ship).map_err(|error| Failure::in_file(shown, error))?;
        let at_trials = earlier[0].particulars;
        let to = self.particulars(shown, &at_trials)?;
        self.warn_of_kept(&to, warnings);
        let expected =
            HullFormPrior::candidates(Some(&to), &earlier).into_iter().find(|hull| hull.form.as_str() == FORM);
        let at_loading = |expected: HullFormPrior| {
            let hull = ship.hulls[0].at_loading(&to, &expected.coefficients, expected.covariance_and_gain()?);
            Some(IdentifiedHull { propeller_per_s: self.given.propeller_rate, ..hull })
        };
        let hull = expected.and_then(at_loading).filter(|hull| drawable_hull::check(hull).is_ok());
        let none =
            || self.refused(format!("the hull of {shown} gives no valid ship at this loading; check the numbers"));
        ship.hulls = vec![hull.ok_or_else(none)?];
        let faster = to.speed / at_trials.speed;
        ship.speed_m_s = ship.speed_m_s.map(|speed| speed * faster);
        ship.approach_yaw_rate_rad_s *= faster;
        ship.validity_range.yaw_rate_rad_s *= faster;
        Ok((ship, at_trials.draught.unwrap_or_default()))
    }

    /// Warns of particulars kept from the trials although they change with the loading.
    fn warn_of_kept(&self, to: &HullParticulars, warnings: &mut Warnings) {
        let HullParticulars { block_coefficient, displacement, x_g, propeller_rate, .. } = self.given;
        let kept = [
            ("block-coefficient", to.block_coefficient.filter(|_| block_coefficient.or(displacement).is_none())),
            ("x-g-m", to.x_g.filter(|_| x_g.is_none())),
            ("propeller-rps", to.propeller_rate.filter(|_| propeller_rate.is_none())),
        ];
        for (key, value) in kept.into_iter().filter_map(|(key, value)| Some((key, value?))) {
            let advice = "it changes with the loading, so give it where it is known";
            let value = ShortNumber::rounded(value, 4);
            let text = format!("{key} = {value} is taken, as at the trials; {advice}");
            warnings.push(WarningCode::KeptParticulars, WarningSource::File(self.file.clone()), text);
        }
    }

    /// Particulars of the ship at this loading, from those `at_trials`. Values that the file does not give are kept,
    /// except the mass; revolutions are proportional to the speed. Unknown particulars of rudder and propeller are
    /// assumed once for both loadings.
    ///
    /// Fails if this is not another loading of the same ship, or if a particular is out of range.
    fn particulars(&self, shown: &str, at_trials: &HullParticulars) -> Result<HullParticulars, Failure> {
        let mut to = completed(at_trials).map_err(|error| Failure::in_file(shown, error))?;
        to.displacement = None;
        to.block_coefficient = to.block_coefficient.filter(|_| self.given.displacement.is_none());
        for particular in &PARTICULARS {
            if let Some(value) = particular.get(&self.given) {
                particular.set(&mut to, value);
            }
        }
        if self.given.propeller_rate.is_none() {
            to.propeller_rate = at_trials.propeller_rate.map(|rate| rate * to.speed / at_trials.speed);
        }
        let differing = to.differing_keys(at_trials);
        let cure = match () {
            () if !to.has_equal_length(at_trials) => "length-m differs; give it at the scale of that model",
            () if differing.contains(&"beam-m") => "beam-m differs; give a loading of the same ship",
            () if differing.is_empty() => "all is within 2 % of it; leave --load out, or give another draught-m",
            () => return completed(&to).map_err(|error| self.out_of_the_water(&to, error)),
        };
        Err(self.refused(format!("this is not another loading of the ship of {shown}: {cure}")))
    }

    /// Failure for an invalid ship at this loading; at a light draught the rudder or the propeller is out of the water.
    fn out_of_the_water(&self, to: &HullParticulars, error: ParticularsError) -> Failure {
        let parts = [("rudder-height-m", "rudder", "height"), ("propeller-diameter-m", "propeller", "diameter")];
        let part = parts.into_iter().find(|(key, ..)| *key == error.key && error.value > error.range[1]);
        let size = Particular::find(error.key).and_then(|particular| particular.get(to));
        let Some(((key, part, measure), size)) = part.zip(size) else { return self.refused(error) };
        let [draught, size, share, most] =
            [self.draught(), size, error.value, error.range[1]].map(|value| ShortNumber::rounded(value, 4));
        self.refused(format!(
            "at draught-m = {draught} the {part} ({key} = {size}) is out of the water too far: its {measure} is {share} \
             draughts, expected at most {most}; give a deeper draught-m, or the {measure} under water as {key} \
             under [ship]"
        ))
    }
}

/// Ship with only the hull that can be converted to another loading; `shown` is the name of her model in messages.
///
/// Fails if there is no such hull, or if its draught, beam or block coefficient is not known.
pub fn with_convertible_hull(shown: &str, ship: &IdentifiedShip) -> Result<IdentifiedShip, Failure> {
    if is_form_ruled_out(&ship.hulls) {
        let cure = "check particulars, rudder and speed of the trial, or fit more records";
        return Err(Failure::in_file(shown, format!("--load needs a hull of the form mmg: {FORM_RULED_OUT}; {cure}")));
    }
    let mut ship = ship.clone();
    ship.hulls.retain(|hull| hull.form == FORM);
    let knows = |key: &str| ship.hulls.iter().all(|hull| hull.particulars.contains_key(key));
    let is_known = |key: &str| knows(key) || key == "block-coefficient" && knows("displacement-t");
    let lacks = match ship.hulls.is_empty() {
        true => format!("hull of the form {FORM}"),
        false => NEEDED.into_iter().filter(|key| !is_known(key)).collect::<Vec<_>>().join(", "),
    };
    if lacks.is_empty() {
        return Ok(ship);
    }
    let cure = "fit records with a speed column again, with length, speed, beam, draught and block coefficient of the \
                trial as options (--draught-m, …) or under [ship] of a sidecar";
    Err(Failure::in_file(shown, format!("it has no {lacks}, so --load cannot take it to another loading; {cure}")))
}

/// Particulars with typical values for missing ones, and the block coefficient from the displacement.
fn completed(given: &HullParticulars) -> Result<HullParticulars, ParticularsError> {
    let mut all = *given;
    for assumed in hull_prior(given)?.assumed_particulars {
        if let Some(particular) = Particular::find(assumed.key) {
            particular.set(&mut all, assumed.value);
        }
    }
    Ok(all)
}

#[cfg(test)]
mod tests {
    use super::*;
    use document::Warning;
    use document::identified_hull::{IdentifiedCoefficient, keyed_particulars};
    use ship::vessel::prime::{HullCoefficient, HullModel, is_frictional, is_trial_specific};

    /// A tanker in ballast.
    fn at_trial() -> HullParticulars {
        let (beam, draught, x_g, propeller_rate) = (Some(58.0), Some(10.5), Some(3.0), Some(1.7));
        let form = HullParticulars { beam, draught, x_g, propeller_rate, ..HullParticulars::default() };
        HullParticulars { length: 320.0, speed: 8.0, block_coefficient: Some(0.77), ..form }
    }

    /// Coefficients by the formulas at some particulars.
    fn formulas(at: &HullParticulars) -> Vec<HullCoefficient> {
        HullModel::mmg(&hull_prior(at).expect("a ship")).coefficients().to_vec()
    }

    /// Hull at a loading, and the warnings. At the trial the coefficients are half a standard deviation of the prior
    /// above the formulas; their standard deviation is a hundredth of that of the prior.
    fn taken(given: HullParticulars) -> (IdentifiedHull, Vec<Warning>) {
        let terms = formulas(&at_trial());
        let entry = |i: usize, j: usize| if i == j { (0.01 * terms[i].sd).powi(2) } else { 0.0 };
        let coefficient = |term: &HullCoefficient| {
            let (key, symbol, value) = (term.key.into(), term.symbol.into(), term.mean + 0.5 * term.sd);
            IdentifiedCoefficient { key, symbol, value, expected: term.mean, expected_sd: term.sd }
        };
        let hull = IdentifiedHull {
            form: FORM.into(),
            length_m: 320.0,
            speed_m_s: 8.0,
            particulars: keyed_particulars(&at_trial()),
            coefficients: terms.iter().map(coefficient).collect(),
            covariance: (0..terms.len()).map(|i| (0..terms.len()).map(|j| entry(i, j)).collect()).collect(),
            ..IdentifiedHull::default()
        };
        let ship = IdentifiedShip { hulls: vec![IdentifiedHull::default(), hull], ..IdentifiedShip::default() };
        let (loading, mut warnings) = (LoadingCondition { file: "full.toml".into(), given }, Warnings::default());
        let (mut ship, _) = loading.convert_ship("fit.json", &ship, &mut warnings).expect("another loading");
        assert_eq!(ship.hulls.len(), 1);
        (ship.hulls.remove(0), warnings.ranked())
    }

    /// A coefficient is the value of the formula at the loading plus the departure of the ship at the trial, with three
    /// times its standard deviation. A frictional coefficient is that of the formula alone, a trial-specific
    /// coefficient is unchanged. Unknown particulars of rudder and propeller are equal in both loadings.
    #[test]
    fn the_hull_is_that_of_the_formulas_with_her_departure() {
        let at_load = |ship: HullParticulars| {
            let (draught, block_coefficient) = (Some(20.8), Some(0.81));
            HullParticulars { speed: 7.5, draught, block_coefficient, x_g: Some(11.0), ..ship }
        };
        let (hull, warnings) = taken(at_load(HullParticulars::default()));
        let to = hull.particulars().expect("known");
        let same_ship =
            HullParticulars { propeller_rate: Some(1.7 * 7.5 / 8.0), ..completed(&at_trial()).expect("a ship") };
        assert_eq!((to, hull.propeller_per_s, warnings.len()), (at_load(same_ship), None, 1), "{warnings:?}");
        for (place, (formula, before)) in formulas(&to).into_iter().zip(formulas(&at_trial())).enumerate() {
            let (truth, sd) = match formula.key {
                key if is_trial_specific(key) => (0.5 * before.sd, 0.01 * before.sd),
                key if is_frictional(key) => (formula.mean, formula.sd),
                _ => (formula.mean + 0.5 * before.sd, 0.03 * before.sd),
            };
            let (value, sd_found) = (hull.coefficients[place].value, hull.covariance[place][place].sqrt());
            assert!((value - truth).abs() < 2e-3 * before.sd, "{}: {value} {truth}", formula.key);
            assert!((sd_found / sd - 1.0).abs() < 0.01, "{}: {sd_found} {sd}", formula.key);
        }
    }

    /// Particulars that are not given are kept, with a warning; the displacement determines the block coefficient.
    #[test]
    fn what_a_loading_does_not_say_stays() {
        let bare = HullParticulars { draught: Some(20.8), ..HullParticulars::default() };
        let (hull, warnings) = taken(bare);
        let to = hull.particulars().expect("known");
        assert_eq!(
            (to.block_coefficient, to.x_g, to.speed, to.propeller_rate),
            (Some(0.77), Some(3.0), 8.0, Some(1.7))
        );
        assert!(
            warnings[0].text.contains("block-coefficient = 0.77 is taken")
                && warnings[1].text.contains("x-g-m = 3 is taken")
        );
        let (hull, warnings) = taken(HullParticulars { displacement: Some(3.2e8), ..bare });
        let block_coefficient = hull.particulars().expect("known").block_coefficient.expect("told");
        assert!((block_coefficient - 0.809).abs() < 1e-3 && warnings.len() == 2, "{block_coefficient} {warnings:?}");
    }
}
