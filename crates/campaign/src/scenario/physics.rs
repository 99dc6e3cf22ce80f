//! Physics that a first-order base lacks in the trials of a cell: the reference of the scores of a trace.

use document::trace::Dependence;
use serde::{Deserialize, Serialize};

use crate::scenario::problem::{KeyFault, KeyPath, suggestion};

/// Keys of [`PhysicsWire`], which stand beside the constants of a formula.
pub const PHYSICS_KEYS: [&str; 4] = ["stands-for", "depends-on", "changes-s", "period-s"];

/// Correct findings for a formula, as written in its entry.
#[derive(Debug, Default, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields, default, rename_all = "kebab-case")]
pub struct PhysicsWire {
    /// Effects of the list with the same physics: a trace that names one of them is right.
    stands_for: Vec<String>,
    /// Variable that determines the moment, if no effect of the list has the same physics: a trace that locates it is
    /// right.
    depends_on: Option<Dependence>,
    /// Instants of change of a time-dependent moment, or centres of its pulses.
    changes_s: Vec<f64>,
    /// Minimum and maximum period of a time-dependent moment.
    period_s: Option<[f64; 2]>,
}

/// Physics that a first-order base lacks.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub enum MissingPhysics {
    /// Effects of the list, or the same physics in another formula.
    Listed {
        /// Effects; any of them is right.
        effects: Vec<String>,
    },
    /// Moment on no list.
    Unlisted {
        /// Variable that determines the moment.
        depends_on: Dependence,
        /// Instants of change, or centres of pulses.
        changes_s: Vec<f64>,
        /// Minimum and maximum period.
        period_s: Option<[f64; 2]>,
    },
    /// No missing physics.
    Nothing {
        /// `true` if a random moment acts on the ship or her recorded rudder, so that naming one is right as well.
        disturbed: bool,
    },
}

impl PhysicsWire {
    /// Missing physics stated by the entry of a formula.
    ///
    /// Fails for an unknown effect, and for inconsistent keys.
    pub fn resolve(self, place: &KeyPath) -> Result<MissingPhysics, KeyFault> {
        let Self { stands_for: effects, depends_on, changes_s, period_s } = self;
        let ids = effect_ids();
        if let Some(index) = effects.iter().position(|id| !ids.contains(&id.as_str())) {
            let (id, key) = (&effects[index], place.child("stands-for").child(index));
            let problem = format!("no effect is called `{id}`");
            return Err(KeyFault::value(key, problem, "expected an effect of the list", suggestion(id, &ids)));
        }
        let is_timed = !changes_s.is_empty() || period_s.is_some();
        let is_backwards = period_s.is_some_and(|[from, to]| !(from > 0.0 && from <= to));
        let time = if changes_s.is_empty() { "period-s" } else { "changes-s" };
        let faults = [
            (
                is_timed && depends_on != Some(Dependence::Time),
                (
                    time,
                    "times of a moment that does not depend on time",
                    "expected `depends-on = \"time\"` beside them",
                ),
            ),
            (
                !changes_s.is_empty() && period_s.is_some(),
                (time, "a moment with changes and with a period", "expected `changes-s` or `period-s`"),
            ),
            (is_backwards, (time, "an invalid range of periods", "expected two periods above 0 s, the shorter first")),
            (
                effects.is_empty() != depends_on.is_some(),
                (
                    "depends-on",
                    "both or neither of `stands-for` and `depends-on`",
                    "expected exactly one of the two keys",
                ),
            ),
        ];
        if let Some((_, (key, problem, expected))) = faults.into_iter().find(|(is_wrong, _)| *is_wrong) {
            return Err(KeyFault::name(place.child(key), problem, expected, "keep one of the keys, or leave all out"));
        }
        Ok(match depends_on {
            None => MissingPhysics::Listed { effects },
            Some(depends_on) => MissingPhysics::Unlisted { depends_on, changes_s, period_s },
        })
    }
}

impl MissingPhysics {
    /// Missing physics of a ship without a statement: one listed effect, or none; `None` for several effects and for
    /// a name outside the list.
    pub fn from_effects(missing: &[String], disturbed: bool) -> Option<Self> {
        match missing {
            [] => Some(Self::Nothing { disturbed }),
            [id] if effect_ids().contains(&id.as_str()) => Some(Self::Listed { effects: missing.to_vec() }),
            _ => None,
        }
    }
}

/// Identifiers of the listed effects.
fn effect_ids() -> Vec<&'static str> {
    let mut ids: Vec<&str> = ship::effects::all_effects().iter().map(|effect| effect.id()).collect();
    ids.dedup();
    ids
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::zig_zag;

    #[test]
    fn what_is_right_is_stated_or_is_what_the_list_has() {
        let formula = "[[effect]]\nformula = 'x = c * psi'\nc = 0.1\n";
        let listed = |id: &str| Some(MissingPhysics::Listed { effects: vec![id.to_owned()] });
        let timed = |changes_s: &[f64], period_s| {
            Some(MissingPhysics::Unlisted { depends_on: Dependence::Time, changes_s: changes_s.to_vec(), period_s })
        };
        for (keys, physics) in [
            (format!("{formula}stands-for = ['speed_loss']"), listed("speed_loss")),
            (format!("{formula}depends-on = 'time'\nchanges-s = [100, 200]"), timed(&[100.0, 200.0], None)),
            (format!("{formula}depends-on = 'time'\nperiod-s = [40, 70]"), timed(&[], Some([40.0, 70.0]))),
            (formula.to_owned(), None),
            ("[sensor]\nheading-lag-s = 1.5".to_owned(), listed("steering_lag")),
            (String::new(), Some(MissingPhysics::Nothing { disturbed: false })),
            ("[sensor]\nrudder-noise-deg = 0.2".to_owned(), Some(MissingPhysics::Nothing { disturbed: true })),
        ] {
            assert_eq!(zig_zag(1, &keys).cells[0].physics(), physics, "{keys}");
        }
    }
}
