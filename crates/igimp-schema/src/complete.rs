//! Checks a tree against the schema and completes it with defaults.
//!
//! A wrong value becomes [`Value::Invalid`], so that one slip is reported once.

pub mod plausible;
mod retired;
pub(crate) mod value;

use toml::de::DeValue;

use super::diagnostic::Problems;
use super::names::check_name;
use super::schema::{MATERIALS_ALONE, MOST_THINGS, ROOT, SPACE, SYMBOLS, bodies_of};
use super::source::{Place, Source};
use super::spec::{Bodies, Field, Kind, Presence, Struct, Variants};
use super::text::{clip, row};
use super::tree::{Entry, Node, Value, from_value};
use crate::names::suggest::nearest;
use value::check_value;

/// The completed tree of a case file.
pub fn complete(tree: &Node, sources: &[Source], problems: &mut Problems) -> Node {
    let mut completer = Completer {
        sources,
        problems,
        bodies: bodies_of(tree),
    };
    completer.table(tree, &ROOT, None)
}

/// The completed tree of a file of materials alone.
pub fn complete_materials(tree: &Node, sources: &[Source], problems: &mut Problems) -> Node {
    let mut completer = Completer {
        sources,
        problems,
        bodies: Bodies::Plane,
    };
    completer.table(tree, &MATERIALS_ALONE, None)
}

/// Keys of tables that say how a property varies.
const OF_PROFILES: [&str; 6] = ["at_top", "at_surface", "levels", "depths", "rows", "raster"];

/// Carries the texts and collects the problems.
pub(crate) struct Completer<'a> {
    pub(crate) sources: &'a [Source],
    pub(crate) problems: &'a mut Problems,
    /// The bodies of the analysis.
    bodies: Bodies,
}

/// That a key is one of the other analysis.
fn of_other(bodies: Bodies, key: &str) -> String {
    if bodies == Bodies::Space {
        format!("`{key}` is a key of analysis = \"plane-strain\"")
    } else {
        format!("`{key}` is a key of analysis = \"{SPACE}\"")
    }
}

impl Completer<'_> {
    /// The text of a value as it is written.
    pub(crate) fn slice(&self, place: Place) -> String {
        let text = self
            .sources
            .get(place.source)
            .map_or("", |source| source.slice(place));
        clip(text, 40)
    }

    /// A value of a key, completed.
    pub(crate) fn value(&mut self, node: &Node, kind: &'static Kind, key: &str) -> Node {
        match (kind, &node.value) {
            (_, Value::Invalid) => node.clone(),
            (Kind::Table(of), Value::Table(_)) => self.table(node, of, Some(key)),
            (Kind::Variants(of), Value::Table(_)) => self.variants(node, of, key),
            (Kind::Map(of, kind), Value::Table(_)) => self.map(node, of, kind),
            (Kind::Vector(of), Value::List(items)) => {
                let axes = if self.bodies == Bodies::Space { 3 } else { 2 };
                if items.len() != axes {
                    self.wrong_length(node, (axes, axes), items.len(), key);
                    return Node::invalid(node.place);
                }
                let items = items.iter().map(|item| self.value(item, of, key)).collect();
                Node {
                    value: Value::List(items),
                    ..*node
                }
            }
            (Kind::List(of, least, most), Value::List(items)) => {
                if items.len() < *least || items.len() > *most {
                    self.wrong_length(node, (*least, *most), items.len(), key);
                    return Node::invalid(node.place);
                }
                let items = items.iter().map(|item| self.value(item, of, key)).collect();
                Node {
                    value: Value::List(items),
                    ..*node
                }
            }
            (Kind::Either(kinds), _) => match kinds.iter().find(|kind| takes(kind, &node.value)) {
                Some(kind) => self.value(node, kind, key),
                None => self.wrong_type(node, kind, key),
            },
            _ => check_value(self, node, kind, key),
        }
    }

    /// Reports a value of the wrong type.
    pub(crate) fn wrong_type(&mut self, node: &Node, kind: &Kind, key: &str) -> Node {
        let message = format!("expected {}, found {}", kind.expectation(), node.kind());
        let problem = self.problems.error(node.place, message);
        match (kind, &node.value) {
            (Kind::List(Kind::Table(_) | Kind::Variants(_), ..), Value::Table(_)) => {
                problem.help(format!("write [[{key}]] in double brackets"));
            }
            (Kind::Table(_) | Kind::Map(..), Value::List(_)) => {
                problem.help(format!("write [{key}] in single brackets"));
            }
            (Kind::Number(_) | Kind::Quantity(..), Value::Table(_))
                if OF_PROFILES.iter().any(|inner| node.get(inner).is_some()) =>
            {
                problem.help(format!(
                    "`{key}` is one for all soil of a material: where it varies, layers with a material each"
                ));
            }
            (
                Kind::Number(_)
                | Kind::Integer(..)
                | Kind::Flag
                | Kind::Either([Kind::Number(_), ..]),
                Value::Text(text),
            ) if DeValue::parse(text).is_ok() => {
                problem.help(format!("write it without quotes: {key} = {text}"));
            }
            _ => {}
        }
        Node::invalid(node.place)
    }

    fn wrong_length(&mut self, node: &Node, range: (usize, usize), found: usize, key: &str) {
        let (least, most) = range;
        let message = if least == most {
            format!("`{key}` takes a list of {least} values, found {found}")
        } else if found < least {
            format!("`{key}` needs at least {least} items, found {found}")
        } else {
            format!("`{key}` takes at most {most} items, found {found}")
        };
        self.problems.error(node.place, message);
    }

    fn table(&mut self, node: &Node, of: &'static Struct, name: Option<&str>) -> Node {
        let mut entries = Vec::with_capacity(of.fields.len());
        let bodies = self.bodies;
        let applies = |field: &&Field| field.applies(bodies);
        let fields: Vec<_> = of.fields.iter().filter(applies).collect();
        let known: Vec<_> = fields.iter().map(|field| field.key).collect();
        let elsewhere = |key: &str| {
            of.fields
                .iter()
                .any(|field| field.key == key)
                .then(|| of_other(bodies, key))
        };
        let meant = self.unknown_keys(node, &known, name, &elsewhere);
        self.fields(node, &fields, &meant, name.is_none(), &mut entries);
        Node {
            value: Value::Table(entries),
            ..*node
        }
    }

    fn variants(&mut self, node: &Node, of: &'static Variants, name: &str) -> Node {
        let bodies = self.bodies;
        let applies = |field: &&'static Field| field.applies(bodies);
        let before: Vec<_> = of.before.iter().filter(applies).collect();
        let mut entries = Vec::new();
        let names = || of.cases.iter().map(|case| case.name);
        let mut found = None;
        let tag = match node.get(of.tag) {
            None => {
                let example = names().next().unwrap_or_default();
                self.problems
                    .error(node.place, format!("missing field `{}`", of.tag))
                    .help(format!("add {} = \"{example}\"", of.tag))
                    .help(format!("choices: {}", row(names())));
                Node::invalid(node.place)
            }
            Some(tag) => match tag.text() {
                Some(text) => {
                    found = of.find(text);
                    if found.is_none() {
                        self.unknown_choice(tag, text, of.tag, names().collect());
                        Node::invalid(tag.place)
                    } else {
                        tag.clone()
                    }
                }
                None => self.wrong_type(tag, &Kind::Text, of.tag),
            },
        };
        let known: Vec<_> = match found {
            Some(case) => of
                .fields(case)
                .filter(applies)
                .map(|field| field.key)
                .collect(),
            None => (of.cases.iter())
                .flat_map(|case| of.fields(case))
                .map(|field| field.key)
                .collect(),
        };
        let known: Vec<_> = std::iter::once(of.tag).chain(known).collect();
        let elsewhere = |key: &str| {
            let known = |case| of.fields(case).any(|field| field.key == key);
            if found.is_some_and(known) {
                return Some(of_other(bodies, key));
            }
            let case =
                (of.cases.iter()).find(|case| case.fields.iter().any(|field| field.key == key))?;
            Some(format!(
                "`{key}` is a field of {} = \"{}\"",
                of.tag, case.name
            ))
        };
        let meant = self.unknown_keys(node, &known, Some(name), &elsewhere);
        self.fields(node, &before, &meant, false, &mut entries);
        entries.push(Entry {
            key: of.tag.to_owned(),
            key_place: node.entry(of.tag).map_or(node.place, |e| e.key_place),
            node: tag,
        });
        let after: Vec<_> = match found {
            Some(case) => case.fields.iter().chain(of.after).filter(applies).collect(),
            None => Vec::new(),
        };
        self.fields(node, &after, &meant, false, &mut entries);
        Node {
            value: Value::Table(entries),
            ..*node
        }
    }

    fn map(&mut self, node: &Node, of: &str, kind: &'static Variants) -> Node {
        if node.entries().is_empty() {
            self.problems
                .error(node.place, format!("there is no {of}"))
                .help(format!("add a table [{of}s.NAME]"));
            return Node::invalid(node.place);
        }
        if node.entries().len() > MOST_THINGS {
            self.problems.error(
                node.place,
                format!("there are more than {MOST_THINGS} {of}s"),
            );
            return Node::invalid(node.place);
        }
        let mut entries = Vec::new();
        for entry in node.entries() {
            check_name(&entry.key, entry.key_place, self.problems);
            let value = match entry.node.value {
                Value::Table(_) => self.variants(&entry.node, kind, &entry.key),
                _ => self.wrong_type(&entry.node, &Kind::Variants(kind), &entry.key),
            };
            entries.push(Entry {
                key: entry.key.clone(),
                key_place: entry.key_place,
                node: value,
            });
        }
        Node {
            value: Value::Table(entries),
            ..*node
        }
    }

    /// Reports keys that are not known; returns those that they probably mean.
    fn unknown_keys(
        &mut self,
        node: &Node,
        known: &[&'static str],
        name: Option<&str>,
        elsewhere: &dyn Fn(&str) -> Option<String>,
    ) -> Vec<&'static str> {
        let mut meant = Vec::new();
        let is_missing = |key: &&&str| node.get(key).is_none();
        let missing: Vec<_> = known.iter().filter(is_missing).copied().collect();
        for entry in node.entries() {
            if known.contains(&entry.key.as_str()) {
                continue;
            }
            let message = format!("unknown field `{}`", clip(&entry.key, 40));
            let are_many = self.problems.are_many();
            let problem = self.problems.error(entry.key_place, message);
            if are_many {
                continue;
            }
            if let Some(help) = retired::remedy(name, &entry.key) {
                problem.help(help);
                continue;
            }
            if let Some(help) = elsewhere(&entry.key) {
                problem.help(help);
                continue;
            }
            let near = symbol(&entry.key, known)
                .or_else(|| nearest(&entry.key, missing.clone()))
                .or_else(|| nearest(&entry.key, known.to_vec()));
            if let Some(near) = near {
                let near = known.iter().find(|key| **key == near).copied();
                meant.extend(near);
                problem.help(format!("did you mean `{}`?", near.unwrap_or_default()));
            } else if let Some(table) = table_of(&entry.key).filter(|table| Some(*table) != name) {
                problem.help(format!("`{}` belongs in [{table}]", entry.key));
            } else {
                // A key that several forms have is one.
                let first = |(k, key): &(usize, &&str)| !known[..*k].contains(*key);
                let once = known.iter().enumerate().filter(first);
                let once = once.map(|(_, key)| *key);
                problem.help(format!("known fields: {}", row(once)));
            }
        }
        meant
    }

    /// Completes fields in the order in which they are declared.
    fn fields(
        &mut self,
        node: &Node,
        fields: &[&'static Field],
        meant: &[&str],
        is_root: bool,
        out: &mut Vec<Entry>,
    ) {
        for field in fields {
            let (key_place, value) = if let Some(entry) = node.entry(field.key) {
                let value = self.value(&entry.node, &field.kind, field.key);
                (entry.key_place, value)
            } else {
                let value = match field.presence {
                    Presence::Required(_) if meant.contains(&field.key) => {
                        Node::invalid(node.place)
                    }
                    Presence::Required(example) => {
                        self.missing(field, example, (!is_root).then_some(node.place));
                        Node::invalid(node.place)
                    }
                    Presence::Default(literal) => self.default(field, literal, node.place),
                    Presence::Derived(_) | Presence::Optional(_) => continue,
                };
                (node.place, value)
            };
            out.push(Entry {
                key: field.key.to_owned(),
                key_place,
                node: value,
            });
        }
    }

    fn missing(&mut self, field: &Field, example: &str, place: Option<Place>) {
        let key = field.key;
        let (message, help) = match field.kind {
            Kind::Table(_) if place.is_none() => (
                format!("missing table [{key}]"),
                format!("add [{key}]: {}", field.doc),
            ),
            Kind::Map(of, _) => (
                format!("missing table [{key}.NAME]"),
                format!("add at least one {of}"),
            ),
            Kind::List(Kind::Table(_) | Kind::Variants(_), ..) if place.is_none() => (
                format!("missing list [[{key}]]"),
                format!("add at least one [[{key}]]"),
            ),
            _ => (
                format!("missing field `{key}`"),
                format!("add {key} = {example}  ({})", field.doc),
            ),
        };
        self.problems.error(place, message).help(help);
    }

    fn default(&mut self, field: &'static Field, literal: &str, place: Place) -> Node {
        let mut node = literal_node(literal, place);
        node = self.value(&node, &field.kind, field.key);
        mark_as_default(&mut node, place);
        node
    }

    /// Reports a text that is none of the choices.
    pub(crate) fn unknown_choice(&mut self, node: &Node, text: &str, key: &str, names: Vec<&str>) {
        let message = format!("`{}` is not a choice for `{key}`", clip(text, 40));
        let near = nearest(text, names.iter().copied());
        let problem = self.problems.error(node.place, message);
        if let Some(near) = near {
            problem.help(format!("did you mean \"{near}\"?"));
        }
        let choices = super::spec::one_of(names.into_iter());
        problem.help(format!("choices: {choices}"));
    }
}

/// The tree of a literal of the schema.
fn literal_node(literal: &str, place: Place) -> Node {
    DeValue::parse(literal).map_or_else(
        |_| Node::invalid(place),
        |value| from_value(&value, place.source),
    )
}

/// Sets the place of a default: that of its table.
fn mark_as_default(node: &mut Node, place: Place) {
    node.place = place;
    node.written = false;
    match &mut node.value {
        Value::List(items) => items
            .iter_mut()
            .for_each(|item| mark_as_default(item, place)),
        Value::Table(entries) => {
            for entry in entries {
                entry.key_place = place;
                mark_as_default(&mut entry.node, place);
            }
        }
        _ => {}
    }
}

/// The field of a material that goes by a symbol in books.
fn symbol(word: &str, known: &[&'static str]) -> Option<&'static str> {
    let word = word.to_lowercase();
    let (_, keys) = SYMBOLS.iter().find(|(symbol, _)| *symbol == word)?;
    let mut keys = keys.iter().copied();
    keys.find(|key| known.contains(key))
}

/// The table of the file that has a key.
fn table_of(key: &str) -> Option<&'static str> {
    let mut tables = ROOT.fields.iter();
    tables
        .find(|field| match field.kind {
            Kind::Table(of) => of.fields.iter().any(|inner| inner.key == key),
            _ => false,
        })
        .map(|field| field.key)
}

/// Whether a kind is the one to judge a value of this type.
fn takes(kind: &Kind, value: &Value) -> bool {
    match kind {
        Kind::Quantity(..) => {
            matches!(value, Value::Text(_) | Value::Integer(_) | Value::Number(_))
        }
        Kind::Choice(_) | Kind::Text | Kind::Name | Kind::Reference(_) => {
            matches!(value, Value::Text(_))
        }
        Kind::Number(_) => matches!(value, Value::Integer(_) | Value::Number(_)),
        Kind::Integer(..) | Kind::IntegerOf(_) => matches!(value, Value::Integer(_)),
        Kind::Flag => matches!(value, Value::Flag(_)),
        Kind::List(..) | Kind::Vector(_) => matches!(value, Value::List(_)),
        Kind::Table(_) | Kind::Variants(_) | Kind::Map(..) => matches!(value, Value::Table(_)),
        Kind::AnyQuantity | Kind::Either(_) => true,
    }
}
