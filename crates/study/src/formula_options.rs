//! Effects as lines of text, on the command line and in a file.

use std::path::Path;
use std::sync::Arc;

use ship::effects::Formula;
use toml::Spanned;
use trial::file::{Kind, read_text};

/// The effects of a file.
#[derive(Debug, Clone)]
pub struct Formulas(Vec<Arc<Formula>>);

impl Formulas {
    /// All of them.
    pub fn all(&self) -> &[Arc<Formula>] {
        &self.0
    }
}

/// Reads one.
pub fn formula(line: &str) -> Result<Arc<Formula>, String> {
    ship::effects::formula(line).map_err(|error| error.to_string())
}

/// Reads those of a file.
pub fn formulas(path: &str) -> Result<Formulas, String> {
    const FILE: Kind = Kind { name: "a file of effects", largest: 1 << 20 };
    let text = read_text(Path::new(path), FILE).map_err(|error| error.to_string())?;
    let file: EffectFile = toml::from_str(&text).map_err(|error| error.to_string().trim_end().to_owned())?;
    let read = |own: &Spanned<String>| {
        let line = || text[..own.span().start].matches('\n').count() + 1;
        ship::effects::formula(own.get_ref()).map_err(|error| format!("line {}: {error}", line()))
    };
    file.effects.iter().map(read).collect::<Result<_, _>>().map(Formulas)
}

/// What a file of effects holds.
#[derive(serde::Deserialize)]
#[serde(deny_unknown_fields)]
struct EffectFile {
    effects: Vec<Spanned<String>>,
}
