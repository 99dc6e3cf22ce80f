//! The sidecar: a small TOML file that tells how a table that does not follow the naming contract is to be read. It
//! describes; reading is done in [`crate::reader`].
//!
//! `NAME.trial.toml` beside `NAME.csv` (or `.dat`, `.txt`, ...) is found by itself; any other sidecar has to be named.
//! [`KEYS`] lists what it may say; none of it is required.

use std::path::{Path, PathBuf};

use serde::Deserialize;
use ship::Particulars;
use ship::angle::{KNOT, from_deg};
use toml::Spanned;

use crate::cells::Separator;
use crate::channel::{Channel, Unit, column, time_column};
use crate::conditions::Conditions;
use crate::encoding::Encoding;
use crate::file::{Kind, read_text};
use crate::record::Noise;
use crate::sidecar_error::Fault;
pub use crate::sidecar_error::{SidecarError, SidecarProblem};
use crate::sidecar_form::{self, WireForm};
pub use crate::sidecar_keys::{KEYS, Key};

/// A sidecar; the longest in use has a hundred lines.
pub const SIDECAR: Kind = Kind { name: "a sidecar", largest: 1 << 20 };

#[derive(Deserialize, Default, schemars::JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
struct Wire {
    #[serde(default)]
    table: WireTable,
    #[serde(default)]
    part: WirePart,
    #[serde(default)]
    #[schemars(with = "Vec<WireColumn>")]
    column: Vec<Spanned<WireColumn>>,
    #[schemars(with = "Option<WireShip>")]
    ship: Option<Spanned<WireShip>>,
    #[serde(default)]
    noise: WireNoise,
    #[serde(default)]
    check: WireCheck,
    #[serde(default)]
    form: WireForm,
}

#[derive(Deserialize, Default, schemars::JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
struct WireTable {
    #[serde(default)]
    skip_lines: usize,
    separator: Option<Separator>,
    #[serde(default)]
    encoding: Encoding,
    header: Option<bool>,
    #[schemars(with = "Option<f64>")]
    time_step_s: Option<Spanned<f64>>,
}

#[derive(Deserialize, Default, schemars::JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
struct WirePart {
    #[schemars(with = "Option<f64>")]
    from_s: Option<Spanned<f64>>,
    #[schemars(with = "Option<f64>")]
    until_s: Option<Spanned<f64>>,
    #[schemars(with = "Option<usize>")]
    every: Option<Spanned<usize>>,
}

#[derive(Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
struct WireColumn {
    index: Option<usize>,
    name: Option<String>,
    #[schemars(with = "Option<String>")]
    is: Option<Spanned<String>>,
    #[serde(default)]
    flip: bool,
    #[serde(default)]
    ignore: bool,
}

#[derive(Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
struct WireShip {
    #[schemars(with = "Option<f64>")]
    length_m: Option<Spanned<f64>>,
    #[schemars(with = "Option<f64>")]
    speed_m_s: Option<Spanned<f64>>,
    #[schemars(with = "Option<f64>")]
    speed_kn: Option<Spanned<f64>>,
}

#[derive(Deserialize, Default, schemars::JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
struct WireNoise {
    #[schemars(with = "Option<f64>")]
    heading_deg: Option<Spanned<f64>>,
    #[schemars(with = "Option<f64>")]
    yaw_rate_deg_s: Option<Spanned<f64>>,
    #[schemars(with = "Option<f64>")]
    rudder_deg: Option<Spanned<f64>>,
}

#[derive(Deserialize, Default, schemars::JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
struct WireCheck {
    plausibility: Option<bool>,
}

/// The JSON schema of the file.
pub fn schema() -> schemars::Schema {
    crate::sidecar_schema::of::<Wire>()
}

/// Which column of a table is meant.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) enum Which {
    /// By place, from 0.
    Place(usize),
    /// By its name in the header.
    Name(String),
}

/// What a column holds.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Quantity {
    Time(Unit),
    Channel(Channel, Unit),
}

impl Quantity {
    /// What a column name of the contract stands for.
    pub(crate) fn of(name: &str) -> Option<Self> {
        time_column(name)
            .map(Quantity::Time)
            .or_else(|| column(name).map(|(channel, unit)| Self::Channel(channel, unit)))
    }
}

/// One `[[column]]`, checked.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Described {
    pub(crate) line: usize,
    pub(crate) which: Which,
    pub(crate) quantity: Option<Quantity>,
    pub(crate) flip: bool,
    pub(crate) ignore: bool,
}

/// A sidecar that was read and checked as far as it can be without its table.
#[derive(Debug, Clone, PartialEq)]
pub struct Sidecar {
    pub(crate) file: PathBuf,
    pub(crate) skip_lines: usize,
    pub(crate) separator: Option<Separator>,
    pub(crate) encoding: Encoding,
    pub(crate) header: bool,
    pub(crate) time_step: Option<f64>,
    pub(crate) from: f64,
    pub(crate) until: f64,
    pub(crate) every: usize,
    pub(crate) columns: Vec<Described>,
    pub(crate) particulars: Option<Particulars>,
    pub(crate) noise: Noise,
    pub(crate) plausibility: bool,
    pub(crate) conditions: Conditions,
}

impl Sidecar {
    /// Where the sidecar of a table is looked for: `NAME.trial.toml` beside `NAME.*`.
    pub fn beside(table: &Path) -> PathBuf {
        table.with_extension("trial.toml")
    }

    /// The sidecar of a table, where there is one beside it.
    pub fn found_beside(table: &Path) -> Option<PathBuf> {
        Some(Self::beside(table)).filter(|beside| beside.is_file())
    }

    /// Reads and checks a sidecar.
    ///
    /// Fails when the file cannot be read or is larger than [`SIDECAR`], and as [`parse`](Self::parse) does.
    pub fn load(file: &Path) -> Result<Self, SidecarError> {
        let text = read_text(file, SIDECAR).map_err(|error| SidecarError {
            file: file.to_path_buf(),
            line: None,
            problem: SidecarProblem::File(error),
        })?;
        Self::parse(&text, file)
    }

    /// Checks the text of a sidecar; `file` is its name in messages.
    ///
    /// Fails on text that is not TOML, keys and quantities that are not known, and numbers outside their range; the
    /// error points to the line.
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

    /// Length and approach speed of the ship, where the sidecar declares them.
    pub fn particulars(&self) -> Option<Particulars> {
        self.particulars
    }

    /// Sensor noise the sidecar declares.
    pub fn noise(&self) -> Noise {
        self.noise
    }

    /// Particulars and conditions the sidecar declares for the form of MSC/Circ.1053.
    pub fn conditions(&self) -> &Conditions {
        &self.conditions
    }
}

/// Line, from 1, of a byte of the text.
fn line_of(text: &str, byte: usize) -> usize {
    1 + text.bytes().take(byte).filter(|&byte| byte == b'\n').count()
}

fn resolve(text: &str, file: &Path) -> Result<Sidecar, Fault> {
    let wire: Wire = toml::from_str(text)
        .map_err(|error| (error.span(), SidecarProblem::Syntax { message: error.message().to_owned() }))?;
    let header = wire.table.header.unwrap_or(true);
    let columns = wire.column.iter().map(|column| described(column, header, text)).collect::<Result<_, _>>()?;
    let (from, until) = part(&wire.part)?;
    if let Some(every) = wire.part.every.as_ref().filter(|every| *every.get_ref() == 0) {
        return Err((Some(every.span()), SidecarProblem::NotPositive { key: "every", found: 0.0 }));
    }
    let particulars = wire.ship.as_ref().map(particulars).transpose()?;
    let deviation = |value: &Option<Spanned<f64>>, key| Ok(positive(value.as_ref(), key)?.map(from_deg));
    Ok(Sidecar {
        file: file.to_path_buf(),
        skip_lines: wire.table.skip_lines,
        separator: wire.table.separator,
        encoding: wire.table.encoding,
        header,
        time_step: positive(wire.table.time_step_s.as_ref(), "time-step-s")?,
        from,
        until,
        every: wire.part.every.map_or(1, Spanned::into_inner),
        columns,
        particulars,
        noise: Noise {
            heading: deviation(&wire.noise.heading_deg, "heading-deg")?,
            yaw_rate: deviation(&wire.noise.yaw_rate_deg_s, "yaw-rate-deg-s")?,
            rudder: deviation(&wire.noise.rudder_deg, "rudder-deg")?,
        },
        plausibility: wire.check.plausibility.unwrap_or(true),
        conditions: sidecar_form::conditions(&wire.form, particulars)?,
    })
}

fn positive(value: Option<&Spanned<f64>>, key: &'static str) -> Result<Option<f64>, Fault> {
    let Some(spanned) = value else { return Ok(None) };
    let found = *spanned.get_ref();
    if found > 0.0 && found.is_finite() {
        Ok(Some(found))
    } else {
        Err((Some(spanned.span()), SidecarProblem::NotPositive { key, found }))
    }
}

fn part(part: &WirePart) -> Result<(f64, f64), Fault> {
    let from = part.from_s.as_ref().map_or(f64::NEG_INFINITY, |value| *value.get_ref());
    let until = part.until_s.as_ref().map_or(f64::INFINITY, |value| *value.get_ref());
    if from < until {
        return Ok((from, until));
    }
    let span = part.until_s.as_ref().or(part.from_s.as_ref()).map(Spanned::span);
    Err((span, SidecarProblem::Part { from_s: from, until_s: until }))
}

fn particulars(ship: &Spanned<WireShip>) -> Result<Particulars, Fault> {
    let wire = ship.get_ref();
    let length = positive(wire.length_m.as_ref(), "length-m")?;
    let metres = positive(wire.speed_m_s.as_ref(), "speed-m-s")?;
    let knots = positive(wire.speed_kn.as_ref(), "speed-kn")?.map(|speed_kn| speed_kn * KNOT);
    match (length, metres, knots) {
        (Some(length), Some(speed), None) | (Some(length), None, Some(speed)) => Ok(Particulars { length, speed }),
        _ => Err((Some(ship.span()), SidecarProblem::Ship)),
    }
}

fn described(column: &Spanned<WireColumn>, header: bool, text: &str) -> Result<Described, Fault> {
    let fault = |problem| (Some(column.span()), problem);
    let wire = column.get_ref();
    let which = match (wire.index, &wire.name) {
        (Some(_), Some(_)) => return Err(fault(SidecarProblem::Which { found: "both" })),
        (None, None) => return Err(fault(SidecarProblem::Which { found: "neither" })),
        (Some(0), None) => return Err(fault(SidecarProblem::Which { found: "index 0" })),
        (Some(index), None) => Which::Place(index - 1),
        (None, Some(_)) if !header => return Err(fault(SidecarProblem::NameWithoutHeader)),
        (None, Some(name)) => Which::Name(name.trim().to_owned()),
    };
    if wire.ignore && (wire.is.is_some() || wire.flip) {
        return Err(fault(SidecarProblem::IgnoredAndUsed));
    }
    if !wire.ignore && !wire.flip && wire.is.is_none() {
        return Err(fault(SidecarProblem::Idle));
    }
    let quantity = match &wire.is {
        None => None,
        Some(is) => Some(Quantity::of(is.get_ref()).ok_or_else(|| {
            (Some(is.span()), SidecarProblem::UnknownQuantity { found: crate::words::shortened(is.get_ref()) })
        })?),
    };
    Ok(Described { line: line_of(text, column.span().start), which, quantity, flip: wire.flip, ignore: wire.ignore })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parse(text: &str) -> Result<Sidecar, SidecarError> {
        Sidecar::parse(text, Path::new("run.trial.toml"))
    }

    /// A key that is listed is understood, though a value may not fit beside the others.
    #[test]
    fn every_listed_key_is_known() {
        for Key { key, .. } in KEYS.iter().filter(|key| key.key.starts_with('[')) {
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
        assert_eq!((sidecar.skip_lines, sidecar.header, sidecar.every), (4, false, 4));
        assert_eq!((sidecar.separator, sidecar.encoding), (Some(Separator::Blank), Encoding::Windows1252));
        assert_eq!((sidecar.from, sidecar.until, sidecar.time_step), (20.0, 110.0, Some(0.1)));
        assert_eq!(sidecar.columns.len(), 2);
        assert_eq!(sidecar.columns[0].line, 11);
        assert_eq!(sidecar.columns[0].which, Which::Place(3));
        assert_eq!(sidecar.columns[0].quantity, Some(Quantity::Channel(Channel::Heading, Unit::Radian)));
        let particulars = sidecar.particulars().expect("declared");
        approx::assert_relative_eq!(particulars.speed, 7.973_888_888_888_89, max_relative = 1e-14);
        approx::assert_relative_eq!(sidecar.noise().rudder.expect("declared"), from_deg(0.2));
        assert!(!sidecar.plausibility);
        let form = sidecar.conditions();
        assert_eq!((form.ship_type.as_deref(), form.beam), (Some("tanker"), Some(58.0)));
        assert_eq!(form.particulars, sidecar.particulars());
        assert_eq!(form.loading(), Some(crate::conditions::Loading::Partial));
        assert!(parse("").expect("no key is required").plausibility);
    }

    #[test]
    fn faults_point_to_their_line() {
        let cases = [
            ("[table]\nskip-line = 4\n", 2, "unknown field `skip-line`"),
            ("[table]\nseparator = \"bar\"\n", 2, "unknown variant `bar`"),
            ("[table]\nheader = \n", 2, ""),
            ("[table]\ntime-step-s = -0.1\n", 2, "`time-step-s` is -0.1, expected a finite number above zero"),
            ("[part]\nfrom-s = 3.0\nuntil-s = 2.0\n", 3, "from 3 s until 2 s"),
            ("[part]\nfrom-s = nan\n", 2, "holds nothing"),
            ("[part]\nevery = 0\n", 2, "`every` is 0"),
            ("\n[[column]]\nindex = 1\nis = \"heding_deg\"\n", 4, "`is = \"heding_deg\"` is no known column name"),
            ("\n[[column]]\nis = \"heading_deg\"\n", 2, "this one has neither"),
            ("[[column]]\nindex = 0\nis = \"heading_deg\"\n", 1, "index 0"),
            ("[[column]]\nindex = 1\n", 1, "says nothing"),
            ("[[column]]\nindex = 1\nignore = true\nflip = true\n", 1, "mean nothing"),
            ("[table]\nheader = false\n[[column]]\nname = \"t\"\nis = \"t_s\"\n", 3, "needs a header"),
            ("[ship]\nlength-m = 7.0\n", 1, "[ship] needs"),
            ("[ship]\nlength-m = 7.0\nspeed-kn = 1.0\nspeed-m-s = 1.0\n", 1, "[ship] needs"),
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
        assert_eq!(Sidecar::beside(Path::new("a/run.1.csv")), Path::new("a/run.1.trial.toml"));
        assert_eq!(Sidecar::beside(Path::new("run")), Path::new("run.trial.toml"));
        let error = Sidecar::load(Path::new("no/such.trial.toml")).expect_err("it is not there");
        assert!(matches!(error.problem, SidecarProblem::File(crate::FileError::NotFound)), "{error}");
    }
}
