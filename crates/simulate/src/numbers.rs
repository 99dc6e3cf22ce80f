//! The numbers of settings by their keys, so that a study can set one that it draws without reading its settings again.

use std::collections::BTreeMap;

use ship::angle::DEGREE;

/// Settings that hold numbers.
pub trait Numbers {
    /// Sets the number at a key, given name by name; `false` where there is none, or one that was left out.
    fn set(&mut self, key: &[String], value: f64) -> bool;
}

impl Numbers for f64 {
    fn set(&mut self, key: &[String], value: f64) -> bool {
        if key.is_empty() {
            *self = value;
        }
        key.is_empty()
    }
}

impl<T: Numbers> Numbers for Option<T> {
    fn set(&mut self, key: &[String], value: f64) -> bool {
        self.as_mut().is_some_and(|settings| settings.set(key, value))
    }
}

impl<T: Numbers> Numbers for Vec<T> {
    fn set(&mut self, key: &[String], value: f64) -> bool {
        let Some((index, below)) = key.split_first() else { return false };
        index.parse().ok().and_then(|index: usize| self.get_mut(index)).is_some_and(|item| item.set(below, value))
    }
}

impl<T: Numbers> Numbers for BTreeMap<String, T> {
    fn set(&mut self, key: &[String], value: f64) -> bool {
        let Some((name, below)) = key.split_first() else { return false };
        self.get_mut(name).is_some_and(|item| item.set(below, value))
    }
}

impl Numbers for trial::Manoeuvre {
    fn set(&mut self, key: &[String], value: f64) -> bool {
        let [_, name] = key else { return false };
        self.number(name).map(|number| *number = value * unit(name)).is_some()
    }
}

/// Size in SI of the unit that the name of a key says.
pub fn unit(key: &str) -> f64 {
    if key.split(['-', '.']).any(|word| word == "deg") { DEGREE } else { 1.0 }
}

/// Implements [`Numbers`]: `Type: "key" field, …;`. A number in SI is set in the unit of its key.
#[macro_export]
macro_rules! numbers {
    ($($type:ty: $($key:literal $field:ident),*;)*) => {$(
        impl $crate::numbers::Numbers for $type {
            fn set(&mut self, key: &[String], value: f64) -> bool {
                let Some((name, below)) = key.split_first() else { return false };
                let value = if below.is_empty() { value * $crate::numbers::unit(name) } else { value };
                match name.as_str() {
                    $($key => $crate::numbers::Numbers::set(&mut self.$field, below, value),)*
                    _ => false,
                }
            }
        }
    )*};
}
