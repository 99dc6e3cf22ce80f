//! `study find`: the manoeuvres inside long logs.

use find::{Kind, Manoeuvre};
use report::number::{MISSING, fixed};
use report::{Column, Table};
use ship::angle::to_deg;
use trial::Log;

use crate::options::{Common, FindRequest, Format};
use crate::records::{expand, manoeuvres, open};
use crate::screen;
use scenario::failure::Failure;

/// Prints the manoeuvres of every log.
///
/// Fails when a log cannot be read.
pub fn run(request: &FindRequest, common: &Common) -> Result<(), Failure> {
    let files = expand(&request.logs)?;
    if files.len() > 1 && !request.with_columns.is_empty() {
        return Err(Failure::input(format!("--with-columns is for one log, {} are given; give one", files.len())));
    }
    let mut warnings = Vec::new();
    for file in &files {
        let log = open(file, request.columns.as_deref(), &request.with_columns, &mut warnings)?;
        let found = manoeuvres(&log);
        let table = common.format.render(&table(&log, &found));
        if common.format != Format::Text {
            screen::say(table.trim_end())?;
            continue;
        }
        let time = log.time();
        let duration = time.last().zip(time.first()).map_or(0.0, |(last, first)| last - first);
        let day = log.clock().and_then(|clock| clock.date_at(time[0])).map(|day| format!(", {day}"));
        let head =
            format!("{}: {} rows, {} s{}", file.display(), time.len(), fixed(duration, 1), day.unwrap_or_default());
        if found.is_empty() {
            screen::say(&format!("{head}\nno manoeuvre found\n"))?;
            continue;
        }
        let remarks: String = (1..)
            .zip(&found)
            .filter(|(_, one)| !one.quality.remarks().is_empty())
            .map(|(number, one)| format!("{number}: {}\n", one.quality.remarks().join(" ")))
            .collect();
        screen::say(&format!("{head}\n\n{table}\n{remarks}"))?;
    }
    for warning in warnings {
        screen::warn(&format!("warning: {warning}"));
    }
    Ok(())
}

fn table(log: &Log, found: &[Manoeuvre]) -> Table {
    let mut table = Table::new([
        Column::decimal("--trial"),
        Column::left("manoeuvre"),
        Column::decimal("from").unit("s"),
        Column::decimal("until").unit("s"),
        Column::left("clock"),
        Column::decimal("executes"),
        Column::decimal("rudder").unit("deg"),
        Column::decimal("heading").unit("deg"),
    ]);
    for (number, one) in (1..).zip(found) {
        let clock = log.clock().map(|clock| format!("{} to {}", clock.at(one.from), clock.at(one.until)));
        let angle = |angle: f64| fixed(to_deg(angle), 1);
        let missing = || MISSING.to_owned();
        let (rudder, heading) = match one.kind {
            Kind::ZigZag { rudder, heading } => (angle(rudder), angle(heading)),
            Kind::TurningCircle { rudder, turned } => (angle(rudder), angle(turned)),
            Kind::PullOut { rudder } => (angle(rudder), missing()),
            Kind::Spiral { largest, .. } => (angle(largest), missing()),
            _ => (missing(), missing()),
        };
        table.push([
            number.to_string(),
            one.kind.name(),
            fixed(one.from, 1),
            fixed(one.until, 1),
            clock.unwrap_or_else(missing),
            one.executes.to_string(),
            rudder,
            heading,
        ]);
    }
    table
}
