//! Values from the command line, such as `materials.clay.cohesion=12 kPa`.

use std::ops::Range;

use toml::de::DeValue;

use super::diagnostic::Problems;
use super::schema::ROOT;
use super::source::{Place, Source};
use super::spec::Kind;
use super::text::{clip, row};
use super::tree::{Entry, Node, Value, from_value, shift};
use crate::names::suggest::nearest;

/// Most parts of a key.
const DEEPEST: usize = 16;

/// A part of a key.
struct Part {
    text: String,
    place: Place,
}

/// Changes a tree as an override says; the override is the source of this index.
pub fn apply(tree: &mut Node, sources: &[Source], index: usize, problems: &mut Problems) {
    let Some(source) = sources.get(index) else {
        return;
    };
    let whole = Place::new(index, &(0..source.text.len()));
    let Some(equals) = outside_quotes(&source.text, '=') else {
        problems
            .error(whole, format!("`{}` has no `=`", clip(&source.text, 40)))
            .help("write KEY=VALUE, like materials.clay.cohesion=\"12 kPa\"");
        return;
    };
    let parts = parts(&source.text[..equals], index);
    if parts.is_empty() || parts.len() > DEEPEST || parts.iter().any(|part| part.text.is_empty()) {
        problems
            .error(whole, "this is not a key of a case file")
            .help("write KEY=VALUE, like materials.clay.cohesion=\"12 kPa\"");
        return;
    }
    if let Some(value) = value(&source.text, equals + 1, index, problems) {
        set(tree, &parts, value, problems);
    }
}

fn outside_quotes(text: &str, wanted: char) -> Option<usize> {
    let mut quote = None;
    for (at, c) in text.char_indices() {
        match quote {
            Some(open) if c == open => quote = None,
            None if c == wanted => return Some(at),
            None if c == '"' || c == '\'' => quote = Some(c),
            _ => {}
        }
    }
    None
}

fn parts(key: &str, source: usize) -> Vec<Part> {
    let mut parts = Vec::new();
    let mut start = 0;
    loop {
        let rest = &key[start..];
        let end = start + outside_quotes(rest, '.').unwrap_or(rest.len());
        let span = trimmed(key, start..end);
        let text = &key[span.clone()];
        let bare = ['"', '\'']
            .iter()
            .find_map(|&quote| text.strip_prefix(quote)?.strip_suffix(quote));
        parts.push(Part {
            text: bare.unwrap_or(text).to_owned(),
            place: Place::new(source, &span),
        });
        if end >= key.len() {
            return parts;
        }
        start = end + 1;
    }
}

fn trimmed(text: &str, span: Range<usize>) -> Range<usize> {
    let part = &text[span.clone()];
    let start = span.start + (part.len() - part.trim_start().len());
    start..start + part.trim().len()
}

/// The value of an override: TOML, or a text without quotes.
fn value(text: &str, from: usize, source: usize, problems: &mut Problems) -> Option<Node> {
    let span = trimmed(text, from..text.len());
    let written = &text[span.clone()];
    let place = Place::new(source, &span);
    match DeValue::parse(written) {
        Ok(value) => {
            let mut node = from_value(&value, source);
            shift(&mut node, span.start);
            Some(node)
        }
        Err(_) if !written.is_empty() && !written.starts_with(['"', '\'', '[', '{']) => {
            Some(Node::written(Value::Text(written.to_owned()), place))
        }
        Err(error) => {
            let at = error.span().map_or(place, |inner| {
                Place::new(source, &inner).shifted(span.start)
            });
            if written.is_empty() {
                problems.error(place, "there is no value after `=`");
            } else {
                problems.error(at, format!("this is not TOML: {}", error.message()));
            }
            None
        }
    }
}

/// Puts a value at a key.
fn set(tree: &mut Node, parts: &[Part], value: Node, problems: &mut Problems) {
    let mut node = tree;
    let mut path = String::new();
    for (depth, part) in parts.iter().enumerate() {
        let is_last = depth + 1 == parts.len();
        let parent = path.clone();
        if !path.is_empty() {
            path.push('.');
        }
        path.push_str(&part.text);
        let kind = node.kind();
        let next = match &mut node.value {
            Value::Table(entries) => {
                let at = entries.iter().position(|entry| entry.key == part.text);
                if at.is_none() && !is_last && !may_be_made(&parent, &part.text) {
                    let known: Vec<_> = entries.iter().map(|entry| entry.key.as_str()).collect();
                    unknown_item(part, &parent, &known, problems);
                    return;
                }
                let at = at.unwrap_or_else(|| {
                    entries.push(Entry {
                        key: part.text.clone(),
                        key_place: part.place,
                        node: Node::written(Value::Table(Vec::new()), part.place),
                    });
                    entries.len() - 1
                });
                entries.get_mut(at).map(|entry| &mut entry.node)
            }
            Value::List(items) => {
                let name = |item: &Node| item.get("name").and_then(Node::text).map(str::to_owned);
                let at = items
                    .iter()
                    .position(|item| name(item).as_deref() == Some(part.text.as_str()))
                    .or_else(|| {
                        part.text
                            .parse()
                            .ok()
                            .filter(|&at: &usize| at < items.len())
                    });
                if at.is_none() {
                    let names: Vec<_> = items.iter().filter_map(name).collect();
                    let known: Vec<_> = names.iter().map(String::as_str).collect();
                    unknown_item(part, &parent, &known, problems);
                    return;
                }
                at.and_then(|at| items.get_mut(at))
            }
            _ => {
                let message = format!("`{parent}` is {kind}, not a table");
                problems
                    .error(part.place, message)
                    .help(format!("set the whole of `{parent}`"));
                return;
            }
        };
        let Some(next) = next else { return };
        node = next;
    }
    *node = value;
}

/// Whether a table that is not in the file may be made on the way to a key: not a material, and
/// not the item of a list.
fn may_be_made(parent: &str, key: &str) -> bool {
    let field = |key: &str| ROOT.fields.iter().find(|field| field.key == key);
    if parent.is_empty() {
        return field(key).is_none_or(|field| !matches!(field.kind, Kind::List(..)));
    }
    field(parent).is_none_or(|field| !matches!(field.kind, Kind::Map(..)))
}

fn unknown_item(part: &Part, parent: &str, known: &[&str], problems: &mut Problems) {
    let shown = clip(&part.text, 40);
    let message = if parent.is_empty() {
        format!("there are no `{shown}` in the file")
    } else {
        format!("there is no `{shown}` in `{parent}`")
    };
    let problem = problems.error(part.place, message);
    if !parent.is_empty() {
        problem.help(format!("defined: {}", row(known.to_vec())));
        if let Some(near) = nearest(&part.text, known.to_vec()) {
            problem.help(format!("did you mean `{near}`?"));
        }
    }
}
