//! Error codes for programs.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Subject of an error.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum ErrorCode {
    /// Wrong input without a more specific code.
    #[default]
    Input,
    /// Failure of the work itself, not of the input, without a more specific code.
    Work,
    /// Ctrl-C, or a termination signal.
    Interrupted,
    /// Wrong command or option.
    Usage,
    /// Wrong key or value of a scenario.
    Scenario,
    /// Sidecar that is wrong or does not match its table.
    Sidecar,
    /// File that is no valid result of this program.
    Document,
    /// Missing file.
    NotFound,
    /// Folder or device in place of a file.
    NoFile,
    /// File, line or record above the size limit.
    TooLarge,
    /// File that the system cannot read.
    Unreadable,
    /// Empty file.
    Empty,
    /// Binary data, or text that is not UTF-8.
    Encoding,
    /// Unsupported format.
    Format,
    /// Damaged or truncated file or log.
    Damaged,
    /// File without a table.
    NoTable,
    /// Table without column names.
    NoHeader,
    /// Time, heading or rudder without a column or values.
    MissingChannel,
    /// Two columns for one quantity.
    DuplicateColumn,
    /// Column of unknown unit.
    OpenUnit,
    /// Angle not in degrees: per cent, parts of a degree, counts of a converter.
    AngleScale,
    /// Degrees in a column of radians, or radians in one of degrees.
    AngleUnit,
    /// Yaw rate in another unit than its column name.
    YawRateUnit,
    /// Yaw rate and heading with opposite signs.
    YawRateSign,
    /// Rudder and turn with opposite signs.
    RudderSign,
    /// Time in another unit than its column name.
    TimeUnit,
    /// Unreadable or ambiguous date or time.
    Stamp,
    /// Cell without a number.
    Cell,
    /// Row with another number of cells than the header.
    RowLength,
    /// Decreasing time.
    TimeBackwards,
    /// Repeated time with different values.
    TimeRepeats,
    /// Missing time, or clocks and channels that do not match.
    Clock,
    /// Selected part without rows.
    EmptyPart,
    /// Too few rows.
    TooShort,
    /// Constant rudder and heading.
    NothingMoves,
    /// Constant heading with a moving rudder.
    HeadingConstant,
    /// Channel that alternates between two sensors.
    TwoInputs,
    /// Several zig-zags without a selected one.
    SeveralManoeuvres,
    /// Record that no method can identify.
    NoAnswer,
}
