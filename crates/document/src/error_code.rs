//! What an error is about, as a word that programs can act on.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// What an error is about.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum ErrorCode {
    /// Input that is wrong in a way without a code.
    #[default]
    Input,
    /// Work that could not be done.
    Work,
    /// Ctrl-C, or a signal to end.
    Interrupted,
    /// A wrong command or option.
    Usage,
    /// A key or value of a scenario.
    Scenario,
    /// A sidecar that is wrong or does not fit its table.
    Sidecar,
    /// A file that should be a result of this program.
    Document,
    /// There is no such file.
    NotFound,
    /// A folder or device where a file was expected.
    NoFile,
    /// A file, line or record longer than may be read.
    TooLarge,
    /// Bytes that the system does not give.
    Unreadable,
    /// Nothing in the file.
    Empty,
    /// Bytes that are no text, or text in another encoding than UTF-8.
    Encoding,
    /// A format that is not read.
    Format,
    /// A file or log that is damaged or cut short.
    Damaged,
    /// A file without a table.
    NoTable,
    /// A table without names of columns.
    NoHeader,
    /// Time, heading or rudder has no column, or no value in it.
    MissingChannel,
    /// Two columns for one quantity.
    DuplicateColumn,
    /// A column whose unit nothing shows.
    OpenUnit,
    /// An angle that is in no degrees: per cent, parts of a degree, counts of a converter.
    AngleScale,
    /// Degrees under the name of radians, or radians under that of degrees.
    AngleUnit,
    /// A yaw rate in another unit than its name says.
    YawRateUnit,
    /// Yaw rate and heading of opposite signs.
    YawRateSign,
    /// The ship turns away from her rudder.
    RudderSign,
    /// A time in another unit than its name says.
    TimeUnit,
    /// A date or time that cannot be read, or in two ways.
    Stamp,
    /// A cell that is no number.
    Cell,
    /// A row with more or fewer cells than the header.
    RowLength,
    /// Time runs backwards.
    TimeBackwards,
    /// A time twice, with different values.
    TimeRepeats,
    /// No time, or clocks and channels that do not belong together.
    Clock,
    /// A part without a row.
    EmptyPart,
    /// Too few rows.
    TooShort,
    /// Neither rudder nor heading moves.
    NothingMoves,
    /// The rudder moves and the heading does not.
    HeadingConstant,
    /// A channel with two sensors in turn.
    TwoInputs,
    /// Several zig-zags, and none was asked for.
    SeveralManoeuvres,
    /// No method can identify the record.
    NoAnswer,
}
