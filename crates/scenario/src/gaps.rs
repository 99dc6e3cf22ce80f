//! Values that stand in for those of a document while it is read, so that a drawn trial needs no document of its own.

use toml::Value;

use crate::problem::KeyPath;

/// Keys of a document whose values are given when it is read, as a tree of names. The document has to have them.
#[derive(Debug, Clone, Default)]
pub struct Gaps(Vec<(String, Gap)>);

#[derive(Debug, Clone)]
enum Gap {
    /// The place of the value among those given.
    Value(usize),
    Below(Gaps),
}

impl Gaps {
    /// Gaps at these keys, none of which leads to another.
    pub fn new<'a>(keys: impl IntoIterator<Item = &'a KeyPath>) -> Self {
        let mut gaps = Self::default();
        keys.into_iter().enumerate().for_each(|(index, key)| gaps.add(key.parts(), index));
        gaps
    }

    fn add(&mut self, parts: &[String], index: usize) {
        match parts {
            [] => {}
            [name] => self.0.push((name.clone(), Gap::Value(index))),
            [name, rest @ ..] => match self.0.iter_mut().find(|(known, _)| known == name) {
                Some((_, Gap::Below(below))) => below.add(rest, index),
                _ => {
                    let mut below = Self::default();
                    below.add(rest, index);
                    self.0.push((name.clone(), Gap::Below(below)));
                }
            },
        }
    }
}

/// What is given for the gaps below a node.
#[derive(Clone, Copy)]
pub struct Filling<'de, 'a> {
    pub gaps: &'a Gaps,
    pub values: &'de [Value],
}

impl<'de, 'a> Filling<'de, 'a> {
    /// The value of a node one step below, and what is given for the gaps below that.
    pub fn below(self, value: &'de Value, is_it: impl Fn(&str) -> bool) -> (&'de Value, Option<Self>) {
        match self.gaps.0.iter().find(|(name, _)| is_it(name)) {
            Some((_, Gap::Value(index))) => (&self.values[*index], None),
            Some((_, Gap::Below(gaps))) => (value, Some(Self { gaps, ..self })),
            None => (value, None),
        }
    }
}
