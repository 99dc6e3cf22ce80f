//! `Display` of enums by their names in files.

use std::fmt;

use serde::Serialize;

use crate::fit::CriterionVerdict;
use crate::noise::MomentKind;
use crate::scales::ScalingVerdict;
use crate::trace::{Dependence, HeadingErrorKind, TraceVerdict};

macro_rules! display_as_in_files {
    ($($name:ty),+) => {$(
        impl fmt::Display for $name {
            fn fmt(&self, out: &mut fmt::Formatter) -> fmt::Result {
                self.serialize(out)
            }
        }
    )+};
}

display_as_in_files!(CriterionVerdict, Dependence, HeadingErrorKind, MomentKind, ScalingVerdict, TraceVerdict);
