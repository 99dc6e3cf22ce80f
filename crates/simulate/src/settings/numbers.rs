//! The numbers of settings by their keys, so that a study can set one that it draws without reading its settings again.

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

/// Whether a name of a scenario is that of a field: `rate-deg-s` of `rate_deg_s`.
pub fn is_name_of(field: &str, name: &str) -> bool {
    name.bytes().eq(field.bytes().map(|letter| if letter == b'_' { b'-' } else { letter }))
}

/// Implements [`Numbers`]: `Type: field …;` for a table, whose keys are the names of its fields, and
/// `Type = Variant …;` for a choice, whose one key names the variant there is.
#[macro_export]
macro_rules! numbers {
    () => {};
    ($type:ty: $($field:ident)*; $($rest:tt)*) => {
        impl $crate::settings::Numbers for $type {
            fn set(&mut self, key: &[String], value: f64) -> bool {
                let Some((name, below)) = key.split_first() else { return false };
                $(if $crate::settings::is_name_of(stringify!($field), name) {
                    return $crate::settings::Numbers::set(&mut self.$field, below, value);
                })*
                false
            }
        }
        $crate::numbers!($($rest)*);
    };
    ($type:ty = $($variant:ident)*; $($rest:tt)*) => {
        impl $crate::settings::Numbers for $type {
            fn set(&mut self, key: &[String], value: f64) -> bool {
                let Some((_, below)) = key.split_first() else { return false };
                match self {
                    $(Self::$variant(settings) => $crate::settings::Numbers::set(settings, below, value),)*
                    #[allow(unreachable_patterns, reason = "of some choices every variant holds numbers")]
                    _ => false,
                }
            }
        }
        $crate::numbers!($($rest)*);
    };
}
