//! The schema as tables, for the book.

pub(crate) mod quantities;

use std::fmt::Write;

use super::quantity::Dimension;
use super::schema::ROOT;
use super::spec::{Choice, Field, Kind, Presence, Range, Scope, Struct, Variants};

/// Lists of choices longer than this get a section of their own.
const LONG: usize = 9;

/// Reference of the case file in Markdown.
pub fn reference_markdown() -> String {
    let mut out = String::new();
    let mut fields_of_particles = None;
    let _ = writeln!(
        out,
        "One TOML file states a case. Quantities carry their unit, as in `\"25 kPa\"`; a number may \
         be a fraction, as in `\"2/17 m\"`. A key without a default must be written. An unknown key \
         is an error.\n"
    );
    units(&mut out);
    for field in ROOT.fields {
        match &field.kind {
            Kind::Table(of) => {
                section(&mut out, &format!("[{}]", field.key), of.doc);
                structure(&mut out, of, &mut fields_of_particles);
            }
            Kind::Map(_, of) => {
                section(&mut out, &format!("[{}.NAME]", field.key), of.doc);
                variants(&mut out, of, &mut fields_of_particles);
            }
            Kind::List(Kind::Table(of), ..) => {
                section(&mut out, &format!("[[{}]]", field.key), of.doc);
                structure(&mut out, of, &mut fields_of_particles);
            }
            Kind::List(Kind::Variants(of), ..) => {
                section(&mut out, &format!("[[{}]]", field.key), of.doc);
                variants(&mut out, of, &mut fields_of_particles);
            }
            _ => {
                section(&mut out, field.key, "At the top of the file.");
                rows(
                    &mut out,
                    &mut std::iter::once(field),
                    &mut fields_of_particles,
                );
            }
        }
    }
    if let Some(choices) = fields_of_particles {
        out.push_str("## Fields\n\nWhat monitors and sections record and figures show.\n\n");
        out.push_str("| name | meaning |\n|---|---|\n");
        for choice in choices {
            let _ = writeln!(out, "| `{}` | {} |", choice.name, cell(choice.doc));
        }
        out.push('\n');
    }
    quantities(&mut out);
    out
}

fn section(out: &mut String, title: &str, doc: &str) {
    let _ = writeln!(out, "## `{title}`\n\n{doc}\n");
}

fn units(out: &mut String) {
    out.push_str("| quantity | units |\n|---|---|\n");
    for dimension in [
        Dimension::Length,
        Dimension::Stress,
        Dimension::UnitWeight,
        Dimension::StressGradient,
        Dimension::UnitWeightGradient,
        Dimension::Angle,
        Dimension::AngleGradient,
        Dimension::NumberGradient,
        Dimension::Acceleration,
        Dimension::ForcePerLength,
        Dimension::MomentPerLength,
        Dimension::MassDensity,
        Dimension::Force,
        Dimension::Moment,
        Dimension::Time,
        Dimension::Velocity,
        Dimension::DischargePerLength,
        Dimension::Discharge,
        Dimension::StrainRate,
    ] {
        let units: Vec<_> = dimension.units().map(|unit| format!("`{unit}`")).collect();
        let _ = writeln!(out, "| {} | {} |", bare(dimension), units.join(" "));
    }
    out.push_str("\nPowers may be written `m3`, `m^3` or `m³`.\n\n");
}

fn quantities(out: &mut String) {
    out.push_str(
        "## Quantities\n\nWhat curves and checks name in `of`, in SI units.\n\n\
         | name | meaning |\n|---|---|\n",
    );
    for (name, doc) in crate::reference::quantities::QUANTITY_DOCS {
        let _ = writeln!(out, "| `{name}` | {} |", cell(doc));
    }
}

type Long = Option<&'static [Choice]>;

fn structure(out: &mut String, of: &'static Struct, long: &mut Long) {
    rows(out, &mut of.fields.iter(), long);
    nested(out, of.fields, long);
}

fn variants(out: &mut String, of: &'static Variants, long: &mut Long) {
    let names: Vec<_> = of
        .cases
        .iter()
        .map(|case| format!("`\"{}\"`", case.name))
        .collect();
    let _ = writeln!(out, "`{}`, {}: {}.\n", of.tag, of.tag_doc, names.join(", "));
    out.push_str("Keys of every form:\n\n");
    rows(out, &mut of.before.iter().chain(of.after), long);
    for case in of.cases {
        let _ = writeln!(out, "**`{} = \"{}\"`** {}\n", of.tag, case.name, case.doc);
        if !case.fields.is_empty() {
            rows(out, &mut case.fields.iter(), long);
        }
        nested(out, case.fields, long);
    }
    nested(out, of.before, long);
    nested(out, of.after, long);
}

/// Tables within tables; keys with the same table share a heading.
fn nested(out: &mut String, fields: &'static [Field], long: &mut Long) {
    let tables: Vec<(String, &'static Struct)> = fields.iter().flat_map(tables_of).collect();
    for (first, (_, of)) in tables.iter().enumerate() {
        let is_same = |other: &&'static Struct| std::ptr::eq(*other, *of);
        if tables[..first].iter().any(|(_, other)| is_same(other)) {
            continue;
        }
        let titles: Vec<_> = tables
            .iter()
            .filter(|(_, other)| is_same(other))
            .map(|(title, _)| format!("`{title}`"))
            .collect();
        let _ = writeln!(out, "{}: {}\n", titles.join(", "), of.doc);
        structure(out, of, long);
    }
}

/// The tables that a key may hold, with their headings.
fn tables_of(field: &'static Field) -> Vec<(String, &'static Struct)> {
    let kinds = match &field.kind {
        Kind::Either(kinds) => kinds,
        kind => std::slice::from_ref(kind),
    };
    let table = |kind: &'static Kind| match kind {
        Kind::Table(of) => Some((format!("{} = {{ ... }}", field.key), *of)),
        Kind::List(Kind::Table(of), ..) => Some((format!("{} = [{{ ... }}]", field.key), *of)),
        _ => None,
    };
    kinds.iter().filter_map(table).collect()
}

fn rows(out: &mut String, fields: &mut dyn Iterator<Item = &'static Field>, long: &mut Long) {
    out.push_str("| key | value | default | meaning |\n|---|---|---|---|\n");
    for field in fields {
        let default = match field.presence {
            Presence::Required(_) => "required".to_owned(),
            Presence::Default("{}") => "the defaults below".to_owned(),
            Presence::Default("[]") => "none".to_owned(),
            Presence::Default(literal) => format!("`{literal}`"),
            Presence::Derived(from) => from.to_owned(),
            Presence::Optional(meaning) => format!("not set: {meaning}"),
        };
        let mut doc = match field.scope {
            Scope::Any => field.doc.to_owned(),
            Scope::Plane => format!("in plane strain: {}", field.doc),
            Scope::Space => format!("in space: {}", field.doc),
            Scope::PerMetre => format!("per metre run: {}", field.doc),
            Scope::Whole => format!("of revolution and in space: {}", field.doc),
        };
        if let Kind::Choice(choices) = field.kind
            && choices.len() <= LONG
        {
            let meanings = choices
                .iter()
                .map(|choice| format!("`{}`: {}", choice.name, choice.doc));
            doc = format!("{doc}. {}", meanings.collect::<Vec<_>>().join("; "));
        }
        let _ = writeln!(
            out,
            "| `{}` | {} | {} | {} |",
            field.key,
            cell(&value(&field.kind, long)),
            cell(&default),
            cell(&doc)
        );
    }
    out.push('\n');
}

/// The values that a kind admits, in a few words.
fn value(kind: &'static Kind, long: &mut Long) -> String {
    match kind {
        Kind::Text => "text".to_owned(),
        Kind::Name => "name".to_owned(),
        Kind::Reference(of) => format!("name of a {of}"),
        Kind::Flag => "`true` or `false`".to_owned(),
        Kind::Integer(least, most) if *most == i64::MAX => format!("whole number from {least}"),
        Kind::Integer(least, most) if least == most => format!("`{least}`"),
        Kind::Integer(least, most) => format!("whole number, {least} to {most}"),
        Kind::IntegerOf(choices) => {
            let choices: Vec<_> = choices.iter().map(|choice| format!("`{choice}`")).collect();
            choices.join(" ")
        }
        Kind::Number(range) => format!("number{}", range_text(*range)),
        Kind::Quantity(dimension, range) => {
            format!("{}{}", bare(*dimension), range_text(*range))
        }
        Kind::AnyQuantity => "number or quantity".to_owned(),
        Kind::Choice(choices) if choices.len() > LONG => {
            *long = Some(choices);
            "[field](#fields)".to_owned()
        }
        Kind::Choice(choices) => {
            let names = choices
                .iter()
                .map(|choice| format!("`\"{}\"`", choice.name));
            names.collect::<Vec<_>>().join(" ")
        }
        Kind::Either(kinds) => {
            let kinds: Vec<_> = kinds.iter().map(|kind| value(kind, long)).collect();
            kinds.join(" or ")
        }
        Kind::Vector(of) => format!("a value for each axis: {}", value(of, long)),
        Kind::List(of, least, most) if least == most => {
            format!("list of {least}: {}", value(of, long))
        }
        Kind::List(of, ..) => format!("list: {}", value(of, long)),
        Kind::Table(_) | Kind::Variants(_) | Kind::Map(..) => "table".to_owned(),
    }
}

fn range_text(range: Range) -> &'static str {
    match range {
        Range::Any => "",
        Range::Positive => " > 0",
        Range::NotNegative => " ≥ 0",
        Range::Share => " between 0 and 1",
        Range::SmallShare => " > 0, at most 0.01",
        Range::Fraction => " from 0 to 1",
    }
}

fn bare(dimension: Dimension) -> &'static str {
    let name = dimension.name();
    name.split_once(' ').map_or(name, |(_, bare)| bare)
}

/// Text that may stand in a cell of a table.
fn cell(text: &str) -> String {
    text.replace('|', "\\|").replace('\n', " ")
}
