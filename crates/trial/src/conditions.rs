//! What a trial was made with and in, as the form of MSC/Circ.1053, appendix 6, asks for it: particulars of the ship
//! that no record holds, and the conditions of the trial with what the circular demands of them.

use serde::{Deserialize, Serialize};
use ship::Particulars;
use ship::vessel::prior::HullParticulars;
use thiserror::Error;

use crate::trial_particulars::TrialParticulars;

/// Water depth that a trial needs, mean draughts. Source: MSC/Circ.1053 (2002), 2.2.1.2.1.
pub const FEWEST_DRAUGHTS: f64 = 4.0;
/// Strongest wind of a trial, Beaufort number. Source: MSC/Circ.1053 (2002), 2.2.1.2.1.
pub const MOST_BEAUFORT: u8 = 5;
/// Highest sea state of a trial. Source: MSC/Circ.1053 (2002), 2.2.1.2.1.
pub const MOST_SEA_STATE: u8 = 4;
/// Deviation from the full-load draught that is still full load, as a share. Source: MSC/Circ.1053 (2002), 2.2.1.2.2.
pub const DRAUGHT_TOLERANCE: f64 = 0.05;
/// Longest interval between readings of a trial, s. Source: MSC/Circ.1053 (2002), 2.2.
pub const LONGEST_INTERVAL: f64 = 20.0;

/// How a ship was loaded at her trial.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Loading {
    /// To the summer load line draught, or within 5 % of it.
    Full,
    /// To less, as in ballast.
    Partial,
}

/// The weather that a trial declares.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, schemars::JsonSchema)]
pub enum DeclaredWeather {
    /// A calm: neither wind nor waves nor any other moment from outside, as in a towing tank.
    #[serde(rename = "none")]
    Calm,
}

/// Particulars and conditions that a sidecar declares under `[form]`; SI units, `None` where nothing is declared. In
/// brackets, what the key of a sidecar may be.
///
/// Source of the entries: MSC/Circ.1053 (2002), appendix 6.
#[derive(Debug, Clone, Default, PartialEq, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct Conditions {
    /// Administration the form of MSC/Circ.1053 goes to; texts have at most 100 characters. (text)
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
    /// Ship, day and draughts of the trial, of the same sidecar.
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
    /// Loading at the trial; by the two draughts, with a tolerance of 5 %, when absent. (full or partial)
    #[serde(rename = "loading")]
    #[schemars(with = "Option<String>")]
    pub declared_loading: Option<Loading>,
    /// A remark for the form. (text)
    pub remark: Option<String>,
}

/// Where a trial is not, or not known to be, what MSC/Circ.1053 (2002), 2.2, asks for.
#[derive(Debug, Clone, PartialEq, Error)]
#[expect(missing_docs, reason = "the message of a variant says what its fields are")]
pub enum Shortcoming {
    /// Something is not declared.
    #[error("{what} is not known; {asked} is asked for")]
    Unknown { what: &'static str, asked: &'static str },
    /// The water is too shallow.
    #[error("water of {draughts:.1} mean draughts; more than {FEWEST_DRAUGHTS} are asked for")]
    Depth { draughts: f64 },
    /// The wind is too strong.
    #[error("wind of Beaufort {beaufort}; at most {MOST_BEAUFORT} is asked for")]
    Wind { beaufort: u8 },
    /// The sea is too rough.
    #[error("sea state {state}; at most {MOST_SEA_STATE} is asked for")]
    Sea { state: u8 },
    /// Readings are too far apart: the median time between rows.
    #[error("a reading every {seconds:.0} s; at most {LONGEST_INTERVAL} s are asked for")]
    Interval { seconds: f64 },
    /// The ship was not at full load; her draught as a share of that at full load, where both are known.
    #[error("not at full load{}", draught.map_or_else(String::new, of_full_load))]
    Load { draught: Option<f64> },
    /// Full load is declared and the draughts say otherwise: the draught as a share of that at full load.
    #[error(
        "the loading is declared as \"full\", and the draught is {:.0} % of that at full load; 5 % are allowed",
        100.0 * draught
    )]
    Contradiction { draught: f64 },
    /// The ship was not on an even keel; trim by the stern, m.
    #[error(
        "trim of {:.2} m by the {}; an even keel is asked for", trim.abs(), if *trim > 0.0 { "stern" } else { "bow" }
    )]
    Trim { trim: f64 },
}

fn of_full_load(share: f64) -> String {
    format!(": the draught is {:.0} % of that at full load", 100.0 * share)
}

impl Conditions {
    /// The same without blanks around texts.
    pub(crate) fn trimmed(mut self) -> Self {
        let Self {
            administration, ship_type, rudder_type, propeller_type, engine_type, ballast, remark, trial, ..
        } = &mut self;
        let ship_name = &mut trial.ship_name;
        for text in [administration, ship_type, rudder_type, propeller_type, engine_type, ballast, remark, ship_name] {
            *text = text.take().map(|text| text.trim().to_owned());
        }
        self
    }

    /// Takes over what [ship] declares of the hull, and completes that with what is declared here. The key of what both
    /// declare and not alike, where there is one; block coefficients may differ, here it is that at full load.
    pub(crate) fn join(&mut self, hull: HullParticulars) -> Option<&'static str> {
        let pairs = [
            ("beam-m", &mut self.beam, hull.beam),
            ("draught-m", &mut self.draught, hull.draught),
            ("rudder-area-m2", &mut self.rudder_area, hull.rudder_area),
        ];
        let mut other = None;
        *pairs[1].1 = pairs[1].1.or(self.trial.mean_draught().filter(|_| hull.draught.is_none()));
        self.trim = self.trim.or(self.trial.trim());
        for (key, own, ship) in pairs {
            other = other.or(own.zip(ship).is_some_and(|(own, ship)| own != ship).then_some(key));
            *own = ship.or(*own);
        }
        let (beam, draught, rudder_area) = (self.beam, self.draught, self.rudder_area);
        let is_full = self.loading() != Some(Loading::Partial);
        let block_coefficient = hull.block_coefficient.or(self.block_coefficient.filter(|_| is_full));
        self.block_coefficient = self.block_coefficient.or(block_coefficient.filter(|_| is_full));
        self.hull = HullParticulars { beam, draught, block_coefficient, rudder_area, ..hull };
        other
    }

    /// The key of a length that no ship has beside the others, or of a weather beside a declared calm, and what was
    /// expected.
    pub(crate) fn contradiction(&self) -> Option<(&'static str, &'static str)> {
        let length = self.particulars.map(|own| own.length);
        let calm = self.weather.map(|_| 1.0);
        let rules = [
            ("wind-beaufort", self.wind_beaufort.map(f64::from), calm, "0 beside weather = \"none\", or nothing"),
            ("sea-state", self.sea_state.map(f64::from), calm, "0 beside weather = \"none\", or nothing"),
            ("beam-m", self.beam, length, "a breadth below the length of [ship]"),
            ("draught-m", self.draught, self.water_depth, "a draught below water-depth-m"),
            ("draught-m", self.draught, self.beam, "a draught below beam-m"),
            ("full-load-draught-m", self.full_load_draught, self.beam, "a draught below beam-m"),
        ];
        let ends = self.trial.draughts().map(|[fore, aft]| [fore.min(aft), fore.max(aft)]);
        if ends.zip(self.draught).is_some_and(|([low, high], mean)| !(low..=high).contains(&mean)) {
            return Some(("draught-m", "a mean draught between those fore and aft of [trial], or nothing"));
        }
        let broken =
            rules.into_iter().find(|(_, one, limit, _)| one.zip(*limit).is_some_and(|(one, limit)| one >= limit));
        broken.map(|(key, .., expected)| (key, expected))
    }

    /// Draught at the trial as a share of that at full load.
    fn draught_share(&self) -> Option<f64> {
        Some(self.draught? / self.full_load_draught?)
    }

    /// How the ship was loaded: as it is declared, else by the draughts with the 5 % that are allowed.
    pub fn loading(&self) -> Option<Loading> {
        let by_draught = |share: f64| match (share - 1.0).abs() <= DRAUGHT_TOLERANCE {
            true => Loading::Full,
            false => Loading::Partial,
        };
        self.declared_loading.or_else(|| self.draught_share().map(by_draught))
    }

    /// Mean draught at full load, m: as it is declared, or that of a trial at full load.
    pub fn draught_at_full_load(&self) -> Option<f64> {
        let at_trial = || self.draught.filter(|_| self.declared_loading == Some(Loading::Full));
        self.full_load_draught.or_else(at_trial)
    }

    /// Depth of the water in mean draughts of the trial.
    pub fn depth_in_draughts(&self) -> Option<f64> {
        Some(self.water_depth? / self.draught?)
    }

    /// What is not, or not known to be, as MSC/Circ.1053 (2002), 2.2, asks for; current and speed are not looked at.
    pub fn shortcomings(&self) -> Vec<Shortcoming> {
        let unknown = |what, asked| Some(Shortcoming::Unknown { what, asked });
        let depth = match self.depth_in_draughts() {
            None => unknown("the water depth in draughts", "more than 4 mean draughts"),
            Some(draughts) => (draughts <= FEWEST_DRAUGHTS).then_some(Shortcoming::Depth { draughts }),
        };
        let calm = self.weather.map(|_| 0);
        let wind = match self.wind_beaufort.or(calm) {
            None => unknown("the wind", "at most Beaufort 5"),
            Some(beaufort) => (beaufort > MOST_BEAUFORT).then_some(Shortcoming::Wind { beaufort }),
        };
        let sea = match self.sea_state.or(calm) {
            None => unknown("the sea state", "at most sea state 4"),
            Some(state) => (state > MOST_SEA_STATE).then_some(Shortcoming::Sea { state }),
        };
        let draught = self.draught_share();
        let load = match (self.loading(), draught) {
            (None, _) => unknown("the loading", "full load with a tolerance of 5 % in draught"),
            (Some(Loading::Partial), _) => Some(Shortcoming::Load { draught }),
            (Some(Loading::Full), share) => share
                .filter(|share| (share - 1.0).abs() > DRAUGHT_TOLERANCE)
                .map(|draught| Shortcoming::Contradiction { draught }),
        };
        let trim = self.trim.filter(|trim| *trim != 0.0).map(|trim| Shortcoming::Trim { trim });
        [depth, wind, sea, load, trim].into_iter().flatten().collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn deep_and_calm() -> Conditions {
        Conditions {
            draught: Some(20.0),
            full_load_draught: Some(20.8),
            water_depth: Some(90.0),
            wind_beaufort: Some(5),
            sea_state: Some(4),
            ..Conditions::default()
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
        let said = |change: fn(&mut Conditions)| {
            let mut conditions = deep_and_calm();
            change(&mut conditions);
            let found = conditions.shortcomings();
            assert_eq!(found.len(), 1, "{found:?}");
            found[0].to_string()
        };
        assert!(said(|c| c.water_depth = Some(80.0)).contains("4.0 mean draughts"), "it should exceed four");
        assert!(said(|c| c.water_depth = None).contains("is not known"));
        assert!(said(|c| c.wind_beaufort = Some(6)).contains("Beaufort 6"));
        assert!(said(|c| c.sea_state = Some(5)).contains("sea state 5"));
        assert!(said(|c| c.full_load_draught = Some(25.0)).contains("80 %"));
        assert!(said(|c| c.full_load_draught = None).contains("the loading is not known"));
        assert!(said(|c| c.declared_loading = Some(Loading::Partial)).contains("not at full load"));
        let in_a_calm = Conditions {
            weather: Some(DeclaredWeather::Calm),
            wind_beaufort: None,
            sea_state: None,
            ..deep_and_calm()
        };
        assert_eq!(in_a_calm.shortcomings(), []);
        assert!(said(|c| c.trim = Some(-0.5)).contains("0.50 m by the bow"));
        let said = said(|c| (c.declared_loading, c.full_load_draught) = (Some(Loading::Full), Some(25.0)));
        assert!(said.contains("declared as \"full\""), "{said}");
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
