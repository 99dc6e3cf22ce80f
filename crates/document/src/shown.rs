//! Values shown by the words that files have for them.

use std::fmt;

use serde::Serialize;

use crate::fit::CriterionVerdict;
use crate::noise::Moment;
use crate::scales::Scaling;
use crate::trace::{Dependence, HeadingWander, Verdict};

macro_rules! shown_as_in_files {
    ($($name:ty),+) => {$(
        impl fmt::Display for $name {
            fn fmt(&self, out: &mut fmt::Formatter) -> fmt::Result {
                self.serialize(out)
            }
        }
    )+};
}

shown_as_in_files!(CriterionVerdict, Dependence, HeadingWander, Moment, Scaling, Verdict);
