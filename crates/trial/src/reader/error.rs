//! Errors of a file: each message states the place, the value found, the expected value and a remedy.

use std::path::{Path, PathBuf};

use ship::ShortNumber;
use thiserror::Error;

use crate::channel::Channel;
use crate::file::FileError;
use crate::plausibility::Implausibility;
use crate::record::TrialError;
use crate::sidecar::SidecarError;
use crate::wording::{interval_end, listed, rounded_to_thousandth};

/// Error of reading a record.
#[derive(Debug, Error)]
#[expect(missing_docs, reason = "the message of a variant says what its fields are")]
pub enum ReadError {
    /// Fault of the file itself.
    #[error("{}: {problem}", file.display())]
    Table { file: PathBuf, problem: ReadProblem },
    /// Fault of the sidecar of the file.
    #[error(transparent)]
    Sidecar(#[from] SidecarError),
}

impl ReadError {
    pub(crate) fn table(file: &Path, problem: ReadProblem) -> Self {
        ReadError::Table { file: file.to_path_buf(), problem }
    }

    /// Message without content of the file, for readers other than the user who named it.
    pub fn without_content(&self) -> String {
        match self {
            Self::Table { problem: ReadProblem::File(_), .. } => self.to_string(),
            Self::Table { file, .. } => format!("{}: this file is not a usable record", file.display()),
            Self::Sidecar(SidecarError { file, .. }) => {
                format!("{}: this sidecar cannot be used", file.display())
            }
        }
    }
}

/// Text of the sidecar key `is` for an angle in degrees: ` is = "rudder_deg"`.
fn angle_key_text(quantity: &str) -> String {
    format!(" is = \"{}_deg\"", quantity.split(' ').next().unwrap_or_default())
}

/// Problem of a table or a log. Lines count from 1 as in editors.
#[derive(Debug, Error)]
#[expect(missing_docs, reason = "the message of a variant says what its fields are")]
pub enum ReadProblem {
    /// The file cannot be opened or read.
    #[error(transparent)]
    File(#[from] FileError),
    /// Sidecar in place of its table.
    #[error("this file is a sidecar, not a table; name the table beside it")]
    IsSidecar,
    /// The file is empty.
    #[error("the file is empty; expected a header line such as `t_s,heading_deg,rudder_deg` and rows of numbers")]
    Empty,
    /// Bytes that are not text.
    #[error("line {line} holds a zero byte, so this is not a text table; export the table as CSV")]
    Binary { line: usize },
    /// UTF-16, which some spreadsheets call "Unicode text".
    #[error("line 1 starts with the mark of UTF-16 text; save the file as CSV in UTF-8")]
    Utf16,
    /// Bytes that are not UTF-8.
    #[error(
        "line {line} holds the byte 0x{byte:02x}, which is not UTF-8; save the file as UTF-8, or write `encoding = \
         \"windows-1252\"` under [table] in a sidecar NAME.trial.toml"
    )]
    NotUtf8 { line: usize, byte: u8 },
    /// Line above the maximum length.
    #[error("line {line} is longer than {limit} bytes, so this is not a table with one row per line; export it as CSV")]
    LongLine { line: usize, limit: usize },
    /// Numbers in place of names.
    #[error(
        "line {line} holds numbers ({text}) where a header was expected; add a header such as \
         `t_s,heading_deg,rudder_deg`, or describe the columns in a sidecar NAME.trial.toml (`header = false` under \
         [table], one [[column]] with `index` and `is` each)"
    )]
    NoHeader { line: usize, text: String },
    /// Absent required column.
    #[error(
        "line {line}: no column holds the {wanted}; expected {accepted}, found {}; rename the column, or describe it in a \
         sidecar NAME.trial.toml ([[column]] with `name` and `is`)",
        listed(columns)
    )]
    NoColumn { line: usize, wanted: &'static str, accepted: String, columns: Vec<String> },
    /// Course over ground and no heading.
    #[error(
        "line {line}: no column holds the heading; `{column}` is the course over ground, which is no heading (they differ \
         by the drift angle, up to 20 degrees in a turn); use a record with the compass, or write `is = \"heading_deg\"` \
         for the column in a sidecar NAME.trial.toml if it is a heading"
    )]
    CourseOnly { line: usize, column: String },
    /// Files or sentences without a required channel.
    #[error("there is no {wanted}; found {}; add the file that holds it with `--with-columns FILE`", listed(channels))]
    NoChannel { wanted: &'static str, channels: Vec<String> },
    /// Rudder and heading without common times.
    #[error(
        "rudder and heading have no time in common: the rudder was read from {} s to {} s, the heading from {} s to {} s; \
         check that both belong to the same trial and count time from the same instant", rounded_to_thousandth(rudder_s[0]),
        rounded_to_thousandth(rudder_s[1]), rounded_to_thousandth(heading_s[0]), rounded_to_thousandth(heading_s[1])
    )]
    NoOverlap { rudder_s: [f64; 2], heading_s: [f64; 2] },
    /// Two files with different kinds of time.
    #[error(
        "{} has {}, this file has {}: they cannot be joined; give both files stamps of date and time, or both seconds from \
         the same instant", first.display(), if *stamped { "time stamps" } else { "times in seconds" },
        if *stamped { "times in seconds" } else { "time stamps" }
    )]
    TwoClocks { first: PathBuf, stamped: bool },
    /// File without columns to describe.
    #[error("this file holds sentences or messages (NMEA), which state their quantities; it needs no sidecar")]
    NeedsNoSidecar,
    /// Format that is recognised but not read.
    #[error("this is {format}; {cure}")]
    Format { format: &'static str, cure: &'static str },
    /// Damaged file of a recognised format.
    #[error("this is {format} and cannot be read: {damage}; it is damaged or cut short: copy or export it again")]
    Damaged { format: &'static str, damage: String },
    /// File of a table format without a table.
    #[error("this is {format} without a table: expected {wanted}, found {}; export the table as CSV", listed(content))]
    NoTable { format: &'static str, wanted: &'static str, content: Vec<String> },
    /// Channel in a cell array of MATLAB.
    #[error(
        "column {column} is a cell array, not a vector of numbers; convert it in MATLAB, `{column} = cell2mat({column})` \
         (for texts `str2double({column})`), and save the file again"
    )]
    CellArray { column: String },
    /// Required column without a unit.
    #[error(
        "line {line}: the {quantity} `{column}` has no unit, and its values (up to {largest}) fit more than one; name it \
         {}, or write in a sidecar NAME.trial.toml: [[column]] name = \"{column}\" is = \"{}\"",
        channel.accepted_names(), channel.column_name()
    )]
    MissingUnit { line: usize, column: String, quantity: &'static str, largest: f64, channel: Channel },
    /// Tenths or hundredths of a degree.
    #[error(
        "line {line}: the {quantity} `{column}` has whole numbers up to {largest}, which are not degrees: they look like \
         {} of a degree; write in a sidecar NAME.trial.toml: [[column]] name = \"{column}\" scale = {scale}{}",
        if *parts == 10.0 { "tenths" } else { "hundredths" },
        angle_key_text(quantity)
    )]
    PartsOfDegree { line: usize, column: String, quantity: &'static str, largest: f64, parts: f64, scale: f64 },
    /// Counts of a converter.
    #[error(
        "line {line}: the {quantity} `{column}` has whole numbers from {low} to {high}, which are not degrees: they look \
         like counts of a converter about {zero}; write in a sidecar NAME.trial.toml: [[column]] name = \"{column}\" \
         zero = {zero} scale = 0.1{}, with the count at rudder amidships and the degrees per count, from the two stops",
        angle_key_text(quantity)
    )]
    ConverterCounts { line: usize, column: String, quantity: &'static str, low: f64, high: f64, zero: f64 },
    /// Numbers that are neither degrees nor parts of them.
    #[error(
        "line {line}: the {quantity} `{column}` reaches {}, which is impossible in degrees; if its numbers have another \
         scale, write in a sidecar NAME.trial.toml: [[column]] name = \"{column}\" scale = 0.1{}, with the degrees per unit",
        ShortNumber::rounded(*largest, 6),
        angle_key_text(quantity)
    )]
    ImpossibleAngle { line: usize, column: String, quantity: &'static str, largest: f64 },
    /// Milliseconds or microseconds since 1970 under a name in seconds.
    #[error(
        "line {line}: the time `{column}` begins at {first}, which is after the year 2100 in seconds, and a present date in \
         {unit}; name it t_{unit}, or write in a sidecar NAME.trial.toml: [[column]] name = \"{column}\" is = \"t_{unit}\""
    )]
    EpochUnit { line: usize, column: String, first: f64, unit: &'static str },
    /// Time without a unit that cannot be seconds.
    #[error(
        "line {line}: the time `{column}` has no unit, and in seconds the ship would turn impossibly fast or slowly; name \
         it t_s, t_ms or t_min, or write in a sidecar NAME.trial.toml: [[column]] name = \"{column}\" is = \"t_ms\""
    )]
    MissingTimeUnit { line: usize, column: String },
    /// Cell that should be a stamp.
    #[error(
        "line {line}, column `{column}`: found `{value}`, expected a date and time such as `2026-11-20T14:03:05.2` or \
         `20.11.2026 14:03:05`; correct the cell"
    )]
    NotAStamp { line: usize, column: String, value: String },
    /// Date with two possible readings.
    #[error(
        "line {line}: `{value}` can be read with the day or the month first, and the dates before do not show which; write \
         dates as 2026-11-20"
    )]
    AmbiguousDate { line: usize, value: String },
    /// Two columns for one quantity.
    #[error(
        "line {line}: the columns `{first}` and `{second}` both hold the {quantity}; remove one of them, or write `ignore = \
         true` for it in a sidecar NAME.trial.toml"
    )]
    Duplicate { line: usize, quantity: &'static str, first: String, second: String },
    /// Header without rows, or comments only.
    #[error("there is no row of numbers after line {line}; expected a header and at least {needed} rows below it")]
    NoRows { line: usize, needed: usize },
    /// Cell that should be a number.
    #[error(
        "line {line}, column `{column}`: found `{value}`, expected a number (or an empty cell or NaN where nothing was \
         recorded); correct the cell"
    )]
    NotANumber { line: usize, column: String, value: String },
    /// Row with another number of cells than the header.
    #[error(
        "line {line} has {cells} cells, expected {expected} as in the first line of the table; correct the row, or the \
         separator in a sidecar NAME.trial.toml"
    )]
    WrongCellCount { line: usize, cells: usize, expected: usize },
    /// Decreasing time.
    #[error(
        "line {line}: time runs backwards, {time} s after {before} s; sort or cut the file, or rebuild time from its step \
         with `time-step-s` under [table] in a sidecar NAME.trial.toml"
    )]
    TimeBackwards { line: usize, before: f64, time: f64 },
    /// Repeated time with different values.
    #[error(
        "line {line}: time {time} s occurs twice with different values; if it was printed with too few digits, rebuild it \
         with `time-step-s` under [table] in a sidecar NAME.trial.toml"
    )]
    TimeRepeats { line: usize, time: f64 },
    /// Required column without a value.
    #[error(
        "the column `{column}` has no value in any row used; expected the {quantity}: check that the sensor was recorded"
    )]
    AllMissing { column: String, quantity: &'static str },
    /// The requested part of the record is empty.
    #[error(
        "no row lies{}{}; the rows lie between {} s and {} s: give another part (--from and --until, or `from-s` and \
         `until-s` under [part] in the sidecar)",
        interval_end("from", *from_s), interval_end("until", *until_s), rounded_to_thousandth(*first_s), rounded_to_thousandth(*last_s)
    )]
    EmptyPart { from_s: f64, until_s: f64, first_s: f64, last_s: f64 },
    /// Requested number without a manoeuvre.
    #[error("there is no manoeuvre {number}; `study find {file}` lists {count}")]
    NoManoeuvre { file: String, number: usize, count: usize },
    /// Several zig-zags and no selection; a line for each.
    #[error("there are {count} zig-zags in this log; choose one:{lines}")]
    SeveralZigZags { count: usize, lines: String },
    /// Too few usable rows.
    #[error(
        "{usable} of {rows} rows have time, heading (or yaw rate) and rudder; a record needs at least {needed}: fill in the \
         missing values or use a longer part"
    )]
    TooShort { needed: usize, usable: usize, rows: usize },
    /// More rows than the limit.
    #[error(
        "more than {limit} rows{}, which is the limit with {columns} columns; thin the record with `every = {every}` under \
         [part] in a sidecar NAME.trial.toml, or use a part of it with `from-s` and `until-s`",
        estimate.map_or_else(String::new, |rows| format!(" (about {rows} by the size of the file)"))
    )]
    TooManyRows { limit: usize, columns: usize, estimate: Option<u64>, every: u64 },
    /// Log with too many damaged lines.
    #[error(
        "{damaged} of {lines} lines are damaged ({wrong} with a wrong checksum, {broken} cut short or not text), expected at \
         most half; check the speed and the wiring of the serial line, or export the log again"
    )]
    DamagedLog { lines: usize, damaged: usize, wrong: usize, broken: usize },
    /// Sentences without time.
    #[error(
        "the log has no time: there is no time stamp before its {sentences} sentences, and {clocks} valid times in ZDA, \
         RMC, GGA or GLL (at least two are needed); record it with time stamps, or with the sentences of a GPS \
         (`time-step-s` is not possible for sentences)"
    )]
    NoClock { sentences: usize, clocks: usize },
    /// Log whose clock restarts.
    #[error(
        "line {line}: the clock of the log goes back from {before} to {after}, expected a single recording; cut the log \
         there and use the parts one by one"
    )]
    ClockBack { line: usize, before: String, after: String },
    /// Log without a used quantity.
    #[error(
        "none of the {sentences} sentences of the log holds a quantity that is used; expected a heading (HDT, THS, HDG) and \
         a rudder angle (RSA): check which sentences were recorded"
    )]
    NoReadings { sentences: usize },
    /// More readings than the limit.
    #[error(
        "line {line}: the log holds more than {limit} numbers, which is the limit; use the part with the manoeuvre"
    )]
    TooManyReadings { line: usize, limit: usize },
    /// Implausible record.
    #[error(transparent)]
    Implausible(#[from] Implausibility),
    /// Columns that are not a record.
    #[error(transparent)]
    Record(#[from] TrialError),
}
