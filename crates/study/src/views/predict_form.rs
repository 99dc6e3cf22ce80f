//! The form for reporting manoeuvring data to IMO (MSC/Circ.1053, appendix 6) as a page.

use askama::Template;
use campaign::statistics::grouped;
use predict::form::{ImoFormEntry, MAX_DECIMALS, MAX_TRACK_REACH_LENGTHS, STOPPING_SECTION};
use predict::interval::PredictionInterval;
use report::markdown::escaped_text;
use report::number::{fixed, significant};
use report::{Page, PlacedFigures, Table, TableHead};

use super::bench_figures::capital;

/// Text of an entry without a value.
const EMPTY: &str = "–";

/// Value as it is filled in, without its unit. A number with a side is a result of a test, any other is declared.
fn filled(entry: &ImoFormEntry) -> String {
    if let (Some(median), Some(ci90)) = (entry.median, entry.ci90) {
        return fixed(median, PredictionInterval { median, ci50: ci90, ci90 }.decimals().min(MAX_DECIMALS));
    }
    match entry.value.as_ref().map(|value| value.as_f64().ok_or(value)) {
        // As many decimals of a measured result as its standard deviation supports.
        Some(Ok(number)) if entry.side.is_some() => {
            let supported = |sd: f64| ((-sd.log10()).ceil().max(0.0) as usize).min(MAX_DECIMALS);
            fixed(number, entry.sd.filter(|sd| *sd > 0.0).map_or(MAX_DECIMALS, supported))
        }
        Some(Ok(number)) => significant(number, if number.fract() == 0.0 { 1 } else { 3 }),
        Some(Err(text_value)) => text_value.as_str().unwrap_or_default().to_owned(),
        None => EMPTY.to_owned(),
    }
}

/// Template of `trial-form.md`.
#[derive(Template)]
#[template(path = "form.md", escape = "none")]
struct FormPage<'a> {
    declared: Vec<(&'a str, Table)>,
    tested: Table,
    form_remarks: &'a [String],
    mark: &'static str,
}

/// Tables of the form: declared entries under the headings of its parts, and the tests.
pub fn form_tables(entries: &[ImoFormEntry]) -> (Vec<(&str, Table)>, Table) {
    let sections = grouped(entries, |entry| entry.section.as_str()).into_iter();
    let is_declared = |(section, section_entries): &(&str, Vec<&ImoFormEntry>)| {
        section_entries.iter().all(|entry| entry.side.is_none()) && *section != STOPPING_SECTION
    };
    let (declared, measured): (Vec<_>, Vec<_>) = sections.partition(is_declared);
    let declaration = |(section, entries): (_, Vec<&ImoFormEntry>)| {
        let mut table = Table::new(TableHead::default().texts(["entry", "value", "unit", "source"]));
        for entry in entries {
            table.push([entry.field.clone(), filled(entry), unit(entry).to_owned(), entry.source.clone()]);
        }
        (section, table)
    };
    let mut tested =
        Table::new(TableHead::default().texts(["test", "result", "side", "value", "unit", "IMO criterion", "source"]));
    for entry in measured.into_iter().flat_map(|(_, section_entries)| section_entries) {
        tested.push([
            entry.section.clone(),
            entry.field.clone(),
            entry.side.clone().unwrap_or_default(),
            filled(entry),
            unit(entry).to_owned(),
            criterion(entry),
            entry.source.clone(),
        ]);
    }
    (declared.into_iter().map(declaration).collect(), tested)
}

/// Table of the measured criteria of MSC.137(76), to both sides.
pub fn form_criterion_table(entries: &[ImoFormEntry]) -> Table {
    let head = TableHead::default().texts(["test", "result"]).numbers(["to port", "to starboard"]).texts(["unit"]);
    let mut table = Table::new(head.numbers(["limit"]).texts(["kept"]));
    let tests = entries.iter().filter(|entry| entry.side.is_some());
    for ((test, result), sides) in grouped(tests, |entry| (entry.section.as_str(), entry.field.as_str())) {
        let at = |side: &str| sides.iter().find(|entry| entry.side.as_deref() == Some(side));
        let values = ["port", "starboard"].map(|side| at(side).map_or_else(|| EMPTY.to_owned(), |entry| filled(entry)));
        let limit = sides.iter().find_map(|entry| entry.limit);
        let measured: Vec<f64> = sides.iter().filter_map(|entry| entry.value.as_ref()?.as_f64()).collect();
        let kept = match limit {
            Some(limit) if !measured.is_empty() => {
                if measured.iter().all(|value| *value <= limit) {
                    "yes"
                } else {
                    "no"
                }
            }
            _ => EMPTY,
        };
        let limit = limit.map_or_else(|| EMPTY.to_owned(), |limit| fixed(limit, 1));
        let unit = sides.first().map_or("", |entry| unit(entry)).to_owned();
        let cells = [test.to_owned(), result.to_owned()].into_iter().chain(values);
        table.push(cells.chain([unit, limit, kept.to_owned()]));
    }
    table
}

/// Page of the form.
pub fn page(entries: &[ImoFormEntry], remarks: &[String]) -> Page {
    let (declared, tested) = form_tables(entries);
    Page::new(FormPage { declared, tested, form_remarks: remarks, mark: "##" }.render(), PlacedFigures::<()>::default())
}

fn criterion(entry: &ImoFormEntry) -> String {
    match entry.limit {
        Some(MAX_TRACK_REACH_LENGTHS) if entry.section == STOPPING_SECTION => {
            String::from("≤ 15, up to 20 where the Administration allows")
        }
        Some(limit) => format!("≤ {}", fixed(limit, 1)),
        None => String::from("depends on L/V, which is not known"),
    }
}

fn unit(entry: &ImoFormEntry) -> &str {
    if entry.unit == "1" { "" } else { &entry.unit }
}
