//! Resolved text of a scenario: the keys as written, and all defaults with a mark.

use toml::{Table, Value};

use crate::scenario::keys::{KeyDefault, ScenarioKey, scenario_keys};
use crate::scenario::method::Method;
use crate::scenario::problem::KeyFault;
use crate::scenario::resolve::validation_recording;
use crate::scenario::wire::ScenarioWire;
use crate::scenario::{effect, reader, ship};

/// Resolved text of a scenario, as TOML. Sweeps and draws are kept as written.
///
/// Fails as the scenario would.
pub fn scenario_toml(document: &Table, methods: &[Method]) -> Result<String, KeyFault> {
    let mut wire: ScenarioWire = reader::read_document(document)?;
    effect::fill_defaults(&mut wire.effect);
    ship::fill_defaults(&mut wire.ship);
    let ship = effect::with_effects(ship::build(&wire.ship)?, &wire.effect, &[])?;
    wire.steering_gear = wire.steering_gear.with_ship_defaults(&ship);
    wire.steering_gear.rudder_rate.get_or_insert(f64::INFINITY);
    for (entry, method) in wire.identifier.iter_mut().zip(methods) {
        entry.label.get_or_insert_with(|| method.label.clone());
    }
    for also in &mut wire.also {
        also.recording.get_or_insert(wire.recording);
    }
    if let Some(validation) = &mut wire.validation {
        validation.recording.get_or_insert(validation_recording(&wire.recording));
    }
    let complete = Table::try_from(&wire).expect("what was read can be written");
    let mut lines = ResolvedText { keys: scenario_keys(), text: String::new() };
    lines.table(&[], &complete, Some(document));
    Ok(lines.text.trim_start().to_owned())
}

/// Writer of the resolved text.
struct ResolvedText {
    /// Keys of a scenario, to comment those without a default.
    keys: Vec<ScenarioKey>,
    text: String,
}

impl ResolvedText {
    /// Writes the table at a path; `given` is the table as written.
    fn table(&mut self, path: &[&str], table: &Table, given: Option<&Table>) {
        let mut entries: Vec<(&String, &Value)> = table.iter().collect();
        if path.is_empty() {
            // Entries in reading order, which is that of the types.
            entries.sort_by_key(|(name, _)| self.keys.iter().position(|entry| entry.key == **name));
        }
        let (tables, values): (Vec<_>, Vec<_>) = entries.into_iter().partition(|(_, value)| is_of_tables(value));
        for (name, value) in values {
            let mark = if given.is_some_and(|given| given.contains_key(name)) { "" } else { "  # default" };
            self.text += &format!("{} = {value}{mark}\n", written(name));
        }
        self.left_out(path, table);
        for (name, value) in tables {
            let path = [path, &[name.as_str()]].concat();
            let heading = path.iter().map(|name| written(name)).collect::<Vec<_>>().join(".");
            let given = given.and_then(|given| given.get(name));
            match value {
                Value::Array(items) => {
                    for (index, item) in items.iter().enumerate() {
                        self.text += &format!("\n[[{heading}]]\n");
                        let given = given.and_then(|given| given.get(index)).and_then(Value::as_table);
                        self.table(&path, item.as_table().expect("a list of tables"), given);
                    }
                }
                _ => {
                    let below = value.as_table().expect("a table");
                    let says_nothing = given.is_none() && below.is_empty();
                    let only_leads_on = !below.is_empty() && below.values().all(Value::is_table);
                    if !says_nothing && !only_leads_on {
                        self.text += &format!("\n[{heading}]{}\n", if given.is_none() { "  # default" } else { "" });
                    }
                    self.table(&path, below, given.and_then(Value::as_table));
                }
            }
        }
    }

    /// Writes comments for missing keys without a default.
    fn left_out(&mut self, path: &[&str], table: &Table) {
        let path = path
            .split_first()
            .filter(|(first, _)| ["validation", "also"].contains(first))
            .map_or(path, |(_, below)| below)
            .join(".");
        for ScenarioKey { key, unit, default, meaning } in &self.keys {
            let name = key.strip_prefix(&path).and_then(|tail| tail.strip_prefix('.'));
            let Some(name) = name.filter(|name| !name.contains('.') && !table.contains_key(*name)) else { continue };
            if *default == KeyDefault::Nothing && unit != "table" {
                self.text += &format!("# {name} is left out: {meaning}\n");
            }
        }
    }
}

fn is_of_tables(value: &Value) -> bool {
    match value {
        Value::Table(_) => true,
        Value::Array(items) => !items.is_empty() && items.iter().all(Value::is_table),
        _ => false,
    }
}

/// Key in TOML notation: bare if its characters allow it, otherwise quoted.
fn written(name: &str) -> String {
    let bare = |letter: char| letter.is_ascii_alphanumeric() || letter == '-' || letter == '_';
    if !name.is_empty() && name.chars().all(bare) {
        name.to_owned()
    } else {
        Value::String(name.to_owned()).to_string()
    }
}

#[cfg(test)]
mod tests {
    use simulate::{Assumption, Simulation};

    use crate::testing::scenario;

    const BARE: &str = "
question = \"One line,\\nand another?\"
seed = 3
[ship.first-order]
K-per-s = 0.1
T-s = 16.3
[manoeuvre.zig-zag]
rudder-deg = 10
heading-deg = 10
[recording]
sampling-s = 1.0
duration-s = 100.0
[validation.manoeuvre.turning-circle]
rudder-deg = 25.0
duration-s = 100.0
[[identifier]]
method.srivc = {}
[[sweep]]
name = \"rate\"
points = [{ label = \"none\", set = {} }, { label = \"2.5\", set = { \"steering-gear.rate-deg-s\" = 2.5 } }]
";

    #[test]
    fn a_resolved_scenario_is_the_same_scenario_and_marks_its_defaults() {
        let bare = scenario(BARE);
        let text = bare.resolved();
        for line in [
            "replicates = 1  # default",
            "rudder-bias-deg = 0.0  # default",
            "rate-deg-s = inf  # default",
            "maximum-deg = 90.0  # default",
            "heading-noise-deg = 0.0  # default",
            "label = \"srivc\"  # default",
            "rudder-deg = 10.0",
            "\"steering-gear.rate-deg-s\" = 2.5",
            "[sensor.drop-out]  # default",
            "# executes is left out: Number of the execute that ends the manoeuvre, or `duration-s`; left out, the end of the \
             record is its end.",
        ] {
            assert!(text.lines().any(|resolved_line| resolved_line == line), "{line}\n{text}");
        }
        let again = scenario(&text);
        for (left, right) in bare.cells.iter().zip(&again.cells) {
            let key = simulate::StreamKey { seed: 3, cell: 0, replicate: 0 };
            let [left, right] =
                [left, right].map(|cell| cell.trial_spec(&key).expect("nothing is drawn").specification);
            // An omitted rate and an infinite rate move the rudder alike; only the omitted one gives a warning.
            let same = |simulation: &Simulation| {
                let mut simulation = simulation.clone();
                simulation.gear.rudder_rate = Some(simulation.gear.largest_rate());
                format!("{simulation:?}")
            };
            assert_eq!(same(&left.simulation), same(&right.simulation));
            assert_eq!(left.validation.as_ref().map(same), right.validation.as_ref().map(same));
        }
        assert_eq!(again.resolved().replace("  # default", ""), text.replace("  # default", ""));
    }

    #[test]
    fn defaults_that_matter_are_told_for_the_cells_that_have_them() {
        let defaults = |text: &str| scenario(text).influential_defaults();
        let bare = defaults(BARE);
        assert_eq!(bare.iter().map(|(assumption, _)| *assumption).collect::<Vec<_>>(), Assumption::ALL);
        assert!(bare[0].1.starts_with("in 1 of 2 cells the rudder moves instantly, because"), "{}", bare[0].1);
        assert!(bare[1].1.starts_with("every order is given"), "{}", bare[1].1);
        let with = |text: &str| defaults(&format!("{BARE}{text}"));
        assert_eq!(with("[steering-gear]\nrate-deg-s = inf").len(), 2, "an infinite rate is meant");
        assert_eq!(with("[helmsman]\nreaction-time-s = 0.5\n[sensor]\nheading-quantum-deg = 0.1").len(), 1);
        let hull = |id: &str| BARE.replace("first-order", id).replace("K-per-s = 0.1\nT-s = 16.3\n", "");
        for ship in ship::ships::all_ships().into_iter().filter(|ship| ship.rudder_rate.is_some()) {
            let assumptions = defaults(&hull(&ship.id));
            assert!(assumptions.iter().all(|(assumption, _)| *assumption != Assumption::InstantRudder), "{}", ship.id);
        }
    }
}
