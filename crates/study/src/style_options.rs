//! Style of figures: options of the command line, and a style file.

use std::path::{Path, PathBuf};

use campaign::failure::Failure;
use clap::{Args, ValueEnum};
use report::Theme;
use report::theme::{DPI_RANGE, WIDTH_RANGE_MM};
use trial::file::{FileKind, read_text};

/// Style of figures.
#[derive(Debug, Clone, Args)]
pub struct FigureOptions {
    /// Draw figures for print, MM millimetres wide [default: for a screen]
    #[arg(long, value_name = "MM", value_parser = within(WIDTH_RANGE_MM), allow_hyphen_values = true)]
    pub paper: Option<f64>,
    /// Resolution of figures for print
    #[arg(long, value_name = "DPI", default_value_t = 600.0, requires = "paper", value_parser = within(DPI_RANGE), allow_hyphen_values = true)]
    pub dpi: f64,
    /// Sizes, colours and limits of axes of the figures; `study schema style` has all keys
    #[arg(long, value_name = "FILE.toml")]
    pub style: Option<PathBuf>,
}

/// Style and selection of the figures of a page.
#[derive(Debug, Clone, Args)]
pub struct PageFigureOptions {
    /// How the figures are drawn
    #[command(flatten)]
    pub style: FigureOptions,
    /// Which figures are made; the document, the curves and the text of the page are always written
    #[arg(long, value_enum, value_name = "WHICH", default_value_t = PageFigures::All)]
    pub figures: PageFigures,
}

/// Selection of the figures of a page.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum PageFigures {
    /// All there are
    All,
    /// None
    None,
}

impl PageFigureOptions {
    /// Theme of the figures; `None` if no figures are made. Fails as [`FigureOptions::theme`] does.
    pub fn theme(&self) -> Result<Option<Theme>, Failure> {
        let theme = self.style.theme()?;
        Ok((self.figures == PageFigures::All).then_some(theme))
    }
}

/// Style and selection of the figures of a study.
#[derive(Debug, Clone, Args)]
pub struct StudyFigureOptions {
    /// How the figures are drawn
    #[command(flatten)]
    pub style: FigureOptions,
    /// Which figures are made
    #[arg(long, value_enum, value_name = "WHICH", default_value_t = FigureChoice::Named)]
    pub figures: FigureChoice,
}

/// Selection of the figures of a study.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, ValueEnum)]
pub enum FigureChoice {
    /// Those that `output.figures` of the scenario names; all figures if it names none
    #[default]
    Named,
    /// All there are
    All,
    /// The key figure of the study, `output.figure`
    #[value(name = "hero")]
    Key,
    /// None
    None,
}

/// Parser of a number from `least` to `most`.
pub(crate) fn within([least, most]: [f64; 2]) -> impl Fn(&str) -> Result<f64, String> + Clone + Send + Sync + 'static {
    move |text| {
        let number = text.parse().ok().filter(|number| (least..=most).contains(number));
        number.ok_or_else(|| format!("expected a number from {least} to {most}"))
    }
}

impl FigureOptions {
    /// Theme of the figures; the command line overrides the file.
    ///
    /// Fails if a width or resolution is out of range, or if the file cannot be read.
    pub fn theme(&self) -> Result<Theme, Failure> {
        let file = self.style.as_deref();
        let style = file.map(style_of).transpose()?.unwrap_or_default();
        let named = |error: String| match file {
            Some(file) => Failure::in_file(file, error),
            None => Failure::input(error),
        };
        let printed = self.paper.map(|width_mm| (width_mm, self.dpi));
        let printed = printed.or_else(|| Some((style.width_mm?, style.dpi.unwrap_or(self.dpi))));
        let theme = match printed {
            None => Theme::screen(),
            Some((width_mm, dpi)) => Theme::paper(width_mm, dpi).map_err(|error| named(error.to_string()))?,
        };
        let style = report::Style { dpi: style.dpi.filter(|_| self.paper.is_none()), ..style };
        style.apply_to(theme).map_err(|error| named(error.to_string()))
    }
}

const STYLE: FileKind = FileKind { name: "a style", max_bytes: 1 << 20 };

/// Style read from its file.
fn style_of(path: &Path) -> Result<report::Style, Failure> {
    let text = read_text(path, STYLE).map_err(|error| Failure::in_file(path, error))?;
    toml::from_str(&text).map_err(|error| Failure::in_file(path, error.to_string().trim_end().to_owned()))
}

#[cfg(test)]
mod tests {
    use std::fs;

    use super::*;

    fn theme(file: &Path) -> Result<Theme, Failure> {
        FigureOptions { paper: None, dpi: 600.0, style: Some(file.to_owned()) }.theme()
    }

    #[test]
    fn the_sample_of_a_style_can_be_used() {
        theme(Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs/src/reference/style.toml"))).expect("a style");
    }

    #[test]
    fn a_wrong_style_is_refused_with_its_file_and_key() {
        let dir = tempfile::tempdir().expect("a folder");
        let path = dir.path().join("own.toml");
        for (text, message) in [
            ("colour = 1", "unknown field `colour`, expected one of `width-mm`, `dpi`"),
            ("width-mm = 3", "3 mm"),
            ("dpi = 10", "dpi = 10: expected a number from 72 to 1200"),
            ("[colours]\nink = \"black\"", "[colours] ink = \"black\": expected"),
        ] {
            fs::write(&path, text).expect("written");
            let error = theme(&path).expect_err("refused").to_string();
            assert!(error.contains("own.toml") && error.contains(message), "{error}");
        }
        fs::write(&path, "#".repeat((1 << 20) + 1)).expect("written");
        let error = theme(&path).expect_err("refused").to_string();
        assert!(error.contains("own.toml") && error.contains("a style has at most 1048576"), "{error}");
    }
}
