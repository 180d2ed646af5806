//! The completed case file as commented TOML.

use std::fmt::Write;

use super::schema::{ROOT, bodies_of};
use super::spec::{Bodies, Field, Kind, Presence, Struct, Variants};
use super::tree::Node;
use crate::syntax::toml_text::{inline, key};

/// Column of comments.
const COMMENT: usize = 44;
/// Most characters of a list on one line.
const WIDTH: usize = 80;

/// The file with every default; it states the same case.
pub fn explain(completed: &Node) -> String {
    let mut out = String::new();
    let bodies = bodies_of(completed);
    for field in ROOT.fields {
        let Some(node) = completed.get(field.key) else {
            continue;
        };
        match field.kind {
            Kind::Table(of) => {
                let _ = writeln!(out, "\n# {}\n[{}]", of.doc, field.key);
                table(&mut out, node, of, bodies);
            }
            Kind::Map(_, of) => {
                for entry in node.entries() {
                    let name = key(&entry.key);
                    let _ = writeln!(
                        out,
                        "\n# {}\n[{}.{name}]",
                        doc_of(&entry.node, of),
                        field.key
                    );
                    variants(&mut out, &entry.node, of, bodies);
                }
            }
            Kind::List(Kind::Table(of), ..) => {
                for item in node.items() {
                    let _ = writeln!(out, "\n# {}\n[[{}]]", of.doc, field.key);
                    table(&mut out, item, of, bodies);
                }
            }
            Kind::List(Kind::Variants(of), ..) => {
                for item in node.items() {
                    let _ = writeln!(out, "\n# {}\n[[{}]]", doc_of(item, of), field.key);
                    variants(&mut out, item, of, bodies);
                }
            }
            _ => line(&mut out, field, Some(node)),
        }
        if node.items().is_empty() && matches!(field.kind, Kind::List(..)) {
            let _ = writeln!(out, "\n# no [[{}]]: {}", field.key, field.doc);
        }
    }
    out
}

/// The subject of a table of this form.
fn doc_of(node: &Node, of: &Variants) -> &'static str {
    let case = node.text_at(of.tag).and_then(|name| of.find(name));
    case.map_or(of.doc, |case| case.doc)
}

fn table(out: &mut String, node: &Node, of: &Struct, bodies: Bodies) {
    for field in of.fields.iter().filter(|field| field.applies(bodies)) {
        line(out, field, node.get(field.key));
    }
}

fn variants(out: &mut String, node: &Node, of: &'static Variants, bodies: Bodies) {
    let applies = |field: &&Field| field.applies(bodies);
    for field in of.before.iter().filter(applies) {
        line(out, field, node.get(field.key));
    }
    let names: Vec<_> = of.cases.iter().map(|case| case.name).collect();
    if let Some(tag) = node.get(of.tag) {
        let value = inline(tag, &Kind::Text);
        let comment = format!("{}: {}", of.tag_doc, names.join(" | "));
        commented(out, &format!("{} = {value}", of.tag), &comment);
    }
    let case = node.text_at(of.tag).and_then(|name| of.find(name));
    let fields = case.map_or(&[][..], |case| case.fields);
    for field in fields.iter().chain(of.after).filter(applies) {
        line(out, field, node.get(field.key));
    }
}

/// A key with its value and what it means.
fn line(out: &mut String, field: &Field, node: Option<&Node>) {
    let mut comment = field.doc.to_owned();
    if let Some(choices) = short_choices(&field.kind) {
        comment = format!("{comment}: {choices}");
    }
    let Some(node) = node else {
        if let Presence::Optional(meaning) = field.presence {
            let text = format!("# {} is not set", field.key);
            commented(out, &text, &format!("{comment}; without it: {meaning}"));
        }
        return;
    };
    if comment == field.key.replace('_', " ") {
        comment.clear();
    }
    if !node.written {
        comment = format!("default; {comment}");
        comment.truncate(comment.trim_end_matches("; ").len());
    }
    let value = inline(node, &field.kind);
    if value.len() > WIDTH && !node.items().is_empty() {
        let _ = writeln!(out, "# {comment}\n{} = [", field.key);
        let of = match &field.kind {
            Kind::List(of, ..) | Kind::Vector(of) => of,
            kind => kind,
        };
        for item in node.items() {
            let _ = writeln!(out, "    {},", inline(item, of));
        }
        out.push_str("]\n");
        return;
    }
    commented(out, &format!("{} = {value}", field.key), &comment);
}

/// A line with a comment behind it, or above it when it is long.
fn commented(out: &mut String, text: &str, comment: &str) {
    let _ = if comment.is_empty() {
        writeln!(out, "{text}")
    } else if text.chars().count() > COMMENT {
        writeln!(out, "# {comment}\n{text}")
    } else {
        writeln!(out, "{text:COMMENT$} # {comment}")
    };
}

/// The choices of a key, when they fit on a line.
fn short_choices(kind: &Kind) -> Option<String> {
    match kind {
        Kind::Choice(choices) if choices.len() <= 9 => {
            let names: Vec<_> = choices.iter().map(|choice| choice.name).collect();
            Some(names.join(" | "))
        }
        _ => None,
    }
}
