//! Ship, date and draughts of the trials, below the title of a report.

use document::TrialParticularsEntry;
use report::number::{MISSING, significant};
use report::{Table, TableHead};

/// One row for every record, or one for all records with equal particulars; `None` if no particular is known.
pub fn particulars_table<'a>(records: impl Iterator<Item = (String, &'a TrialParticularsEntry)>) -> Option<Table> {
    let records: Vec<(String, &TrialParticularsEntry)> = records.collect();
    let (_, first) = records.first()?;
    if records.iter().all(|(_, entry)| entry.is_empty()) {
        return None;
    }
    let is_common = records.iter().all(|(_, entry)| entry == first);
    let head = if is_common { TableHead::default() } else { TableHead::default().texts(["record"]) };
    let texts = declared(&records, &TEXTS);
    let draughts = declared(&records, &DRAUGHTS);
    let head = head.texts(texts.iter().map(|(heading, _)| *heading));
    let mut table = Table::new(head.numbers(draughts.iter().map(|(heading, _)| *heading)).unit("m"));
    for (name, entry) in if is_common { &records[..1] } else { &records } {
        let name = (!is_common).then(|| name.clone());
        let cells = texts.iter().chain(&draughts).map(|(_, cell)| cell(entry).unwrap_or_else(|| MISSING.to_owned()));
        table.push(name.into_iter().chain(cells));
    }
    Some(table)
}

/// Column: its heading, and its cell for one record, `None` if undeclared.
type ParticularsColumn = (&'static str, fn(&TrialParticularsEntry) -> Option<String>);

/// Columns of texts.
const TEXTS: [ParticularsColumn; 2] =
    [("ship", |entry| entry.ship_name.clone()), ("date of the trial", |entry| entry.date.clone())];

/// Columns of draughts.
const DRAUGHTS: [ParticularsColumn; 3] = [
    ("draught fore", |entry| entry.draught_fore_m.map(metres)),
    ("draught aft", |entry| entry.draught_aft_m.map(metres)),
    ("mean draught", |entry| entry.draught_m.map(metres)),
];

/// Columns of particulars that have a value for at least one record.
fn declared<'a>(
    records: &[(String, &TrialParticularsEntry)],
    columns: &'a [ParticularsColumn],
) -> Vec<&'a ParticularsColumn> {
    columns.iter().filter(|(_, cell)| records.iter().any(|(_, entry)| cell(entry).is_some())).collect()
}

/// Draught, m, with three significant digits: that of a model is a few decimetres.
fn metres(draught: f64) -> String {
    significant(draught, 3)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn records_of_one_trial_are_one_row() {
        let declared = TrialParticularsEntry { ship_name: Some("Kempf".into()), ..TrialParticularsEntry::default() };
        let unknown = TrialParticularsEntry::default();
        let rows = |entries: [&TrialParticularsEntry; 2]| {
            let table = particulars_table(entries.map(|entry| (String::from("run"), entry)).into_iter());
            table.map(|table| table.to_text().lines().count())
        };
        assert_eq!([rows([&declared; 2]), rows([&unknown; 2])], [Some(3), None]);
        assert_eq!(rows([&declared, &unknown]), Some(4));
    }
}
