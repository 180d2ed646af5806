//! The schema as JSON Schema, so that editors complete and check case files.

use serde_json::{Map, Value as Json, json};
use toml::de::DeValue;

use super::quantity::Dimension;
use super::schema::ROOT;
use super::spec::{Choice, Field, Kind, Presence, Range, Scope, Struct, Variants};
use super::tree::{Node, Value, from_value};

/// A decimal number or a fraction, as a regular expression.
const NUMBER: &str = r"[-+]?([0-9_]+\.?[0-9_]*|\.[0-9_]+)([eE][-+]?[0-9]+)?";
/// Dimensions that keys take.
const DIMENSIONS: [Dimension; 19] = [
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
];

/// JSON Schema (draft 2020-12) of a case file.
pub fn json_schema() -> Json {
    let mut schema = table(&ROOT);
    if let Some(schema) = schema.as_object_mut() {
        let defs = DIMENSIONS.map(|dimension| (def_name(dimension), quantity(dimension)));
        schema.insert(
            "$schema".to_owned(),
            json!("https://json-schema.org/draft/2020-12/schema"),
        );
        schema.insert("title".to_owned(), json!("igimp case file"));
        schema.insert("$defs".to_owned(), Json::Object(defs.into_iter().collect()));
    }
    schema
}

fn def_name(dimension: Dimension) -> String {
    let name = dimension.name();
    let bare = name.split_once(' ').map_or(name, |(_, bare)| bare);
    bare.replace(' ', "-")
}

fn quantity(dimension: Dimension) -> Json {
    let units: Vec<String> = dimension.units().map(unit_pattern).collect();
    let units = units.join("|");
    json!({
        "type": "string",
        "title": format!("{}, with its unit", dimension.name()),
        "pattern": format!(r"^\s*{NUMBER}(\s*/\s*{NUMBER})?\s*({units})\s*$"),
        "examples": [dimension.example()],
    })
}

/// A unit with any of the spellings of its powers.
fn unit_pattern(unit: &str) -> String {
    unit.chars()
        .map(|c| match c {
            '2' => r"(\^?2|²)".to_owned(),
            '3' => r"(\^?3|³)".to_owned(),
            '/' => r"\s?/\s?".to_owned(),
            c => c.to_string(),
        })
        .collect()
}

fn table(of: &Struct) -> Json {
    object(of.doc, of.fields.iter(), None)
}

fn object<'a>(
    doc: &str,
    fields: impl Iterator<Item = &'a Field>,
    tag: Option<(&str, &str, &str)>,
) -> Json {
    let mut properties = Map::new();
    let mut required = Vec::new();
    if let Some((tag, doc, name)) = tag {
        let value = json!({ "const": name, "description": doc });
        properties.insert(tag.to_owned(), value);
        required.push(tag.to_owned());
    }
    for field in fields {
        let value = property(field);
        if matches!(field.presence, Presence::Required(_)) && field.scope == Scope::Any {
            required.push(field.key.to_owned());
        }
        let value = match properties.remove(field.key) {
            Some(other) => json!({ "anyOf": [other, value] }),
            None => value,
        };
        properties.insert(field.key.to_owned(), value);
    }
    json!({
        "type": "object",
        "description": doc,
        "properties": properties,
        "required": required,
        "additionalProperties": false,
    })
}

fn property(field: &Field) -> Json {
    let mut schema = kind(&field.kind);
    let doc = match field.presence {
        Presence::Optional(meaning) => format!("{}; when it is missing: {meaning}", field.doc),
        Presence::Derived(from) => format!("{}; when it is missing: {from}", field.doc),
        _ => field.doc.to_owned(),
    };
    if let Some(schema) = schema.as_object_mut() {
        let doc = match schema.get("description").and_then(Json::as_str) {
            Some(more) if matches!(field.kind, Kind::Choice(_)) => format!("{doc}. {more}"),
            _ => doc,
        };
        schema.insert("description".to_owned(), json!(doc));
        match field.presence {
            Presence::Default(literal) => {
                schema.insert("default".to_owned(), from_toml(literal));
            }
            Presence::Required(example)
                if !matches!(field.kind, Kind::Table(_) | Kind::Map(..)) =>
            {
                schema.insert("examples".to_owned(), json!([from_toml(example)]));
            }
            _ => {}
        }
    }
    schema
}

fn kind(of: &Kind) -> Json {
    match of {
        Kind::Text | Kind::Reference(_) => json!({ "type": "string" }),
        Kind::Name => json!({
            "type": "string",
            "pattern": r"^[\p{L}\p{N} ()+_-]+$",
            "minLength": 1,
            "maxLength": super::names::LONGEST,
        }),
        Kind::Flag => json!({ "type": "boolean" }),
        Kind::Integer(least, most) if *most == i64::MAX => {
            json!({ "type": "integer", "minimum": least })
        }
        Kind::Integer(least, most) => {
            json!({ "type": "integer", "minimum": least, "maximum": most })
        }
        Kind::IntegerOf(choices) => json!({ "type": "integer", "enum": choices }),
        Kind::Number(range) => number(*range),
        Kind::Quantity(dimension, _) => {
            json!({ "$ref": format!("#/$defs/{}", def_name(*dimension)) })
        }
        Kind::AnyQuantity => json!({ "type": ["number", "string"] }),
        Kind::Choice(choices) => json!({
            "type": "string",
            "enum": choices.iter().map(|choice| choice.name).collect::<Vec<_>>(),
            "description": meanings(choices),
        }),
        Kind::Either(kinds) => json!({ "anyOf": kinds.iter().map(kind).collect::<Vec<_>>() }),
        Kind::Vector(of) => json!({
            "type": "array",
            "items": kind(of),
            "minItems": 2,
            "maxItems": 3,
        }),
        Kind::List(of, least, most) => json!({
            "type": "array",
            "items": kind(of),
            "minItems": least,
            "maxItems": most,
        }),
        Kind::Table(of) => table(of),
        Kind::Map(_, of) => json!({
            "type": "object",
            "minProperties": 1,
            "additionalProperties": variants(of),
        }),
        Kind::Variants(of) => variants(of),
    }
}

fn variants(of: &'static Variants) -> Json {
    let cases = of.cases.iter().map(|case| {
        let mut schema = object(
            case.doc,
            of.fields(case),
            Some((of.tag, of.tag_doc, case.name)),
        );
        if let Some(schema) = schema.as_object_mut() {
            schema.insert("title".to_owned(), json!(case.name));
        }
        schema
    });
    json!({ "description": of.doc, "oneOf": cases.collect::<Vec<_>>() })
}

fn number(range: Range) -> Json {
    match range {
        Range::Any => json!({ "type": "number" }),
        Range::Positive => json!({ "type": "number", "exclusiveMinimum": 0 }),
        Range::NotNegative => json!({ "type": "number", "minimum": 0 }),
        Range::Share => json!({ "type": "number", "exclusiveMinimum": 0, "exclusiveMaximum": 1 }),
        Range::SmallShare => json!({ "type": "number", "exclusiveMinimum": 0, "maximum": 0.01 }),
        Range::Fraction => json!({ "type": "number", "minimum": 0, "maximum": 1 }),
    }
}

fn meanings(choices: &[Choice]) -> String {
    let meanings = choices
        .iter()
        .map(|choice| format!("{}: {}", choice.name, choice.doc));
    meanings.collect::<Vec<_>>().join("; ")
}

/// A literal of the schema as JSON.
fn from_toml(literal: &str) -> Json {
    DeValue::parse(literal).map_or(Json::Null, |value| to_json(&from_value(&value, 0)))
}

fn to_json(node: &Node) -> Json {
    match &node.value {
        Value::Text(text) | Value::Quantity(_, text) | Value::Date(text) => json!(text),
        Value::Integer(value) => json!(value),
        Value::Number(value) => json!(value),
        Value::Flag(value) => json!(value),
        Value::List(items) => Json::Array(items.iter().map(to_json).collect()),
        Value::Table(entries) => Json::Object(
            entries
                .iter()
                .map(|entry| (entry.key.clone(), to_json(&entry.node)))
                .collect(),
        ),
        Value::Invalid => Json::Null,
    }
}
