//! Machine-readable codes of the errors of the reader.

use document::ErrorCode;

use super::error::{ReadError, ReadProblem};
use crate::file::FileError;
use crate::plausibility::Implausibility;
use crate::record::TrialError;

impl ReadError {
    /// Machine-readable code of the error.
    pub fn code(&self) -> ErrorCode {
        match self {
            Self::Table { problem, .. } => problem.code(),
            Self::Sidecar(_) => ErrorCode::Sidecar,
        }
    }
}

impl ReadProblem {
    /// Machine-readable code of the problem.
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
            Self::MissingUnit { .. } => ErrorCode::OpenUnit,
            Self::PartsOfDegree { .. } | Self::ConverterCounts { .. } | Self::ImpossibleAngle { .. } => {
                ErrorCode::AngleScale
            }
            Self::EpochUnit { .. } | Self::MissingTimeUnit { .. } => ErrorCode::TimeUnit,
            Self::NotAStamp { .. } | Self::AmbiguousDate { .. } => ErrorCode::Stamp,
            Self::Duplicate { .. } => ErrorCode::DuplicateColumn,
            Self::NoRows { .. } | Self::TooShort { .. } => ErrorCode::TooShort,
            Self::NotANumber { .. } => ErrorCode::Cell,
            Self::WrongCellCount { .. } => ErrorCode::RowLength,
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
        FileError::Folder | FileError::NotAFile => ErrorCode::NoFile,
        FileError::TooLarge { .. } => ErrorCode::TooLarge,
        FileError::NotUtf8 { .. } => ErrorCode::Encoding,
        FileError::Io(_) => ErrorCode::Unreadable,
    }
}

fn plausibility_code(implausible: &Implausibility) -> ErrorCode {
    match implausible {
        Implausibility::NothingMoves { .. } => ErrorCode::NothingMoves,
        Implausibility::HeadingConstant { .. } => ErrorCode::HeadingConstant,
        Implausibility::RudderInDegrees { .. }
        | Implausibility::RudderInRadians { .. }
        | Implausibility::HeadingInDegrees { .. }
        | Implausibility::HeadingInRadians { .. } => ErrorCode::AngleUnit,
        Implausibility::YawRateInMinutes { .. } | Implausibility::YawRateUnit { .. } => ErrorCode::YawRateUnit,
        Implausibility::TwoInputs { .. } => ErrorCode::TwoInputs,
        Implausibility::YawRateSign { .. } => ErrorCode::YawRateSign,
        Implausibility::TurnsAgainstRudder { .. } | Implausibility::RudderFlipped { .. } => ErrorCode::RudderSign,
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
