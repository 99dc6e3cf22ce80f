//! Angles in files: degrees in the file, radians in the program.

use std::borrow::Cow;
use std::marker::PhantomData;

use schemars::{JsonSchema, Schema, SchemaGenerator};
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use ship::ShortNumber;
use ship::angle::{from_deg, to_deg};

/// Serde adapter of an angle or angular rate, degrees in the file and rad in memory: `#[serde(with = "Degrees::<…>")]`.
pub struct Degrees<T>(PhantomData<T>);

/// Number or optional number that [`Degrees`] converts.
pub trait Angle: Sized {
    /// Applies a conversion to the number.
    fn map_angle(self, change: fn(f64) -> f64) -> Self;
}

impl Angle for f64 {
    fn map_angle(self, change: fn(f64) -> f64) -> Self {
        change(self)
    }
}

impl Angle for Option<f64> {
    fn map_angle(self, change: fn(f64) -> f64) -> Self {
        self.map(change)
    }
}

/// Degrees of an angle (rad), rounded to 14 significant digits so that the rounding of a conversion to radians and
/// back vanishes.
pub fn written_deg(angle: f64) -> f64 {
    ShortNumber::rounded(to_deg(angle), 14).0
}

impl<T: Angle + Copy + Serialize> Degrees<T> {
    /// Writes an angle in rad as degrees.
    pub fn serialize<S: Serializer>(angle: &T, serializer: S) -> Result<S::Ok, S::Error> {
        angle.map_angle(written_deg).serialize(serializer)
    }
}

impl<T: Angle> Degrees<T> {
    /// Angle in rad from degrees in the file.
    pub fn deserialize<'de, D: Deserializer<'de>>(deserializer: D) -> Result<T, D::Error>
    where
        T: Deserialize<'de>,
    {
        T::deserialize(deserializer).map(|angle| angle.map_angle(from_deg))
    }
}

impl<T: JsonSchema> JsonSchema for Degrees<T> {
    fn inline_schema() -> bool {
        true
    }

    fn schema_name() -> Cow<'static, str> {
        T::schema_name()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        T::json_schema(generator)
    }
}
