//! Figures of a benchmark: scores over those of the reference.

use campaign::benchmark::BenchDocument;
use campaign::benchmark::board::Board;
use campaign::disk;
use campaign::folder::ResultFolder;
use report::figures::{Dot, DotColumn, DotPlot, Reference95, Scale, dots};
use report::{Origin, Theme};
use scenario::failure::{Failure, OnPath};

use super::picture::{slug, write_figure};

/// A score over that of the reference beyond which an arrow stands for it.
const FAR: f64 = 100.0;

/// Beginning of the names of the figures, and of those that an earlier version drew beside them.
const RATIOS: &str = "ratios";
const FORMER: &str = "scores";

/// Removes what an earlier run may have drawn.
pub fn remove(folder: &ResultFolder) -> Result<(), Failure> {
    for name in disk::names(folder.path()).on("list the folder", folder.path())? {
        let is_figure = [FORMER, RATIOS].iter().any(|stem| name.starts_with(&format!("{stem}-")));
        if is_figure && [".svg", ".png"].iter().any(|kind| name.ends_with(kind)) {
            let path = folder.path().join(name);
            disk::remove(&path).on("remove", &path)?;
        }
    }
    Ok(())
}

/// The stem of the figure of a field.
pub fn of_field(field: &str) -> String {
    format!("{RATIOS}-{}", slug(field))
}

/// Draws them, and returns stems and captions.
pub fn draw(results: &BenchDocument, theme: &Theme, folder: &ResultFolder) -> Result<Vec<(String, String)>, Failure> {
    let mut drawn = Vec::new();
    for field in results.fields() {
        let Some(data) = ratios(results, field) else { continue };
        write_figure(&dots(&data, theme), folder, &of_field(field))?;
        let caption = format!(
            "{}: median of the score over that of {} in the same case, with 95 % intervals where there are six independent \
             records or more. Left of the line a method is better. An arrow: more than {FAR} times, or no answer in half of \
             the cases.",
            capital(field),
            results.reference
        );
        drawn.push((of_field(field), caption));
    }
    Ok(drawn)
}

/// A sentence that begins with a capital.
pub fn capital(words: &str) -> String {
    let mut letters = words.chars();
    letters.next().map_or_else(String::new, |first| first.to_uppercase().chain(letters).collect())
}

fn origin(method: &str) -> Origin {
    match method {
        // The floor is no method: grey.
        campaign::benchmark::method::STRAIGHT_ON => Origin::Series { label: method.to_owned(), number: 2 },
        campaign::benchmark::method::TRACE_OF_HEADING => {
            Origin::Variant { label: method.to_owned(), method: scenario::TRACE.to_owned(), number: 0 }
        }
        method => Origin::Method(method.to_owned()),
    }
}

fn ratios(results: &BenchDocument, field: &str) -> Option<DotPlot> {
    let boards: Vec<_> = results.boards.iter().filter(|board| board.field == field).collect();
    let others: Vec<&String> = results.methods.iter().filter(|method| **method != results.reference).collect();
    let has_ratios = boards.iter().flat_map(|board| &board.standings).any(|standing| standing.ratio.is_some());
    if others.is_empty() || !has_ratios {
        return None;
    }
    let column = |board: &&Board| {
        let row = |method: &&String| {
            let standing = board.standings.iter().find(|standing| standing.method == **method);
            let Some(ratio) = standing.and_then(|standing| standing.ratio) else { return Vec::new() };
            let far = |value: Option<f64>| value.unwrap_or(f64::MAX).max(f64::MIN_POSITIVE);
            let interval = ratio.ci95.map(|ends| ends.map(far)).filter(|_| ratio.value.is_some());
            vec![Dot { origin: origin(method), x: far(ratio.value), interval, hollow: false }]
        };
        DotColumn {
            x_title: board.task.id().to_owned(),
            scale: Scale::Log,
            reference: Some(Reference95 { value: 1.0, band: [1.0; 2] }),
            limit: Some(FAR),
            rows: others.iter().map(row).collect(),
        }
    };
    Some(DotPlot {
        title: None,
        names: others.iter().map(|method| (*method).clone()).collect(),
        columns: boards.iter().map(column).collect(),
        rows_are_methods: true,
        quiet: Vec::new(),
        note: Some(format!("Score over that of {} in the same case.", results.reference)),
    })
}
