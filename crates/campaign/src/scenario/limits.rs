//! How much one scenario may hold, so that it is read, checked and begun at once, whatever stands in it. A person
//! writes a few of each; more is a slip or comes from a program, and is several studies. What one trial may cost is
//! estimated in [`simulate::cost`].

use crate::scenario::problem::{KeyFault, KeyPath};

/// Most entries of `[[sweep]]`: with two points each they make more cells than a study may have.
pub const MOST_SWEEPS: usize = 16;

/// Most entries of `[[draw]]`: each is tried at both ends of its range in every cell.
pub const MOST_DRAWS: usize = 64;

/// Most entries of `[[identifier]]`: each is a column of every table.
pub const MOST_METHODS: usize = 100;

/// Most entries of `[[effect]]`: each is computed at every step. There are fewer effects than that.
pub const MOST_EFFECTS: usize = 20;

/// Most cells times methods: they are in memory while the study runs.
pub const MOST_METHODS_OF_CELLS: usize = 1_000_000;

/// Most names in a dotted key; no key of a scenario has half as many.
const MOST_NAMES: usize = 16;

/// Refuses a list of too many entries.
pub fn entries(list: &str, count: usize, most: usize) -> Result<(), KeyFault> {
    if count <= most {
        return Ok(());
    }
    Err(KeyFault::name(
        KeyPath::dotted(list),
        format!("`{list}` has {count} entries"),
        format!("expected at most {most}"),
        "remove some, or make several scenarios of this one",
    ))
}

/// Refuses a key that leads deeper than any document, at the `place` where it is written.
pub fn depth(key: &KeyPath, place: &KeyPath) -> Result<(), KeyFault> {
    let names = key.parts().len();
    if names <= MOST_NAMES {
        return Ok(());
    }
    Err(KeyFault::value(
        place.clone(),
        format!("the key has {names} names joined by dots"),
        format!("expected at most {MOST_NAMES}"),
        "write a key of the trial or of a method, for instance `sensor.heading-noise-deg`",
    ))
}
