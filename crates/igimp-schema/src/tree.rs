//! A parsed case file as a tree whose every value knows its place.

pub mod read;

use toml::Spanned;
use toml::de::{DeTable, DeValue};

use super::source::Place;

/// A value and where it stands.
#[derive(Clone, Debug)]
pub struct Node {
    /// The value.
    pub value: Value,
    /// Where it stands; of a defaulted value, where its table stands.
    pub place: Place,
    /// Whether it is written down, rather than a default.
    pub written: bool,
}

/// A value.
#[derive(Clone, Debug)]
pub enum Value {
    /// Text.
    Text(String),
    /// A whole number.
    Integer(i64),
    /// A number.
    Number(f64),
    /// Yes or no.
    Flag(bool),
    /// Several values.
    List(Vec<Node>),
    /// Values by key, in the order of the file.
    Table(Vec<Entry>),
    /// A quantity that was checked: in SI units, and as written.
    Quantity(f64, String),
    /// A date, which no key takes.
    Date(String),
    /// A value that was found wrong; what depends on it is not checked.
    Invalid,
}

/// A key and its value.
#[derive(Clone, Debug)]
pub struct Entry {
    /// The key.
    pub key: String,
    /// Where the key stands.
    pub key_place: Place,
    /// The value.
    pub node: Node,
}

impl Node {
    /// A value that is written down.
    pub fn written(value: Value, place: Place) -> Self {
        Self {
            value,
            place,
            written: true,
        }
    }

    /// A value that was found wrong.
    pub fn invalid(place: Place) -> Self {
        Self::written(Value::Invalid, place)
    }

    /// Whether the value was found wrong.
    pub fn is_invalid(&self) -> bool {
        matches!(self.value, Value::Invalid)
    }

    /// The value of a key, for a table that has it.
    pub fn get(&self, key: &str) -> Option<&Self> {
        self.entry(key).map(|entry| &entry.node)
    }

    /// The entry of a key, for a table that has it.
    pub fn entry(&self, key: &str) -> Option<&Entry> {
        self.entries().iter().find(|entry| entry.key == key)
    }

    /// The entries of a table; nothing for other values.
    pub fn entries(&self) -> &[Entry] {
        match &self.value {
            Value::Table(entries) => entries,
            _ => &[],
        }
    }

    /// The items of a list; nothing for other values.
    pub fn items(&self) -> &[Self] {
        match &self.value {
            Value::List(items) => items,
            _ => &[],
        }
    }

    /// The text, if it is one.
    pub fn text(&self) -> Option<&str> {
        match &self.value {
            Value::Text(text) => Some(text),
            _ => None,
        }
    }

    /// The number in SI units, if it is one.
    pub fn number(&self) -> Option<f64> {
        match self.value {
            Value::Quantity(value, _) | Value::Number(value) => Some(value),
            Value::Integer(value) => Some(value as f64),
            _ => None,
        }
    }

    /// The whole number, if it is one that counts something.
    pub fn count(&self) -> Option<usize> {
        match self.value {
            Value::Integer(value) => usize::try_from(value).ok(),
            _ => None,
        }
    }

    /// Yes or no, if it is that.
    pub fn flag(&self) -> Option<bool> {
        match self.value {
            Value::Flag(value) => Some(value),
            _ => None,
        }
    }

    /// The kind of its value, with an article.
    pub fn kind(&self) -> &'static str {
        match &self.value {
            Value::Text(_) | Value::Quantity(..) => "a text",
            Value::Integer(_) => "a whole number",
            Value::Number(_) => "a number",
            Value::Flag(_) => "true or false",
            Value::List(_) => "a list",
            Value::Table(_) => "a table",
            Value::Date(_) => "a date",
            Value::Invalid => "a wrong value",
        }
    }
}

/// The tree of a parsed document.
pub fn from_document(document: &Spanned<DeTable<'_>>, source: usize) -> Node {
    let place = Place::new(source, &(0..0));
    Node::written(Value::Table(entries(document.get_ref(), source)), place)
}

/// The tree of a parsed value.
pub fn from_value(value: &Spanned<DeValue<'_>>, source: usize) -> Node {
    let converted = match value.get_ref() {
        DeValue::String(text) => Value::Text(text.clone().into_owned()),
        DeValue::Integer(integer) => {
            let (text, radix) = (integer.as_str(), integer.radix());
            i64::from_str_radix(text, radix).map_or_else(
                |_| Value::Number(text.parse().unwrap_or(f64::NAN)),
                Value::Integer,
            )
        }
        DeValue::Float(float) => Value::Number(float.as_str().parse().unwrap_or(f64::NAN)),
        DeValue::Boolean(flag) => Value::Flag(*flag),
        DeValue::Datetime(date) => Value::Date(date.to_string()),
        DeValue::Array(items) => {
            Value::List(items.iter().map(|item| from_value(item, source)).collect())
        }
        DeValue::Table(table) => Value::Table(entries(table, source)),
    };
    Node::written(converted, Place::new(source, &value.span()))
}

fn entries(table: &DeTable<'_>, source: usize) -> Vec<Entry> {
    let mut entries: Vec<Entry> = table
        .iter()
        .map(|(key, value)| Entry {
            key: key.get_ref().clone().into_owned(),
            key_place: Place::new(source, &key.span()),
            node: from_value(value, source),
        })
        .collect();
    entries.sort_by_key(|entry| (entry.node.place, entry.key_place));
    entries
}

/// Moves everything that stands in a source to the right.
pub fn shift(node: &mut Node, by: usize) {
    node.place = node.place.shifted(by);
    match &mut node.value {
        Value::List(items) => items.iter_mut().for_each(|item| shift(item, by)),
        Value::Table(entries) => {
            for entry in entries {
                entry.key_place = entry.key_place.shifted(by);
                shift(&mut entry.node, by);
            }
        }
        _ => {}
    }
}

/// Something that was found wrong, and reported.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Wrong;

/// Values of keys, when the table has them and they were found right.
impl Node {
    /// The count of a key.
    pub fn count_at(&self, key: &str) -> Option<usize> {
        self.get(key)?.count()
    }

    /// The text of a key.
    pub fn text_at(&self, key: &str) -> Option<&str> {
        self.get(key)?.text()
    }

    /// Two numbers.
    pub fn pair(&self) -> Option<[f64; 2]> {
        match self.items() {
            [x, y] => Some([x.number()?, y.number()?]),
            _ => None,
        }
    }

    /// Where the value of a key stands; the table itself when it is missing.
    pub fn place_at(&self, key: &str) -> Place {
        self.get(key).map_or(self.place, |node| node.place)
    }

    /// The items of the list of a key.
    pub fn items_at(&self, key: &str) -> &[Self] {
        self.get(key).map_or(&[], Self::items)
    }

    /// The entries of a table that can grow.
    pub fn entries_mut(&mut self) -> Option<&mut Vec<Entry>> {
        match &mut self.value {
            Value::Table(entries) => Some(entries),
            _ => None,
        }
    }

    /// The value of a key, to change.
    pub fn get_mut(&mut self, key: &str) -> Option<&mut Self> {
        let entries = self.entries_mut()?;
        let entry = entries.iter_mut().find(|entry| entry.key == key)?;
        Some(&mut entry.node)
    }

    /// The items of a list, to change.
    pub fn items_mut(&mut self) -> &mut [Self] {
        match &mut self.value {
            Value::List(items) => items,
            _ => &mut [],
        }
    }

    /// Adds a value that follows from others.
    pub fn add_derived(&mut self, key: &str, value: Value) {
        let place = self.place;
        if let Some(entries) = self.entries_mut() {
            let mut node = Self::written(value, place);
            node.written = false;
            entries.push(Entry {
                key: key.to_owned(),
                key_place: place,
                node,
            });
        }
    }
}
