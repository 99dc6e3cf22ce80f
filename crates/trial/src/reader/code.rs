//! Machine-readable codes of the errors of the reader.

use document::ErrorCode;

use super::error::{Problem, ReadError};
use crate::file::FileError;
use crate::plausibility::Implausible;
use crate::record::TrialError;

impl ReadError {
    /// Code of the error.
    pub fn code(&self) -> ErrorCode {
        match self {
            Self::Table { problem, .. } => problem.code(),
            Self::Sidecar(_) => ErrorCode::Sidecar,
        }
    }
}

impl Problem {
    /// Code of the problem.
    pub fn code(&self) -> ErrorCode {
        match self {
            Self::File(error) => file_code(error),
            Self::IsSidecar | Self::NeedsNoSidecar => ErrorCode::Sidecar,
            Self::Empty => ErrorCode::Empty,
            Self::Binary { .. } | Self::Utf16 | Self::NotUtf8 { .. } => ErrorCode::Encoding,
            Self::TooManyRows { .. } | Self::TooManyReadings { .. } => ErrorCode::TooLarge,
            Self::NoHeader { .. } => ErrorCode::NoHeader,
            Self::NoColumn { .. }
            | Self::CourseOnly { .. }
            | Self::NoChannel { .. }
            | Self::AllMissing { .. }
            | Self::NoReadings { .. } => ErrorCode::MissingChannel,
            Self::NoOverlap { .. } | Self::TwoClocks { .. } | Self::NoClock { .. } => ErrorCode::Clock,
            Self::LongLine { .. } | Self::Format { .. } | Self::CellArray { .. } => ErrorCode::Format,
            Self::Damaged { .. } | Self::DamagedLog { .. } => ErrorCode::Damaged,
            Self::NoTable { .. } => ErrorCode::NoTable,
            Self::OpenUnit { .. } => ErrorCode::OpenUnit,
            Self::Parts { .. } | Self::Counts { .. } | Self::NoAngle { .. } => ErrorCode::AngleScale,
            Self::EpochUnit { .. } | Self::OpenTime { .. } => ErrorCode::TimeUnit,
            Self::NotAStamp { .. } | Self::EitherMonth { .. } => ErrorCode::Stamp,
            Self::Duplicate { .. } => ErrorCode::DuplicateColumn,
            Self::NoRows { .. } | Self::TooShort { .. } => ErrorCode::TooShort,
            Self::NotANumber { .. } => ErrorCode::Cell,
            Self::Cells { .. } => ErrorCode::RowLength,
            Self::TimeBackwards { .. } | Self::ClockBack { .. } => ErrorCode::TimeBackwards,
            Self::TimeRepeats { .. } => ErrorCode::TimeRepeats,
            Self::EmptyPart { .. } => ErrorCode::EmptyPart,
            Self::NoManoeuvre { .. } => ErrorCode::Input,
            Self::SeveralZigZags { .. } => ErrorCode::SeveralManoeuvres,
            Self::Implausible(implausible) => plausibility_code(implausible),
            Self::Record(error) => columns_code(error),
        }
    }
}

fn file_code(error: &FileError) -> ErrorCode {
    match error {
        FileError::NotFound => ErrorCode::NotFound,
        FileError::Folder | FileError::NoFile => ErrorCode::NoFile,
        FileError::TooLarge { .. } => ErrorCode::TooLarge,
        FileError::NotUtf8 { .. } => ErrorCode::Encoding,
        FileError::Io(_) => ErrorCode::Unreadable,
    }
}

fn plausibility_code(implausible: &Implausible) -> ErrorCode {
    match implausible {
        Implausible::NothingMoves { .. } => ErrorCode::NothingMoves,
        Implausible::HeadingConstant { .. } => ErrorCode::HeadingConstant,
        Implausible::RudderInDegrees { .. }
        | Implausible::RudderInRadians { .. }
        | Implausible::HeadingInDegrees { .. }
        | Implausible::HeadingInRadians { .. } => ErrorCode::AngleUnit,
        Implausible::YawRateInMinutes { .. } | Implausible::YawRateUnit { .. } => ErrorCode::YawRateUnit,
        Implausible::TwoInputs { .. } => ErrorCode::TwoInputs,
        Implausible::YawRateSign { .. } => ErrorCode::YawRateSign,
        Implausible::TurnsAgainstRudder { .. } | Implausible::RudderFlipped { .. } => ErrorCode::RudderSign,
    }
}

fn columns_code(error: &TrialError) -> ErrorCode {
    match error {
        TrialError::Missing(_) | TrialError::Rudder { .. } => ErrorCode::MissingChannel,
        TrialError::Length { .. } => ErrorCode::RowLength,
        TrialError::TooShort { .. } => ErrorCode::TooShort,
        TrialError::Time { .. } => ErrorCode::TimeBackwards,
    }
}
