//! Sidecar: a small TOML file that describes a table with columns that are not named `quantity_unit`. The table is read
//! in [`crate::reader`].
//!
//! `NAME.trial.toml` next to `NAME.csv` (or `.dat`, `.txt`, ...) is used automatically; any other sidecar must be
//! named. [`sidecar_keys`] lists its keys; none is required.

use std::ops::{Range, RangeInclusive};
use std::path::{Path, PathBuf};

use ship::Particulars;
use ship::angle::{KNOT, from_deg};
use ship::effects::ColumnFormula;
use toml::de::{DeTable, DeValue};
use toml::{Spanned, Value};

use crate::conditions::DeclaredConditions;
use crate::file::{FileKind, read_text};
use crate::names::{ColumnMeaning, quantity_unit_meaning};
use crate::record::SensorNoise;
use crate::sidecar_error::LocatedProblem;
pub use crate::sidecar_error::{SidecarError, SidecarProblem};
use crate::sidecar_keys::{CheckKeys, ColumnKeys, PartKeys, RudderKeys, ShipKeys, SidecarKeys, TableKeys};
pub use crate::sidecar_keys::{SidecarKey, sidecar_keys, sidecar_schema};
use crate::wording::shortened;

/// Kind of file of a sidecar, at most 1 MiB; usual sidecars have up to a hundred lines.
pub const SIDECAR_FILE: FileKind = FileKind { name: "a sidecar", max_bytes: 1 << 20 };

/// Reference to a column of a table.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum ColumnReference {
    /// Index, from 0.
    Index(usize),
    /// Name in the header.
    Name(String),
    /// New column, computed from existing columns.
    Formula(ColumnFormula),
}

/// Column as described by a `[[column]]` of a sidecar, checked.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct DescribedColumn {
    pub(crate) line: usize,
    pub(crate) which: ColumnReference,
    pub(crate) meaning: Option<ColumnMeaning>,
    /// Factor of the numbers less `zero`, in the unit of `meaning`; negative for a changed sign.
    pub(crate) scale: f64,
    /// Number in the file at a value of zero.
    pub(crate) zero: f64,
    pub(crate) ignore: bool,
}

/// Sidecar, checked as far as possible without its table; the default is the empty sidecar.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Sidecar {
    pub(crate) file: PathBuf,
    pub(crate) table: TableKeys,
    pub(crate) part: PartKeys,
    pub(crate) check: CheckKeys,
    pub(crate) columns: Vec<DescribedColumn>,
    pub(crate) rudder: RudderKeys,
    pub(crate) noise: SensorNoise,
    /// Declared particulars and conditions for the form of MSC/Circ.1053.
    pub conditions: DeclaredConditions,
}

impl Sidecar {
    /// Path of the sidecar of a table: `NAME.trial.toml` next to `NAME.*`.
    pub fn path_beside(table: &Path) -> PathBuf {
        table.with_extension("trial.toml")
    }

    /// Path of the sidecar of a table; `None` if there is no such file.
    pub fn existing_beside(table: &Path) -> Option<PathBuf> {
        Some(Self::path_beside(table)).filter(|beside| beside.is_file())
    }

    /// Path of the sidecar of a table: the given file, or the file of its name in the given folder; else the file next
    /// to the table. `None` without any of these.
    pub fn path_for(table: &Path, given: Option<&Path>) -> Option<PathBuf> {
        let given = given.and_then(|given| match given.is_dir() {
            true => Self::existing_beside(&given.join(table.file_name()?)),
            false => Some(given.to_path_buf()),
        });
        given.or_else(|| Self::existing_beside(table))
    }

    /// Reads and checks a sidecar.
    ///
    /// Fails if the file cannot be read or is larger than [`SIDECAR_FILE`], and as [`parse`](Self::parse) does.
    pub fn load(file: &Path) -> Result<Self, SidecarError> {
        let text = read_text(file, SIDECAR_FILE).map_err(|error| SidecarError {
            file: file.to_path_buf(),
            line: None,
            problem: SidecarProblem::File(error),
        })?;
        Self::parse(&text, file)
    }

    /// Checks the text of a sidecar; `file` is its name in messages.
    ///
    /// Fails for text that is not TOML, unknown keys and quantities, and numbers outside their range; the error states
    /// the line.
    pub fn parse(text: &str, file: &Path) -> Result<Self, SidecarError> {
        resolve(text, file).map_err(|(span, problem)| SidecarError {
            file: file.to_path_buf(),
            line: span.map(|span| line_of(text, span.start)),
            problem,
        })
    }

    pub(crate) fn error(&self, line: usize, problem: SidecarProblem) -> SidecarError {
        SidecarError { file: self.file.clone(), line: Some(line), problem }
    }

    /// `true` for a table with a header.
    pub(crate) fn has_header(&self) -> bool {
        self.table.header.unwrap_or(true)
    }

    /// Used part of the record, s; an end that is not declared is infinite.
    pub(crate) fn used_interval(&self) -> RangeInclusive<f64> {
        self.part.from_s.unwrap_or(f64::NEG_INFINITY)..=self.part.until_s.unwrap_or(f64::INFINITY)
    }

    /// `true` if readings are cleaned and an implausible record is refused.
    pub(crate) fn is_checked(&self) -> bool {
        self.check.plausibility.unwrap_or(true)
    }
}

/// Line, from 1, of a byte of the text.
fn line_of(text: &str, byte: usize) -> usize {
    1 + text.bytes().take(byte).filter(|&byte| byte == b'\n').count()
}

/// Position of a key in the text, or of the table if the key is absent.
fn span(document: &DeTable, table: &str, key: &str) -> Option<Range<usize>> {
    key_span(document, table, key).or_else(|| Some(entry(document, table)?.span()))
}

/// Position of a key in the text; `table` is empty for a key above the tables.
fn key_span(document: &DeTable, table: &str, key: &str) -> Option<Range<usize>> {
    let keys = if table.is_empty() { document } else { entry(document, table)?.get_ref().as_table()? };
    Some(entry(keys, key)?.span())
}

fn entry<'a, 'b>(table: &'a DeTable<'b>, wanted: &str) -> Option<&'a Spanned<DeValue<'b>>> {
    table.iter().find(|(key, _)| key.get_ref() == wanted).map(|(_, value)| value)
}

/// Rule of a value: validity, and the description of valid values; `None` for a key without a rule.
fn rule(table: &str, key: &str, kind: &str, value: &Value) -> Option<(bool, &'static str)> {
    let number = value.as_float().or_else(|| value.as_integer().map(|whole| whole as f64)).filter(|x| x.is_finite());
    let above_zero = number.is_some_and(|number| number > 0.0);
    let whole = |range: std::ops::RangeInclusive<i64>| value.as_integer().is_some_and(|whole| range.contains(&whole));
    Some(match (table, key, kind) {
        ("", "weather", _) => {
            (value.as_str() == Some("none"), "\"none\" for a calm; leave the key out of any other weather")
        }
        ("ship", "x-g-m", _) => (number.is_some(), "a number of metres, positive forward of midship"),
        ("ship" | "form", _, "1") => (above_zero && number <= Some(1.0), "a number above 0, at most 1"),
        ("table", "time-step-s", _) | ("part", "every", _) | ("ship" | "noise", ..) => {
            (above_zero, "a finite number above zero")
        }
        ("rudder", "late-s", _) => (number.is_some(), "a finite number of seconds"),
        ("rudder", "order-rate-deg-s", _) => {
            (number.is_some_and(|rate| (0.1..=200.0).contains(&rate)), "a rate from 0.1 to 200°/s")
        }
        ("form", "trim-m", _) => (number.is_some(), "a number of metres, positive by the stern"),
        ("form" | "trial", _, "m") => (above_zero, "a number of metres above 0"),
        ("form", _, "m²") => (above_zero, "a number of square metres above 0"),
        ("form", _, "number") => (whole(1..=10), "a whole number from 1 to 10"),
        ("form", _, "0 to 12") => (whole(0..=12), "a whole number from 0 to 12 (the Beaufort scale)"),
        ("form", _, "0 to 9") => (whole(0..=9), "a whole number from 0 to 9 (WMO sea state)"),
        ("form", _, "full or partial") => {
            (matches!(value.as_str(), Some("full" | "partial")), "\"full\" or \"partial\"")
        }
        ("form" | "trial", _, "text") => {
            let text = value.as_str().map_or("", str::trim);
            let fits = (1..=100).contains(&text.chars().count()) && !text.chars().any(char::is_control);
            (fits, "a text of 1 to 100 characters in one line")
        }
        _ => return None,
    })
}

/// Checks every value independently.
fn check_values(text: &str, document: &DeTable) -> Result<(), LocatedProblem> {
    let values: toml::Table = text.parse().map_err(syntax)?;
    for SidecarKey { key: name, value_kind: kind, .. } in sidecar_keys() {
        let (table, key) = name.split_once(' ').unwrap_or(("", &name));
        let table = table.trim_matches(['[', ']']);
        let value = if table.is_empty() { values.get(key) } else { values.get(table).and_then(|keys| keys.get(key)) };
        let Some(value) = value else { continue };
        if let Some((false, expected)) = rule(table, key, &kind, value) {
            return Err(unfit(text, document, table, key, expected));
        }
    }
    Ok(())
}

fn unfit(text: &str, document: &DeTable, table: &str, key: &str, expected: &'static str) -> LocatedProblem {
    let span = span(document, table, key);
    let value = span.clone().and_then(|span| text.get(span)).map(shortened).unwrap_or_default();
    (span, SidecarProblem::Value { key: key.to_owned(), value, expected })
}

fn syntax(error: toml::de::Error) -> LocatedProblem {
    (error.span(), SidecarProblem::Syntax { message: error.message().to_owned() })
}

fn resolve(text: &str, file: &Path) -> Result<Sidecar, LocatedProblem> {
    let document = DeTable::parse(text).map_err(syntax)?.into_inner();
    check_values(text, &document)?;
    let SidecarKeys { weather, table, part, column, rudder, ship, noise, check, trial, form } =
        toml::from_str(text).map_err(syntax)?;
    let header = table.header.unwrap_or(true);
    let columns = column.iter().map(|column| described(column, header, text)).collect::<Result<_, _>>()?;
    let conditions = conditions(text, &document, ship, DeclaredConditions { weather, trial, ..form }.without_blanks())?;
    let noise = SensorNoise {
        heading_sd: noise.heading_deg.map(from_deg),
        yaw_rate_sd: noise.yaw_rate_deg_s.map(from_deg),
        rudder_sd: noise.rudder_deg.map(from_deg),
    };
    let sidecar = Sidecar { file: file.to_path_buf(), table, part, check, columns, rudder, noise, conditions };
    let (from_s, until_s) = sidecar.used_interval().into_inner();
    // Comparisons with NaN are false.
    if from_s.partial_cmp(&until_s) != Some(std::cmp::Ordering::Less) {
        let key = if sidecar.part.until_s.is_some() { "until-s" } else { "from-s" };
        return Err((span(&document, "part", key), SidecarProblem::Part { from_s, until_s }));
    }
    Ok(sidecar)
}

/// Conditions declared by [form] and [ship] together; a key that both tables have may be in either.
fn conditions(
    text: &str,
    document: &DeTable,
    ship: Option<ShipKeys>,
    form: DeclaredConditions,
) -> Result<DeclaredConditions, LocatedProblem> {
    let declared = ship.is_some();
    let ShipKeys { mut hull, speed_kn } = ship.unwrap_or_default();
    if declared && (hull.length == 0.0 || (hull.speed == 0.0) == speed_kn.is_none()) {
        return Err((span(document, "ship", ""), SidecarProblem::IncompleteShip));
    }
    let has_form = hull.has_more_than_length_and_speed();
    hull.speed = speed_kn.map_or(hull.speed, |speed| speed * KNOT);
    let particulars = declared.then_some(Particulars { length: hull.length, speed: hull.speed });
    let mut conditions = DeclaredConditions { particulars, ..form };
    if let Some(key) = conditions.join(hull) {
        return Err(unfit(text, document, "form", key, "the value of [ship], or no value"));
    }
    if let Some((key, expected)) = conditions.contradiction() {
        let table = if key_span(document, "form", key).is_some() { "form" } else { "ship" };
        return Err(unfit(text, document, table, key, expected));
    }
    if has_form && let Err(error) = conditions.hull.check() {
        let key = key_span(document, "ship", error.key).or_else(|| key_span(document, "form", error.key));
        return Err((key.or_else(|| span(document, "ship", "")), SidecarProblem::Particulars(Box::new(error))));
    }
    Ok(conditions)
}

fn described(column: &Spanned<ColumnKeys>, header: bool, text: &str) -> Result<DescribedColumn, LocatedProblem> {
    let fault = |problem| Err((Some(column.span()), problem));
    let invalid = |given| fault(SidecarProblem::InvalidColumnReference { given });
    let ColumnKeys { index, name, is, flip, scale, zero, formula, ignore } = column.get_ref();
    let which = match (index, name, formula) {
        (None, None, Some(formula)) => {
            ColumnReference::Formula(ColumnFormula::parse(formula.get_ref()).map_err(|error| {
                let problem = error.to_string();
                (Some(formula.span()), SidecarProblem::Formula { problem })
            })?)
        }
        (.., Some(_)) | (Some(_), Some(_), None) => return invalid("both"),
        (None, None, None) => return invalid("neither"),
        (Some(0), None, None) => return invalid("index 0"),
        (Some(index), None, None) => ColumnReference::Index(index - 1),
        (None, Some(_), None) if !header => return fault(SidecarProblem::NameWithoutHeader),
        (None, Some(name), None) => ColumnReference::Name(name.trim().to_owned()),
    };
    let is_changed = *flip || scale.is_some() || zero.is_some();
    if *ignore && (is.is_some() || is_changed) {
        return fault(SidecarProblem::IgnoredAndUsed);
    }
    let is_formula = matches!(which, ColumnReference::Formula(_));
    if !ignore && is.is_none() && (is_formula || !is_changed) {
        return fault(if is_formula { formula_without_meaning() } else { SidecarProblem::MissingDescription });
    }
    let number = |key: &str, value: Option<f64>, absent: f64| match value.unwrap_or(absent) {
        number if number.is_finite() && (number != 0.0 || key == "zero") => Ok(number),
        number => {
            let (key, value) = (key.to_owned(), number.to_string());
            let expected = "a finite number, and a scale other than 0";
            Err((Some(column.span()), SidecarProblem::Value { key, value, expected }))
        }
    };
    let sign = if *flip { -1.0 } else { 1.0 };
    let (scale, zero) = (sign * number("scale", *scale, 1.0)?, number("zero", *zero, 0.0)?);
    let meaning_of = |is: &Spanned<String>| {
        let unknown = || SidecarProblem::UnknownQuantity { name: shortened(is.get_ref()) };
        quantity_unit_meaning(is.get_ref()).ok_or_else(|| (Some(is.span()), unknown()))
    };
    let meaning = is.as_ref().map(meaning_of).transpose()?;
    Ok(DescribedColumn { line: line_of(text, column.span().start), which, meaning, scale, zero, ignore: *ignore })
}

fn formula_without_meaning() -> SidecarProblem {
    SidecarProblem::Formula { problem: "a column with a formula needs `is` for its quantity".into() }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cells::Separator;
    use crate::encoding::Encoding;
    use ship::vessel::prior::HullParticulars;

    fn parse(text: &str) -> Result<Sidecar, SidecarError> {
        Sidecar::parse(text, Path::new("run.trial.toml"))
    }

    /// Every listed key is accepted, though a value may contradict others.
    #[test]
    fn every_listed_key_is_known() {
        for SidecarKey { key, .. } in sidecar_keys().into_iter().filter(|key| key.key.starts_with('[')) {
            let (table, name) = key.split_once(' ').expect("a table and a key");
            let text = format!("{table}\n{name} = {{}}\n");
            let error = parse(&text).expect_err("no key is a table").to_string();
            assert!(!error.contains("unknown field"), "{error}");
        }
    }

    #[test]
    fn every_documented_key_is_understood() {
        let sidecar = parse(
            "[table]\nskip-lines = 4\nseparator = \"blank\"\nencoding = \"windows-1252\"\nheader = false\n\
             time-step-s = 0.1\n[part]\nfrom-s = 20\nuntil-s = 110.0\nevery = 4\n[[column]]\nindex = 4\n\
             is = \"heading_rad\"\nflip = true\n[[column]]\nindex = 5\nignore = true\n[ship]\nlength-m = 320\n\
             speed-kn = 15.5\n[noise]\nheading-deg = 0.1\nyaw-rate-deg-s = 0.05\nrudder-deg = 0.2\n[check]\n\
             plausibility = false\n[form]\nship-type = \"tanker\"\nbeam-m = 58\nloading = \"partial\"\n",
        )
        .expect("all keys are documented");
        let table = &sidecar.table;
        assert_eq!((table.skip_lines, table.header, sidecar.part.every), (4, Some(false), Some(4)));
        assert_eq!((table.separator, table.encoding), (Some(Separator::Blank), Encoding::Windows1252));
        assert_eq!((sidecar.used_interval(), table.time_step_s), (20.0..=110.0, Some(0.1)));
        assert_eq!(sidecar.columns.len(), 2);
        assert_eq!(sidecar.columns[0].line, 11);
        assert_eq!(sidecar.columns[0].which, ColumnReference::Index(3));
        assert_eq!(sidecar.columns[0].meaning, quantity_unit_meaning("heading_rad"));
        let particulars = sidecar.conditions.particulars.expect("declared");
        approx::assert_relative_eq!(particulars.speed, 7.973_888_888_888_89, max_relative = 1e-14);
        approx::assert_relative_eq!(sidecar.noise.rudder_sd.expect("declared"), from_deg(0.2));
        assert!(!sidecar.is_checked());
        let form = &sidecar.conditions;
        assert_eq!((form.ship_type.as_deref(), form.beam), (Some("tanker"), Some(58.0)));
        assert_eq!(form.loading(), Some(crate::conditions::Loading::Partial));
        assert!(parse("").expect("no key is required").is_checked());
    }

    /// [ship] and [form] complete each other; a trial in ballast has another block coefficient than full load.
    #[test]
    fn the_hull_is_declared_in_either_table() {
        let ship = "[ship]\nlength-m = 320\nspeed-m-s = 7.97\nbeam-m = 58\nrudder-height-m = 15.8\nx-g-m = -2\n\
                    displacement-t = 320415\npropeller-diameter-m = 9.86\npropeller-rps = 1.778\n";
        let form = "[form]\ndraught-m = 20.8\nrudder-area-m2 = 112.5\nblock-coefficient = 0.81\n";
        let conditions = parse(&format!("{ship}{form}")).expect("one ship").conditions;
        let declared = HullParticulars {
            length: 320.0,
            speed: 7.97,
            beam: Some(58.0),
            draught: Some(20.8),
            block_coefficient: Some(0.81),
            rudder_area: Some(112.5),
            rudder_height: Some(15.8),
            propeller_diameter: Some(9.86),
            propeller_rate: Some(1.778),
            displacement: Some(320_415_000.0),
            x_g: Some(-2.0),
        };
        assert_eq!((conditions.hull, conditions.beam), (declared, Some(58.0)));
        let ship = "[ship]\nlength-m = 320\nspeed-m-s = 7.97\nbeam-m = 58\n";
        let ballast = parse(&format!("{ship}{form}loading = \"partial\"\n")).expect("one ship").conditions;
        assert_eq!((ballast.hull.block_coefficient, ballast.block_coefficient), (None, Some(0.81)));
    }

    #[test]
    fn faults_point_to_their_line() {
        let cases = [
            ("weather = \"calm\"\n", 1, "`weather` is \"calm\", expected \"none\" for a calm; leave the key out"),
            ("\nweather = 0\n", 2, "`weather` is 0"),
            ("weather = \"none\"\n[form]\nsea-state = 2\n", 3, "`sea-state` is 2, expected 0 beside weather"),
            ("[table]\nskip-line = 4\n", 2, "unknown field `skip-line`"),
            ("[table]\nseparator = \"bar\"\n", 2, "unknown variant `bar`"),
            ("[table]\nheader = \n", 2, ""),
            ("[table]\ntime-step-s = -0.1\n", 2, "`time-step-s` is -0.1, expected a finite number above zero"),
            ("[part]\nfrom-s = 3.0\nuntil-s = 2.0\n", 3, "from 3 s until 2 s"),
            ("[part]\nfrom-s = nan\n", 2, "is empty"),
            ("[part]\nevery = 0\n", 2, "`every` is 0"),
            ("\n[[column]]\nindex = 1\nis = \"heding_deg\"\n", 4, "`is = \"heding_deg\"` is no known column name"),
            ("\n[[column]]\nis = \"heading_deg\"\n", 2, "this one has neither"),
            ("[[column]]\nindex = 0\nis = \"heading_deg\"\n", 1, "index 0"),
            ("[[column]]\nindex = 1\n", 1, "says nothing"),
            ("[[column]]\nindex = 1\nignore = true\nflip = true\n", 1, "mean nothing"),
            ("[table]\nheader = false\n[[column]]\nname = \"t\"\nis = \"t_s\"\n", 3, "needs a header"),
            ("[ship]\nlength-m = 7.0\n", 1, "[ship] needs"),
            ("[ship]\nlength-m = 7.0\nspeed-kn = 1.0\nspeed-m-s = 1.0\n", 1, "[ship] needs"),
            ("[ship]\nlength-m = 7.0\nbreadth-m = 1.0\n", 3, "unknown field `breadth-m`, expected one of `length-m`"),
            ("[ship]\nlength-m = 7\nspeed-kn = 1\nbeam-m = 58\n", 4, "a breadth below the length of [ship]"),
            ("[ship]\nlength-m = 320\nspeed-kn = 15\nbeam-m = 1.27\n", 4, "L/B (beam-m) is 252, expected 2 to 12"),
            ("[ship]\nlength-m = 320\nspeed-kn = 15\nrudder-area-m2 = -9\n", 4, "`rudder-area-m2` is -9"),
            ("[ship]\nlength-m = 320\nspeed-kn = 15\nblock-coefficient = 1.2\n", 4, "at most 1"),
            ("[ship]\nlength-m = 320\nspeed-kn = 2\nbeam-m = 58\n", 1, "both of the ship, or both of the model"),
            (
                "[ship]\nlength-m = 320\nspeed-kn = 15\nbeam-m = 58\n[form]\nbeam-m = 32\n",
                6,
                "`beam-m` is 32, expected the value of [ship]",
            ),
            ("[noise]\nheading-deg = 0\n", 2, "`heading-deg` is 0"),
            ("[form]\nbeam = 58\n", 2, "unknown field `beam`"),
            ("[form]\nbeam-m = \"wide\"\n", 2, "`beam-m` is \"wide\", expected a number of metres above 0"),
            ("[form]\nbeam-m = -58\n", 2, "`beam-m` is -58"),
            ("[form]\nblock-coefficient = 1.2\n", 2, "expected a number above 0, at most 1"),
            ("[form]\nwind-beaufort = 13\n", 2, "from 0 to 12"),
            ("[form]\nsea-state = 2.5\n", 2, "`sea-state` is 2.5, expected a whole number"),
            ("[form]\nloading = \"ballast\"\n", 2, "expected \"full\" or \"partial\""),
            ("[form]\nship-type = \"\"\n", 2, "a text of 1 to 100 characters"),
            ("[form]\ntrim-m = nan\n", 2, "positive by the stern"),
            ("[form]\nwater-depth-m = 5\ndraught-m = 8\n", 3, "a draught below water-depth-m"),
            ("[ship]\nlength-m = 7\nspeed-kn = 1\n[form]\nbeam-m = 58\n", 5, "a breadth below the length of [ship]"),
        ];
        for (text, line, message) in cases {
            let error = parse(text).expect_err(text);
            assert_eq!(error.line, Some(line), "{text}\n{error}");
            assert!(error.to_string().contains(message), "{error}");
            assert!(error.to_string().starts_with(&format!("run.trial.toml: line {line}: ")), "{error}");
        }
    }

    #[test]
    fn the_sidecar_lies_beside_its_table() {
        assert_eq!(Sidecar::path_beside(Path::new("a/run.1.csv")), Path::new("a/run.1.trial.toml"));
        assert_eq!(Sidecar::path_beside(Path::new("run")), Path::new("run.trial.toml"));
        let error = Sidecar::load(Path::new("no/such.trial.toml")).expect_err("it is not there");
        assert!(matches!(error.problem, SidecarProblem::File(crate::FileError::NotFound)), "{error}");
    }
}
