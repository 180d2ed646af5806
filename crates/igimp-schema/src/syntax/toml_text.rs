//! Values as TOML.

use std::fmt::Write;

use igimp_text::is_odd;

use crate::spec::{Field, Kind, Struct, Variants};
use crate::tree::{Node, Value};

/// A key, quoted when it has to be.
pub fn key(key: &str) -> String {
    let is_bare = |c: char| c.is_ascii_alphanumeric() || c == '-' || c == '_';
    if !key.is_empty() && key.chars().all(is_bare) {
        key.to_owned()
    } else {
        quoted(key)
    }
}

/// A text in quotes.
pub fn quoted(text: &str) -> String {
    let mut out = String::with_capacity(text.len() + 2);
    out.push('"');
    for c in text.chars() {
        match c {
            '"' => out.push_str("\\\""),
            '\\' => out.push_str("\\\\"),
            '\n' => out.push_str("\\n"),
            '\t' => out.push_str("\\t"),
            c if is_odd(c) => {
                let _ = write!(out, "\\u{:04X}", u32::from(c));
            }
            c => out.push(c),
        }
    }
    out.push('"');
    out
}

/// A value on one line; the keys of tables in the order of the schema.
pub fn inline(node: &Node, kind: &Kind) -> String {
    match &node.value {
        Value::Text(text) | Value::Quantity(_, text) | Value::Date(text) => quoted(text),
        Value::Integer(value) => value.to_string(),
        Value::Number(value) => format!("{value:?}"),
        Value::Flag(value) => value.to_string(),
        Value::List(items) => {
            let of = match kind {
                Kind::List(of, ..) | Kind::Vector(of) => of,
                kind => kind,
            };
            let items: Vec<_> = items.iter().map(|item| inline(item, of)).collect();
            format!("[{}]", items.join(", "))
        }
        Value::Table(_) => {
            let entries: Vec<_> = entries(node, kind)
                .iter()
                .map(|(name, value, kind)| format!("{} = {}", key(name), inline(value, kind)))
                .collect();
            if entries.is_empty() {
                "{}".to_owned()
            } else {
                format!("{{ {} }}", entries.join(", "))
            }
        }
        Value::Invalid => "\"?\"".to_owned(),
    }
}

/// The entries of a table in the order of the schema.
fn entries<'a>(node: &'a Node, kind: &'a Kind) -> Vec<(&'a str, &'a Node, &'a Kind)> {
    match kind {
        Kind::Table(of) => struct_entries(node, of),
        Kind::Variants(of) => variant_entries(node, of),
        Kind::Either(kinds) => kinds
            .iter()
            .find(|kind| matches!(kind, Kind::Table(_)))
            .map_or_else(Vec::new, |kind| entries(node, kind)),
        _ => Vec::new(),
    }
}

fn struct_entries<'a>(node: &'a Node, of: &'static Struct) -> Vec<(&'a str, &'a Node, &'a Kind)> {
    known(node, of.fields.iter())
}

/// The values of fields that a table has; a key that plane and space know as fields of their own is one.
fn known<'a>(
    node: &'a Node,
    fields: impl Iterator<Item = &'static Field>,
) -> Vec<(&'a str, &'a Node, &'a Kind)> {
    let mut all: Vec<(&'a str, &'a Node, &'a Kind)> = Vec::new();
    for field in fields {
        if let Some(value) = node.get(field.key)
            && all.iter().all(|(key, ..)| *key != field.key)
        {
            all.push((field.key, value, &field.kind));
        }
    }
    all
}

fn variant_entries<'a>(
    node: &'a Node,
    of: &'static Variants,
) -> Vec<(&'a str, &'a Node, &'a Kind)> {
    let Some(case) = node.text_at(of.tag).and_then(|name| of.find(name)) else {
        return Vec::new();
    };
    let tag = node.get(of.tag).map(|tag| (of.tag, tag, &Kind::Text));
    tag.into_iter()
        .chain(known(node, of.fields(case)))
        .collect()
}
