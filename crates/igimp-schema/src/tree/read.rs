//! Reads values of a completed tree into types: what a table of the schema is read with.

use std::ops::Deref;

use super::{Entry, Node, Value, Wrong};
use crate::source::Place;

/// A value and where it stands.
#[derive(Clone, Debug)]
pub struct At<T> {
    /// The value.
    pub value: T,
    /// Where it stands; of a defaulted value, where its table stands.
    pub place: Place,
    /// Where its key stands, if it has one.
    pub key_place: Place,
    /// Whether it is written down, rather than a default.
    pub written: bool,
}

/// A value, if it was found right.
pub type Found<T> = Result<At<T>, Wrong>;

impl<T> Deref for At<T> {
    type Target = T;

    fn deref(&self) -> &T {
        &self.value
    }
}

/// A value of one of two types.
#[derive(Clone, Debug)]
pub enum Either<A, B> {
    /// The first.
    First(A),
    /// The second.
    Second(B),
}

impl<A: Copy, B> At<Either<A, B>> {
    /// The first, if it is that.
    pub fn first(&self) -> Option<At<A>> {
        let Either::First(value) = self.value else {
            return None;
        };
        Some(At {
            value,
            place: self.place,
            key_place: self.key_place,
            written: self.written,
        })
    }
}

/// A table under a name.
#[derive(Clone, Debug)]
pub struct Named<T> {
    /// The name.
    pub name: String,
    /// Where the name stands.
    pub name_place: Place,
    /// Where the table stands.
    pub place: Place,
    /// The table, if it was found right.
    pub value: Result<T, Wrong>,
}

/// Tables under names, in the order of the file.
#[derive(Clone, Debug)]
pub struct NamedTables<T>(pub Vec<Named<T>>);

/// A type that values are read into.
pub trait Read: Sized {
    /// The value of a node.
    ///
    /// # Errors
    /// [`Wrong`] when the value was found wrong; the problem is reported already.
    fn read(node: &Node) -> Result<Self, Wrong>;
}

/// A type that the value of a key is read into.
pub trait ReadKey: Sized {
    /// The value of a key, if the table has it.
    ///
    /// # Errors
    /// [`Wrong`] when the value was found wrong, or is missing and has to be there; the problem is reported already.
    fn read_key(entry: Option<&Entry>) -> Result<Self, Wrong>;
}

impl<T: Read> ReadKey for At<T> {
    fn read_key(entry: Option<&Entry>) -> Result<Self, Wrong> {
        let entry = entry.ok_or(Wrong)?;
        Ok(Self {
            key_place: entry.key_place,
            ..Self::read(&entry.node)?
        })
    }
}

impl<T: Read> ReadKey for Option<At<T>> {
    fn read_key(entry: Option<&Entry>) -> Result<Self, Wrong> {
        entry.map(|entry| At::read_key(Some(entry))).transpose()
    }
}

/// By itself: what was found wrong leaves what is beside it.
impl<T: ReadKey> ReadKey for Result<T, Wrong> {
    fn read_key(entry: Option<&Entry>) -> Result<Self, Wrong> {
        Ok(T::read_key(entry))
    }
}

impl<T: Read> Read for At<T> {
    fn read(node: &Node) -> Result<Self, Wrong> {
        Ok(Self {
            value: T::read(node)?,
            place: node.place,
            key_place: node.place,
            written: node.written,
        })
    }
}

impl Read for f64 {
    fn read(node: &Node) -> Result<Self, Wrong> {
        node.number().ok_or(Wrong)
    }
}

impl Read for usize {
    fn read(node: &Node) -> Result<Self, Wrong> {
        node.count().ok_or(Wrong)
    }
}

impl Read for bool {
    fn read(node: &Node) -> Result<Self, Wrong> {
        node.flag().ok_or(Wrong)
    }
}

impl Read for String {
    fn read(node: &Node) -> Result<Self, Wrong> {
        node.text().map(str::to_owned).ok_or(Wrong)
    }
}

impl<A: Read, B: Read> Read for Either<A, B> {
    fn read(node: &Node) -> Result<Self, Wrong> {
        A::read(node)
            .map(Self::First)
            .or_else(|Wrong| B::read(node).map(Self::Second))
    }
}

/// By itself: what was found wrong leaves what is beside it.
impl<T: Read> Read for Result<T, Wrong> {
    fn read(node: &Node) -> Result<Self, Wrong> {
        Ok(T::read(node))
    }
}

impl<T: Read, const N: usize> Read for [T; N] {
    fn read(node: &Node) -> Result<Self, Wrong> {
        let items: Result<Vec<T>, Wrong> = items(node)?.iter().map(T::read).collect();
        items?.try_into().map_err(|_| Wrong)
    }
}

impl<T: Read> Read for Vec<T> {
    fn read(node: &Node) -> Result<Self, Wrong> {
        items(node)?.iter().map(T::read).collect()
    }
}

impl<T: Read> Read for NamedTables<T> {
    fn read(node: &Node) -> Result<Self, Wrong> {
        is_table(node)?;
        let named = |entry: &Entry| Named {
            name: entry.key.clone(),
            name_place: entry.key_place,
            place: entry.node.place,
            value: T::read(&entry.node),
        };
        Ok(Self(node.entries().iter().map(named).collect()))
    }
}

/// A name that was found wrong: none that can be written.
const UNKNOWN: &str = "?";

impl At<String> {
    /// The name, if it was found right.
    pub fn known(&self) -> Option<String> {
        (self.value != UNKNOWN).then(|| self.value.clone())
    }
}

/// A name in a table; a question mark where it was found wrong, so that what is beside it is looked at.
pub(crate) fn name_in(table: &Node, key: &str) -> At<String> {
    let node = table.get(key).unwrap_or(table);
    At {
        value: node.text().unwrap_or(UNKNOWN).to_owned(),
        place: node.place,
        key_place: node.place,
        written: node.written,
    }
}

/// Whether a value is a table.
pub(crate) fn is_table(node: &Node) -> Result<(), Wrong> {
    matches!(node.value, Value::Table(_))
        .then_some(())
        .ok_or(Wrong)
}

fn items(node: &Node) -> Result<&[Node], Wrong> {
    match &node.value {
        Value::List(items) => Ok(items),
        _ => Err(Wrong),
    }
}
