//! GOAL: the JSON Schema accepts every shipped case, refuses a damaged one, and describes every key.
//! ORACLE: the case files; the part of JSON Schema that ours uses, read by a few lines here.

use igimp_input::shipped::SHIPPED;
use igimp_schema::json_schema;

use crate::{FOOTING, SLOPE};

#[test]
fn the_json_schema_describes_every_table() {
    let schema = json_schema();
    assert_eq!(
        schema["$schema"],
        "https://json-schema.org/draft/2020-12/schema"
    );
    let shipped = SHIPPED.iter().map(|case| (case.name, case.text));
    for (name, text) in [SLOPE, FOOTING].into_iter().chain(shipped) {
        let file: toml::Table = text.parse().unwrap();
        let value = serde_json::to_value(file).unwrap();
        validate(&schema, &schema, &value, name);
        let mut spoiled = 0;
        for pointer in pointers(&value, "") {
            // A key that there is not, in every table that does not take keys of the user's.
            let mut with_key = value.clone();
            if let Some(table) = with_key.pointer_mut(&pointer).unwrap().as_object_mut() {
                table.insert("no_such_key".to_owned(), true.into());
                assert!(!matches(&schema, &schema, &with_key), "{name}: {pointer}");
            }
            // A value of another kind, wherever there is one.
            let mut of_other_type = value.clone();
            *of_other_type.pointer_mut(&pointer).unwrap() =
                serde_json::json!({ "no_such_key": {} });
            assert!(
                !matches(&schema, &schema, &of_other_type),
                "{name}: {pointer}"
            );
            spoiled += 1;
        }
        assert!(spoiled > 40, "{name}: {spoiled}");
    }
    let words = described(&schema);
    assert!(words > 400, "{words}");
}

/// Places of all values within a value, as JSON pointers.
fn pointers(value: &serde_json::Value, at: &str) -> Vec<String> {
    let within: Vec<(String, &serde_json::Value)> = match value {
        serde_json::Value::Object(entries) => (entries.iter())
            .map(|(key, value)| (key.replace('~', "~0").replace('/', "~1"), value))
            .collect(),
        serde_json::Value::Array(items) => (items.iter().enumerate())
            .map(|(k, value)| (k.to_string(), value))
            .collect(),
        _ => Vec::new(),
    };
    let deeper = within
        .into_iter()
        .flat_map(|(key, value)| pointers(value, &format!("{at}/{key}")));
    std::iter::once(at.to_owned()).chain(deeper).collect()
}

/// How many properties a schema has, each described, in either analysis.
fn described(schema: &serde_json::Value) -> usize {
    let says = |property: &serde_json::Value| {
        let text = property["description"].as_str();
        property.get("const").is_some() || text.is_some_and(|text| text.len() > 3)
    };
    match schema {
        serde_json::Value::Object(entries) => {
            let properties = entries
                .get("properties")
                .and_then(|value| value.as_object());
            let mut count = 0;
            for (key, property) in properties.into_iter().flatten() {
                let forms = property["anyOf"].as_array();
                let is_described = says(property) || forms.is_some_and(|all| all.iter().all(says));
                assert!(is_described, "{key}: {property}");
                count += 1;
            }
            count + entries.values().map(described).sum::<usize>()
        }
        serde_json::Value::Array(items) => items.iter().map(described).sum(),
        _ => 0,
    }
}

/// Holds a value against the part of JSON Schema that ours uses.
fn validate(
    root: &serde_json::Value,
    schema: &serde_json::Value,
    value: &serde_json::Value,
    at: &str,
) {
    assert!(
        matches(root, schema, value),
        "{at}: {value} is not {schema}"
    );
}

fn matches(
    root: &serde_json::Value,
    schema: &serde_json::Value,
    value: &serde_json::Value,
) -> bool {
    if let Some(name) = schema["$ref"].as_str() {
        let name = name.strip_prefix("#/$defs/").unwrap();
        assert!(!root["$defs"][name].is_null(), "{name}");
        return matches(root, &root["$defs"][name], value);
    }
    if let Some(forms) = schema["oneOf"].as_array() {
        return forms
            .iter()
            .filter(|form| matches(root, form, value))
            .count()
            == 1;
    }
    if let Some(forms) = schema["anyOf"].as_array() {
        return forms.iter().any(|form| matches(root, form, value));
    }
    if let Some(expected) = schema.get("const") {
        return expected == value;
    }
    let one_of = schema["enum"].as_array();
    if one_of.is_some_and(|choices| !choices.contains(value)) {
        return false;
    }
    let is_type = |name: &str| match name {
        "string" => value.is_string(),
        "number" => value.is_number(),
        "integer" => value.is_i64(),
        "boolean" => value.is_boolean(),
        "array" => value.is_array(),
        "object" => value.is_object(),
        other => panic!("unknown type {other}"),
    };
    let right_type = match &schema["type"] {
        serde_json::Value::Array(names) => names.iter().any(|name| is_type(name.as_str().unwrap())),
        name => is_type(name.as_str().unwrap_or_else(|| panic!("no type: {schema}"))),
    };
    if !right_type {
        return false;
    }
    let items = value.as_array().is_none_or(|items| {
        items
            .iter()
            .all(|item| matches(root, &schema["items"], item))
            && items.len() as u64 >= schema["minItems"].as_u64().unwrap()
    });
    let entries = value.as_object().is_none_or(|entries| {
        let required = schema["required"].as_array();
        entries
            .iter()
            .all(|(key, value)| match &schema["properties"][key] {
                serde_json::Value::Null if schema["additionalProperties"].is_object() => {
                    matches(root, &schema["additionalProperties"], value)
                }
                serde_json::Value::Null => false,
                property => matches(root, property, value),
            })
            && required.is_none_or(|keys| {
                keys.iter()
                    .all(|key| entries.contains_key(key.as_str().unwrap()))
            })
    });
    items && entries
}
