//! `study report DIR`: tables and figures of a finished study, from what is stored and nothing else.

use std::path::Path;

use campaign::folder::ResultFolder;
use campaign::store::{self, Stored};
use scenario::failure::Failure;

use crate::options::{Common, StudyStyle};
use crate::views::publish::publish;

/// Makes tables, figures and `report.md` of a finished study where its rows are, or in `--out`.
pub fn run(rows: &Path, style: &StudyStyle, common: &Common) -> Result<(), Failure> {
    let theme = style.style.theme()?;
    let is_same =
        |out: &Path| out.canonicalize().ok().zip(rows.canonicalize().ok()).is_some_and(|(out, rows)| out == rows);
    match common.out.as_deref().filter(|out| !is_same(out)) {
        Some(out) => {
            let stored = Stored::read(rows)?;
            publish(&stored, &ResultFolder::hold(out)?, (&theme, style.figures), common)
        }
        None => {
            store::is_finished(rows)?;
            let folder = ResultFolder::hold(rows)?;
            publish(&Stored::held(&folder)?, &folder, (&theme, style.figures), common)
        }
    }
}
