//! A table from its first line to its columns.

use std::path::Path;

use super::assemble::on_plane;
use super::error::ReadError;
use super::head::{self, Found};
use super::input::Text;
use super::layout::Layout;
use super::lines::Lines;
use super::rows::Rows;
use super::source::Piece;
use super::units;
use crate::cells::Separator;
use crate::cleaning;
use crate::encoding::Encoding;
use crate::sidecar::Sidecar;
use crate::words::listed;

/// Reads a table; `whole` says whether it has to hold a whole record.
pub(super) fn read(
    path: &Path,
    input: Text,
    size: Option<u64>,
    sidecar: Option<&Sidecar>,
    whole: bool,
) -> Result<Piece, ReadError> {
    let fault = |problem| ReadError::table(path, problem);
    // What was written here has tabs between its cells and is UTF-8, whatever is said of other files.
    let declared = sidecar.filter(|_| !input.is_made);
    let separator = if input.is_made { Some(Separator::Tab) } else { declared.and_then(|sidecar| sidecar.separator) };
    let mut lines = Lines::new(input.bytes, declared.map_or(Encoding::Utf8, |sidecar| sidecar.encoding));
    let Found { head, rows: pending, passed } = head::find(&mut lines, separator, sidecar).map_err(fault)?;
    let separator = head.separator;
    let layout = Layout::new(head, path, sidecar, whole)?;
    let mut rows = Rows::new(&layout, separator, sidecar);
    for (number, text) in pending {
        rows.add(&text, number).map_err(fault)?;
    }
    loop {
        // The number is taken after the line is read, and the line borrows the source: hence the detour over `number`.
        let number = lines.number() + 1;
        let consumed = lines.consumed();
        match lines.next_line().map_err(fault)? {
            Some(text) => rows.add(text, number).map_err(fault)?,
            None => break,
        }
        if rows.kept() > rows.limit() || rows.will_be_too_many(consumed, size) {
            return Err(fault(rows.too_many(consumed, size)));
        }
    }
    let sha256 = lines.sha256();
    let (mut kept, found) = rows.finish().map_err(fault)?;
    let mut warnings = Vec::new();
    if passed > 0 {
        warnings.push(format!("{passed} lines before the header passed over"));
    }
    if let Some(position) = kept.position.take().and_then(on_plane) {
        for (channel, values) in position {
            kept.columns.channels.entry(channel).or_insert(values);
        }
    }
    let decided = units::settle(&mut kept, layout.line).map_err(fault)?;
    if !layout.understood.is_empty() {
        let names: Vec<String> = layout.understood.iter().map(|&place| layout.names[place].clone()).collect();
        warnings.push(format!("columns understood by their names: {}", listed(&names)));
    }
    warnings.extend(decided);
    warnings.extend(found);
    let mut marks = Vec::new();
    if sidecar.is_none_or(|sidecar| sidecar.plausibility) {
        warnings.extend(cleaning::clean(&mut kept.columns, &mut marks));
    }
    Ok(Piece { columns: kept.columns, clock: kept.clock, warnings, marks, rows: kept.rows, sha256 })
}
