//! Reads typed values out of a TOML document that is already in memory, and knows for every fault which key it belongs
//! to. So a scenario as it is written and a scenario that a sweep has changed, which stands in no file, give the same
//! messages.

use serde::de::value::StrDeserializer;
use serde::de::{DeserializeSeed, Deserializer, EnumAccess, MapAccess, SeqAccess, VariantAccess, Visitor};
use serde::{Deserialize, forward_to_deserialize_any};
use toml::{Table, Value};

use crate::fault::{A_LIST, A_TABLE, Error, Fault, Place};
use crate::gaps::{Filling, Gaps};
use crate::name::shown;
use crate::problem::{KeyPath, Mark, Problem};

/// Reads a whole document.
///
/// Fails with the key, what was found and what was expected.
pub fn document<'de, T: Deserialize<'de>>(table: &'de Table) -> Result<T, Problem> {
    read(table, &KeyPath::default(), None)
}

/// Reads a whole document with `values` at the keys of `gaps`, as if they stood in it.
///
/// Fails like [`document`].
pub fn filled<'de, T: Deserialize<'de>>(table: &'de Table, gaps: &Gaps, values: &'de [Value]) -> Result<T, Problem> {
    read(table, &KeyPath::default(), Some(Filling { gaps, values }))
}

/// Reads the table at `key`.
pub fn table<'de, T: Deserialize<'de>>(table: &'de Table, key: &KeyPath) -> Result<T, Problem> {
    read(table, key, None)
}

fn read<'de, T: Deserialize<'de>>(
    table: &'de Table,
    key: &KeyPath,
    filling: Option<Filling<'de, '_>>,
) -> Result<T, Problem> {
    let place = Place::Root(key);
    T::deserialize(Reader { node: Node::Table(table), place, filling }).map_err(|error| error.at(&place).into())
}

/// The problem of a table that lacks a key.
pub fn missing(table: &KeyPath, name: &'static str) -> Problem {
    Error::new(&Place::Root(table), Fault::MissingKey { name }).into()
}

/// A value or the table of a document.
#[derive(Clone, Copy)]
enum Node<'de> {
    Table(&'de Table),
    Value(&'de Value),
}

struct Reader<'de, 'a> {
    node: Node<'de>,
    place: Place<'a>,
    filling: Option<Filling<'de, 'a>>,
}

impl<'de, 'a> Reader<'de, 'a> {
    /// The reader of a value at `place`, one step below the node with this filling.
    fn below(
        value: &'de Value,
        place: Place<'a>,
        filling: Option<Filling<'de, 'a>>,
        is_it: impl Fn(&str) -> bool,
    ) -> Self {
        let (value, filling) = filling.map_or((value, None), |filling| filling.below(value, is_it));
        Self { node: Node::Value(value), place, filling }
    }

    fn table(&self) -> Option<&'de Table> {
        match self.node {
            Node::Table(table) => Some(table),
            Node::Value(value) => value.as_table(),
        }
    }

    fn value(&self) -> Option<&'de Value> {
        match self.node {
            Node::Table(_) => None,
            Node::Value(value) => Some(value),
        }
    }

    fn refuse(&self, expected: &'static str) -> Error {
        Error::new(&self.place, Fault::Type { found: self.value().map_or("a table".into(), described), expected })
    }

    fn read_table<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Error> {
        let Some(table) = self.table() else { return Err(self.refuse(A_TABLE)) };
        let entries = Entries { rest: table.iter(), value: None, place: &self.place, filling: self.filling };
        visitor.visit_map(entries).map_err(|error| error.at(&self.place))
    }

    fn whole_number(&self) -> Result<u64, Error> {
        let number = self.value().and_then(Value::as_integer).and_then(|number| u64::try_from(number).ok());
        number.ok_or_else(|| self.refuse("a whole number, 0 or above"))
    }
}

/// A value in a message.
fn described(value: &Value) -> String {
    match value {
        Value::String(text) => format!("the text {}", shown(text)),
        Value::Table(_) => "a table".to_owned(),
        Value::Array(items) => format!("a list of {}", items.len()),
        Value::Datetime(date) => format!("the date {date}"),
        Value::Integer(number) => number.to_string(),
        Value::Float(number) => format!("{number:?}"),
        Value::Boolean(answer) => answer.to_string(),
    }
}

impl<'de> Deserializer<'de> for Reader<'de, '_> {
    type Error = Error;

    fn deserialize_any<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Error> {
        match self.node {
            Node::Table(_) | Node::Value(Value::Table(_)) => self.read_table(visitor),
            Node::Value(Value::Array(_)) => self.deserialize_seq(visitor),
            Node::Value(Value::String(text)) => visitor.visit_str(text),
            Node::Value(Value::Integer(number)) => visitor.visit_i64(*number),
            Node::Value(Value::Float(number)) => visitor.visit_f64(*number),
            Node::Value(Value::Boolean(answer)) => visitor.visit_bool(*answer),
            Node::Value(Value::Datetime(_)) => Err(self.refuse("a number, a text, a list or a table")),
        }
    }

    fn deserialize_f64<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Error> {
        match self.value() {
            Some(Value::Float(number)) => visitor.visit_f64(*number),
            Some(Value::Integer(number)) => visitor.visit_f64(*number as f64),
            _ => Err(self.refuse("a number")),
        }
    }

    fn deserialize_u64<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Error> {
        visitor.visit_u64(self.whole_number()?).map_err(|error: Error| error.at(&self.place))
    }

    fn deserialize_bool<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Error> {
        match self.value().and_then(Value::as_bool) {
            Some(answer) => visitor.visit_bool(answer),
            None => Err(self.refuse("true or false, without quotes")),
        }
    }

    fn deserialize_string<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Error> {
        match self.value().and_then(Value::as_str) {
            Some(text) => visitor.visit_str(text),
            None => Err(self.refuse("a text in quotes")),
        }
    }

    fn deserialize_str<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Error> {
        self.deserialize_string(visitor)
    }

    fn deserialize_option<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Error> {
        visitor.visit_some(self)
    }

    fn deserialize_newtype_struct<V: Visitor<'de>>(self, _: &'static str, visitor: V) -> Result<V::Value, Error> {
        visitor.visit_newtype_struct(self)
    }

    fn deserialize_seq<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Error> {
        let Some(items) = self.value().and_then(Value::as_array) else {
            return Err(self.refuse(A_LIST));
        };
        let entries = Items { rest: items.iter().enumerate(), place: &self.place, filling: self.filling };
        visitor.visit_seq(entries).map_err(|error| error.at(&self.place))
    }

    fn deserialize_tuple<V: Visitor<'de>>(self, _: usize, visitor: V) -> Result<V::Value, Error> {
        self.deserialize_seq(visitor)
    }

    fn deserialize_map<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Error> {
        self.read_table(visitor)
    }

    fn deserialize_struct<V: Visitor<'de>>(
        self,
        _: &'static str,
        _: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, Error> {
        self.read_table(visitor)
    }

    fn deserialize_enum<V: Visitor<'de>>(
        self,
        _: &'static str,
        known: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, Error> {
        if let Some(name) = self.value().and_then(Value::as_str) {
            return visitor.visit_enum(Choice { name, settings: None, place: self.place, filling: None });
        }
        let Some(table) = self.table() else { return Err(self.refuse("a name, with its settings below it")) };
        let mut entries = table.iter();
        match (entries.next(), entries.next()) {
            (Some((name, settings)), None) => {
                let place = Place::Name(&self.place, name);
                visitor.visit_enum(Choice { name, settings: Some(settings), place, filling: self.filling })
            }
            _ => Err(Error::new(&self.place, Fault::NotOneName { found: table.keys().cloned().collect(), known })),
        }
    }

    forward_to_deserialize_any! {
        i8 i16 i32 i64 u8 u16 u32 f32 char bytes byte_buf unit unit_struct tuple_struct identifier ignored_any
    }
}

/// The entries of a table.
struct Entries<'de, 'a> {
    rest: toml::map::Iter<'de, String, Value>,
    value: Option<(&'de str, &'de Value)>,
    place: &'a Place<'a>,
    filling: Option<Filling<'de, 'a>>,
}

impl<'de> MapAccess<'de> for Entries<'de, '_> {
    type Error = Error;

    fn next_key_seed<K: DeserializeSeed<'de>>(&mut self, seed: K) -> Result<Option<K::Value>, Error> {
        let Some((name, value)) = self.rest.next() else { return Ok(None) };
        self.value = Some((name, value));
        let name = seed.deserialize(StrDeserializer::new(name)).map_err(|error: Error| error.at(self.place))?;
        Ok(Some(name))
    }

    fn next_value_seed<T: DeserializeSeed<'de>>(&mut self, seed: T) -> Result<T::Value, Error> {
        let (name, value) = self.value.take().expect("serde asks for a value after its key");
        let place = Place::Name(self.place, name);
        let reader = Reader::below(value, place, self.filling, |gap| gap == name);
        seed.deserialize(reader).map_err(|error| error.at(&place))
    }
}

/// The entries of a list.
struct Items<'de, 'a> {
    rest: std::iter::Enumerate<std::slice::Iter<'de, Value>>,
    place: &'a Place<'a>,
    filling: Option<Filling<'de, 'a>>,
}

impl<'de> SeqAccess<'de> for Items<'de, '_> {
    type Error = Error;

    fn next_element_seed<T: DeserializeSeed<'de>>(&mut self, seed: T) -> Result<Option<T::Value>, Error> {
        let Some((index, value)) = self.rest.next() else { return Ok(None) };
        let place = Place::Index(self.place, index);
        let reader = Reader::below(value, place, self.filling, |gap| gap.parse() == Ok(index));
        seed.deserialize(reader).map(Some).map_err(|error| error.at(&place))
    }
}

/// One of several names, with its settings where it is written as a key.
struct Choice<'de, 'a> {
    name: &'de str,
    settings: Option<&'de Value>,
    place: Place<'a>,
    /// Of the node that names it.
    filling: Option<Filling<'de, 'a>>,
}

impl<'de> EnumAccess<'de> for Choice<'de, '_> {
    type Error = Error;
    type Variant = Self;

    fn variant_seed<V: DeserializeSeed<'de>>(self, seed: V) -> Result<(V::Value, Self), Error> {
        match seed.deserialize(StrDeserializer::new(self.name)) {
            Ok(variant) => Ok((variant, self)),
            Err(Error { fault: Fault::UnknownName { name, known, .. }, .. }) => {
                let mark = if self.settings.is_some() { Mark::Name } else { Mark::Value };
                Err(Error::new(&self.place, Fault::UnknownName { name, known, mark }))
            }
            Err(error) => Err(error.at(&self.place)),
        }
    }
}

impl<'de, 'a> Choice<'de, 'a> {
    fn reader(self) -> Result<Reader<'de, 'a>, Error> {
        match self.settings {
            Some(value) => Ok(Reader::below(value, self.place, self.filling, |gap| gap == self.name)),
            None => Err(Error::new(&self.place, Fault::NoSettings { name: self.name.to_owned() })),
        }
    }
}

impl<'de> VariantAccess<'de> for Choice<'de, '_> {
    type Error = Error;

    fn unit_variant(self) -> Result<(), Error> {
        match self.settings {
            None => Ok(()),
            Some(_) => Err(Error::new(
                &self.place,
                Fault::Type { found: "written as a key".into(), expected: "the name alone, as a text in quotes" },
            )),
        }
    }

    fn newtype_variant_seed<T: DeserializeSeed<'de>>(self, seed: T) -> Result<T::Value, Error> {
        let place = self.place;
        seed.deserialize(self.reader()?).map_err(|error| error.at(&place))
    }

    fn tuple_variant<V: Visitor<'de>>(self, _: usize, visitor: V) -> Result<V::Value, Error> {
        self.reader()?.deserialize_seq(visitor)
    }

    fn struct_variant<V: Visitor<'de>>(self, _: &'static [&'static str], visitor: V) -> Result<V::Value, Error> {
        self.reader()?.read_table(visitor)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sweep;

    #[derive(Debug, Deserialize)]
    #[serde(deny_unknown_fields, rename_all = "kebab-case")]
    struct Trial {
        sampling_s: f64,
        #[serde(default)]
        rows: Option<usize>,
        #[serde(default)]
        side: Side,
        #[serde(default)]
        methods: Vec<Method>,
    }

    #[derive(Debug, Default, PartialEq, Deserialize)]
    #[serde(rename_all = "kebab-case")]
    enum Side {
        #[default]
        Port,
        Starboard,
    }

    #[derive(Debug, Deserialize)]
    #[serde(rename_all = "kebab-case")]
    enum Method {
        Srivc(Settings),
    }

    #[derive(Debug, Deserialize)]
    #[serde(deny_unknown_fields)]
    struct Settings {
        #[serde(default)]
        limit: f64,
    }

    fn read(text: &str) -> Result<Trial, Problem> {
        document(&text.parse::<Table>().expect("well formed"))
    }

    #[test]
    fn reads_what_is_right() {
        let trial =
            read("sampling-s = 1\nrows = 3\nside = \"starboard\"\n[[methods]]\nsrivc.limit = 2.5").expect("right");
        assert_eq!((trial.sampling_s, trial.rows, trial.side), (1.0, Some(3), Side::Starboard));
        let Method::Srivc(settings) = &trial.methods[0];
        assert_eq!(settings.limit, 2.5);
    }

    /// Both ways to change a document: before it is read, and while it is read.
    fn changed(text: &str, keys: &[&str], value: f64) -> [Result<Trial, Problem>; 2] {
        let mut table: Table = text.parse().expect("well formed");
        let keys: Vec<KeyPath> = keys.iter().map(|key| KeyPath::dotted(key)).collect();
        let values = vec![Value::Float(value); keys.len()];
        let while_read = filled(&table, &Gaps::new(&keys), &values);
        for key in &keys {
            sweep::set(&mut table, key, Value::Float(value)).expect("the key is there");
        }
        [document(&table), while_read]
    }

    #[test]
    fn gaps_are_filled_in_tables_lists_and_choices() {
        let text = "sampling-s = 1\nrows = 3\n[[methods]]\nsrivc.limit = 2.5\n[[methods]]\nsrivc.limit = 3.5";
        for trial in changed(text, &["sampling-s", "methods.1.srivc.limit"], 7.0) {
            let trial = trial.expect("right");
            let limits: Vec<f64> = trial.methods.iter().map(|Method::Srivc(settings)| settings.limit).collect();
            assert_eq!((trial.sampling_s, trial.rows, limits), (7.0, Some(3), vec![2.5, 7.0]));
        }
        for key in ["rows", "side", "methods", "methods.0", "methods.1.srivc"] {
            let [before, while_read] =
                changed(&format!("side = \"port\"\n{text}"), &[key], 2.5).map(Result::unwrap_err);
            assert_eq!(before, while_read);
            assert_eq!(before.found, format!("`{key}` is 2.5"));
        }
    }

    #[test]
    fn every_fault_has_its_key() {
        for (text, key, found) in [
            ("", "", "a scenario has no key `sampling-s`"),
            ("sampling = 1", "sampling", "a scenario has no key `sampling`"),
            ("sampling-s = \"x\"", "sampling-s", "`sampling-s` is the text \"x\""),
            ("sampling-s = 1\nrows = -2", "rows", "`rows` is -2"),
            ("sampling-s = 1\nrows = 2.5", "rows", "`rows` is 2.5"),
            ("sampling-s = 1\nside = \"left\"", "side", "`side` is the text \"left\""),
            ("sampling-s = 1\nmethods = 3", "methods", "`methods` is 3"),
            ("sampling-s = 1\n[[methods]]\nsrivk = {}", "methods.0.srivk", "no setting is called `srivk`"),
            ("sampling-s = 1\nmethods = [\"srivc\"]", "methods.0", "`methods.0` is the text \"srivc\""),
            ("sampling-s = 1\n[[methods]]\n", "methods.0", "`methods.0` names nothing"),
            (
                "sampling-s = 1\n[[methods]]\nsrivc.limt = 1",
                "methods.0.srivc.limt",
                "`methods.0.srivc` has no key `limt`",
            ),
            (
                "sampling-s = 1\n[[methods]]\nsrivc.limit = true",
                "methods.0.srivc.limit",
                "`methods.0.srivc.limit` is true",
            ),
            ("sampling-s = 1\nrows = 1979-05-27", "rows", "`rows` is the date 1979-05-27"),
        ] {
            let problem = read(text).expect_err(text);
            assert_eq!((problem.key.to_string().as_str(), problem.found.as_str()), (key, found), "{text}");
        }
    }
}
