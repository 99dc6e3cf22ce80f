//! What a user wants to be in the model, or kept out of it, whatever the evidence says.

use std::sync::Arc;

use identify::settings::SettingsError;
use ship::effects::{self, Effect, Formula};

/// Identifier of an effect on the list.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct EffectId(&'static str);

impl EffectId {
    /// The effect of this name; `None` where there is none.
    pub fn find(name: &str) -> Option<Self> {
        effects::all().iter().map(|effect| effect.id()).find(|id| *id == name).map(Self)
    }

    /// Every effect once, in the order of reports.
    pub fn all() -> Vec<Self> {
        let mut ids: Vec<Self> = effects::all().iter().map(|effect| Self(effect.id())).collect();
        // The forms of an effect follow one another.
        ids.dedup();
        ids
    }

    /// The effect of a formula.
    pub fn of(formula: &Formula) -> Self {
        Self(formula.id())
    }

    /// The name.
    pub fn as_str(self) -> &'static str {
        self.0
    }
}

/// Effects that are in the model on request, effects that are no candidates, and whether others are looked for.
///
/// An effect that was asked for is fitted in its most probable form, judged and replayed like any other, and never
/// dropped.
#[derive(Debug, Clone, PartialEq)]
pub struct Selection {
    /// In the model whatever the evidence says.
    pub with: Vec<EffectId>,
    /// No candidates.
    pub without: Vec<EffectId>,
    /// Whether effects that were not asked for are looked for.
    pub search: bool,
    /// Effects written as formulas, candidates like those of the list.
    pub formulas: Vec<Arc<Formula>>,
}

impl Default for Selection {
    fn default() -> Self {
        Self { with: Vec::new(), without: Vec::new(), search: true, formulas: Vec::new() }
    }
}

impl Selection {
    /// Exactly these effects and no search.
    pub fn only(with: Vec<EffectId>) -> Self {
        Self { with, search: false, ..Self::default() }
    }

    /// A search that has these effects alone on its menu.
    pub fn among(menu: &[EffectId]) -> Self {
        let without = EffectId::all().into_iter().filter(|id| !menu.contains(id)).collect();
        Self { without, ..Self::default() }
    }

    /// Every effect in every form: those of the list, then the formulas.
    pub fn effects(&self) -> Vec<Arc<dyn Effect>> {
        let formulas = self.formulas.iter().map(|formula| Arc::clone(formula) as Arc<dyn Effect>);
        effects::all().into_iter().chain(formulas).collect()
    }

    /// Every effect once, in the order of reports.
    pub fn ids(&self) -> Vec<EffectId> {
        EffectId::all().into_iter().chain(self.formulas.iter().map(|formula| EffectId::of(formula))).collect()
    }

    /// The formula of this name.
    pub fn formula(&self, name: &str) -> Option<&Formula> {
        self.formulas.iter().find(|formula| formula.id() == name).map(Arc::as_ref)
    }

    /// The effect of this name, on the list or a formula; `None` where there is none.
    pub fn find(&self, name: &str) -> Option<EffectId> {
        EffectId::find(name).or_else(|| self.formula(name).map(EffectId::of))
    }

    /// Refuses an effect that is asked for and excluded at once, and two formulas of one name.
    pub fn check(&self) -> Result<(), SettingsError> {
        let ids: Vec<&str> = self.formulas.iter().map(|formula| formula.id()).collect();
        if let Some(twice) = (1..ids.len()).find(|&place| ids[..place].contains(&ids[place])) {
            return Err(SettingsError::new("effect", ids[twice], "effects with names of their own"));
        }
        match self.with.iter().find(|id| self.without.contains(id)) {
            Some(both) => {
                let expected = "an effect that `with` does not name";
                Err(SettingsError::new("without-effect", both.as_str(), expected))
            }
            None => Ok(()),
        }
    }

    /// Whether an effect was asked for.
    pub fn asks_for(&self, id: &str) -> bool {
        self.with.iter().any(|asked| asked.as_str() == id)
    }

    /// Whether an effect may be in the model.
    pub fn allows(&self, id: &str) -> bool {
        self.asks_for(id) || self.search && !self.without.iter().any(|excluded| excluded.as_str() == id)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn id(name: &str) -> EffectId {
        EffectId::find(name).expect("on the list")
    }

    #[test]
    fn effects_are_known_by_name() {
        assert_eq!(EffectId::find("wind"), None);
        let all = EffectId::all();
        assert!(all.len() == 12 && all.iter().all(|one| EffectId::find(one.as_str()) == Some(*one)), "{all:?}");
    }

    #[test]
    fn what_is_asked_for_is_allowed_and_what_is_excluded_is_not() {
        let usual =
            Selection { with: vec![id("speed_loss")], without: vec![id("wind_moment")], ..Selection::default() };
        assert_eq!(usual.check(), Ok(()));
        assert_eq!(["speed_loss", "wind_moment", "wave_yaw"].map(|id| usual.allows(id)), [true, false, true]);
        let few = Selection::among(&[id("speed_loss")]);
        assert_eq!(["speed_loss", "wind_moment", "wave_yaw"].map(|id| few.allows(id)), [true, false, false]);
        assert!(few.with.is_empty() && few.search && few.check().is_ok());
        let only = Selection::only(vec![id("speed_loss")]);
        assert_eq!(["speed_loss", "wind_moment", "wave_yaw"].map(|id| only.allows(id)), [true, false, false]);
        let both = Selection { without: vec![id("speed_loss")], ..usual };
        assert_eq!(both.check().map_err(|error| error.found), Err(String::from("speed_loss")));
    }
}
