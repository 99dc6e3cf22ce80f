//! Effects that a user requires in the model, excludes from it, or adds as formulas.

use std::sync::Arc;

use identify::settings::SettingsError;
use ship::effects::{self, Effect, Formula};

/// Identifier of a listed effect or of a formula.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct EffectId(&'static str);

impl EffectId {
    /// Listed effect of this name; `None` for any other name.
    pub fn find(name: &str) -> Option<Self> {
        effects::all_effects().iter().map(|effect| effect.id()).find(|id| *id == name).map(Self)
    }

    /// Listed effects, in the order of reports.
    pub fn all() -> Vec<Self> {
        let mut ids: Vec<Self> = effects::all_effects().iter().map(|effect| Self(effect.id())).collect();
        // The forms of an effect follow one another.
        ids.dedup();
        ids
    }

    /// Identifier of a formula.
    pub fn from_formula(formula: &Formula) -> Self {
        Self(formula.id())
    }

    /// Name in files.
    pub fn as_str(self) -> &'static str {
        self.0
    }
}

/// Selection of the candidate effects.
///
/// A required effect is fitted in its most probable form, evaluated and replayed like any other, and never dropped.
#[derive(Debug, Clone, PartialEq)]
pub struct Selection {
    /// Required effects: in the model whatever their evidence.
    pub required: Vec<EffectId>,
    /// Excluded effects: never candidates.
    pub excluded: Vec<EffectId>,
    /// `true` if effects that are not required are candidates.
    pub searches_effects: bool,
    /// Effects given as formulas, candidates like the listed effects.
    pub formulas: Vec<Arc<Formula>>,
}

impl Default for Selection {
    fn default() -> Self {
        Self { required: Vec::new(), excluded: Vec::new(), searches_effects: true, formulas: Vec::new() }
    }
}

impl Selection {
    /// Selection of exactly these effects, without a search.
    pub fn only(with: Vec<EffectId>) -> Self {
        Self { required: with, searches_effects: false, ..Self::default() }
    }

    /// Search among these listed effects only.
    pub fn among(menu: &[EffectId]) -> Self {
        let without = EffectId::all().into_iter().filter(|id| !menu.contains(id)).collect();
        Self { excluded: without, ..Self::default() }
    }

    /// Effects in all their forms: the listed effects, then the formulas.
    pub fn effects(&self) -> Vec<Arc<dyn Effect>> {
        let formulas = self.formulas.iter().map(|formula| Arc::clone(formula) as Arc<dyn Effect>);
        effects::all_effects().into_iter().chain(formulas).collect()
    }

    /// Identifiers of all effects, in the order of reports.
    pub fn ids(&self) -> Vec<EffectId> {
        EffectId::all().into_iter().chain(self.formulas.iter().map(|formula| EffectId::from_formula(formula))).collect()
    }

    /// Formula of this name; `None` if no formula has it.
    pub fn formula(&self, name: &str) -> Option<&Formula> {
        self.formulas.iter().find(|formula| formula.id() == name).map(Arc::as_ref)
    }

    /// Listed effect or formula of this name; `None` for any other name.
    pub fn find(&self, name: &str) -> Option<EffectId> {
        EffectId::find(name).or_else(|| self.formula(name).map(EffectId::from_formula))
    }

    /// Fails if an effect is both required and excluded, or if two formulas have the same name.
    pub fn check(&self) -> Result<(), SettingsError> {
        let ids: Vec<&str> = self.formulas.iter().map(|formula| formula.id()).collect();
        if let Some(twice) = (1..ids.len()).find(|&place| ids[..place].contains(&ids[place])) {
            return Err(SettingsError::new("effect", ids[twice], "effects with names of their own"));
        }
        match self.required.iter().find(|id| self.excluded.contains(id)) {
            Some(both) => {
                let expected = "an effect that `with` does not name";
                Err(SettingsError::new("without-effect", both.as_str(), expected))
            }
            None => Ok(()),
        }
    }

    /// `true` if an effect is required.
    pub fn requires(&self, id: &str) -> bool {
        self.required.iter().any(|asked| asked.as_str() == id)
    }

    /// `true` if an effect is a candidate.
    pub fn allows(&self, id: &str) -> bool {
        self.requires(id) || self.searches_effects && !self.excluded.iter().any(|excluded| excluded.as_str() == id)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn id(name: &str) -> EffectId {
        EffectId::find(name).expect("on the list")
    }

    #[test]
    fn effects_are_found_by_name() {
        assert_eq!(EffectId::find("wind"), None);
        let all = EffectId::all();
        assert!(all.len() == 12 && all.iter().all(|id| EffectId::find(id.as_str()) == Some(*id)), "{all:?}");
    }

    #[test]
    fn required_effects_are_allowed_and_excluded_ones_are_not() {
        let usual =
            Selection { required: vec![id("speed_loss")], excluded: vec![id("wind_moment")], ..Selection::default() };
        assert_eq!(usual.check(), Ok(()));
        assert_eq!(["speed_loss", "wind_moment", "wave_yaw"].map(|id| usual.allows(id)), [true, false, true]);
        let few = Selection::among(&[id("speed_loss")]);
        assert_eq!(["speed_loss", "wind_moment", "wave_yaw"].map(|id| few.allows(id)), [true, false, false]);
        assert!(few.required.is_empty() && few.searches_effects && few.check().is_ok());
        let only = Selection::only(vec![id("speed_loss")]);
        assert_eq!(["speed_loss", "wind_moment", "wave_yaw"].map(|id| only.allows(id)), [true, false, false]);
        let both = Selection { excluded: vec![id("speed_loss")], ..usual };
        assert_eq!(both.check().map_err(|error| error.value), Err(String::from("speed_loss")));
    }
}
