//! Limits on the size of one scenario, so that any file is read and checked quickly. A person writes a few entries of
//! each kind; more indicate an error, or several studies. [`simulate::cost`] limits the cost of one trial.

use crate::scenario::problem::{KeyFault, KeyPath};

/// Maximum number of `[[sweep]]` entries: with two points each, more would exceed the maximum number of cells.
pub const MAX_SWEEP_ENTRIES: usize = 16;

/// Maximum number of `[[draw]]` entries: each is checked at both ends of its range in every cell.
pub const MAX_DRAW_ENTRIES: usize = 64;

/// Maximum number of `[[identifier]]` entries: each is a column of every table.
pub const MAX_METHODS: usize = 100;

/// Maximum number of `[[effect]]` entries, which is above the number of listed effects: each is computed at every step.
pub const MAX_EFFECTS: usize = 20;

/// Maximum number of cells times methods, which are in memory while the study runs.
pub const MAX_CELLS_TIMES_METHODS: usize = 1_000_000;

/// Maximum number of names in a dotted key; no key has half as many.
const MAX_NAMES: usize = 16;

/// Refuses a list with too many entries.
pub fn check_count(list: &str, count: usize, most: usize) -> Result<(), KeyFault> {
    if count <= most {
        return Ok(());
    }
    Err(KeyFault::name(
        KeyPath::from_dotted(list),
        format!("`{list}` has {count} entries"),
        format!("expected at most {most}"),
        "remove some, or split the scenario",
    ))
}

/// Refuses a key with too many names, at its `place` in the file.
pub fn check_depth(key: &KeyPath, place: &KeyPath) -> Result<(), KeyFault> {
    let names = key.names().len();
    if names <= MAX_NAMES {
        return Ok(());
    }
    Err(KeyFault::value(
        place.clone(),
        format!("the key has {names} names joined by dots"),
        format!("expected at most {MAX_NAMES}"),
        "write a key of the trial or of a method, for instance `sensor.heading-noise-deg`",
    ))
}
