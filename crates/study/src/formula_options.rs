//! Effects given as formulas, on the command line and in a file.

use std::path::Path;
use std::sync::Arc;

use ship::effects::Formula;
use toml::Spanned;
use trial::file::{FileKind, read_text};

/// Effects of a file, `effects = ["NAME = FORMULA", …]`.
#[derive(Debug, Clone)]
pub struct Formulas(Vec<Arc<Formula>>);

impl Formulas {
    /// All effects, in the order of the file.
    pub fn all(&self) -> &[Arc<Formula>] {
        &self.0
    }
}

/// Effect read from `NAME = FORMULA`. Fails if the line is no such formula.
pub fn formula(line: &str) -> Result<Arc<Formula>, String> {
    ship::effects::parse_formula(line).map_err(|error| error.to_string())
}

/// Effects read from a file. Fails if it cannot be read, or with the line of the first invalid formula.
pub fn read_formulas(path: &str) -> Result<Formulas, String> {
    const FILE: FileKind = FileKind { name: "a file of effects", max_bytes: 1 << 20 };
    let text = read_text(Path::new(path), FILE).map_err(|error| error.to_string())?;
    let file: EffectFile = toml::from_str(&text).map_err(|error| error.to_string().trim_end().to_owned())?;
    let read = |line_text: &Spanned<String>| {
        let line = || text[..line_text.span().start].matches('\n').count() + 1;
        ship::effects::parse_formula(line_text.get_ref()).map_err(|error| format!("line {}: {error}", line()))
    };
    file.effects.iter().map(read).collect::<Result<_, _>>().map(Formulas)
}

/// File of effects as TOML.
#[derive(serde::Deserialize)]
#[serde(deny_unknown_fields)]
struct EffectFile {
    effects: Vec<Spanned<String>>,
}
