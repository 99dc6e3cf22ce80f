//! Declared conditions of a trial for the form of MSC/Circ.1053, appendix 6: particulars of the ship outside the
//! record, conditions of the trial, and the limits of the circular.

use serde::{Deserialize, Serialize};
use ship::Particulars;
use ship::vessel::prior::HullParticulars;
use thiserror::Error;

use crate::trial_particulars::TrialParticulars;

/// Minimum water depth of a trial, mean draughts. Source: MSC/Circ.1053 (2002), 2.2.1.2.1.
pub const MIN_DEPTH_DRAUGHTS: f64 = 4.0;
/// Maximum wind of a trial, Beaufort number. Source: MSC/Circ.1053 (2002), 2.2.1.2.1.
pub const MAX_BEAUFORT: u8 = 5;
/// Maximum sea state of a trial. Source: MSC/Circ.1053 (2002), 2.2.1.2.1.
pub const MAX_SEA_STATE: u8 = 4;
/// Maximum deviation from the full-load draught, as a share. Source: MSC/Circ.1053 (2002), 2.2.1.2.2.
pub const MAX_DRAUGHT_DEVIATION_SHARE: f64 = 0.05;
/// Maximum interval between readings of a trial, s. Source: MSC/Circ.1053 (2002), 2.2.
pub const MAX_READING_INTERVAL_S: f64 = 20.0;

/// Loading condition at the trial.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Loading {
    /// Summer load line draught, with a tolerance of 5 %.
    Full,
    /// Smaller draught, as in ballast.
    Partial,
}

/// Declared weather of a trial.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, schemars::JsonSchema)]
pub enum DeclaredWeather {
    /// Calm: neither wind nor waves nor any other external moment, as in a towing tank.
    #[serde(rename = "none")]
    Calm,
}

/// Particulars and conditions declared in a sidecar under `[form]`; SI units, `None` if undeclared. In
/// brackets, the kind of value of the sidecar key.
///
/// Source of the entries: MSC/Circ.1053 (2002), appendix 6.
#[derive(Debug, Clone, Default, PartialEq, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct DeclaredConditions {
    /// Administration that receives the form of MSC/Circ.1053; texts have at most 100 characters. (text)
    pub administration: Option<String>,
    /// Container ship, tanker, gas carrier, ro-ro ship, bulk carrier, ... (text)
    pub ship_type: Option<String>,
    /// Length and approach speed of the same sidecar, so that ratios are of one scale.
    #[serde(skip)]
    pub particulars: Option<Particulars>,
    /// Particulars of the hull at the trial, of [ship] and of this table; without [ship] length and speed are zero.
    #[serde(skip)]
    pub hull: HullParticulars,
    /// Weather of the same sidecar.
    #[serde(skip)]
    pub weather: Option<DeclaredWeather>,
    /// Ship, date and draughts of the trial, of the same sidecar.
    #[serde(skip)]
    pub trial: TrialParticulars,
    /// Breadth of the ship; lengths are of the scale of [ship] length-m. (m)
    #[serde(rename = "beam-m")]
    pub beam: Option<f64>,
    /// Mean draught at the trial. (m)
    #[serde(rename = "draught-m")]
    pub draught: Option<f64>,
    /// Mean draught at full load. (m)
    #[serde(rename = "full-load-draught-m")]
    pub full_load_draught: Option<f64>,
    /// Block coefficient at full load. (1)
    pub block_coefficient: Option<f64>,
    /// Full spade, semi-spade, high lift, ... (text)
    pub rudder_type: Option<String>,
    /// Area of all rudders together. (m²)
    #[serde(rename = "rudder-area-m2")]
    pub rudder_area: Option<f64>,
    /// Number of rudders. (number)
    pub rudders: Option<u8>,
    /// Fixed pitch, controllable pitch, with or without nozzle, ... (text)
    pub propeller_type: Option<String>,
    /// Number of propellers. (number)
    pub propellers: Option<u8>,
    /// Diesel, steam turbine, gas turbine, diesel-electric, ... (text)
    pub engine_type: Option<String>,
    /// Trim, positive by the stern, 0 for an even keel. (m)
    #[serde(rename = "trim-m")]
    pub trim: Option<f64>,
    /// Ballast condition in words. (text)
    pub ballast: Option<String>,
    /// Depth of the water at the trial. (m)
    #[serde(rename = "water-depth-m")]
    pub water_depth: Option<f64>,
    /// Wind at the trial, Beaufort number. (0 to 12)
    pub wind_beaufort: Option<u8>,
    /// Sea state at the trial. (0 to 9)
    pub sea_state: Option<u8>,
    /// Loading at the trial; by the two draughts, with a tolerance of 5 %, if absent. (full or partial)
    #[serde(rename = "loading")]
    #[schemars(with = "Option<String>")]
    pub declared_loading: Option<Loading>,
    /// Remark for the form. (text)
    pub remark: Option<String>,
}

/// Deviation of a trial from the conditions of MSC/Circ.1053 (2002), 2.2, or a condition that is not declared.
#[derive(Debug, Clone, PartialEq, Error)]
#[expect(missing_docs, reason = "the message of a variant says what its fields are")]
pub enum ConditionShortcoming {
    /// Undeclared condition.
    #[error("{condition} is not declared; required: {requirement}")]
    Undeclared { condition: &'static str, requirement: &'static str },
    /// Water depth below the minimum.
    #[error("the water is {draughts:.1} mean draughts deep; required: more than {MIN_DEPTH_DRAUGHTS}")]
    Depth { draughts: f64 },
    /// Wind above the maximum.
    #[error("the wind is Beaufort {beaufort}; required: at most {MAX_BEAUFORT}")]
    Wind { beaufort: u8 },
    /// Sea state above the maximum.
    #[error("the sea state is {state}; required: at most {MAX_SEA_STATE}")]
    Sea { state: u8 },
    /// Median time between rows above the maximum interval.
    #[error("readings are {seconds:.0} s apart; required: at most {MAX_READING_INTERVAL_S} s")]
    Interval { seconds: f64 },
    /// Loading other than full; the draught as a share of that at full load, `None` unless both are declared.
    #[error("the ship was not at full load{}", draught.map_or_else(String::new, draught_note))]
    Load { draught: Option<f64> },
    /// Declared full load that contradicts the draughts: the draught as a share of that at full load.
    #[error(
        "the loading is declared as \"full\", but the draught is {:.0} % of that at full load; tolerance: 5 %",
        100.0 * draught
    )]
    Contradiction { draught: f64 },
    /// Trim other than an even keel, m, positive by the stern.
    #[error(
        "the trim is {:.2} m by the {}; required: an even keel", trim.abs(), if *trim > 0.0 { "stern" } else { "bow" }
    )]
    Trim { trim: f64 },
}

/// Second half of the message of a partial load; `share` is the draught over that at full load.
fn draught_note(share: f64) -> String {
    format!(": the draught is {:.0} % of that at full load", 100.0 * share)
}

impl DeclaredConditions {
    /// The same conditions without blanks around texts.
    pub(crate) fn without_blanks(mut self) -> Self {
        let Self {
            administration, ship_type, rudder_type, propeller_type, engine_type, ballast, remark, trial, ..
        } = &mut self;
        let ship_name = &mut trial.ship_name;
        for text in [administration, ship_type, rudder_type, propeller_type, engine_type, ballast, remark, ship_name] {
            *text = text.take().map(|text| text.trim().to_owned());
        }
        self
    }

    /// Merges the hull particulars of `[ship]` with those declared here; undeclared draught and trim follow from the
    /// draughts of `[trial]`. Returns the first key declared in both with different values, `None` without a conflict.
    /// Block coefficients may differ: the value here is that at full load.
    pub(crate) fn join(&mut self, hull: HullParticulars) -> Option<&'static str> {
        let pairs = [
            ("beam-m", &mut self.beam, hull.beam),
            ("draught-m", &mut self.draught, hull.draught),
            ("rudder-area-m2", &mut self.rudder_area, hull.rudder_area),
        ];
        let mut conflict = None;
        *pairs[1].1 = pairs[1].1.or(self.trial.mean_draught().filter(|_| hull.draught.is_none()));
        self.trim = self.trim.or(self.trial.trim());
        for (key, form, ship) in pairs {
            conflict = conflict.or(form.zip(ship).is_some_and(|(form, ship)| form != ship).then_some(key));
            *form = ship.or(*form);
        }
        let (beam, draught, rudder_area) = (self.beam, self.draught, self.rudder_area);
        let is_full = self.loading() != Some(Loading::Partial);
        let block_coefficient = hull.block_coefficient.or(self.block_coefficient.filter(|_| is_full));
        self.block_coefficient = self.block_coefficient.or(block_coefficient.filter(|_| is_full));
        self.hull = HullParticulars { beam, draught, block_coefficient, rudder_area, ..hull };
        conflict
    }

    /// Key of a contradictory declaration with the expected value: an impossible ratio of lengths, or weather in
    /// addition to a declared calm. `None` for consistent declarations.
    pub(crate) fn contradiction(&self) -> Option<(&'static str, &'static str)> {
        let length = self.particulars.map(|particulars| particulars.length);
        let calm = self.weather.map(|_| 1.0);
        let rules = [
            ("wind-beaufort", self.wind_beaufort.map(f64::from), calm, "0 beside weather = \"none\", or nothing"),
            ("sea-state", self.sea_state.map(f64::from), calm, "0 beside weather = \"none\", or nothing"),
            ("beam-m", self.beam, length, "a breadth below the length of [ship]"),
            ("draught-m", self.draught, self.water_depth, "a draught below water-depth-m"),
            ("draught-m", self.draught, self.beam, "a draught below beam-m"),
            ("full-load-draught-m", self.full_load_draught, self.beam, "a draught below beam-m"),
        ];
        if self.draught.is_some_and(|draught| !self.trial.admits_draught(draught)) {
            return Some(("draught-m", "a mean draught between those fore and aft of [trial], or nothing"));
        }
        let broken = rules.into_iter().find(|(_, x, limit, _)| x.zip(*limit).is_some_and(|(x, limit)| x >= limit));
        broken.map(|(key, .., expected)| (key, expected))
    }

    /// Draught at the trial as a share of that at full load; `None` unless both are declared.
    fn draught_share(&self) -> Option<f64> {
        Some(self.draught? / self.full_load_draught?)
    }

    /// Loading condition: as declared, else from the draughts with a tolerance of 5 %; `None` if these are undeclared.
    pub fn loading(&self) -> Option<Loading> {
        let is_full = |share: f64| (share - 1.0).abs() <= MAX_DRAUGHT_DEVIATION_SHARE;
        let by_draught = |share: f64| if is_full(share) { Loading::Full } else { Loading::Partial };
        self.declared_loading.or_else(|| self.draught_share().map(by_draught))
    }

    /// Mean draught at full load, m: as declared, or the draught of a trial that is declared at full load; else `None`.
    pub fn draught_at_full_load(&self) -> Option<f64> {
        let at_trial = || self.draught.filter(|_| self.declared_loading == Some(Loading::Full));
        self.full_load_draught.or_else(at_trial)
    }

    /// Depth of the water in mean draughts of the trial; `None` unless both are declared.
    pub fn depth_in_draughts(&self) -> Option<f64> {
        Some(self.water_depth? / self.draught?)
    }

    /// Deviations from the conditions of MSC/Circ.1053 (2002), 2.2, and conditions that are not declared. Current and
    /// speed are not checked.
    pub fn shortcomings(&self) -> Vec<ConditionShortcoming> {
        let undeclared = |condition, requirement| Some(ConditionShortcoming::Undeclared { condition, requirement });
        let depth = match self.depth_in_draughts() {
            None => undeclared("the water depth in draughts", "more than 4 mean draughts"),
            Some(draughts) => (draughts <= MIN_DEPTH_DRAUGHTS).then_some(ConditionShortcoming::Depth { draughts }),
        };
        let calm = self.weather.map(|_| 0);
        let wind = match self.wind_beaufort.or(calm) {
            None => undeclared("the wind", "at most Beaufort 5"),
            Some(beaufort) => (beaufort > MAX_BEAUFORT).then_some(ConditionShortcoming::Wind { beaufort }),
        };
        let sea = match self.sea_state.or(calm) {
            None => undeclared("the sea state", "at most sea state 4"),
            Some(state) => (state > MAX_SEA_STATE).then_some(ConditionShortcoming::Sea { state }),
        };
        let draught = self.draught_share();
        let load = match (self.loading(), draught) {
            (None, _) => undeclared("the loading", "full load with a tolerance of 5 % in draught"),
            (Some(Loading::Partial), _) => Some(ConditionShortcoming::Load { draught }),
            (Some(Loading::Full), share) => share
                .filter(|share| (share - 1.0).abs() > MAX_DRAUGHT_DEVIATION_SHARE)
                .map(|draught| ConditionShortcoming::Contradiction { draught }),
        };
        let trim = self.trim.filter(|trim| *trim != 0.0).map(|trim| ConditionShortcoming::Trim { trim });
        [depth, wind, sea, load, trim].into_iter().flatten().collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn deep_and_calm() -> DeclaredConditions {
        DeclaredConditions {
            draught: Some(20.0),
            full_load_draught: Some(20.8),
            water_depth: Some(90.0),
            wind_beaufort: Some(5),
            sea_state: Some(4),
            ..DeclaredConditions::default()
        }
    }

    #[test]
    fn a_trial_by_the_book_has_no_remark() {
        let conditions = deep_and_calm();
        assert_eq!(conditions.loading(), Some(Loading::Full), "4 % less draught");
        assert_eq!(conditions.shortcomings(), []);
    }

    #[test]
    fn what_is_not_by_the_book_is_said() {
        let message = |change: fn(&mut DeclaredConditions)| {
            let mut conditions = deep_and_calm();
            change(&mut conditions);
            let shortcomings = conditions.shortcomings();
            assert_eq!(shortcomings.len(), 1, "{shortcomings:?}");
            shortcomings[0].to_string()
        };
        assert!(message(|c| c.water_depth = Some(80.0)).contains("4.0 mean draughts"), "it should exceed four");
        assert!(message(|c| c.water_depth = None).contains("is not declared"));
        assert!(message(|c| c.wind_beaufort = Some(6)).contains("Beaufort 6"));
        assert!(message(|c| c.sea_state = Some(5)).contains("sea state is 5"));
        assert!(message(|c| c.full_load_draught = Some(25.0)).contains("80 %"));
        assert!(message(|c| c.full_load_draught = None).contains("the loading is not declared"));
        assert!(message(|c| c.declared_loading = Some(Loading::Partial)).contains("not at full load"));
        let in_a_calm = DeclaredConditions {
            weather: Some(DeclaredWeather::Calm),
            wind_beaufort: None,
            sea_state: None,
            ..deep_and_calm()
        };
        assert_eq!(in_a_calm.shortcomings(), []);
        assert!(message(|c| c.trim = Some(-0.5)).contains("0.50 m by the bow"));
        let contradiction = message(|c| (c.declared_loading, c.full_load_draught) = (Some(Loading::Full), Some(25.0)));
        assert!(contradiction.contains("declared as \"full\""), "{contradiction}");
    }

    #[test]
    fn the_draught_of_a_trial_at_full_load_is_that_at_full_load() {
        let mut conditions = deep_and_calm();
        conditions.full_load_draught = None;
        assert_eq!(conditions.draught_at_full_load(), None);
        conditions.declared_loading = Some(Loading::Full);
        assert_eq!(conditions.draught_at_full_load(), Some(20.0));
    }
}
