//! Ship, day and draughts of the trials, below the title of a report.

use document::TrialParticularsEntry;
use report::number::{MISSING, optional};
use report::{Table, TableHead};

/// A row for every record, and one for all where they say the same; `None` if nothing is known.
pub fn particulars<'a>(records: impl Iterator<Item = (String, &'a TrialParticularsEntry)>) -> Option<Table> {
    let records: Vec<(String, &TrialParticularsEntry)> = records.collect();
    let (_, first) = records.first()?;
    if records.iter().all(|(_, entry)| entry.is_empty()) {
        return None;
    }
    let is_common = records.iter().all(|(_, entry)| entry == first);
    let head = if is_common { TableHead::default() } else { TableHead::default().texts(["record"]) };
    let head = head.texts(["ship", "date of the trial"]);
    let mut table = Table::new(head.numbers(["draught fore", "draught aft", "mean draught"]).unit("m"));
    for (name, entry) in if is_common { &records[..1] } else { &records } {
        let name = (!is_common).then(|| name.clone());
        let texts = [&entry.ship_name, &entry.date].map(|text| text.clone().unwrap_or_else(|| MISSING.to_owned()));
        let draughts = [entry.draught_fore_m, entry.draught_aft_m, entry.draught_m].map(|draught| optional(draught, 2));
        table.push(name.into_iter().chain(texts).chain(draughts));
    }
    Some(table)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn records_of_one_trial_are_one_row() {
        let known = TrialParticularsEntry { ship_name: Some("Kempf".into()), ..TrialParticularsEntry::default() };
        let unknown = TrialParticularsEntry::default();
        let rows = |entries: [&TrialParticularsEntry; 2]| {
            let named = entries.into_iter().map(|entry| (String::from("run"), entry));
            particulars(named).map(|table| table.to_text().lines().count())
        };
        assert_eq!([rows([&known; 2]), rows([&unknown; 2])], [Some(3), None]);
        assert_eq!(rows([&known, &unknown]), Some(4));
    }
}
