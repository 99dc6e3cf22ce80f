//! The form for reporting manoeuvring data to IMO (MSC/Circ.1053, appendix 6) as a page.

use campaign::statistics::grouped;
use predict::form::{DECIMALS, ImoFormEntry, STOPPING, TRACK_REACH_LENGTHS};
use predict::interval::PredictionInterval;
use report::markdown::text;
use report::number::{fixed, significant};
use report::{Page, Table, TableHead};

use super::bench_figures::capital;

/// What stands for an entry that nobody can fill in.
const EMPTY: &str = "–";

/// A value as it is filled in, without its unit. Numbers of one side are results, others are declared.
fn filled(entry: &ImoFormEntry) -> String {
    if let (Some(median), Some(ci90)) = (entry.median, entry.ci90) {
        return fixed(median, PredictionInterval { median, ci50: ci90, ci90 }.decimals().min(DECIMALS));
    }
    match entry.value.as_ref().map(|value| value.as_f64().ok_or(value)) {
        // As many decimals of a measured result as its standard deviation supports.
        Some(Ok(number)) if entry.side.is_some() => {
            let supported = |sd: f64| ((-sd.log10()).ceil().max(0.0) as usize).min(DECIMALS);
            fixed(number, entry.sd.filter(|sd| *sd > 0.0).map_or(DECIMALS, supported))
        }
        Some(Ok(number)) => significant(number, if number.fract() == 0.0 { 1 } else { 3 }),
        Some(Err(words)) => words.as_str().unwrap_or_default().to_owned(),
        None => EMPTY.to_owned(),
    }
}

/// The page of the form.
pub fn page(entries: &[ImoFormEntry], remarks: &[String]) -> Page {
    let mut page = Page::titled("Form for reporting manoeuvring data to IMO");
    page.say(
        "MSC/Circ.1053 (2002), appendix 6; criteria of resolution MSC.137(76). Every entry names its source; what is predicted \
         is no trial.",
    );
    let sections = grouped(entries, |entry| entry.section.as_str()).into_iter();
    let is_declared = |(section, own): &(&str, Vec<&ImoFormEntry>)| {
        own.iter().all(|entry| entry.side.is_none()) && *section != STOPPING
    };
    let (declared, tested): (Vec<_>, Vec<_>) = sections.partition(is_declared);
    for (section, own) in declared {
        if !section.is_empty() {
            page.part(capital(section));
        }
        let mut table = Table::new(TableHead::default().texts(["entry", "value", "unit", "source"]));
        for entry in own {
            table.push([entry.field.clone(), filled(entry), unit(entry).to_owned(), entry.source.clone()]);
        }
        page.table(table);
    }
    page.part("Test results");
    let mut table =
        Table::new(TableHead::default().texts(["test", "result", "side", "value", "unit", "IMO criterion", "source"]));
    for entry in tested.into_iter().flat_map(|(_, own)| own) {
        table.push([
            entry.section.clone(),
            entry.field.clone(),
            entry.side.clone().unwrap_or_default(),
            filled(entry),
            unit(entry).to_owned(),
            criterion(entry),
            entry.source.clone(),
        ]);
    }
    page.table(table);
    page.part("Remarks");
    page.list(remarks.iter().map(|remark| text(remark)));
    page.say(if remarks.is_empty() { "None." } else { "" });
    page
}

fn criterion(entry: &ImoFormEntry) -> String {
    match entry.limit {
        Some(TRACK_REACH_LENGTHS) if entry.section == STOPPING => {
            String::from("≤ 15, up to 20 where the Administration allows")
        }
        Some(limit) => format!("≤ {}", fixed(limit, 1)),
        None => String::from("depends on L/V, which is not known"),
    }
}

fn unit(entry: &ImoFormEntry) -> &str {
    if entry.unit == "1" { "" } else { &entry.unit }
}
