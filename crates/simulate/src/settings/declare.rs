//! How a setting is declared: once, with the unit in its name and the meaning in the comment above it. From that follow
//! what serde reads and writes, and the lists of keys for a person.

use std::fmt;

/// A key of a scenario, for a person who looks for it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Key {
    /// With dots, from the root of a scenario.
    pub key: String,
    /// Unit of the number, or what stands there instead of one.
    pub unit: String,
    /// What holds when it is left out.
    pub default: LeftOut,
    /// In the words of the field.
    pub meaning: String,
}

/// What holds when a key is left out.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum LeftOut {
    /// It cannot be left out where the table it stands in is given.
    Required,
    /// What the meaning of the key says.
    Nothing,
    /// This value.
    Value(&'static str),
}

impl fmt::Display for LeftOut {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Required => "required",
            Self::Nothing => "–",
            Self::Value(value) => value,
        })
    }
}

/// What may stand behind a key.
pub enum Kind {
    /// A number, whose unit is in the name of the key.
    Number,
    /// A whole number.
    Count,
    /// True or false.
    Truth,
    /// A text.
    Text,
    /// One of these names; the first is the default where there is one.
    Name(&'static [&'static str]),
    /// Keys of its own.
    Table(Vec<Entry>),
}

/// A type that may stand behind a key.
pub trait Written {
    /// Whether nothing may stand there instead.
    const OPTIONAL: bool = false;

    /// What is written.
    fn kind() -> Kind;
}

/// A declared setting.
pub struct Entry {
    name: String,
    default: LeftOut,
    meaning: String,
    kind: Kind,
}

impl Entry {
    /// The setting of this type that a field or a variant declares.
    pub fn new<T: Written>(name: &str, comment: &[&str], has_default: bool) -> Self {
        let kind = T::kind();
        let default = match &kind {
            _ if T::OPTIONAL => LeftOut::Nothing,
            _ if !has_default => LeftOut::Required,
            Kind::Number => LeftOut::Value("0"),
            Kind::Truth => LeftOut::Value("false"),
            Kind::Name(names) => LeftOut::Value(names[0]),
            Kind::Count | Kind::Text | Kind::Table(_) => LeftOut::Nothing,
        };
        let meaning = comment.iter().map(|line| line.trim()).collect::<Vec<_>>().join(" ");
        Self { name: in_kebab_case(name), default, meaning, kind }
    }

    /// Its key below `path`, and the keys below it.
    pub fn keys(&self, path: &str) -> Vec<Key> {
        let key = format!("{path}{}{}", if path.is_empty() { "" } else { "." }, self.name);
        let (unit, below) = match &self.kind {
            Kind::Number => (unit_of(&self.name).to_owned(), [].as_slice()),
            Kind::Count => ("whole number".to_owned(), [].as_slice()),
            Kind::Truth => ("true or false".to_owned(), [].as_slice()),
            Kind::Text => ("text".to_owned(), [].as_slice()),
            Kind::Name(names) => (names.join(" or "), [].as_slice()),
            Kind::Table(entries) => ("table".to_owned(), entries.as_slice()),
        };
        let below = below.iter().flat_map(|entry| entry.keys(&key)).collect::<Vec<_>>();
        let own = Key { unit, default: self.default, meaning: self.meaning.clone(), key };
        [own].into_iter().chain(below).collect()
    }
}

/// `rate_deg_s` and `ZigZag` as a scenario writes them: `rate-deg-s`, `zig-zag`.
fn in_kebab_case(name: &str) -> String {
    let mut words = String::new();
    for letter in name.chars() {
        if letter == '_' || (letter.is_uppercase() && !words.is_empty()) {
            words.push('-');
        }
        words.extend(letter.to_lowercase().filter(|&letter| letter != '_'));
    }
    words
}

/// Endings of keys and the units they stand for, the longest first.
const UNITS: [(&str, &str); 8] = [
    ("-deg-per-root-s", "deg/√s"),
    ("-deg-per-s", "deg/s"),
    ("-deg-s", "deg/s"),
    ("-rad-s", "rad/s"),
    ("-m-s", "m/s"),
    ("-deg", "deg"),
    ("-s", "s"),
    ("-rows", "rows"),
];

fn unit_of(name: &str) -> &'static str {
    UNITS.iter().find(|(ending, _)| name.ends_with(ending)).map_or("1", |(_, unit)| unit)
}

macro_rules! written {
    ($($type:ty: $kind:expr),* $(,)?) => {
        $(impl Written for $type {
            fn kind() -> Kind {
                $kind
            }
        })*
    };
}

written! {
    f64: Kind::Number,
    usize: Kind::Count,
    bool: Kind::Truth,
    String: Kind::Text,
    crate::manoeuvre::Side: Kind::Name(&["starboard", "port"]),
}

impl<T: Written> Written for Option<T> {
    const OPTIONAL: bool = true;

    fn kind() -> Kind {
        T::kind()
    }
}

/// Declares a table of settings, or a choice of one of several. Comments are read by users of `study list` too.
///
/// A field that is no `Option` is required, unless it or its table has `#[serde(default)]`; every default is that of
/// the type.
macro_rules! settings {
    ($(#[doc = $about:literal])+ $(#[derive($derive:ident)])? $(#[serde($all:ident)])? pub struct $name:ident {
        $($(#[doc = $meaning:literal])+ $(#[serde($default:ident)])? pub $field:ident: $type:ty,)*
    }) => {
        $(#[doc = $about])+
        #[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize $(, $derive)?)]
        #[serde(deny_unknown_fields, rename_all = "kebab-case" $(, $all)?)]
        pub struct $name {
            $($(#[doc = $meaning])+ $(#[serde($default)])? pub $field: $type,)*
        }

        impl $crate::settings::declare::Written for $name {
            fn kind() -> $crate::settings::declare::Kind {
                use $crate::settings::declare::{Entry, Kind};
                let has_default = false $(|| !stringify!($all).is_empty())?;
                Kind::Table(vec![
                    $(Entry::new::<$type>(stringify!($field), &[$($meaning),+], has_default $(|| !stringify!($default).is_empty())?),)*
                ])
            }
        }
    };
    ($(#[$($about:tt)*])+ pub enum $name:ident {
        $($(#[doc = $meaning:literal])+ $variant:ident($type:ty),)*
    }) => {
        $(#[$($about)*])+
        #[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
        #[serde(rename_all = "kebab-case")]
        pub enum $name {
            $($(#[doc = $meaning])+ $variant($type),)*
        }

        impl $crate::settings::declare::Written for $name {
            fn kind() -> $crate::settings::declare::Kind {
                use $crate::settings::declare::{Entry, Kind};
                Kind::Table(vec![$(Entry::new::<Option<$type>>(stringify!($variant), &[$($meaning),+], false),)*])
            }
        }
    };
}

pub(crate) use settings;
