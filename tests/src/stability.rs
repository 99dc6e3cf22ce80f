//! The same effects in several records of one hull, each traced alone: does a coefficient stay what it is?

use std::collections::BTreeMap;

use document::trace::ParameterEntry;
use report::number::{MISSING, uncertain};
use report::{Table, TableHead};
use trace::Document;

/// Identifier and form.
type Effect = (String, String);

/// A coefficient with its standard deviation, without dimension where it can be, and its unit.
fn coefficient(entry: &ParameterEntry) -> (String, &str) {
    let (quantity, unit) = match &entry.prime {
        Some(prime) => (prime.quantity, prime.unit.as_str()),
        None => (entry.quantity, entry.unit.as_str()),
    };
    (uncertain(quantity.value, quantity.sd), unit)
}

/// Every effect that is named in one of the records alone: how often, and its coefficients record by record.
pub fn table(alone: &[(&str, &Document)]) -> Table {
    let head = TableHead::default().texts(["effect", "coefficient"]).counts(["named in"]);
    let mut table = Table::new(head.texts(alone.iter().map(|(record, _)| *record)));
    let own = |(_, document): &'_ (_, &Document)| -> BTreeMap<Effect, BTreeMap<String, ParameterEntry>> {
        let effects = document.effects.iter();
        effects.map(|effect| ((effect.id.clone(), effect.form.clone()), effect.parameters.clone())).collect()
    };
    let named: Vec<_> = alone.iter().map(own).collect();
    let mut rows: BTreeMap<(&Effect, &str), &str> = BTreeMap::new();
    for (effect, parameters) in named.iter().flatten() {
        for (symbol, entry) in parameters.iter().filter(|(_, entry)| entry.quantity.sd.is_some()) {
            rows.insert((effect, symbol), coefficient(entry).1);
        }
    }
    for ((effect, symbol), unit) in rows {
        let count = named.iter().filter(|one| one.contains_key(effect)).count();
        let mut row = vec![
            format!("{} ({})", effect.0, effect.1),
            if unit == "1" { symbol.to_owned() } else { format!("{symbol} [{unit}]") },
            format!("{count} of {}", named.len()),
        ];
        row.extend(named.iter().map(|one| {
            let entry = one.get(effect).and_then(|parameters| parameters.get(symbol));
            entry.map_or_else(|| MISSING.to_owned(), |entry| coefficient(entry).0)
        }));
        table.push(row);
    }
    table
}
