//! What a trace said of every ship, as a map.

use campaign::statistics::share;
use report::PageFigure;
use report::figures::{CellMap, MapCell, Outline, Plot, Shades};

use super::Outcome;
use super::judged::Judgement;
use super::truths::{Kind, Truth};

/// What was said, in the order of the columns.
const SAID: [(&str, Judgement); 8] = [
    ("named right", Judgement::Right),
    ("located right", Judgement::Located),
    ("unexplained", Judgement::Unexplained),
    ("disturbed", Judgement::Disturbed),
    ("clean", Judgement::Clean),
    ("alias", Judgement::Alias),
    ("located elsewhere", Judgement::Elsewhere),
    ("wrong", Judgement::Wrong),
];

/// A row for every ship, a column for everything that was said.
pub fn outcomes(truths: &[Truth], outcomes: &[Outcome]) -> PageFigure {
    let of_ship = |ship| outcomes.iter().filter(move |own| own.ship == ship);
    let cell = |ship: usize, said: Judgement| {
        let count = of_ship(ship).filter(|own| own.judgement == said).count();
        let share = share(count as u64, of_ship(ship).count() as u64).map(|own| own.times(100.0));
        MapCell {
            value: share.map(|own| own.value),
            interval: share.and_then(|own| own.ci95),
            outline: said.is_right(&truths[ship].kind).then_some(Outline::Right),
        }
    };
    let cells = (0..truths.len()).map(|ship| SAID.iter().map(|(_, said)| cell(ship, *said)).collect());
    let right = |is_of: fn(&Kind) -> bool| {
        let own = outcomes.iter().filter(|own| is_of(&truths[own.ship].kind));
        let judged: Vec<bool> = own.map(|own| own.judgement.is_right(&truths[own.ship].kind)).collect();
        format!("right in {} of {}", judged.iter().filter(|own| **own).count(), judged.len())
    };
    let listed = right(|kind| matches!(kind, Kind::Listed { .. }));
    let unlisted = right(|kind| matches!(kind, Kind::Unlisted { .. }));
    let map = CellMap {
        title: Some(format!("Known effects in other formulas: {listed} trials; unknown effects: {unlisted}")),
        titles: [String::from("said by the trace"), String::from("truth")],
        columns: SAID.iter().map(|(words, _)| (*words).to_owned()).collect(),
        rows: (truths.iter())
            .map(|truth| {
                let kind = match truth.kind {
                    Kind::Listed { .. } => "known",
                    Kind::Unlisted { .. } => "unknown",
                    Kind::Nothing { .. } => "nothing missing",
                };
                format!("{kind}: {}", truth.name).replace(" %", "\u{a0}%")
            })
            .collect(),
        shades: Shades::Shares,
        panels: vec![(None, cells.collect())],
        note: Some(String::from(
            "Shares of the trials of a row in per cent. Known: on the list of effects, in another formula. Unknown: on \
             no list. Alias: not to be told from the truth. Elsewhere: by another dependence, or at another time.",
        )),
    };
    let caption = "What was said of every ship, both noises together, with 95 % intervals (Wilson). Wrong is a name \
                   that is not right, and of a ship that lacks nothing also a located moment.";
    PageFigure::new("outcomes", caption, Plot::Cells(map))
}
